//! What is wrong with a file, and where.

/// What is wrong on a line, before the file's name is added.
pub(super) type Fault = (Option<usize>, String);

pub(super) fn fault<T>(line: usize, what: impl Into<String>) -> Result<T, Fault> {
    Err((Some(line), what.into()))
}
