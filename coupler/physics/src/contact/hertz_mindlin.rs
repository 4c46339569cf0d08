//! Hertz, Mindlin and Tsuji.

use super::{ContactModel, PairConstants, Slip, Springs};

/// Elastic spheres with a tangential spring and a damping that makes the restitution independent of the
/// speed of impact.
///
/// S_n = 2 E* √(R* δ), F = ⅔ S_n δ (that is 4/3 E* √R* δ^1.5), γ_n = 2 √(5/6) β √(S_n m*),
/// k_t = 8 G* √(R* δ), γ_t = 2 √(5/6) β √(k_t m*) (docs/theory.md, COR-12)
///
/// γ_n is Tsuji's α √(m* k) δ^¼ with α = √5 β. The tangential spring keeps μ |F_n| when it slips.
///
/// Validity: overlaps small against the radii; no plastic flow.
///
/// Source: Tsuji, Tanaka, Ishida, Powder Technol. 71 (1992) 239, doi 10.1016/0032-5910(92)88030-L;
/// β by Antypov and Elliott, EPL 94 (2011) 50004, doi 10.1209/0295-5075/94/50004.
#[derive(Clone, Copy, Debug)]
pub struct HertzMindlin;

/// 2 √(5/6).
pub(super) const DAMPING: f64 = 1.825_741_858_350_553_6;

impl ContactModel for HertzMindlin {
    const SLIP: Slip = Slip::SpringKept;

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
        let tangential = 8.0 * pair.shear * contact_radius;
        let elastic = 2.0 / 3.0 * normal * overlap;
        let damping = DAMPING * pair.damping * (normal * mass).sqrt();
        Springs {
            elastic,
            energy: 0.4 * elastic * overlap,
            normal_damping: damping,
            tangential_stiffness: tangential,
            tangential_damping: pair.stiffness_root * damping,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::glass;
    use super::*;

    #[test]
    fn agrees_with_an_independent_evaluation() {
        // By hand for E* = 5.3333333e6, G* = 1.1428571e6, R* = 1e-3, δ = 1e-6, m* = 1e-5, e = 0.5
        // (β = 0.21545376): √(R*δ) = 3.1622777e-5, S_n = 337.30962.
        let s = HertzMindlin.springs(&glass(0.5), 0.0, 1e-6, 1e-3, 1e-5);
        let near =
            |value: f64, wanted: f64| assert!((value / wanted - 1.0).abs() < 1e-6, "{value}");
        near(s.elastic, 2.248_730_8e-4);
        near(s.energy, 8.994_923e-11);
        near(s.normal_damping, 0.022_845_876);
        near(s.tangential_stiffness, 289.122_54);
        near(s.tangential_damping, 0.021_151_171);
    }

    #[test]
    fn the_force_is_the_slope_of_the_energy() {
        let at = |overlap| HertzMindlin.springs(&glass(0.5), 0.0, overlap, 1e-3, 1e-5);
        let slope = (at(1.001e-6).energy - at(0.999e-6).energy) / 2e-9;
        assert!((slope / at(1e-6).elastic - 1.0).abs() < 1e-6);
    }
}
