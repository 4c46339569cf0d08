//! `[[quantities]]`.

use calcine_coupler::physics::Vec3;
use calcine_coupler::physics::solids::SolidSpecies;

use super::bodies::of_name;
use super::common::direction;
use super::common::name_in_results;
use super::known::{Known, check_patch, checked_probe};
use super::passages;
use super::zone::zone as zone_from;
use crate::case::model::{
    Expect, GasPlace, Measure, ParticlePlace, PlacementSpec, Population, Quantity, SURROUNDINGS,
    Statistic, belongs,
};
use crate::case::table::TableReader;
use crate::case::tolerance::{band, band_about};
use crate::case::units::Dimension;
use crate::case::words::{DifferenceField, GasField, ParticleField};

pub(super) fn quantities(root: &TableReader<'_>, known: &Known<'_>) -> Vec<Quantity> {
    let mut made: Vec<Quantity> = Vec::new();
    for table in &root.tables("quantities") {
        let Some(quantity) = quantity(table, known) else {
            continue;
        };
        if made.iter().any(|other| other.name == quantity.name) {
            table.fail(
                "name",
                format!("is \"{}\" a second time", quantity.name),
                "names must differ",
            );
        }
        made.push(quantity);
    }
    made
}

fn quantity(table: &TableReader<'_>, known: &Known<'_>) -> Option<Quantity> {
    let name = name_in_results(table);
    let measure = table.table("measure").and_then(|reader| {
        let measure = measure(&reader, known);
        let of = reader.text("of");
        let column = measure
            .as_ref()
            .and_then(|(measure, field)| column(&reader, measure, field, of, known));
        reader.finish();
        measure.map(|measure| (measure, column))
    });
    // Keys are read even where the measure could not be, so that they are not called unknown.
    let (agree, expected) = (table.has("agree"), table.table("expect"));
    let from = table.number("agree_from");
    if !agree && table.has("agree_from") {
        let help = "add agree = \"1 %\", or remove it";
        table.fail("agree_from", "stands without `agree`", help);
    }
    let over = table.number("agree_over");
    if over.is_some() && !agree {
        let help = "add agree = \"5 %\", or remove it";
        table.fail("agree_over", "stands without `agree`", help);
    }
    let Some(((measure, field), column)) = measure else {
        table.finish();
        return None;
    };
    let (dimension, unit) = match field {
        "pressure" => (Dimension::PRESSURE, "Pa"),
        "density" => (Dimension::DENSITY, "kg/m^3"),
        "speed" => (Dimension::VELOCITY, "m/s"),
        "void_fraction" => (Dimension::NONE, "1"),
        "height" | "x" | "y" | "z" | "diameter" => (Dimension::LENGTH, "m"),
        "angular_speed" => (Dimension::ANGULAR_VELOCITY, "rad/s"),
        "kinetic_energy" => (Dimension::ENERGY, "J"),
        "wall_heat" => (Dimension::POWER, "W"),
        "mass" => (Dimension::MASS, "kg"),
        "mass_fraction" | "count" | "shell_count" | "conversion" => (Dimension::NONE, "1"),
        "heat_flow" => (Dimension::POWER, "W"),
        "mass_flow" | "species_flow" => (Dimension::MASS_FLOW, "kg/s"),
        "force" => (Dimension::FORCE, "N"),
        "residence_time" => (Dimension::TIME, "s"),
        "angle" => (Dimension::NONE, "rad"),
        _ => (Dimension::TEMPERATURE, "K"),
    };
    let agree = if agree {
        band(table, "agree", dimension)
    } else {
        None
    };
    let expect = expected.and_then(|reader| {
        let at = reader.number("at");
        let value = reader.number_as("value", dimension);
        let within = band_about(&reader, value, dimension);
        reader.finish();
        Some(Expect {
            at,
            value: value?,
            within: within?,
        })
    });
    table.finish();
    Some(Quantity {
        name: name?.into(),
        measure,
        column,
        unit,
        agree,
        agree_from: from.unwrap_or(0.0),
        agree_over: over.unwrap_or(0.0),
        expect,
    })
}

