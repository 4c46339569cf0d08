//! What moves particles between size classes without losing what else is known of them.

use crate::StreamLayout;
use crate::sums::add_in_turns;

/// How a unit moves the mass of size classes (docs/theory.md, FLS-2): out_j = Σ_i T_ij in_i for every attribute class and
/// compound alike, so that what is red and large stays red where it is large. Rows that sum to 1 conserve mass.
#[derive(Clone, Debug, PartialEq)]
pub enum Transformation {
    /// Classes stay; of class i the share T_ii goes on.
    Diagonal(Vec<f64>),
    /// Whatever its class, mass gets one distribution: T_ij = share_j.
    Uniform(Vec<f64>),
    /// Any matrix, row by row (from class i).
    Full(Vec<f64>),
}

impl Transformation {
    /// Largest deviation of a row's sum from 1.
    pub fn loss(&self, classes: usize) -> f64 {
        let far = |sum: f64| (sum - 1.0).abs();
        match self {
            Self::Diagonal(shares) => shares.iter().map(|s| far(*s)).fold(0.0, f64::max),
            Self::Uniform(shares) => far(shares.iter().sum()),
            Self::Full(matrix) => {
                let rows = matrix.chunks_exact(classes);
                rows.map(|row| far(row.iter().sum())).fold(0.0, f64::max)
            }
        }
    }

    /// Adds what it makes of the solids of a stream to those of another.
    pub fn apply(&self, layout: &StreamLayout, from: &[f64], to: &mut [f64]) {
        let inner = layout.inner();
        if let (Self::Diagonal(shares), 1) = (self, inner) {
            let pairs = to[..layout.solids()].iter_mut().zip(from).zip(shares);
            pairs.for_each(|((made, own), share)| *made += share * own);
            return;
        }
        let classes = from[..layout.solids()].chunks_exact(inner);
        match self {
            Self::Diagonal(shares) => {
                let to = to[..layout.solids()].chunks_exact_mut(inner);
                for ((own, made), share) in classes.zip(to).zip(shares) {
                    add(made, *share, own);
                }
            }
            Self::Uniform(shares) => {
                let mut all = vec![0.0; inner];
                add_in_turns(&from[..layout.solids()], &mut all);
                let to = to[..layout.solids()].chunks_exact_mut(inner);
                for (made, share) in to.zip(shares) {
                    add(made, *share, &all);
                }
            }
            Self::Full(matrix) => {
                let count = layout.grid().classes();
                for (own, row) in classes.zip(matrix.chunks_exact(count)) {
                    let to = to[..layout.solids()].chunks_exact_mut(inner);
                    for (made, share) in to.zip(row).filter(|(_, share)| **share != 0.0) {
                        add(made, *share, own);
                    }
                }
            }
        }
    }
}

fn add(to: &mut [f64], share: f64, what: &[f64]) {
    to.iter_mut().zip(what).for_each(|(t, w)| *t += share * w);
}
