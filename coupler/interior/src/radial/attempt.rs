//! One particle over one window, with the gas about it held (docs/theory.md, XDP-18).

use calcine_numerics::LinearAlgebra;
use calcine_physics::film::bernoulli;
use thiserror::Error;

use super::equations::{carried, face_pressures};
use super::physics::RadialPhysics;
use super::transport::Outside;
use super::workspace::RadialWorkspace;

/// γ of the two stages: L-stable and of second order.
const GAMMA: f64 = 1.0 - std::f64::consts::FRAC_1_SQRT_2;
/// By how much a second stage continues the first.
const ONWARDS: f64 = (1.0 - GAMMA) / GAMMA;
/// Share of an amount of the first stage that the second one must begin with; below it the reactions of the shell go by the end of the step alone.
const BEGINS_WITH: f64 = 0.1;
/// Share of the gas of a shell by which one gas may be below nothing, as round-off leaves it.
const ROUND_OFF: f64 = 1e-6;
/// Share of the solids of a shell that a step must turn over for it to count.
const COUNTS: f64 = 1e-6;
/// Steps at most, and the shortest one as a share of the span.
const MOST_STEPS: usize = 20_000;
const SHORTEST: f64 = 1e-7;
const SAFETY: f64 = 0.9;

/// A particle that cannot be followed.
#[derive(Clone, Copy, Debug, Error, PartialEq)]
#[error(
    "the inside of a particle at {temperature} K cannot be followed beyond {reached} s of a window of {span} s: check that its pores \
     stay open (true densities, `size`), its rate constants and its permeability, or shorten the windows"
)]
pub struct RadialStalled {
    /// Temperature of its surface in K.
    pub temperature: f64,
    /// How far it came in s.
    pub reached: f64,
    /// The window in s.
    pub span: f64,
}

/// What a window does to a particle; its state is left in the workspace.
#[derive(Clone, Debug, Default)]
pub(super) struct RadialOutcome {
    /// Mean heat from the gas in W, its change with the temperature of the gas in W/K, and that of the surface.
    pub heat: f64,
    pub heat_slope: f64,
    pub surface_slope: f64,
    /// Change of the temperature of the surface with heat from contacts and radiation in K/W.
    pub surface_by_heat: f64,
    /// Mean temperature in K with which gas leaves.
    pub released: f64,
    /// Mean flow of each gas to the gas outside in mol/s, and its change with the own mole fraction outside.
    pub flow: Vec<f64>,
    pub flow_slope: Vec<f64>,
    /// Steps that were taken, and repeated; shells and steps that went by the end of a step alone.
    pub steps: usize,
    pub repeated: usize,
    pub fallen_back: usize,
    /// Sums of the step at hand.
    step_heat: f64,
    step_weight: [f64; 2],
}

impl RadialPhysics {
    /// Follows a particle over a span in s. The workspace holds its start; it is left with the end, as `start` and
    /// `start_gas`. Amounts of the start are `unreacted` where nothing has reacted.
    pub fn follow(
        &self,
        outside: &Outside<'_>,
        span: f64,
        ws: &mut RadialWorkspace,
        out: &mut RadialOutcome,
    ) -> Result<(), RadialStalled> {
        let g = ws.gases;
        for list in [&mut out.flow, &mut out.flow_slope] {
            list.clear();
            list.resize(g, 0.0);
        }
        (out.heat, out.steps, out.repeated, out.fallen_back) = (0.0, 0, 0, 0);
        let mut leaving = [0.0; 2];
        ws.flows.gas.fill(0.0);
        ws.flows.film.fill(0.0);
        ws.held.film.fill(0.0);
        self.begin(outside, ws);
        let (mut time, mut step) = (0.0, span);
        loop {
            let left = span - time;
            let ends = step >= 0.999 * left;
            let length = if ends { left } else { step };
            let error = self.step(outside, length, ws, out);
            if error <= 1.0 {
                time += length;
                out.steps += 1;
                out.heat += out.step_heat;
                self.add_flow(ws, out);
                leaving[0] += out.step_weight[0];
                leaving[1] += out.step_weight[1];
                let now = &ws.now;
                ws.start.temperature.copy_from_slice(&now.temperature);
                ws.start.pressure.copy_from_slice(&now.pressure);
                ws.start.amount.copy_from_slice(&now.amount);
                ws.start_gas.copy_from_slice(&ws.now_gas);
                if ends {
                    break;
                }
            } else {
                out.repeated += 1;
            }
            let factor = if error.is_finite() {
                (SAFETY / error.max(1e-10).sqrt()).clamp(0.2, 4.0)
            } else {
                0.25
            };
            step = length * factor;
            if step < SHORTEST * span || out.steps + out.repeated > MOST_STEPS {
                return Err(RadialStalled {
                    temperature: ws.start.temperature[ws.shells],
                    reached: time,
                    span,
                });
            }
        }
        out.heat /= span;
        out.flow.iter_mut().for_each(|flow| *flow /= span);
        out.released = if leaving[0] > 0.0 {
            leaving[1] / leaving[0]
        } else {
            ws.start.temperature[ws.shells]
        };
        self.respond(outside, span, ws, out);
        Ok(())
    }

