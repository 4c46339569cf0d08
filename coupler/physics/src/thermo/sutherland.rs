//! Sutherland 1893.

use calcine_numerics::Lanes;

/// Viscosity of a gas of molecules that attract each other weakly.
///
/// μ = A √T/(1 + S/T), A in kg/m/s/K^½, S in K (docs/theory.md, COR-7).
///
/// Conversion: with a reference viscosity μ₀ at T₀, A = μ₀ (1 + S/T₀)/√T₀.
///
/// Validity: the range of the fit; non-polar gases within some 2 % over a factor of five in T.
///
/// Source: Sutherland, Philos. Mag. 36 (1893) 507, doi 10.1080/14786449308620508.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sutherland {
    /// A in kg/m/s/K^½.
    pub coefficient: f64,
    /// S in K.
    pub temperature: f64,
}

impl Sutherland {
    /// Dynamic viscosity in Pa s at a temperature in K.
    pub fn viscosity(&self, temperature: f64) -> f64 {
        self.coefficient * temperature.sqrt() / (1.0 + self.temperature / temperature)
    }

    /// μ in Pa s at temperatures in K side by side.
    #[inline(always)]
    pub fn lanes<const N: usize>(&self, temperature: Lanes<N>) -> Lanes<N> {
        let below = temperature.inverse() * self.temperature + 1.0;
        temperature.sqrt() * self.coefficient / below
    }

    /// dμ/dT in Pa s/K: μ/T · (½ + S/(T + S)).
    pub fn slope(&self, temperature: f64) -> f64 {
        let s = self.temperature;
        self.viscosity(temperature) / temperature * (0.5 + s / (temperature + s))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Air, docs/theory.md, COR-7.
    const AIR: Sutherland = Sutherland {
        coefficient: 1.4792e-6,
        temperature: 116.0,
    };

    #[test]
    fn agrees_with_an_independent_evaluation() {
        // In Python: 1.4792e-6·20/(1 + 0.29).
        assert!((AIR.viscosity(400.0) / 2.293_333_333_333e-5 - 1.0).abs() < 1e-12);
    }

    #[test]
    fn the_slope_is_the_difference_quotient() {
        for t in [200.0, 300.0, 1000.0, 3000.0] {
            let step = 1e-3 * t;
            let quotient = (AIR.viscosity(t + step) - AIR.viscosity(t - step)) / (2.0 * step);
            // The quotient's own error is of the order of (1e-3)².
            assert!((AIR.slope(t) / quotient - 1.0).abs() < 1e-6, "{t}");
        }
    }

    #[test]
    fn hot_gas_goes_with_the_root_of_the_temperature() {
        let ratio = AIR.viscosity(4e9) / AIR.viscosity(1e9);
        assert!((ratio - 2.0).abs() < 1e-6, "{ratio}");
    }
}
