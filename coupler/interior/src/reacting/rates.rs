//! Rates of a particle's reactions, with or without derivatives.

use calcine_numerics::Number;
use calcine_physics::gas::GAS_CONSTANT;
use calcine_physics::reaction::equilibrium::STANDARD_PRESSURE;
use calcine_physics::reaction::shrinking_core::{self, Interface, MOST_INTERFACES};
use calcine_physics::reaction::{Equilibrium, PowerLaw, power_law};
use calcine_physics::sphere;

use super::chemistry::SolidChemistry;
use super::layers::{GasPath, Layers};
use super::passage::{FilmFlow, FilmPassage, ParticleSurroundings};
use super::reaction::{LayerDiffusivity, Rate, Reaction};

/// A trace: the share of a particle's solids at the start of a window below which the rate of what uses a solid goes to
/// zero with what is left of it. With x the amount in traces, the factor is
///
/// - of a rate that does not follow the amount, x (2 − x): its slope has no jump at x = 1 and is steep at x = 0;
/// - of a power law of order m < 1 in that solid, x ((2 − m) + (m − 1) x) times the law at one trace, with the law's own slope at
///   x = 1; orders of one and more end by themselves;
/// - of a shrinking core, x (2 − x) of its rate constant, with the radius of the interface no smaller than that of a core of one trace.
///
/// So rates end where nothing is left, and have a slope there by which an implicit step finds that end.
pub const TRACE: f64 = 1e-6;

/// What the rates of a particle depend on within a window.
#[derive(Clone, Copy, Debug)]
pub struct RateState<'a, N> {
    /// Amounts of all solids in mol.
    pub amounts: &'a [N],
    /// Mole fractions of the gas.
    pub fractions: &'a [N],
    /// Temperature of the particle in K.
    pub temperature: N,
    /// The net flow through its film.
    pub film_flow: FilmFlow<N>,
    /// The amount in mol that is a trace ([`TRACE`]).
    pub trace: f64,
    /// How much faster than film and a layer of the particle's size (β + D/R) an interface is at most: a resistance of this
    /// share of theirs is in series with its own. So amounts of what fast reactions use as it is made stay within what digits resolve.
    pub fastest: f64,
}

impl<N: Number> RateState<'_, N> {
    /// The factor of what uses a solid by an order below one ([`TRACE`]).
    fn presence(&self, solid: usize, order: f64) -> N {
        let amount = self.amounts[solid];
        let x = amount.value() / self.trace;
        if x >= 1.0 {
            N::constant(1.0)
        } else {
            // An amount that round-off left below zero has the slope at zero: without it no implicit step would see that
            // what is made of the solid is used again.
            let (x, steep, bend) = (x.max(0.0), 2.0 - order, order - 1.0);
            amount.through(
                x * (steep + bend * x),
                (steep + 2.0 * bend * x) / self.trace,
            )
        }
    }

    /// An amount in mol, at least a trace.
    fn at_least_a_trace(&self, solid: usize) -> N {
        let amount = self.amounts[solid];
        if amount.value() > self.trace {
            amount
        } else {
            N::constant(self.trace)
        }
    }
}

impl SolidChemistry {
    /// Rates of all reactions of a particle in mol/s.
    pub fn rates<N: Number>(
        &self,
        around: &ParticleSurroundings<'_>,
        state: &RateState<'_, N>,
        out: &mut [N],
    ) {
        out.fill(N::constant(0.0));
        let radius = around.size.radius_of(state.amounts, around.radius);
        let all_gas = state
            .temperature
            .inverse()
            .times(around.pressure / GAS_CONSTANT);
        for (index, reaction) in self.reactions.iter().enumerate() {
            if let Rate::Power(law) = &reaction.rate {
                let key = self.key(index);
                out[index] = power(reaction, (law, key), around, state, (radius, all_gas));
            }
        }
        for layers in self.layers() {
            self.core(layers, around, state, (radius, all_gas), out);
        }
    }