    /// Pressures of the start from its amounts, and those at the surface of the gas outside.
    fn begin(&self, outside: &Outside<'_>, ws: &mut RadialWorkspace) {
        let (n, g) = (ws.shells, ws.gases);
        ws.now.temperature.copy_from_slice(&ws.start.temperature);
        ws.now.amount.copy_from_slice(&ws.start.amount);
        self.measure(ws);
        let gas = std::mem::take(&mut ws.start_gas);
        self.pressurise(&gas, ws);
        ws.start_gas = gas;
        for k in 0..g {
            ws.now.pressure[n * g + k] =
                outside.around.pressure * outside.around.fractions[k].max(0.0);
        }
        ws.start.pressure.copy_from_slice(&ws.now.pressure);
    }

    /// One step of a length in s; its error over the tolerances, infinite where it has no solution.
    fn step(
        &self,
        outside: &Outside<'_>,
        length: f64,
        ws: &mut RadialWorkspace,
        out: &mut RadialOutcome,
    ) -> f64 {
        (out.step_heat, out.step_weight) = (0.0, [0.0; 2]);
        self.base(ws);
        let first = GAMMA * length;
        ws.base.weight.fill(first);
        if !self.solve(outside, first, ws) {
            return f64::INFINITY;
        }
        self.book(ws);
        self.add(outside, ONWARDS * first, ws, out);
        ws.first_stage
            .temperature
            .copy_from_slice(&ws.now.temperature);
        ws.first_stage.pressure.copy_from_slice(&ws.now.pressure);
        ws.first_stage.amount.copy_from_slice(&ws.now.amount);
        for (turned, own) in ws.turned.iter_mut().zip(&ws.now.extent) {
            *turned = ONWARDS * own;
        }
        let fallen = self.continue_base(length, ws);
        let mut done = self.solve(outside, first, ws);
        if done {
            self.book(ws);
            done = self.is_positive(ws);
        }
        if done {
            for (turned, own) in ws.turned.iter_mut().zip(&ws.now.extent) {
                *turned += own;
            }
            self.add(outside, first, ws, out);
            out.fallen_back += fallen;
            return self.error(ws);
        }
        // The end of the step alone: positive, and of first order.
        (out.step_heat, out.step_weight) = (0.0, [0.0; 2]);
        ws.now
            .temperature
            .copy_from_slice(&ws.first_stage.temperature);
        ws.now.pressure.copy_from_slice(&ws.first_stage.pressure);
        self.base_of_start(ws);
        ws.base.weight.fill(length);
        if !self.solve(outside, length, ws) {
            return f64::INFINITY;
        }
        self.book(ws);
        if !self.is_positive(ws) {
            return f64::INFINITY;
        }
        ws.turned.copy_from_slice(&ws.now.extent);
        self.add(outside, length, ws, out);
        out.fallen_back += ws.shells;
        self.error(ws)
    }

