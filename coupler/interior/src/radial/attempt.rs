//! Particles over one window, each in a lane, with the gas about them held (docs/theory.md, XDP-18).
//!
//! Every lane goes its own way: it has its own steps, stages and rounds, and takes up the next particle when it has followed one. The
//! lanes share the rounds of Newton's method ([`RadialPhysics::round`]) alone, so that a particle has the same bits whoever is beside it.

use calcine_physics::film::bernoulli;
use calcine_physics::pores::dusty_gas::MOST_GASES;
use thiserror::Error;

use super::equations::{FaceFlow, net_flow};
use super::physics::RadialPhysics;
use super::transport::{ANY, Outside};
use super::workspace::{RadialWorkspace, copy_lane, fill_lane};

/// γ of the two stages: L-stable and of second order.
pub(super) const GAMMA: f64 = 1.0 - std::f64::consts::FRAC_1_SQRT_2;
/// By how much a second stage continues the first.
pub(super) const ONWARDS: f64 = (1.0 - GAMMA) / GAMMA;
/// Share of the gas of a shell by which one gas may be below nothing, as round-off leaves it.
const ROUND_OFF: f64 = 1e-6;
/// Steps at most, and the shortest one as a share of the span.
const MOST_STEPS: usize = 20_000;
const SHORTEST: f64 = 1e-7;
const SAFETY: f64 = 0.9;
/// Rounds of Newton's method at most, and of those the ones that take coefficients anew: then they are held, so that the
/// last rounds square what is left.
const ROUNDS: usize = 40;
const UPDATES: usize = 4;
/// Changes that end them, relative to temperature, pressure and the amount of solids.
const CLOSE: f64 = 1e-8;

/// A particle that cannot be followed.
#[derive(Clone, Copy, Debug, Error, PartialEq)]
#[error(
    "the inside of a particle at {temperature} K cannot be followed beyond {reached} s of a window of {span} s: {}", self.remedy()
)]
pub struct RadialStalled {
    /// Temperature of its surface in K.
    pub temperature: f64,
    /// How far it came in s.
    pub reached: f64,
    /// The window in s.
    pub span: f64,
    /// True where solids came to fill a shell.
    pub full: bool,
}

impl RadialStalled {
    fn remedy(&self) -> &'static str {
        match self.full {
            true => {
                "its solids come to fill a shell, so that no gas passes: check true densities, `density` and `size`"
            }
            false => {
                "its equations are not solved at any step: check the rate constants, orders and equilibria of its reactions, and \
                 conductivity and permeability, or shorten the windows"
            }
        }
    }
}

/// What a window does to a particle; its state is left in the lane of the workspace.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct RadialOutcome {
    /// Mean heat from the gas in W, its change with the temperature of the gas in W/K, and that of the surface.
    pub heat: f64,
    pub heat_slope: f64,
    pub surface_slope: f64,
    /// Change of the temperature of the surface with heat from contacts and radiation in K/W; where the network asks, that of its
    /// mean over the window, and the same of its change with the temperature of the gas.
    pub surface_by_heat: f64,
    /// Means of the temperature of the surface in K and of its fourth power in K⁴.
    pub surface: [f64; 2],
    /// Mean temperature in K with which gas leaves.
    pub released: f64,
    /// Mean flow of each gas to the gas outside in mol/s, and its change with the own mole fraction outside.
    pub flow: [f64; MOST_GASES],
    pub flow_slope: [f64; MOST_GASES],
    /// Steps that were taken, and repeated; shells and steps that went by the end of a step alone; rounds of Newton's method.
    pub steps: usize,
    pub repeated: usize,
    pub fallen_back: usize,
    pub rounds: usize,
    /// Sums of the step at hand, and of the gas that left in the window with its temperature.
    step_heat: f64,
    step_surface: [f64; 2],
    step_weight: [f64; 2],
    leaving: [f64; 2],
}

/// The stage at which a particle is.
#[derive(Clone, Copy, Debug, PartialEq)]
enum StageAt {
    /// Both of the method, the error of their step through their equations, the end of the step alone, how the particle answers at
    /// the end of the window, and how the mean of its surface does.
    First,
    Second,
    Error,
    Whole,
    Answer,
    MeanAnswer,
}

