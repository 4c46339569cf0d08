//! Radiation between particles, and what the gas does to it.

mod distance;
mod gas;
mod sphere;

pub use distance::{visibility, wall_visibility};
pub use gas::{GasRadiation, TransparentGas};
pub use sphere::{SphereTable, element_to_sphere, sphere_to_sphere};

/// Stefan and Boltzmann's constant σ in W/m²/K⁴ (CODATA 2018, exact digits cut).
pub const STEFAN_BOLTZMANN: f64 = 5.670_374_419e-8;

/// The conductance in W/m²/K that turns a difference of temperatures in K into a difference of black
/// radiation, exactly: h (T₁ − T₂) = σ (T₁⁴ − T₂⁴).
pub fn linear(first: f64, second: f64) -> f64 {
    STEFAN_BOLTZMANN * (first * first + second * second) * (first + second)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_linear_form_gives_the_difference_of_fourth_powers() {
        for (a, b) in [(300.0_f64, 1500.0_f64), (1000.0, 999.0), (700.0, 700.0)] {
            let exact = STEFAN_BOLTZMANN * (a.powi(4) - b.powi(4));
            assert!((linear(a, b) * (a - b) - exact).abs() <= 1e-12 * exact.abs());
        }
        // 4 σ T³ at 1000 K
        assert!((linear(1000.0, 1000.0) / 226.814_976_76 - 1.0).abs() < 1e-12);
    }
}
