//! What a law of conversion is.

/// The share of a solid below which its rate ends along a line.
pub const TRACE: f64 = 1e-9;

/// f(w) of a law and its derivative.
pub trait ConversionLaw {
    /// f(w) and df/dw at a share w of the solid that is left, above zero.
    fn of(&self, left: f64) -> [f64; 2];
}