/// A particle on its way through a window.
#[derive(Clone, Debug)]
pub(super) struct RadialCourse {
    span: f64,
    time: f64,
    /// Length in s of the step at hand, and whether it ends the window.
    length: f64,
    ends: bool,
    stage: StageAt,
    /// Rounds of the stage so far, and the change of the last one.
    round: usize,
    moved: f64,
    /// Shells that go by the end of the step alone in the second stage.
    fallen: usize,
    /// Error of what the step turned over, over its tolerance.
    turned_error: f64,
    /// True where solids filled a shell since the last step that was taken.
    full: bool,
    pub out: RadialOutcome,
}

impl RadialPhysics {
    /// Sends the particle that a lane holds, as `start` and `start_gas`, through a span in s. Amounts of the start are `unreacted` where
    /// nothing has reacted.
    pub fn send(
        &self,
        lane: usize,
        outside: &Outside<'_>,
        span: f64,
        ws: &mut RadialWorkspace,
    ) -> RadialCourse {
        let (n, g) = (ws.shells, ws.gases);
        fill_lane(&mut ws.flows.gas, lane, 0.0);
        fill_lane(&mut ws.flows.film, lane, 0.0);
        fill_lane(&mut ws.held.film, lane, 0.0);
        copy_lane(&mut ws.now.temperature, &ws.start.temperature, lane);
        copy_lane(&mut ws.now.amount, &ws.start.amount, lane);
        for shell in 0..n {
            [ws.held.volume[shell][lane], ws.held.pores[shell][lane]] =
                self.volumes(shell, lane, ws);
        }
        ws.taken_up = true;
        self.pressurise(lane, ws);
        for k in 0..g {
            ws.now.pressure[n * g + k][lane] = outside.pressure * outside.fractions[k].max(0.0);
        }
        copy_lane(&mut ws.start.pressure, &ws.now.pressure, lane);
        ws.fresh[lane] = 1.0;
        ws.alone[lane] = 0.0;
        let mut course = RadialCourse {
            span,
            time: 0.0,
            length: span,
            ends: true,
            stage: StageAt::First,
            round: 0,
            moved: f64::INFINITY,
            fallen: 0,
            turned_error: 0.0,
            full: false,
            out: RadialOutcome::default(),
        };
        self.begin(lane, &mut course, ws);
        course
    }

