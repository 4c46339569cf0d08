//! The equations of one particle within a window.

use calcine_numerics::rosenbrock::SystemDerivatives;
use calcine_numerics::{Dual, StiffSystem};

use super::film_heat::FilmHeat;
#[cfg(doc)]
use crate::reacting::bound_water::BoundWater;
use crate::reacting::chemistry::SolidChemistry;
use crate::reacting::film_balance::{self, FilmBalance};
use crate::reacting::passage::{FilmFlow, ParticleSurroundings};
use crate::reacting::rates::RateState;
use crate::reacting::surface::SurfaceBalance;

/// Rounds of taking back at most.
const MOST_ROUNDS: usize = 100;

/// By how much temperatures are varied for the slopes of heats, in K.
const VARIED: f64 = 10.0;
/// Directions of derivatives that one evaluation gives.
const WIDTH: usize = 8;
type Slopes = Dual<WIDTH>;

/// A particle at the start of a window, and what acts on it.
#[derive(Clone, Copy, Debug)]
pub struct ParticleStart<'a> {
    /// Amounts of all solids in mol.
    pub amounts: &'a [f64],
    /// Those with which it came.
    pub first: &'a [f64],
    /// Its temperature in K.
    pub temperature: f64,
    /// The gas about it.
    pub around: ParticleSurroundings<'a>,
    /// h A in W/K at the start.
    pub conductance: f64,
    /// Heat that it conducts and radiates, in W.
    pub heat: f64,
}

/// What an attempt before tells the next one of the same window. Amounts and temperature depend on it by no more than
/// the accuracy of the integration.
#[derive(Clone, Copy, Debug)]
pub struct AttemptGuess {
    /// Longest first step in s.
    pub first_step: f64,
    /// True where slopes over the window are wanted; they are zero elsewhere.
    pub slopes: bool,
}

impl Default for AttemptGuess {
    fn default() -> Self {
        Self {
            first_step: f64::INFINITY,
            slopes: true,
        }
    }
}

/// Memory of the equations.
#[derive(Clone, Debug, Default)]
pub(super) struct Buffers {
    pub amounts: Vec<f64>,
    pub rates: Vec<f64>,
    amounts_dual: Vec<Slopes>,
    fractions_dual: Vec<Slopes>,
    rates_dual: Vec<Slopes>,
    /// Heat of each reaction in J/mol at the start, and its changes with the temperatures of the particle and the gas.
    pub warmth: Vec<[f64; 3]>,
    /// Heat of each reaction in J/mol by what binds water at the amounts at hand, and its changes ([`BoundWater::heats`]); empty
    /// where nothing does.
    pub bound: Vec<[f64; 3]>,
    /// Molar heat capacity of each solid in J/mol/K, and its slope.
    molar: Vec<[f64; 2]>,
    /// The net flow through the film.
    film: FilmBalance,
    /// The gas at the surface, of rates and of their derivatives.
    surface: SurfaceBalance<f64>,
    surface_dual: SurfaceBalance<Slopes>,
    /// What exchanged gases do to the heat through the film.
    film_heat: FilmHeat,
    /// Change of the radius over that at the start with the amount of each solid that reacts, in 1/mol.
    shrinkage_slopes: Vec<f64>,
}

impl Buffers {
    pub fn begin(&mut self, chemistry: &SolidChemistry, start: &ParticleStart<'_>, slopes: bool) {
        let (begin, hot) = (start.temperature, start.around.temperature);
        let zero = Slopes {
            value: 0.0,
            slope: [0.0; WIDTH],
        };
        self.amounts.clear();
        self.amounts.extend_from_slice(start.amounts);
        self.rates.clear();
        self.rates.resize(chemistry.reactions.len(), 0.0);
        self.rates_dual.resize(chemistry.reactions.len(), zero);
        self.amounts_dual.resize(start.amounts.len(), zero);
        self.fractions_dual
            .resize(start.around.fractions.len(), zero);
        self.molar.resize(start.amounts.len(), [0.0; 2]);
        self.shrinkage_slopes.clear();
        self.shrinkage_slopes.resize(chemistry.moving().len(), 0.0);
        self.bound.clear();
        self.film.begin();
        self.surface.begin();
        self.surface_dual.begin();
        self.film_heat
            .begin(chemistry, &start.around, start.temperature);
        // The heat of a reaction follows temperature so slowly that a line will do here; what is booked is exact.
        self.warmth.clear();
        self.warmth.extend((0..chemistry.reactions.len()).map(|j| {
            let at = chemistry.warmth(j, begin, hot);
            let rise = |begin: f64, hot: f64| (chemistry.warmth(j, begin, hot) - at) / VARIED;
            // That with the temperature of the gas enters slopes over the window alone.
            let by_gas = if slopes {
                rise(begin, hot + VARIED)
            } else {
                0.0
            };
            [at, rise(begin + VARIED, hot), by_gas]
        }));
    }
}

