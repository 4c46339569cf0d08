//! APT's own entries turned into source entries, for a private configuration that leaves the
//! system's untouched.

use std::fs;
use std::path::Path;
use std::process::Command;

use crate::steps::{Stop, TaskResult, output};

/// Writes source entries for every repository of Debian's that the system uses into `folder`,
/// with the same suites and keys.
pub fn write_source_entries(folder: &Path) -> TaskResult<()> {
    let wanted = debian_repositories();
    let mut found = 0;
    for (file, text) in system_entries() {
        let converted = if file.ends_with(".sources") {
            stanzas_as_sources(&text, &wanted)
        } else {
            lines_as_sources(&text, &wanted)
        };
        if !converted.is_empty() {
            found += 1;
            let path = folder.join(file);
            fs::write(&path, converted).map_err(|cause| Stop::io(&path, &cause))?;
        }
    }
    if found == 0 {
        return Err(Stop::new(
            "no package source is configured below /etc/apt: Debian's package sources are needed \
             to fetch the headers of OpenFOAM (see `man sources.list`)",
        ));
    }
    Ok(())
}

/// Addresses of the repositories that call themselves Debian; empty if APT cannot say, which
/// means all of them. Others (a vendor's repository) often hold no sources.
fn debian_repositories() -> Vec<String> {
    let mut command = Command::new("apt-get");
    command.args([
        "indextargets",
        "--format",
        "$(ORIGIN) $(REPO_URI)",
        "Created-By: Packages",
    ]);
    let text = output(&mut command).unwrap_or_default();
    let mut addresses: Vec<String> = text
        .lines()
        .filter_map(|line| line.strip_prefix("Debian "))
        .map(|address| address.trim_end_matches('/').to_owned())
        .collect();
    addresses.sort();
    addresses.dedup();
    addresses
}

/// Name and text of each file that lists package sources.
fn system_entries() -> Vec<(String, String)> {
    let mut entries = Vec::new();
    if let Ok(text) = fs::read_to_string("/etc/apt/sources.list") {
        entries.push(("sources.list".to_owned(), text));
    }
    let Ok(folder) = fs::read_dir("/etc/apt/sources.list.d") else {
        return entries;
    };
    for file in folder.flatten() {
        let name = file.file_name().to_string_lossy().into_owned();
        let listed = name.ends_with(".list") || name.ends_with(".sources");
        if let (true, Ok(text)) = (listed, fs::read_to_string(file.path())) {
            entries.push((name, text));
        }
    }
    entries
}

fn is_wanted(text: &str, wanted: &[String]) -> bool {
    let same = |word: &str, address: &String| word.trim_end_matches('/') == address;
    wanted.is_empty()
        || text
            .split_whitespace()
            .any(|word| wanted.iter().any(|address| same(word, address)))
}

/// One-line entries: `deb [options] address suite components`.
fn lines_as_sources(text: &str, wanted: &[String]) -> String {
    text.lines()
        .filter_map(|line| line.trim_start().strip_prefix("deb"))
        .filter(|rest| rest.starts_with([' ', '\t']) && is_wanted(rest, wanted))
        .map(|rest| format!("deb-src{rest}\n"))
        .collect()
}

/// Entries in stanzas: `Types: deb`, `URIs: …`, one field a line.
fn stanzas_as_sources(text: &str, wanted: &[String]) -> String {
    let mut converted = String::new();
    let without_comments: Vec<&str> = text
        .lines()
        .filter(|line| !line.starts_with('#'))
        .map(str::trim_end)
        .collect();
    for stanza in without_comments.split(|line| line.is_empty()) {
        let is_types = |line: &str| line.to_ascii_lowercase().starts_with("types:");
        let is_binary =
            |line: &&str| is_types(line) && line[6..].split_whitespace().any(|kind| kind == "deb");
        if !stanza.iter().any(is_binary) || !is_wanted(&stanza.join(" "), wanted) {
            continue;
        }
        for line in stanza {
            converted.push_str(if is_types(line) {
                "Types: deb-src"
            } else {
                line
            });
            converted.push('\n');
        }
        converted.push('\n');
    }
    converted
}

#[cfg(test)]
mod tests {
    use super::*;

    const STANZAS: &str = "\
# a comment
Types: deb
# another
URIs: http://deb.example.org/debian
Suites: bookworm bookworm-updates
Components: main
Signed-By: /usr/share/keyrings/debian-archive-keyring.gpg

Types: deb
URIs: https://vendor.example.org/
Suites: stable

Types: deb-src
URIs: http://deb.example.org/debian
Suites: bookworm
";

    #[test]
    fn a_stanza_keeps_everything_but_its_type() {
        let wanted = ["http://deb.example.org/debian".to_owned()];
        let converted = "\
Types: deb-src
URIs: http://deb.example.org/debian
Suites: bookworm bookworm-updates
Components: main
Signed-By: /usr/share/keyrings/debian-archive-keyring.gpg

";
        assert_eq!(stanzas_as_sources(STANZAS, &wanted), converted);
    }

    #[test]
    fn all_binary_stanzas_are_taken_where_the_origin_is_unknown() {
        assert_eq!(
            stanzas_as_sources(STANZAS, &[])
                .matches("Types: deb-src")
                .count(),
            2
        );
    }

    #[test]
    fn a_line_keeps_its_options_and_a_disabled_one_stays_away() {
        let text = "\
# deb http://deb.example.org/debian bookworm main
deb [signed-by=/k.gpg] http://deb.example.org/debian/ bookworm main
deb-src http://deb.example.org/debian bookworm main
deb https://vendor.example.org stable main
";
        let wanted = ["http://deb.example.org/debian".to_owned()];
        assert_eq!(
            lines_as_sources(text, &wanted),
            "deb-src [signed-by=/k.gpg] http://deb.example.org/debian/ bookworm main\n"
        );
    }
}
