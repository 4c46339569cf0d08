//! `[mesh]`.

use std::path::Path;

use calcine_coupler::mesh::grading::Stretch;
use calcine_coupler::physics::Vec3;
use toml_edit::Value;

use super::common::existing;
use super::zone::{cuts, openings, refinements};
use crate::case::model::MeshSpec;
use crate::case::table::TableReader;

/// Patch names of x−, x+, y−, y+, z−, z+ where the case names none.
const PATCHES: [&str; 6] = ["side", "side", "side", "side", "bottom", "top"];
/// Most cells that 32-bit numbers hold.
const MOST_CELLS: f64 = 2e9;

pub(super) fn read(root: &TableReader<'_>, folder: &Path) -> Option<MeshSpec> {
    let section = root.table("mesh")?;
    let made = match section.exactly_one() {
        Some("box") => cuboid(&section),
        Some("cylinder") => cylinder(&section),
        Some(_) => polymesh(&section, folder),
        None => None,
    };
    section.finish();
    made
}

fn cylinder(section: &TableReader<'_>) -> Option<MeshSpec> {
    let cylinder = section.table("cylinder")?;
    let origin = cylinder.vector("origin").unwrap_or([0.0; 3]);
    let diameter = cylinder.number("diameter");
    let length = cylinder.number("length");
    let cells = cylinder.wholes::<2>("cells");
    let grading = gradings(&cylinder, ["z"], cells.map(|cells| [cells[1]]));
    let refine = refinements(&cylinder);
    let sides = ["side", "bottom", "top"].map(String::from);
    let cut = cuts(&cylinder, &sides);
    let openings = openings(&cylinder, &sides);
    cylinder.finish();
    let (diameter, length, cells, [grading]) = (diameter?, length?, cells?, grading?);
    if !(3..=20_000).contains(&cells[0])
        || cells[0] as f64 * cells[0] as f64 * cells[1] as f64 > MOST_CELLS
    {
        let rule = format!("makes {} cells across and {} along", cells[0], cells[1]);
        cylinder.fail("cells", rule, "3 to 20000 across, and 2e9 in all at most");
        return None;
    }
    Some(MeshSpec::Cylinder {
        origin: Vec3::from(origin),
        diameter,
        length,
        cells,
        grading,
        refine,
        cut,
        openings,
    })
}

fn polymesh(section: &TableReader<'_>, folder: &Path) -> Option<MeshSpec> {
    let path = existing(section, "polymesh", folder)?;
    if path.join("owner").is_file() {
        return Some(MeshSpec::PolyMesh(path));
    }
    section.fail(
        "polymesh",
        format!("names {}, which holds no file `owner`", path.display()),
        "name the folder constant/polyMesh of an OpenFOAM case",
    );
    None
}

fn cuboid(section: &TableReader<'_>) -> Option<MeshSpec> {
    let cuboid = section.table("box")?;
    let origin = cuboid.vector("origin").unwrap_or([0.0; 3]);
    let size = cuboid.vector("size");
    let cells = cuboid.wholes::<3>("cells");
    let grading = gradings(&cuboid, ["x", "y", "z"], cells);
    let refine = refinements(&cuboid);
    let patches = match cuboid.texts("patches") {
        // What is there and is no list has been told.
        None if cuboid.has("patches") => None,
        None => Some(PATCHES.map(String::from)),
        Some(names) => {
            let count = names.len();
            let six = <[String; 6]>::try_from(names).ok();
            if six.is_none() {
                cuboid.fail(
                    "patches",
                    format!("has {count} names"),
                    "name the patches of x-, x+, y-, y+, z-, z+; equal names make one patch",
                );
            }
            six
        }
    };
    let sides = patches.as_ref().map_or(&[][..], |six| &six[..]);
    let (cut, openings) = (cuts(&cuboid, sides), openings(&cuboid, sides));
    cuboid.finish();
    let (size, cells, grading, patches) = (size?, cells?, grading?, patches?);
    if size.iter().any(|&length| length <= 0.0) {
        cuboid.fail(
            "size",
            format!("is {} {} {} m", size[0], size[1], size[2]),
            "each length must be above zero",
        );
        return None;
    }
    if cells.iter().map(|&n| n as f64).product::<f64>() > MOST_CELLS {
        cuboid.fail(
            "cells",
            format!("makes {} x {} x {} cells", cells[0], cells[1], cells[2]),
            "2e9 cells are the most",
        );
        return None;
    }
    Some(MeshSpec::Box {
        origin: Vec3::from(origin),
        size: Vec3::from(size),
        cells,
        grading,
        refine,
        cut,
        openings,
        patches,
    })
}

/// How cell sizes change along axes; nothing for equal ones. `None` where something is wrong.
fn gradings<const N: usize>(
    mesh: &TableReader<'_>,
    axes: [&str; N],
    cells: Option<[usize; N]>,
) -> Option<[Vec<Stretch>; N]> {
    let mut all = [const { Vec::new() }; N];
    if !mesh.has("grading") {
        return Some(all);
    }
    let table = mesh.table("grading")?;
    let mut right = true;
    for (place, axis) in axes.into_iter().enumerate() {
        if table.has(axis) {
            match grading(&table, axis) {
                Some(stretches) => all[place] = stretches,
                None => right = false,
            }
            if let Some(cells) = cells
                && all[place].len() > cells[place]
            {
                let rule = format!(
                    "has {} regions, but {} cells",
                    all[place].len(),
                    cells[place]
                );
                table.fail(axis, rule, "each region needs a cell at least");
                right = false;
            }
        }
    }
    table.finish();
    right.then_some(all)
}

/// A ratio of cell sizes, or regions of [share of the length, share of the cells, ratio].
fn grading(table: &TableReader<'_>, axis: &str) -> Option<Vec<Stretch>> {
    let help = "write the ratio of the last cell to the first, such as 4, or regions of \
                [share of the length, share of the cells, ratio], such as \
                [[0.4, 0.2, 0.25], [0.6, 0.8, 1]]";
    let plain = |value: &Value| {
        let whole = value.as_integer().map(|number| number as f64);
        let number = value.as_float().or(whole);
        number.filter(|number| number.is_finite() && *number > 0.0)
    };
    let value = table.raw(axis)?.as_value();
    let regions = match value {
        Some(Value::Array(list)) => list
            .iter()
            .map(|region| {
                let numbers: Option<Vec<f64>> = region.as_array()?.iter().map(plain).collect();
                let [length_share, cell_share, expansion] = numbers?[..] else {
                    return None;
                };
                Some(Stretch {
                    length_share,
                    cell_share,
                    expansion,
                })
            })
            .collect(),
        Some(value) => plain(value).map(|expansion| {
            vec![Stretch {
                length_share: 1.0,
                cell_share: 1.0,
                expansion,
            }]
        }),
        None => None,
    };
    let regions = regions.filter(|regions: &Vec<Stretch>| !regions.is_empty());
    if regions.is_none() {
        table.fail(axis, "holds no ratios and shares above zero", help);
    }
    regions
}
