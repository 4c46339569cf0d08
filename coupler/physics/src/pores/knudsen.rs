//! Diffusion of a gas whose molecules meet walls.

use std::f64::consts::PI;

use calcine_numerics::Lanes;

use crate::gas::GAS_CONSTANT;

/// Diffusivity in m²/s of a gas in a straight pore so narrow that its molecules meet walls and hardly each other,
///
/// D_K = d/3 √(8 R T/(π M)).
///
/// Source: Knudsen, Ann. Phys. 333 (1909) 75, doi 10.1002/andp.19093330106.
pub fn diffusivity(pore_diameter: f64, temperature: f64, molar_mass: f64) -> f64 {
    pore_diameter / 3.0 * (8.0 * GAS_CONSTANT * temperature / (PI * molar_mass)).sqrt()
}

/// The same from the roots of temperatures side by side, in K^½.
#[inline(always)]
pub fn lanes<const N: usize>(pore_diameter: f64, root: Lanes<N>, molar_mass: f64) -> Lanes<N> {
    root * (pore_diameter / 3.0 * (8.0 * GAS_CONSTANT / (PI * molar_mass)).sqrt())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn agrees_with_an_independent_evaluation() {
        // 1e-7/3 · √(8 · 8.314462618 · 1150/(π · 0.0440095)) in Python.
        let found = diffusivity(1e-7, 1150.0, 0.044_009_5);
        assert!((found / 2.479_371_460_8e-5 - 1.0).abs() < 1e-7, "{found:e}");
        let beside = lanes(1e-7, Lanes([1150.0_f64.sqrt()]), 0.044_009_5);
        assert!((beside[0] / found - 1.0).abs() < 1e-14);
    }
}
