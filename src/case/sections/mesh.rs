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
    let made = match (section.has("box"), section.has("polymesh")) {
        (true, false) => cuboid(&section),
        (false, true) => polymesh(&section, folder),
        _ => {
            if section.has("cylinder") {
                section.fail(
                    "cylinder",
                    "is not supported yet",
                    "use `mesh.box` or `mesh.polymesh`",
                );
            } else {
                root.fail(
                    "mesh",
                    "needs exactly one of `box` and `polymesh`",
                    "for example box = { size = \"10 10 110 mm\", cells = [1, 1, 11] }",
                );
            }
            None
        }
    };
    section.finish();
    made
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