    /// Takes what a round did to the particle of a lane, and sets up the next one; the end of its window where it is reached, with the
    /// state as `start` and `start_gas`.
    pub fn advance(
        &self,
        lane: usize,
        outside: &Outside<'_>,
        course: &mut RadialCourse,
        ws: &mut RadialWorkspace,
    ) -> Option<Result<(), RadialStalled>> {
        course.out.rounds += 1;
        if course.stage == StageAt::Answer {
            self.answer(lane, outside, ws, &mut course.out);
            if outside.networked {
                // What heat stores over the window is there for half of it in the mean, what passes the film at once.
                let half = 0.5 * course.span;
                fill_lane(&mut ws.base.weight, lane, half);
                ws.length[lane] = half;
                copy_lane(&mut ws.now.amount, &ws.start.amount, lane);
                course.stage = StageAt::MeanAnswer;
                return None;
            }
            return Some(Ok(()));
        }
        if course.stage == StageAt::MeanAnswer {
            let found = ws.algebra.above(ws.shells)[0][lane];
            if found.is_finite() {
                course.out.surface_by_heat = found;
                course.out.surface_slope = ws.held.film_heat[lane] * found;
            }
            return Some(Ok(()));
        }
        if course.stage == StageAt::Error {
            let error = course.turned_error.max(self.smoothed_error(lane, ws));
            return self.judge(lane, error, course, ws);
        }
        course.round += 1;
        let moved = ws.moved[lane];
        let sound = ws.updating[lane] == 0.0 || ws.broken[lane] == 0.0;
        course.full |= ws.room[lane] <= 0.0;
        let goes = sound && moved.is_finite() && ws.room[lane] > 0.0;
        // Changes shrink by a rate: the iterate is off by what the later ones would come to in all (Hairer and Wanner, Solving
        // Ordinary Differential Equations II, 2nd ed. (1996), section IV.8).
        let rate = moved / course.moved;
        let shrinks = course.round > 1 && rate < 0.5;
        let close = moved <= CLOSE || (shrinks && moved * rate / (1.0 - rate) <= CLOSE);
        course.moved = moved;
        if goes && !close && course.round < ROUNDS {
            ws.updating[lane] = f64::from(u8::from(course.round < UPDATES));
            return None;
        }
        let solved = goes && close;
        if solved {
            self.book(lane, ws);
        }
        let (length, first) = (course.length, GAMMA * course.length);
        match course.stage {
            StageAt::First if solved => {
                self.add(lane, outside, ONWARDS * first, ws, &mut course.out);
                let (stage, now) = (&mut ws.first_stage, &ws.now);
                copy_lane(&mut stage.temperature, &now.temperature, lane);
                copy_lane(&mut stage.pressure, &now.pressure, lane);
                copy_lane(&mut stage.amount, &now.amount, lane);
                for (turned, own) in ws.turned.iter_mut().zip(&ws.now.extent) {
                    turned[lane] = ONWARDS * own[lane];
                }
                course.fallen = self.continue_base(lane, length, ws);
                enter(lane, StageAt::Second, course, ws);
                self.guess_onwards(lane, ws);
                return None;
            }
            StageAt::Second if solved && self.is_positive(lane, ws) => {
                for (turned, own) in ws.turned.iter_mut().zip(&ws.now.extent) {
                    turned[lane] += own[lane];
                }
                self.add(lane, outside, first, ws, &mut course.out);
                course.out.fallen_back += course.fallen;
                let [kelvin, turned] = self.errors(lane, ws);
                if turned <= 1.0 && kelvin > 1.0 {
                    self.send_error(lane, first, ws);
                    (course.stage, course.turned_error) = (StageAt::Error, turned);
                    ws.updating[lane] = 0.0;
                    return None;
                }
                return self.judge(lane, kelvin.max(turned), course, ws);
            }
            StageAt::Second => {
                // The end of the step alone: positive, and of first order.
                course.out.begin_step();
                copy_lane(&mut ws.now.temperature, &ws.first_stage.temperature, lane);
                copy_lane(&mut ws.now.pressure, &ws.first_stage.pressure, lane);
                base_of_start(lane, length, ws);
                ws.length[lane] = length;
                enter(lane, StageAt::Whole, course, ws);
                return None;
            }
            StageAt::Whole if solved && self.is_positive(lane, ws) => {
                copy_lane(&mut ws.turned, &ws.now.extent, lane);
                self.add(lane, outside, length, ws, &mut course.out);
                course.out.fallen_back += ws.shells;
            }
            _ => return self.judge(lane, f64::INFINITY, course, ws),
        }
        let [kelvin, turned] = self.errors(lane, ws);
        self.judge(lane, kelvin.max(turned), course, ws)
    }

    /// Takes or repeats a step by its error over the tolerances, and begins the next one.
    fn judge(
        &self,
        lane: usize,
        error: f64,
        course: &mut RadialCourse,
        ws: &mut RadialWorkspace,
    ) -> Option<Result<(), RadialStalled>> {
        let out = &mut course.out;
        let factor = if error.is_finite() {
            (SAFETY / error.max(1e-10).sqrt()).clamp(0.2, 4.0)
        } else {
            0.25
        };
        let step = course.length * factor;
        // What comes and goes within the shortest step is not followed: the step ends where it leads to.
        let fleeting = error > 1.0 && error.is_finite() && step < SHORTEST * course.span;
        let factor = if fleeting { 4.0 } else { factor };
        let step = course.length * factor;
        if error <= 1.0 || fleeting {
            course.time += course.length;
            course.full = false;
            out.steps += 1;
            out.heat += out.step_heat;
            out.surface[0] += out.step_surface[0];
            out.surface[1] += out.step_surface[1];
            out.leaving[0] += out.step_weight[0];
            out.leaving[1] += out.step_weight[1];
            self.add_flow(lane, ws, out);
            copy_lane(&mut ws.start.temperature, &ws.now.temperature, lane);
            copy_lane(&mut ws.start.pressure, &ws.now.pressure, lane);
            copy_lane(&mut ws.start.amount, &ws.now.amount, lane);
            copy_lane(&mut ws.start_gas, &ws.now_gas, lane);
            copy_lane(&mut ws.start_enthalpy, &ws.now_enthalpy, lane);
            if course.ends {
                fill_lane(&mut ws.base.weight, lane, course.span);
                ws.length[lane] = course.span;
                ws.updating[lane] = 0.0;
                ws.alone[lane] = 1.0;
                course.stage = StageAt::Answer;
                return None;
            }
        } else {
            out.repeated += 1;
        }
        if step < SHORTEST * course.span || out.steps + out.repeated > MOST_STEPS {
            return Some(Err(RadialStalled {
                temperature: ws.start.temperature[ws.shells][lane],
                reached: course.time,
                span: course.span,
                full: course.full,
            }));
        }
        let left = course.span - course.time;
        course.ends = step >= 0.999 * left;
        course.length = if course.ends { left } else { step };
        self.begin(lane, course, ws);
        None
    }

