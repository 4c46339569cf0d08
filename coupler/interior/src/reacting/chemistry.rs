//! The reactions of particles, and the thermodynamics of their solids.

use calcine_physics::film::StefanFlow;
use calcine_physics::reaction::PowerLaw;
use calcine_physics::solids::SolidSpecies;
use calcine_physics::thermo::{Element, Mixture};

use super::bound_water::BoundWater;
use super::layers::{Layers, LayersError, gases, layers};
use super::passage::ParticleSurroundings;
use super::reaction::{Rate, Reaction};
use super::shared_film::SharedFilm;

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
    /// Reactions that share the gas at the surface.
    shared: SharedFilm,
    /// The gas by whose amount each reaction's rate is linear, as far as it is.
    key: Vec<Option<usize>>,
    /// Heat of each reaction at 298.15 K in J/mol.
    pub heat: Vec<f64>,
    /// Solids that some reaction uses or makes, and what each reaction does to them by their place here.
    moving: Vec<usize>,
    effects: Vec<Vec<(usize, f64)>>,
    /// Changes of the gas by which rates have slopes, and that of each reaction.
    directions: Vec<(usize, Option<usize>)>,
    direction: Vec<Option<usize>>,
    /// True where reactions change the moles, and the mass, of the gas.
    makes_moles: bool,
    makes_mass: bool,
    /// The reaction that dries, and what binds water.
    drying: Option<usize>,
    bound: Option<BoundWater>,
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
            Rate::Evaporation(_) => Ok(reaction.gases.first().map(|gas| gas.0)),
            Rate::Devolatilisation(_) => Ok(reaction.gases.first().map(|gas| gas.0)),
            Rate::Conversion { .. } | Rate::Grains { .. } => Ok(None),
        });
        let key = key.collect::<Result<_, _>>()?;
        let mut made = Self {
            solids,
            gas,
            heat: Vec::new(),
            reactions,
            layers,
            shared: SharedFilm::default(),
            key,
            moving: Vec::new(),
            effects: Vec::new(),
            directions: Vec::new(),
            direction: Vec::new(),
            makes_moles: false,
            makes_mass: false,
            drying: None,
            bound: None,
        };
        let dries = |one: &Reaction| matches!(one.rate, Rate::Evaporation(_));
        made.drying = made.reactions.iter().position(dries);
        made.bound = BoundWater::of(&made.reactions, &made.solids, made.gas.as_ref());
        made.heat = made.reactions.iter().map(|one| made.heat_of(one)).collect();
        made.index();
        made.shared = SharedFilm::new(&made.reactions, &made.layers);
        Ok(made)
    }

    /// Fills what follows from the reactions for their integration.
    fn index(&mut self) {
        let net = |one: &Reaction| one.gases.iter().map(|gas| gas.1).sum::<f64>();
        let changes = |one: &Reaction| net(one).abs() > EQUIMOLAR;
        self.makes_moles = self.reactions.iter().any(changes);
        self.makes_mass = self.reactions.iter().any(|one| !one.gases.is_empty());
        let used = |s: &usize| {
            let mut solids = self.reactions.iter().flat_map(|one| &one.solids);
            solids.any(|one| one.0 == *s && one.1 != 0.0)
        };
        self.moving = (0..self.solids.len()).filter(used).collect();
        let place = |&(s, n): &(usize, f64)| {
            let found = self.moving.iter().position(|one| *one == s);
            found.map(|place| (place, n))
        };
        let reactions = self.reactions.iter();
        self.effects = reactions
            .map(|one| one.solids.iter().filter_map(place).collect())
            .collect();
        for (index, reaction) in self.reactions.iter().enumerate() {
            let direction = self.key[index].map(|key| match &reaction.rate {
                Rate::Core { .. } => gases(reaction).unwrap_or((key, None)),
                _ => (key, None),
            });
            if let Some(one) = direction.filter(|one| !self.directions.contains(one)) {
                self.directions.push(one);
            }
            let found =
                direction.and_then(|one| self.directions.iter().position(|other| *other == one));
            self.direction.push(found);
        }
    }

    /// The layers of its shrinking cores.
    pub(super) fn layers(&self) -> &[Layers] {
        &self.layers
    }

    /// The reactions that share the gas at the surface.
    pub(super) fn shared(&self) -> &SharedFilm {
        &self.shared
    }

    /// Solids that some reaction uses or makes.
    pub(super) fn moving(&self) -> &[usize] {
        &self.moving
    }

    /// Solids on which gases react with each other.
    pub(super) fn catalysts(&self) -> impl Iterator<Item = usize> {
        self.reactions.iter().flat_map(Reaction::catalysts)
    }

    /// Moles that a mole of a reaction makes (+) or uses (−) of each solid, by its place in `moving`.
    pub(super) fn effects(&self, reaction: usize) -> &[(usize, f64)] {
        &self.effects[reaction]
    }

    /// Changes of the gas by which rates have slopes: the mole fraction of a key gas, and of the gas that diffuses back
    /// for it by as much less.
    pub(super) fn directions(&self) -> &[(usize, Option<usize>)] {
        &self.directions
    }

    /// That of a reaction.
    pub(super) fn direction(&self, reaction: usize) -> Option<usize> {
        self.direction[reaction]
    }

    /// True where reactions may make a net flow through the film of a particle in these surroundings that acts on their rates.
    pub(super) fn makes_film_flow(&self, around: &ParticleSurroundings<'_>) -> bool {
        let there = around.film.iter().all(|one| one.value > 0.0);
        there
            && match around.theory.stefan_flow {
                StefanFlow::None => false,
                StefanFlow::Molar => self.makes_moles,
                StefanFlow::Mass => self.makes_mass,
            }
    }

    /// The gas that diffuses back for a reaction's key gas, mole for mole.
    pub(super) fn counter(&self, reaction: usize) -> Option<usize> {
        let direction = self.direction[reaction]?;
        self.directions[direction].1
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

    /// Change with the particle's temperature of the heat that a mole of a reaction brings it, in J/mol/K, of one that uses no gas.
    pub(super) fn warmth_slope(&self, reaction: usize, temperature: f64) -> f64 {
        let one = &self.reactions[reaction];
        let solids = one.solids.iter().map(|&(s, n)| {
            n * self.solids[s].molar_mass() * self.solids[s].heat_capacity(temperature)
        });
        let gases = one.gases.iter().map(|&(g, n)| {
            let species = self.gas.as_ref().map(|gas| &gas.species()[g]);
            species.map_or(0.0, |one| {
                n * one.molar_mass() * one.heat_capacity(temperature)
            })
        });
        -solids.chain(gases).sum::<f64>()
    }

    /// The reaction that dries particles.
    pub(super) fn drying(&self) -> Option<usize> {
        self.drying
    }

    /// What binds water, if anything does.
    pub(super) fn bound(&self) -> Option<&BoundWater> {
        self.bound.as_ref()
    }

    /// Energy in J of amounts of solids (mol) by what binds their water, zero or below.
    pub fn binding(&self, amounts: &[f64]) -> f64 {
        let bound = self.bound.as_ref();
        bound.map_or(0.0, |bound| bound.energy(amounts, &self.solids))
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
    /// method, whose slope is piecewise linear, held within [`LOWEST`] and [`HIGHEST`]; the bound as an error where the
    /// enthalpy has none within.
    pub fn temperature(&self, amounts: &[f64], enthalpy: f64, guess: f64) -> Result<f64, f64> {
        let (mut low, mut high) = (LOWEST, HIGHEST);
        let mut temperature = guess.clamp(2.0 * LOWEST, 0.5 * HIGHEST);
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
                return Ok(next);
            }
            for (bound, beyond) in [(LOWEST, next < LOWEST), (HIGHEST, next > HIGHEST)] {
                let lacking = enthalpy - self.enthalpy(amounts, bound);
                if beyond && lacking * (bound - temperature) > 0.0 {
                    return Err(bound);
                }
            }
            temperature = if next > low && next < high {
                next
            } else {
                0.5 * (low + high)
            };
        }
        Ok(temperature)
    }

    /// Mass in kg of amounts of solids.
    pub fn mass(&self, amounts: &[f64]) -> f64 {
        let parts = self.solids.iter().zip(amounts);
        parts.map(|(solid, n)| solid.molar_mass() * n).sum()
    }
}

/// Moles by which gases that are used and made may differ, a mole of the reaction, as none.
const EQUIMOLAR: f64 = 1e-9;

/// Bounds of the temperature of a particle in K.
pub(super) const LOWEST: f64 = 1.0;
pub(super) const HIGHEST: f64 = 2e4;

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
