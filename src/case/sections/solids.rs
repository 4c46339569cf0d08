//! `[solids]`: pure solids, beside those that are built in.

use calcine_coupler::physics::solid::HeatCapacity;
use calcine_coupler::physics::solids::SolidSpecies;

use crate::case::table::TableReader;

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
