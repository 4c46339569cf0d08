//! `[materials]`, `[[contacts]]`, `[[particles]]`.

use std::path::Path;

use calcine_coupler::physics::Vec3;
use calcine_coupler::physics::conduction::Conductivity;
use calcine_coupler::physics::solid::HeatCapacity;
use calcine_coupler::physics::solids::SolidSpecies;
use calcine_coupler::physics::thermo::Nasa7;
use calcine_coupler::setup::Schedule;

use super::composition::of_solids;
use super::place::place;
use super::reactions::mixed;
use super::sizes::sizes;
use super::{conversion, radial};
use crate::case::model::{ContactSpec, Laws, MaterialSpec, MeshSpec, MotionSpec, Population};
use crate::case::table::TableReader;

pub(super) fn materials(root: &TableReader<'_>, solids: &[SolidSpecies]) -> Vec<MaterialSpec> {
    let Some(section) = root.table("materials") else {
        return Vec::new();
    };
    section
        .named()
        .into_iter()
        .map(|(name, table)| material(name, &table, solids))
        .collect()
}

fn material(name: String, table: &TableReader<'_>, solids: &[SolidSpecies]) -> MaterialSpec {
    // A value that could not be read is recorded as an error; its stand-in is never used.
    let composed = table.table("composition");
    let composition = composed.and_then(|table| of_solids(&table, solids));
    let heat_capacity = match &composition {
        Some(_) if table.has("heat_capacity") => {
            let help = "remove it: the heat capacity is that of the solids";
            table.fail("heat_capacity", "stands beside `composition`", help);
            HeatCapacity::constant(f64::NAN)
        }
        Some(fractions) => mixed(fractions, solids),
        None if table.has("composition") => HeatCapacity::constant(f64::NAN),
        None => heat_capacity(table),
    };
    if table.has("used_up") && !table.has("composition") {
        let help = "add a composition, or remove it: only what reacts is used up";
        table.fail("used_up", "stands beside no `composition`", help);
    }
    let (inside, radial) = radial::read(table, solids);
    let made = MaterialSpec {
        name,
        inside,
        radial,
        density: table.number("density").unwrap_or(f64::NAN),
        heat_capacity,
        size: conversion::read(table, solids),
        used_up: table.number("used_up").unwrap_or(f64::NAN),
        composition,
        conductivity: conductivity(table),
        emissivity: table.number("emissivity"),
        young: table.number("young"),
        real_young: table.number("real_young"),
        poisson: table.number("poisson"),
    };
    table.finish();
    made
}

/// A number, or points over temperature.
fn conductivity(table: &TableReader<'_>) -> Option<Conductivity> {
    table.curve("conductivity").map(Conductivity::table)
}

/// A number, points over temperature, or a table with NASA's polynomials.
fn heat_capacity(table: &TableReader<'_>) -> HeatCapacity {
    let points = if table.is_table("heat_capacity") {
        table.table("heat_capacity").and_then(|inner| {
            let made = polynomial(&inner);
            inner.finish();
            made
        })
    } else {
        table.need("heat_capacity");
        table.curve("heat_capacity")
    };
    let Some(points) = points else {
        return HeatCapacity::constant(f64::NAN);
    };
    if let Some((kelvin, value)) = points.iter().find(|point| point.1 <= 0.0) {
        let rule = format!("is {value} J/kg/K at {kelvin} K");
        let help = "it is above zero at all temperatures";
        table.fail("heat_capacity", rule, help);
    }
    HeatCapacity::table(points)
}

/// Highest temperature in K to which NASA fits polynomials (TP-2002-211556).
const HOTTEST: f64 = 20_000.0;

