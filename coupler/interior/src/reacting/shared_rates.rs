//! Rates of the reactions of a particle that share the gas at its surface (docs/theory.md, RXN-3).

use calcine_numerics::Number;
use calcine_physics::reaction::equilibrium::STANDARD_PRESSURE;
use calcine_physics::reaction::shrinking_core::{self, Interface, MOST_INTERFACES};
use calcine_physics::reaction::{Equilibrium, PowerLaw, power_law};
use calcine_physics::sphere;

use super::chemistry::SolidChemistry;
use super::layers::GasPath;
use super::passage::{FilmPassage, ParticleSurroundings};
use super::rates::{CoreLadder, LadderEnd, RateState, devolatilise, moles, prefactor, products};
use super::reaction::{Rate, Reaction};
use super::shared_film::{SharedFilm, zeroth};
use super::surface::SurfaceBalance;

impl SolidChemistry {
    /// True where a gas in the layers of a shrinking core meets other reactions.
    pub(super) fn is_shared(&self, path: &GasPath) -> bool {
        let mut reactions = path.reactions.iter().flatten();
        reactions.any(|one| self.shared().place(*one).is_some())
    }

    /// Rates in mol/s of the reactions that share gases at the surface.
    pub(super) fn shared_rates<N: Number>(
        &self,
        around: &ParticleSurroundings<'_>,
        state: &RateState<'_, N>,
        (radius, all_gas): (N, N),
        surface: &mut SurfaceBalance<N>,
        out: &mut [N],
    ) {
        let shared = self.shared();
        if shared.reactions.is_empty() {
            return;
        }
        let area = sphere::surface_of(radius);
        let passage = |gas: usize| {
            let passed = around.passage(gas, radius, state.temperature, state.film_flow);
            (passed, all_gas * passed.gain * state.fractions[gas])
        };
        // Which way a core goes whose gas has no counterpart is known with the surface.
        for _ in 0..2 {
            surface.clear(shared.reactions.len());
            for &gas in &shared.gases {
                let (FilmPassage { coefficient, .. }, bulk) = passage(gas);
                let conductance = area * coefficient;
                surface.gas(conductance, conductance * bulk);
            }
            for (place, &index) in shared.reactions.iter().enumerate() {
                let reaction = &self.reactions[index];
                if let Rate::Power(law) = &reaction.rate {
                    let rest = prefactor(reaction, law, state, radius);
                    let over = all_gas.inverse().times(around.pressure / STANDARD_PRESSURE);
                    let back = reaction.equilibrium.inverse(state.temperature);
                    power_terms(shared, (place, reaction, law), rest, (over, back), surface);
                    if back.value() > 0.0 {
                        surface.returns(place, products(reaction, state));
                    }
                }
            }
            self.wet_terms(around, state, (radius, &passage), surface);
            for layers in self.layers() {
                let places = 0..shared.gases.len();
                let seen: Vec<_> = places.map(|place| surface.found(place)).collect();
                let ends = |path: &GasPath, _: &FilmPassage<N>| {
                    let place = shared.place_of(path.key);
                    let place = place.filter(|_| self.is_shared(path))?;
                    let outer = seen[place].map(N::constant);
                    Some(LadderEnd {
                        outer: outer.unwrap_or_else(|| passage(path.key).1),
                        both: path.product.map(|_| N::constant(1.0)),
                    })
                };
                self.cores(layers, around, state, (radius, ends), |ladder| {
                    let counter = ladder.path.product.map(|product| {
                        let (own, (other, beyond)) = (ladder.passage, passage(product));
                        let ratio = other.coefficient / own.coefficient;
                        let in_gas = all_gas * own.gain * state.fractions[product];
                        (product, ratio, in_gas - ratio * beyond)
                    });
                    self.core_terms(ladder, radius, counter, surface);
                });
            }
            surface.solve(&shared.moles, |place, rate| {
                out[shared.reactions[place]] = rate;
            });
            if !surface.has_turned() {
                break;
            }
        }
    }