    fn core<N: Number>(
        &self,
        layers: &Layers,
        around: &ParticleSurroundings<'_>,
        state: &RateState<'_, N>,
        (radius, all_gas): (N, N),
        out: &mut [N],
    ) {
        let count = layers.solids.len() - 1;
        let volumes = around.size.volumes();
        let weighed = |k: usize| {
            let solid = layers.solids[k];
            let room = volumes.map_or(layers.weights[k], |each| each[solid]);
            state.amounts[solid].positive().times(room)
        };
        let sum = |sum: N, k: usize| sum + weighed(k);
        let all = (0..=count).fold(N::constant(0.0), sum);
        if all.value() <= 0.0 {
            return;
        }
        let mut places = [N::constant(0.0); MOST_INTERFACES];
        let mut within = N::constant(0.0);
        // Thicknesses of layers times all volumes, without differences: those of thin ones have no digits.
        let mut layers_of = [N::constant(0.0); MOST_INTERFACES];
        for (k, place) in places.iter_mut().enumerate().take(count) {
            layers_of[k] = weighed(k + 1) / all;
            within = within + weighed(k);
            let share = within / all;
            *place = if share.value() >= 1.0 {
                N::constant(1.0)
            } else if share.value() > TRACE {
                share.cbrt()
            } else {
                N::constant(TRACE.cbrt())
            };
        }
        // Layers of one case mostly follow temperature alike.
        let mut grown: Option<(&LayerDiffusivity, N)> = None;
        for path in &layers.paths {
            let mut interfaces = [Interface::<N>::none(); MOST_INTERFACES];
            let FilmPassage {
                coefficient: film,
                gain,
            } = around.passage(path.key, radius, state.temperature, state.film_flow);
            let bulk = all_gas * gain * state.fractions[path.key];
            for (k, interface) in interfaces.iter_mut().enumerate().take(count) {
                let (inner, outer) = (places[k], places.get(k + 1).copied());
                let outer = outer.filter(|_| k + 1 < count).unwrap_or(N::constant(1.0));
                interface.radius = inner;
                interface.thickness =
                    layers_of[k] / (inner * inner + inner * outer + outer * outer);
                let diffusivity = &path.diffusivity[k];
                let growth = match grown {
                    Some((like, growth)) if diffusivity.grows_like(like) => growth,
                    _ => diffusivity.growth(state.temperature),
                };
                grown = Some((diffusivity, growth));
                interface.diffusivity = growth.times(diffusivity.value);
                if let Some(index) = path.reactions[k] {
                    let solids = [layers.solids[k], layers.solids[k + 1]];
                    let passed = interface.diffusivity.times(1.0 / around.radius) + film;
                    (interface.rate_constant, interface.equilibrium) = interface_of(
                        &self.reactions[index],
                        (path, passed.times(state.fastest)),
                        solids,
                        around,
                        state,
                        (bulk, gain, all_gas),
                    );
                }
            }
            let mut flows = [N::constant(0.0); MOST_INTERFACES];
            let known = &interfaces[..count];
            shrinking_core::flows(radius, film, bulk, known, &mut flows);
            for (flow, index) in flows.iter().zip(&path.reactions) {
                if let Some(index) = *index {
                    out[index] = flow.times(-1.0 / moles(&self.reactions[index], path.key));
                }
            }
        }
    }
}

/// Rate constant of an interface, both directions together, and the concentration at which it rests; between two solids,
/// the inner one first.
fn interface_of<N: Number>(
    reaction: &Reaction,
    (path, fastest): (&GasPath, N),
    [inner, outer]: [usize; 2],
    around: &ParticleSurroundings<'_>,
    state: &RateState<'_, N>,
    (bulk, gain, all_gas): (N, N, N),
) -> (N, N) {
    let Rate::Core { rate_constant, .. } = &reaction.rate else {
        return (N::constant(0.0), N::constant(0.0));
    };
    let moles = moles(reaction, path.key);
    let back = reaction.equilibrium.inverse(state.temperature);
    // K is that of the equation as it is written; the ratio of its two gases at rest is that of one mole of them.
    let back = match path.product {
        Some(_) if moles != -1.0 && back.value() > 0.0 => back.ln().times(-1.0 / moles).exp(),
        _ => back,
    };
    let forward = rate_constant.of(state.temperature);
    let turnover = match path.product {
        Some(_) => forward * (N::constant(1.0) + back),
        None => forward,
    };
    let forward = forward / (N::constant(1.0) + turnover / fastest);
    // Forwards it goes as far as its solid is there, backwards as far as its layer is.
    let (own, layer) = (
        barely_there(state.presence(inner, 0.0)),
        barely_there(state.presence(outer, 0.0)),
    );
    if let Some(product) = path.product {
        // k (s c − s' c'/K) with c + c' the same everywhere
        let both = bulk + all_gas * gain * state.fractions[product];
        let returning = layer * back;
        let together = own + returning;
        let at_rest = if together.value() > 0.0 {
            both * returning / together
        } else {
            N::constant(0.0)
        };
        return (forward * together, at_rest);
    }
    let at_rest = if back.value() > 0.0 {
        let power = back.ln().times(-1.0 / moles).exp();
        all_gas.times(STANDARD_PRESSURE / around.pressure) * power
    } else {
        N::constant(0.0)
    };
    let forwards = (bulk.value() - at_rest.value()) * moles <= 0.0;
    (forward * if forwards { own } else { layer }, at_rest)
}

