//! The heated column integrated apart from Calcine: its own transcription of the laws, its own
//! form of the equations, classical Runge-Kutta in time. Nothing here calls Calcine.
//!
//! One dimension, `CELLS` cells of 10 mm, the lowest ten each with one sphere. With constant c_p
//! and constant pressure the gas' enthalpy per volume, ρ c_p T = p c_p/(R/M), does not change, so
//! that the energy balance of a cell gives the flow that leaves it:
//!
//! φ_out = (φ_in T_in + (Q + conduction)/c_p)/T,   dm/dt = φ_in − φ_out,   m = ε V p/((R/M) T).

use std::f64::consts::PI;

/// Cells along the column.
pub const CELLS: usize = 11;
/// Particles, one in each of the lowest cells.
pub const PARTICLES: usize = 10;

const CELL: f64 = 0.01;
const AREA: f64 = 1e-4;
const DIAMETER: f64 = 0.01;
const PRESSURE: f64 = 101_325.0;
const GAS_CONSTANT: f64 = 8.314_462_618 / 28.96e-3;
const HEAT_CAPACITY: f64 = 1007.0;
const INLET_TEMPERATURE: f64 = 400.0;
const INLET_VELOCITY: f64 = 0.5;

/// Temperatures of the ten particles in K and the pressure drop in Pa at a time in s.
#[derive(Clone, Copy, Debug)]
pub struct Row {
    /// Time in s.
    pub time: f64,
    /// Particle temperatures in K, from below.
    pub particles: [f64; PARTICLES],
    /// Pressure at the bottom patch minus that at the top patch in Pa.
    pub pressure_drop: f64,
}

#[derive(Clone, Copy)]
struct State {
    gas: [f64; CELLS],
    particles: [f64; PARTICLES],
}

fn void_fraction(cell: usize) -> f64 {
    if cell < PARTICLES {
        1.0 - PI / 6.0
    } else {
        1.0
    }
}

fn viscosity(temperature: f64) -> f64 {
    1.4792e-6 * temperature.sqrt() / (1.0 + 116.0 / temperature)
}

fn conductivity(temperature: f64) -> f64 {
    let isochoric = HEAT_CAPACITY - GAS_CONSTANT;
    viscosity(temperature) * (1.32 * isochoric + 1.77 * GAS_CONSTANT)
}

/// h A of one sphere in W/K after Gunn, at a superficial velocity.
fn conductance(temperature: f64, eps: f64, superficial: f64) -> f64 {
    let density = PRESSURE / (GAS_CONSTANT * temperature);
    let (mu, kappa) = (viscosity(temperature), conductivity(temperature));
    let re = density * superficial * DIAMETER / mu;
    let pr = HEAT_CAPACITY * mu / kappa;
    let nu = (7.0 - 10.0 * eps + 5.0 * eps.powi(2))
        * (1.0 + 0.7 * re.powf(0.2) * pr.powf(1.0 / 3.0))
        + (1.33 - 2.4 * eps + 1.2 * eps.powi(2)) * re.powf(0.7) * pr.powf(1.0 / 3.0);
    nu * kappa * PI * DIAMETER
}

/// Mass flow into each cell, and out of the last one, in kg/s; and heat into each particle in W.
fn flows(state: &State) -> ([f64; CELLS + 1], [f64; PARTICLES]) {
    let mut flow = [0.0; CELLS + 1];
    let mut heat = [0.0; PARTICLES];
    flow[0] = PRESSURE / (GAS_CONSTANT * INLET_TEMPERATURE) * INLET_VELOCITY * AREA;
    for c in 0..CELLS {
        let (temperature, eps) = (state.gas[c], void_fraction(c));
        let upstream = if c == 0 {
            INLET_TEMPERATURE
        } else {
            state.gas[c - 1]
        };
        let conduction = conduction(state, c) - conduction(state, c + 1);
        let mut to_gas = conduction;
        if c < PARTICLES {
            let density = PRESSURE / (GAS_CONSTANT * temperature);
            let superficial = flow[c] / (density * AREA);
            heat[c] =
                conductance(temperature, eps, superficial) * (temperature - state.particles[c]);
            to_gas -= heat[c];
        }
        flow[c + 1] = (flow[c] * upstream + to_gas / HEAT_CAPACITY) / temperature;
    }
    (flow, heat)
}

