//! What particles exchange with the gas through channels, heterogeneous reactions for example (docs/theory.md, RXN-1, 2).
//!
//! The rate of a channel j of particle p is a line in the mass fraction of its key gas that p sees, Ȳ = Σ_c W_cp Y_c:
//! r = b Ȳ − a. Its share in a cell follows the gas of the cell, W_cp [r + β (Y_c − Ȳ)], with β how the rate at a part of
//! the surface follows the gas there. b is the response of the particle as a whole, with its temperature and what
//! it is made of; β alone says where mass is exchanged, and no choice of b moves the result. An attempt of
//! a window gives the gas β Y_c − (a + (β − b) Ȳ) about the gas of the attempt before, with the larger of b and β/2
//! implicitly: the key gas implicitly, which is what keeps large process steps stable, a gas into which the
//! channel turns it mole for mole likewise (the rate follows both, and by the key gas alone the two would be out of step
//! until the attempts agree), all others explicitly, but for what would be taken of a gas whatever is left of it: that goes in
//! proportion to what is left, so that no attempt comes to fractions below zero. What comes of it gives the rates of the cells; limited to what
//! particles hold, they are given to the gas once more as fixed sources, all species of a channel in their proportions,
//! so that elements close whatever the attempts before did.
//!
//! Gas that is used up leaves its cell with the cell's temperature, gas that is made comes with the
//! particle's.

use calcine_interior::{Channel, GasLines};
use calcine_numerics::parallel::{self, CHUNK};
use calcine_physics::gas_model::GasModel;
use rayon::prelude::*;

use crate::part::{GasFields, SpeciesExchange};
use crate::smoother::Operator;

/// The channels of all particles, and their lines at hand.
#[derive(Clone, Copy, Debug)]
pub struct ChannelLines<'a> {
    /// The channels.
    pub channels: &'a [Channel],
    /// The lines of all particles.
    pub lines: &'a GasLines,
}

/// The exchange of species of one window, with its scratch memory.
#[derive(Debug, Default)]
pub struct SpeciesCoupling {
    /// Mean rate of each channel of each particle in units/s, channel by channel within each particle.
    pub rates: Vec<f64>,
    /// Sensible heat in W that exchanged gases bring into each particle.
    pub carried: Vec<f64>,
    /// The same into each cell, of the last attempt.
    pub cell_heat: Vec<f64>,
    /// Sum of rates in units/s below which nothing is exchanged.
    pub least: f64,
    /// Rates before those.
    before: Vec<f64>,
    /// Of each channel the gas that counter-diffuses mole for mole.
    counter: Vec<Option<usize>>,
    shares: Vec<f64>,
    /// β of each channel of each particle.
    slope: Vec<f64>,
    /// a + (β − b) Ȳ of each.
    offset: Vec<f64>,
    /// The slope of each that the gas takes implicitly.
    implicit: Vec<f64>,
    key_fraction: Vec<f64>,
    /// Of each channel the sums of the lines over particles, in cells.
    cells: Vec<CellLine>,
    /// Mass fractions by which the fixed rates went.
    fractions: Vec<f64>,
    scratch: Vec<f64>,
    sampled: Vec<f64>,
}

/// Mass fraction of a gas that is as good as not there.
const FAINT: f64 = 1e-9;

impl CellRows<'_> {
    /// Takes implicitly what would be taken of a gas whatever is left of it, in proportion to what is left: no attempt comes
    /// to fractions below zero. At the fractions at hand nothing changes, where there is any of the gas.
    fn keep_positive(self, fractions: &[f64]) {
        let rows = self.source.iter_mut().zip(self.coefficient).zip(fractions);
        for ((source, coefficient), fraction) in rows {
            if *source < 0.0 {
                *coefficient -= *source / fraction.max(FAINT);
                *source = 0.0;
            }
        }
    }
}

/// The lines of one channel, summed over particles, in each cell.
#[derive(Debug, Default)]
struct CellLine {
    slope: Vec<f64>,
    offset: Vec<f64>,
    implicit: Vec<f64>,
    /// Slope and offset, each times the sensible enthalpy in J a unit of what the channel makes.
    warm_slope: Vec<f64>,
    warm_offset: Vec<f64>,
}

