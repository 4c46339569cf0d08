//! LU factors of the matrices that stiff integration solves with.

mod block_tridiagonal;
mod dense;
mod lane_tridiagonal;

pub use block_tridiagonal::BlockTridiagonal;
pub use dense::DenseMatrix;
pub use lane_tridiagonal::{LaneTridiagonal, eliminate};

/// Storage, factors and solution of a matrix of one structure. A Jacobian is a slice of `entries` values whose order
/// the structure defines.
pub trait LinearAlgebra {
    /// How many values a matrix of this structure has.
    fn entries(&self) -> usize;

    /// Order of the matrix.
    fn order(&self) -> usize;

    /// Factors diagonal · I − J; false where that is singular or not finite.
    fn factorise(&mut self, diagonal: f64, jacobian: &[f64]) -> bool;

    /// Solves with the factors, in place.
    fn solve(&mut self, x: &mut [f64]);
}
