//! What binds the water of particles (docs/theory.md, DRY-2).

use calcine_numerics::{Dual, Number};
use calcine_physics::moisture::bound_water::{binding, binding_slopes};
use calcine_physics::solids::SolidSpecies;
use calcine_physics::thermo::Mixture;

use super::reaction::{Rate, Reaction};

/// Temperature in K whose heat of evaporation the heat of sorption is a share of.
const BOILING: f64 = 373.15;

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
        let (vapour, water) = reaction.vapour_and_water()?;
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
