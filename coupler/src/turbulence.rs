//! Eddies of the gas, as a case states them.

use calcine_physics::turbulence::{KEpsilon, energy_of_intensity};

/// Solid fraction above which a cell belongs to the bed, where eddies are those of a law for porous media, or neither
/// made nor carry anything (docs/theory.md, FLO-2).
pub const BED: f64 = 0.1;

/// True where a cell of this void fraction is free of the bed.
#[inline]
pub fn is_free(void_fraction: f64) -> bool {
    1.0 - void_fraction <= BED
}

/// Eddies of the gas.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Turbulence {
    /// None.
    #[default]
    Laminar,
    /// The standard k-epsilon model ([`KEpsilon::STANDARD`]), with wall functions outside the bed.
    KEpsilon {
        /// k at the start in m²/s².
        energy: f64,
        /// Length scale of the eddies at the start in m, see [`KEpsilon::dissipation`].
        length_scale: f64,
        /// Turbulent Prandtl number: eddies carry heat with c_p μ_t/Pr_t.
        prandtl: f64,
        /// Turbulent Schmidt number: eddies carry species with μ_t/Sc_t.
        schmidt: f64,
        /// Iterations of the linear solver of k and of ε_t at most.
        iterations: u32,
        /// True where eddies go on in the bed: the exchange then tells what its particles make of them.
        in_bed: bool,
    },
}

impl Turbulence {
    /// True where there are no eddies.
    pub fn is_laminar(&self) -> bool {
        matches!(self, Self::Laminar)
    }

    /// True where eddies go on in the bed.
    pub fn is_in_bed(&self) -> bool {
        matches!(self, Self::KEpsilon { in_bed: true, .. })
    }

    /// True where a cell of this void fraction has eddies that are made and carry something.
    #[inline]
    pub fn reaches(&self, void_fraction: f64) -> bool {
        match self {
            Self::Laminar => false,
            Self::KEpsilon { in_bed, .. } => *in_bed || is_free(void_fraction),
        }
    }
}

/// Eddies in the gas that flows in.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct InletTurbulence {
    /// Root mean square of one component's fluctuation over the mean (interstitial) speed.
    pub intensity: f64,
    /// Length scale in m, see [`KEpsilon::dissipation`].
    pub length_scale: f64,
}

impl InletTurbulence {
    /// k in m²/s² and ε in m²/s³ at an interstitial speed in m/s.
    pub fn state(&self, speed: f64) -> [f64; 2] {
        let energy = energy_of_intensity(self.intensity, speed);
        let dissipation = KEpsilon::STANDARD.dissipation(energy, self.length_scale);
        [energy, dissipation]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_tenth_of_solids_is_the_last_that_is_free_of_the_bed() {
        assert!(is_free(0.9001) && !is_free(0.8995));
    }
}
