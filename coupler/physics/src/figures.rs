//! Computed numbers as messages show them.

use std::fmt;

/// Sizes that are written without an exponent.
const LEAST_PLAIN: f64 = 1e-12;
const MOST_PLAIN: f64 = 1e15;
/// Digits behind the first of a [`Brief`].
const BRIEF: usize = 5;

/// A computed number to six digits, without idle zeros.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Brief(pub f64);

impl fmt::Display for Brief {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&rounded(self.0, BRIEF))
    }
}

/// A number to so many digits behind the first, with an exponent where it would have many zeros.
pub fn rounded(number: f64, digits: usize) -> String {
    let rounded = format!("{number:.digits$e}")
        .parse::<f64>()
        .unwrap_or(number);
    let size = rounded.abs();
    match size == 0.0 || (LEAST_PLAIN..MOST_PLAIN).contains(&size) {
        true => rounded.to_string(),
        false => format!("{rounded:e}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_have_six_digits_at_most_and_no_idle_zeros() {
        for (number, text) in [
            (874.668_687_663_814_1, "874.669"),
            (0.1 + 0.2, "0.3"),
            (-2.5e-20, "-2.5e-20"),
            (1.0e6, "1000000"),
            (0.0, "0"),
            (f64::NAN, "NaN"),
        ] {
            assert_eq!(Brief(number).to_string(), text);
        }
    }
}