    /// The start as base and as iterate.
    fn base(&self, ws: &mut RadialWorkspace) {
        ws.now.temperature.copy_from_slice(&ws.start.temperature);
        ws.now.pressure.copy_from_slice(&ws.start.pressure);
        ws.now.amount.copy_from_slice(&ws.start.amount);
        self.properties(ws);
        let (s, g) = (ws.solids, ws.gases);
        for shell in 0..ws.shells {
            let held = |amounts: &[f64], enthalpies: &[f64]| -> f64 {
                amounts.iter().zip(enthalpies).map(|(n, h)| n * h).sum()
            };
            let (solids, gases) = (shell * s..(shell + 1) * s, shell * g..(shell + 1) * g);
            ws.start_enthalpy[shell] =
                held(&ws.start.amount[solids.clone()], &ws.solid_enthalpy[solids])
                    + held(&ws.start_gas[gases.clone()], &ws.gas_enthalpy[gases]);
        }
        self.base_of_start(ws);
    }

    /// The start as base.
    fn base_of_start(&self, ws: &mut RadialWorkspace) {
        ws.base.enthalpy.copy_from_slice(&ws.start_enthalpy);
        ws.base.amount.copy_from_slice(&ws.start.amount);
        ws.base.gas.copy_from_slice(&ws.start_gas);
    }

    /// The base of the second stage; how many shells go by the end of the step alone.
    fn continue_base(&self, length: f64, ws: &mut RadialWorkspace) -> usize {
        let (s, g, r) = (ws.solids, ws.gases, ws.reactions);
        let mut fallen = 0;
        for shell in 0..ws.shells {
            ws.base.enthalpy[shell] = ws.start_enthalpy[shell] + ONWARDS * ws.warmed[shell];
            let mut short = false;
            for k in shell * s..(shell + 1) * s {
                let (start, stage) = (ws.start.amount[k], ws.first_stage.amount[k]);
                ws.base.amount[k] = start + ONWARDS * (stage - start);
                short |= ws.base.amount[k] < BEGINS_WITH * stage;
            }
            ws.base.weight[shell] = if short { length } else { GAMMA * length };
            let moved = ws.turned[shell * r..(shell + 1) * r].iter();
            let all: f64 = ws.unreacted[shell * s..(shell + 1) * s].iter().sum();
            let reacts = moved.fold(0.0, |most: f64, x| most.max(x.abs())) > COUNTS * all;
            fallen += usize::from(short && reacts);
            for k in 0..g {
                let place = shell * g + k;
                let mut made = ws.came[place];
                if !short {
                    made = ws.now_gas[place] - ws.start_gas[place];
                }
                ws.base.gas[place] = ws.start_gas[place] + ONWARDS * made;
            }
            if short {
                let own = shell * s..(shell + 1) * s;
                ws.base.amount[own.clone()].copy_from_slice(&ws.start.amount[own]);
                ws.turned[shell * r..(shell + 1) * r].fill(0.0);
            }
        }
        fallen
    }

    /// True where no shell has less than nothing of a solid or a gas.
    fn is_positive(&self, ws: &RadialWorkspace) -> bool {
        let g = ws.gases;
        let solids = ws.now.amount.iter().all(|n| *n >= 0.0);
        let gases = ws.now_gas.chunks_exact(g.max(1)).all(|own| {
            let all: f64 = own.iter().sum();
            own.iter().all(|n| *n >= -ROUND_OFF * all)
        });
        solids && gases
    }

    /// Adds what passed to gas and surface in a stage that counts over a length in s.
    fn add(
        &self,
        outside: &Outside<'_>,
        length: f64,
        ws: &RadialWorkspace,
        out: &mut RadialOutcome,
    ) {
        let (n, g) = (ws.shells, ws.gases);
        let surface = ws.now.temperature[n];
        let mut passing = 0.0;
        for k in 0..g {
            let flow = ws.flows.gas[(n - 1) * g + k];
            passing += (flow * ws.gas_capacity[n * g + k]).abs();
        }
        out.step_heat += length * ws.held.film_heat * (outside.around.temperature - surface);
        out.step_weight[0] += length * passing;
        out.step_weight[1] += length * passing * surface;
    }