/// Least factor of an interface's rates ([`TRACE`]).
const LEAST: f64 = 1e-20;

/// A factor that does not vanish, with its slope: an interface between two solids of which nothing is there would
/// have no slopes, and what another makes of one of them would not be seen to react on. Rates of this
/// size are below round-off, however fast the interface.
fn barely_there<N: Number>(presence: N) -> N {
    presence + N::constant((LEAST - presence.value()).max(0.0))
}

/// Rate of a reaction in the whole volume of a particle in mol/s.
fn power<N: Number>(
    reaction: &Reaction,
    (law, key): (&PowerLaw, Option<usize>),
    around: &ParticleSurroundings<'_>,
    state: &RateState<'_, N>,
    (radius, all_gas): (N, N),
) -> N {
    let zero = N::constant(0.0);
    let order_in = |s: usize| {
        let found = law.solids.iter().find(|one| one.0 == s);
        found.map_or(0.0, |one| one.1)
    };
    let ends = |s: usize| {
        let used = reaction.solids.iter().any(|one| one.0 == s && one.1 < 0.0);
        used && order_in(s) < 1.0
    };
    let area = sphere::surface_of(radius);
    let volume = (area * radius).times(1.0 / 3.0);
    let solid = |s: usize| {
        if ends(s) {
            state.at_least_a_trace(s) / volume
        } else {
            state.amounts[s].positive() / volume
        }
    };
    let used = reaction.solids.iter().filter(|one| ends(one.0));
    let left = used.fold(N::constant(1.0), |left, one| {
        left * state.presence(one.0, order_in(one.0))
    });
    let gas = |g: usize| all_gas * state.fractions[g];
    let (rest, order) = law.without(key, state.temperature, solid, gas);
    let rest = left * volume * rest;
    let back = quotient(reaction, around, state) * reaction.equilibrium.inverse(state.temperature);
    let distance = N::constant(1.0) - back;
    let Some(key) = key else {
        return rest * distance;
    };
    let moles = moles_of(reaction, key).unwrap_or(0.0);
    let rate = if moles > 0.0 {
        rest * power_law::power(gas(key), order) * distance
    } else if order == 0.0 && state.fractions[key].value() <= 0.0 {
        zero
    } else {
        let passage = around.passage(key, radius, state.temperature, state.film_flow);
        let film = (area * passage.coefficient).times(-1.0 / moles);
        let bulk = gas(key) * passage.gain;
        let surface = power_law::at_surface(bulk, film, rest, order);
        let forward = if order == 0.0 && surface.value() <= 0.0 {
            film * bulk
        } else {
            rest * power_law::power(surface, order)
        };
        forward * distance
    };
    if rate.value() >= 0.0 {
        rate
    } else {
        // Backwards a reaction goes as far as its products are there.
        let made = reaction.solids.iter().filter(|one| one.1 > 0.0);
        made.fold(rate, |rate, one| rate * state.presence(one.0, 0.0))
    }
}

/// Π (p_i/p°)^ν of a reaction's gases.
fn quotient<N: Number>(
    reaction: &Reaction,
    around: &ParticleSurroundings<'_>,
    state: &RateState<'_, N>,
) -> N {
    if reaction.equilibrium == Equilibrium::OneWay {
        return N::constant(0.0);
    }
    let mut product = N::constant(1.0);
    for &(g, n) in &reaction.gases {
        let over = state.fractions[g].times(around.pressure / STANDARD_PRESSURE);
        // Of a gas that is used up and not there, nothing reacts forwards either.
        if over.value() <= 0.0 {
            return N::constant(0.0);
        }
        product = product * power_law::power(over, n);
    }
    product
}

/// Moles of a gas that a mole of a reaction makes.
fn moles_of(reaction: &Reaction, gas: usize) -> Option<f64> {
    let found = reaction.gases.iter().find(|one| one.0 == gas);
    found.map(|one| one.1)
}

fn moles(reaction: &Reaction, gas: usize) -> f64 {
    moles_of(reaction, gas).unwrap_or(-1.0)
}