    /// Begins a step: the start as base and as iterate.
    fn begin(&self, lane: usize, course: &mut RadialCourse, ws: &mut RadialWorkspace) {
        course.out.begin_step();
        copy_lane(&mut ws.now.temperature, &ws.start.temperature, lane);
        copy_lane(&mut ws.now.pressure, &ws.start.pressure, lane);
        let first = GAMMA * course.length;
        base_of_start(lane, first, ws);
        ws.length[lane] = first;
        enter(lane, StageAt::First, course, ws);
    }

    /// True where no shell has less than nothing of a solid or a gas.
    fn is_positive(&self, lane: usize, ws: &RadialWorkspace) -> bool {
        let g = ws.gases;
        // What is used up falls to subnormal numbers, whose round-off may leave it below zero.
        let mut amounts = ws.now.amount.iter();
        let solids = amounts.all(|n| n[lane] >= -f64::MIN_POSITIVE);
        let gases = ws.now_gas.chunks_exact(g.max(1)).all(|own| {
            let all: f64 = own.iter().map(|n| n[lane]).sum();
            own.iter().all(|n| n[lane] >= -ROUND_OFF * all)
        });
        solids && gases
    }

    /// Adds what passed to gas and surface in a stage that counts over a length in s.
    fn add(
        &self,
        lane: usize,
        outside: &Outside<'_>,
        length: f64,
        ws: &RadialWorkspace,
        out: &mut RadialOutcome,
    ) {
        let (n, g) = (ws.shells, ws.gases);
        let surface = ws.now.temperature[n][lane];
        let mut passing = 0.0;
        for k in 0..g {
            let flow = ws.flows.gas[(n - 1) * g + k][lane];
            passing += (flow * ws.gas_capacity[n * g + k][lane]).abs();
        }
        out.step_heat += length * ws.held.film_heat[lane] * (outside.temperature - surface);
        out.step_surface[0] += length * surface;
        out.step_surface[1] += length * surface.powi(4);
        out.step_weight[0] += length * passing;
        out.step_weight[1] += length * passing * surface;
    }

    /// Adds the gases that left in a step: what there was, and what was made, less what is there.
    fn add_flow(&self, lane: usize, ws: &RadialWorkspace, out: &mut RadialOutcome) {
        let (g, r) = (ws.gases, ws.reactions);
        for (k, flow) in out.flow.iter_mut().enumerate().take(g) {
            for shell in 0..ws.shells {
                let place = shell * g + k;
                *flow += ws.start_gas[place][lane] - ws.now_gas[place][lane];
            }
        }
        for j in 0..r {
            let turned = (0..ws.shells).map(|shell| ws.turned[shell * r + j][lane]);
            let turned: f64 = turned.sum();
            for (k, flow) in out.flow.iter_mut().enumerate().take(g) {
                *flow += self.gas_moles[j * g + k] * turned;
            }
        }
    }

