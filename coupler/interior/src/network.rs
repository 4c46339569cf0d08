//! Conduction between particles: a network of conductances, solved implicitly.

use calcine_physics::conduction::{Conduction, Contact};

use crate::{Newcomer, without};

/// Relative residual at which the implicit step ends: far below what a window's other errors are, and
/// energy does not depend on it, because flows go from one particle to the other whatever they are.
const TOLERANCE: f64 = 1e-12;

/// Two particles that touch.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Touch {
    /// Their places in the order of the particles.
    pub particles: [usize; 2],
    /// Their radii in m.
    pub radius: [f64; 2],
    /// Their overlap in m, positive.
    pub overlap: f64,
}

/// Conductances between particles.
#[derive(Debug)]
pub struct Network {
    law: Box<dyn Conduction>,
    /// Conductivity of each particle in W/m/K.
    conductivity: Vec<f64>,
    /// Pairs of particles with their conductance in W/K.
    bonds: Vec<([usize; 2], f64)>,
    /// Heat into each particle from the others in W.
    pub heat: Vec<f64>,
    solver: Solver,
}

/// Scratch of the conjugate gradients.
#[derive(Debug, Default)]
struct Solver {
    temperature: Vec<f64>,
    diagonal: Vec<f64>,
    residual: Vec<f64>,
    direction: Vec<f64>,
    product: Vec<f64>,
}

impl Network {
    /// A network without contacts yet; conductivities in W/m/K.
    pub fn new(law: Box<dyn Conduction>, conductivity: Vec<f64>) -> Self {
        let heat = vec![0.0; conductivity.len()];
        Self {
            law,
            conductivity,
            bonds: Vec::new(),
            heat,
            solver: Solver::default(),
        }
    }

    /// Particles that go, by their rows in ascending order, and come; all contacts are forgotten.
    pub fn change(&mut self, gone: &[usize], new: &[Newcomer]) {
        without(&mut self.conductivity, gone);
        self.conductivity
            .extend(new.iter().map(|one| one.conductivity));
        self.heat = vec![0.0; self.conductivity.len()];
        self.bonds.clear();
    }

    /// Takes up which particles touch.
    pub fn connect(&mut self, touches: &[Touch]) {
        self.bonds.clear();
        for touch in touches {
            let contact = Contact {
                radius: touch.radius,
                overlap: touch.overlap,
                conductivity: touch.particles.map(|p| self.conductivity[p]),
            };
            let conductance = self.law.conductance(&contact);
            if conductance > 0.0 {
                self.bonds.push((touch.particles, conductance));
            }
        }
    }

    /// True where no heat can flow.
    pub fn is_empty(&self) -> bool {
        self.bonds.is_empty()
    }

    /// Sets `heat` to the conduction of an implicit step: temperatures T with
    /// C_i (T_i − T_i,old) = h_i (S_i − T_i) + Σ_j G_ij (T_j − T_i), where C_i is a heat capacity over the
    /// span in W/K, S_i a temperature beside it in K and h_i in W/K its conductance.
    pub fn solve(&mut self, capacity: &[f64], old: &[f64], conductance: &[f64], beside: &[f64]) {
        self.solver
            .solve(&self.bonds, capacity, old, conductance, beside);
        self.heat.fill(0.0);
        for &([i, j], g) in &self.bonds {
            let flow = g * (self.solver.temperature[j] - self.solver.temperature[i]);
            self.heat[i] += flow;
            self.heat[j] -= flow;
        }
    }
}

impl Solver {
    /// Conjugate gradients, preconditioned by the diagonal; from the old temperatures.
    fn solve(
        &mut self,
        bonds: &[([usize; 2], f64)],
        capacity: &[f64],
        old: &[f64],
        conductance: &[f64],
        beside: &[f64],
    ) {
        let count = old.len();
        let Self {
            temperature: x,
            diagonal,
            residual: r,
            direction: p,
            product: q,
        } = self;
        x.clear();
        x.extend_from_slice(old);
        diagonal.clear();
        diagonal.extend(capacity.iter().zip(conductance).map(|(c, h)| c + h));
        for &([i, j], g) in bonds {
            diagonal[i] += g;
            diagonal[j] += g;
        }
        // The residual at the old temperatures is what would flow there.
        r.clear();
        r.extend((0..count).map(|i| conductance[i] * (beside[i] - x[i])));
        for &([i, j], g) in bonds {
            r[i] += g * (x[j] - x[i]);
            r[j] -= g * (x[j] - x[i]);
        }
        p.clear();
        p.resize(count, 0.0);
        q.resize(count, 0.0);
        let (mut before, mut goal) = (0.0, 0.0);
        for step in 0..count.max(10) * 10 {
            let product: f64 = r.iter().zip(diagonal.iter()).map(|(r, d)| r * r / d).sum();
            if step == 0 {
                goal = TOLERANCE * TOLERANCE * product;
            }
            if product <= goal || product == 0.0 {
                return;
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
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use calcine_physics::conduction::BatchelorObrien;

    fn chain(count: usize) -> Network {
        let mut network = Network::new(Box::new(BatchelorObrien), vec![50.0; count]);
        let touch = |i: usize| Touch {
            particles: [i, i + 1],
            radius: [5e-3; 2],
            overlap: 1e-6,
        };
        network.connect(&(0..count - 1).map(touch).collect::<Vec<_>>());
        network
    }

    #[test]
    fn two_particles_approach_each_other_as_the_implicit_step_has_it() {
        // G = 5e-3 W/K (COR-17), C = 2: T₁ − T₀ shrinks to 1/(1 + 2 G/C) of 100 K.
        let mut network = chain(2);
        network.solve(&[2.0; 2], &[300.0, 400.0], &[0.0; 2], &[0.0; 2]);
        let expected = 5e-3 * 100.0 / (1.0 + 2.0 * 5e-3 / 2.0);
        assert!((network.heat[0] / expected - 1.0).abs() < 1e-12);
        assert_eq!(network.heat[0], -network.heat[1]);
    }

    #[test]
    fn a_chain_between_two_surroundings_carries_the_series_conductance_in_any_step() {
        // Ends tied by h = 1 W/K to 500 and 300 K; a huge step is the steady state: resistances
        // 1/h + 9/G + 1/h.
        let mut network = chain(10);
        let mut tie = [0.0; 10];
        let mut beside = [0.0; 10];
        (tie[0], tie[9]) = (1.0, 1.0);
        (beside[0], beside[9]) = (500.0, 300.0);
        network.solve(&[1e-12; 10], &[400.0; 10], &tie, &beside);
        let flow = 200.0 / (2.0 + 9.0 / 5e-3);
        assert!(
            (network.heat[0] / -flow - 1.0).abs() < 1e-9,
            "{:?}",
            network.heat
        );
        assert!((network.heat[9] / flow - 1.0).abs() < 1e-9);
        assert!(network.heat.iter().sum::<f64>().abs() < 1e-12 * flow);
    }

    #[test]
    fn equal_temperatures_conduct_nothing() {
        let mut network = chain(5);
        network.solve(&[1.0; 5], &[350.0; 5], &[0.3; 5], &[350.0; 5]);
        assert_eq!(network.heat, [0.0; 5]);
    }
}
