//! `materials.NAME.inside` and `.radial`: particles resolved along their radius.

use calcine_coupler::interior::radial::{ShellGrading, ShellGrid};
use calcine_coupler::interior::reacting::{Rate, Reaction};
use calcine_coupler::physics::pores::PorousConductivity;
use calcine_coupler::physics::solids::SolidSpecies;

use super::conversion::{densities, reached};
use crate::case::model::{Inside, MaterialSpec, Population, RadialSpec, ReactionSpec};
use crate::case::table::TableReader;

/// What is inside of a material's particles.
pub(super) fn read(material: &TableReader<'_>, solids: &[SolidSpecies]) -> (Inside, RadialSpec) {
    let inside = material.choice("inside").unwrap_or_default();
    if inside == Inside::Thin && material.has("radial") {
        let help = "write inside = \"radial\" or \"auto\", or remove it";
        material.fail("radial", "stands beside `inside` = \"thin\"", help);
    }
    let nothing = RadialSpec {
        grid: ShellGrid {
            shells: 30,
            grading: ShellGrading::Ratio(4.0),
        },
        true_densities: Vec::new(),
        pore_diameter: None,
        tortuosity: None,
        permeability: None,
        conduction: PorousConductivity::Stated,
        errors: [1.0, 1e-3],
        turns: [5.0, 0.05],
    };
    let Some(table) = material.table("radial") else {
        return (inside, nothing);
    };
    let laws = table.laws();
    let number = |key: &str| table.number(key).unwrap_or(f64::NAN);
    let shells = table.whole("shells").unwrap_or(30);
    let made = RadialSpec {
        grid: ShellGrid {
            shells: usize::try_from(shells).unwrap_or(30),
            grading: grading(&table),
        },
        true_densities: match table.has("true_densities") {
            true => densities(&table, "true_densities", solids).unwrap_or_default(),
            false => Vec::new(),
        },
        pore_diameter: table.number("pore_diameter"),
        tortuosity: table.number("tortuosity"),
        permeability: law(&table, "permeability", &laws.permeability),
        conduction: law(&table, "conduction", &laws.porous_conductivity)
            .unwrap_or(PorousConductivity::Stated),
        errors: [number("temperature_error"), number("conversion_error")],
        turns: [number("turn_temperature"), number("turn_pressure")],
    };
    table.finish();
    (inside, made)
}

/// How shells get thinner towards the surface: a ratio, or a table with a Thiele number.
fn grading(table: &TableReader<'_>) -> ShellGrading {
    if !table.is_table("grading") {
        return ShellGrading::Ratio(table.number("grading").unwrap_or(f64::NAN));
    }
    let number = table.table("grading").and_then(|inner| {
        let number = inner.number("thiele");
        inner.finish();
        number
    });
    ShellGrading::Thiele(number.unwrap_or(f64::NAN))
}

/// The law that a table below names.
fn law<L: Copy + 'static>(
    table: &TableReader<'_>,
    key: &str,
    laws: &[&'static calcine_coupler::physics::law::LawEntry<L>],
) -> Option<L> {
    let (law, inner) = table.law(key, laws)?;
    inner.finish();
    law.map(|law| *law.make())
}

/// Errors where shells do not go with the rest of the case.
pub(super) fn fits(
    root: &TableReader<'_>,
    chemistry: &ReactionSpec,
    materials: &[MaterialSpec],
    particles: &[Population],
) {
    let tables = root.table("materials").map(|section| section.named());
    for (name, table) in tables.unwrap_or_default() {
        let Some(index) = materials.iter().position(|one| one.name == name) else {
            continue;
        };
        if particles.iter().any(|one| one.material == index) {
            fits_one(&table, chemistry, (&materials[index], index));
        }
    }
}

