//! Coulomb's limit of the tangential spring.

use super::{ContactModel, Slip, Springs};
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
/// along −ξ, which keeps the length μ |F_n|/k_t (docs/theory.md, COR-12), or along −v_t, and ξ is forgotten. The dashpot does not
/// count against the limit, as in LIGGGHTS and OpenFOAM, nor does cohesion add to F_n, as in LIGGGHTS.
///
/// Where the sum is limited, |k_t ξ + γ_t v_t| ≤ μ |F_n|; beyond it F keeps its direction and ξ = −(F + γ_t v_t)/k_t.
///
/// Source: Cundall and Strack, Géotechnique 29 (1979) 47, doi 10.1680/geot.1979.29.1.47; the limit of the sum by Luding, Granular
/// Matter 10 (2008) 235, doi 10.1007/s10035-008-0099-x.
#[inline(always)]
pub fn friction<L: ContactModel>(
    shift: Vec3,
    slip: Vec3,
    springs: &Springs,
    limit: f64,
) -> Tangential {
    let stiffness = springs.tangential_stiffness;
    if L::SLIP == Slip::SumLimited {
        return limited(shift, springs.tangential_damping * slip, stiffness, limit);
    }
    let squared = stiffness * stiffness * shift.norm_squared();
    if squared <= limit * limit {
        return Tangential {
            force: -stiffness * shift - springs.tangential_damping * slip,
            shift,
        };
    }
    if L::SLIP == Slip::SpringForgotten {
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

/// Spring and dashpot of which friction limits the sum.
#[inline(always)]
fn limited(shift: Vec3, damped: Vec3, stiffness: f64, limit: f64) -> Tangential {
    let force = -stiffness * shift - damped;
    let size = force.norm();
    if size <= limit {
        return Tangential { force, shift };
    }
    let force = limit / size * force;
    Tangential {
        force,
        shift: -(force + damped) / stiffness,
    }
}

#[cfg(test)]
mod tests {
    use super::super::{HertzMindlin, OpenfoamSpringSliderDashpot, SpringSliderDashpot};
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
        let forgotten = friction::<OpenfoamSpringSliderDashpot>(shift, slip, &SPRINGS, 0.1);
        assert!((forgotten.force - Vec3::z() * -0.1).norm() < 1e-15);
        assert_eq!(forgotten.shift, Vec3::zeros());
    }

    #[test]
    fn nothing_holds_without_friction() {
        let out = friction::<HertzMindlin>(Vec3::x() * 1e-4, Vec3::x(), &SPRINGS, 0.0);
        assert_eq!(out.force.norm(), 0.0);
        assert_eq!(out.shift.norm(), 0.0);
    }

    #[test]
    fn the_sum_of_spring_and_dashpot_is_limited_and_stays_at_the_limit_while_it_slides() {
        let slip = Vec3::x() * 0.5;
        // k ξ = 0.05 N and γ v = 1 N against 0.1 N.
        let first = friction::<SpringSliderDashpot>(Vec3::x() * 5e-5, slip, &SPRINGS, 0.1);
        assert!((first.force - Vec3::x() * -0.1).norm() < 1e-15);
        let moved = first.shift + slip * 1e-9;
        let next = friction::<SpringSliderDashpot>(moved, slip, &SPRINGS, 0.1);
        assert!((next.force - first.force).norm() < 1e-15);
        // Below the limit it is spring and dashpot.
        let slow = friction::<SpringSliderDashpot>(Vec3::x() * 5e-5, slip * 0.02, &SPRINGS, 0.1);
        assert!((slow.force - Vec3::x() * -0.07).norm() < 1e-15);
        assert_eq!(slow.shift, Vec3::x() * 5e-5);
    }
}
