//! The cases: what is solved, on which meshes and steps, and what the errors are measured against.

use super::field::MeanField;
use super::start::Start;

/// A flow that every solver computes. Its files are below `of-cases/gas-error`: `case.toml` for Calcine, `stock` for
/// the solver of OpenFOAM, on the same box, boundaries and properties.
pub struct ErrorCase {
    pub name: &'static str,
    /// Name of OpenFOAM's solver.
    pub stock: &'static str,
    /// Cells along x and y of the coarsest mesh. All fields are averaged to these cells before they are compared.
    pub coarsest: [usize; 2],
    /// End in s.
    pub end: f64,
    pub quantities: &'static [ErrorQuantity],
    /// The runs of all solvers.
    pub runs: &'static [Resolution],
    /// The same with `CALCINE_BENCH_LARGE`.
    pub large: &'static [Resolution],
    pub reference: Reference,
    /// The flow at the start; at rest without it.
    pub start: Option<Start>,
}

/// A field whose error is measured.
pub struct ErrorQuantity {
    pub name: &'static str,
    /// Its name in Calcine's files and in OpenFOAM's.
    pub calcine: &'static str,
    pub openfoam: &'static str,
    /// Errors are relative to the reference's distance to this value.
    pub level: f64,
}

/// A mesh and a time step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Resolution {
    /// How many times finer than the coarsest mesh along x and y.
    pub factor: usize,
    /// Time step in s.
    pub step: f64,
}

/// What errors are measured against.
pub enum Reference {
    /// OpenFOAM's solver with a time scheme of second order (`backward`), extrapolated from this resolution and one
    /// of twice its cell and step, as errors of second order in both. Of half its cell and step for large runs.
    Extrapolated(Resolution),
    /// The exact values of the only quantity at a place (x, y) in m, and the edge of the square in m.
    Exact(fn(f64, f64) -> Vec<f64>, f64),
}

/// A gas of Calcine with its settings.
#[derive(Clone, Copy, Debug)]
pub struct CoupledGas {
    /// `native` or `openfoam`.
    pub gas: &'static str,
    /// Words of `--set`.
    pub set: &'static [&'static str],
    /// How many times longer its windows are than the steps of the others.
    pub longer: u32,
}

pub const fn at(factor: usize, milliseconds: f64) -> Resolution {
    Resolution {
        factor,
        step: 1e-3 * milliseconds,
    }
}

impl ErrorCase {
    /// Cells along x and y.
    pub fn cells(&self, resolution: Resolution) -> [usize; 2] {
        self.coarsest.map(|count| count * resolution.factor)
    }

    /// The finest mesh, as a multiple of the coarsest, that a gas of Calcine runs on: slower ones would take most of the time of
    /// a benchmark. Nothing where it takes no part.
    pub fn finest(&self, gas: &CoupledGas, large: bool) -> Option<usize> {
        match (gas.gas, gas.set.is_empty(), large) {
            ("native", ..) => Some(usize::MAX),
            (_, true, false) => None,
            (_, true, true) => Some(2),
            (_, false, false) => Some(2),
            (_, false, true) => Some(8),
        }
    }

    /// Errors of fields on the coarsest mesh relative to the sizes of the reference.
    pub fn errors(&self, fields: &[MeanField], reference: &[MeanField]) -> Vec<f64> {
        let each = fields.iter().zip(reference).zip(self.quantities);
        let errors = each.map(|((field, reference), quantity)| {
            field.distance(reference) / reference.size(quantity.level)
        });
        errors.collect()
    }
}
