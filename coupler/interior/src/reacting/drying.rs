//! Water of particles: its exchange with the gas through the film (docs/theory.md, DRY-1).

use calcine_numerics::Number;
use calcine_physics::reaction::Evaporation;
use calcine_physics::sphere;

use super::chemistry::SolidChemistry;
use super::passage::ParticleSurroundings;
use super::rates::RateState;
use super::reaction::Reaction;

/// How many times faster than interfaces are at most ([`RateState::fastest`]) a wet surface comes to equilibrium with the gas
/// beside it: that much the vapour there is off.
const QUICK: f64 = 100.0;
/// Mole fraction of other gases that vapour beside a particle has at least: pure vapour has no film, and what would condense in it on
/// a cold particle no end. With it, condensation is some ten times as fast as in a gas with a tenth of another one.
pub(super) const LEAST_OTHER: f64 = 1e-7;

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
    /// Leaves the last gas its least share beside vapour, in mole fractions.
    pub(super) fn other_than_vapour(&self, fractions: &mut [f64]) {
        let reaction = self.drying().map(|one| &self.reactions[one]);
        let Some((vapour, _)) = reaction.and_then(Reaction::vapour_and_water) else {
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
        let (gas, water) = reaction.vapour_and_water()?;
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
        let Some((gas, _)) = drying.0.vapour_and_water() else {
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
