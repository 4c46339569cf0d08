//! Resistance to rolling.

use super::PairConstants;
use crate::Vec3;

/// Constant directional torque: the part across the normal n of
///
/// M = −μ_r R* F ω/|ω|, F the elastic normal force, ω the rotation against the other body.
///
/// For a wall R* is the sphere's radius.
///
/// Source: Zhou, Wright, Yang, Xu, Yu, Physica A 269 (1999) 536, doi 10.1016/S0378-4371(99)00183-1;
/// model A of Ai, Chen, Rotter, Ooi 2011, doi 10.1016/j.powtec.2010.09.030.
#[inline(always)]
pub fn constant_torque(
    pair: &PairConstants,
    elastic: f64,
    radius: f64,
    rotation: Vec3,
    normal: Vec3,
) -> Vec3 {
    let speed = rotation.norm();
    if speed == 0.0 {
        return Vec3::zeros();
    }
    let torque = -pair.rolling_friction * elastic * radius / speed * rotation;
    torque - torque.dot(&normal) * normal
}

/// What the rolling spring of a contact depends on beside the pair.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RollingSpring {
    /// Normal force F_n in N, with damping but without cohesion, as in LIGGGHTS.
    pub force: f64,
    /// Secant stiffness k_n = F/δ of the normal spring in N/m.
    pub stiffness: f64,
    /// Effective radius R* in m.
    pub radius: f64,
    /// Moment of inertia about the contact in kg m²: 7/5 m R², reduced for a pair.
    pub inertia: f64,
}

/// Elastic-plastic spring and dashpot: the torque on the first sphere, given the spring's torque so far,
/// which it brings up to date; rotation across the normal in rad/s over a step in s.
///
/// k_r = 2.25 k_n (μ_r R*)², M ← M − k_r ω dt, |M| ≤ μ_r R* |F_n|; below the limit the dashpot adds
/// −2 η √(I k_r) ω
///
/// Source: Ai, Chen, Rotter, Ooi, Powder Technol. 206 (2011) 269, doi 10.1016/j.powtec.2010.09.030, model
/// C with f = 0; k_r and I as LIGGGHTS' `epsd`.
#[inline(always)]
pub fn elastic_plastic(
    pair: &PairConstants,
    spring: &RollingSpring,
    torque: &mut Vec3,
    rotation: Vec3,
    step: f64,
) -> Vec3 {
    let arm = pair.rolling_friction * spring.radius;
    let stiffness = 2.25 * spring.stiffness * arm * arm;
    *torque -= stiffness * step * rotation;
    let limit = spring.force.abs() * arm;
    let squared = torque.norm_squared();
    if squared > limit * limit {
        *torque *= limit / squared.sqrt();
        return *torque;
    }
    *torque - 2.0 * pair.rolling_damping * (spring.inertia * stiffness).sqrt() * rotation
}

#[cfg(test)]
mod tests {
    use super::super::glass;
    use super::*;

    #[test]
    fn the_constant_torque_opposes_rolling_and_leaves_spin_about_the_normal() {
        let pair = glass(0.5);
        let torque = constant_torque(&pair, 2.0, 1e-3, Vec3::x() * 7.0, Vec3::z());
        assert!((torque - Vec3::x() * -2e-4).norm() < 1e-18);
        assert_eq!(
            constant_torque(&pair, 2.0, 1e-3, Vec3::z(), Vec3::z()).norm(),
            0.0
        );
        assert_eq!(
            constant_torque(&pair, 2.0, 1e-3, Vec3::zeros(), Vec3::z()).norm(),
            0.0
        );
    }

    #[test]
    fn the_spring_yields_at_its_limit_and_damps_below_it() {
        let pair = glass(0.5);
        let spring = RollingSpring {
            force: 2.0,
            stiffness: 1e5,
            radius: 1e-3,
            inertia: 1e-9,
        };
        // μ_r R* = 1e-4 m, k_r = 2.25e5 · 1e-8 = 2.25e-3 N m/rad
        let mut torque = Vec3::zeros();
        let total = elastic_plastic(&pair, &spring, &mut torque, Vec3::y(), 1e-3);
        assert!((torque.y / -2.25e-6 - 1.0).abs() < 1e-14);
        // 2 · 0.3 √(1e-9 · 2.25e-3) = 9e-7
        assert!((total.y / -(2.25e-6 + 9e-7) - 1.0).abs() < 1e-12);
        let total = elastic_plastic(&pair, &spring, &mut torque, Vec3::y() * 1e3, 1e-3);
        assert!((total.y / -2e-4 - 1.0).abs() < 1e-14);
        assert_eq!(total, torque);
    }
}
