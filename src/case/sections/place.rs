//! `particles.place`: where particles are at the start.

use std::path::Path;

use calcine_coupler::packing::Sizes;
use calcine_coupler::physics::Vec3;

use super::common::existing;
use crate::case::model::{MeshSpec, PlacementSpec, RandomAmount};
use crate::case::overlap::PRESSED;
use crate::case::table::TableReader;
use crate::case::units::shown;
use crate::case::words::PackingName;

/// Most particles of a grid.
const MOST_PARTICLES: f64 = 1e9;
/// Touching spheres are fine; this share of a diameter is round-off of the units.
const ROUND_OFF: f64 = 1e-9;

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

/// A packing from wall to wall of a generated mesh.
fn packing(
    place: &TableReader<'_>,
    sizes: Option<&Sizes>,
    mesh: Option<&MeshSpec>,
) -> Option<PlacementSpec> {
    let lattice = place.choice("packing");
    let layer = layer(place, sizes, mesh);
    let PackingName(lattice) = lattice?;
    let Some(lattice) = lattice else {
        return random(place, layer);
    };
    if sizes.is_some_and(|sizes| !matches!(sizes, Sizes::Equal(_))) {
        let rule = "is a regular stacking, but the diameters differ";
        place.fail(
            "packing",
            rule,
            "write one diameter, or packing = \"random\"",
        );
        return None;
    }
    Some(PlacementSpec::Regular {
        lattice,
        layer: layer?,
    })
}

fn random(place: &TableReader<'_>, layer: Option<[f64; 2]>) -> Option<PlacementSpec> {
    let given = [place.has("solid_fraction"), place.has("number")];
    if given[0] == given[1] {
        let rule = "needs exactly one of solid_fraction and number with a random packing";
        place.fail_whole(rule, "for example solid_fraction = 0.58, or number = 2000");
    }
    let solid_fraction = place.number("solid_fraction");
    let number = place.whole("number");
    place.need("seed");
    let seed = place.whole("seed");
    let amount = match given {
        [true, false] => RandomAmount::SolidFraction(solid_fraction?),
        [false, true] => RandomAmount::Number(usize::try_from(number?).ok()?),
        _ => return None,
    };
    let (layer, seed) = (layer?, seed?);
    Some(PlacementSpec::Random {
        layer,
        amount,
        seed,
    })
}

/// Lowest and highest z of a packing in m: `height` above the bottom of the mesh, or `region`.
fn layer(
    place: &TableReader<'_>,
    sizes: Option<&Sizes>,
    mesh: Option<&MeshSpec>,
) -> Option<[f64; 2]> {
    let given = [place.has("height"), place.has("region")];
    let height = place.number("height");
    let region = if given[1] {
        place.table("region")
    } else {
        None
    };
    let ends = region.map(|region| {
        let from = region.number("from");
        let to = region.number("to");
        region.finish();
        from.zip(to)
    });
    let (low, high) = match mesh? {
        MeshSpec::Box { origin, size, .. } => (origin.z, origin.z + size.z),
        MeshSpec::Cylinder { origin, length, .. } => (origin.z, origin.z + length),
        MeshSpec::PolyMesh(_) => {
            place.fail(
                "packing",
                "needs a box or a cylinder as mesh",
                "use `file`, or another mesh",
            );
            return None;
        }
    };
    let largest = sizes.map_or(0.0, Sizes::largest);
    match given {
        [true, false] => {
            let height = height?;
            if height > high - low || height < largest * (1.0 - ROUND_OFF) {
                let rule = format!("is {} m", shown(height));
                let help = format!(
                    "it lies between the diameter and the mesh's {} m",
                    shown(high - low)
                );
                place.fail("height", rule, help);
                return None;
            }
            Some([low, low + height])
        }
        [false, true] => {
            let (from, to) = ends??;
            // Round-off of units, relative to the mesh.
            let margin = ROUND_OFF * (high - low);
            if from < low - margin || to > high + margin || to - from < largest * (1.0 - ROUND_OFF)
            {
                let rule = format!("reaches from {} m to {} m", shown(from), shown(to));
                let help = format!(
                    "it lies inside the mesh, which reaches from {} m to {} m, and is as high as \
                     the largest particle at least",
                    shown(low),
                    shown(high)
                );
                place.fail("region", rule, help);
                return None;
            }
            Some([from.max(low), to.min(high)])
        }
        _ => {
            let rule = "needs exactly one of height and region with a packing";
            place.fail_whole(rule, "for example height = \"145 mm\"");
            None
        }
    }
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
