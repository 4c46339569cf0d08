//! Forces of spheres in contact, one law a file.
//!
//! Signs: the normal n points from the other body to the sphere; the normal force is positive where it
//! pushes them apart; v_n = (v − v_other)·n is negative while they approach.

mod cohesion;
mod friction;
mod hertz_mindlin;
mod jkr;
mod linear;
mod linear_springs;
mod rolling;
mod spring_slider_dashpot;
pub mod time_step;

pub use cohesion::{CohesionArea, sjkr};
pub use friction::{Tangential, friction};
pub use hertz_mindlin::HertzMindlin;
pub use jkr::{AdhesiveContact, jkr, tear_off_distance, tear_off_energy};
pub use linear::Linear;
pub use linear_springs::LinearSprings;
pub use rolling::{RollingSpring, constant_torque, elastic_plastic};
pub use spring_slider_dashpot::{OpenfoamSpringSliderDashpot, SpringSliderDashpot};

/// What the contact of two materials needs, worked out once per pair.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PairConstants {
    /// Effective Young's modulus E* in Pa, 1/E* = (1 − ν₁²)/E₁ + (1 − ν₂²)/E₂.
    pub young: f64,
    /// Effective shear modulus G* in Pa, 1/G* = 2(2 − ν₁)(1 + ν₁)/E₁ + 2(2 − ν₂)(1 + ν₂)/E₂.
    pub shear: f64,
    /// √(k_t/S_n) = √(4 G*/E*) of Hertz' and Mindlin's springs.
    pub stiffness_root: f64,
    /// Damping ratio β = −ln e/√(ln² e + π²) of the restitution e; 0 for e = 1.
    pub damping: f64,
    /// Coefficient of sliding friction.
    pub friction: f64,
    /// Coefficient of rolling friction.
    pub rolling_friction: f64,
    /// Damping of rolling as a share of the critical one.
    pub rolling_damping: f64,
    /// Cohesion energy density in J/m³.
    pub cohesion_energy: f64,
    /// Work of adhesion in J/m².
    pub work_of_adhesion: f64,
}

impl PairConstants {
    /// Elastic and damping constants of two materials, each given by Young's modulus in Pa and Poisson's
    /// ratio, and their restitution; friction, rolling friction, cohesion and adhesion are zero.
    pub fn new(first: [f64; 2], second: [f64; 2], restitution: f64) -> Self {
        let [young, poisson] = [0, 1].map(|i| [first[i], second[i]]);
        let normal = |i: usize| (1.0 - poisson[i] * poisson[i]) / young[i];
        let shear = |i: usize| 2.0 * (2.0 - poisson[i]) * (1.0 + poisson[i]) / young[i];
        let log = restitution.ln();
        let (young, shear) = (1.0 / (normal(0) + normal(1)), 1.0 / (shear(0) + shear(1)));
        Self {
            young,
            shear,
            stiffness_root: (4.0 * shear / young).sqrt(),
            damping: -log / (log * log + std::f64::consts::PI.powi(2)).sqrt(),
            friction: 0.0,
            rolling_friction: 0.0,
            rolling_damping: 0.0,
            cohesion_energy: 0.0,
            work_of_adhesion: 0.0,
        }
    }
}

/// Springs and dashpots of a contact at an overlap δ.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Springs {
    /// Elastic normal force in N.
    pub elastic: f64,
    /// Energy in the normal spring in J.
    pub energy: f64,
    /// Normal damping in kg/s; the damping force is −γ v_n.
    pub normal_damping: f64,
    /// Tangential stiffness in N/m.
    pub tangential_stiffness: f64,
    /// Tangential damping in kg/s.
    pub tangential_damping: f64,
}

/// What friction limits, and what becomes of the tangential spring as a contact slips.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Slip {
    /// The spring alone, which keeps the length that friction can hold (docs/theory.md, COR-12).
    SpringKept,
    /// The spring alone, which is forgotten; the force then acts against the velocity of slip (docs/theory.md, COR-13).
    SpringForgotten,
    /// Spring and dashpot together; the spring keeps what makes the next sum that limit (docs/theory.md, COR-13).
    SumLimited,
}

/// A law of the force between two spheres in contact; a flat wall is a sphere of endless radius and mass.
pub trait ContactModel: Copy + Send + Sync {
    /// What friction limits, and what becomes of the tangential spring as the contact slips.
    const SLIP: Slip;

    /// A value of the pair of spheres that does not change with their overlap: effective radius R* =
    /// R₁R₂/(R₁ + R₂) in m, effective mass m* = m₁m₂/(m₁ + m₂) in kg.
    fn prepare(&self, _pair: &PairConstants, _radius: f64, _mass: f64) -> f64 {
        0.0
    }

    /// Springs and dashpots at an overlap in m, with the value that `prepare` gave.
    fn springs(
        &self,
        pair: &PairConstants,
        prepared: f64,
        overlap: f64,
        radius: f64,
        mass: f64,
    ) -> Springs;
}

#[cfg(test)]
pub(crate) fn glass(restitution: f64) -> PairConstants {
    PairConstants {
        friction: 0.3,
        rolling_friction: 0.1,
        rolling_damping: 0.3,
        cohesion_energy: 1000.0,
        ..PairConstants::new([1e7, 0.25], [1e7, 0.25], restitution)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_damping_ratio_is_the_published_one() {
        // docs/theory.md, COR-12 prints α = √5 β.
        for (restitution, alpha) in [(0.9, 0.074_949_5), (0.8, 0.158_426), (0.5, 0.481_769)] {
            let beta = glass(restitution).damping;
            assert!((5f64.sqrt() * beta / alpha - 1.0).abs() < 2e-6, "{beta}");
        }
        assert_eq!(glass(1.0).damping, 0.0);
    }

    #[test]
    fn the_moduli_of_equal_materials_are_those_of_openfoam() {
        // E* = E/(2(1 − ν²)) and G* = G/(2(2 − ν)) with G = E/(2(1 + ν)) (docs/theory.md, COR-13).
        let pair = glass(0.9);
        assert!((pair.young / (1e7 / (2.0 * 0.9375)) - 1.0).abs() < 1e-15);
        assert!((pair.shear / (4e6 / (2.0 * 1.75)) - 1.0).abs() < 1e-15);
        // steel 210 GPa, 0.3 against aluminium 70 GPa, 0.33
        let mixed = PairConstants::new([210e9, 0.3], [70e9, 0.33], 0.5);
        assert!(
            (mixed.young / 5.860_519_63e10 - 1.0).abs() < 1e-6,
            "{}",
            mixed.young
        );
        assert!(
            (mixed.shear / 1.183_325_26e10 - 1.0).abs() < 1e-6,
            "{}",
            mixed.shear
        );
    }
}