impl SpeciesCoupling {
    /// Tells the gas the lines, about its present fields. The result is how far their rates there are from those before, as a
    /// share of all.
    pub fn linearise(
        &mut self,
        operator: &Operator,
        given: ChannelLines<'_>,
        gas: &GasFields<'_>,
        properties: &GasModel,
        out: &mut SpeciesExchange,
    ) -> f64 {
        let species = properties.species().len();
        let count = given.channels.len() * operator.particles();
        self.shares.clear();
        self.shares.resize(count, 1.0);
        let moved = self.follow(operator, given, gas, species);
        self.spread(operator, given, properties);
        let counter = |channel| counter(channel, properties);
        self.counter.clear();
        self.counter.extend(given.channels.iter().map(counter));
        self.fill(given, species, true, out);
        moved
    }

    /// Takes up the rates of the lines at the gas as it is; the result is how far they are from those before, as a share of
    /// all.
    pub fn follow(
        &mut self,
        operator: &Operator,
        given: ChannelLines<'_>,
        gas: &GasFields<'_>,
        species: usize,
    ) -> f64 {
        std::mem::swap(&mut self.rates, &mut self.before);
        self.fractions.clear();
        self.fractions.extend_from_slice(gas.composition);
        self.sample_rates(operator, given, species);
        let (mut moved, mut all) = (0.0, 0.0);
        let width = given.channels.len().max(1);
        for (at, (now, before)) in self.rates.iter().zip(&self.before).enumerate() {
            let count = operator.count(at / width);
            moved += count * (now - before).abs();
            all += count * now.abs();
        }
        let all: f64 = all;
        if moved == 0.0 {
            0.0
        } else {
            moved / all.max(self.least).max(f64::MIN_POSITIVE)
        }
    }

    /// The rate that moved most in the last comparison, by its place in [`SpeciesCoupling::rates`], before and now in units/s;
    /// `None` where none did. One that is not finite has moved more than all.
    pub fn most_moved(&self) -> Option<(usize, [f64; 2])> {
        let pairs = self.before.iter().zip(&self.rates).enumerate();
        let moved = pairs.map(|(at, (before, now))| (at, [*before, *now]));
        let by = |one: &(usize, [f64; 2])| {
            let change = (one.1[1] - one.1[0]).abs();
            if change.is_finite() {
                change
            } else {
                f64::INFINITY
            }
        };
        moved
            .filter(|one| by(one) > 0.0)
            .max_by(|one, other| by(one).total_cmp(&by(other)))
    }

    /// Tells the gas the rates of the last attempt as they are, after `limit` has lowered them to what the particles
    /// hold.
    pub fn fix(
        &mut self,
        operator: &Operator,
        given: ChannelLines<'_>,
        limit: impl FnOnce(&mut [f64]),
        properties: &GasModel,
        out: &mut SpeciesExchange,
    ) {
        self.shares.clone_from(&self.rates);
        limit(&mut self.rates);
        for (share, rate) in self.shares.iter_mut().zip(&self.rates) {
            *share = if *share == *rate { 1.0 } else { rate / *share };
        }
        if self.shares.iter().any(|share| *share != 1.0) {
            self.spread(operator, given, properties);
        }
        self.fill(given, properties.species().len(), false, out);
    }

    /// What of the heat that cells received came with exchanged gas, in W.
    pub fn heat_of_cells(
        &mut self,
        gas: &GasFields<'_>,
        properties: &GasModel,
        told: &SpeciesExchange,
    ) {
        let species = properties.species().len();
        self.cell_heat.resize(told.heat.len(), 0.0);
        parallel::fill(&mut self.cell_heat, |cell| {
            let taken = (0..species).map(|k| {
                let mass = told.taken[cell * species + k];
                if mass == 0.0 {
                    0.0
                } else {
                    mass * properties.species_enthalpy(k, gas.temperature[cell])
                }
            });
            told.heat[cell] - taken.sum::<f64>()
        });
    }

