//! Rates of a particle's reactions, with or without derivatives.

use calcine_numerics::Number;
use calcine_physics::gas::GAS_CONSTANT;
use calcine_physics::reaction::equilibrium::STANDARD_PRESSURE;
use calcine_physics::reaction::shrinking_core::{self, Interface, MOST_INTERFACES};
use calcine_physics::reaction::{Devolatilisation, PowerLaw, power_law};
use calcine_physics::sphere;

use super::chemistry::SolidChemistry;
use super::layers::{GasPath, Layers};
use super::passage::{FilmFlow, FilmPassage, ParticleSurroundings};
use super::reaction::{LayerDiffusivity, Rate, Reaction};
use super::surface::SurfaceBalance;

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
    /// Amounts in mol with which the particle came, of which shares are left.
    pub first: &'a [f64],
    /// The amount in mol that is a trace ([`TRACE`]).
    pub trace: f64,
    /// How much faster than film and a layer of the particle's size (β + D/R) an interface is at most: a resistance of this
    /// share of theirs is in series with its own. So amounts of what fast reactions use as it is made stay within what digits resolve.
    pub fastest: f64,
    /// Of each reaction at a shrinking core its rate constant in m/s and 1/K where the temperature stays as it is; they are
    /// evaluated where nothing is given.
    pub known: Option<&'a [[f64; 2]]>,
}

/// Rate constant in m/s and 1/K of a reaction at a shrinking core; of others no rate constant.
pub(super) fn constants_of<N: Number>(reaction: &Reaction, temperature: N) -> [N; 2] {
    let Rate::Core { rate_constant, .. } = &reaction.rate else {
        return [N::constant(0.0); 2];
    };
    let back = reaction.equilibrium.inverse(temperature);
    [rate_constant.of(temperature), back]
}

impl<N: Number> RateState<'_, N> {
    /// [`constants_of`] a reaction at the temperature at hand.
    fn constants(&self, index: usize, reaction: &Reaction) -> [N; 2] {
        match self.known {
            Some(known) => known[index].map(N::constant),
            None => constants_of(reaction, self.temperature),
        }
    }

    /// The factor of what uses a solid by an order below one ([`TRACE`]).
    pub(super) fn presence(&self, solid: usize, order: f64) -> N {
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
    pub(super) fn rates<N: Number>(
        &self,
        around: &ParticleSurroundings<'_>,
        state: &RateState<'_, N>,
        surface: &mut SurfaceBalance<N>,
        out: &mut [N],
    ) {
        out.fill(N::constant(0.0));
        let radius = around.size.radius_of(state.amounts, around.radius);
        let all_gas = state
            .temperature
            .inverse()
            .times(around.pressure / GAS_CONSTANT);
        for (index, reaction) in self.reactions.iter().enumerate() {
            if self.shared().place(index).is_some() {
                continue;
            }
            match &reaction.rate {
                Rate::Power(law) => {
                    let key = self.key(index);
                    out[index] = power(reaction, (law, key), around, state, (radius, all_gas));
                }
                Rate::Evaporation(law) => {
                    out[index] = self.dry((reaction, law), around, state, (radius, all_gas));
                }
                Rate::Devolatilisation(law) => {
                    out[index] = devolatilise((reaction, law), state);
                }
                // Cores follow below; the rest is of particles with shells.
                Rate::Core { .. } | Rate::Conversion { .. } | Rate::Grains { .. } => {}
            }
        }
        for layers in self.layers() {
            // k (s c − s' c'/K) with c + c' the same everywhere
            let ends = |path: &GasPath, passage: &FilmPassage<N>| {
                let gas = |g: usize| all_gas * passage.gain * state.fractions[g];
                let bulk = gas(path.key);
                let both = path.product.map(|product| bulk + gas(product));
                (!self.is_shared(path)).then_some(LadderEnd { outer: bulk, both })
            };
            self.cores(layers, around, state, (radius, ends), |ladder| {
                let (path, end) = (ladder.path, &ladder.end);
                let mut flows = [N::constant(0.0); MOST_INTERFACES];
                let film = ladder.passage.coefficient;
                shrinking_core::flows(radius, film, end.outer, ladder.interfaces(), &mut flows);
                for (flow, index) in flows.iter().zip(&path.reactions) {
                    if let Some(index) = *index {
                        out[index] = flow.times(-1.0 / moles(&self.reactions[index], path.key));
                    }
                }
            });
        }
        self.shared_rates(around, state, (radius, all_gas), surface, out);
    }

    /// The ladders of those gases of a shrinking core of which the outer ends are told.
    pub(super) fn cores<N: Number>(
        &self,
        layers: &Layers,
        around: &ParticleSurroundings<'_>,
        state: &RateState<'_, N>,
        (radius, ends): (
            N,
            impl Fn(&GasPath, &FilmPassage<N>) -> Option<LadderEnd<N>>,
        ),
        mut each: impl FnMut(&CoreLadder<'_, N>),
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
            let passage = around.passage(path.key, radius, state.temperature, state.film_flow);
            let Some(end) = ends(path, &passage) else {
                continue;
            };
            let mut ladder = CoreLadder {
                path,
                passage,
                end,
                interfaces: [Interface::<N>::none(); MOST_INTERFACES],
                turns: [false; MOST_INTERFACES],
            };
            for (k, interface) in ladder.interfaces.iter_mut().enumerate().take(count) {
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
                    let passed =
                        interface.diffusivity.times(1.0 / around.radius) + passage.coefficient;
                    ladder.turns[k] = path.product.is_none()
                        && state.presence(solids[0], 0.0).value()
                            != state.presence(solids[1], 0.0).value();
                    (interface.rate_constant, interface.equilibrium) = interface_of(
                        (&self.reactions[index], index),
                        (path, passed.times(state.fastest)),
                        solids,
                        around,
                        state,
                        &ladder.end,
                    );
                }
            }
            each(&ladder);
        }
    }
}

