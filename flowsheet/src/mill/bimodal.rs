//! Bond's law with particles that break in two.

use std::fmt::Display;

use calcine_physics::law::LawEntry;

use super::bond::{POWER, WORK_INDEX};
use super::model::MillLaw;
use super::{BondLaw, BondLength};
use crate::distribution::quantile;
use crate::{PlantError, SizeGrid, Transformation};

/// A mill that breaks a share p of each class into two equal fragments, of diameter d/2^(1/3), once. p is such that the
/// product has the x₈₀ of Bond's law; at p = 1 the mill cannot do more, and an x₈₀ below that is an error.
///
/// A class's fragments are spread evenly over its shrunk width; what would lie below the grid stays in its first class.
///
/// Source: the unit "Crusher" of Dyssol (SoftwareX 12 (2020) 100572, doi 10.1016/j.softx.2020.100572), which repeats the
/// breakage where one does not suffice.
#[derive(Clone, Debug, PartialEq)]
pub struct BondBimodal {
    /// Work, index and length.
    pub bond: BondLaw,
}

impl BondBimodal {
    /// T of a mill in which everything breaks, row by row.
    fn halves(grid: &SizeGrid) -> Vec<f64> {
        let count = grid.classes();
        let shrink = 2f64.cbrt();
        let mut matrix = vec![0.0; count * count];
        for (class, row) in matrix.chunks_exact_mut(count).enumerate() {
            let from = grid.edges()[class] / shrink;
            let to = grid.edges()[class + 1] / shrink;
            let mut rest = 1.0;
            for made in (1..=class).rev() {
                let (low, high) = (grid.edges()[made], grid.edges()[made + 1]);
                let share = (high.min(to) - low.max(from)).max(0.0) / (to - from);
                row[made] = share;
                rest -= share;
            }
            row[0] = if rest.abs() < 1e-14 { 0.0 } else { rest };
        }
        matrix
    }
}

impl MillLaw for BondBimodal {
    fn transformation(
        &self,
        grid: &SizeGrid,
        feed: &[f64],
        place: &dyn Display,
    ) -> Result<Transformation, PlantError> {
        self.bond.check(place)?;
        let count = grid.classes();
        let halves = Self::halves(grid);
        let mut broken = vec![0.0; count];
        for (mass, row) in feed.iter().zip(halves.chunks_exact(count)) {
            broken
                .iter_mut()
                .zip(row)
                .for_each(|(b, share)| *b += mass * share);
        }
        let flow: f64 = feed.iter().sum();
        let size = quantile(grid, feed, 0.8).unwrap_or(f64::NAN);
        let wanted = self.bond.product_size(size, flow);
        let size_at = |p: f64| {
            let mixed: Vec<f64> = feed
                .iter()
                .zip(&broken)
                .map(|(a, b)| (1.0 - p) * a + p * b)
                .collect();
            quantile(grid, &mixed, 0.8).unwrap_or(f64::NAN)
        };
        let least = size_at(1.0);
        if wanted.is_nan() || wanted < least {
            return Err(PlantError::Value {
                place: place.to_string(),
                quantity: "x80 of the product in m",
                value: wanted,
                allowed: "particles break in two once and do not get that small; lower the power, or take `bond-normal`",
            });
        }
        // The size falls as p rises.
        let (mut low, mut high) = (0.0, 1.0);
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            if size_at(middle) > wanted {
                low = middle;
            } else {
                high = middle;
            }
        }
        let p = 0.5 * (low + high);
        let mut matrix: Vec<f64> = halves.iter().map(|share| p * share).collect();
        for class in 0..count {
            matrix[class * count + class] += 1.0 - p;
        }
        Ok(Transformation::Full(matrix))
    }

    fn power(&self) -> f64 {
        self.bond.power
    }
}

/// Its entry in a case file.
pub(super) static LAW: LawEntry<dyn MillLaw> = LawEntry {
    name: "bond-bimodal",
    summary: "Particles that break in two, to the x80 of Bond's law.",
    source: "Bond, Trans. AIME 193 (1952) 484; as the crusher of Dyssol, SoftwareX 12 (2020) 100572, doi 10.1016/j.softx.2020.100572",
    parameters: &[WORK_INDEX, POWER],
    tables: &[],
    make: |values| {
        Box::new(BondBimodal {
            bond: BondLaw {
                work_index: values[0],
                power: values[1],
                length: BondLength::Micrometre,
            },
        })
    },
};

/// Its entry in a case file.
pub(super) static IN_MILLIMETRES: LawEntry<dyn MillLaw> = LawEntry {
    name: "bond-mm-bimodal",
    summary: "The same with sizes in mm where Bond has them in µm, as Dyssol computes it.",
    source: "Bond, Trans. AIME 193 (1952) 484; as the crusher of Dyssol, SoftwareX 12 (2020) 100572, doi 10.1016/j.softx.2020.100572",
    parameters: &[WORK_INDEX, POWER],
    tables: &[],
    make: |values| {
        Box::new(BondBimodal {
            bond: BondLaw {
                work_index: values[0],
                power: values[1],
                length: BondLength::Millimetre,
            },
        })
    },
};