    /// Sets `carried`: the sensible heat of what each particle takes from its cells, less that of what it makes.
    pub fn credit(
        &mut self,
        operator: &Operator,
        given: ChannelLines<'_>,
        gas: &GasFields<'_>,
        properties: &GasModel,
    ) {
        let (cells, particles) = (operator.cells(), operator.particles());
        let species = properties.species().len();
        let channels = given.channels;
        self.carried.clear();
        self.carried.resize(particles, 0.0);
        self.sampled.resize(particles, 0.0);
        let mut enthalpy = vec![0.0; cells];
        for (c, channel) in channels.iter().enumerate() {
            let at = |p: usize| p * channels.len() + c;
            parallel::fill(&mut enthalpy, |cell| {
                let parts = channel.mass.iter().enumerate();
                let used = parts.filter(|(_, mass)| **mass < 0.0);
                used.map(|(k, mass)| -mass * properties.species_enthalpy(k, gas.temperature[cell]))
                    .sum()
            });
            operator.sample(&enthalpy, &mut self.sampled);
            let (shares, sampled) = (&self.shares, &self.sampled);
            parallel::update(&mut self.carried, |p, carried| {
                *carried -= shares[at(p)] * self.offset[at(p)] * sampled[p];
            });
            parallel::update(&mut enthalpy, |cell, value| {
                *value *= fraction(&self.fractions, cell, species, channel);
            });
            operator.sample(&enthalpy, &mut self.sampled);
            let sampled = &self.sampled;
            parallel::update(&mut self.carried, |p, carried| {
                *carried += shares[at(p)] * self.slope[at(p)] * sampled[p]
                    - self.rates[at(p)] * made(channel, properties, given.lines.released[p]);
            });
        }
    }

    /// Brings the particles' lines to the cells.
    fn spread(&mut self, operator: &Operator, given: ChannelLines<'_>, properties: &GasModel) {
        let channels = given.channels;
        let (shares, scratch) = (&self.shares, &mut self.scratch);
        scratch.resize(operator.particles(), 0.0);
        self.cells.resize_with(channels.len(), CellLine::default);
        for (c, (channel, cells)) in channels.iter().zip(&mut self.cells).enumerate() {
            let at = |p: usize| p * channels.len() + c;
            let mut gather = |lines: &[f64], sums: &mut Vec<f64>, warm: Option<&mut Vec<f64>>| {
                for (p, value) in scratch.iter_mut().enumerate() {
                    *value = shares[at(p)] * lines[at(p)];
                }
                sums.resize(operator.cells(), 0.0);
                operator.spread(scratch, sums);
                let Some(warm) = warm else {
                    return;
                };
                for (value, released) in scratch.iter_mut().zip(&given.lines.released) {
                    if *value != 0.0 {
                        *value *= made(channel, properties, *released);
                    }
                }
                warm.resize(operator.cells(), 0.0);
                operator.spread(scratch, warm);
            };
            gather(&self.slope, &mut cells.slope, Some(&mut cells.warm_slope));
            gather(
                &self.offset,
                &mut cells.offset,
                Some(&mut cells.warm_offset),
            );
            gather(&self.implicit, &mut cells.implicit, None);
        }
    }

    /// Rates of all particles' lines, unlimited, at the mass fractions at hand.
    fn sample_rates(&mut self, operator: &Operator, given: ChannelLines<'_>, species: usize) {
        let channels = given.channels;
        let (slopes, offsets) = (&given.lines.slope, &given.lines.offset);
        self.rates.clear();
        self.rates.resize(slopes.len(), 0.0);
        self.slope.clone_from(&given.lines.local_slope);
        let pairs = slopes.iter().zip(&self.slope);
        self.implicit.clear();
        self.implicit
            .extend(pairs.map(|(whole, local)| implicit_slope(*whole, *local)));
        self.offset.clear();
        self.offset.resize(slopes.len(), 0.0);
        self.sampled.resize(operator.particles(), 0.0);
        let (mut sampled, fractions) = (None, &self.fractions);
        for (c, channel) in channels.iter().enumerate() {
            if sampled != Some(channel.key) {
                self.key_fraction.resize(operator.cells(), 0.0);
                parallel::fill(&mut self.key_fraction, |cell| {
                    fraction(fractions, cell, species, channel)
                });
                operator.sample(&self.key_fraction, &mut self.sampled);
                sampled = Some(channel.key);
            }
            for (p, sampled) in self.sampled.iter().enumerate() {
                let at = p * channels.len() + c;
                self.rates[at] = slopes[at] * sampled - offsets[at];
                self.offset[at] = self.slope[at] * sampled - self.rates[at];
            }
        }
    }

