//! How growth depends on size.

use crate::PlantError;

/// Growth of a diameter relative to that of others; the spray's mass sets the scale (docs/theory.md, PBM-3).
pub trait GrowthLaw: Send + Sync {
    /// g(d) of a diameter in m, dimensionless.
    fn relative(&self, d: f64) -> f64;
}

/// All sizes grow alike (PBM-2).
#[derive(Clone, Copy, Debug, Default)]
pub struct UniformGrowth;

impl GrowthLaw for UniformGrowth {
    fn relative(&self, _d: f64) -> f64 {
        1.0
    }
}

/// g = 1 + d/d₀: for d₀ small against all sizes growth in proportion to the diameter, negative where large ones grow less.
#[derive(Clone, Copy, Debug)]
pub struct LinearGrowth {
    /// d₀ in m.
    pub reference: f64,
}

impl GrowthLaw for LinearGrowth {
    fn relative(&self, d: f64) -> f64 {
        1.0 + d / self.reference
    }
}

/// g by points, linear between them and constant beyond, for growth measured or computed elsewhere.
#[derive(Clone, Debug)]
pub struct TabulatedGrowth {
    points: Vec<(f64, f64)>,
}

impl TabulatedGrowth {
    /// Points of diameter in m and g.
    pub fn new(points: Vec<(f64, f64)>, place: &str) -> Result<Self, PlantError> {
        let refuse = |quantity, value, allowed| {
            let place = place.to_owned();
            Err(PlantError::Value {
                place,
                quantity,
                value,
                allowed,
            })
        };
        if points.is_empty() {
            return refuse(
                "number of points of the growth table",
                0.0,
                "give one at least",
            );
        }
        for (d, g) in &points {
            if !(d.is_finite() && *d >= 0.0) {
                return refuse(
                    "diameter of the growth table",
                    *d,
                    "it is finite and not negative",
                );
            }
            if !(g.is_finite() && *g >= 0.0) {
                return refuse("growth of the table", *g, "it is finite and not negative");
            }
        }
        if let Some(pair) = points.windows(2).find(|pair| pair[1].0 <= pair[0].0) {
            return refuse("diameter of the growth table", pair[1].0, "diameters rise");
        }
        Ok(Self { points })
    }
}

impl GrowthLaw for TabulatedGrowth {
    fn relative(&self, d: f64) -> f64 {
        let after = self.points.partition_point(|(x, _)| *x <= d);
        if after == 0 {
            return self.points[0].1;
        }
        let (x0, g0) = self.points[after - 1];
        match self.points.get(after) {
            Some((x1, g1)) => g0 + (g1 - g0) * (d - x0) / (x1 - x0),
            None => g0,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_table_is_linear_between_its_points_and_constant_beyond() {
        let law = TabulatedGrowth::new(vec![(1e-3, 2.0), (2e-3, 1.0)], "test").unwrap();
        assert_eq!(
            [0.0, 1.5e-3, 5e-3].map(|d| law.relative(d)),
            [2.0, 1.5, 1.0]
        );
        assert!(TabulatedGrowth::new(vec![(1e-3, f64::NAN)], "test").is_err());
        assert_eq!(LinearGrowth { reference: 2e-3 }.relative(1e-3), 1.5);
    }
}