/// The equations of a particle ([`SolidChemistry::follow`]).
pub(super) struct ParticleSystem<'a> {
    pub chemistry: &'a SolidChemistry,
    pub start: &'a ParticleStart<'a>,
    /// In mol.
    pub trace: f64,
    /// How fast interfaces are at most ([`RateState`]).
    pub fastest: f64,
    /// Amounts in mol below which nothing is missing.
    pub round_off: f64,
    /// What an amount may be below zero, in mol.
    pub tolerance: f64,
    /// In J/K.
    pub least_capacity: f64,
    pub guess: AttemptGuess,
    pub buffers: &'a mut Buffers,
}

/// What the temperature of a particle follows from.
struct ParticleHeat {
    /// Heat capacity in J/K and its change with temperature.
    capacity: [f64; 2],
    /// Change with temperature of the heat of reaction in W, at fixed rates.
    released: f64,
    /// What passes of a difference of temperatures, in W/K: h A but for what exchanged gases do to it.
    conductance: f64,
    /// Change with the radius over that at the start of what comes from outside, in W.
    widened: f64,
}

impl ParticleSystem<'_> {
    /// Heat capacity in J/K.
    fn capacity(&self, temperature: f64) -> f64 {
        let amounts = &self.buffers.amounts;
        let all = self.chemistry.heat_capacity(amounts, temperature);
        all.max(self.least_capacity)
    }

    /// Heat capacity in J/K and its change with temperature; the molar ones stay in the buffer.
    fn capacity_with_slopes(&mut self, temperature: f64) -> [f64; 2] {
        let mut all = [0.0; 2];
        // The molar ones are those of the slopes, which the least capacity does not have.
        let solids = self.chemistry.solids.iter().zip(&self.buffers.amounts);
        for ((solid, n), molar) in solids.zip(&mut self.buffers.molar) {
            let mass = solid.molar_mass();
            *molar = [
                mass * solid.heat_capacity(temperature),
                mass * solid.heat_capacity_slope(temperature),
            ];
            all[0] += n * molar[0];
            all[1] += n * molar[1];
        }
        if all[0] > self.least_capacity {
            all
        } else {
            self.buffers.molar.fill([0.0; 2]);
            [self.least_capacity, 0.0]
        }
    }

    /// The radius over that at the start.
    fn shrinkage(&self) -> f64 {
        let around = &self.start.around;
        let radius = around.size.radius_of(&self.buffers.amounts, around.radius);
        around.shrinkage(radius).unwrap_or(1.0)
    }

    /// Takes up the unknowns; their temperature in K.
    fn place(&mut self, y: &[f64]) -> f64 {
        for (&s, n) in self.chemistry.moving().iter().zip(y) {
            self.buffers.amounts[s] = *n;
        }
        let temperature = y[self.chemistry.moving().len()];
        // Water that boils may cool a particle by a hundred kelvin within a window: its heat is no line.
        if let Some(j) = self.chemistry.drying() {
            let hot = self.start.around.temperature;
            let slope = self.chemistry.warmth_slope(j, temperature);
            let at = self.chemistry.warmth(j, temperature, hot);
            let warmth = &mut self.buffers.warmth[j];
            warmth[0] = at - slope * (temperature - self.start.temperature);
            warmth[1] = slope;
        }
        if let Some(bound) = self.chemistry.bound() {
            let Buffers {
                amounts,
                bound: heats,
                ..
            } = &mut *self.buffers;
            bound.heats(amounts, &self.chemistry.solids, heats);
        }
        temperature
    }

    /// What follows from the rates with a heat capacity in J/K and its slope: changes of amounts, of temperature, of extents.
    fn fill(&self, temperature: f64, capacity: [f64; 2], out: &mut [f64]) -> ParticleHeat {
        let moving = self.chemistry.moving().len();
        out.fill(0.0);
        let mut released = [0.0; 2];
        for (j, (rate, warmth)) in self
            .buffers
            .rates
            .iter()
            .zip(&self.buffers.warmth)
            .enumerate()
        {
            for &(k, n) in self.chemistry.effects(j) {
                out[k] += n * rate;
            }
            let bound = self.bound_heat(j);
            released[0] +=
                rate * (warmth[0] + warmth[1] * (temperature - self.start.temperature) + bound);
            released[1] += rate * warmth[1];
            out[moving + 1 + j] = *rate;
        }
        // The film conducts in proportion to the radius, contacts and radiation act on the surface.
        let shrinkage = self.shrinkage();
        let (conductance, wider) = self.film_conductance(shrinkage);
        let difference = self.difference(temperature);
        let taken = conductance * difference + shrinkage * shrinkage * self.start.heat;
        out[moving] = (taken + released[0]) / capacity[0];
        ParticleHeat {
            capacity,
            released: released[1],
            conductance,
            widened: wider * difference + 2.0 * shrinkage * self.start.heat,
        }
    }

    /// Heat in J/mol of a reaction by what binds water at the amounts at hand.
    fn bound_heat(&self, reaction: usize) -> f64 {
        let heats = self.buffers.bound.get(reaction);
        heats.map_or(0.0, |one| one[0])
    }

    /// Change with the amount of a solid of the heat in W that reactions set free by what binds water, at fixed rates.
    fn bound_slope(&self, solid: usize) -> f64 {
        let Some(bound) = self.chemistry.bound() else {
            return 0.0;
        };
        let part = bound.part(solid);
        let pairs = self.buffers.rates.iter().zip(&self.buffers.bound);
        let sum: f64 = pairs.map(|(rate, heat)| rate * heat[part]).sum();
        sum * self.chemistry.solids[solid].molar_mass()
    }

    /// What the film of a particle so much smaller than at the start conducts in W/K at the rates at hand, and its slope.
    fn film_conductance(&self, shrinkage: f64) -> (f64, f64) {
        let (own, rates) = (self.start.conductance, &self.buffers.rates);
        self.buffers.film_heat.conductance(own, shrinkage, rates)
    }

    /// How much warmer the gas is, in K.
    fn difference(&self, temperature: f64) -> f64 {
        self.start.around.temperature - temperature
    }

    /// Rates at the amounts at hand, with the net flow through the film that they make.
    fn find_rates(&mut self, temperature: f64) {
        let (chemistry, around) = (self.chemistry, &self.start.around);
        let state = RateState {
            amounts: &self.buffers.amounts,
            fractions: around.fractions,
            temperature,
            film_flow: FilmFlow::still(),
            first: self.start.first,
            trace: self.trace,
            fastest: self.fastest,
            known: None,
        };
        if chemistry.makes_film_flow(around) {
            let (film, rates) = (&mut self.buffers.film, &mut self.buffers.rates);
            film.solve(chemistry, around, &state, rates);
        } else {
            let (surface, rates) = (&mut self.buffers.surface, &mut self.buffers.rates);
            chemistry.rates(around, &state, surface, rates);
        }
    }
}

