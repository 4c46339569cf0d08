//! Conjugate gradients on a network of conductances.

/// Relative residual at which an implicit step ends: far below what a window's other errors are, and
/// energy does not depend on it, because flows go from one node to the other whatever they are.
const TOLERANCE: f64 = 1e-12;

/// A symmetric network: node i holds C_i (T_i − T_i,old) = h_i (S_i − T_i) + Σ_j G_ij (T_j − T_i); for a particle
/// C and T_old are its surface line.
#[derive(Clone, Copy, Debug)]
pub struct NetworkSystem<'a> {
    /// Pairs of nodes and their conductance G in W/K.
    pub bonds: &'a [([usize; 2], f64)],
    /// C in W/K; zero for a node that only passes heat on.
    pub capacity: &'a [f64],
    /// T_old in K.
    pub old: &'a [f64],
    /// Conductance h in W/K to what has a given temperature.
    pub sink_conductance: &'a [f64],
    /// h (S − T_old) in W.
    pub drive: &'a [f64],
}

/// Conjugate gradients that ended at their limit, or with NaN.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct UnsolvedNetwork {
    /// Residual over that at the old temperatures.
    pub residual: f64,
}

/// Scratch of the conjugate gradients.
#[derive(Debug, Default)]
pub struct NetworkSolver {
    diagonal: Vec<f64>,
    residual: Vec<f64>,
    direction: Vec<f64>,
    product: Vec<f64>,
}

impl NetworkSolver {
    /// Solves for the temperatures in K, from those given on; preconditioned by the diagonal. An error where the
    /// residual stayed above the tolerance, or is NaN.
    pub fn solve(
        &mut self,
        system: &NetworkSystem<'_>,
        temperature: &mut [f64],
    ) -> Result<(), UnsolvedNetwork> {
        let count = temperature.len();
        let NetworkSystem {
            bonds,
            capacity,
            old,
            sink_conductance,
            drive,
        } = *system;
        let Self {
            diagonal,
            residual: r,
            direction: p,
            product: q,
        } = self;
        let x = temperature;
        diagonal.clear();
        diagonal.extend(capacity.iter().zip(sink_conductance).map(|(c, h)| c + h));
        for &([i, j], g) in bonds {
            diagonal[i] += g;
            diagonal[j] += g;
        }
        // Residuals at the old temperatures, which set the scale, and at those to start from.
        p.clear();
        p.extend_from_slice(drive);
        r.clear();
        r.extend(
            (0..count).map(|i| drive[i] - (capacity[i] + sink_conductance[i]) * (x[i] - old[i])),
        );
        for &([i, j], g) in bonds {
            let (before, now) = (g * (old[j] - old[i]), g * (x[j] - x[i]));
            p[i] += before;
            p[j] -= before;
            r[i] += now;
            r[j] -= now;
        }
        // A node to which nothing leads has no equation.
        for d in diagonal.iter_mut().filter(|d| **d == 0.0) {
            *d = 1.0;
        }
        let norm = |of: &[f64]| {
            of.iter()
                .zip(&*diagonal)
                .map(|(r, d)| r * r / d)
                .sum::<f64>()
        };
        let scale = norm(p);
        let goal = TOLERANCE * TOLERANCE * scale;
        p.clear();
        p.resize(count, 0.0);
        q.resize(count, 0.0);
        let mut before = 0.0;
        for step in 0..count.max(10) * 10 {
            let product = norm(r);
            if product <= goal || product == 0.0 {
                return Ok(());
            }
            if !product.is_finite() {
                break;
            }
            let share = if step == 0 { 0.0 } else { product / before };
            before = product;
            for i in 0..count {
                p[i] = r[i] / diagonal[i] + share * p[i];
                q[i] = diagonal[i] * p[i];
            }
            for &([i, j], g) in bonds {
                q[i] -= g * p[j];
                q[j] -= g * p[i];
            }
            let curvature: f64 = p.iter().zip(q.iter()).map(|(p, q)| p * q).sum();
            let length = product / curvature;
            for i in 0..count {
                x[i] += length * p[i];
                r[i] -= length * q[i];
            }
        }
        let residual = (norm(r) / scale).sqrt();
        Err(UnsolvedNetwork { residual })
    }
}