    /// What the gas is told, by the cells' lines at the mass fractions at hand.
    fn fill(
        &self,
        given: ChannelLines<'_>,
        species: usize,
        implicit: bool,
        out: &mut SpeciesExchange,
    ) {
        let cells = self.fractions.len() / species.max(1);
        out.reset(cells, species);
        let width = (species * CHUNK).max(1);
        let coefficients = out.coefficient.par_chunks_mut(width);
        let gained = out.source.par_chunks_mut(width);
        let taken = out.taken.par_chunks_mut(width);
        let chunks = (coefficients.zip(gained).zip(taken)).zip(out.heat.par_chunks_mut(CHUNK));
        chunks.enumerate().for_each(|(chunk, (rows, heat))| {
            let ((coefficient, source), taken) = rows;
            for (row, heat) in heat.iter_mut().enumerate() {
                let own = row * species..(row + 1) * species;
                let told = CellRows {
                    coefficient: &mut coefficient[own.clone()],
                    source: &mut source[own.clone()],
                    taken: &mut taken[own],
                    heat,
                };
                self.fill_cell(given.channels, chunk * CHUNK + row, implicit, told);
            }
        });
    }

    /// The same for one cell.
    fn fill_cell(&self, channels: &[Channel], cell: usize, implicit: bool, told: CellRows<'_>) {
        let species = told.source.len();
        let fractions = &self.fractions[cell * species..(cell + 1) * species];
        for (c, (channel, lines)) in channels.iter().zip(&self.cells).enumerate() {
            let (slope, offset) = (lines.slope[cell], lines.offset[cell]);
            if slope == 0.0 && offset == 0.0 {
                continue;
            }
            let fraction = fraction(&self.fractions, cell, species, channel);
            let rate = slope * fraction - offset;
            let taken = lines.implicit[cell];
            for (k, mass) in channel.mass.iter().enumerate().filter(|(_, m)| **m != 0.0) {
                let steepness = -mass * taken;
                if implicit && channel.key == Some(k) && steepness > 0.0 {
                    told.coefficient[k] += steepness;
                    told.source[k] += mass * rate + steepness * fraction;
                } else if implicit && taken > 0.0 && self.counter[c] == Some(k) {
                    // What the key gas loses, this one gains, mole for mole, in a gas whose mass changes with it.
                    let key = channel.key.map_or(0.0, |key| -channel.mass[key]);
                    let gain = mass - key;
                    let ratio = (1.0 + fraction * gain / key) / (1.0 - fractions[k] * gain / mass);
                    let coefficient = key * taken * ratio;
                    told.coefficient[k] += coefficient;
                    told.source[k] += mass * rate + coefficient * fractions[k];
                } else {
                    told.source[k] += mass * rate;
                }
                if *mass < 0.0 {
                    told.taken[k] -= mass * rate;
                }
            }
            *told.heat += lines.warm_slope[cell] * fraction - lines.warm_offset[cell];
        }
        if implicit {
            told.keep_positive(fractions);
        }
    }
}

/// What the gas is told of one cell, by species.
struct CellRows<'a> {
    coefficient: &'a mut [f64],
    source: &'a mut [f64],
    taken: &'a mut [f64],
    heat: &'a mut f64,
}

/// Mass fraction in a cell of the key gas of a channel.
fn fraction(fractions: &[f64], cell: usize, species: usize, channel: &Channel) -> f64 {
    channel
        .key
        .map_or(0.0, |key| fractions[cell * species + key])
}

/// The slope that the gas takes implicitly: that of the whole particle, which its total follows, and no less than half of
/// the local one, by which attempts contract at least twofold in how the cells of a particle differ.
fn implicit_slope(whole: f64, local: f64) -> f64 {
    if whole.abs() < 0.5 * local.abs() {
        0.5 * local
    } else {
        whole
    }
}

/// The gas into which a channel turns its key gas mole for mole, where it does nothing else.
fn counter(channel: &Channel, properties: &GasModel) -> Option<usize> {
    let GasModel::Mixture(mixture) = properties else {
        return None;
    };
    let moles = |k: usize| channel.mass[k] / mixture.species()[k].molar_mass();
    let mut products = (0..channel.mass.len()).filter(|&k| channel.mass[k] > 0.0);
    let used = (0..channel.mass.len()).filter(|&k| channel.mass[k] < 0.0);
    let (key, product) = (channel.key?, products.next()?);
    let alone = products.next().is_none() && used.count() == 1 && channel.mass[key] < 0.0;
    let balance = moles(key) + moles(product);
    (alone && balance.abs() < 1e-6 * moles(product)).then_some(product)
}

/// Sensible enthalpy in J of the gases that a unit of a channel makes, at a temperature in K.
fn made(channel: &Channel, properties: &GasModel, temperature: f64) -> f64 {
    let parts = channel.mass.iter().enumerate();
    parts
        .filter(|(_, mass)| **mass > 0.0)
        .map(|(k, mass)| mass * properties.species_enthalpy(k, temperature))
        .sum()
}
