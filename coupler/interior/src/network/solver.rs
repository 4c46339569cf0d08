//! Conjugate gradients on a network of conductances, on threads with the same bits on any number of them.

use calcine_numerics::parallel::{fill, sum, update, update_both};

/// Relative residual at which an implicit step ends: far below what a window's other errors are, and
/// energy does not depend on it, because flows go from one node to the other whatever they are.
const TOLERANCE: f64 = 1e-12;

/// A symmetric network: node i holds C_i (T_i − T_i,old) = h_i (S_i − T_i) + Σ_j G_ij (T_j − T_i); for a particle
/// C and T_old are its surface line. Where C is infinite T_i is T_old.
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

/// Conjugate gradients that ended at their limit, with NaN, or on a network that is not positive definite.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct UnsolvedNetwork {
    /// Residual over that at the old temperatures.
    pub residual: f64,
}

/// Scratch of the conjugate gradients.
#[derive(Debug, Default)]
pub struct NetworkSolver {
    graph: BondGraph,
    diagonal: Vec<f64>,
    residual: Vec<f64>,
    direction: Vec<f64>,
    product: Vec<f64>,
}

/// What is bonded to each node, in the order of the bonds.
#[derive(Debug, Default)]
struct BondGraph {
    /// Where the neighbours of each node end; those of the next begin there.
    ends: Vec<usize>,
    neighbour: Vec<u32>,
    conductance: Vec<f64>,
}

impl BondGraph {
    fn set(&mut self, nodes: usize, bonds: &[([usize; 2], f64)]) {
        let ends = &mut self.ends;
        ends.clear();
        ends.resize(nodes + 1, 0);
        for &([i, j], _) in bonds {
            ends[i + 1] += 1;
            ends[j + 1] += 1;
        }
        for node in 0..nodes {
            ends[node + 1] += ends[node];
        }
        self.neighbour.resize(2 * bonds.len(), 0);
        self.conductance.resize(2 * bonds.len(), 0.0);
        // Each entry counts from the start of its node on, which so becomes its end.
        for &([i, j], g) in bonds {
            for (node, other) in [(i, j), (j, i)] {
                let place = ends[node];
                self.neighbour[place] = other as u32;
                self.conductance[place] = g;
                ends[node] = place + 1;
            }
        }
    }

    /// Neighbours of a node and the conductances to them in W/K.
    fn around(&self, node: usize) -> impl Iterator<Item = (usize, f64)> {
        let start = if node == 0 { 0 } else { self.ends[node - 1] };
        let own = start..self.ends[node];
        let neighbour = self.neighbour[own.clone()].iter();
        let pairs = neighbour.zip(&self.conductance[own]);
        pairs.map(|(other, g)| (*other as usize, *g))
    }
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
        self.graph.set(count, bonds);
        let Self {
            graph,
            diagonal,
            residual: r,
            direction: p,
            product: q,
        } = self;
        let x = temperature;
        for scratch in [&mut *diagonal, r, p, q] {
            scratch.resize(count, 0.0);
        }
        let fixed = |i: usize| capacity[i].is_infinite();
        fill(diagonal, |i| {
            let own = capacity[i] + sink_conductance[i];
            let sum = graph.around(i).fold(own, |sum, (_, g)| sum + g);
            // A node to which nothing leads has no equation.
            if sum == 0.0 { 1.0 } else { sum }
        });
        update(x, |i, x| {
            if fixed(i) {
                *x = old[i];
            }
        });
        // Residuals at the old temperatures, which set the scale, and at those to start from.
        fill(p, |i| {
            if fixed(i) {
                return 0.0;
            }
            let flows = graph.around(i).map(|(j, g)| g * (old[j] - old[i]));
            flows.fold(drive[i], |sum, flow| sum + flow)
        });
        fill(r, |i| {
            if fixed(i) {
                return 0.0;
            }
            let own = drive[i] - (capacity[i] + sink_conductance[i]) * (x[i] - old[i]);
            let flows = graph.around(i).map(|(j, g)| g * (x[j] - x[i]));
            flows.fold(own, |sum, flow| sum + flow)
        });
        let norm = |of: &[f64]| sum(count, |i| of[i] * of[i] / diagonal[i].abs());
        let scale = norm(p);
        let goal = TOLERANCE * TOLERANCE * scale;
        p.fill(0.0);
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
            update(p, |i, p| *p = r[i] / diagonal[i] + share * *p);
            let direction = &*p;
            fill(q, |i| {
                if fixed(i) {
                    return 0.0;
                }
                let own = diagonal[i] * direction[i];
                graph
                    .around(i)
                    .fold(own, |sum, (j, g)| sum - g * direction[j])
            });
            let curvature = sum(count, |i| direction[i] * q[i]);
            // Of a network that is not positive definite: there is no minimum to go to.
            if curvature.is_nan() || curvature <= 0.0 {
                break;
            }
            let length = product / curvature;
            update_both(x, r, |i, x, r| {
                *x += length * direction[i];
                *r -= length * q[i];
            });
        }
        let residual = (norm(r) / scale).sqrt();
        Err(UnsolvedNetwork { residual })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A chain of three nodes with a surface line of conductance c in W/K each, of which the first begins hotter.
    fn chain(capacity: [f64; 3]) -> (Result<(), UnsolvedNetwork>, Vec<f64>) {
        let old = [400.0, 300.0, 300.0];
        let mut temperature = old.to_vec();
        let system = NetworkSystem {
            bonds: &[([0, 1], 2.0), ([1, 2], 1.0)],
            capacity: &capacity,
            old: &old,
            sink_conductance: &[0.0; 3],
            drive: &[0.0; 3],
        };
        let solved = NetworkSolver::default().solve(&system, &mut temperature);
        (solved, temperature)
    }

    #[test]
    fn a_positive_definite_network_is_solved_and_keeps_its_heat() {
        let (solved, temperature) = chain([3.0, 1.0, 2.0]);
        assert_eq!(solved, Ok(()));
        let heat: f64 = 3.0 * temperature[0] + temperature[1] + 2.0 * temperature[2];
        assert!((heat - 2100.0).abs() < 1e-9, "{temperature:?}");
    }

    #[test]
    fn one_that_is_not_positive_definite_is_told_of_with_finite_temperatures() {
        for capacity in [[-3.0, -1.0, -2.0], [-30.0, -10.0, -20.0]] {
            let (solved, temperature) = chain(capacity);
            let residual = solved.unwrap_err().residual;
            assert!(residual.is_finite() && residual > TOLERANCE, "{residual}");
            assert!(temperature.iter().all(|kelvin| kelvin.is_finite()));
        }
    }
}
