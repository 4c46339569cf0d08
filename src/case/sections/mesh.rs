//! `[mesh]`.

use std::path::Path;

use calcine_coupler::physics::Vec3;

use super::existing;
use crate::case::model::MeshSpec;
use crate::case::table::Reader;
use crate::case::units::Dimension;

/// Patch names of x−, x+, y−, y+, z−, z+ where the case names none.
const PATCHES: [&str; 6] = ["side", "side", "side", "side", "bottom", "top"];
/// Most cells that 32-bit numbers hold.
const MOST_CELLS: f64 = 2e9;

pub(super) fn read(root: &Reader<'_>, folder: &Path) -> Option<MeshSpec> {
    let section = root.required_table(
        "mesh",
        "[mesh] with box = { size = \"10 10 110 mm\", cells = [1, 1, 11] }",
    )?;
    let kinds = ["box", "cylinder", "polymesh"];
    let given: Vec<&str> = kinds.into_iter().filter(|kind| section.has(kind)).collect();
    let made = match given[..] {
        ["box"] => cuboid(&section),
        ["cylinder"] => cylinder(&section),
        ["polymesh"] => polymesh(&section, folder),
        _ => {
            root.fail(
                "mesh",
                "needs exactly one of `box`, `cylinder` and `polymesh`",
                "for example box = { size = \"10 10 110 mm\", cells = [1, 1, 11] }",
            );
            None
        }
    };
    section.finish();
    made
}

fn cylinder(section: &Reader<'_>) -> Option<MeshSpec> {
    let cylinder = section.table("cylinder")?;
    let origin = cylinder
        .vector("origin", Dimension::LENGTH)
        .unwrap_or([0.0; 3]);
    let diameter = cylinder.required_positive("diameter", Dimension::LENGTH);
    let length = cylinder.required_positive("length", Dimension::LENGTH);
    let cells = cylinder.wholes::<2>("cells");
    cylinder.finish();
    let (diameter, length, cells) = (diameter?, length?, cells?);
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
    })
}

fn polymesh(section: &Reader<'_>, folder: &Path) -> Option<MeshSpec> {
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

fn cuboid(section: &Reader<'_>) -> Option<MeshSpec> {
    let cuboid = section.table("box")?;
    let origin = cuboid
        .vector("origin", Dimension::LENGTH)
        .unwrap_or([0.0; 3]);
    let size = cuboid.required_vector("size", Dimension::LENGTH);
    let cells = cuboid.wholes::<3>("cells");
    let patches = match cuboid.texts("patches") {
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
    cuboid.finish();
    let (size, cells, patches) = (size?, cells?, patches?);
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
        patches,
    })
}