impl StiffSystem for ParticleSystem<'_> {
    fn unknowns(&self) -> usize {
        self.chemistry.moving().len() + 1
    }

    fn integrals(&self) -> usize {
        self.chemistry.reactions.len()
    }

    fn parameters(&self) -> usize {
        self.chemistry.directions().len() + 1
    }

    /// What a cell gives of a particle's rate follows from it: of each attempt.
    fn direct(&self) -> bool {
        true
    }

    fn follows_tangent(&self) -> bool {
        self.guess.slopes
    }

    fn rates(&mut self, y: &[f64], out: &mut [f64]) {
        let temperature = self.place(y);
        self.find_rates(temperature);
        self.fill(temperature, [self.capacity(temperature), 0.0], out);
    }

    fn differentiate(&mut self, y: &[f64], out: &mut [f64], derivatives: &mut SystemDerivatives) {
        let chemistry = self.chemistry;
        let n = y.len();
        let (temperature, place_of_temperature) = (self.place(y), n - 1);
        let directions = n + chemistry.directions().len();
        if chemistry.makes_film_flow(&self.start.around) {
            self.find_rates(temperature);
        }
        let (shrinkage, difference) = (self.shrinkage(), self.difference(temperature));
        for first in (0..directions).step_by(WIDTH) {
            let last = (first + WIDTH).min(directions);
            self.differentiate_by(first..last, temperature);
            if first == 0 {
                let values = self.buffers.rates_dual.iter().map(|one| one.value);
                self.buffers.rates.clear();
                self.buffers.rates.extend(values);
            }
            for (j, rate) in self.buffers.rates_dual.iter().enumerate() {
                let warmth = self.buffers.warmth[j];
                let own = self.start.conductance;
                let film = &self.buffers.film_heat;
                let heat = warmth[0]
                    + warmth[1] * (temperature - self.start.temperature)
                    + self.bound_heat(j)
                    + difference * film.slope(own, shrinkage, &self.buffers.rates, j);
                for (direction, slope) in (first..last).zip(rate.slope) {
                    if direction < n {
                        for &(k, moles) in chemistry.effects(j) {
                            derivatives.jacobian[k * n + direction] += moles * slope;
                        }
                        derivatives.jacobian[place_of_temperature * n + direction] += heat * slope;
                        derivatives.integrals[j * n + direction] = slope;
                    } else {
                        let column = &mut derivatives.parameters[(direction - n) * out.len()..];
                        for &(k, moles) in chemistry.effects(j) {
                            column[k] += moles * slope;
                        }
                        column[place_of_temperature] += heat * slope;
                        column[n + j] = slope;
                    }
                }
            }
        }
        let capacity = self.capacity_with_slopes(temperature);
        let heat = self.fill(temperature, capacity, out);
        // C dT/dτ = …: the row of the temperature holds the slopes of its right side so far.
        let rise = out[place_of_temperature];
        let widening = &self.buffers.shrinkage_slopes;
        let row = &mut derivatives.jacobian[place_of_temperature * n..];
        for (k, &s) in chemistry.moving().iter().enumerate() {
            row[k] +=
                widening[k] * heat.widened - rise * self.buffers.molar[s][0] + self.bound_slope(s);
        }
        row[place_of_temperature] += heat.released - heat.conductance - rise * heat.capacity[1];
        row.iter_mut().for_each(|slope| *slope /= heat.capacity[0]);
        for column in derivatives.parameters.chunks_exact_mut(out.len()) {
            column[place_of_temperature] /= heat.capacity[0];
        }
        let heats = self.buffers.rates.iter().zip(&self.buffers.warmth);
        let brought: f64 = heats.map(|(rate, warmth)| rate * warmth[2]).sum();
        let column = &mut derivatives.parameters[chemistry.directions().len() * out.len()..];
        column[place_of_temperature] = (heat.conductance + brought) / heat.capacity[0];
    }

    /// Where a solid begins to be made, what uses it again begins within one trace of it: a step from there linearises with
    /// the slope of that beginning, which its stages and their errors do not leave.
    fn first_step(&self, y: &[f64], rates: &[f64]) -> f64 {
        let moving = self.chemistry.moving().len();
        let made = y.iter().zip(rates).take(moving);
        let beginning = made.filter(|(n, rate)| **n < self.trace && **rate > 0.0);
        beginning.fold(self.guess.first_step, |least, (_, rate)| {
            least.min(self.trace / rate)
        })
    }

    fn admissible(&self, from: &[f64], to: &[f64]) -> f64 {
        let amounts = from.iter().zip(to).take(self.chemistry.moving().len());
        amounts.fold(1.0, |least: f64, (from, to)| {
            if *to < -self.tolerance {
                least.min((from / (from - to)).max(0.0))
            } else {
                least
            }
        })
    }

    /// Takes back what reactions used of a solid beyond what was there, by their shares in all that was used of it.
    fn correct(&mut self, y: &mut [f64], extents: &mut [f64], tangent: &mut [f64]) {
        let chemistry = self.chemistry;
        let (moving, count) = (chemistry.moving().len(), chemistry.reactions.len());
        let width = y.len() + extents.len();
        // What one solid gets back another may lack: the rounds end where only round-off is missing.
        let round_off = -self.round_off;
        for _ in 0..MOST_ROUNDS {
            let uses_of = |solid: usize, j: usize, extent: f64| {
                let effects = chemistry.effects(j).iter();
                let moles: f64 = effects.filter(|one| one.0 == solid).map(|one| one.1).sum();
                (moles, (-moles * extent).max(0.0))
            };
            let mut lacking: Option<(usize, f64)> = None;
            for solid in (0..moving).filter(|&k| y[k] < round_off) {
                let used: f64 = (0..count).map(|j| uses_of(solid, j, extents[j]).1).sum();
                if used > 0.0 && lacking.is_none_or(|(worst, _)| y[solid] < y[worst]) {
                    lacking = Some((solid, used));
                }
            }
            let Some((solid, used)) = lacking else {
                break;
            };
            let uses = |j: usize, extent: f64| uses_of(solid, j, extent);
            for (j, extent) in extents.iter_mut().enumerate().take(count) {
                let (moles, own) = uses(j, *extent);
                if own == 0.0 {
                    continue;
                }
                // What a unit of the lack takes back of this reaction.
                let share = own / (used * moles);
                let give_back = |lack: f64, amounts: &mut [f64], extent: usize| {
                    amounts[extent] -= share * lack;
                    for &(k, n) in chemistry.effects(j).iter().filter(|one| one.0 != solid) {
                        amounts[k] -= n * share * lack;
                    }
                };
                for column in tangent.chunks_exact_mut(width) {
                    give_back(column[solid], column, moving + 1 + j);
                }
                let lack = y[solid];
                *extent -= share * lack;
                for &(k, n) in chemistry.effects(j).iter().filter(|one| one.0 != solid) {
                    y[k] -= n * share * lack;
                }
            }
            y[solid] = 0.0;
            for column in tangent.chunks_exact_mut(width) {
                column[solid] = 0.0;
            }
        }
        for value in y[..moving]
            .iter_mut()
            .filter(|n| **n < 0.0 && **n >= round_off)
        {
            *value = 0.0;
        }
    }
}

