//! Times that bound the step of a discrete element solver.

use std::f64::consts::PI;

/// Rayleigh time in s: the time in which a surface wave runs along half of a sphere of this radius in m and
/// density in kg/m³, of Young's modulus in Pa and Poisson's ratio.
///
/// T_R = π R √(ρ/G)/(0.1631 ν + 0.8766), G = E/(2 (1 + ν))
///
/// A step of at most a fifth of it is usual for dense beds.
///
/// Source: Thornton and Randall 1988, in Micromechanics of Granular Materials, p. 133; as LIGGGHTS'
/// `check/timestep/gran`.
pub fn rayleigh(radius: f64, density: f64, young: f64, poisson: f64) -> f64 {
    let shear = young / (2.0 * (1.0 + poisson));
    PI * radius * (density / shear).sqrt() / (0.1631 * poisson + 0.8766)
}

/// Duration in s of the elastic collision of two spheres by Hertz' law: effective radius in m, effective
/// mass in kg, effective Young's modulus in Pa, speed of approach in m/s.
///
/// t = 2.943 275 (15 m*/(16 E* √R*))^(2/5) V^(−1/5) = 2.868 266 (m*²/(R* E*² V))^(1/5)
///
/// Source: Landau and Lifshitz, Theory of Elasticity, § 9, problem 1.
pub fn hertz_collision(radius: f64, mass: f64, young: f64, speed: f64) -> f64 {
    COLLISION * (mass * mass / (radius * young * young * speed)).powf(0.2)
}

/// Largest overlap in m of the elastic collision of two spheres by Hertz' law: effective radius in m, effective mass in kg,
/// effective Young's modulus in Pa, speed of approach in m/s.
///
/// δ = (15 m* V²/(16 E* √R*))^(2/5)
///
/// Source: Landau and Lifshitz, Theory of Elasticity, § 9, problem 1.
pub fn hertz_overlap(radius: f64, mass: f64, young: f64, speed: f64) -> f64 {
    (15.0 * mass * speed * speed / (16.0 * young * radius.sqrt())).powf(0.4)
}

/// Duration in s of the elastic collision of two spheres by a linear spring: effective mass in kg, stiffness in N/m.
///
/// t = π √(m*/k)
///
/// Source: half a period of the harmonic oscillator.
pub fn linear_collision(mass: f64, stiffness: f64) -> f64 {
    PI * (mass / stiffness).sqrt()
}

/// 2 ∫₀¹ dx/√(1 − x^2.5) (15/16)^(2/5) = 2.943 275 18 · (15/16)^(2/5).
const COLLISION: f64 = 2.868_265_70;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn agree_with_independent_values() {
        // glass-like: R = 1 mm, ρ = 2500, E = 50 MPa, ν = 0.22: G = 2.0491803e7, √(ρ/G) = 1.1045361e-2
        let linear = linear_collision(1e-5, 1000.0);
        assert!((linear / 3.141_592_65e-4 - 1.0).abs() < 1e-8, "{linear}");
        let time = rayleigh(1e-3, 2500.0, 5e7, 0.22);
        assert!((time / 3.802_817_5e-5 - 1.0).abs() < 1e-5, "{time}");
        let unit = hertz_collision(1.0, 1.0, 1.0, 1.0);
        // The quadrature of 2 ∫₀^δm dδ/√(V² − 16/15 δ^2.5), by δ = δm (1 − s²)
        let deepest = (15f64 / 16.0).powf(0.4);
        let count = 20_000;
        let sum: f64 = (0..count)
            .map(|k| {
                let s = (f64::from(k) + 0.5) / f64::from(count);
                let x = 1.0 - s * s;
                2.0 * s / (1.0 - x.powf(2.5)).sqrt()
            })
            .sum();
        let quadrature = 2.0 * deepest * sum / f64::from(count);
        assert!((hertz_overlap(1.0, 1.0, 1.0, 1.0) / deepest - 1.0).abs() < 1e-14);
        // R* = 0.5 mm, m* = 5.2359878 mg, E* = 2.6666667 GPa, 1 m/s: (15 m*/(16 E* √R*))^0.4
        let glass = hertz_overlap(5e-4, 5.235_987_8e-6, 2.666_666_7e9, 1.0);
        assert!((glass / 5.837_225_4e-6 - 1.0).abs() < 1e-7, "{glass}");
        assert!(
            (unit / quadrature - 1.0).abs() < 1e-6,
            "{unit} {quadrature}"
        );
    }
}
