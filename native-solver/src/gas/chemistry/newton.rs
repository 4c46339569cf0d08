//! Newton's step for the gas of all cells. A sweep leaves each cell with what its reactor makes of the gas that its neighbours had
//! when it was visited. With the cells' responses J to what would be there without reactions, z, the step δ of all is
//!
//! δ_c = J_c (z_c − z°_c + Σ_nb a_nb δ_nb/D_c),
//!
//! z° that of the visit, solved by BiCGStab behind a symmetric Gauss–Seidel sweep in the order of the flow
//! (van der Vorst, SIAM J. Sci. Stat. Comput. 13 (1992) 631, doi 10.1137/0913035). Without it what diffuses upstream would go from
//! cell to cell once a sweep.

use super::equations::ScalarEquations;
use crate::gas::attempt::AttemptFrame;
use crate::gas::state::GasState;
use crate::numerics::parallel::dot;

/// Share of its first residual to which the step is solved, and iterations at most; a solve that does not come there is used if
/// it came nearer.
const RELATIVE: f64 = 1e-4;
const ITERATIONS: u32 = 60;
/// A step is not followed to less than this share of a temperature, or to a fraction further below zero than this.
const LEAST_TEMPERATURE: f64 = 0.5;
const LEAST_FRACTION: f64 = -1e-3;

/// Memory of Newton's steps.
#[derive(Debug, Default)]
pub struct NewtonStep {
    /// Values of a cell: mass fractions and enthalpy.
    width: usize,
    /// z° of each cell; enthalpies in J/kg.
    visited: Vec<f64>,
    /// J of each cell row by row; empty where nothing reacts and J is one.
    responses: Vec<Vec<f64>>,
}

impl NewtonStep {
    /// Takes up the start of an attempt of cells with so many values.
    pub fn begin(&mut self, cells: usize, width: usize) {
        self.width = width;
        self.visited.clear();
        self.visited.resize(cells * width, 0.0);
        self.responses.clear();
        self.responses.resize(cells, Vec::new());
    }

    /// Notes the visit of a cell, with its response where that is new.
    pub fn note(&mut self, cell: usize, inert: &[f64], response: Option<Vec<f64>>) {
        self.visited[cell * self.width..(cell + 1) * self.width].copy_from_slice(inert);
        if let Some(response) = response {
            self.responses[cell] = response;
        }
    }

    /// Adds the step to the fields, but in cells in which that would be no gas; `unit` in J/kg is that of enthalpies.
    pub fn correct(
        &self,
        frame: &AttemptFrame<'_>,
        equations: ScalarEquations<'_>,
        order: &[u32],
        unit: f64,
        now: &mut GasState,
    ) {
        let system = StepSystem {
            frame,
            equations,
            order,
            responses: &self.responses,
            width: self.width,
        };
        let (width, species) = (self.width, self.width - 1);
        // z − z°, from the fields as a step from nothing.
        let mut fields = vec![0.0; self.visited.len()];
        for (cell, own) in fields.chunks_mut(width).enumerate() {
            own[..species].copy_from_slice(now.composition_of(cell, species));
            own[species] = now.enthalpy[cell] / unit;
        }
        let mut right = vec![0.0; fields.len()];
        for cell in 0..frame.grid.cells() {
            let mut change = vec![0.0; width];
            system.neighbours(cell, &fields, &mut change);
            let visited = &self.visited[cell * width..(cell + 1) * width];
            for (k, change) in change.iter_mut().take(species).enumerate() {
                *change += equations.sources[cell * species + k] / system.diagonal(cell, k);
                *change -= visited[k];
            }
            change[species] += equations.heat[cell] / (system.diagonal(cell, species) * unit);
            change[species] -= visited[species] / unit;
            system.respond(cell, &change, &mut right[cell * width..(cell + 1) * width]);
        }
        let Some(step) = system.solve(&right) else {
            return;
        };
        for (cell, step) in step.chunks(width).enumerate() {
            let own = cell * species..(cell + 1) * species;
            let fractions = &mut fields[cell * width..cell * width + species];
            fractions.iter_mut().zip(step).for_each(|(y, d)| *y += d);
            if fractions.iter().any(|y| y.is_nan() || *y < LEAST_FRACTION) {
                continue;
            }
            fractions.iter_mut().for_each(|y| *y = y.max(0.0));
            let enthalpy = now.enthalpy[cell] + step[species] * unit;
            let guess = now.temperature[cell];
            let found = frame.properties.temperature(enthalpy, fractions, guess);
            if found > LEAST_TEMPERATURE * guess {
                now.composition[own].copy_from_slice(fractions);
                now.enthalpy[cell] = enthalpy;
                now.temperature[cell] = found;
            }
        }
    }
}