/// What is known of the gas at the outer end of a ladder, in mol/m³.
pub(super) struct LadderEnd<N> {
    /// Of the key gas.
    pub outer: N,
    /// Of it and what diffuses back for it.
    pub both: Option<N>,
}

/// The resistances between a gas and the interfaces of a shrinking core.
pub(super) struct CoreLadder<'a, N> {
    pub path: &'a GasPath,
    pub passage: FilmPassage<N>,
    pub end: LadderEnd<N>,
    interfaces: [Interface<N>; MOST_INTERFACES],
    turns: [bool; MOST_INTERFACES],
}

impl<N: Number> CoreLadder<'_, N> {
    /// The interfaces, innermost first.
    pub fn interfaces(&self) -> &[Interface<N>] {
        &self.interfaces[..self.path.reactions.len()]
    }

    /// The concentration in mol/m³ at which an interface without a counterpart of its gas turns, where that makes a difference.
    pub fn turns_at(&self, place: usize) -> Option<f64> {
        self.turns[place].then(|| self.interfaces[place].equilibrium.value())
    }
}

/// Rate constant of an interface, both directions together, and the concentration at which it rests; between two solids,
/// the inner one first.
fn interface_of<N: Number>(
    (reaction, index): (&Reaction, usize),
    (path, fastest): (&GasPath, N),
    [inner, outer]: [usize; 2],
    around: &ParticleSurroundings<'_>,
    state: &RateState<'_, N>,
    end: &LadderEnd<N>,
) -> (N, N) {
    let Rate::Core { .. } = &reaction.rate else {
        return (N::constant(0.0), N::constant(0.0));
    };
    let moles = moles(reaction, path.key);
    let [forward, back] = state.constants(index, reaction);
    // K is that of the equation as it is written; the ratio of its two gases at rest is that of one mole of them.
    let back = match path.product {
        Some(_) if back.value() > 0.0 => of_one_mole(back, moles),
        _ => back,
    };
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
    if let Some(both) = end.both {
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
        let power = of_one_mole(back, moles);
        let all_gas = state
            .temperature
            .inverse()
            .times(around.pressure / GAS_CONSTANT);
        all_gas.times(STANDARD_PRESSURE / around.pressure) * power
    } else {
        N::constant(0.0)
    };
    let forwards = (end.outer.value() - at_rest.value()) * moles <= 0.0;
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

/// 1/K^(1/ν) of an equation in which a gas has so many moles ν, below zero where it is used.
fn of_one_mole<N: Number>(back: N, moles: f64) -> N {
    if moles == -1.0 {
        back
    } else if moles == 1.0 {
        back.inverse()
    } else {
        back.ln().times(-1.0 / moles).exp()
    }
}

/// Rate in mol/s of a reaction in the whole volume of a particle that no other shares a gas with: of its key gas alone.
fn power<N: Number>(
    reaction: &Reaction,
    (law, key): (&PowerLaw, Option<usize>),
    around: &ParticleSurroundings<'_>,
    state: &RateState<'_, N>,
    (radius, all_gas): (N, N),
) -> N {
    let rest = prefactor(reaction, law, state, radius);
    let Some(key) = key else {
        let distance = N::constant(1.0) - reaction.equilibrium.inverse(state.temperature);
        return held_back(reaction, state, rest * distance);
    };
    let moles = moles_of(reaction, key).unwrap_or(0.0);
    if moles > 0.0 {
        return rest;
    }
    let found = law.gases.iter().find(|one| one.0 == key);
    let order = found.map_or(0.0, |one| one.1);
    if order == 0.0 && state.fractions[key].value() <= 0.0 {
        return N::constant(0.0);
    }
    let passage = around.passage(key, radius, state.temperature, state.film_flow);
    let film = (sphere::surface_of(radius) * passage.coefficient).times(-1.0 / moles);
    let bulk = all_gas * state.fractions[key] * passage.gain;
    let surface = power_law::at_surface(bulk, film, rest, order);
    if order == 0.0 && surface.value() <= 0.0 {
        film * bulk
    } else {
        rest * power_law::power(surface, order)
    }
}

/// Rate in mol/s of a reaction by the share of its solid that is left.
pub(super) fn devolatilise<N: Number>(
    (reaction, law): (&Reaction, &Devolatilisation),
    state: &RateState<'_, N>,
) -> N {
    let used = reaction.solids.iter().find(|one| one.1 < 0.0);
    used.map_or(N::constant(0.0), |&(s, n)| {
        law.turnover(state.amounts[s], state.first[s], state.temperature)
            .times(-1.0 / n)
    })
}

/// Rate of a power law in a particle in mol/s, but for the factors of gases.
pub(super) fn prefactor<N: Number>(
    reaction: &Reaction,
    law: &PowerLaw,
    state: &RateState<'_, N>,
    radius: N,
) -> N {
    let order_in = |s: usize| {
        let found = law.solids.iter().find(|one| one.0 == s);
        found.map_or(0.0, |one| one.1)
    };
    let ends = |s: usize| {
        let used = reaction.solids.iter().any(|one| one.0 == s && one.1 < 0.0);
        used && order_in(s) < 1.0
    };
    let volume = (sphere::surface_of(radius) * radius).times(1.0 / 3.0);
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
    let of_gas = |_: usize| N::constant(1.0);
    left * volume * law.without(None, state.temperature, solid, of_gas).0
}

/// Backwards a reaction goes as far as its products are there.
fn held_back<N: Number>(reaction: &Reaction, state: &RateState<'_, N>, rate: N) -> N {
    if rate.value() >= 0.0 {
        rate
    } else {
        rate * products(reaction, state)
    }
}

/// How far the solids that a reaction makes are there.
pub(super) fn products<N: Number>(reaction: &Reaction, state: &RateState<'_, N>) -> N {
    let made = reaction.solids.iter().filter(|one| one.1 > 0.0);
    made.fold(N::constant(1.0), |all, one| {
        all * state.presence(one.0, 0.0)
    })
}

/// Moles of a gas that a mole of a reaction makes.
fn moles_of(reaction: &Reaction, gas: usize) -> Option<f64> {
    let found = reaction.gases.iter().find(|one| one.0 == gas);
    found.map(|one| one.1)
}

pub(super) fn moles(reaction: &Reaction, gas: usize) -> f64 {
    moles_of(reaction, gas).unwrap_or(-1.0)
}