    /// Means of the window, and how the particle as a whole follows the gas over its span: by one implicit step about its end, of which
    /// the round at hand has eliminated all but the surface.
    fn answer(
        &self,
        lane: usize,
        outside: &Outside<'_>,
        ws: &mut RadialWorkspace,
        out: &mut RadialOutcome,
    ) {
        let (n, g) = (ws.shells, ws.gases);
        let block = 1 + g;
        copy_lane(&mut ws.now.temperature, &ws.start.temperature, lane);
        copy_lane(&mut ws.now.pressure, &ws.start.pressure, lane);
        let film = ws.held.film_heat[lane];
        let surface = ws.algebra.above(n);
        out.surface_by_heat = surface[0][lane];
        out.surface_slope = film * out.surface_by_heat;
        out.heat_slope = film * (1.0 - out.surface_slope);
        let net = net_flow(lane, outside, ws);
        // What the film passes is what the outermost shell does.
        let face = n - 1;
        let through = FaceFlow::of::<ANY>(face, ws);
        let inside = ws.algebra.above(face);
        for k in 0..g {
            let number = net / ws.held.film[k][lane];
            let direct = ws.held.film[k][lane] * bernoulli(number);
            let mut at_surface = [0.0; 1 + MOST_GASES];
            let mut within = [0.0; 1 + MOST_GASES];
            for i in 0..block {
                at_surface[i] = direct * surface[i * block + 1 + k][lane];
            }
            for i in 0..block {
                let pairs = (0..block).map(|j| inside[i * block + j][lane] * at_surface[j]);
                within[i] = -pairs.sum::<f64>();
            }
            let carried = through.carried::<ANY>(face, k, ws);
            let diffusion = ws.held.diffusion[face * g + k][lane];
            let mut flow = (diffusion + carried.own_here[lane]) * within[1 + k]
                + (carried.own_there[lane] - diffusion) * at_surface[1 + k];
            for j in 0..g {
                let dragged = (ws.held.drag[(face * g + k) * g + j] * carried.fraction)[lane];
                flow += (dragged + carried.by_here[lane]) * within[1 + j]
                    + (carried.by_there[lane] - dragged) * at_surface[1 + j];
            }
            out.flow_slope[k] = flow;
        }
        let slopes = out.flow_slope.iter().all(|slope| slope.is_finite());
        if !(slopes && out.surface_by_heat.is_finite()) {
            // Without slopes the exchange is told as it is.
            (out.heat_slope, out.surface_slope, out.surface_by_heat) = (film, 0.0, 0.0);
            out.flow_slope = [0.0; MOST_GASES];
        }
    }
}

impl RadialOutcome {
    /// Sums of a step begin anew.
    fn begin_step(&mut self) {
        (self.step_heat, self.step_surface, self.step_weight) = (0.0, [0.0; 2], [0.0; 2]);
    }
}

impl RadialCourse {
    /// Ends it: sums become means.
    pub fn end(mut self, lane: usize, ws: &RadialWorkspace) -> RadialOutcome {
        let out = &mut self.out;
        out.heat /= self.span;
        out.surface = out.surface.map(|sum| sum / self.span);
        out.flow.iter_mut().for_each(|flow| *flow /= self.span);
        out.released = if out.leaving[0] > 0.0 {
            out.leaving[1] / out.leaving[0]
        } else {
            ws.start.temperature[ws.shells][lane]
        };
        self.out
    }
}

/// The start as base, from which rates count over a length in s.
fn base_of_start(lane: usize, length: f64, ws: &mut RadialWorkspace) {
    copy_lane(&mut ws.base.enthalpy, &ws.start_enthalpy, lane);
    copy_lane(&mut ws.base.amount, &ws.start.amount, lane);
    copy_lane(&mut ws.base.gas, &ws.start_gas, lane);
    fill_lane(&mut ws.base.weight, lane, length);
}

/// Begins a stage: nothing has reacted in it.
fn enter(lane: usize, stage: StageAt, course: &mut RadialCourse, ws: &mut RadialWorkspace) {
    (course.stage, course.round, course.moved) = (stage, 0, f64::INFINITY);
    fill_lane(&mut ws.now.extent, lane, 0.0);
    copy_lane(&mut ws.now.amount, &ws.base.amount, lane);
    ws.updating[lane] = 1.0;
}