/// NASA's seven coefficients over two ranges, every few kelvin: c_p is linear in between, and the enthalpy
/// its exact integral.
fn polynomial(table: &TableReader<'_>) -> Option<Vec<(f64, f64)>> {
    const STEP: f64 = 2.0;
    let molar_mass = table.number("molar_mass");
    let ends = table.vector("ranges");
    let low = coefficients(table, "low");
    let high = coefficients(table, "high");
    let (molar_mass, ends) = (molar_mass?, ends?);
    let made = match Nasa7::new(ends, low?, high?) {
        Ok(made) => made,
        Err(error) => {
            let help = "write ranges = \"200 1000 6000 K\": lowest, common and highest temperature";
            table.fail("ranges", error.to_string(), help);
            return None;
        }
    };
    if ends[2] > HOTTEST {
        let rule = format!("reaches up to {} K, beyond {HOTTEST} K", ends[2]);
        let help = "no polynomial of NASA's goes further; write the ranges that they are fitted to";
        table.fail("ranges", rule, help);
        return None;
    }
    let range = |from: f64, to: f64| {
        let parts = ((to - from) / STEP).ceil();
        let parts_whole = parts as usize;
        (0..parts_whole).map(move |k| from + (to - from) * k as f64 / parts)
    };
    let kelvins = range(ends[0], ends[1]).chain(range(ends[1], ends[2]));
    let at = |kelvin: f64| (kelvin, made.heat_capacity(kelvin) / molar_mass);
    Some(kelvins.chain([ends[2]]).map(at).collect())
}

fn coefficients(table: &TableReader<'_>, key: &str) -> Option<[f64; 7]> {
    let numbers = table.raw(key)?.as_array().map(|array| {
        let number = |value: &toml_edit::Value| {
            let whole = value.as_integer().map(|number| number as f64);
            value.as_float().or(whole)
        };
        array.iter().map(number).collect::<Option<Vec<f64>>>()
    });
    let seven = numbers
        .flatten()
        .and_then(|numbers| <[f64; 7]>::try_from(numbers).ok());
    if seven.is_none() {
        let help = "write a1 to a7 of NASA's polynomials, for example [2.5, 0, 0, 0, 0, 0, 0]";
        table.fail(key, "is not a list of seven numbers", help);
    }
    seven
}

/// The index of the material that a table names.
pub(super) fn material_of(table: &TableReader<'_>, materials: &[MaterialSpec]) -> Option<usize> {
    let name = table.text("material")?;
    let found = materials.iter().position(|one| one.name == name);
    if found.is_none() {
        let known: Vec<&str> = materials.iter().map(|one| one.name.as_str()).collect();
        let help = match known.is_empty() {
            true => format!("the case has no materials; write a table [materials.{name}]"),
            false => format!("the materials are {}", known.join(", ")),
        };
        table.fail("material", format!("is \"{name}\""), help);
    }
    found
}

pub(super) fn contacts(root: &TableReader<'_>, materials: &[MaterialSpec]) -> Vec<ContactSpec> {
    let tables = root.tables("contacts");
    let mut pairs: Vec<[usize; 2]> = Vec::new();
    tables
        .iter()
        .filter_map(|table| {
            let between = table.texts("between");
            let number = |key| table.number(key);
            let restitution = number("restitution");
            let friction = number("friction");
            let rolling_friction = number("rolling_friction");
            let rolling_damping = number("rolling_damping");
            let cohesion_energy = number("cohesion_energy");
            let work_of_adhesion = number("work_of_adhesion");
            table.finish();
            let index = |name: &String| materials.iter().position(|other| other.name == *name);
            let pair: Option<Vec<usize>> = between?.iter().map(index).collect();
            let pair = pair.and_then(|pair| <[usize; 2]>::try_from(pair).ok());
            if pair.is_none() {
                table.fail(
                    "between",
                    "does not name two materials of the case",
                    "name two of [materials]",
                );
            }
            let pair = pair?;
            let [a, b] = pair;
            let sorted = [a.min(b), a.max(b)];
            if pairs.contains(&sorted) {
                let names = [a, b].map(|index| materials[index].name.as_str());
                let rule = format!(
                    "names \"{}\" and \"{}\", as an entry before it does",
                    names[0], names[1]
                );
                table.fail("between", rule, "state each pair of materials once");
            }
            pairs.push(sorted);
            Some(ContactSpec {
                between: pair,
                restitution,
                friction,
                rolling_friction,
                rolling_damping,
                cohesion_energy,
                work_of_adhesion,
            })
        })
        .collect()
}

