//! The reactions of particles, and their rates at a state of one particle.

use std::f64::consts::PI;

use calcine_physics::gas::GAS_CONSTANT;
use calcine_physics::reaction::equilibrium::STANDARD_PRESSURE;
use calcine_physics::reaction::power_law;
use calcine_physics::reaction::shrinking_core::{self, Interface, MOST_INTERFACES};
use calcine_physics::reaction::{Arrhenius, Equilibrium, PowerLaw};
use calcine_physics::solids::SolidSpecies;
use calcine_physics::thermo::{Element, Mixture};

use super::layers::{LayerDiffusivity, Layers, LayersError, gases, layers};

/// Share of a particle's amount of solids below which what is left of one reacts the slower the less
/// there is: rates end where nothing is left, without a step that no integration could follow.
const TRACE: f64 = 1e-6;

/// A reaction of solids, and of gases where it is heterogeneous.
#[derive(Clone, Debug, PartialEq)]
pub struct Reaction {
    /// Its name.
    pub name: String,
    /// Each solid with the moles that one mole of the reaction makes (+) or uses up (−).
    pub solids: Vec<(usize, f64)>,
    /// The same of gases; empty for an inner reaction.
    pub gases: Vec<(usize, f64)>,
    /// By what law it goes.
    pub rate: Rate,
    /// How far it goes.
    pub equilibrium: Equilibrium,
}

/// Laws of rates.
#[derive(Clone, Debug, PartialEq)]
pub enum Rate {
    /// In the whole volume of a particle.
    Power(PowerLaw),
    /// At the surface of a core that shrinks.
    Core {
        /// k in m/s, of the forward reaction, per area of the interface.
        rate_constant: Arrhenius,
        /// Of the gas in the layer that the reaction leaves.
        diffusivity: LayerDiffusivity,
    },
}

/// Reactions with the solids and the gas that they are of.
#[derive(Clone, Debug)]
pub struct SolidChemistry {
    /// The solids.
    pub solids: Vec<SolidSpecies>,
    /// The gas; none for inner reactions alone.
    pub gas: Option<Mixture>,
    /// The reactions.
    pub reactions: Vec<Reaction>,
    /// Shrinking cores.
    layers: Vec<Layers>,
    /// The gas by whose amount each reaction's rate is linear, as far as it is.
    key: Vec<Option<usize>>,
    /// Heat of each reaction at 298.15 K in J/mol.
    pub heat: Vec<f64>,
}

/// The surroundings of one particle.
#[derive(Clone, Copy, Debug)]
pub struct ParticleSurroundings<'a> {
    /// Temperature of the gas in K.
    pub temperature: f64,
    /// Its pressure in Pa.
    pub pressure: f64,
    /// Mole fractions.
    pub fractions: &'a [f64],
    /// Mass transfer coefficient of each species in m/s.
    pub film: &'a [f64],
    /// Radius of the particle in m.
    pub radius: f64,
    /// Volumes in m³/mol that its solids take up; `None`: its diameter stays, and layers share the room by what
    /// they were made of.
    pub volumes: Option<&'a [f64]>,
}

/// Rates of all reactions of a particle in mol/s, and how each changes with the mole fraction of its
/// key gas.
#[derive(Clone, Debug, Default)]
pub struct Rates {
    /// mol/s.
    pub rate: Vec<f64>,
    /// mol/s by mole fraction.
    pub slope: Vec<f64>,
}

impl SolidChemistry {
    /// Reactions of these solids and this gas.
    pub fn new(
        solids: Vec<SolidSpecies>,
        gas: Option<Mixture>,
        reactions: Vec<Reaction>,
    ) -> Result<Self, LayersError> {
        let layers = layers(&reactions)?;
        let key = reactions.iter().map(|reaction| match &reaction.rate {
            Rate::Core { .. } => gases(reaction).map(|(key, _)| Some(key)),
            Rate::Power(law) => Ok(key_of(law, reaction)),
        });
        let key = key.collect::<Result<_, _>>()?;
        let mut made = Self {
            solids,
            gas,
            heat: Vec::new(),
            reactions,
            layers,
            key,
        };
        made.heat = made.reactions.iter().map(|one| made.heat_of(one)).collect();
        Ok(made)
    }

    /// The gas by whose amount a reaction's rate is taken as linear.
    pub fn key(&self, reaction: usize) -> Option<usize> {
        self.key[reaction]
    }