impl ParticleSystem<'_> {
    /// Rates with their derivatives in a range of the directions: amounts, temperature, gases.
    fn differentiate_by(&mut self, directions: std::ops::Range<usize>, temperature: f64) {
        let chemistry = self.chemistry;
        let (moving, first) = (chemistry.moving().len(), directions.start);
        let buffers = &mut *self.buffers;
        let zero = [0.0; WIDTH];
        for (dual, value) in buffers.amounts_dual.iter_mut().zip(&buffers.amounts) {
            *dual = Slopes {
                value: *value,
                slope: zero,
            };
        }
        let fractions = self.start.around.fractions;
        for (dual, value) in buffers.fractions_dual.iter_mut().zip(fractions) {
            *dual = Slopes {
                value: *value,
                slope: zero,
            };
        }
        let mut warm = Slopes {
            value: temperature,
            slope: zero,
        };
        for direction in directions {
            let lane = direction - first;
            if direction < moving {
                let solid = chemistry.moving()[direction];
                buffers.amounts_dual[solid].slope[lane] = 1.0;
            } else if direction == moving {
                warm.slope[lane] = 1.0;
            } else {
                let (key, product) = chemistry.directions()[direction - moving - 1];
                buffers.fractions_dual[key].slope[lane] = 1.0;
                if let Some(product) = product {
                    buffers.fractions_dual[product].slope[lane] = -1.0;
                }
            }
        }
        let state = RateState {
            amounts: &buffers.amounts_dual,
            fractions: &buffers.fractions_dual,
            temperature: warm,
            film_flow: buffers.film.point(),
            first: self.start.first,
            trace: self.trace,
            fastest: self.fastest,
            known: None,
        };
        let around = &self.start.around;
        let surface = &mut buffers.surface_dual;
        match chemistry.makes_film_flow(&self.start.around) {
            true => surface.begin_with(buffers.film.surface()),
            false => surface.begin_with(&buffers.surface),
        }
        chemistry.rates(around, &state, surface, &mut buffers.rates_dual);
        if chemistry.makes_film_flow(around) {
            let rates = &mut buffers.rates_dual;
            let residual = film_balance::residual(chemistry, around, &state, rates);
            buffers.film.follow(residual, rates);
        }
        let radius = around.size.radius_of(state.amounts, around.radius);
        if let Some(shrinkage) = around.shrinkage(radius) {
            let slopes = buffers.shrinkage_slopes.iter_mut().skip(first);
            for (slope, lane) in slopes.zip(shrinkage.slope) {
                *slope = lane;
            }
        }
    }
}
