//! Water of particles: its exchange with the gas through the film (docs/theory.md, DRY-1), and what binds it (DRY-2).

use calcine_numerics::{Dual, Number};
use calcine_physics::moisture::bound_water::{binding, binding_slopes};
use calcine_physics::reaction::Evaporation;
use calcine_physics::solids::SolidSpecies;
use calcine_physics::sphere;
use calcine_physics::thermo::Mixture;

use super::chemistry::SolidChemistry;
use super::passage::ParticleSurroundings;
use super::rates::RateState;
use super::reaction::{Rate, Reaction};

/// How many times faster than interfaces are at most ([`RateState::fastest`]) a wet surface comes to equilibrium with the gas
/// beside it: that much the vapour there is off.
const QUICK: f64 = 100.0;
/// Mole fraction of other gases that vapour beside a particle has at least: pure vapour has no film, and what would condense in it on
/// a cold particle no end. With it, condensation is some ten times as fast as in a gas with a tenth of another one.
pub(super) const LEAST_OTHER: f64 = 1e-7;
/// Temperature in K whose heat of evaporation the heat of sorption is a share of.
const BOILING: f64 = 373.15;

/// A wet surface: what it sets free by itself in mol/s, and what it takes back at 1 mol/m³ beside it.
pub(super) struct WetExchange<N> {
    pub free: N,
    pub back: N,
    /// Concentration in mol/m³ with which it is in equilibrium.
    pub at_rest: N,
    /// True where the other way round it would go otherwise.
    pub turns: bool,
}

impl SolidChemistry {
    /// The gas and the solid between which a reaction dries a particle.
    pub(super) fn vapour_and_water(reaction: &Reaction) -> Option<(usize, usize)> {
        let (gas, solid) = (reaction.gases.first()?, reaction.solids.first()?);
        Some((gas.0, solid.0))
    }

    /// Leaves the last gas its least share beside vapour, in mole fractions.
    pub(super) fn other_than_vapour(&self, fractions: &mut [f64]) {
        let reaction = self.drying().map(|one| &self.reactions[one]);
        let Some((vapour, _)) = reaction.and_then(Self::vapour_and_water) else {
            return;
        };
        let most = 1.0 - LEAST_OTHER;
        if fractions[vapour] > most {
            fractions.fill(0.0);
            fractions[vapour] = most;
            if let Some(last) = fractions.last_mut() {
                *last = LEAST_OTHER;
            }
        }
    }

    /// The wet surface of a particle of a radius in m, beside gas of a concentration in mol/m³ of the vapour.
    pub(super) fn wet_exchange<N: Number>(
        &self,
        (reaction, law): (&Reaction, &Evaporation),
        around: &ParticleSurroundings<'_>,
        state: &RateState<'_, N>,
        (radius, beside): (N, f64),
    ) -> Option<WetExchange<N>> {
        let (gas, water) = Self::vapour_and_water(reaction)?;
        let film = around.film_temperature(state.temperature);
        let coefficient = around.coefficient(gas, radius, film);
        let quick = coefficient.times(QUICK * state.fastest);
        let at_rest = law.concentration(self.wet_and_dry(state.amounts, water), state.temperature);
        let dries = at_rest.value() > beside;
        let presence = state.presence(water, 0.0);
        // What goes one way takes nothing back.
        let one_way = reaction.equilibrium == calcine_physics::reaction::Equilibrium::OneWay;
        let returning = N::constant(if one_way { 0.0 } else { 1.0 });
        let factor = if dries { presence } else { returning };
        let back = sphere::surface_of(radius) * quick * factor;
        Some(WetExchange {
            free: back * at_rest,
            back,
            at_rest,
            turns: presence.value() != returning.value(),
        })
    }