fn fits_one(
    table: &TableReader<'_>,
    chemistry: &ReactionSpec,
    (material, index): (&MaterialSpec, usize),
) {
    let start = chemistry.compositions.get(index).map_or(&[][..], |own| own);
    let holds = |s: usize| start.get(s).is_some_and(|y| *y > 0.0);
    // A core has its layers instead of shells, and may stand beside another law; nothing else takes up water and volatiles.
    let only = |one: &Reaction| one.rate.needs_thin() && !matches!(one.rate, Rate::Core { .. });
    let reacts = |shells: bool| {
        let stays = |one: &&Reaction| {
            let stays = if shells {
                one.rate.needs_thin()
            } else {
                one.rate.needs_shells()
            };
            stays && one.solids.iter().any(|&(s, n)| n < 0.0 && holds(s))
        };
        let own = || chemistry.reactions.iter().filter(stays);
        own().find(|one| only(one)).or_else(|| own().next())
    };
    let others = |shells: bool| {
        chemistry.reactions.iter().any(|one| {
            let own = if shells {
                !one.rate.needs_thin()
            } else {
                !one.rate.needs_shells()
            };
            own && one.solids.iter().any(|&(s, n)| n < 0.0 && holds(s))
        })
    };
    let with_shells = material.inside != Inside::Thin;
    if let Some(one) = reacts(with_shells).filter(|one| only(one) || !others(with_shells)) {
        let rule = match with_shells {
            true if only(one) => format!(
                "gives particles shells, but {} goes by {}, which is a law of thin particles",
                one.name,
                one.rate.law().name
            ),
            true => format!(
                "gives particles shells, but {} goes by shrinking-core, which has its own layers",
                one.name
            ),
            false => format!(
                "lets particles be thin, but {} goes by {}, which needs their shells",
                one.name,
                one.rate.law().name
            ),
        };
        let help = match with_shells {
            true if only(one) => "write inside = \"thin\", or leave it out",
            true => {
                "add the reaction by a law of the whole particle, such as equilibrium-pressure or power-law"
            }
            false => "write inside = \"radial\" or \"auto\", or choose shrinking-core or power-law",
        };
        table.fail("inside", rule, help);
    }
    if !with_shells {
        return;
    }
    if material.conductivity.is_none() && !table.has("conductivity") {
        table.missing_like("conductivity", "\"1.5 W/m/K\"");
    }
    let alone = material.composition.is_none();
    let parallel = matches!(
        material.radial.conduction,
        PorousConductivity::Parallel { .. }
    );
    if parallel && material.true_density().is_none() {
        let rule = "goes by `parallel`, which needs the porosity at the start";
        let help = if alone {
            "state a `composition` in place of `heat_capacity`, and `radial.true_densities`; or write law = \"stated\""
        } else {
            "state `radial.true_densities` of what it holds, or write law = \"stated\""
        };
        if let Some(inner) = table.table("radial") {
            inner.fail("conduction", rule, help);
        }
        return;
    }
    // What is of one solid that does not react has no pores to speak of.
    let exchanges = !alone && chemistry.exchanges();
    if exchanges && !has_pores(table, chemistry, (index, start)) {
        return;
    }
    if exchanges || parallel {
        leaves_pores(table, material);
    }
}

/// True where a material with gas in its pores says what they are; else errors.
fn has_pores(
    table: &TableReader<'_>,
    chemistry: &ReactionSpec,
    (index, start): (usize, &[f64]),
) -> bool {
    let Some(inner) = table.table("radial") else {
        let help = "write radial = { true_densities = ..., pore_diameter = ..., tortuosity = ..., permeability = ... }";
        table.fail(
            "inside",
            "gives particles pores with gas, and no `radial` says what they are",
            help,
        );
        return false;
    };
    for (key, example) in [
        (
            "true_densities",
            "{ CaCO3 = \"2711 kg/m^3\", CaO = \"3340 kg/m^3\" }",
        ),
        ("pore_diameter", "\"1 um\""),
        ("tortuosity", "2"),
        (
            "permeability",
            "{ law = \"constant\", value = \"1e-15 m^2\" }",
        ),
    ] {
        if !inner.has(key) {
            inner.missing_like(key, example);
        }
    }
    let own = chemistry.true_densities.get(index);
    let Some(own) = own.filter(|own| !own.is_empty()) else {
        return false;
    };
    let held = reached(chemistry, start);
    if let Some(s) = (0..own.len()).find(|&s| held[s] && own[s].is_infinite()) {
        let rule = format!(
            "has no density of {}, which such particles hold or come to hold",
            chemistry.solids[s].name()
        );
        inner.fail("true_densities", rule, "add it");
        return false;
    }
    true
}

/// An error where the solids of particles fill them at the start.
fn leaves_pores(table: &TableReader<'_>, material: &MaterialSpec) {
    let (Some(found), Some(inner)) = (material.true_density(), table.table("radial")) else {
        return;
    };
    let density = material.density;
    if found > density {
        return;
    }
    let rule = format!(
        "come to {found:.0} kg/m^3 at the start, which leaves no pores in a particle of `density` {density:.0} kg/m^3"
    );
    let help = "true densities are without pores, above that of the particle: correct one of them";
    inner.fail("true_densities", rule, help);
}
