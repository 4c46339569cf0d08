//! What gradients by least squares need of a mesh, made once: with the way d from a cell's centre to that of each neighbour, the
//! weighted ways d/|d|² and Σ d dᵀ/|d|² over the neighbours. Across periodic planes d leads to where the neighbour lies beside the face.

use calcine_coupler::physics::Vec3;
use nalgebra::Matrix3;

/// Ways and their sums; empty where lines between centres are normal to faces.
#[derive(Clone, Debug, Default)]
pub struct LeastSquares {
    /// d/|d|² from the owner of each internal face to its neighbour, in 1/m.
    towards: Vec<Vec3>,
    /// Of each cell.
    sums: Vec<Normal>,
}

/// The matrix of the normal equations of a cell.
#[derive(Clone, Copy, Debug)]
pub enum Normal {
    /// Its inverse, of a cell that has neighbours at all of its faces.
    Inverse(Matrix3<f64>),
    /// Σ d dᵀ/|d|² over the neighbours of a cell on the boundary.
    Inside(Matrix3<f64>),
}

impl LeastSquares {
    /// Of the ways `between` the centres of each internal face's owner and neighbour, and what each cell `meets`: its internal faces, and
    /// whether it has others.
    pub fn new<I: Iterator<Item = usize>>(
        between: &[Vec3],
        cells: usize,
        meets: impl Fn(usize) -> (I, bool),
    ) -> Self {
        let sums = (0..cells).map(|cell| {
            let (faces, has_others) = meets(cell);
            let sum = faces.map(|face| outer(&between[face])).sum();
            match has_others {
                true => Normal::Inside(sum),
                false => Normal::Inverse(inverse(&sum)),
            }
        });
        Self {
            sums: sums.collect(),
            towards: between.iter().map(weighted).collect(),
        }
    }

    /// d/|d|² from the owner of an internal face to its neighbour, in 1/m.
    #[inline]
    pub fn towards(&self, face: usize) -> &Vec3 {
        &self.towards[face]
    }

    /// The normal equations of a cell.
    #[inline]
    pub fn normal(&self, cell: usize) -> &Normal {
        &self.sums[cell]
    }
}

/// d/|d|² in 1/m.
#[inline]
pub fn weighted(way: &Vec3) -> Vec3 {
    way / way.norm_squared()
}

/// d dᵀ/|d|².
#[inline]
pub fn outer(way: &Vec3) -> Matrix3<f64> {
    weighted(way) * way.transpose()
}

/// The faces of a cell look along all directions, so that the sum of their ways can be inverted.
#[inline]
pub fn inverse(sum: &Matrix3<f64>) -> Matrix3<f64> {
    sum.try_inverse().unwrap_or_else(Matrix3::zeros)
}
