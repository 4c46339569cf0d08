//! Diffusivity of a gas in the pores of a layer that a reaction leaves.

use calcine_numerics::Number;

/// Diffusivity D (T/T₀)^n of a gas in the pores of a layer.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LayerDiffusivity {
    /// D in m²/s.
    pub value: f64,
    /// T₀ in K.
    pub at: f64,
    /// n.
    pub exponent: f64,
}

impl LayerDiffusivity {
    /// (T/T₀)^n at a temperature in K.
    pub fn growth<N: Number>(&self, temperature: N) -> N {
        if self.exponent == 0.0 {
            return N::constant(1.0);
        }
        let t = temperature.value();
        let value = (t / self.at).powf(self.exponent);
        temperature.through(value, self.exponent * value / t)
    }

    /// True where another diffusivity grows alike.
    pub fn grows_like(&self, other: &Self) -> bool {
        self.at == other.at && self.exponent == other.exponent
    }
}
