//! Aggregation by cell average.

use calcine_physics::sphere::volume_of_diameter;

use super::{AggregationKernel, SizeProcess};
use crate::{PlantError, SizeGrid};

/// Aggregation of pairs by the cell average technique (docs/theory.md, PBM-6).
///
/// Particles of classes j ≤ k aggregate at the rate (1 − δ_jk/2) β N_j N_k. Births within a class are summed first, then
/// their number is divided between the two classes whose particles lie on both sides of the births' mean mass, so that
/// number and mass are both kept. Attributes and compounds move with the mass. Pairs whose mass exceeds the last
/// class do not aggregate.
///
/// Source: Kumar, Peglow, Warnecke, Heinrich and Mörl, Chem. Eng. Sci. 61 (2006) 3327, doi 10.1016/j.ces.2005.12.014.
pub struct Aggregation {
    kernel: Box<dyn AggregationKernel>,
    particle: Vec<f64>,
    /// β of pairs j ≤ k and the class their mass falls into, row by row.
    pairs: Vec<Pair>,
}

#[derive(Clone, Copy, Debug)]
struct Pair {
    first: u32,
    second: u32,
    into: u32,
    rate: f64,
}

impl Aggregation {
    /// Aggregation with a kernel.
    pub fn new(kernel: Box<dyn AggregationKernel>) -> Self {
        Self {
            kernel,
            particle: Vec::new(),
            pairs: Vec::new(),
        }
    }
}

impl SizeProcess for Aggregation {
    fn prepare(
        &mut self,
        grid: &SizeGrid,
        particle: &[f64],
        place: &str,
    ) -> Result<(), PlantError> {
        let count = grid.classes();
        // Particles' mass at the edges between classes, by the volume of the classes' own.
        let density = particle[count - 1] / volume_of_diameter(grid.diameters()[count - 1]);
        let edges: Vec<f64> = grid
            .edges()
            .iter()
            .map(|d| density * volume_of_diameter(*d))
            .collect();
        self.pairs.clear();
        for first in 0..count {
            for second in first..count {
                let mass = particle[first] + particle[second];
                if mass > particle[count - 1] {
                    break;
                }
                let (u, v) = (particle[first] / density, particle[second] / density);
                let rate = self.kernel.rate(u, v);
                if !(rate.is_finite() && rate >= 0.0) {
                    return Err(PlantError::Value {
                        place: place.to_owned(),
                        quantity: "aggregation kernel in 1/s",
                        value: rate,
                        allowed: "it is finite and not negative",
                    });
                }
                if rate > 0.0 {
                    let into = edges.partition_point(|edge| *edge <= mass) - 1;
                    let rate = if first == second { 0.5 * rate } else { rate };
                    let [first, second, into] = [first, second, into].map(|k| k as u32);
                    self.pairs.push(Pair {
                        first,
                        second,
                        into,
                        rate,
                    });
                }
            }
        }
        self.particle = particle.to_vec();
        Ok(())
    }

    fn add(&self, inner: usize, masses: &[f64], rates: &mut [f64]) {
        let count = self.particle.len();
        let number = |k: usize| {
            let class = &masses[k * inner..(k + 1) * inner];
            class.iter().sum::<f64>() / self.particle[k]
        };
        let numbers: Vec<f64> = (0..count).map(number).collect();
        // Of births in each class: number, and mass of each attribute and compound.
        let mut born = vec![0.0; count];
        let mut brought = vec![0.0; count * inner];
        let mut lost = vec![0.0; count];
        for pair in &self.pairs {
            let [j, k, into] = [pair.first, pair.second, pair.into].map(|k| k as usize);
            let (one, other) = (numbers[j], numbers[k]);
            let rate = pair.rate * one * other;
            // Masses below the normal range of numbers have no digits by which a mean could be taken.
            if !(rate * self.particle[0]).is_normal() {
                continue;
            }
            born[into] += rate;
            lost[j] += rate;
            lost[k] += rate;
            for (class, number) in [(j, one), (k, other)] {
                let own = &masses[class * inner..(class + 1) * inner];
                let to = &mut brought[into * inner..(into + 1) * inner];
                let share = rate / number;
                to.iter_mut().zip(own).for_each(|(t, m)| *t += share * m);
            }
        }
        for class in 0..count {
            if lost[class] != 0.0 {
                let share = lost[class] / numbers[class];
                let own = class * inner..(class + 1) * inner;
                for (rate, mass) in rates[own.clone()].iter_mut().zip(&masses[own]) {
                    *rate -= share * mass;
                }
            }
            if born[class] == 0.0 {
                continue;
            }
            let whole = &brought[class * inner..(class + 1) * inner];
            let mean = whole.iter().sum::<f64>() / born[class];
            // The other class, on the side of the mean; its share of the births.
            let above = mean >= self.particle[class];
            let other = if above {
                (class + 1).min(count - 1)
            } else {
                class.saturating_sub(1)
            };
            let gap = self.particle[other] - self.particle[class];
            let share = if gap == 0.0 {
                0.0
            } else {
                (mean - self.particle[class]) / gap
            };
            // In mass: number times the class's particle over the mean's.
            let mass_share = share * self.particle[other] / mean;
            for (part, value) in whole.iter().enumerate() {
                rates[other * inner + part] += mass_share * value;
                rates[class * inner + part] += (1.0 - mass_share) * value;
            }
        }
    }
}