    /// Terms of what dries a particle, and of what it sets free by itself.
    fn wet_terms<N: Number>(
        &self,
        around: &ParticleSurroundings<'_>,
        state: &RateState<'_, N>,
        (radius, passage): (N, &impl Fn(usize) -> (FilmPassage<N>, N)),
        surface: &mut SurfaceBalance<N>,
    ) {
        let shared = self.shared();
        for (place, &index) in shared.reactions.iter().enumerate() {
            let reaction = &self.reactions[index];
            match &reaction.rate {
                Rate::Devolatilisation(law) => {
                    surface.term(place, devolatilise((reaction, law), state), []);
                }
                Rate::Evaporation(law) => {
                    let own = reaction
                        .vapour_and_water()
                        .and_then(|(gas, _)| Some((gas, shared.place_of(gas)?)));
                    let Some((gas, vapour)) = own else {
                        continue;
                    };
                    let seen = surface.found(vapour);
                    let beside = seen.unwrap_or_else(|| passage(gas).1.value());
                    let exchange =
                        self.wet_exchange((reaction, law), around, state, (radius, beside));
                    if let Some(wet) = exchange {
                        surface.term(place, wet.free, []);
                        surface.term(place, -wet.back, [(vapour, 1.0)]);
                        if wet.turns {
                            surface.watch(vapour, wet.at_rest.value(), beside);
                        }
                    }
                }
                _ => {}
            }
        }
    }

    /// Terms of the reactions in the layers of a core, whose flows are linear in the concentrations at the surface. Of the gas that diffuses
    /// back for the key gas: its coefficient in the film over that of the key gas, and by how much both together are more in mol/m³ than the key
    /// gas and so many times that gas at the surface: mole for mole the pair passes by the film of the key gas.
    fn core_terms<N: Number>(
        &self,
        ladder: &CoreLadder<'_, N>,
        radius: N,
        counter: Option<(usize, N, N)>,
        surface: &mut SurfaceBalance<N>,
    ) {
        let (shared, path) = (self.shared(), ladder.path);
        let (zero, one) = (N::constant(0.0), N::constant(1.0));
        let Some(key) = shared.place_of(path.key) else {
            return;
        };
        let none = N::constant(f64::INFINITY);
        let mut at_rest = [zero; MOST_INTERFACES];
        shrinking_core::flows(radius, none, zero, ladder.interfaces(), &mut at_rest);
        let mut bare = [Interface::none(); MOST_INTERFACES];
        for (bare, interface) in bare.iter_mut().zip(ladder.interfaces()) {
            *bare = Interface {
                equilibrium: zero,
                ..*interface
            };
        }
        let mut of_key = [zero; MOST_INTERFACES];
        let count = path.reactions.len();
        shrinking_core::flows(radius, none, one, &bare[..count], &mut of_key);
        for (k, index) in path.reactions.iter().enumerate() {
            let Some((index, place)) = index.and_then(|index| Some((index, shared.place(index)?)))
            else {
                continue;
            };
            let by_mole = -1.0 / moles(&self.reactions[index], path.key);
            let (own, rest) = (of_key[k].times(by_mole), at_rest[k].times(by_mole));
            match counter {
                Some((product, ratio, more)) => {
                    surface.term(place, own + rest, [(key, 1.0)]);
                    if let Some(product) = shared.place_of(product) {
                        surface.term(place, rest * ratio, [(product, 1.0)]);
                    }
                    surface.term(place, rest * more, []);
                }
                None => {
                    surface.term(place, own, [(key, 1.0)]);
                    surface.term(place, rest, []);
                    if let Some(at_rest) = ladder.turns_at(k) {
                        surface.watch(key, at_rest, ladder.end.outer.value());
                    }
                }
            }
        }
    }
}

/// Forth and back of a power law in mol/s, by its rate but for gases and by p/p° of 1 mol/m³ and 1/K.
fn power_terms<N: Number>(
    shared: &SharedFilm,
    (place, reaction, law): (usize, &Reaction, &PowerLaw),
    rest: N,
    (over, back): (N, N),
    surface: &mut SurfaceBalance<N>,
) {
    let order = |gas: usize| {
        let found = law.gases.iter().find(|one| one.0 == gas);
        found.map_or(0.0, |one| one.1)
    };
    let gases = || shared.gases.iter().copied().enumerate();
    let forth = gases().filter_map(|(k, gas)| {
        let order = order(gas);
        (order != 0.0 || zeroth(reaction, gas)).then_some((k, order))
    });
    surface.term(place, rest, forth);
    if reaction.equilibrium == Equilibrium::OneWay {
        return;
    }
    let made = |gas: usize| {
        let own = reaction.gases.iter().filter(|one| one.0 == gas);
        own.map(|one| one.1).sum::<f64>()
    };
    let all: f64 = reaction.gases.iter().map(|one| one.1).sum();
    let returning = gases().filter_map(|(k, gas)| {
        let order = order(gas) + made(gas);
        (order != 0.0).then_some((k, order))
    });
    surface.term(
        place,
        -(rest * back * power_law::power(over, all)),
        returning,
    );
}
