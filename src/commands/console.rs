//! The user's terminal.

use std::fmt;
use std::io::{ErrorKind, Write};

use super::failure::Failure;
use crate::exit;

/// A quantity as a terminal shows it: six decimals, or seven digits of what is too small or too large for that.
pub(super) fn printed(value: f64) -> String {
    if value == 0.0 || !value.is_finite() || (1e-3..1e9).contains(&value.abs()) {
        format!("{value:.6}")
    } else {
        format!("{value:.6e}")
    }
}

/// Linux' number of the error of a terminal that is gone.
const EIO: i32 = 5;

/// True of a pipe that is closed, and of a terminal that is gone.
fn nobody_reads(cause: &std::io::Error) -> bool {
    cause.kind() == ErrorKind::BrokenPipe || cause.raw_os_error() == Some(EIO)
}

/// Prints a line for the user. One who reads no further, such as `head`, is no error.
pub(super) fn say(text: impl fmt::Display) -> Result<(), Failure> {
    let mut out = std::io::stdout().lock();
    match writeln!(out, "{text}").and_then(|()| out.flush()) {
        Err(cause) if !nobody_reads(&cause) => Err(Failure::new(
            exit::OTHER,
            format_args!("standard output cannot be written: {cause}"),
        )),
        _ => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use super::printed;

    #[test]
    fn small_and_large_quantities_keep_their_digits() {
        assert_eq!(printed(334.264_662_1), "334.264662");
        assert_eq!(printed(1.162_28e-7), "1.162280e-7");
        assert_eq!(printed(-2.5e12), "-2.500000e12");
        assert_eq!(printed(1e-3), "0.001000");
        assert_eq!(printed(9.99e-4), "9.990000e-4");
        assert_eq!(printed(9.99e8), "999000000.000000");
        assert_eq!(printed(1e9), "1.000000e9");
        assert_eq!(printed(0.0), "0.000000");
        assert_eq!(printed(f64::NAN), "NaN");
    }
}
