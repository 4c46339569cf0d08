//! Cheng, Yu and Zulli 1999.

use super::{GasGap, SphereGap};
use crate::dimension::Dimension;
use crate::law::{Bound, LawEntry, LawParameter};

/// Conduction along parallel paths through one solid, the gas and the other solid, in series.
///
/// G = ∫ 2πr dr/(l₁(r)/k₁ + w(r)/k_g + l₂(r)/k₂) from the contact radius to r_out. The paths of a pair fill a
/// double cone with tips in the centres and a common base of radius r_ij = `cone` R (R the smaller radius),
/// in the plane between the spheres at the distances a₁ and a₂ from the centres; a path at r runs from the
/// cone to the surface, l = √(R² − r²) − r a/r_ij, and the last at r_out = R r_ij/√(r_ij² + a²). The face of
/// a wall is as warm as the wall, l₂ = 0.
///
/// Validity: neighbours in a bed, across gaps up to `widest` times the smaller radius; any conductivity of
/// the solids. r_ij is the equivalent radius of the face of two Voronoi cells, 0.56 R (1 − ε)^(−1/3).
///
/// Source: Cheng, Yu and Zulli, Chem. Eng. Sci. 54 (1999) 4199, doi 10.1016/S0009-2509(99)00125-6; r_ij and
/// spheres that are apart in the form of Zhou, Yu and Zulli, AIChE J. 55 (2009) 868, doi 10.1002/aic.11823.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cheng {
    /// Radius of the base of the cones over the smaller particle's radius.
    pub cone: f64,
    /// Widest gap over the smaller particle's radius.
    pub widest: f64,
}

/// Its entry in a case file.
pub(super) static LAW: LawEntry<dyn GasGap> = LawEntry {
    name: "cheng",
    summary: "Paths through solid, gas and solid in series.",
    source: "Cheng, Yu and Zulli, Chem. Eng. Sci. 54 (1999) 4199, doi 10.1016/S0009-2509(99)00125-6",
    parameters: &[
        LawParameter {
            name: "cone",
            dimension: Dimension::NONE,
            bound: Bound::Positive,
            default: Some(0.66),
            needed_with: None,
            meaning: "Radius of the cone of paths between two neighbours over the smaller radius, 0.56 (1 - eps)^(-1/3).",
            example: "0.66",
        },
        LawParameter {
            name: "widest",
            dimension: Dimension::NONE,
            bound: Bound::Positive,
            default: Some(1.0),
            needed_with: None,
            meaning: "Widest gap over the smaller radius.",
            example: "1",
        },
    ],
    tables: &[],
    make: |values| {
        Box::new(Cheng {
            cone: values[0],
            widest: values[1],
        })
    },
};

impl GasGap for Cheng {
    fn name(&self) -> &'static str {
        LAW.name
    }

    fn reach(&self, radius: [f64; 2]) -> f64 {
        self.widest * radius[0].min(radius[1])
    }

    fn conductance(&self, gap: &SphereGap) -> f64 {
        if gap.distance > self.reach(gap.radius) {
            return 0.0;
        }
        let [first, second] = gap.radius;
        let base = self.cone * first.min(second);
        // Distances of the centres from the plane between the spheres (that of equal tangents).
        let planes = if second.is_infinite() {
            [first + gap.distance, 0.0]
        } else {
            let distance = first + second + gap.distance;
            let own = 0.5 * (distance + (first * first - second * second) / distance);
            [own, distance - own]
        };
        let out = |radius: f64, plane: f64| radius * base / base.hypot(plane);
        let finite = second.is_finite();
        let end = if finite {
            out(first, planes[0]).min(out(second, planes[1]))
        } else {
            out(first, planes[0])
        };
        let solid = |i: usize, r: f64| {
            let radius = gap.radius[i];
            let length = (radius * radius - r * r).max(0.0).sqrt() - r * planes[i] / base;
            length.max(0.0) / gap.conductivity[i]
        };
        // The gas is as wide as the solids resist, over the axis.
        let inside = solid(0, 0.0) + if finite { solid(1, 0.0) } else { 0.0 };
        let width = gap.distance.max(0.0) + inside * gap.gas_conductivity;
        gap.ring(gap.contact_radius, end, width, |r| {
            let far = if finite { solid(1, r) } else { 0.0 };
            1.0 / (solid(0, r) + gap.width(r).max(0.0) / gap.gas_conductivity + far)
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const LAW: Cheng = Cheng {
        cone: 0.66,
        widest: 1.0,
    };

    fn gap(radius: [f64; 2], distance: f64, solid: f64) -> SphereGap {
        SphereGap {
            radius,
            distance,
            contact_radius: 0.0,
            conductivity: [solid; 2],
            gas_conductivity: 0.03,
        }
    }

    /// Integral of the paper's formula for equal spheres by the midpoint rule.
    fn paper(r: f64, half: f64, solid: f64) -> f64 {
        let (base, count) = (0.66 * r, 2_000_000);
        let end = r * base / base.hypot(r + half);
        let ring = |k: usize| {
            let s = end * (k as f64 + 0.5) / f64::from(count);
            let u = (r * r - s * s).sqrt();
            let paths = (u - s * (r + half) / base) * 2.0 / solid + 2.0 * (r + half - u) / 0.03;
            2.0 * std::f64::consts::PI * s / paths
        };
        (0..count as usize).map(ring).sum::<f64>() * end / f64::from(count)
    }

    #[test]
    fn agrees_with_the_papers_formula_for_equal_spheres() {
        for (half, solid) in [(0.0, 1.0), (1e-4, 1.0), (1e-3, 40.0)] {
            let made = LAW.conductance(&gap([5e-3; 2], 2.0 * half, solid));
            let exact = paper(5e-3, half, solid);
            assert!((made / exact - 1.0).abs() < 2e-4, "{half} {made} {exact}");
        }
    }

    #[test]
    fn as_well_as_the_gas_the_solids_conduct_the_lengths_of_the_cones() {
        // k_s = k_g: all paths have the length of the cones, 2 (R + H)(1 − r/r_ij).
        let (r, end) = (5e-3_f64, 5e-3 * 0.66 / 0.66_f64.hypot(1.0));
        let base = 0.66 * r;
        // ∫ 2πr dr/(2R(1 − r/b)) = π b²/R (−x − ln(1 − x)), x = r_out/b.
        let x = end / base;
        let exact = 0.03 * std::f64::consts::PI * base * base / r * (-x - (1.0 - x).ln());
        let made = LAW.conductance(&gap([r; 2], 0.0, 0.03));
        assert!((made / exact - 1.0).abs() < 1e-5, "{made} {exact}");
    }

    #[test]
    fn a_wall_as_warm_as_the_mirror_image_between_has_twice_the_conductance() {
        let pair = LAW.conductance(&gap([5e-3; 2], 2e-4, 1.0));
        let wall = LAW.conductance(&gap([5e-3, f64::INFINITY], 1e-4, 1.0));
        assert!((wall / (2.0 * pair) - 1.0).abs() < 1e-12);
        let one = LAW.conductance(&gap([5e-3, 2e-3], 1e-4, 1.0));
        assert!((LAW.conductance(&gap([2e-3, 5e-3], 1e-4, 1.0)) / one - 1.0).abs() < 1e-12);
        assert_eq!(LAW.conductance(&gap([5e-3; 2], 5.1e-3, 1.0)), 0.0);
    }
}
