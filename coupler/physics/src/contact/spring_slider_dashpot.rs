//! Spring, slider and dashpot, limited as Coulomb says or as OpenFOAM does.

use super::hertz_mindlin::DAMPING;
use super::{ContactModel, PairConstants, Slip, Springs};

/// The springs and dashpots of OpenFOAM's `pairSpringSliderDashpot` with b = 1.5, their tangential force limited by friction.
///
/// k_N = 4/3 E* √R*, F = k_N δ^1.5, η_N = α √(m* k_N) δ^¼ with α = √5 β, k_T = 8 G* √(R* δ), η_T = η_N, |k_T ξ + η_T v_t| ≤ μ |F_n|
/// (docs/theory.md, COR-13)
///
/// It differs from `HertzMindlin` in the tangential damping, and in that friction limits spring and dashpot together.
///
/// Source: OpenFOAM 6, `PairSpringSliderDashpot.C`; Tsuji, Tanaka, Ishida, Powder Technol. 71 (1992) 239,
/// doi 10.1016/0032-5910(92)88030-L; limit of the sum by Luding, Granular Matter 10 (2008) 235, doi 10.1007/s10035-008-0099-x.
#[derive(Clone, Copy, Debug)]
pub struct SpringSliderDashpot;

/// The same as OpenFOAM has it: friction limits the spring alone, and slip forgets it.
///
/// The friction of a contact that slides then depends on the time step: after each slip the spring begins anew, and the dashpot, which
/// nothing limits, acts until it has grown. With small steps that is more than μ |F_n| where it slides fast, and less where it slides
/// slowly.
///
/// Source: OpenFOAM 6, `PairSpringSliderDashpot.C`.
#[derive(Clone, Copy, Debug)]
pub struct OpenfoamSpringSliderDashpot;

/// Springs and dashpots of both.
#[inline(always)]
fn springs(pair: &PairConstants, overlap: f64, radius: f64, mass: f64) -> Springs {
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

impl ContactModel for SpringSliderDashpot {
    const SLIP: Slip = Slip::SumLimited;

    #[inline(always)]
    fn springs(
        &self,
        pair: &PairConstants,
        _prepared: f64,
        overlap: f64,
        radius: f64,
        mass: f64,
    ) -> Springs {
        springs(pair, overlap, radius, mass)
    }
}

impl ContactModel for OpenfoamSpringSliderDashpot {
    const SLIP: Slip = Slip::SpringForgotten;

    #[inline(always)]
    fn springs(
        &self,
        pair: &PairConstants,
        _prepared: f64,
        overlap: f64,
        radius: f64,
        mass: f64,
    ) -> Springs {
        springs(pair, overlap, radius, mass)
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
