//! Coulomb's limit of the tangential spring.

use super::{ContactModel, Springs};
use crate::Vec3;

/// What a tangential spring does in a step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tangential {
    /// Force on the first sphere in N.
    pub force: Vec3,
    /// The spring's elongation afterwards in m.
    pub shift: Vec3,
}

/// Force of the tangential spring of elongation ξ at a slip velocity v_t, limited by friction.
///
/// F = −k_t ξ − γ_t v_t where k_t |ξ| ≤ μ |F_n|; beyond it the contact slips with |F| = μ |F_n|:
/// along −ξ, which keeps the length μ |F_n|/k_t (docs/theory.md, COR-12), or along −v_t, and ξ is forgotten
/// (docs/theory.md, COR-13). The dashpot does not count against the limit, as in LIGGGHTS and OpenFOAM, nor does
/// cohesion add to F_n, as in LIGGGHTS.
///
/// Source: Cundall and Strack, Géotechnique 29 (1979) 47, doi 10.1680/geot.1979.29.1.47.
#[inline(always)]
pub fn friction<L: ContactModel>(
    shift: Vec3,
    slip: Vec3,
    springs: &Springs,
    limit: f64,
) -> Tangential {
    let stiffness = springs.tangential_stiffness;
    let squared = stiffness * stiffness * shift.norm_squared();
    if squared <= limit * limit {
        return Tangential {
            force: -stiffness * shift - springs.tangential_damping * slip,
            shift,
        };
    }
    if L::FORGETS_ON_SLIP {
        let speed = slip.norm();
        let direction = if speed > 0.0 {
            slip / speed
        } else {
            shift.normalize()
        };
        return Tangential {
            force: -limit * direction,
            shift: Vec3::zeros(),
        };
    }
    let kept = limit / squared.sqrt() * shift;
    Tangential {
        force: -stiffness * kept,
        shift: kept,
    }
}

#[cfg(test)]
mod tests {
    use super::super::{HertzMindlin, SpringSliderDashpot};
    use super::*;

    const SPRINGS: Springs = Springs {
        elastic: 1.0,
        energy: 0.0,
        normal_damping: 0.0,
        tangential_stiffness: 1000.0,
        tangential_damping: 2.0,
    };

    #[test]
    fn sticks_below_the_limit_with_spring_and_dashpot() {
        let out = friction::<HertzMindlin>(Vec3::x() * 1e-4, Vec3::y() * 0.01, &SPRINGS, 0.11);
        assert!((out.force - Vec3::new(-0.1, -0.02, 0.0)).norm() < 1e-15);
        assert_eq!(out.shift, Vec3::x() * 1e-4);
    }

    #[test]
    fn slips_at_the_limit_along_the_spring_or_against_the_velocity() {
        let (shift, slip) = (Vec3::new(3e-4, 4e-4, 0.0), Vec3::z() * 0.5);
        let kept = friction::<HertzMindlin>(shift, slip, &SPRINGS, 0.1);
        assert!((kept.force - Vec3::new(-0.06, -0.08, 0.0)).norm() < 1e-15);
        assert!((kept.shift - Vec3::new(6e-5, 8e-5, 0.0)).norm() < 1e-18);
        let forgotten = friction::<SpringSliderDashpot>(shift, slip, &SPRINGS, 0.1);
        assert!((forgotten.force - Vec3::z() * -0.1).norm() < 1e-15);
        assert_eq!(forgotten.shift, Vec3::zeros());
    }

    #[test]
    fn nothing_holds_without_friction() {
        let out = friction::<HertzMindlin>(Vec3::x() * 1e-4, Vec3::x(), &SPRINGS, 0.0);
        assert_eq!(out.force.norm(), 0.0);
        assert_eq!(out.shift.norm(), 0.0);
    }
}