    /// Heat of a reaction at 298.15 K in J/mol, from the enthalpies of formation.
    pub fn heat_of(&self, reaction: &Reaction) -> f64 {
        let solids = reaction.solids.iter();
        let solids = solids.map(|&(s, n)| n * self.solids[s].formation_enthalpy());
        let gases = reaction.gases.iter().map(|&(g, n)| {
            self.gas.as_ref().map_or(0.0, |gas| {
                let one = &gas.species()[g];
                n * one.formation_enthalpy() * one.molar_mass()
            })
        });
        solids.chain(gases).sum()
    }

    /// Atoms of each element that a reaction makes of nothing, which is none.
    pub fn imbalance(&self, reaction: &Reaction) -> [f64; Element::COUNT] {
        let mut sum = [0.0; Element::COUNT];
        let mut add = |n: f64, atoms: &[f64; Element::COUNT]| {
            for (sum, atoms) in sum.iter_mut().zip(atoms) {
                *sum += n * atoms;
            }
        };
        for &(s, n) in &reaction.solids {
            add(n, self.solids[s].atoms());
        }
        if let Some(gas) = &self.gas {
            for &(g, n) in &reaction.gases {
                add(n, gas.species()[g].atoms());
            }
        }
        sum
    }

    /// Heat that a mole of a reaction brings a particle at one temperature in K, with what it takes of a gas
    /// at another, in J/mol.
    pub fn warmth(&self, reaction: usize, temperature: f64, gas_temperature: f64) -> f64 {
        let one = &self.reactions[reaction];
        let mut sensible = 0.0;
        for &(s, n) in &one.solids {
            let solid = &self.solids[s];
            sensible += n * solid.molar_mass() * solid.enthalpy(temperature);
        }
        if let Some(gas) = &self.gas {
            for &(g, n) in &one.gases {
                let at = if n < 0.0 {
                    gas_temperature
                } else {
                    temperature
                };
                let species = &gas.species()[g];
                sensible += n * species.molar_mass() * species.enthalpy(at);
            }
        }
        -self.heat[reaction] - sensible
    }

    /// Heat capacity of amounts of solids (mol) in J/K.
    pub fn heat_capacity(&self, amounts: &[f64], temperature: f64) -> f64 {
        let parts = self.solids.iter().zip(amounts);
        parts
            .filter(|(_, n)| **n != 0.0)
            .map(|(solid, n)| n * solid.molar_mass() * solid.heat_capacity(temperature))
            .sum()
    }

    /// Sensible enthalpy of amounts of solids (mol) in J.
    pub fn enthalpy(&self, amounts: &[f64], temperature: f64) -> f64 {
        let parts = self.solids.iter().zip(amounts);
        parts
            .filter(|(_, n)| **n != 0.0)
            .map(|(solid, n)| n * solid.molar_mass() * solid.enthalpy(temperature))
            .sum()
    }

    /// Temperature in K of a sensible enthalpy in J of these amounts; `guess` in K is near it. Newton's
    /// method, whose slope is piecewise linear, held between bounds.
    pub fn temperature(&self, amounts: &[f64], enthalpy: f64, guess: f64) -> f64 {
        let (mut low, mut high): (f64, f64) = (1.0, 2e4);
        let mut temperature = guess.clamp(2.0, 1e4);
        for _ in 0..100 {
            let off = self.enthalpy(amounts, temperature) - enthalpy;
            if off > 0.0 {
                high = temperature;
            } else {
                low = temperature;
            }
            let step = off / self.heat_capacity(amounts, temperature);
            let next = temperature - step;
            if step.abs() <= 4e-15 * temperature {
                return next;
            }
            temperature = if next > low && next < high {
                next
            } else {
                0.5 * (low + high)
            };
        }
        temperature
    }

    /// Rates at a particle's amounts (mol) and temperature in K.
    pub fn rates(
        &self,
        around: &ParticleSurroundings<'_>,
        amounts: &[f64],
        temperature: f64,
        out: &mut Rates,
    ) {
        let count = self.reactions.len();
        for list in [&mut out.rate, &mut out.slope] {
            list.clear();
            list.resize(count, 0.0);
        }
        let all: f64 = amounts.iter().map(|n| n.max(0.0)).sum();
        let there = Presence {
            amounts,
            trace: TRACE * all,
        };
        let all_gas = around.pressure / (GAS_CONSTANT * temperature);
        for (index, reaction) in self.reactions.iter().enumerate() {
            if let Rate::Power(law) = &reaction.rate {
                let state = (temperature, all_gas);
                (out.rate[index], out.slope[index]) =
                    self.power(index, reaction, law, around, &there, state);
            }
        }
        for layers in &self.layers {
            self.core(layers, around, &there, (temperature, all_gas), out);
        }
    }

