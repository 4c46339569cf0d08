//! The standard k-epsilon model.

/// Two quantities stand for the eddies: their energy k in m²/s² and its dissipation ε in m²/s³ (docs/theory.md,
/// COR-15), with
///
/// ν_t = C_μ k²/ε,
/// dk/dt = ν_t P − ε − ⅔ k ∇·u + ∇·(ν + ν_t/σ_k)∇k,
/// dε/dt = C₁ C_μ k P − C₂ ε²/k − ⅔ C₁ ε ∇·u + ∇·(ν + ν_t/σ_ε)∇ε,   P = ∇u : (∇u + ∇uᵀ − ⅔ ∇·u).
///
/// Range: flows of a high Reynolds number away from walls, no strong swirl or separation. Launder and
/// Spalding 1974, doi 10.1016/0045-7825(74)90029-2, for constant density; the terms of ∇·u as in OpenFOAM's model.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct KEpsilon {
    /// C_μ of the eddy viscosity.
    pub viscosity: f64,
    /// C₁ of the production of ε.
    pub production: f64,
    /// C₂ of the destruction of ε.
    pub destruction: f64,
    /// σ_k, the Prandtl number of k.
    pub energy_prandtl: f64,
    /// σ_ε, the Prandtl number of ε.
    pub dissipation_prandtl: f64,
}

impl KEpsilon {
    /// The constants of Launder and Spalding 1974, table 2.1.
    pub const STANDARD: Self = Self {
        viscosity: 0.09,
        production: 1.44,
        destruction: 1.92,
        energy_prandtl: 1.0,
        dissipation_prandtl: 1.3,
    };

    /// Eddy viscosity ν_t in m²/s of k in m²/s² and ε in m²/s³; none where there is no energy.
    #[inline]
    pub fn eddy_viscosity(&self, energy: f64, dissipation: f64) -> f64 {
        if energy > 0.0 {
            self.viscosity * energy * energy / dissipation
        } else {
            0.0
        }
    }

    /// ε in m²/s³ of k in m²/s² in eddies of a length scale in m: C_μ^¾ k^(3/2)/L.
    #[inline]
    pub fn dissipation(&self, energy: f64, length_scale: f64) -> f64 {
        self.viscosity.powf(0.75) * energy * energy.sqrt() / length_scale
    }

    /// k in m²/s² after a time in s without production or transport: k₀ (1 + (C₂ − 1) ε₀ t/k₀)^(−1/(C₂ − 1)).
    pub fn decayed(&self, energy: f64, dissipation: f64, time: f64) -> f64 {
        let exponent = self.destruction - 1.0;
        energy * (1.0 + exponent * dissipation * time / energy).powf(-1.0 / exponent)
    }
}

/// k in m²/s² of an intensity (root mean square of one component's fluctuation over the mean speed) at a mean
/// speed in m/s: 3/2 (I U)².
#[inline]
pub fn energy_of_intensity(intensity: f64, speed: f64) -> f64 {
    1.5 * (intensity * speed).powi(2)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_constants_are_those_of_the_paper() {
        let KEpsilon {
            viscosity,
            production,
            destruction,
            energy_prandtl,
            dissipation_prandtl,
        } = KEpsilon::STANDARD;
        assert_eq!(
            [
                viscosity,
                production,
                destruction,
                energy_prandtl,
                dissipation_prandtl
            ],
            [0.09, 1.44, 1.92, 1.0, 1.3]
        );
    }

    #[test]
    fn the_eddy_viscosity_of_a_length_scale_agrees_with_an_independent_evaluation() {
        // C_μ^¼ √k L, with 0.09^0.25 = 0.547722557505166.
        let model = KEpsilon::STANDARD;
        let dissipation = model.dissipation(0.25, 0.02);
        assert!((dissipation / 1.026_979_795_322_186 - 1.0).abs() < 1e-12);
        let found = model.eddy_viscosity(0.25, dissipation);
        assert!((found / (0.547_722_557_505_166 * 0.5 * 0.02) - 1.0).abs() < 1e-12);
        assert_eq!(model.eddy_viscosity(0.0, 0.0), 0.0);
    }

    #[test]
    fn decay_starts_with_the_dissipation_and_follows_its_power_of_time() {
        let model = KEpsilon::STANDARD;
        let slope = (model.decayed(2.0, 5.0, 1e-6) - 2.0) / 1e-6;
        assert!((slope / -5.0 - 1.0).abs() < 1e-5);
        let late = model.decayed(2.0, 5.0, 2e6) / model.decayed(2.0, 5.0, 1e6);
        assert!((late - 2f64.powf(-1.0 / 0.92)).abs() < 1e-6);
    }

    #[test]
    fn five_percent_at_ten_metres_a_second_are_0_375() {
        assert!((energy_of_intensity(0.05, 10.0) - 0.375).abs() < 1e-15);
    }
}
