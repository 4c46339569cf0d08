//! Where particles count as used up before they are converted.

use super::model::Case;
use super::units::short3;

/// Passes over the reactions at most until nothing is left to react.
const PASSES: usize = 100;
/// Share of the first mass below which nothing of a particle is left.
const NOTHING: f64 = 1e-3;

/// Warnings about `materials.NAME.used_up`, in the order of the materials.
pub(super) fn all(case: &Case) -> Vec<String> {
    let chemistry = &case.chemistry;
    let materials = case.materials.iter().zip(&chemistry.compositions);
    let early = materials.enumerate().filter_map(|(index, (material, start))| {
        let has_particles = case.particles.iter().any(|one| one.material == index);
        let left = left(case, start);
        let early = left > NOTHING && material.used_up > left;
        (has_particles && early && material.composition.is_some()).then(|| {
            format!(
                "`materials.{}.used_up` is {}, but full conversion leaves {} of the mass: particles are taken out of the run before they \
                 are converted, and what is left of them with them; write less than that, or nothing",
                material.name,
                material.used_up,
                short3(left)
            )
        })
    });
    early.collect()
}

/// Share of the mass that is left where every reaction went as far as its solids last; gas is not wanting.
fn left(case: &Case, start: &[f64]) -> f64 {
    let chemistry = &case.chemistry;
    let molar = |s: usize| chemistry.solids[s].molar_mass();
    let mut moles: Vec<f64> = start
        .iter()
        .enumerate()
        .map(|(s, y)| y / molar(s))
        .collect();
    for _ in 0..PASSES {
        let mut turned = 0.0;
        for one in &chemistry.reactions {
            let taken = one.solids.iter().filter(|(_, nu)| *nu < 0.0);
            let extent = taken
                .map(|&(s, nu)| moles[s] / -nu)
                .fold(f64::INFINITY, f64::min);
            if !extent.is_finite() || extent <= 0.0 {
                continue;
            }
            for &(s, nu) in &one.solids {
                moles[s] = (moles[s] + nu * extent).max(0.0);
            }
            turned += extent;
        }
        if turned <= 1e-12 {
            break;
        }
    }
    let masses = moles.iter().enumerate().map(|(s, n)| n * molar(s));
    masses.sum::<f64>() / start.iter().sum::<f64>()
}

#[cfg(test)]
mod tests {
    use crate::case::cautions::tests::{one, said};

    #[test]
    fn a_share_above_what_full_conversion_leaves_is_told() {
        let text = one("calcining-box", &["materials.limestone.used_up=0.9"]);
        assert!(
            text.starts_with(
                "`materials.limestone.used_up` is 0.9, but full conversion leaves 0.56 of the mass"
            ),
            "{text}"
        );
        assert!(said("calcining-box", &["materials.limestone.used_up=0.5"]).is_empty());
        // Nothing is left of carbon.
        assert!(said("burning-moving", &["materials.char.used_up=0.3"]).is_empty());
    }
}
