//! What reactors and Newton's step see of the equations of the scalars.

use crate::numerics::matrix::Matrix;

/// Equations of species and enthalpy without reactions: what flows, diffuses and is conducted.
#[derive(Clone, Copy, Debug)]
pub struct ScalarEquations<'a> {
    /// Matrix of the first species.
    pub species: &'a Matrix,
    /// Right sides of all species in kg/s, species by species within each cell.
    pub sources: &'a [f64],
    /// Diffusive conductance of each face in kg/s, a part of the matrix.
    pub diffusion: &'a [f64],
    /// Matrix of the enthalpy.
    pub enthalpy: &'a Matrix,
    /// Its right side in W.
    pub heat: &'a [f64],
}
