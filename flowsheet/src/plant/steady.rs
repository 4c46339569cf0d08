//! Steady states and their stability.

use nalgebra::linalg::Schur;
use nalgebra::{Complex, DMatrix, DVector};

use super::flows::{FlowWorkspace, Moment};
use super::topology::Plant;
use crate::PlantError;

/// Most iterations of Newton's method.
const MOST_ITERATIONS: usize = 200;

/// Rates in sizes per second below which differences are taken over a smaller share of the sizes: within a class that is almost empty a
/// larger one passes a kink of the limiter, and the iteration crawls.
const NEAR: f64 = 1e-8;
const FINE: f64 = 1e-4;

/// One mode of small deviations from a steady state: exp((rate + i frequency) t).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Mode {
    /// Growth rate in 1/s; negative where it decays.
    pub rate: f64,
    /// Angular frequency in 1/s.
    pub frequency: f64,
}

/// Whether a steady state is one that a plant returns to.
#[derive(Clone, Debug, PartialEq)]
pub struct Stability {
    /// Modes, the one that decays last (or grows most) first; those that never change are left out.
    pub modes: Vec<Mode>,
}

impl Stability {
    /// Growth rate of the dominant mode in 1/s; a plant without unknowns has none.
    pub fn growth_rate(&self) -> Option<f64> {
        self.modes.first().map(|mode| mode.rate)
    }

    /// Period of the dominant mode in s; infinite where it does not oscillate.
    pub fn period(&self) -> Option<f64> {
        let mode = self.modes.first()?;
        Some(2.0 * std::f64::consts::PI / mode.frequency.abs())
    }
}

/// A state of a plant that does not change.
#[derive(Clone, Debug)]
pub struct SteadyState {
    /// Unknowns.
    pub unknowns: Vec<f64>,
    /// Streams.
    pub flows: FlowWorkspace,
    /// Largest rate of change, in sizes of the unknowns per second ([`Plant::scales`]).
    pub residual: f64,
    /// Iterations.
    pub iterations: usize,
}

impl Plant {
    /// The steady state next to a guess, with schedules as they are at `time` (docs/theory.md, FLS-5): Newton's method
    /// in pseudo-time, whose steps grow as the rates fall, so that what never changes (a fixed hold-up) needs no
    /// equation of its own.
    ///
    /// Source: Kelley and Keyes, SIAM J. Numer. Anal. 35 (1998) 508, doi 10.1137/S0036142996304796.
    pub fn steady(&self, guess: &[f64], time: f64) -> Result<SteadyState, PlantError> {
        self.refuse_beds("no steady state can be looked for")?;
        let at = Moment {
            time,
            end: f64::INFINITY,
        };
        let mut y = guess.to_vec();
        let mut work = FlowWorkspace::new(self);
        let scales = self.scales();
        let mut rates = vec![0.0; self.unknowns + self.totals()];
        self.rates(at, &y, &mut work, &mut rates)?;
        let size = |rates: &[f64]| {
            let relative = rates.iter().zip(&scales).map(|(r, s)| (r / s).abs());
            relative.fold(0.0, f64::max)
        };
        let mut residual = size(&rates);
        let (mut step, mut stalled) = (if residual > 0.0 { 1.0 / residual } else { 1.0 }, 0);
        let mut best = residual;
        let mut entries = Vec::new();
        let fine: Vec<f64> = scales.iter().map(|scale| FINE * scale).collect();
        for iteration in 0..MOST_ITERATIONS {
            // Round-off is reached when the residual no longer falls.
            if residual < 1e-15 || (residual < 1e-11 && stalled >= 2) {
                return Ok(SteadyState {
                    unknowns: y,
                    flows: work,
                    residual,
                    iterations: iteration,
                });
            }
            let sizes = if residual < NEAR { &fine } else { &scales };
            self.jacobian(at, &y, &rates, sizes, &mut work, &mut entries, false)?;
            let mut jacobian = DMatrix::from_row_slice(self.unknowns, self.unknowns, &entries);
            jacobian.neg_mut();
            for k in 0..self.unknowns {
                jacobian[(k, k)] += 1.0 / step;
            }
            let right =
                DVector::from_iterator(self.unknowns, rates[..self.unknowns].iter().copied());
            let Some(change) = jacobian.lu().solve(&right) else {
                step *= 0.5;
                continue;
            };
            let mut tried = y.clone();
            tried
                .iter_mut()
                .zip(change.iter())
                .for_each(|(y, c)| *y += c);
            self.constrain(&mut tried);
            let before = work.streams.clone();
            let mut new = rates.clone();
            let good = self.rates(at, &tried, &mut work, &mut new).is_ok();
            let next = size(&new[..self.unknowns]);
            // Rates may rise on the way, not by orders of magnitude.
            if !good || !next.is_finite() || next > 10.0 * residual {
                work.streams = before;
                step *= 0.2;
                if step < 1e-6 {
                    break;
                }
                continue;
            }
            step = (step * (residual / next).clamp(0.5, 20.0)).min(1e9);
            stalled = if next < 0.5 * best { 0 } else { stalled + 1 };
            best = best.min(next);
            (y, rates, residual) = (tried, new, next);
        }
        Err(PlantError::NoSteadyState {
            residual,
            iterations: MOST_ITERATIONS,
        })
    }