/// The species or solid whose mass fraction is measured.
fn column(
    reader: &TableReader<'_>,
    measure: &Measure,
    field: &str,
    of: Option<&str>,
    known: &Known<'_>,
) -> Option<usize> {
    if !["mass_fraction", "conversion", "species_flow"].contains(&field) {
        if of.is_some() {
            let help = "remove it: mass_fraction, conversion and the flow of species are of one";
            reader.fail("of", "does not go with this measure", help);
        }
        return None;
    }
    let Some(name) = of else {
        reader.missing("of");
        return None;
    };
    let names: Vec<&str> = match measure {
        Measure::Gas { .. } | Measure::Flow { .. } => {
            known.species.iter().map(String::as_str).collect()
        }
        _ => known.solids?.iter().map(SolidSpecies::name).collect(),
    };
    let found = names.iter().position(|other| *other == name);
    if found.is_none() {
        let help = match names[..] {
            [] => "there are none here".into(),
            _ => format!("there are {}", names.join(", ")),
        };
        reader.fail("of", format!("is \"{name}\""), help);
    }
    if let Some(solid) = found.filter(|_| field == "conversion") {
        came_with(reader, measure, (solid, &names), known);
    }
    found
}

/// Refuses the conversion of a solid with which none of the particles that are meant came.
fn came_with(
    reader: &TableReader<'_>,
    measure: &Measure,
    (solid, names): (usize, &[&str]),
    known: &Known<'_>,
) {
    let Some(all) = known.populations else {
        return;
    };
    let only = match measure {
        Measure::Particles {
            over: ParticlePlace::Among { populations, .. },
            ..
        } => populations.as_deref(),
        _ => None,
    };
    let meant = (0u32..).zip(all);
    let meant = meant.filter(|(place, _)| only.is_none_or(|only| only.contains(place)));
    let made: Vec<&[f64]> = meant
        .filter_map(|(_, one)| Some(&**known.compositions.get(one.material)?))
        .collect();
    let has = |k: usize| {
        made.iter()
            .any(|shares| shares.get(k).is_some_and(|x| *x > 0.0))
    };
    if has(solid) {
        return;
    }
    let others: Vec<&str> = (0..names.len())
        .filter(|k| has(*k))
        .map(|k| names[k])
        .collect();
    let help = match others[..] {
        [] => "name particles that react; these have no composition".into(),
        _ => format!("they come with {}", others.join(", ")),
    };
    let rule = format!(
        "is \"{}\", with which none of these particles comes",
        names[solid]
    );
    reader.fail("of", rule, help);
}

/// The measure and the field that it is of.
fn measure(reader: &TableReader<'_>, known: &Known<'_>) -> Option<(Measure, &'static str)> {
    match reader.exactly_one()? {
        "difference" => difference_of(reader, known),
        "gas" => gas(reader, known),
        "particles" => particles(reader, known),
        "particle" => particle(reader, known),
        "wall_heat" => wall_heat(reader, known),
        "flow" => passages::flow(reader, known),
        "force" => passages::force(reader, known),
        "discharge" => passages::discharge(reader, known),
        "body" => {
            let name = reader.text("body")?;
            of_name(reader, name, known.bodies);
            Some((Measure::Body { body: name.into() }, "temperature"))
        }
        _ => surface_angle(reader, known),
    }
}

fn difference_of(reader: &TableReader<'_>, known: &Known<'_>) -> Option<(Measure, &'static str)> {
    let field = reader
        .choice("difference")
        .map(|DifferenceField(field)| field);
    let names = reader
        .texts("patches")
        .and_then(|names| <[String; 2]>::try_from(names).ok());
    let Some(names) = names else {
        reader.fail(
            "patches",
            "needs two patches",
            "for example patches = [\"bottom\", \"top\"]",
        );
        return None;
    };
    for name in &names {
        check_patch(reader, "patches", name, known.mesh);
    }
    let field = field?;
    Some((
        Measure::Difference {
            field: field.into(),
            patches: names,
        },
        field,
    ))
}