    fn power(
        &self,
        index: usize,
        reaction: &Reaction,
        law: &PowerLaw,
        around: &ParticleSurroundings<'_>,
        there: &Presence<'_>,
        (temperature, all_gas): (f64, f64),
    ) -> (f64, f64) {
        let left = there.share(reaction, -1.0);
        let volume = 4.0 / 3.0 * PI * around.radius.powi(3);
        let solid = |s: usize| there.amounts[s].max(0.0) / volume;
        let gas = |g: usize| all_gas * around.fractions[g];
        let key = self.key[index];
        let (rest, order) = law.without(key, temperature, solid, gas);
        let rest = left * volume * rest;
        let back = self.quotient(reaction, around) * reaction.equilibrium.inverse(temperature);
        let Some(key) = key else {
            return (rest * (1.0 - back), 0.0);
        };
        let fraction = around.fractions[key];
        let moles = reaction.gases.iter().find(|gas| gas.0 == key);
        let moles = moles.map_or(0.0, |gas| gas.1);
        if moles > 0.0 {
            // The gas that is set free holds the reaction back.
            let held = if fraction > 0.0 { back / fraction } else { 0.0 };
            let full = rest * power_law::power(gas(key), order);
            return self.backward(there, reaction, full * (1.0 - back), -full * held);
        }
        if order == 0.0 && fraction <= 0.0 {
            return (0.0, 0.0);
        }
        let film = around.film[key] * 4.0 * PI * around.radius * around.radius / -moles;
        let surface = power_law::at_surface(gas(key), film, rest, order);
        let forward = if order == 0.0 && surface <= 0.0 {
            film * gas(key)
        } else {
            rest * power_law::power(surface, order)
        };
        let slope = if fraction > 0.0 {
            forward / fraction
        } else {
            0.0
        };
        self.backward(there, reaction, forward * (1.0 - back), slope)
    }

    /// Backwards a reaction goes as far as its products are there.
    fn backward(
        &self,
        there: &Presence<'_>,
        reaction: &Reaction,
        rate: f64,
        slope: f64,
    ) -> (f64, f64) {
        if rate >= 0.0 {
            return (rate, slope);
        }
        let left = there.share(reaction, 1.0);
        (left * rate, left * slope)
    }

    /// Π (p_i/p°)^ν of a reaction's gases.
    fn quotient(&self, reaction: &Reaction, around: &ParticleSurroundings<'_>) -> f64 {
        if reaction.equilibrium == Equilibrium::OneWay {
            return 0.0;
        }
        let of = |&(g, n): &(usize, f64)| {
            let over = around.fractions[g].max(0.0) * around.pressure / STANDARD_PRESSURE;
            over.powf(n)
        };
        let quotient: f64 = reaction.gases.iter().map(of).product();
        // Of a gas that is used up and not there, nothing reacts forwards either.
        if quotient.is_finite() { quotient } else { 0.0 }
    }

