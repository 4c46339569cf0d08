//! The user's terminal.

use std::fmt;
use std::io::Write;

/// Prints a line for the user. One who reads no further, such as `head`, is no error.
pub(super) fn say(text: impl fmt::Display) {
    let _ = writeln!(std::io::stdout().lock(), "{text}");
}
