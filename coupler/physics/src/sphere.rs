//! Geometry and mass of a sphere: the one place that knows them.
//!
//! The functions of a plain radius serve kernels; those over a [`Number`] carry derivatives.

use std::f64::consts::PI;

use calcine_numerics::Number;

/// Volume of a sphere in m³ by its radius in m: 4/3 π r³.
pub fn volume(radius: f64) -> f64 {
    4.0 / 3.0 * PI * radius.powi(3)
}

/// Volume of a sphere in m³ by its diameter in m, as the drag correlations have it: π/6 d³.
pub fn volume_of_diameter(diameter: f64) -> f64 {
    PI / 6.0 * diameter.powi(3)
}

/// Surface of a sphere in m² by its radius in m: 4 π r².
pub fn surface(radius: f64) -> f64 {
    4.0 * PI * radius * radius
}

/// Cross-section of a sphere in m² by its radius in m: π r².
pub fn cross_section(radius: f64) -> f64 {
    PI * radius * radius
}

/// Mass of a sphere in kg by its radius in m and density in kg/m³.
pub fn mass(radius: f64, density: f64) -> f64 {
    volume(radius) * density
}

/// Density of a sphere in kg/m³ by its mass in kg and radius in m.
pub fn density(mass: f64, radius: f64) -> f64 {
    mass / volume(radius)
}

/// Surface of a sphere in m² with its derivatives.
pub fn surface_of<N: Number>(radius: N) -> N {
    (radius * radius).times(4.0 * PI)
}

/// Radius in m of a sphere by its volume in m³, with its derivatives.
pub fn radius_of<N: Number>(volume: N) -> N {
    volume.times(0.75 / PI).cbrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A sphere of 2 m: 33.510 321 638 m³, 50.265 482 457 m², 12.566 370 614 m².
    #[test]
    fn agrees_with_an_independent_evaluation_at_a_radius_of_2_m() {
        let near = |found: f64, due: f64| assert!((found / due - 1.0).abs() < 1e-10, "{found}");
        near(volume(2.0), 33.510_321_638_3);
        near(volume_of_diameter(4.0), 33.510_321_638_3);
        near(surface(2.0), 50.265_482_457_4);
        near(surface_of(2.0), 50.265_482_457_4);
        near(cross_section(2.0), 12.566_370_614_4);
        near(mass(2.0, 0.5), 16.755_160_819_1);
        near(density(mass(2.0, 0.5), 2.0), 0.5);
        near(radius_of(33.510_321_638_3), 2.0);
    }

    /// d(4/3 π r³)/dr = 4 π r²; central differences of a cubic are off by h²/6 of its third derivative.
    #[test]
    fn the_surface_is_the_derivative_of_the_volume() {
        let h = 1e-4;
        let slope = (volume(1.5 + h) - volume(1.5 - h)) / (2.0 * h);
        assert!((slope / surface(1.5) - 1.0).abs() < 1e-8, "{slope}");
    }
}
