//! `particles.place.packing`: what a packing fills, and how.

use calcine_coupler::mesh::zone::Zone;
use calcine_coupler::packing::Sizes;
use calcine_coupler::physics::Vec3;

use super::zone::zone_of;
use crate::case::model::{MeshSpec, PackingSection, PackingSpace, PlacementSpec, RandomAmount};
use crate::case::table::TableReader;
use crate::case::units::shown;
use crate::case::words::PackingName;

/// Touching spheres are fine; this share of a length is round-off of the units.
const ROUND_OFF: f64 = 1e-9;

/// A packing from wall to wall of a generated mesh, or in a region of any mesh.
pub(super) fn packing(
    place: &TableReader<'_>,
    sizes: Option<&Sizes>,
    mesh: Option<&MeshSpec>,
) -> Option<PlacementSpec> {
    let lattice = place.choice("packing");
    let space = space(place, sizes, mesh);
    let PackingName(lattice) = lattice?;
    let Some(lattice) = lattice else {
        return random(place, space);
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
        space: space?,
    })
}

fn random(place: &TableReader<'_>, space: Option<PackingSpace>) -> Option<PlacementSpec> {
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
    let (space, seed) = (space?, seed?);
    Some(PlacementSpec::Random {
        space,
        amount,
        seed,
    })
}

/// What a packing fills: a layer of a generated mesh, from wall to wall, or a box or a cylinder within any mesh.
fn space(
    place: &TableReader<'_>,
    sizes: Option<&Sizes>,
    mesh: Option<&MeshSpec>,
) -> Option<PackingSpace> {
    let height = place.number("height");
    let region = match place.has("region") {
        true => Some(place.table("region")?),
        false => None,
    };
    let space = match (place.has("height"), &region) {
        (false, Some(region)) if has_any(region, ["box", "cylinder"]) => {
            of_region(region, sizes, mesh)
        }
        (false, Some(region)) => {
            region.need("from");
            region.need("to");
            let ends = [region.number("from"), region.number("to")];
            layer(place, "region", sizes, mesh, |_| Some([ends[0]?, ends[1]?]))
        }
        (true, None) => layer(place, "height", sizes, mesh, |low| {
            Some([low, low + height?])
        }),
        (_, region) => {
            if let Some(region) = region {
                let _heights = [region.number("from"), region.number("to")];
            }
            let rule = "needs exactly one of height and region with a packing";
            place.fail_whole(rule, "for example height = \"145 mm\"");
            None
        }
    };
    if let Some(region) = region {
        region.finish();
    }
    space
}

fn has_any(table: &TableReader<'_>, keys: [&str; 2]) -> bool {
    keys.iter().any(|key| table.has(key))
}

/// The layer of a generated mesh between two heights.
fn layer(
    place: &TableReader<'_>,
    key: &str,
    sizes: Option<&Sizes>,
    mesh: Option<&MeshSpec>,
    ends: impl FnOnce(f64) -> Option<[f64; 2]>,
) -> Option<PackingSpace> {
    let (origin, section, length) = match mesh? {
        MeshSpec::Box { origin, size, .. } => {
            let section = PackingSection::Rectangle([size.x, size.y]);
            (origin, section, size.z)
        }
        MeshSpec::Cylinder {
            origin,
            diameter,
            length,
            ..
        } => (origin, PackingSection::Disc(*diameter), *length),
        MeshSpec::PolyMesh(_) => {
            let rule = "is a layer from wall to wall, but the mesh is of files";
            let help =
                "write a region = { box = … } or { cylinder = … } within the mesh, or use `file`";
            place.fail(key, rule, help);
            return None;
        }
    };
    let (low, high) = (origin.z, origin.z + length);
    let [from, to] = ends(low)?;
    // Round-off of units, relative to the mesh.
    let margin = ROUND_OFF * length;
    let largest = sizes.map_or(0.0, Sizes::largest);
    if from < low - margin || to > high + margin || to - from < largest * (1.0 - ROUND_OFF) {
        let (rule, help) = match key {
            "height" => (
                format!("is {} m", shown(to - from)),
                format!(
                    "it lies between the diameter and the mesh's {} m",
                    shown(length)
                ),
            ),
            _ => (
                format!("reaches from {} m to {} m", shown(from), shown(to)),
                format!(
                    "it lies inside the mesh, which reaches from {} m to {} m, and is as high as \
                     the largest particle at least",
                    shown(low),
                    shown(high)
                ),
            ),
        };
        place.fail(key, rule, help);
        return None;
    }
    let (from, to) = (from.max(low), to.min(high));
    Some(PackingSpace {
        origin: Vec3::new(origin.x, origin.y, from),
        section,
        height: to - from,
    })
}

