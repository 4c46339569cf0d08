//! Which solids a case is about: those that its materials hold and its reactions make.

use calcine_coupler::interior::reacting::{Rate, Reaction};
use calcine_coupler::physics::solids::SolidSpecies;

use super::conversion;
use crate::case::model::{MaterialSpec, Population, ReactionSpec};

/// Reactions with the solids of the case; a material of particles that does not say what it is made of is one solid that
/// does not react. Nothing where no reaction is.
pub(super) fn inventory(
    mut solids: Vec<SolidSpecies>,
    mut reactions: Vec<Reaction>,
    materials: &[MaterialSpec],
    particles: &[Population],
) -> ReactionSpec {
    if reactions.is_empty() {
        return ReactionSpec::default();
    }
    let mut compositions: Vec<Vec<f64>> = Vec::new();
    for (index, material) in materials.iter().enumerate() {
        let has_particles = particles.iter().any(|one| one.material == index);
        compositions.push(match &material.composition {
            Some(fractions) => fractions.clone(),
            // Walls are of it.
            None if !has_particles => Vec::new(),
            None => {
                let law = material.heat_capacity.clone();
                solids.push(SolidSpecies::inert(&material.name, law));
                let mut own = vec![0.0; solids.len()];
                own[solids.len() - 1] = 1.0;
                own
            }
        });
    }
    let used: Vec<bool> = (0..solids.len())
        .map(|s| {
            let held = |own: &Vec<f64>| own.get(s).is_some_and(|y| *y > 0.0);
            let mut turned = reactions.iter().flat_map(|one| &one.solids);
            let mut catalysts = reactions.iter().flat_map(Reaction::catalysts);
            compositions.iter().any(held)
                || turned.any(|part| part.0 == s)
                || catalysts.any(|one| one == s)
        })
        .collect();
    let place = |s: usize| used[..s].iter().filter(|used| **used).count();
    for own in &mut compositions {
        own.resize(solids.len(), 0.0);
        let kept = own.iter().zip(&used).filter(|(_, used)| **used);
        *own = kept.map(|(y, _)| *y).collect();
    }
    for reaction in &mut reactions {
        for part in &mut reaction.solids {
            part.0 = place(part.0);
        }
        if let Rate::Power(law) = &mut reaction.rate {
            law.solids.retain(|part| used[part.0]);
            for part in &mut law.solids {
                part.0 = place(part.0);
            }
        }
    }
    let kept = solids.into_iter().zip(&used).filter(|(_, used)| **used);
    let solids: Vec<SolidSpecies> = kept.map(|(solid, _)| solid).collect();
    let own = materials.iter().zip(&compositions);
    let sizes = own.map(|(material, start)| conversion::size(material, start, &solids, &used));
    let stated = |material: &MaterialSpec| {
        let own = &material.radial.true_densities;
        let kept = (0..used.len()).filter(|k| used[*k]);
        // Of what is not stated there is never any, or the material needs no pores.
        kept.map(|k| own.get(k).copied().flatten().unwrap_or(f64::INFINITY))
            .collect()
    };
    ReactionSpec {
        true_densities: materials.iter().map(stated).collect(),
        sizes: sizes.collect(),
        solids,
        reactions,
        compositions,
    }
}