    /// Rate in mol/s at which a particle dries whose vapour no other reaction meets.
    pub(super) fn dry<N: Number>(
        &self,
        drying: (&Reaction, &Evaporation),
        around: &ParticleSurroundings<'_>,
        state: &RateState<'_, N>,
        (radius, all_gas): (N, N),
    ) -> N {
        let none = N::constant(0.0);
        let Some((gas, _)) = Self::vapour_and_water(drying.0) else {
            return none;
        };
        let passage = around.passage(gas, radius, state.temperature, state.film_flow);
        let bulk = all_gas * state.fractions[gas] * passage.gain;
        let Some(wet) = self.wet_exchange(drying, around, state, (radius, bulk.value())) else {
            return none;
        };
        let film = sphere::surface_of(radius) * passage.coefficient;
        let both = film + wet.back;
        if both.value() <= 0.0 {
            return none;
        }
        film * wet.back / both * (wet.at_rest - bulk)
    }

    /// Masses in kg of the water and of everything else in a particle.
    fn wet_and_dry<N: Number>(&self, amounts: &[N], water: usize) -> [N; 2] {
        let mut masses = [N::constant(0.0); 2];
        for (s, (n, solid)) in amounts.iter().zip(&self.solids).enumerate() {
            let part = &mut masses[usize::from(s != water)];
            *part = *part + n.times(solid.molar_mass());
        }
        masses
    }
}

/// What binds the water of particles.
#[derive(Clone, Debug)]
pub(super) struct BoundWater {
    water: usize,
    fibre_saturation: f64,
    /// Heat of evaporation in J/kg of which the heat of sorption is a share.
    latent: f64,
    /// Masses in kg of water and of everything else that a mole of each reaction makes.
    effects: Vec<[f64; 2]>,
}

impl BoundWater {
    /// That of the first reaction that dries with a heat of sorption.
    pub fn of(
        reactions: &[Reaction],
        solids: &[SolidSpecies],
        gas: Option<&Mixture>,
    ) -> Option<Self> {
        let (reaction, fibre_saturation) = reactions.iter().find_map(|one| match &one.rate {
            Rate::Evaporation(law) => Some((one, law.fibre_saturation?)),
            _ => None,
        })?;
        let (vapour, water) = SolidChemistry::vapour_and_water(reaction)?;
        let (vapour, liquid) = (&gas?.species()[vapour], &solids[water]);
        let latent = vapour.formation_enthalpy() + vapour.enthalpy(BOILING)
            - liquid.formation_enthalpy() / liquid.molar_mass()
            - liquid.enthalpy(BOILING);
        let effects = reactions.iter().map(|one| {
            let mut masses = [0.0; 2];
            for &(s, n) in &one.solids {
                masses[usize::from(s != water)] += n * solids[s].molar_mass();
            }
            masses
        });
        Some(Self {
            water,
            fibre_saturation,
            latent,
            effects: effects.collect(),
        })
    }

    fn masses(&self, amounts: &[f64], solids: &[SolidSpecies]) -> [f64; 2] {
        let mut masses = [0.0; 2];
        for (s, (n, solid)) in amounts.iter().zip(solids).enumerate() {
            masses[usize::from(s != self.water)] += n * solid.molar_mass();
        }
        masses
    }

    /// Energy in J of amounts in mol against those of free water and dry solid, zero or below.
    pub fn energy(&self, amounts: &[f64], solids: &[SolidSpecies]) -> f64 {
        let [water, dry] = self.masses(amounts, solids);
        self.latent * binding(water, dry, self.fibre_saturation)
    }

    /// Heat in J/mol that each reaction sets free by it at these amounts, and its changes with the masses in kg of water and of
    /// everything else.
    pub fn heats(&self, amounts: &[f64], solids: &[SolidSpecies], out: &mut Vec<[f64; 3]>) {
        let [water, dry] = self.masses(amounts, solids);
        let (water, dry) = (Dual::<2>::along(water, 0), Dual::along(dry, 1));
        let slopes = binding_slopes(water, dry, self.fibre_saturation);
        out.clear();
        out.extend(self.effects.iter().map(|effect| {
            let heat =
                (slopes[0].times(effect[0]) + slopes[1].times(effect[1])).times(-self.latent);
            [heat.value, heat.slope[0], heat.slope[1]]
        }));
    }

    /// Which of the changes of [`Self::heats`] is that with a solid.
    pub fn part(&self, solid: usize) -> usize {
        1 + usize::from(solid != self.water)
    }
}
