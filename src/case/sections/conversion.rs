//! `materials.NAME.size`: how particles take up room while they react.

use calcine_coupler::interior::reacting::SizeChange;
use calcine_coupler::interior::reacting::size::{SizeRule, specific_volume};
use calcine_coupler::physics::reaction::Equilibrium;
use calcine_coupler::physics::solids::SolidSpecies;

use crate::case::model::{MaterialSpec, Population, ReactionSpec, SizeLaw};
use crate::case::table::TableReader;

/// By how much the density that stated densities of solids come to may differ from the material's.
const DENSITY: f64 = 0.01;

/// The law of a material.
pub(super) fn read(material: &TableReader<'_>, solids: &[SolidSpecies]) -> SizeLaw {
    let Some((law, table)) = material.law("size", &material.laws().size) else {
        return SizeLaw::default();
    };
    if !material.has("composition") {
        let help = "add a composition, or remove it: only what reacts changes its size";
        material.fail("size", "stands beside no `composition`", help);
    }
    let least = |table: &TableReader<'_>| {
        table.need("least_diameter");
        0.5 * table.number("least_diameter").unwrap_or(f64::NAN)
    };
    let made = match law.map(|law| *law.make()) {
        None | Some(SizeRule::ConstantDiameter) => SizeLaw::Constant,
        Some(SizeRule::ConstantDensity) => SizeLaw::ConstantDensity {
            least_radius: least(&table),
        },
        Some(SizeRule::Densities) => SizeLaw::Densities {
            densities: densities(&table, "densities", solids).unwrap_or_default(),
            least_radius: least(&table),
        },
    };
    table.finish();
    made
}

/// Density of each solid, by the names of the table; `None` where one could not be read.
pub(super) fn densities(
    table: &TableReader<'_>,
    key: &str,
    solids: &[SolidSpecies],
) -> Option<Vec<Option<f64>>> {
    table.need(key);
    let (inner, stated) = table.by_name(key)?;
    let mut found = vec![None; solids.len()];
    for (name, value) in stated? {
        let Some(k) = solids.iter().position(|one| one.name() == name) else {
            let help = "name solids of the composition, and those that reactions make of them";
            inner.fail(&name, "is no solid of the case", help);
            return None;
        };
        if value <= 0.0 {
            inner.fail(
                &name,
                format!("is {value} kg/m^3"),
                "write a density above zero",
            );
            return None;
        }
        found[k] = Some(value);
    }
    Some(found)
}

/// The law in terms of the solids that there are: of all solids, those that are `used`.
pub(super) fn size(
    material: &MaterialSpec,
    start: &[f64],
    solids: &[SolidSpecies],
    used: &[bool],
) -> SizeChange {
    match &material.size {
        SizeLaw::Constant => SizeChange::Constant,
        SizeLaw::ConstantDensity { least_radius } => {
            SizeChange::of_density(material.density, solids, *least_radius)
        }
        SizeLaw::Densities {
            densities,
            least_radius,
        } => {
            let stated = |k: usize| densities.get(k).copied().flatten();
            let kept = (0..used.len()).filter(|k| used[*k]);
            // Of what is not stated there is never any.
            let own: Vec<f64> = kept.map(|k| stated(k).unwrap_or(f64::INFINITY)).collect();
            SizeChange::of_densities(&own, (material.density, start), solids, *least_radius)
        }
    }
}

/// Errors where sizes do not go with composition, reactions and diameters.
pub(super) fn fits(
    root: &TableReader<'_>,
    chemistry: &ReactionSpec,
    materials: &[MaterialSpec],
    particles: &[Population],
) {
    let tables = root.table("materials").map(|section| section.named());
    for (name, table) in tables.unwrap_or_default() {
        let found = materials.iter().position(|one| one.name == name);
        let Some(index) = found.filter(|&index| index < chemistry.sizes.len()) else {
            continue;
        };
        let SizeChange::Volumes { each, least_radius } = &chemistry.sizes[index] else {
            continue;
        };
        let own = particles.iter().filter(|one| one.material == index);
        let smallest = own.map(|one| one.sizes.smallest());
        let smallest = smallest.fold(f64::INFINITY, f64::min);
        let least = 2.0 * least_radius;
        if least > smallest {
            let rule = format!(
                "lets no particle shrink below {least} m, but some begin with {smallest} m"
            );
            let help = "write a `least_diameter` below the smallest diameter";
            table.fail("size", rule, help);
        }
        let start = &chemistry.compositions[index];
        let held = reached(chemistry, start);
        // What could not be read is told already.
        let unread = matches!(&materials[index].size, SizeLaw::Densities { densities, .. } if densities.is_empty());
        if unread {
            continue;
        }
        if let Some(s) = (0..each.len()).find(|&s| held[s] && each[s] == 0.0) {
            let solid = chemistry.solids[s].name();
            let rule =
                format!("has no density of {solid}, which such particles hold or come to hold");
            table.fail("size", rule, "add it to `densities`");
            continue;
        }
        let material = &materials[index];
        let stated = stated_density(material);
        if let Some(stated) = stated.filter(|one| (one / material.density - 1.0).abs() > DENSITY) {
            let rule = format!(
                "has densities that come to {stated:.0} kg/m^3 at the start, but `density` is {} kg/m^3",
                material.density
            );
            let help =
                "correct one of them: a solid's density is that in the particle, with its pores";
            table.fail("size", rule, help);
        }
    }
}

/// The density in kg/m³ that the stated ones of a material's solids come to at the start.
fn stated_density(material: &MaterialSpec) -> Option<f64> {
    let SizeLaw::Densities { densities, .. } = &material.size else {
        return None;
    };
    let stated = densities.iter().map(|one| one.unwrap_or(f64::INFINITY));
    let composition = material.composition.as_ref()?;
    Some(1.0 / specific_volume(&stated.collect::<Vec<f64>>(), composition))
}

/// Which solids a material holds or comes to hold.
pub(super) fn reached(chemistry: &ReactionSpec, start: &[f64]) -> Vec<bool> {
    let mut there: Vec<bool> = start.iter().map(|y| *y > 0.0).collect();
    for _ in 0..chemistry.reactions.len() {
        for reaction in &chemistry.reactions {
            let ways = match reaction.equilibrium {
                Equilibrium::OneWay => &[1.0][..],
                _ => &[1.0, -1.0],
            };
            for way in ways {
                let mut used = reaction.solids.iter().filter(|one| way * one.1 < 0.0);
                if used.all(|one| there[one.0]) {
                    let made = reaction.solids.iter().filter(|one| way * one.1 > 0.0);
                    made.for_each(|one| there[one.0] = true);
                }
            }
        }
    }
    there
}