fn gas(reader: &TableReader<'_>, known: &Known<'_>) -> Option<(Measure, &'static str)> {
    let field = reader.choice("gas").map(|GasField(field)| field);
    let patch = reader.text("patch");
    let probe = reader.text("probe");
    let statistic = statistic(reader, reader.has("probe").then_some(Statistic::Mean));
    if statistic == Some(Statistic::MassFlowMean) {
        passages::flow_mean(reader, (field, patch), known);
    }
    if statistic == Some(Statistic::Sum) {
        let help = "write \"mean\", which is over the volume of gas or the area of a patch";
        reader.fail("statistic", "is \"sum\", which no gas field has", help);
    }
    let over = match (patch, probe) {
        (Some(_), Some(_)) => {
            reader.fail("patch", "stands beside `probe`", "name one of them");
            return None;
        }
        (Some(patch), None) => {
            check_patch(reader, "patch", patch, known.mesh);
            GasPlace::Patch(patch.into())
        }
        (None, Some(probe)) => GasPlace::Probe(checked_probe(reader, probe, known)?),
        (None, None) => GasPlace::Everywhere,
    };
    let field = field?;
    Some((
        Measure::Gas {
            field: field.into(),
            over,
            statistic: statistic?,
        },
        field,
    ))
}

fn particles(reader: &TableReader<'_>, known: &Known<'_>) -> Option<(Measure, &'static str)> {
    let field = reader.choice("particles").map(|ParticleField(field)| field);
    let probe = reader.text("probe");
    let counts = field == Some("count");
    let unstated = match counts {
        true => Some(Statistic::Sum),
        false => reader.has("probe").then_some(Statistic::Mean),
    };
    let statistic = statistic(reader, unstated);
    let over = particle_place(reader, probe, known);
    let (field, statistic) = (field?, statistic?);
    let summed = counts || ["mass", "kinetic_energy"].contains(&field);
    if statistic == Statistic::MassFlowMean {
        let help = "write \"mean\"; what particles carry out is measured by `discharge`";
        reader.fail("statistic", "is of gas through a patch alone", help);
    } else if statistic == Statistic::Sum && !summed {
        let help = "write \"mean\"; sums are of count, mass and kinetic_energy";
        reader.fail("statistic", format!("is the sum of {field}"), help);
    } else if counts && statistic != Statistic::Sum {
        let help = "remove it, or write \"sum\"";
        reader.fail("statistic", "is no statistic of a count", help);
    }
    Some((
        Measure::Particles {
            field: field.into(),
            over: over?,
            statistic,
        },
        field,
    ))
}

/// Which particles count.
fn particle_place(
    reader: &TableReader<'_>,
    probe: Option<&str>,
    known: &Known<'_>,
) -> Option<ParticlePlace> {
    let (population, material) = (reader.text("population"), reader.text("material"));
    let zone = reader.table("zone");
    if let Some(probe) = probe {
        let others = ["population", "material", "zone"];
        if let Some(other) = others.into_iter().find(|key| reader.has(key)) {
            reader.fail(other, "stands beside `probe`", "name one of them");
            return None;
        }
        return Some(ParticlePlace::Probe(checked_probe(reader, probe, known)?));
    }
    let zone = match zone {
        Some(table) => {
            let zone = zone_from(&table);
            table.finish();
            Some(zone?)
        }
        None => None,
    };
    if population.is_none() && material.is_none() {
        let populations = None;
        return Some(ParticlePlace::Among { populations, zone });
    }
    // Where a population could not be read, its error is told there.
    let all = known.populations?;
    let unknown = |key: &str, name: &str, others: Vec<&str>| {
        let help = format!("there are {}", others.join(", "));
        reader.fail(key, format!("is \"{name}\""), help);
    };
    let names = || all.iter().map(|one| one.name.as_str()).collect();
    if let Some(name) = population
        && !all.iter().any(|one| one.name == name)
    {
        unknown("population", name, names());
        return None;
    }
    if let Some(name) = material
        && !known.materials.iter().any(|one| one.name == name)
    {
        let others = known.materials.iter().map(|one| one.name.as_str());
        unknown("material", name, others.collect());
        return None;
    }
    let counts = |one: &Population| {
        let made = known.materials.get(one.material);
        population.is_none_or(|name| one.name == name)
            && material.is_none_or(|name| made.is_some_and(|made| made.name == name))
    };
    let own = (0u32..).zip(all).filter(|(_, one)| counts(one));
    let populations: Vec<u32> = own.map(|(index, _)| index).collect();
    if populations.is_empty() {
        let (key, help) = match population {
            Some(_) => ("material", "remove one of them"),
            None => ("material", "name a material of particles"),
        };
        reader.fail(key, "is that of no particles that are meant", help);
        return None;
    }
    let populations = Some(populations);
    Some(ParticlePlace::Among { populations, zone })
}

