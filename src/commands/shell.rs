//! Words as a shell reads them.

use std::ffi::OsStr;

use calcine_adapters::launch::quoted;

/// A word of a command line, quoted for the shell where it needs to be.
pub(super) fn word(text: &OsStr) -> String {
    let plain = |c: char| c.is_alphanumeric() || "_-./=,:+%@".contains(c);
    match text.to_str() {
        Some(text) if !text.is_empty() && text.chars().all(plain) => text.to_owned(),
        _ => quoted(text),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_word_is_quoted_only_where_the_shell_would_change_it() {
        for (text, written) in [
            ("time.end=1.9", "time.end=1.9"),
            ("time.end=10 s", "'time.end=10 s'"),
            ("particles[0].density=2", "'particles[0].density=2'"),
            ("it's", "'it'\\''s'"),
            ("", "''"),
        ] {
            assert_eq!(word(text.as_ref()), written);
        }
    }
}