    /// Eigenvalues of the Jacobian at a steady state.
    pub fn stability(&self, at: &SteadyState, time: f64) -> Result<Stability, PlantError> {
        let moment = Moment {
            time,
            end: f64::INFINITY,
        };
        if self.unknowns == 0 {
            return Ok(Stability { modes: Vec::new() });
        }
        let mut work = at.flows.clone();
        let mut rates = vec![0.0; self.unknowns + self.totals()];
        self.rates(moment, &at.unknowns, &mut work, &mut rates)?;
        let scales = self.scales();
        let mut entries = Vec::new();
        self.jacobian(
            moment,
            &at.unknowns,
            &rates,
            &scales,
            &mut work,
            &mut entries,
            true,
        )?;
        let mut matrix = DMatrix::from_row_slice(self.unknowns, self.unknowns, &entries);
        // In sizes of the unknowns, in which the numbers are alike.
        for row in 0..self.unknowns {
            for column in 0..self.unknowns {
                matrix[(row, column)] *= scales[column] / scales[row];
            }
        }
        let Some(eigenvalues) = eigenvalues(&matrix) else {
            return Err(PlantError::NoModes);
        };
        let mut modes: Vec<Mode> = eigenvalues
            .iter()
            .map(|value| Mode {
                rate: value.re,
                frequency: value.im,
            })
            .collect();
        // What never changes has eigenvalues of zero, to round-off.
        modes.sort_by(|a, b| {
            a.rate
                .hypot(a.frequency)
                .total_cmp(&b.rate.hypot(b.frequency))
        });
        modes.drain(..self.invariants().min(modes.len()));
        modes.sort_by(|a, b| {
            b.rate
                .total_cmp(&a.rate)
                .then(b.frequency.total_cmp(&a.frequency))
        });
        Ok(Stability { modes })
    }
}

/// Eigenvalues of a matrix; `None` where the QR algorithm does not converge.
///
/// Between diagonal elements that are zero, the algorithm never takes an element beside them for nothing: it is repeated with all eigenvalues
/// moved away from zero by the matrix's norm, which costs them round-off of that norm.
fn eigenvalues(matrix: &DMatrix<f64>) -> Option<Vec<Complex<f64>>> {
    const SWEEPS: usize = 100;
    let size = matrix.nrows();
    [0.0, matrix.norm(), -2.0 * matrix.norm()]
        .into_iter()
        .find_map(|shift| {
            let mut moved = matrix.clone();
            for k in 0..size {
                moved[(k, k)] += shift;
            }
            let schur = Schur::try_new(moved, f64::EPSILON, SWEEPS * size)?;
            let found = schur.complex_eigenvalues();
            Some(found.iter().map(|value| value - shift).collect())
        })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A hold-up m with a PI controller of its discharge, filter 5 s, gain −0.02 1/s, time 100 s: x' = (m − x)/5, I' = 2e-4 (x − w),
    /// m' = −0.02 (x − w) − I; beside what never changes.
    #[test]
    fn the_modes_of_a_controlled_hold_up_are_found_beside_zeros() {
        let rows = [
            [0.0, -0.02, -1.0, 0.0],
            [0.2, -0.2, 0.0, 0.0],
            [0.0, 2e-4, 0.0, 0.0],
            [0.0, 0.0, 0.0, 0.0],
        ];
        let matrix = DMatrix::from_row_slice(4, 4, &rows.concat());
        let found = eigenvalues(&matrix).unwrap();
        // Of λ (λ³ + 0.2 λ² + 0.004 λ + 4e-5).
        for value in found {
            let cubic = ((value + 0.2) * value + 0.004) * value + 4e-5;
            assert!((cubic * value).norm() < 1e-14, "{value}");
        }
        let nothing = DMatrix::<f64>::zeros(3, 3);
        assert!(
            eigenvalues(&nothing)
                .unwrap()
                .iter()
                .all(|value| value.norm() == 0.0)
        );
    }
}