/// A box along the axes or an upright cylinder.
fn of_region(
    region: &TableReader<'_>,
    sizes: Option<&Sizes>,
    mesh: Option<&MeshSpec>,
) -> Option<PackingSpace> {
    if has_any(region, ["from", "to"]) {
        let _heights = [region.number("from"), region.number("to")];
        let rule = "has heights beside a shape";
        region.fail_whole(rule, "write `from` and `to`, or a `box`, or a `cylinder`");
        return None;
    }
    let kind = match (region.has("box"), region.has("cylinder")) {
        (true, true) => {
            region.fail_whole("has two shapes", "write a `box` or a `cylinder`");
            return None;
        }
        (true, false) => "box",
        _ => "cylinder",
    };
    let (space, [low, high]) = match zone_of(region, kind)? {
        Zone::Box { low, high } => {
            let size = high - low;
            let section = PackingSection::Rectangle([size.x, size.y]);
            let space = PackingSpace {
                origin: low,
                section,
                height: size.z,
            };
            (space, [low, high])
        }
        Zone::Cylinder { from, to, radius } => {
            let axis = to - from;
            if axis.xy().norm() > ROUND_OFF * axis.norm() {
                let rule = "is not upright";
                region.fail("cylinder", rule, "write ends that differ in z only");
                return None;
            }
            let origin = if axis.z > 0.0 { from } else { to };
            let reach = Vec3::new(radius, radius, 0.0);
            let space = PackingSpace {
                origin,
                section: PackingSection::Disc(2.0 * radius),
                height: axis.z.abs(),
            };
            (space, [from.inf(&to) - reach, from.sup(&to) + reach])
        }
    };
    let largest = sizes.map_or(0.0, Sizes::largest);
    let width = (high - low).min();
    if width < largest * (1.0 - ROUND_OFF) {
        let rule = format!("is {} m in its least extent", shown(width));
        let help = format!(
            "it is as wide and high as the largest particle at least, {} m",
            shown(largest)
        );
        region.fail_whole(&rule, &help);
        return None;
    }
    if let Some([first, last]) = mesh.and_then(bounds) {
        let margin = ROUND_OFF * (last - first).max();
        let outside = (0..3)
            .find(|&axis| low[axis] < first[axis] - margin || high[axis] > last[axis] + margin);
        if let Some(axis) = outside {
            let rule = format!(
                "reaches from {} m to {} m along {}, but the mesh from {} m to {} m",
                shown(low[axis]),
                shown(high[axis]),
                ["x", "y", "z"][axis],
                shown(first[axis]),
                shown(last[axis])
            );
            region.fail_whole(&rule, "move the region into the mesh");
            return None;
        }
    }
    Some(space)
}

/// Lowest and highest corner in m of a generated mesh.
fn bounds(mesh: &MeshSpec) -> Option<[Vec3; 2]> {
    match mesh {
        MeshSpec::Box { origin, size, .. } => Some([*origin, origin + size]),
        MeshSpec::Cylinder {
            origin,
            diameter,
            length,
            ..
        } => {
            let reach = Vec3::new(0.5 * diameter, 0.5 * diameter, 0.0);
            let top = origin + Vec3::new(0.0, 0.0, *length);
            Some([origin - reach, top + reach])
        }
        MeshSpec::PolyMesh(_) => None,
    }
}
