//! Aggregates of strongly coupled unknowns, and the smoothed interpolation from them.
//!
//! Vaněk, Mandel and Brezina 1996, doi 10.1007/BF02238511; the strength of a coupling is measured
//! against the strongest ones of both sides, so that anisotropy and jumps of coefficients are
//! seen alike.

use super::parallel::fill;
use super::sparse::Rows;

/// Damping of the Jacobi step that smooths the interpolation: 4/3 over the largest eigenvalue of
/// D⁻¹A, which is below 2 for a matrix of differences.
const SMOOTHING: f64 = 2.0 / 3.0;
/// What belongs to no aggregate.
const NONE: u32 = u32::MAX;

/// The strongest coupling of each unknown.
fn strongest(matrix: &Rows) -> Vec<f64> {
    let mut strongest = vec![0.0; matrix.len()];
    fill(&mut strongest, |index| {
        let others = matrix.pairs(index).filter(|pair| pair.0 as usize != index);
        others.fold(0.0f64, |most, (_, value)| most.max(-value))
    });
    strongest
}

/// Which couplings of a matrix are strong: −a_ij > θ √(m_i m_j), m the strongest of each side.
struct Strength<'a> {
    matrix: &'a Rows,
    strongest: Vec<f64>,
    threshold: f64,
}

impl Strength<'_> {
    #[inline]
    fn is_strong(&self, from: usize, to: u32, value: f64) -> bool {
        let product = self.strongest[from] * self.strongest[to as usize];
        to as usize != from
            && value < 0.0
            && value * value > self.threshold * self.threshold * product
    }

    fn neighbours(&self, of: usize) -> impl Iterator<Item = (u32, f64)> {
        let strong = move |&(to, value): &(u32, f64)| self.is_strong(of, to, value);
        self.matrix.pairs(of).filter(strong)
    }

    /// The aggregate of each unknown, and their number. An unknown without strong couplings is in
    /// none: the smoother alone solves for it.
    fn aggregates(&self) -> (Vec<u32>, u32) {
        let mut aggregate = vec![NONE; self.matrix.len()];
        let mut count = 0;
        for root in 0..aggregate.len() {
            let free = |(other, _): (u32, f64)| aggregate[other as usize] == NONE;
            let alone = self.neighbours(root).next().is_none();
            if alone || aggregate[root] != NONE || !self.neighbours(root).all(free) {
                continue;
            }
            aggregate[root] = count;
            for (other, _) in self.neighbours(root) {
                aggregate[other as usize] = count;
            }
            count += 1;
        }
        let roots = aggregate.clone();
        fill(&mut aggregate, |index| {
            if roots[index] != NONE {
                return roots[index];
            }
            let taken = self
                .neighbours(index)
                .filter(|pair| roots[pair.0 as usize] != NONE);
            let nearest = taken.fold((NONE, 0.0), |best, (other, value)| {
                if value < best.1 { (other, value) } else { best }
            });
            roots.get(nearest.0 as usize).copied().unwrap_or(NONE)
        });
        (aggregate, count)
    }
}

/// The interpolation from aggregates to the unknowns of a matrix, and the number of aggregates:
/// one for each, smoothed by a step of Jacobi with the strong couplings (the weak ones are added
/// to the diagonal, so that constants stay constant).
pub fn interpolation(matrix: &Rows, threshold: f64) -> (Rows, usize) {
    let strength = Strength {
        matrix,
        strongest: strongest(matrix),
        threshold,
    };
    let (aggregate, count) = strength.aggregates();
    let rows = Rows::build(matrix.len(), count as usize, |index, entries| {
        if aggregate[index] == NONE {
            return;
        }
        let filtered: f64 = matrix
            .pairs(index)
            .filter(|&(other, value)| !strength.is_strong(index, other, value))
            .map(|pair| pair.1)
            .sum();
        if filtered <= 0.0 {
            entries.add(aggregate[index], 1.0);
            return;
        }
        entries.add(aggregate[index], 1.0 - SMOOTHING);
        for (other, value) in strength.neighbours(index) {
            let of = aggregate[other as usize];
            if of != NONE {
                entries.add(of, -SMOOTHING * value / filtered);
            }
        }
    });
    (rows, count as usize)
}
