//! The cases: what is solved, on which meshes and steps, and what the errors are measured against.

use super::coupled::Gas;
use super::field::Field;
use super::start::Start;
use super::{cavity, five_species, heated_cavity, taylor_green};

/// A flow that every solver computes. Its files are below `of-cases/gas-error`: `case.toml` for Calcine, `stock` for
/// the solver of OpenFOAM, on the same box, boundaries and properties.
pub struct Case {
    pub name: &'static str,
    /// Name of OpenFOAM's solver.
    pub stock: &'static str,
    /// Cells along x and y of the coarsest mesh. All fields are averaged to these cells before they are compared.
    pub coarsest: [usize; 2],
    /// End in s.
    pub end: f64,
    pub quantities: &'static [Quantity],
    /// The finest mesh, as a multiple of the coarsest, that gases with the default tolerances of Calcine run on unless large
    /// runs are asked for.
    pub finest_strict: usize,
    /// The runs of all solvers.
    pub runs: &'static [Resolution],
    /// The same with `CALCINE_BENCH_LARGE`.
    pub large: &'static [Resolution],
    pub reference: Reference,
    /// The flow at the start; at rest without it.
    pub start: Option<Start>,
}

/// A field whose error is measured.
pub struct Quantity {
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
    /// of twice its cell and step, as errors of second order in both.
    Extrapolated(Resolution),
    /// The exact values of the only quantity at a place (x, y) in m, and the edge of the square in m.
    Exact(fn(f64, f64) -> Vec<f64>, f64),
}

pub const ALL: [&Case; 4] = [
    &cavity::CASE,
    &taylor_green::CASE,
    &heated_cavity::CASE,
    &five_species::CASE,
];

pub const fn at(factor: usize, milliseconds: f64) -> Resolution {
    Resolution {
        factor,
        step: 1e-3 * milliseconds,
    }
}

impl Case {
    /// Cells along x and y.
    pub fn cells(&self, resolution: Resolution) -> [usize; 2] {
        self.coarsest.map(|count| count * resolution.factor)
    }

    /// The finest mesh, as a multiple of the coarsest, that a gas runs on unless large runs are asked for: a default benchmark
    /// takes minutes.
    pub fn finest(&self, gas: &Gas) -> usize {
        match (gas.gas, gas.set.is_empty()) {
            ("native", true) => self.finest_strict,
            ("native", false) => usize::MAX,
            (_, true) => 1,
            (_, false) => 2,
        }
    }

    /// Errors of fields on the coarsest mesh relative to the sizes of the reference.
    pub fn errors(&self, fields: &[Field], reference: &[Field]) -> Vec<f64> {
        let each = fields.iter().zip(reference).zip(self.quantities);
        let errors = each.map(|((field, reference), quantity)| {
            field.distance(reference) / reference.size(quantity.level)
        });
        errors.collect()
    }
}
