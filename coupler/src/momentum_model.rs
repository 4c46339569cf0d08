//! How gas and particles share their momentum: models A and B, named here and nowhere else
//! (docs/theory.md, DRG-1).
//!
//! With the drag coefficient K_A of the laws, the weights W of mapping and smoother, and α = 1 − ε:
//!
//! | | gas, per volume | particle |
//! |---|---|---|
//! | A | −ε ∇p + ε ρ g − Σ W K_A (u − v)/V | m g − V_p Wᵀ∇p + K_A (u − v) |
//! | B | −∇p + ρ g − Σ W (K_A/ε) (u − v)/V | (m − ρ V_p) g + (K_A/ε) (u − v) |
//!
//! Both sum to −∇p + ε ρ g + α ρ_s g of the mixture. In a uniform steady bed A's −∇p is
//! −ρ g + n K_A (u − v)/ε with n V_p = α, so that the particle's acceleration is the same: K_A (1 + α/ε) =
//! K_A/ε. Where the gas accelerates they differ by V_p ρ Du/Dt, which only A gives the particle.

use calcine_physics::Vec3;

/// Model A or B.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum MomentumModel {
    /// The pressure gradient acts on both, each by its share of the volume.
    #[default]
    A,
    /// The pressure gradient acts on the gas alone; a particle is as much lighter as what it displaces.
    B,
}

impl MomentumModel {
    /// The name in a case file.
    pub fn name(self) -> &'static str {
        match self {
            Self::A => "a",
            Self::B => "b",
        }
    }

    /// Share of −∇p and ρ g that the gas of a cell with this void fraction takes.
    #[inline]
    pub fn pressure_share(self, void_fraction: f64) -> f64 {
        match self {
            Self::A => void_fraction,
            Self::B => 1.0,
        }
    }

    /// The coefficient in kg/s that multiplies the slip, of a law's K_A at the void fraction that the
    /// particle sees.
    #[inline]
    pub fn coefficient(self, drag: f64, void_fraction: f64) -> f64 {
        match self {
            Self::A => drag,
            Self::B => drag / void_fraction,
        }
    }

    /// What the gas does to a particle of this volume in m³ besides drag, in N: of the pressure gradient in
    /// Pa/m that the particle sees, or of the weight in N/m³ of the gas that it displaces.
    #[inline]
    pub fn pressure_force(self, volume: f64, gradient: Vec3, weight: Vec3) -> Vec3 {
        match self {
            Self::A => -volume * gradient,
            Self::B => -volume * weight,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_particle_in_a_uniform_steady_bed_is_pushed_alike_by_both() {
        let (pores, volume, drag, slip) = (0.4, 4e-9, 2e-5, Vec3::new(0.1, 0.0, 0.3));
        let weight = Vec3::new(0.0, 0.0, -9.81 * 998.0);
        let number = (1.0 - pores) / volume;
        // The gas of model A at rest: ε ∇p = ε ρ g − n K_A (u − v).
        let gradient = weight - number * drag / pores * slip;
        let on = |model: MomentumModel| {
            model.pressure_force(volume, gradient, weight) + model.coefficient(drag, pores) * slip
        };
        let (a, b) = (on(MomentumModel::A), on(MomentumModel::B));
        assert!((a - b).norm() < 1e-14 * a.norm(), "{a} {b}");
        // By hand: 4e-9 m³ of 9790.38 N/m³, and 2e-5 kg/s / 0.4 of 0.3 m/s.
        assert!((b.z - (3.916_152e-5 + 1.5e-5)).abs() < 1e-15, "{b}");
    }

    #[test]
    fn gas_and_particles_of_a_cell_take_the_whole_pressure_gradient() {
        let (pores, cell) = (0.55, 1e-6);
        let gradient = Vec3::new(0.0, 0.0, -400.0);
        let particles =
            MomentumModel::A.pressure_force((1.0 - pores) * cell, gradient, Vec3::zeros());
        let gas = -MomentumModel::A.pressure_share(pores) * cell * gradient;
        assert!((gas + particles + cell * gradient).norm() < 1e-18);
        assert_eq!(MomentumModel::B.pressure_share(pores), 1.0);
    }
}
