//! `[materials]`, `[[contacts]]`, `[[particles]]`.

use std::path::Path;

use calcine_coupler::physics::Vec3;

use super::existing;
use crate::case::model::{Contact, Material, MeshSpec, Motion, Place, Population};
use crate::case::table::Reader;
use crate::case::units::{Dimension, shown};

/// Most particles of a grid.
const MOST_PARTICLES: f64 = 1e9;

pub(super) fn materials(root: &Reader<'_>) -> Vec<Material> {
    let example = "[materials.glass] with density = \"2500 kg/m^3\"";
    let Some(section) = root.required_table("materials", example) else {
        return Vec::new();
    };
    section
        .named()
        .into_iter()
        .map(|(name, table)| material(name, &table))
        .collect()
}

fn material(name: String, table: &Reader<'_>) -> Material {
    // A value that could not be read is recorded as an error; its stand-in is never used.
    let positive = |key, dimension| table.required_positive(key, dimension).unwrap_or(f64::NAN);
    let made = Material {
        name,
        density: positive("density", Dimension::DENSITY),
        heat_capacity: positive("heat_capacity", Dimension::HEAT_CAPACITY),
        conductivity: table.positive("conductivity", Dimension::CONDUCTIVITY),
        young: table.positive("young", Dimension::PRESSURE),
        poisson: table.quantity("poisson", Dimension::NONE),
    };
    if made
        .poisson
        .is_some_and(|poisson| !(-1.0..=0.5).contains(&poisson))
    {
        table.fail(
            "poisson",
            "is out of range",
            "Poisson's ratio lies between -1 and 0.5",
        );
    }
    table.finish();
    made
}

pub(super) fn contacts(root: &Reader<'_>, materials: &[Material]) -> Vec<Contact> {
    root.tables("contacts")
        .iter()
        .filter_map(|table| {
            let between = table.texts("between");
            if between.is_none() && !table.has("between") {
                table.missing("between", "[\"glass\", \"glass\"]");
            }
            let restitution = table.quantity("restitution", Dimension::NONE);
            let friction = table.quantity("friction", Dimension::NONE);
            if restitution.is_some_and(|e| !(e > 0.0 && e <= 1.0)) {
                table.fail(
                    "restitution",
                    "is out of range",
                    "it lies above 0 and up to 1",
                );
            }
            if friction.is_some_and(|mu| mu < 0.0) {
                table.fail("friction", "is negative", "it is zero or above");
            }
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
            Some(Contact {
                between: pair?,
                restitution,
                friction,
            })
        })
        .collect()
}

pub(super) fn populations(
    root: &Reader<'_>,
    materials: &[Material],
    mesh: Option<&MeshSpec>,
    folder: &Path,
) -> Option<Vec<Population>> {
    let tables = root.tables("particles");
    if tables.is_empty() && root.raw("particles").is_none() {
        root.missing("particles", "a list: [[particles]] with name = \"beads\"");
    }
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
    table: &Reader<'_>,
    materials: &[Material],
    mesh: Option<&MeshSpec>,
    folder: &Path,
) -> Option<Population> {
    let name = table.required_text("name", "\"beads\"");
    let material = table
        .required_text("material", "\"glass\"")
        .and_then(|name| {
            let found = materials.iter().position(|material| material.name == name);
            if found.is_none() {
                let known: Vec<&str> = materials
                    .iter()
                    .map(|material| material.name.as_str())
                    .collect();
                table.fail(
                    "material",
                    format!("is \"{name}\""),
                    format!("the materials are {}", known.join(", ")),
                );
            }
            found
        });
    let diameter = table.required_positive("diameter", Dimension::LENGTH);
    let motion = table.required_choice("motion", &[("frozen", Motion::Frozen)]);
    let temperature = table.required_positive("temperature", Dimension::TEMPERATURE);
    let place = table
        .required_table("place", "place = { grid = { first = \"5 5 5 mm\", spacing = \"10 10 10 mm\", counts = [1, 1, 10] } }")
        .and_then(|place| {
            let made = placed(&place, diameter, mesh, folder);
            place.finish();
            made
        });
    table.finish();
    Some(Population {
        name: name?.into(),
        material: material?,
        diameter: diameter?,
        motion: motion?,
        place: place?,
        temperature: temperature?,
    })
}