/// Heat conducted in the gas up through the lower face of a cell in W; none at inlet and outlet (docs/theory.md, BND-1).
fn conduction(state: &State, face: usize) -> f64 {
    if face == 0 || face == CELLS {
        return 0.0;
    }
    let above = state.gas[face];
    let below = state.gas[face - 1];
    let lower = void_fraction(face - 1) * conductivity(below);
    let upper = void_fraction(face) * conductivity(above);
    0.5 * (lower + upper) * AREA * (below - above) / CELL
}

fn rates(state: &State, solid: f64) -> State {
    let (flow, heat) = flows(state);
    let mut rate = State {
        gas: [0.0; CELLS],
        particles: [0.0; PARTICLES],
    };
    for c in 0..CELLS {
        let mass = void_fraction(c) * CELL * AREA * PRESSURE / (GAS_CONSTANT * state.gas[c]);
        rate.gas[c] = -state.gas[c] / mass * (flow[c] - flow[c + 1]);
    }
    let volume = PI / 6.0 * DIAMETER.powi(3);
    rate.particles = heat.map(|heat| heat / (solid * volume));
    rate
}

/// Steady momentum balance cell by cell: convection (upwind), drag after Ergun, −ε dp/dz.
fn pressure_drop(state: &State) -> f64 {
    let (flow, _) = flows(state);
    let mut upstream = INLET_VELOCITY / void_fraction(0);
    let mut drop = 0.0;
    for c in 0..CELLS {
        let (temperature, eps) = (state.gas[c], void_fraction(c));
        let density = PRESSURE / (GAS_CONSTANT * temperature);
        let superficial = 0.5 * (flow[c] + flow[c + 1]) / (density * AREA);
        let velocity = superficial / eps;
        let mut gradient = flow[c] * (velocity - upstream) / (eps * AREA * CELL);
        if c < PARTICLES {
            gradient += 150.0 * (1.0 - eps).powi(2) * viscosity(temperature) * superficial
                / (eps.powi(3) * DIAMETER.powi(2))
                + 1.75 * (1.0 - eps) * density * superficial.powi(2) / (eps.powi(3) * DIAMETER);
        }
        drop += gradient * CELL;
        upstream = velocity;
    }
    drop
}

fn moved(state: &State, rate: &State, step: f64) -> State {
    let mut next = *state;
    next.gas
        .iter_mut()
        .zip(&rate.gas)
        .for_each(|(value, rate)| *value += step * rate);
    next.particles
        .iter_mut()
        .zip(&rate.particles)
        .for_each(|(value, rate)| *value += step * rate);
    next
}

/// Integrates from 300 K with a step in s and returns a row at each multiple of `every`.
/// `solid`: ρ c_p of the particles in J/m³/K.
pub fn integrate(solid: f64, end: f64, every: f64, step: f64) -> Vec<Row> {
    let mut state = State {
        gas: [300.0; CELLS],
        particles: [300.0; PARTICLES],
    };
    let (steps, stride) = (
        (end / step).round() as usize,
        (every / step).round() as usize,
    );
    let mut rows = Vec::new();
    for n in 0..=steps {
        if n % stride == 0 {
            let pressure_drop = pressure_drop(&state);
            rows.push(Row {
                time: n as f64 * step,
                particles: state.particles,
                pressure_drop,
            });
        }
        let k1 = rates(&state, solid);
        let k2 = rates(&moved(&state, &k1, 0.5 * step), solid);
        let k3 = rates(&moved(&state, &k2, 0.5 * step), solid);
        let k4 = rates(&moved(&state, &k3, step), solid);
        for (rate, weight) in [(k1, 1.0), (k2, 2.0), (k3, 2.0), (k4, 1.0)] {
            state = moved(&state, &rate, weight * step / 6.0);
        }
    }
    rows
}
