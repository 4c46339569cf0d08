//! One particle over one window, with the gas about it held.

mod film_heat;
mod system;

use calcine_numerics::rosenbrock::{IntegrationAccuracy, MOST_STEPS, StallCause};
use calcine_numerics::{
    DenseMatrix, IntegrationStalled, IntegrationStatistics, Rosenbrock, RosenbrockTableau,
    StiffSystem,
};

pub use self::system::{AttemptGuess, ParticleStart};
use self::system::{Buffers, ParticleSystem};
use super::chemistry::SolidChemistry;
use super::rates::TRACE;

/// How exactly particles are integrated.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ParticleAccuracy {
    /// Errors of amounts and of extents in a step, as a share of a particle's solids.
    pub amount: f64,
    /// Error of its temperature in a step in K.
    pub temperature: f64,
}

impl Default for ParticleAccuracy {
    fn default() -> Self {
        Self {
            amount: 1e-6,
            temperature: 1e-2,
        }
    }
}

/// What a window does to a particle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ParticleOutcome {
    /// Mean heat from the gas in W.
    pub flow: f64,
    /// Its temperature at the end in K.
    pub end: f64,
    /// Change of that heat with the temperature of the gas in W/K.
    pub flow_slope: f64,
    /// Length of its first step in s.
    pub first_step: f64,
    /// What its integration took.
    pub statistics: IntegrationStatistics,
}

/// Memory of attempts, reused; no result depends on what it was used for before.
#[derive(Clone, Debug)]
pub struct ParticleWorkspace {
    method: Rosenbrock<DenseMatrix>,
    unknowns: Vec<f64>,
    tolerance: Vec<f64>,
    /// What each reaction turns over, in mol.
    pub extents: Vec<f64>,
    /// How that changes with the mole fraction of each reaction's key gas, in mol.
    pub slopes: Vec<f64>,
    /// The same with the particle's state as it went: what the gas at a part of its surface does.
    pub local_slopes: Vec<f64>,
    buffers: Buffers,
}

impl Default for ParticleWorkspace {
    fn default() -> Self {
        Self {
            method: Rosenbrock::new(&RosenbrockTableau::RODAS4, DenseMatrix::default())
                .quickly(&RosenbrockTableau::RODAS3),
            unknowns: Vec::new(),
            tolerance: Vec::new(),
            extents: Vec::new(),
            slopes: Vec::new(),
            local_slopes: Vec::new(),
            buffers: Buffers::default(),
        }
    }
}

/// How sharply rates end, and in how many steps a particle is followed with that.
#[derive(Clone, Copy, Debug)]
struct RateEdges {
    /// Share of a particle's solids that is a trace ([`TRACE`]).
    trace: f64,
    /// How fast interfaces are at most ([`super::rates::RateState::fastest`]).
    fastest: f64,
    /// Steps at most.
    steps: usize,
}

/// A particle whose steps do not suffice is followed anew with blunter edges: interfaces whose constants are many powers of ten
/// apart and that react forth by one gas and back by another hold traces that no step within the accuracy can follow.
/// Its rates are then within a thousandth of those of infinitely fast interfaces, its solids within 1e-4 of all.
const EDGES: [RateEdges; 2] = [
    RateEdges {
        trace: TRACE,
        fastest: 1e5,
        steps: 200,
    },
    RateEdges {
        trace: 100.0 * TRACE,
        fastest: 1e3,
        steps: MOST_STEPS,
    },
];

/// Share of its heat capacity at the start of a window that a particle has at least: what is used up has the
/// temperature at which the heat of its reactions passes.
const LEAST_CAPACITY: f64 = 1e-9;
impl SolidChemistry {
    /// Follows a particle over a span in s. Extents and their slopes are left in the workspace.
    ///
    /// The unknowns are the amounts n of the solids that react, and the temperature T, the integrals the extents ξ:
    ///
    /// dn_s/dτ = Σ_j ν_sj r_j,   C dT/dτ = h A (T_gas − T) + Q + Σ_j r_j q_j,   dξ_j/dτ = r_j.
    ///
    /// Radius, film and h A follow the amounts. The heat from the gas is what the balance of energy leaves for it between
    /// start and end: ∫ h A (T_gas − T) dτ has no digits where h A is large.
    ///
    /// Amounts, not extents, are the unknowns, because what is left of a solid that a fast reaction uses as
    /// it is made is a difference of extents without digits. The extents keep all amounts: n = n₀ + ν ξ to round-off.
    pub fn follow(
        &self,
        start: &ParticleStart<'_>,
        span: f64,
        accuracy: ParticleAccuracy,
        workspace: &mut ParticleWorkspace,
    ) -> Result<ParticleOutcome, IntegrationStalled> {
        self.follow_again(start, span, accuracy, AttemptGuess::default(), workspace)
    }

    /// The same after another attempt of the window.
    pub fn follow_again(
        &self,
        start: &ParticleStart<'_>,
        span: f64,
        accuracy: ParticleAccuracy,
        guess: AttemptGuess,
        workspace: &mut ParticleWorkspace,
    ) -> Result<ParticleOutcome, IntegrationStalled> {
        let [sharp, blunt] = EDGES;
        let done = self.follow_with(start, span, accuracy, (guess, sharp), workspace);
        match done {
            Err(IntegrationStalled {
                cause: StallCause::Steps(_) | StallCause::Step,
                ..
            }) => {
                let mut done =
                    self.follow_with(start, span, accuracy, (guess, blunt), workspace)?;
                done.statistics.rejected += sharp.steps;
                Ok(done)
            }
            done => done,
        }
    }

