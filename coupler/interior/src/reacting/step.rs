//! One window of particles that react, with the gas about them held.

use calcine_numerics::IntegrationStalled;
use calcine_numerics::batch::each_row;
use thiserror::Error;

use super::Reacting;
use super::attempt::{AttemptGuess, ParticleStart, ParticleWorkspace};
use super::passage::ParticleSurroundings;
use crate::model::{NetworkHeat, Surroundings};

/// A particle whose reactions cannot be followed.
#[derive(Clone, Debug, Error, PartialEq)]
#[error(
    "the reactions of a particle at {temperature} K in gas of {gas_temperature} K: {cause}; the largest error is \
     that of {reaction}: check its rate constant and its equilibrium there, or shorten the windows (time.motion_window, or \
     time.process_step where the case has it)"
)]
pub struct ReactError {
    /// Its row.
    pub row: usize,
    /// Its temperature in K at the start of the window.
    pub temperature: f64,
    /// That of the gas in K.
    pub gas_temperature: f64,
    /// The reaction that its integration failed with.
    pub reaction: String,
    /// What went wrong.
    pub cause: IntegrationStalled,
}

/// A particle whose heat has no temperature.
#[derive(Clone, Copy, Debug, Error, PartialEq)]
#[error(
    "the particle comes to its bound of {bound} K from {from} K within one window, with {exchanged:.4e} J from gas, \
     contacts and radiation and {released:.4e} J from its reactions: shorten the windows (time.motion_window, or \
     time.process_step where the case has it), or check the heats of reaction"
)]
pub struct TemperatureBeyond {
    /// The bound in K that it would pass.
    pub bound: f64,
    /// Its temperature in K at the start of the window.
    pub from: f64,
    /// Heat in J that it exchanged over the window.
    pub exchanged: f64,
    /// Heat in J that its reactions set free.
    pub released: f64,
}

/// Places of a particle's results in a row of them: extents follow, those with which slopes were taken, and lines.
const CONDUCTANCE: usize = 0;
const START: usize = 1;
const END: usize = 2;
const FIRST_STEP: usize = 3;
const EXTENTS: usize = 4;

/// By what share the extents of a window may move before slopes over the window are taken anew. Only how fast attempts
/// converge depends on the slopes.
const SLOPES_HOLD: f64 = 0.1;

impl Reacting {
    /// Follows every particle over a process span in s, each by itself, with the network's heat in W, and takes the
    /// lines from it that the exchange needs.
    pub(super) fn react(
        &mut self,
        around: &Surroundings<'_>,
        span: f64,
        network: &[NetworkHeat],
    ) -> Result<(), ReactError> {
        let (count, channels) = (self.chemistry.reactions.len(), self.channels.len());
        let width = EXTENTS + 2 * count + 3 * channels;
        // The attempt before of the same window, in which each particle finds its own row.
        let mut results = std::mem::take(&mut self.results);
        let first = results.len() != self.count() * width;
        if first {
            results.clear();
            results.resize(self.count() * width, 0.0);
        }
        let done = each_row(
            &mut results,
            width,
            ParticleScratch::default,
            |p, row, scratch| {
                self.react_one(p, around, (span, network[p].mean, first), row, scratch)
            },
        );
        for (p, row) in results.chunks_exact(width).enumerate() {
            let (head, rest) = row.split_at(EXTENTS);
            let (extents, lines) = (&rest[..count], &rest[2 * count..]);
            self.conductance[p] = head[CONDUCTANCE];
            self.start[p] = head[START];
            self.end[p] = head[END];
            self.extents[p * count..(p + 1) * count].copy_from_slice(extents);
            for (all, own) in self
                .lines
                .iter_mut()
                .zip(lines.chunks_exact(channels.max(1)))
            {
                all[p * channels..(p + 1) * channels].copy_from_slice(own);
            }
        }
        self.results = results;
        done
    }

    /// One particle; a function of its committed state, its surroundings and its row of the attempt before.
    fn react_one(
        &self,
        p: usize,
        around: &Surroundings<'_>,
        (span, heat, first): (f64, f64, bool),
        row: &mut [f64],
        scratch: &mut ParticleScratch,
    ) -> Result<(), ReactError> {
        let (hot, exchanged) = (around.temperature[p], around.conductance[p]);
        let begin = self.committed.temperature[p];
        let heat = heat + self.committed.owed[p] / span;
        // Without reactions: the implicit step.
        let inert = exchanged / (1.0 + exchanged * span / self.capacity[p]);
        if !self.can_react(p) {
            row.fill(0.0);
            row[CONDUCTANCE] = inert;
            row[START] = begin + heat * span / self.capacity[p];
            row[END] = row[START] + inert * (hot - row[START]) * span / self.capacity[p];
            return Ok(());
        }
        let solids = self.chemistry.solids.len();
        scratch.see(self, p, around);
        let mass = self.committed.first_mass[p];
        scratch.first.clear();
        scratch
            .first
            .extend(self.composition.iter().map(|n| n * mass));
        let species = scratch.fractions.len();
        let start = ParticleStart {
            amounts: &self.committed.amount[p * solids..(p + 1) * solids],
            first: &scratch.first,
            temperature: begin,
            around: ParticleSurroundings {
                temperature: hot,
                // Reactions without gas need no pressure and no film, which are empty where nothing has channels.
                pressure: around.pressure.get(p).copied().unwrap_or_default(),
                fractions: &scratch.fractions,
                film: around
                    .film
                    .get(p * species..(p + 1) * species)
                    .unwrap_or_default(),
                theory: around.theory,
                radius: around.radius[p],
                size: self.size(),
            },
            conductance: exchanged,
            heat,
        };
        let count = self.chemistry.reactions.len();
        let guess = guess(&row[..EXTENTS + 2 * count], first);
        let workspace = &mut scratch.workspace;
        let outcome = self
            .chemistry
            .follow_again(&start, span, self.accuracy, guess, workspace)
            .map_err(|cause| ReactError {
                row: p,
                temperature: begin,
                gas_temperature: hot,
                reaction: self
                    .chemistry
                    .worst_reaction(cause.worst, workspace)
                    .to_owned(),
                cause,
            })?;
        row[END] = outcome.end;
        let flow = outcome.flow;
        // Only how fast attempts converge depends on the slope.
        let slope = if guess.slopes {
            let least = 0.2 * inert;
            outcome.flow_slope.clamp(least, exchanged.max(least))
        } else {
            row[CONDUCTANCE]
        };
        row[CONDUCTANCE] = slope;
        row[START] = if slope > 0.0 { hot - flow / slope } else { hot };
        row[FIRST_STEP] = outcome.first_step;
        let (extents, rest) = row[EXTENTS..].split_at_mut(count);
        let (those_of_slopes, lines) = rest.split_at_mut(count);
        extents.copy_from_slice(&workspace.extents);
        if guess.slopes {
            those_of_slopes.copy_from_slice(extents);
        }
        self.draw_lines(p, around, (span, guess.slopes), workspace, lines);
        Ok(())
    }

