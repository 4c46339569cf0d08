//! Fields on blocks of equal cells, as OpenFOAM and Calcine write them, and their differences.

use std::fs;
use std::path::Path;

use crate::openfoam::internal_field;
use crate::snapshots::appended;
use crate::steps::{Stop, TaskResult};

/// Values of the cells of a block of `counts` cells along x and y, x fastest, all components of a cell together.
#[derive(Clone, Debug, PartialEq)]
pub struct MeanField {
    pub counts: [usize; 2],
    pub components: usize,
    pub values: Vec<f64>,
}

impl MeanField {
    /// A field of one component or three by its values; nothing where their number is that of neither.
    pub fn new(counts: [usize; 2], values: Vec<f64>) -> Option<Self> {
        let cells = counts[0] * counts[1];
        let components = [1, 3].into_iter().find(|n| n * cells == values.len())?;
        Some(Self {
            counts,
            components,
            values,
        })
    }

    /// Means over blocks of cells, so many along x and y; nothing where cells do not fill them.
    pub fn restricted(&self, counts: [usize; 2]) -> Option<Self> {
        let whole = (0..2).all(|axis| self.counts[axis].is_multiple_of(counts[axis]));
        let each = [0, 1].map(|axis| self.counts[axis] / counts[axis]);
        let mut values = vec![0.0; counts[0] * counts[1] * self.components];
        let share = 1.0 / (each[0] * each[1]) as f64;
        for (cell, tuple) in self.values.chunks_exact(self.components).enumerate() {
            let place = [
                cell % self.counts[0] / each[0],
                cell / self.counts[0] / each[1],
            ];
            let to = (place[1] * counts[0] + place[0]) * self.components;
            for (component, value) in tuple.iter().enumerate() {
                *values.get_mut(to + component)? += share * value;
            }
        }
        whole.then_some(Self {
            counts,
            values,
            ..*self
        })
    }

    /// Means over the cells of a square of values at places, of many points in each.
    pub fn means(counts: [usize; 2], edge: f64, values: fn(f64, f64) -> Vec<f64>) -> Option<Self> {
        const POINTS: usize = 16;
        let fine = counts.map(|count| POINTS * count);
        let place = |at: usize, axis: usize| edge * (at as f64 + 0.5) / fine[axis] as f64;
        let points = (0..fine[0] * fine[1]).map(|point| (point % fine[0], point / fine[0]));
        let all = points.flat_map(|(x, y)| values(place(x, 0), place(y, 1)));
        Self::new(fine, all.collect())?.restricted(counts)
    }

    /// The sum of fields on the same cells, each times its weight.
    pub fn sum(terms: &[(f64, &MeanField)]) -> Self {
        let mut sum = terms[0].1.clone();
        sum.values.fill(0.0);
        for (weight, field) in terms {
            for (value, other) in sum.values.iter_mut().zip(&field.values) {
                *value += weight * other;
            }
        }
        sum
    }

    /// Root mean square of the distance to a constant, over cells.
    pub fn size(&self, level: f64) -> f64 {
        let squares: f64 = self
            .values
            .iter()
            .map(|value| (value - level).powi(2))
            .sum();
        (squares / (self.counts[0] * self.counts[1]) as f64).sqrt()
    }

    /// Root mean square of the difference to another field on the same cells.
    pub fn distance(&self, other: &MeanField) -> f64 {
        Self::sum(&[(1.0, self), (-1.0, other)]).size(0.0)
    }
}

/// The internal field of a file of OpenFOAM in ASCII.
pub fn of_openfoam(path: &Path, counts: [usize; 2]) -> TaskResult<MeanField> {
    let text = fs::read_to_string(path).map_err(|cause| Stop::io(path, &cause))?;
    let values = internal_field(&text, counts[0] * counts[1]);
    let field = values.and_then(|values| MeanField::new(counts, values));
    field.ok_or_else(|| {
        Stop(format!(
            "{}: not a field of {counts:?} cells",
            path.display()
        ))
    })
}

/// An array of cells of a VTU file of Calcine.
pub fn of_calcine(path: &Path, name: &str, counts: [usize; 2]) -> TaskResult<MeanField> {
    let bytes = fs::read(path).map_err(|cause| Stop::io(path, &cause))?;
    let field = appended(&bytes, name).and_then(|values| MeanField::new(counts, values));
    field.ok_or_else(|| {
        Stop(format!(
            "{}: no `{name}` of {counts:?} cells",
            path.display()
        ))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn blocks_of_cells_are_averaged_and_sums_keep_what_they_should() {
        let values: Vec<f64> = (0..16).map(f64::from).collect();
        let fine = MeanField::new([4, 4], values).unwrap();
        let coarse = fine.restricted([2, 2]).unwrap();
        assert_eq!(coarse.values, [2.5, 4.5, 10.5, 12.5]);
        assert_eq!(fine.restricted([3, 2]), None);
        let difference = MeanField::sum(&[(2.0, &coarse), (-1.0, &coarse)]);
        assert_eq!(difference, coarse);
        assert_eq!(coarse.distance(&difference), 0.0);
        let lengths = MeanField::new([1, 1], vec![3.0, 0.0, 4.0]).unwrap();
        assert_eq!(lengths.size(0.0), 5.0);
    }
}
