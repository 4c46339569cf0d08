//! View factors of spheres.

use std::f64::consts::{FRAC_PI_2, PI};

use crate::quadrature::gauss;

/// View factor from a small flat element to a sphere.
///
/// The element looks along a normal at the angle θ from the direction to the centre; H = h/r is the
/// distance of the centre over the sphere's radius:
///
/// F = cos θ/H², where the sphere lies above the element's horizon, θ + asin(1/H) ≤ π/2; where the horizon
/// cuts it, F = ½ − (1/π) asin(√(H² − 1)/(H sin θ)) + (1/(πH²)) (cos θ acos(−√(H² − 1) cot θ) −
/// √(H² − 1) √(1 − H² cos² θ)); below it, 0.
///
/// Source: Hamilton and Morgan, NACA TN 2836 (1952); Howell, A Catalog of Radiation Configuration Factors,
/// B-43.
pub fn element_to_sphere(distance: f64, radius: f64, angle: f64) -> f64 {
    let h = distance / radius;
    let half = (1.0 / h).clamp(-1.0, 1.0).asin();
    if angle <= FRAC_PI_2 - half {
        return angle.cos() / (h * h);
    }
    if angle >= FRAC_PI_2 + half {
        return 0.0;
    }
    let root = (h * h - 1.0).max(0.0).sqrt();
    let (sine, cosine) = angle.sin_cos();
    let first = (root / (h * sine)).clamp(-1.0, 1.0).asin();
    let second = (-root * cosine / sine).clamp(-1.0, 1.0).acos();
    let third = root * (1.0 - h * h * cosine * cosine).max(0.0).sqrt();
    0.5 - first / PI + (cosine * second - third) / (PI * h * h)
}

/// View factor from a sphere to another, with nothing between them (docs/theory.md, COR-11).
///
/// F = ½ ∫ F_el(β) sin β dβ over the angle β from the line of centres, with the analytic factor of an element
/// of the first sphere's surface; radii and distance of the centres in m. A₁F₁₂ = A₂F₂₁.
///
/// Range: spheres that do not overlap. Overlapping ones count as touching.
///
/// Source: the integral over elements as by Feng and Han, Int. J. Heat Mass Transf. 55 (2012) 6374,
/// doi 10.1016/j.ijheatmasstransfer.2012.06.021.
pub fn sphere_to_sphere(first: f64, second: f64, distance: f64) -> f64 {
    let distance = distance.max(first + second);
    // Seen as a whole up to β₁, and in part up to β₂, where the other sphere sets.
    let whole = ((first + second) / distance).clamp(-1.0, 1.0).acos();
    let set = ((first - second) / distance).clamp(-1.0, 1.0).acos();
    let element = |beta: f64| {
        let (sine, cosine) = beta.sin_cos();
        let along = distance * cosine - first;
        let between = along.hypot(distance * sine);
        let angle = (along / between).clamp(-1.0, 1.0).acos();
        element_to_sphere(between, second, angle) * sine
    };
    0.5 * (integral(0.0, whole, element) + integral(whole, set, element))
}

/// Integral of a function whose slope may be endless at both ends: in φ with x = middle + half sin φ.
fn integral(from: f64, to: f64, f: impl Fn(f64) -> f64) -> f64 {
    let (middle, half) = (0.5 * (from + to), 0.5 * (to - from));
    let inner = |phi: f64| f(middle + half * phi.sin()) * half * phi.cos();
    gauss(-FRAC_PI_2, 0.0, inner) + gauss(0.0, FRAC_PI_2, inner)
}

/// Open views of equal spheres over their distance, from a table that is made once.
#[derive(Clone, Debug)]
pub struct SphereTable {
    /// F s² over x = 2/s, evenly spaced from 0 to 1.
    values: Vec<f64>,
}

/// Intervals of the table, linear in between: good for 2e-5 of a value.
const INTERVALS: usize = 512;

impl SphereTable {
    /// Evaluates the table.
    pub fn new() -> Self {
        let value = |k: usize| {
            let x = k as f64 / INTERVALS as f64;
            // Far away F = (R/D)²/4.
            match k {
                0 => 0.25,
                _ => sphere_to_sphere(1.0, 1.0, 2.0 / x) * 4.0 / (x * x),
            }
        };
        Self {
            values: (0..=INTERVALS).map(value).collect(),
        }
    }

    /// View factor at a distance of the centres over the radius; closer than 2 counts as touching.
    pub fn at(&self, distance: f64) -> f64 {
        let x = (2.0 / distance).min(1.0);
        let place = x * INTERVALS as f64;
        let below = (place as usize).min(INTERVALS - 1);
        let share = place - below as f64;
        let value = self.values[below] + share * (self.values[below + 1] - self.values[below]);
        value * x * x * 0.25
    }
}

impl Default for SphereTable {
    fn default() -> Self {
        Self::new()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn equal_spheres_see_each_other_as_tabulated() {
        // Requirements COR-11, distance of centres over the radius.
        for (s, tabulated) in [
            (2.0, 0.075_587),
            (2.1, 0.066_504),
            (2.2, 0.059_323),
            (2.5, 0.044_119),
            (3.0, 0.029_590),
            (4.0, 0.016_156),
            (5.0, 0.010_211),
            (6.0, 0.007_044),
        ] {
            let made = sphere_to_sphere(1.0, 1.0, s);
            assert!((made - tabulated).abs() < 1.5e-6, "{s}: {made}");
        }
    }

    #[test]
    fn the_table_gives_the_integral() {
        let table = SphereTable::new();
        for k in 0..500 {
            let s = 1.99 + 0.01 * f64::from(k * k) * 0.1;
            let exact = sphere_to_sphere(1.0, 1.0, s);
            assert!((table.at(s) / exact - 1.0).abs() < 2e-5, "{s}");
        }
    }

    #[test]
    fn far_apart_they_see_the_others_cross_section() {
        // F → ¼ (R₂/D)² · 1, the share of all directions.
        let made = sphere_to_sphere(1.0, 0.5, 1000.0);
        assert!((made / (0.25 * 0.25e-6) - 1.0).abs() < 1e-3, "{made}");
    }

    #[test]
    fn reciprocity_holds_between_unequal_spheres() {
        for (a, b, d) in [(1.0, 0.3, 1.3), (1.0, 0.3, 2.0), (0.2, 2.0, 2.5)] {
            let there = a * a * sphere_to_sphere(a, b, d);
            let back = b * b * sphere_to_sphere(b, a, d);
            assert!((there / back - 1.0).abs() < 1e-4, "{there} {back}");
        }
    }

    #[test]
    fn an_element_on_a_sphere_sees_half_of_its_sky_filled_from_the_edge() {
        assert!((element_to_sphere(1.0, 1.0, FRAC_PI_2) - 0.5).abs() < 1e-15);
        assert!((element_to_sphere(2.0, 1.0, 0.0) - 0.25).abs() < 1e-15);
        assert_eq!(element_to_sphere(2.0, 1.0, 2.2), 0.0);
        // Both branches meet where the sphere touches the horizon.
        let edge = FRAC_PI_2 - 0.5_f64.asin();
        let apart = element_to_sphere(2.0, 1.0, edge) - element_to_sphere(2.0, 1.0, edge + 1e-9);
        assert!(apart.abs() < 1e-8);
    }
}
