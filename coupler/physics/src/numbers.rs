//! Dimensionless numbers that are easily confused, each with one definition and a checked range.

use thiserror::Error;

/// A number outside its range.
#[derive(Clone, Copy, Debug, Error, PartialEq)]
#[error("{name} is {value}, but must lie in {range}")]
pub struct OutOfRange {
    /// Which number.
    pub name: &'static str,
    /// Its value.
    pub value: f64,
    /// The range as text.
    pub range: &'static str,
}

/// Defines a newtype over f64 with a checked constructor.
macro_rules! number {
    ($(#[$doc:meta])* $type:ident, $name:literal, $range:literal, $holds:expr) => {
        $(#[$doc])*
        #[derive(Clone, Copy, Debug, PartialEq, PartialOrd)]
        pub struct $type(f64);

        impl $type {
            /// The number, if it lies in its range.
            pub fn new(value: f64) -> Result<Self, OutOfRange> {
                let holds: fn(f64) -> bool = $holds;
                if holds(value) {
                    Ok(Self(value))
                } else {
                    Err(OutOfRange { name: $name, value, range: $range })
                }
            }

            /// The bare value.
            pub fn value(self) -> f64 {
                self.0
            }
        }
    };
}

number!(
    /// Volume fraction ε of the gas, 1 − α.
    VoidFraction, "the void fraction", "(0, 1]", |x| x > 0.0 && x <= 1.0
);
number!(
    /// Re = ρ ε |u − v| d/μ, with the superficial slip ε |u − v|.
    SuperficialReynolds, "the superficial Reynolds number", "[0, inf)", |x| x >= 0.0 && x.is_finite()
);
number!(
    /// Re = ρ |u − v| d/μ, with the interstitial slip |u − v|.
    InterstitialReynolds, "the interstitial Reynolds number", "[0, inf)", |x| x >= 0.0 && x.is_finite()
);
number!(
    /// Pr = c_p μ/κ.
    Prandtl, "the Prandtl number", "(0, inf)", |x| x > 0.0 && x.is_finite()
);

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_void_fraction_is_positive_and_at_most_one() {
        assert!(VoidFraction::new(0.0).is_err());
        assert!(VoidFraction::new(1.0 + 1e-15).is_err());
        assert!(VoidFraction::new(f64::NAN).is_err());
        assert_eq!(VoidFraction::new(0.4).unwrap().value(), 0.4);
    }
}