fn particle(reader: &TableReader<'_>, known: &Known<'_>) -> Option<(Measure, &'static str)> {
    let field = reader.choice("particle").map(|ParticleField(field)| field);
    reader.need("number");
    let number = usize::try_from(reader.whole("number")?).ok()?;
    if let Some(count) = known.populations.and_then(count)
        && number > count
    {
        reader.fail(
            "number",
            format!("is {number}, but the bed has {count} particles"),
            "particles count from 1",
        );
    }
    let field = field?;
    Some((
        Measure::Particle {
            field: field.into(),
            number,
        },
        field,
    ))
}

/// Heat from a wall of a temperature, or from all parts of one of several shapes.
fn wall_heat(reader: &TableReader<'_>, known: &Known<'_>) -> Option<(Measure, &'static str)> {
    let name = reader.text("wall_heat")?;
    let warm = known.walls.iter().filter(|(_, kelvin)| kelvin.is_some());
    let names: Vec<&str> = warm.map(|(wall, _)| wall.name.as_str()).collect();
    if name != SURROUNDINGS && !names.iter().any(|own| belongs(own, name)) {
        let help = match names[..] {
            [] => "give a wall of [[walls]] a temperature".into(),
            _ => format!("walls of a temperature are {}", names.join(", ")),
        };
        let rule = format!("is \"{name}\", which is no wall of a temperature");
        reader.fail("wall_heat", rule, help);
    }
    Some((Measure::WallHeat { wall: name.into() }, "wall_heat"))
}

fn surface_angle(reader: &TableReader<'_>, known: &Known<'_>) -> Option<(Measure, &'static str)> {
    let table = reader.table("surface_angle")?;
    let point = table.vector("point");
    let axis = direction(&table, "axis");
    table.finish();
    let (point, axis) = (Vec3::from(point?), axis?);
    let down = known.gravity?.try_normalize(0.0);
    if down.is_none_or(|down| down.cross(&axis).norm() < 1e-3) {
        let help = "state `gas.gravity` across the axis; it says what is below";
        reader.fail(
            "surface_angle",
            "has an axis that gravity does not cross",
            help,
        );
    }
    let down = down?;
    Some((Measure::SurfaceAngle { point, axis, down }, "angle"))
}

/// The statistic, or the one that is meant where none is named: on a probe, which may be a single point, the mean.
fn statistic(reader: &TableReader<'_>, unstated: Option<Statistic>) -> Option<Statistic> {
    if unstated.is_some() && !reader.has("statistic") {
        return unstated;
    }
    reader.need("statistic");
    reader.choice("statistic")
}

/// Number of particles, where the case alone knows it.
fn count(populations: &[Population]) -> Option<usize> {
    populations
        .iter()
        .try_fold(0usize, |sum, population| match &population.place {
            PlacementSpec::Grid { counts, .. } => sum.checked_add(counts.iter().product()),
            _ => None,
        })
}
