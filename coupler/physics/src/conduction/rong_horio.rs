//! Rong and Horio 1999.

use super::{GasGap, SphereGap};
use crate::dimension::Dimension;
use crate::law::{Bound, LawEntry, LawParameter};

/// Conduction through the lens of gas that surrounds a particle, between two surfaces of one temperature
/// each.
///
/// G = k_g ∫ 2πr/max(w(r), s) dr from the contact radius to r_out, with the width w(r) of the gap and a
/// least width s (roughness, mean free path). Each particle carries a film of gas as thick as `lens` times
/// its radius; r_out is where the film of one meets the other's surface,
/// r_out² = S² − ((S² − R_j² + D²)/(2 D))², S = R_i (1 + lens), at most the smaller radius, and of the two
/// ways of a pair the wider one counts.
///
/// Validity: solids that conduct far better than the gas; else the surfaces have no one temperature, and
/// `cheng` puts the solids in series.
///
/// Source: Rong and Horio, Second Int. Conf. on CFD in the Minerals and Process Industries (1999) 65; in the
/// form of Musser, Carney and Picarelli, Int. J. Heat Mass Transf. 84 (2015) 1070 (MFiX: lens 0.2).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RongHorio {
    /// Thickness of the film over the particle's radius.
    pub lens: f64,
    /// Least width s of a gap in m.
    pub least_width: f64,
}

impl RongHorio {
    fn outer(&self, gap: &SphereGap) -> f64 {
        let [first, second] = gap.radius;
        let least = first.min(second);
        let film = |own: f64, other: f64| {
            let film = own * (1.0 + self.lens);
            if own.is_infinite() {
                return 0.0;
            }
            // Distance from the own centre to the plane of the circle where film and surface meet.
            let plane = if other.is_infinite() {
                own + gap.distance
            } else {
                let distance = own + other + gap.distance;
                (film * film - other * other + distance * distance) / (2.0 * distance)
            };
            (film * film - plane * plane).max(0.0).sqrt()
        };
        film(first, second).max(film(second, first)).min(least)
    }
}

/// Its entry in a case file.
pub(super) static LAW: LawEntry<dyn GasGap> = LawEntry {
    name: "rong-horio",
    summary: "Surfaces of one temperature each, for solids that conduct far better than the gas.",
    source: "Rong and Horio, Second Int. Conf. on CFD in the Minerals and Process Industries (1999) 65",
    parameters: &[
        LawParameter {
            name: "lens",
            dimension: Dimension::NONE,
            bound: Bound::Positive,
            default: Some(0.2),
            needed_with: None,
            meaning: "Thickness of the film of gas over the radius.",
            example: "0.2",
        },
        LawParameter {
            name: "least_width",
            dimension: Dimension::LENGTH,
            bound: Bound::Positive,
            default: None,
            needed_with: None,
            meaning: "Least width of a gap (roughness).",
            example: "\"1 um\"",
        },
    ],
    tables: &[],
    make: |values| {
        Box::new(RongHorio {
            lens: values[0],
            least_width: values[1],
        })
    },
};

impl GasGap for RongHorio {
    fn name(&self) -> &'static str {
        LAW.name
    }

    fn reach(&self, radius: [f64; 2]) -> f64 {
        let finite = radius.into_iter().filter(|r| r.is_finite());
        self.lens * finite.fold(0.0, f64::max)
    }

    fn conductance(&self, gap: &SphereGap) -> f64 {
        let (from, to) = (gap.contact_radius, self.outer(gap));
        // The least width holds up to the radius where the gap is as wide; beyond, the gap itself.
        let excess = self.least_width - gap.distance;
        let split = if excess > 0.0 {
            radius_of_width(gap, self.least_width).clamp(from, to.max(from))
        } else {
            from
        };
        let inner = std::f64::consts::PI * (split * split - from * from) / self.least_width;
        let outer = gap.ring(split, to, gap.distance.max(0.0), |r| 1.0 / gap.width(r));
        gap.gas_conductivity * (inner + outer)
    }
}

/// The distance in m from the axis where a gap has a width in m above its least, by bisection.
fn radius_of_width(gap: &SphereGap, width: f64) -> f64 {
    let (mut low, mut high) = (0.0, gap.radius[0].min(gap.radius[1]));
    if gap.width(high) <= width {
        return high;
    }
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if gap.width(middle) < width {
            low = middle;
        } else {
            high = middle;
        }
    }
    0.5 * (low + high)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::PI;

    const LAW: RongHorio = RongHorio {
        lens: 0.2,
        least_width: 1e-6,
    };

    fn gap(radius: [f64; 2], distance: f64) -> SphereGap {
        SphereGap {
            radius,
            distance,
            contact_radius: 0.0,
            conductivity: [1.0; 2],
            gas_conductivity: 0.03,
        }
    }

    #[test]
    fn a_sphere_near_a_wall_conducts_by_the_closed_form() {
        // r_out² = (1.2 R)² − (R + h)²; ∫ 2πr/w dr = 2π (T ln((T − u₁)/(T − u₀)) + u₁ − u₀),
        // T = R + h, u = √(R² − r²) from R down to √(R² − r_out²).
        let (r, h) = (5e-3, 1e-4);
        let out = (36e-6_f64 - 5.1e-3 * 5.1e-3).sqrt();
        let (top, end) = (r + h, (r * r - out * out).sqrt());
        let exact = 0.03 * 2.0 * PI * (top * ((top - end) / (top - r)).ln() + end - r);
        let made = LAW.conductance(&gap([r, f64::INFINITY], h));
        assert!((made / exact - 1.0).abs() < 1e-7, "{made} {exact}");
    }

    #[test]
    fn touching_spheres_are_limited_by_the_least_width() {
        // Where w < s = 1 µm the gap counts as s; beyond, the integral of 2πr/(2 (R − u)) dr.
        let r = 5e-3_f64;
        // The film of 6 mm meets the other's surface in the plane (S² − R² + D²)/(2D), D = 2R.
        let out = (36e-6 - ((36e-6_f64 + 75e-6) / (4.0 * r)).powi(2)).sqrt();
        let split = (r * r - (r - 0.5e-6_f64).powi(2)).sqrt();
        let (u0, u1) = ((r * r - split * split).sqrt(), (r * r - out * out).sqrt());
        let outer = 2.0 * PI * 0.5 * (r * ((r - u1) / (r - u0)).ln() + u1 - u0);
        let exact = 0.03 * (PI * split * split / 1e-6 + outer);
        let made = LAW.conductance(&gap([r; 2], 0.0));
        assert!((made / exact - 1.0).abs() < 1e-4, "{made} {exact}");
    }

    #[test]
    fn ends_where_the_film_ends_and_does_not_mind_the_order() {
        assert_eq!(LAW.reach([5e-3, 2e-3]), 1e-3);
        assert_eq!(LAW.conductance(&gap([5e-3; 2], 1.001e-3)), 0.0);
        assert!(LAW.conductance(&gap([5e-3; 2], 0.99e-3)) > 0.0);
        let one = LAW.conductance(&gap([5e-3, 2e-3], 1e-4));
        assert!((LAW.conductance(&gap([2e-3, 5e-3], 1e-4)) / one - 1.0).abs() < 1e-13);
    }
}
