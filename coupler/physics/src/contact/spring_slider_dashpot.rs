//! OpenFOAM's pair of spring, slider and dashpot.

use super::hertz_mindlin::DAMPING;
use super::{ContactModel, PairConstants, Springs};

/// OpenFOAM's `pairSpringSliderDashpot` with b = 1.5.
///
/// k_N = 4/3 E* √R*, F = k_N δ^1.5, η_N = α √(m* k_N) δ^¼ with α = √5 β, k_T = 8 G* √(R* δ), η_T = η_N
/// (docs/theory.md, COR-13)
///
/// It differs from `HertzMindlin` in the tangential damping, and in that slip forgets the tangential
/// spring and acts against the slip's velocity.
///
/// Source: OpenFOAM 6, `PairSpringSliderDashpot.C`; Tsuji, Tanaka, Ishida, Powder Technol. 71 (1992) 239,
/// doi 10.1016/0032-5910(92)88030-L.
#[derive(Clone, Copy, Debug)]
pub struct SpringSliderDashpot;

impl ContactModel for SpringSliderDashpot {
    const FORGETS_ON_SLIP: bool = true;

    #[inline(always)]
    fn springs(
        &self,
        pair: &PairConstants,
        _prepared: f64,
        overlap: f64,
        radius: f64,
        mass: f64,
    ) -> Springs {
        let contact_radius = (radius * overlap).sqrt();
        let normal = 2.0 * pair.young * contact_radius;
        let elastic = 2.0 / 3.0 * normal * overlap;
        let damping = DAMPING * pair.damping * (normal * mass).sqrt();
        Springs {
            elastic,
            energy: 0.4 * elastic * overlap,
            normal_damping: damping,
            tangential_stiffness: 8.0 * pair.shear * contact_radius,
            tangential_damping: damping,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::glass;
    use super::*;

    #[test]
    fn agrees_with_openfoams_formula() {
        let (pair, overlap, radius, mass) = (glass(0.8), 2e-6f64, 1.5e-3f64, 3e-5f64);
        let stiffness = 4.0 / 3.0 * pair.young * radius.sqrt();
        // α = 0.158426 for e = 0.8 (docs/theory.md, COR-12)
        let damping = 0.158_426 * (mass * stiffness).sqrt() * overlap.powf(0.25);
        let s = SpringSliderDashpot.springs(&pair, 0.0, overlap, radius, mass);
        assert!((s.elastic / (stiffness * overlap.powf(1.5)) - 1.0).abs() < 1e-14);
        assert!((s.normal_damping / damping - 1.0).abs() < 5e-6);
        assert_eq!(s.tangential_damping, s.normal_damping);
        let tangential = 8.0 * (radius * overlap).sqrt() * pair.shear;
        assert!((s.tangential_stiffness / tangential - 1.0).abs() < 1e-14);
    }
}
