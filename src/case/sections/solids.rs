//! `[solids]`: pure solids, beside those that are built in.

use calcine_coupler::interior::reacting::Reaction;
use calcine_coupler::physics::solid::HeatCapacity;
use calcine_coupler::physics::solids::SolidSpecies;
use calcine_coupler::physics::thermo::Element;

use crate::case::model::MaterialSpec;
use crate::case::table::{NO_DRYING, TableReader, is_moisture};

/// All solids that a case may name: its own, and the built-in ones that it does not redefine.
pub(super) fn solids(root: &TableReader<'_>) -> Vec<SolidSpecies> {
    let own = root.table("solids").map_or(Vec::new(), |section| {
        let tables = section.named();
        let made = tables.iter().filter_map(|(name, table)| solid(name, table));
        let made: Vec<SolidSpecies> = made.collect();
        if made.len() < tables.len() {
            // Whatever names one that could not be made only follows.
            root.unusable("solids");
        }
        made
    });
    let mut all: Vec<SolidSpecies> = own;
    for name in SolidSpecies::built_in_names() {
        if all.iter().all(|one| one.name() != name) {
            all.extend(SolidSpecies::built_in(name).ok());
        }
    }
    all
}

/// Refuses water of a material that no reaction takes up: nothing else would dry it.
pub(super) fn no_drying(
    root: &TableReader<'_>,
    solids: &[SolidSpecies],
    materials: &[MaterialSpec],
    reactions: &[Reaction],
) {
    let Some(section) = root.table("solids") else {
        return;
    };
    for (s, solid) in solids.iter().enumerate() {
        let held = materials.iter().filter_map(|one| one.composition.as_ref());
        let mut held = held.filter(|own| own.get(s).is_some_and(|y| *y > 0.0));
        let mut parts = reactions.iter().flat_map(|one| &one.solids);
        let leaves = parts.any(|&(k, moles)| k == s && moles < 0.0);
        if (is_moisture(solid.name()) || is_water(solid)) && held.next().is_some() && !leaves {
            let help = format!("{}, or state a reaction that takes it up", NO_DRYING[1]);
            section.fail(solid.name(), NO_DRYING[0], help);
        }
    }
}

/// Whether a solid is water whatever its name.
fn is_water(solid: &SolidSpecies) -> bool {
    let of = |element: Element| solid.atoms()[element as usize];
    let others: f64 = solid.atoms().iter().sum::<f64>() - of(Element::H) - of(Element::O);
    others == 0.0 && of(Element::O) > 0.0 && of(Element::H) == 2.0 * of(Element::O)
}

fn solid(name: &str, table: &TableReader<'_>) -> Option<SolidSpecies> {
    let formula = table.text("formula");
    let enthalpy = table.number("formation_enthalpy");
    let entropy = table.number("entropy");
    let points = table.curve("heat_capacity");
    table.finish();
    let points = points?;
    let law = match points[..] {
        [(_, value)] => HeatCapacity::constant(value),
        _ => HeatCapacity::table(points),
    };
    match SolidSpecies::new(name, formula?, enthalpy?, entropy?, law) {
        Ok(made) => Some(made),
        Err(error) => {
            let help = "write elements with their numbers, such as CaCO3";
            table.fail("formula", format!("is refused: {error}"), help);
            None
        }
    }
}
