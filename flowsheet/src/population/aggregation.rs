//! Aggregation by cell average.

use calcine_physics::sphere::volume_of_diameter;

use super::{AggregationKernel, SizeProcess};
use crate::sums::{dot, sum};
use crate::{PlantError, SizeGrid};

/// Aggregation of pairs by the cell average technique (docs/theory.md, PBM-6).
///
/// Particles of classes j ≤ k aggregate at the rate (1 − δ_jk/2) β N_j N_k. Births within a class are summed first, then
/// their number is divided between the two classes whose particles lie on both sides of the births' mean mass, so that
/// number and mass are both kept. Attributes and compounds move with the mass. Pairs whose mass exceeds the last
/// class do not aggregate, nor do classes whose mass an explicit step left below zero.
///
/// Source: Kumar, Peglow, Warnecke, Heinrich and Mörl, Chem. Eng. Sci. 61 (2006) 3327, doi 10.1016/j.ces.2005.12.014.
pub struct Aggregation {
    kernel: Box<dyn AggregationKernel>,
    particle: Vec<f64>,
    /// β of each pair of classes in 1/s, row by row; zero where they do not aggregate.
    rates: Vec<f64>,
    /// Class that the mass of pairs j ≤ k falls into, row by row.
    into: Vec<u32>,
    /// How many classes may follow in each row.
    partners: Vec<usize>,
    /// Degree of homogeneity of the kernel among the largest particles.
    degree: f64,
}

impl Aggregation {
    /// Aggregation with a kernel.
    pub fn new(kernel: Box<dyn AggregationKernel>) -> Self {
        Self {
            kernel,
            particle: Vec::new(),
            rates: Vec::new(),
            into: Vec::new(),
            partners: Vec::new(),
            degree: 0.0,
        }
    }

    /// Numbers of particles by class.
    fn numbers(&self, inner: usize, masses: &[f64]) -> Vec<f64> {
        let classes = masses.chunks_exact(inner).zip(&self.particle);
        classes
            .map(|(class, particle)| (class.iter().sum::<f64>() / particle).max(0.0))
            .collect()
    }

    /// Σ_k β_jk N_k of each class in 1/s.
    fn losses(&self, numbers: &[f64]) -> Vec<f64> {
        let rows = self.rates.chunks_exact(numbers.len());
        rows.map(|row| dot(row, numbers)).collect()
    }

    /// Number born into each class in 1/s, and their mass in kg/s, where particles differ in size only.
    fn births(&self, numbers: &[f64]) -> [Vec<f64>; 2] {
        let count = numbers.len();
        let mut born = vec![0.0; count];
        let mut brought = vec![0.0; count];
        let last = numbers.iter().rposition(|n| *n > 0.0).map_or(0, |k| k + 1);
        for j in 0..last {
            let one = numbers[j];
            let partners = self.partners[j].min(last);
            if one == 0.0 || partners <= j {
                continue;
            }
            let row = j * count..j * count + partners;
            let pairs = self.rates[row.clone()].iter().zip(&self.into[row]);
            let others = numbers[..partners].iter().zip(&self.particle);
            let own = self.particle[j];
            for ((rate, into), (other, particle)) in pairs.zip(others).skip(j + 1) {
                let rate = rate * one * other;
                born[*into as usize] += rate;
                brought[*into as usize] += rate * (own + particle);
            }
            let alike = 0.5 * self.rates[j * count + j] * one * one;
            let into = self.into[j * count + j] as usize;
            born[into] += alike;
            brought[into] += alike * 2.0 * own;
        }
        [born, brought]
    }

    /// The same with the mass of each attribute and compound.
    fn births_of_parts(&self, inner: usize, masses: &[f64], numbers: &[f64]) -> [Vec<f64>; 2] {
        let count = numbers.len();
        let mut born = vec![0.0; count];
        let mut brought = vec![0.0; count * inner];
        for j in (0..count).filter(|j| numbers[*j] > 0.0) {
            for k in (j..self.partners[j]).filter(|k| numbers[*k] > 0.0) {
                let half = if j == k { 0.5 } else { 1.0 };
                let rate = half * self.rates[j * count + k] * numbers[j] * numbers[k];
                let into = self.into[j * count + k] as usize;
                born[into] += rate;
                let to = &mut brought[into * inner..(into + 1) * inner];
                for class in [j, k] {
                    let share = rate / numbers[class];
                    let own = &masses[class * inner..(class + 1) * inner];
                    to.iter_mut().zip(own).for_each(|(t, m)| *t += share * m);
                }
            }
        }
        [born, brought]
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
        let mass = |d: &f64| density * volume_of_diameter(*d);
        let edges: Vec<f64> = grid.edges().iter().map(mass).collect();
        self.rates = vec![0.0; count * count];
        self.into = vec![0; count * count];
        self.partners = vec![0; count];
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
                let into = edges.partition_point(|edge| *edge <= mass) - 1;
                for place in [first * count + second, second * count + first] {
                    self.rates[place] = rate;
                    self.into[place] = into as u32;
                }
                self.partners[first] = second + 1;
            }
        }
        let large = 0.25 * particle[count - 1] / density;
        let [single, double] = [large, 2.0 * large].map(|v| self.kernel.rate(v, v));
        self.degree = if single > 0.0 {
            (double / single).log2()
        } else {
            0.0
        };
        self.particle = particle.to_vec();
        Ok(())
    }

    fn add(&self, inner: usize, masses: &[f64], rates: &mut [f64]) {
        let count = self.particle.len();
        let numbers = self.numbers(inner, masses);
        let losses = self.losses(&numbers);
        let [born, brought] = if inner == 1 {
            self.births(&numbers)
        } else {
            self.births_of_parts(inner, masses, &numbers)
        };
        for class in 0..count {
            let own = class * inner..(class + 1) * inner;
            if numbers[class] > 0.0 {
                for (rate, mass) in rates[own.clone()].iter_mut().zip(&masses[own.clone()]) {
                    *rate -= losses[class] * mass;
                }
            }
            let whole = &brought[own];
            let mass = sum(whole);
            if mass == 0.0 {
                continue;
            }
            // Masses below the normal range of numbers have no digits by which a mean could be taken.
            let number = born[class] * self.particle[class];
            let mean = if mass.is_normal() && number.is_normal() {
                mass / born[class]
            } else {
                self.particle[class]
            };
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

    fn fastest(&self, inner: usize, masses: &[f64]) -> f64 {
        let losses = self.losses(&self.numbers(inner, masses));
        losses.into_iter().fold(0.0, f64::max)
    }

    fn gels(&self) -> Option<f64> {
        (self.degree > 1.0 + 1e-9).then_some(self.degree)
    }
}