    /// The lines of a particle's channels: tangents of their mean rates, or those that `lines` holds, offsets, and slopes in
    /// single cells.
    fn draw_lines(
        &self,
        p: usize,
        around: &Surroundings<'_>,
        (span, slopes): (f64, bool),
        workspace: &ParticleWorkspace,
        lines: &mut [f64],
    ) {
        let Some(gas) = &self.chemistry.gas else {
            return;
        };
        let species = gas.names().len();
        let composition = &around.composition[p * species..(p + 1) * species];
        let molar = gas.molar_mass(composition);
        let count = self.channels.len();
        let channels = self.channels.iter().zip(&self.reaction_of);
        for (c, (channel, reaction)) in channels.enumerate() {
            let Some(key) = channel.key else {
                continue;
            };
            let mean = workspace.extents[*reaction] / span;
            let own = gas.species()[key].molar_mass();
            // As the gas reacts it gains mass: its own fraction falls by more than what of it is used.
            let gain = self.chemistry.counter(*reaction).map_or(0.0, |product| {
                composition[key] * (gas.species()[product].molar_mass() - own) / own
            });
            let by_mass = molar / own / (1.0 + gain);
            // More of a gas that is used up lets a reaction go faster, more of one that is made slower; where others
            // compete with it so hard that it is the other way round, the rate is told as fixed.
            let told = |slope: f64| {
                let slope = slope / span * by_mass;
                if slope * channel.mass[key] < 0.0 {
                    slope
                } else {
                    0.0
                }
            };
            if slopes {
                lines[c] = told(workspace.slopes[*reaction]);
            }
            let slope = lines[c];
            lines[count + c] = slope * composition[key] - mean;
            let local = told(workspace.local_slopes[*reaction]);
            // A cell gives no more than its share of the gas that is used: orders below one follow a gas less than in proportion,
            // and would take from cells that have none.
            let used = mean * channel.mass[key] < 0.0 && composition[key] > 0.0;
            let proportional = if used { mean / composition[key] } else { 0.0 };
            lines[2 * count + c] = if proportional.abs() > local.abs() {
                proportional
            } else {
                local
            };
        }
    }

    /// True where a particle holds a solid that some reaction uses, makes, or goes on.
    fn can_react(&self, p: usize) -> bool {
        let solids = self.chemistry.solids.len();
        let amounts = &self.committed.amount[p * solids..(p + 1) * solids];
        let mut moving = self.chemistry.moving().iter();
        let mut catalysts = self.chemistry.catalysts();
        moving.any(|s| amounts[*s] > 0.0) || catalysts.any(|s| amounts[s] > 0.0)
    }
}

/// What a row of the attempt before tells the next one; a first attempt has none.
fn guess(row: &[f64], first: bool) -> AttemptGuess {
    if first || row[FIRST_STEP] == 0.0 {
        return AttemptGuess::default();
    }
    let (extents, those_of_slopes) = row[EXTENTS..].split_at((row.len() - EXTENTS) / 2);
    let pairs = extents.iter().zip(those_of_slopes);
    let (moved, all) = pairs.fold((0.0, 0.0), |(moved, all): (f64, f64), (now, then)| {
        (moved + (now - then).abs(), all + then.abs())
    });
    AttemptGuess {
        first_step: row[FIRST_STEP],
        slopes: moved > SLOPES_HOLD * all,
    }
}

/// Memory of a thread.
#[derive(Debug, Default)]
struct ParticleScratch {
    workspace: ParticleWorkspace,
    fractions: Vec<f64>,
    /// Amounts in mol with which the particle came.
    first: Vec<f64>,
}

impl ParticleScratch {
    /// Takes up the mole fractions about a particle.
    fn see(&mut self, reacting: &Reacting, p: usize, around: &Surroundings<'_>) {
        self.fractions.clear();
        if let Some(gas) = &reacting.chemistry.gas {
            let species = gas.names().len();
            self.fractions.resize(species, 0.0);
            let composition = &around.composition[p * species..(p + 1) * species];
            gas.mole_fractions(composition, &mut self.fractions);
            for fraction in &mut self.fractions {
                *fraction = fraction.max(0.0);
            }
            reacting.chemistry.other_than_vapour(&mut self.fractions);
        }
    }
}
