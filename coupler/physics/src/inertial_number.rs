//! How far a granular flow is from quasi-static.

/// Inertial number of a sheared granular bed.
///
/// I = γ̇ d √(ρ_s/P): the time in which pressure P pushes a particle of diameter d and density ρ_s back into
/// its place, over the time 1/γ̇ of the shear. Below about 1e-3 a bed moves quasi-statically: its motion is
/// the same at any pace; above about 0.1 collisions rule. Without pressure it is infinite where there is shear.
///
/// Units: shear rate γ̇ in 1/s, diameter in m, density in kg/m³, pressure in Pa.
///
/// Source: GDR MiDi, Eur. Phys. J. E 14 (2004) 341, doi 10.1140/epje/i2003-10153-0.
pub fn inertial_number(shear_rate: f64, diameter: f64, density: f64, pressure: f64) -> f64 {
    if shear_rate == 0.0 {
        return 0.0;
    }
    if pressure > 0.0 {
        shear_rate * diameter * (density / pressure).sqrt()
    } else {
        f64::INFINITY
    }
}

#[cfg(test)]
mod tests {
    use super::inertial_number;

    #[test]
    fn agrees_with_an_independent_evaluation() {
        // 2/s, 8 mm, 2500 kg/m³, 640 Pa: 0.016 √3.90625.
        let number = inertial_number(2.0, 8e-3, 2500.0, 640.0);
        assert!((number / 0.031_622_776_601_683_79 - 1.0).abs() < 1e-14);
    }

    #[test]
    fn a_bed_without_pressure_has_none_or_all_of_it() {
        assert_eq!(inertial_number(0.0, 1e-3, 2500.0, 0.0), 0.0);
        assert!(inertial_number(1.0, 1e-3, 2500.0, -1.0).is_infinite());
    }
}