/// The linear system of a step, δ − J N δ.
struct StepSystem<'a> {
    frame: &'a AttemptFrame<'a>,
    equations: ScalarEquations<'a>,
    order: &'a [u32],
    responses: &'a [Vec<f64>],
    width: usize,
}

impl StepSystem<'_> {
    fn diagonal(&self, cell: usize, value: usize) -> f64 {
        let species = self.width - 1;
        if value == species {
            return self.equations.enthalpy.diagonal()[cell];
        }
        let exchange = &self.frame.exchange.species;
        let shared = self.equations.species.diagonal()[cell];
        if exchange.is_none() {
            return shared;
        }
        let own = &exchange.coefficient[cell * species..][..species];
        shared + own[value] - own[0]
    }

    /// N x of a cell: what the neighbours' values give it.
    fn neighbours(&self, cell: usize, x: &[f64], out: &mut [f64]) {
        let (width, species) = (self.width, self.width - 1);
        out.fill(0.0);
        let (columns, values) = self.equations.species.row(cell);
        for (&other, value) in columns.iter().zip(values) {
            let beside = &x[other as usize * width..][..species];
            for (out, x) in out.iter_mut().zip(beside) {
                *out -= value * x;
            }
        }
        let (columns, values) = self.equations.enthalpy.row(cell);
        for (&other, value) in columns.iter().zip(values) {
            out[species] -= value * x[other as usize * width + species];
        }
        for (value, out) in out.iter_mut().enumerate() {
            *out /= self.diagonal(cell, value);
        }
    }

    /// J of a cell times a vector.
    fn respond(&self, cell: usize, x: &[f64], out: &mut [f64]) {
        let response = &self.responses[cell];
        if response.is_empty() {
            out.copy_from_slice(x);
            return;
        }
        for (out, row) in out.iter_mut().zip(response.chunks_exact(self.width)) {
            *out = row.iter().zip(x).map(|(j, x)| j * x).sum();
        }
    }

    /// x − J N x.
    fn times(&self, x: &[f64], out: &mut [f64]) {
        let mut given = vec![0.0; self.width];
        for (cell, out) in out.chunks_mut(self.width).enumerate() {
            self.neighbours(cell, x, &mut given);
            self.respond(cell, &given, out);
            let own = &x[cell * self.width..];
            out.iter_mut().zip(own).for_each(|(out, x)| *out = x - *out);
        }
    }

    /// A symmetric Gauss–Seidel sweep from nothing.
    fn precondition(&self, right: &[f64], x: &mut [f64]) {
        x.fill(0.0);
        let mut given = vec![0.0; self.width];
        let mut reached = vec![0.0; self.width];
        let forth = self.order.iter();
        for &cell in forth.chain(self.order.iter().rev()) {
            let cell = cell as usize;
            let own = cell * self.width..(cell + 1) * self.width;
            self.neighbours(cell, x, &mut given);
            self.respond(cell, &given, &mut reached);
            let right = &right[own.clone()];
            for ((x, reached), right) in x[own].iter_mut().zip(&reached).zip(right) {
                *x = right + reached;
            }
        }
    }

    /// The step, or none where the solve comes no nearer.
    fn solve(&self, right: &[f64]) -> Option<Vec<f64>> {
        let count = right.len();
        let first = dot(right, right).sqrt();
        if first == 0.0 || !first.is_finite() {
            return None;
        }
        let mut x = vec![0.0; count];
        let mut r = right.to_vec();
        let shadow = r.clone();
        let mut p = r.clone();
        let [mut v, mut t, mut y, mut z] = std::array::from_fn(|_| vec![0.0; count]);
        let mut rho = dot(&shadow, &r);
        for _ in 0..ITERATIONS {
            self.precondition(&p, &mut y);
            self.times(&y, &mut v);
            let alpha = rho / dot(&shadow, &v);
            add(&mut r, -alpha, &v);
            add(&mut x, alpha, &y);
            if dot(&r, &r).sqrt() <= RELATIVE * first {
                break;
            }
            self.precondition(&r, &mut z);
            self.times(&z, &mut t);
            let omega = dot(&t, &r) / dot(&t, &t);
            add(&mut x, omega, &z);
            add(&mut r, -omega, &t);
            if dot(&r, &r).sqrt() <= RELATIVE * first {
                break;
            }
            let next = dot(&shadow, &r);
            let beta = next / rho * alpha / omega;
            rho = next;
            for ((p, r), v) in p.iter_mut().zip(&r).zip(&v) {
                *p = r + beta * (*p - omega * v);
            }
            if !(beta.is_finite() && alpha.is_finite()) {
                return None;
            }
        }
        (dot(&r, &r).sqrt() < first && x.iter().all(|x| x.is_finite())).then_some(x)
    }
}

fn add(out: &mut [f64], factor: f64, x: &[f64]) {
    out.iter_mut()
        .zip(x)
        .for_each(|(out, x)| *out += factor * x);
}