    fn follow_with(
        &self,
        start: &ParticleStart<'_>,
        span: f64,
        accuracy: ParticleAccuracy,
        (guess, edges): (AttemptGuess, RateEdges),
        workspace: &mut ParticleWorkspace,
    ) -> Result<ParticleOutcome, IntegrationStalled> {
        let ParticleWorkspace {
            method,
            unknowns,
            tolerance,
            extents,
            slopes,
            local_slopes,
            buffers,
        } = workspace;
        let (moving, count) = (self.moving().len(), self.reactions.len());
        let all: f64 = start.amounts.iter().map(|n| n.max(0.0)).sum();
        unknowns.clear();
        unknowns.extend(self.moving().iter().map(|&s| start.amounts[s]));
        unknowns.push(start.temperature);
        tolerance.clear();
        tolerance.resize(moving, accuracy.amount * all);
        tolerance.push(accuracy.temperature);
        tolerance.resize(moving + 1 + count, accuracy.amount * all);
        buffers.begin(self, start, guess.slopes);
        method.algebra().resize(moving + 1);
        let mut system = ParticleSystem {
            chemistry: self,
            start,
            trace: edges.trace * all,
            fastest: edges.fastest,
            round_off: f64::EPSILON * all,
            tolerance: accuracy.amount * all,
            least_capacity: LEAST_CAPACITY * self.heat_capacity(start.amounts, start.temperature),
            guess,
            buffers,
        };
        let accuracy = IntegrationAccuracy {
            relative: 0.0,
            absolute: tolerance,
            steps: edges.steps,
        };
        let statistics = method.integrate(&mut system, unknowns, span, accuracy)?;
        extents.clear();
        extents.extend_from_slice(&method.integrals()[..count]);
        // Rates far above what passes lose digits: what the extents leave of a solid, not the unknown, is what counts.
        for (&s, n) in self.moving().iter().zip(unknowns.iter_mut()) {
            *n = start.amounts[s];
        }
        for (j, extent) in extents.iter().enumerate() {
            for &(k, n) in self.effects(j) {
                unknowns[k] += n * extent;
            }
        }
        system.correct(unknowns, extents, &mut []);
        slopes.clear();
        local_slopes.clear();
        for j in 0..count {
            let direction = self.direction(j);
            slopes.push(direction.map_or(0.0, |one| method.tangent(one)[moving + 1 + j]));
            local_slopes.push(direction.map_or(0.0, |one| method.direct(one)[j]));
        }
        let gas_temperature = self.directions().len();
        let changed = method.tangent(gas_temperature);
        let (end, hot) = (unknowns[moving], start.around.temperature);
        let capacity = self.heat_capacity(start.amounts, end);
        let (mut brought, mut slope) = (-start.heat * span, capacity * changed[moving]);
        brought +=
            self.enthalpy(start.amounts, end) - self.enthalpy(start.amounts, start.temperature);
        for (&s, n) in self.moving().iter().zip(unknowns.iter()) {
            buffers.amounts[s] = *n;
        }
        if let Some(bound) = self.bound() {
            bound.heats(&buffers.amounts, &self.solids, &mut buffers.bound);
            brought += self.binding(&buffers.amounts) - self.binding(start.amounts);
        }
        for (j, extent) in extents.iter().enumerate() {
            let warmth = self.warmth(j, end, hot);
            let bound = buffers.bound.get(j).map_or(0.0, |one| one[0]);
            let [_, by_particle, by_gas] = buffers.warmth[j];
            brought -= extent * warmth;
            slope -= changed[moving + 1 + j] * (warmth + bound)
                + extent * (by_particle * changed[moving] + by_gas);
        }
        Ok(ParticleOutcome {
            flow: brought / span,
            end,
            flow_slope: slope / span,
            first_step: method.first_step(),
            statistics,
        })
    }

    /// The reaction that does most to the value that an integration ended at.
    pub fn worst_reaction(&self, worst: usize, workspace: &ParticleWorkspace) -> &str {
        let moving = self.moving().len();
        let rates = &workspace.buffers.rates;
        let effect = |j: usize| match worst {
            _ if worst > moving => f64::from(u8::from(worst - moving - 1 == j)),
            _ if worst == moving => rates[j] * workspace.buffers.warmth[j][0],
            _ => self
                .effects(j)
                .iter()
                .filter(|one| one.0 == worst)
                .map(|one| one.1 * rates[j])
                .sum(),
        };
        let largest = |best: usize, j: usize| {
            if effect(j).abs() > effect(best).abs() {
                j
            } else {
                best
            }
        };
        let found = (0..self.reactions.len()).fold(0, largest);
        self.reactions.get(found).map_or("", |one| &one.name)
    }
}

#[cfg(test)]
mod drying_tests;
#[cfg(test)]
mod film_tests;
#[cfg(test)]
mod shared_film_tests;
#[cfg(test)]
mod tests;
