//! Pressure drop of packed beds.

use crate::numbers::VoidFraction;

/// Ergun's constant of the viscous term.
pub const ERGUN_VISCOUS: f64 = 150.0;
/// Ergun's constant of the inertial term.
pub const ERGUN_INERTIAL: f64 = 1.75;

/// Pressure gradient −dp/dx of a bed of spheres in Pa/m after Ergun, along the flow.
///
/// −dp/dx = 150 (1 − ε)² μ U/(ε³ d²) + 1.75 (1 − ε) ρ U|U|/(ε³ d)
///
/// with the superficial velocity U = ε u in m/s (signed), the density ρ in kg/m³, the viscosity μ
/// in Pa s and the diameter d in m. [`crate::drag::Ergun`] is the same law for one particle.
///
/// Conversion: none. For other shapes d is six times the volume over the surface.
///
/// Validity: random packings, ε 0.35 to 0.55, Re/(1 − ε) from 1 to about 2500 (Re superficial);
/// walls further than some ten diameters apart.
///
/// Source: Ergun, Fluid flow through packed columns, Chem. Eng. Prog. 48 (1952) 89 (no DOI).
pub fn ergun(
    void_fraction: VoidFraction,
    superficial_velocity: f64,
    density: f64,
    viscosity: f64,
    diameter: f64,
) -> f64 {
    let (eps, u, d) = (void_fraction.value(), superficial_velocity, diameter);
    let solid = 1.0 - eps;
    let viscous = ERGUN_VISCOUS * solid * solid * viscosity * u / (eps.powi(3) * d * d);
    let inertial = ERGUN_INERTIAL * solid * density * u * u.abs() / (eps.powi(3) * d);
    viscous + inertial
}

/// Superficial velocity in m/s at which gas that flows up carries a packed bed: minimum fluidisation.
///
/// 150 (1 − ε)² μ U/(ε³ d²) + 1.75 (1 − ε) ρ U²/(ε³ d) = (1 − ε) (ρ_s − ρ) g
///
/// with the density of the particles ρ_s in kg/m³, that of the gas ρ, gravity g in m/s², viscosity μ in Pa s and diameter d in m;
/// the positive root. 0 where the gas is denser than the particles.
///
/// Conversion: none.
///
/// Validity: that of [`ergun`]; ε is that of the packed bed, as fluidisation begins.
///
/// Source: Ergun and Orning, Fluid flow through randomly packed columns and fluidized beds, Ind. Eng. Chem. 41 (1949) 1179,
/// doi 10.1021/ie50474a011.
pub fn minimum_fluidisation(
    void_fraction: VoidFraction,
    solid_density: f64,
    density: f64,
    viscosity: f64,
    diameter: f64,
    gravity: f64,
) -> f64 {
    let eps = void_fraction.value();
    let weight = (1.0 - eps) * (solid_density - density) * gravity;
    if weight <= 0.0 {
        return 0.0;
    }
    // Ergun's gradient is b U + a U².
    let at_one =
        |density: f64, viscosity: f64| ergun(void_fraction, 1.0, density, viscosity, diameter);
    let (a, b) = (at_one(density, 0.0), at_one(0.0, viscosity));
    // The form without cancellation where the viscous term is the larger one.
    2.0 * weight / (b + (b * b + 4.0 * a * weight).sqrt())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn bed(superficial_velocity: f64) -> f64 {
        let eps = VoidFraction::new(0.4).unwrap();
        ergun(eps, superficial_velocity, 1.2, 1.82e-5, 0.014)
    }

    #[test]
    fn agrees_with_the_independent_values_of_cor_5() {
        // 14 mm spheres, ε = 0.4, 145 mm; in Python, from the equation.
        let oracle = [
            (0.5, 56.65680803571427),
            (1.0, 215.26674107142853),
            (2.0, 838.3459821428569),
        ];
        for (u, drop) in oracle {
            assert!((bed(u) * 0.145 / drop - 1.0).abs() < 1e-13, "{u}");
        }
    }

    #[test]
    fn is_carman_s_law_in_creeping_flow_and_turns_with_the_flow() {
        let slow = 1e-9;
        let viscous = 150.0 * 0.36 * 1.82e-5 * slow / (0.064 * 0.014 * 0.014);
        assert!((bed(slow) / viscous - 1.0).abs() < 1e-6);
        assert_eq!(bed(-0.7), -bed(0.7));
        assert_eq!(bed(0.0), 0.0);
    }

    #[test]
    fn at_minimum_fluidisation_the_pressure_drop_is_the_weight_less_the_buoyancy() {
        let eps = VoidFraction::new(0.4).unwrap();
        for diameter in [1e-4, 1e-3, 1e-2] {
            let u = minimum_fluidisation(eps, 2500.0, 1.2, 1.82e-5, diameter, 9.81);
            let gradient = ergun(eps, u, 1.2, 1.82e-5, diameter);
            assert!((gradient / (0.6 * 2498.8 * 9.81) - 1.0).abs() < 1e-12);
        }
        // In Python, from the quadratic equation: 1 mm of glass in air, 0.1 mm by Carman's law alone.
        let one = minimum_fluidisation(eps, 2500.0, 1.2, 1.82e-5, 1e-3, 9.81);
        assert!((one - 0.5582456462933463).abs() < 1e-9, "{one}");
        let fine = minimum_fluidisation(eps, 2500.0, 1.2, 1.82e-5, 1e-4, 9.81);
        let viscous = 0.064 * 1e-8 * 2498.8 * 9.81 / (150.0 * 0.6 * 1.82e-5);
        assert!((fine / viscous - 1.0).abs() < 3e-3, "{fine} {viscous}");
        let floats = minimum_fluidisation(eps, 900.0, 1000.0, 1e-3, 1e-3, 9.81);
        assert_eq!(floats, 0.0);
    }

    #[test]
    fn an_empty_tube_has_no_pressure_drop() {
        let empty = VoidFraction::new(1.0).unwrap();
        assert_eq!(ergun(empty, 2.0, 1.2, 1.82e-5, 0.014), 0.0);
    }
}
