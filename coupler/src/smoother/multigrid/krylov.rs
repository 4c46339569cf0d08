//! Conjugate gradients around the cycle: accurate solutions, and how well the cycle works.

use nalgebra::DMatrix;

use super::Multigrid;
use calcine_numerics::parallel;

const MOST_STEPS: usize = 200;
/// Steps without a smaller residual after which round-off is all that is left.
const PATIENCE: usize = 8;
/// Steps that show the lowest eigenvalue.
const STEPS_FOR_EIGENVALUE: usize = 14;

impl Multigrid {
    /// Solves H x = rhs from the x given, until no residual is larger than the tolerance times the
    /// scale of its row, or round-off is reached. (A stop by the norm alone would leave large
    /// residuals in a few cells unseen.)
    pub fn solve(&self, rhs: &[f64], x: &mut [f64], scale: &[f64], tolerance: f64) {
        let mut least = f64::INFINITY;
        let mut waited = 0;
        self.conjugate(rhs, x, MOST_STEPS, |residual| {
            let relative = |row: usize| residual[row].abs() / scale[row];
            let largest = parallel::largest(residual.len(), relative).1;
            waited = if largest < least { 0 } else { waited + 1 };
            least = least.min(largest);
            largest <= tolerance || waited > PATIENCE
        });
    }

    /// The smallest eigenvalue of MH, from the Lanczos process that conjugate gradients are, on
    /// the residual of pseudo-random numbers; a little above the truth.
    pub fn least_eigenvalue(&self) -> f64 {
        let rows = self.matrix().rows();
        let mut rhs = vec![0.0; rows];
        parallel::fill(&mut rhs, |row| {
            let hash = (row as u64 + 1).wrapping_mul(0x9E37_79B9_7F4A_7C15) >> 11;
            self.matrix().diagonal[row] * (hash as f64 / (1u64 << 53) as f64 - 0.5)
        });
        let mut x = vec![0.0; rows];
        let steps = self.conjugate(&rhs, &mut x, STEPS_FOR_EIGENVALUE, |_| false);
        let size = steps.len();
        if size == 0 {
            return 1.0;
        }
        let mut lanczos = DMatrix::<f64>::zeros(size, size);
        for (k, &(alpha, beta)) in steps.iter().enumerate() {
            lanczos[(k, k)] += 1.0 / alpha;
            if k + 1 < size {
                lanczos[(k + 1, k + 1)] += beta / alpha;
                let side = beta.sqrt() / alpha;
                lanczos[(k, k + 1)] = side;
                lanczos[(k + 1, k)] = side;
            }
        }
        lanczos.symmetric_eigenvalues().min()
    }

    /// Preconditioned conjugate gradients until `stop` says so of the residual; returns (α, β) of
    /// each step.
    fn conjugate(
        &self,
        rhs: &[f64],
        x: &mut [f64],
        most: usize,
        mut stop: impl FnMut(&[f64]) -> bool,
    ) -> Vec<(f64, f64)> {
        let matrix = self.matrix();
        let rows = matrix.rows();
        let mut scratch = vec![0.0; self.scratch()];
        let (mut residual, mut through) = (vec![0.0; rows], vec![0.0; rows]);
        parallel::fill(&mut residual, |row| matrix.residual(row, rhs, x));
        self.cycle(&residual, &mut through, &mut scratch);
        let mut direction = through.clone();
        let zero = vec![0.0; rows];
        let mut image = vec![0.0; rows];
        let dot = |a: &[f64], b: &[f64]| parallel::sum(rows, |row| a[row] * b[row]);
        let mut size = dot(&residual, &through);
        let first = size;
        let mut steps = Vec::new();
        // Below the square of round-off nothing is left to gain.
        while steps.len() < most && size > 1e-34 * first && size > 0.0 && !stop(&residual) {
            parallel::fill(&mut image, |row| -matrix.residual(row, &zero, &direction));
            let alpha = size / dot(&direction, &image);
            parallel::update(x, |row, x| *x += alpha * direction[row]);
            parallel::update(&mut residual, |row, r| *r -= alpha * image[row]);
            self.cycle(&residual, &mut through, &mut scratch);
            let next = dot(&residual, &through);
            let beta = next / size;
            parallel::update(&mut direction, |row, d| *d = through[row] + beta * *d);
            size = next;
            steps.push((alpha, beta));
        }
        steps
    }
}
