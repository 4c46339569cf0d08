//! What is told beside the output of a command.

use std::fmt;
use std::io::Write;

/// Writes to standard error. One who reads no further, such as `head` behind `2>&1`, ends no run: what cannot be told is in the
/// results too.
pub(crate) fn tell(text: impl fmt::Display) {
    let mut out = std::io::stderr().lock();
    let _ = write!(out, "{text}").and_then(|()| out.flush());
}

/// The same of a line.
pub(crate) fn tell_line(text: impl fmt::Display) {
    tell(format_args!("{text}\n"));
}