fn placed(
    place: &Reader<'_>,
    diameter: Option<f64>,
    mesh: Option<&MeshSpec>,
    folder: &Path,
) -> Option<Place> {
    let kinds = ["grid", "file", "packing"];
    let given: Vec<&str> = kinds.into_iter().filter(|kind| place.has(kind)).collect();
    match given[..] {
        ["grid"] => grid(&place.table("grid")?, diameter, mesh),
        ["file"] => existing(place, "file", folder).map(Place::File),
        ["packing"] => random(place, diameter, mesh),
        _ => {
            place.fail_whole("needs exactly one of grid, file and packing", "for example grid = { first = \"5 5 5 mm\", spacing = \"10 10 10 mm\", counts = [1, 1, 10] }");
            None
        }
    }
}

fn random(place: &Reader<'_>, diameter: Option<f64>, mesh: Option<&MeshSpec>) -> Option<Place> {
    let kind = place.required_choice("packing", &[("random", ())]);
    let height = place.required_positive("height", Dimension::LENGTH);
    if !place.has("solid_fraction") {
        place.missing("solid_fraction", "0.58");
    }
    let solid_fraction = place.quantity("solid_fraction", Dimension::NONE);
    if !place.has("seed") {
        place.missing("seed", "1");
    }
    let seed = place.whole("seed", 0..=i64::MAX);
    kind?;
    let (height, solid_fraction, seed) = (height?, solid_fraction?, seed?);
    if !(solid_fraction > 0.0 && solid_fraction < 0.74) {
        place.fail(
            "solid_fraction",
            format!("is {solid_fraction}"),
            "it lies between 0 and 0.74, the densest stacking",
        );
        return None;
    }
    let length = match mesh? {
        MeshSpec::Box { size, .. } => size.z,
        MeshSpec::Cylinder { length, .. } => *length,
        MeshSpec::PolyMesh(_) => {
            place.fail(
                "packing",
                "needs a box or a cylinder as mesh",
                "use `file`, or another mesh",
            );
            return None;
        }
    };
    if height > length || diameter.is_some_and(|diameter| height < diameter) {
        let rule = format!("is {} m", shown(height));
        let help = format!(
            "it lies between the diameter and the mesh's {} m",
            shown(length)
        );
        place.fail("height", rule, help);
        return None;
    }
    Some(Place::Random {
        height,
        solid_fraction,
        seed,
    })
}

fn grid(grid: &Reader<'_>, diameter: Option<f64>, mesh: Option<&MeshSpec>) -> Option<Place> {
    let first = grid.required_vector("first", Dimension::LENGTH);
    let spacing = grid.required_vector("spacing", Dimension::LENGTH);
    let counts = grid.wholes::<3>("counts");
    grid.finish();
    let (first, spacing, counts) = (Vec3::from(first?), Vec3::from(spacing?), counts?);
    let diameter = diameter?;
    if counts.iter().map(|&n| n as f64).product::<f64>() > MOST_PARTICLES {
        let rule = format!(
            "makes {} x {} x {} particles",
            counts[0], counts[1], counts[2]
        );
        grid.fail("counts", rule, "1e9 particles are the most");
        return None;
    }
    for axis in 0..3 {
        // Touching spheres are fine; 1e-9 is round-off of the units.
        if counts[axis] > 1 && spacing[axis] < diameter * (1.0 - 1e-9) {
            let rule = format!(
                "is {} m along {}, less than the diameter of {} m",
                shown(spacing[axis]),
                ["x", "y", "z"][axis],
                shown(diameter)
            );
            grid.fail("spacing", rule, "particles must not overlap");
        }
    }
    if let Some(MeshSpec::Box { origin, size, .. }) = mesh {
        for axis in 0..3 {
            let last = first[axis] + spacing[axis] * (counts[axis] - 1) as f64;
            let (low, high) = (origin[axis], origin[axis] + size[axis]);
            if first[axis] < low || last > high {
                let rule = format!(
                    "puts centres from {} m to {} m along {}, but the mesh reaches from {} m to {} m",
                    shown(first[axis]),
                    shown(last),
                    ["x", "y", "z"][axis],
                    shown(low),
                    shown(high)
                );
                grid.fail_whole(&rule, "move the particles, or enlarge the mesh");
            }
        }
    }
    Some(Place::Grid {
        first,
        spacing,
        counts,
    })
}
