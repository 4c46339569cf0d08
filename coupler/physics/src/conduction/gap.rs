//! Conduction through the gas between surfaces that are near each other.

use std::fmt::Debug;

use crate::law::LawEntry;
use crate::quadrature::gauss;

/// Two spheres with gas between them; a flat wall is one of endless radius and stands second.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SphereGap {
    /// Radii in m.
    pub radius: [f64; 2],
    /// Shortest distance of the surfaces in m, negative where the spheres overlap.
    pub distance: f64,
    /// Radius in m of the contact, which conducts by itself and is left out here; zero without one.
    pub contact_radius: f64,
    /// Conductivities of the solids in W/m/K.
    pub conductivity: [f64; 2],
    /// Conductivity of the gas in W/m/K.
    pub gas_conductivity: f64,
}

impl SphereGap {
    /// Width in m of the gap at a distance r in m from the line of centres, within both radii.
    pub fn width(&self, r: f64) -> f64 {
        self.distance + sagitta(self.radius[0], r) + sagitta(self.radius[1], r)
    }

    /// Integral over r in m from `from` to `to` of 2 π r f(r). The integrand is nearly 1/(w₀ + r²/(2R*)) with
    /// a width w₀ in m, positive or `from` is; in ln(r² + 2 R* w₀) that is a constant.
    pub(super) fn ring(&self, from: f64, to: f64, width: f64, f: impl Fn(f64) -> f64) -> f64 {
        let shift = 2.0 * super::model::reduced(self.radius) * width;
        if to <= from {
            return 0.0;
        }
        let ends = [from, to].map(|r| (r * r + shift).ln());
        let inner = |z: f64| {
            let square = z.exp();
            square * f((square - shift).max(0.0).sqrt())
        };
        std::f64::consts::PI * gauss(ends[0], ends[1], inner)
    }
}

/// How far in m a sphere's surface falls back from its foremost point at a distance r from the axis.
fn sagitta(radius: f64, r: f64) -> f64 {
    if radius.is_infinite() {
        0.0
    } else {
        r * r / (radius + (radius * radius - r * r).max(0.0).sqrt())
    }
}

/// Conduction through the gas of a gap.
pub trait GasGap: Debug + Send + Sync {
    /// Name as case files use it.
    fn name(&self) -> &'static str;

    /// The widest gap in m between two spheres of these radii in m that still conducts.
    fn reach(&self, radius: [f64; 2]) -> f64;

    /// Conductance G in W/K: the heat from the second to the first particle is G (T₂ − T₁).
    fn conductance(&self, gap: &SphereGap) -> f64;
}

/// The gas between particles conducts nothing.
#[derive(Clone, Copy, Debug)]
pub struct NoGap;

/// Its entry in a case file.
pub(super) static NO_GAP: LawEntry<dyn GasGap> = LawEntry {
    name: "none",
    summary: "No conduction through the gas between surfaces.",
    source: "",
    parameters: &[],
    tables: &[],
    make: |_| Box::new(NoGap),
};

impl GasGap for NoGap {
    fn name(&self) -> &'static str {
        NO_GAP.name
    }

    fn reach(&self, _: [f64; 2]) -> f64 {
        0.0
    }

    fn conductance(&self, _: &SphereGap) -> f64 {
        0.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_rule_integrates_rings_of_areas_and_of_gaps() {
        let gap = SphereGap {
            radius: [2.0, f64::INFINITY],
            distance: 0.1,
            contact_radius: 0.0,
            conductivity: [1.0; 2],
            gas_conductivity: 1.0,
        };
        let area = gap.ring(0.5, 1.5, 0.1, |_| 1.0);
        assert!((area / (2.0 * std::f64::consts::PI) - 1.0).abs() < 1e-14);
        // ∫ 2πr/w dr with r² = R² − u²: 2π ∫ u du/(h + R − u), by parts with u from √(4 − 2.25) to 2.
        let (low, high, top): (f64, f64, f64) = (1.75_f64.sqrt(), 2.0, 2.1);
        let exact =
            2.0 * std::f64::consts::PI * (top * ((top - low) / (top - high)).ln() - (high - low));
        let made = gap.ring(0.0, 1.5, 0.1, |r| 1.0 / gap.width(r));
        assert!((made / exact - 1.0).abs() < 1e-9, "{made} {exact}");
    }
}