    /// Adds the gases that left in a step: what there was, and what was made, less what is there.
    fn add_flow(&self, ws: &RadialWorkspace, out: &mut RadialOutcome) {
        let g = ws.gases;
        for (k, flow) in out.flow.iter_mut().enumerate() {
            for shell in 0..ws.shells {
                *flow += ws.start_gas[shell * g + k] - ws.now_gas[shell * g + k];
            }
        }
        let r = ws.reactions;
        for (j, reaction) in self.chemistry.reactions.iter().enumerate() {
            let turned: f64 = (0..ws.shells).map(|shell| ws.turned[shell * r + j]).sum();
            for &(k, moles) in &reaction.gases {
                out.flow[k] += moles * turned;
            }
        }
    }

    /// How far a step is from that of first order by its own stages, over the tolerances.
    fn error(&self, ws: &RadialWorkspace) -> f64 {
        let volume: f64 = ws.held.volume.iter().sum();
        let mut off = 0.0;
        for shell in 0..ws.shells {
            let (start, now) = (ws.start.temperature[shell], ws.now.temperature[shell]);
            let stage = ws.first_stage.temperature[shell];
            off += ws.held.volume[shell] * (now - start - (stage - start) / GAMMA).abs();
        }
        let mut turned: f64 = 0.0;
        let all: f64 = ws.unreacted.iter().sum();
        let s = ws.solids;
        for k in 0..s {
            let mut sum = 0.0;
            for shell in 0..ws.shells {
                let place = shell * s + k;
                let (start, now) = (ws.start.amount[place], ws.now.amount[place]);
                sum += now - start - (ws.first_stage.amount[place] - start) / GAMMA;
            }
            turned = turned.max(sum.abs());
        }
        let numerics = &self.numerics;
        let kelvin = off / volume / numerics.temperature;
        kelvin.max(turned / all / numerics.conversion)
    }

    /// How the particle as a whole follows the gas over the span: by one implicit step about its end.
    fn respond(
        &self,
        outside: &Outside<'_>,
        span: f64,
        ws: &mut RadialWorkspace,
        out: &mut RadialOutcome,
    ) {
        let (n, g) = (ws.shells, ws.gases);
        let block = 1 + g;
        ws.base.weight.fill(span);
        self.assemble(outside, span, ws);
        let film: f64 = ws.held.film_heat;
        let beyond = outside.around.pressure;
        let pressure: f64 = ws.now.pressure[n * g..(n + 1) * g].iter().sum();
        let net = ws.held.opening * (pressure - beyond);
        ws.entries.iter_mut().for_each(|value| *value = -*value);
        if !ws.algebra.factorise(0.0, &ws.entries) {
            // Without slopes the exchange is told as it is.
            (out.heat_slope, out.surface_slope, out.surface_by_heat) = (film, 0.0, 0.0);
            return;
        }
        ws.right.fill(0.0);
        ws.right[n * block] = 1.0;
        ws.algebra.solve(&mut ws.right);
        out.surface_by_heat = ws.right[n * block];
        out.surface_slope = film * out.surface_by_heat;
        out.heat_slope = film * (1.0 - out.surface_slope);
        for k in 0..g {
            let number = net / ws.held.film[k];
            let direct = ws.held.film[k] * bernoulli(number);
            ws.right.fill(0.0);
            ws.right[n * block + 1 + k] = direct;
            ws.algebra.solve(&mut ws.right);
            // What the film passes is what the outermost shell does.
            let face = n - 1;
            let ends = face_pressures(face, ws);
            let [_, by_here, by_there, own_here, own_there] = carried(face, k, ends, ws);
            let step = |node: usize, j: usize| ws.right[node * block + 1 + j];
            let mut flow = own_here * step(face, k) + own_there * step(n, k);
            for j in 0..g {
                let diffusive = ws.held.diffusion[(face * g + k) * g + j];
                flow += (diffusive + by_here) * step(face, j) + (by_there - diffusive) * step(n, j);
            }
            out.flow_slope[k] = flow;
        }
    }
}
