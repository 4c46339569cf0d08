//! `particles.place`: where particles are at the start.

use std::path::Path;

use calcine_coupler::packing::Sizes;
use calcine_coupler::physics::Vec3;

use super::common::existing;
use super::packing::packing;
use crate::case::model::{MeshSpec, PlacementSpec};
use crate::case::overlap::PRESSED;
use crate::case::table::TableReader;
use crate::case::units::shown;

/// Most particles of a grid.
const MOST_PARTICLES: f64 = 1e9;

pub(super) fn place(
    place: &TableReader<'_>,
    sizes: Option<&Sizes>,
    mesh: Option<&MeshSpec>,
    folder: &Path,
) -> Option<PlacementSpec> {
    match place.exactly_one()? {
        "grid" => grid(&place.table("grid")?, sizes, mesh),
        "file" => file(place, folder),
        _ => packing(place, sizes, mesh),
    }
}

fn file(place: &TableReader<'_>, folder: &Path) -> Option<PlacementSpec> {
    let path = existing(place, "file", folder);
    let timestep = place.whole("timestep");
    let kind = place.whole("type");
    Some(PlacementSpec::File {
        path: path?,
        timestep,
        kind,
    })
}

fn grid(
    grid: &TableReader<'_>,
    sizes: Option<&Sizes>,
    mesh: Option<&MeshSpec>,
) -> Option<PlacementSpec> {
    let first = grid.vector("first");
    let spacing = grid.vector("spacing");
    let counts = grid.wholes::<3>("counts");
    grid.finish();
    let (first, spacing, counts) = (Vec3::from(first?), Vec3::from(spacing?), counts?);
    let diameter = sizes?.largest();
    if counts.iter().map(|&n| n as f64).product::<f64>() > MOST_PARTICLES {
        let rule = format!(
            "makes {} x {} x {} particles",
            counts[0], counts[1], counts[2]
        );
        grid.fail("counts", rule, "1e9 particles are the most");
        return None;
    }
    for axis in 0..3 {
        if counts[axis] > 1 && spacing[axis] < diameter * (1.0 - PRESSED) {
            let rule = format!(
                "is {} m along {}, more than 5 % less than the diameter of {} m",
                shown(spacing[axis]),
                ["x", "y", "z"][axis],
                shown(diameter)
            );
            grid.fail(
                "spacing",
                rule,
                "spheres pressed together overlap by 5 % of their diameter at most",
            );
            // One value may stand for all three.
            break;
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
    Some(PlacementSpec::Grid {
        first,
        spacing,
        counts,
    })
}