pub(super) fn populations(
    root: &TableReader<'_>,
    materials: &[MaterialSpec],
    mesh: Option<&MeshSpec>,
    folder: &Path,
) -> Option<Vec<Population>> {
    let tables = root.tables("particles");
    let all: Vec<Option<Population>> = tables
        .iter()
        .map(|table| population(table, materials, mesh, folder))
        .collect();
    for (index, population) in all.iter().enumerate() {
        let Some(population) = population else {
            continue;
        };
        if all[..index]
            .iter()
            .flatten()
            .any(|other| other.name == population.name)
        {
            let rule = format!("is \"{}\" a second time", population.name);
            tables[index].fail("name", rule, "names of populations must differ");
        }
    }
    all.into_iter().collect()
}

fn population(
    table: &TableReader<'_>,
    materials: &[MaterialSpec],
    mesh: Option<&MeshSpec>,
    folder: &Path,
) -> Option<Population> {
    let name = table.text("name");
    let material = material_of(table, materials);
    let sizes = sizes(table);
    let motion = table.choice("motion");
    let velocity = table.vector("velocity");
    if velocity.is_some() && motion == Some(MotionSpec::Frozen) {
        let help = "remove it, or write motion = \"free\"";
        table.fail("velocity", "does not go with motion = \"frozen\"", help);
    }
    let (temperature, prescribed_temperature) = temperature(table);
    let weight = weight(table, motion);
    let placed = table.table("place").and_then(|reader| {
        let sizes = sizes.as_ref().map(|(sizes, _)| sizes);
        let made = place(&reader, sizes, mesh, folder);
        reader.finish();
        made
    });
    table.finish();
    let (sizes, size_seed) = sizes?;
    Some(Population {
        name: name?.into(),
        material: material?,
        sizes,
        size_seed,
        motion: motion?,
        velocity: velocity.map_or(Vec3::zeros(), Vec3::from),
        place: placed?,
        temperature: temperature?,
        prescribed_temperature,
        weight: weight?,
    })
}

/// The temperature at the start, and that of all times where it is prescribed.
fn temperature(table: &TableReader<'_>) -> (Option<f64>, Option<Schedule>) {
    match table.exactly_one() {
        Some("prescribed_temperature") => {
            let schedule = table.schedule("prescribed_temperature");
            (schedule.as_ref().map(|one| one.at(0.0)), schedule)
        }
        Some(_) => (table.number("temperature"), None),
        None => (None, None),
    }
}

/// Particles of a prescribed temperature do not react: what is set free in them would be nobody's.
pub(super) fn prescribed_fit(
    root: &TableReader<'_>,
    particles: &[Population],
    materials: &[MaterialSpec],
    reactions: usize,
) {
    for (table, population) in root.tables("particles").iter().zip(particles) {
        let material = &materials[population.material];
        let reacts = reactions > 0 && material.composition.is_some();
        if reacts && population.prescribed_temperature.is_some() {
            let rule = format!(
                "is of particles of \"{}\", which has a composition and may react",
                material.name
            );
            let help = "write `temperature`, or give them a material with `heat_capacity` in place of `composition`";
            table.fail("prescribed_temperature", rule, help);
        }
    }
}

/// The statistical weight; particles that move touch each other one by one.
fn weight(table: &TableReader<'_>, motion: Option<MotionSpec>) -> Option<f64> {
    let weight = table.number("weight")?;
    if weight != 1.0 && motion == Some(MotionSpec::Free) {
        let rule = format!("is {weight}, but the particles are free");
        let help = "leave it out: particles that touch each other stand for themselves alone";
        table.fail("weight", rule, help);
    }
    Some(weight)
}

/// Heat between particles goes from one to the next: rows that stand for several have no neighbours of their own.
pub(super) fn weights_fit(root: &TableReader<'_>, particles: &[Population], laws: &Laws) {
    if !(laws.conducts() || laws.radiation.is_some()) {
        return;
    }
    for (table, population) in root.tables("particles").iter().zip(particles) {
        if population.weight != 1.0 {
            let rule = format!(
                "is {}, but `laws.conduction` or `laws.radiation` exchanges heat between particles",
                population.weight
            );
            let help = "write `none` for both laws, or leave the weight out";
            table.fail("weight", rule, help);
        }
    }
}
