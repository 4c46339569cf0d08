//! Breakage that keeps two moments.

use calcine_physics::sphere::volume_of_diameter;

use super::{BreakageLaw, SizeProcess};
use crate::{PlantError, SizeGrid};

/// Breakage over size classes (docs/theory.md, PBM-6): fragments between the particles of two classes are divided between
/// them so that their number and their mass are kept; those smaller than the first class's go into it by mass.
///
/// Source: Kumar and Ramkrishna, Chem. Eng. Sci. 51 (1996) 1311, doi 10.1016/0009-2509(96)88489-2.
pub struct ParticleBreakage {
    law: Box<dyn BreakageLaw>,
    /// Mass in kg/s that a kg of each class gives each class, row by row: what it loses stands on the diagonal.
    moves: Vec<f64>,
}

impl ParticleBreakage {
    /// Breakage by a law.
    pub fn new(law: Box<dyn BreakageLaw>) -> Self {
        Self {
            law,
            moves: Vec::new(),
        }
    }
}

impl SizeProcess for ParticleBreakage {
    fn prepare(
        &mut self,
        grid: &SizeGrid,
        particle: &[f64],
        place: &str,
    ) -> Result<(), PlantError> {
        if let Some((quantity, value, allowed)) = self.law.refused() {
            return Err(PlantError::Value {
                place: place.to_owned(),
                quantity,
                value,
                allowed,
            });
        }
        let count = grid.classes();
        let volumes: Vec<f64> = grid
            .diameters()
            .iter()
            .map(|d| volume_of_diameter(*d))
            .collect();
        debug_assert_eq!(particle.len(), count);
        self.moves = vec![0.0; count * count];
        for (class, row) in self.moves.chunks_exact_mut(count).enumerate() {
            let v = volumes[class];
            let rate = self.law.rate(v);
            if !(rate.is_finite() && rate >= 0.0) {
                return Err(PlantError::Value {
                    place: place.to_owned(),
                    quantity: "breakage rate in 1/s",
                    value: rate,
                    allowed: "it is finite and not negative",
                });
            }
            // The smallest particles have no class to break into.
            if class == 0 {
                continue;
            }
            row[0] += self.law.below(volumes[0], v)[1] / v;
            for below in 0..class {
                let (low, high) = (volumes[below], volumes[below + 1]);
                let ([n0, v0], [n1, v1]) = (self.law.below(low, v), self.law.below(high, v));
                let (number, sum) = (n1 - n0, v1 - v0);
                let upper = (sum - low * number) / (high - low);
                row[below] += (number - upper) * low / v;
                row[below + 1] += upper * high / v;
            }
            row[class] -= 1.0;
            row.iter_mut().for_each(|share| *share *= rate);
        }
        Ok(())
    }

    fn add(&self, inner: usize, masses: &[f64], rates: &mut [f64]) {
        let count = masses.len() / inner;
        let classes = masses.chunks_exact(inner);
        for (class, (own, row)) in classes.zip(self.moves.chunks_exact(count)).enumerate() {
            for (to, share) in row[..=class].iter().enumerate() {
                let rates = &mut rates[to * inner..(to + 1) * inner];
                rates.iter_mut().zip(own).for_each(|(r, m)| *r += share * m);
            }
        }
    }

    fn fastest(&self, _inner: usize, _masses: &[f64]) -> f64 {
        let count = self.moves.len().isqrt();
        let own = (0..count).map(|class| -self.moves[class * count + class]);
        own.fold(0.0, f64::max)
    }
}
