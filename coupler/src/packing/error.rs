//! What can go wrong with a packing.

use thiserror::Error;

/// A packing that cannot be made.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum PackingError {
    /// Spheres that are larger than the vessel is wide.
    #[error(
        "spheres of {diameter} m do not fit between walls that are {width:.4} m apart; take smaller spheres or a wider \
         vessel"
    )]
    TooNarrow {
        /// The largest diameter in m.
        diameter: f64,
        /// Narrowest width of the vessel in m.
        width: f64,
    },
    /// A number that has no meaning.
    #[error("the {what} is {value}; it needs {need}")]
    Value {
        /// Which number.
        what: &'static str,
        /// Its value in SI units.
        value: f64,
        /// What it may be.
        need: &'static str,
    },
    /// Spheres that overlap still.
    #[error(
        "{count} spheres cannot be packed at a solid fraction of {target:.4}: shrunk until none overlap they fill {reached:.4}; \
         write a smaller solid fraction or number: equal spheres between walls reach 0.57 to 0.59, spheres of many sizes more"
    )]
    Fraction {
        /// Number of spheres.
        count: usize,
        /// Wanted solid fraction.
        target: f64,
        /// Solid fraction with the spheres shrunk until none overlap.
        reached: f64,
    },
}

pub(super) fn positive(what: &'static str, value: f64) -> Result<(), PackingError> {
    if value.is_finite() && value > 0.0 {
        return Ok(());
    }
    let need = "a number above 0";
    Err(PackingError::Value { what, value, need })
}