    fn core(
        &self,
        layers: &Layers,
        around: &ParticleSurroundings<'_>,
        there: &Presence<'_>,
        (temperature, all_gas): (f64, f64),
        out: &mut Rates,
    ) {
        let count = layers.solids.len() - 1;
        let mut radius = [0.0; MOST_INTERFACES];
        let weighed = |k: usize| {
            let solid = layers.solids[k];
            let room = around.volumes.map_or(layers.weights[k], |each| each[solid]);
            room * there.amounts[solid].max(0.0)
        };
        let all: f64 = (0..=count).map(weighed).sum();
        if all <= 0.0 {
            return;
        }
        let mut within = 0.0;
        for (k, radius) in radius.iter_mut().enumerate().take(count) {
            within += weighed(k);
            *radius = (within / all).min(1.0).cbrt();
        }
        for path in &layers.paths {
            let mut interfaces = [Interface::default(); MOST_INTERFACES];
            let bulk = all_gas * around.fractions[path.key];
            let both = bulk + path.product.map_or(0.0, |g| all_gas * around.fractions[g]);
            for (k, interface) in interfaces.iter_mut().enumerate().take(count) {
                interface.radius = radius[k];
                interface.diffusivity = path.diffusivity[k].at(temperature);
                let Some(index) = path.reactions[k] else {
                    continue;
                };
                let reaction = &self.reactions[index];
                let Rate::Core { rate_constant, .. } = &reaction.rate else {
                    continue;
                };
                let back = reaction.equilibrium.inverse(temperature);
                let forward = rate_constant.at(temperature);
                // Forwards it goes as far as its solid is there, backwards as far as its layer is.
                let (own, layer) = (there.of(layers.solids[k]), there.of(layers.solids[k + 1]));
                (interface.rate_constant, interface.equilibrium) = match path.product {
                    // k (s c − s' c'/K) with c + c' the same everywhere
                    Some(_) => {
                        let together = own + layer * back;
                        let at_rest = if together > 0.0 {
                            both * layer * back / together
                        } else {
                            0.0
                        };
                        (forward * together, at_rest)
                    }
                    None => {
                        let moles = moles(reaction, path.key);
                        let standard = STANDARD_PRESSURE / around.pressure * all_gas;
                        let power = (-1.0 / moles) * back.ln();
                        let at_rest = if back > 0.0 {
                            standard * power.exp()
                        } else {
                            0.0
                        };
                        let forwards = (bulk - at_rest) * moles <= 0.0;
                        (forward * if forwards { own } else { layer }, at_rest)
                    }
                };
            }
            take(
                path,
                &mut interfaces[..count],
                (bulk, all_gas),
                around,
                |index, one| {
                    let moles = moles(&self.reactions[index], path.key);
                    out.rate[index] = -one[0] / moles;
                    out.slope[index] = -one[1] / moles;
                },
            );
        }
    }

    /// Mass in kg of amounts of solids.
    pub fn mass(&self, amounts: &[f64]) -> f64 {
        let parts = self.solids.iter().zip(amounts);
        parts.map(|(solid, n)| solid.molar_mass() * n).sum()
    }
}

/// Flow of a gas into each interface in mol/s, and how it changes with the gas' mole fraction, told to `tell` with
/// the reaction there.
fn take(
    path: &super::layers::GasPath,
    interfaces: &mut [Interface],
    (bulk, all_gas): (f64, f64),
    around: &ParticleSurroundings<'_>,
    mut tell: impl FnMut(usize, [f64; 2]),
) {
    let count = interfaces.len();
    let (mut flow, mut slope) = ([0.0; MOST_INTERFACES], [0.0; MOST_INTERFACES]);
    let film = around.film[path.key];
    shrinking_core::flows(around.radius, film, bulk, interfaces, &mut flow[..count]);
    for interface in interfaces.iter_mut() {
        interface.equilibrium = 0.0;
    }
    shrinking_core::flows(
        around.radius,
        film,
        all_gas,
        interfaces,
        &mut slope[..count],
    );
    for (k, reaction) in path.reactions.iter().enumerate() {
        if let Some(index) = reaction {
            tell(*index, [flow[k], slope[k]]);
        }
    }
}

/// Moles of a gas that a mole of a reaction makes.
fn moles(reaction: &Reaction, gas: usize) -> f64 {
    let found = reaction.gases.iter().find(|one| one.0 == gas);
    found.map_or(-1.0, |one| one.1)
}

/// The gas by whose amount a power law's rate is taken as linear: the first that is used up, or else the
/// first that is set free.
fn key_of(law: &PowerLaw, reaction: &Reaction) -> Option<usize> {
    let used = reaction.gases.iter().filter(|gas| gas.1 < 0.0);
    let with_order = used
        .clone()
        .find(|gas| law.gases.iter().any(|one| one.0 == gas.0 && one.1 != 0.0));
    let found = with_order.or_else(|| reaction.gases.iter().find(|gas| gas.1 < 0.0));
    found.or_else(|| reaction.gases.first()).map(|gas| gas.0)
}

/// How much of what is there.
struct Presence<'a> {
    amounts: &'a [f64],
    trace: f64,
}

impl Presence<'_> {
    /// One as long as there is more than a trace of a solid.
    fn of(&self, solid: usize) -> f64 {
        let amount = self.amounts[solid];
        if amount >= self.trace {
            1.0
        } else {
            amount.max(0.0) / self.trace
        }
    }

    /// The least of all solids on the side of a reaction with this sign.
    fn share(&self, reaction: &Reaction, sign: f64) -> f64 {
        let side = reaction.solids.iter().filter(|(_, n)| n * sign > 0.0);
        side.map(|&(s, _)| self.of(s)).fold(1.0, f64::min)
    }
}
