//! `[[walls]]`: what particles bounce off.

use std::path::Path;

use calcine_coupler::bodies::HeatBody;
use calcine_coupler::mesh::cut::Cut;
use calcine_coupler::mesh::surface::triangles;
use calcine_coupler::mesh::{Mesh, Patch};
use calcine_coupler::motion::{Wall, WallMotion, WallShape};
use calcine_coupler::physics::Vec3;
use calcine_coupler::setup::Schedule;

use super::bodies::of_name;
use super::common::{direction, existing, turning};
use super::heat;
use super::particles::material_of;
use crate::case::meshing::{self, MeshingError};
use crate::case::model::{MaterialSpec, MeshSpec};
use crate::case::stl;
use crate::case::table::TableReader;

/// Most numbers of triangles that are named.
const MOST: usize = 5;

/// What the section says.
pub(super) struct WallsRead {
    /// All walls with their temperatures; those of bodies with that of the start.
    pub walls: Vec<(Wall, Option<Schedule>)>,
    /// The body of each.
    pub bodies: Vec<Option<usize>>,
    /// What of their files is left out.
    pub left_out: Vec<String>,
}

/// All walls.
pub(super) fn walls(
    root: &TableReader<'_>,
    materials: &[MaterialSpec],
    mesh: Option<&MeshSpec>,
    folder: &Path,
    bodies: &[HeatBody],
) -> WallsRead {
    let mut of_bodies = Vec::new();
    let mut all: Vec<(Wall, Option<Schedule>)> = Vec::new();
    let mut left_out = Vec::new();
    for table in root.tables("walls") {
        let name = table.text("name");
        let material = material_of(&table, materials);
        let shapes = shapes(&table, mesh, folder, &mut left_out);
        let motion = motion(&table);
        let (temperature, body) = warmth(&table, bodies);
        table.finish();
        let (Some(name), Some(material), Some(shapes)) = (name, material, shapes) else {
            continue;
        };
        let several = shapes.len() > 1;
        for (part, shape) in shapes {
            let name = match several {
                true => format!("{name}.{part}"),
                false => name.to_owned(),
            };
            if temperature.is_some() {
                heat::stays(&table, &shape, &motion);
            }
            if all.iter().any(|(other, _)| other.name == name) {
                let rule = format!("is \"{name}\" a second time");
                table.fail("name", rule, "names of walls must differ");
            }
            let wall = Wall {
                name,
                material,
                shape,
                motion: motion.clone(),
            };
            all.push((wall, temperature.clone()));
            of_bodies.push(body);
        }
    }
    WallsRead {
        walls: all,
        bodies: of_bodies,
        left_out,
    }
}

/// The temperature of a wall, and the body that it is of.
fn warmth(table: &TableReader<'_>, bodies: &[HeatBody]) -> (Option<Schedule>, Option<usize>) {
    let temperature = table.schedule("temperature");
    if !table.has("body") {
        return (temperature, None);
    }
    if table.has("temperature") {
        let help = "remove one of the two: the wall has the temperature of its body";
        table.fail("temperature", "stands beside `body`", help);
    }
    let name = table.text("body");
    let body = name.and_then(|name| of_name(table, name, bodies));
    let start = body.map(|body| Schedule::constant(bodies[body].temperature));
    (start, body)
}

/// What is left out of a file: the first numbers of its triangles without area.
fn without_area(path: &Path, flat: &[usize]) -> String {
    let first: Vec<String> = flat.iter().take(MOST).map(usize::to_string).collect();
    let more = match flat.len().saturating_sub(MOST) {
        0 => String::new(),
        more => format!(" and {more} more"),
    };
    let triangles = if flat.len() == 1 {
        "triangle"
    } else {
        "triangles"
    };
    format!(
        "{}: {triangles} {}{more} without area, left out; mend the surface if particles could pass there",
        path.display(),
        first.join(", ")
    )
}

/// The shapes of one entry, with the part of the mesh that each is.
fn shapes(
    table: &TableReader<'_>,
    mesh: Option<&MeshSpec>,
    folder: &Path,
    left_out: &mut Vec<String>,
) -> Option<Vec<(String, WallShape)>> {
    let scale = table.number("scale");
    let kind = table.exactly_one()?;
    if table.has("scale") && kind != "stl" {
        table.fail("scale", "goes with `stl` only", "remove it");
    }
    match kind {
        "plane" => plane(&table.table("plane")?).map(|shape| vec![(String::new(), shape)]),
        "cylinder" => cylinder(&table.table("cylinder")?).map(|shape| vec![(String::new(), shape)]),
        "cone" => cone(&table.table("cone")?).map(|shape| vec![(String::new(), shape)]),
        "stl" => {
            let path = existing(table, "stl", folder)?;
            match stl::read(&path, scale?) {
                Ok(stl) => {
                    if !stl.flat.is_empty() {
                        left_out.push(without_area(&path, &stl.flat));
                    }
                    let triangles = stl.triangles;
                    Some(vec![(String::new(), WallShape::Mesh { triangles })])
                }
                Err(error) => {
                    table.fail(
                        "stl",
                        error.to_string(),
                        "name an STL file, ASCII or binary",
                    );
                    None
                }
            }
        }
        _ => of_mesh(table, mesh),
    }
}

fn plane(table: &TableReader<'_>) -> Option<WallShape> {
    let point = table.vector("point");
    let normal = direction(table, "normal");
    table.finish();
    Some(WallShape::Plane {
        point: point?.into(),
        normal: normal?,
    })
}

fn cylinder(table: &TableReader<'_>) -> Option<WallShape> {
    let point = table.vector("point");
    let axis = direction(table, "axis");
    let radius = table.number("radius");
    table.finish();
    Some(WallShape::Cylinder {
        point: point?.into(),
        axis: axis?,
        radius: radius?,
    })
}

fn cone(table: &TableReader<'_>) -> Option<WallShape> {
    let from = table.vector("from");
    let to = table.vector("to");
    let low = table.number("from_radius");
    let high = table.number("to_radius");
    table.finish();
    let ends: [Vec3; 2] = [from?.into(), to?.into()];
    let radii = [low?, high?];
    if ends[0] == ends[1] || radii.iter().any(|radius| *radius < 0.0) {
        let help = "the ends of its axis differ, and no radius is negative";
        table.fail_whole("is no frustum of a cone", help);
        return None;
    }
    Some(WallShape::Cone { ends, radii })
}

/// The parts of the mesh's boundary that carry one of the named patches: sides of a generated mesh, triangles of bodies
/// that are cut out of it and of a mesh of files.
fn of_mesh(table: &TableReader<'_>, mesh: Option<&MeshSpec>) -> Option<Vec<(String, WallShape)>> {
    let wanted = table.texts("patches")?;
    if wanted.is_empty() {
        let help = "name patches of the mesh, or remove the wall";
        table.fail("patches", "names no patch", help);
        return None;
    }
    let parts = match parts(mesh?) {
        Ok(parts) => parts,
        Err(error) => {
            table.fail(
                "patches",
                format!("names parts of a mesh: {error}"),
                "write a mesh that can be read",
            );
            return None;
        }
    };
    let unknown = wanted
        .iter()
        .find(|name| !parts.iter().any(|(patch, ..)| patch == *name));
    if let Some(name) = unknown {
        let mut known: Vec<&str> = parts.iter().map(|(patch, ..)| patch.as_str()).collect();
        known.sort_unstable();
        known.dedup();
        let rule = format!("names \"{name}\", which is no patch of the mesh");
        table.fail(
            "patches",
            rule,
            format!("its patches are {}", known.join(", ")),
        );
        return None;
    }
    let chosen = parts
        .into_iter()
        .filter(|(patch, ..)| wanted.contains(patch));
    Some(chosen.map(|(_, part, shape)| (part, shape)).collect())
}

/// Patch, name and shape of each side of a generated mesh, the round side of a cylinder is the circle of its diameter; patches of
/// a mesh of files.
fn parts(mesh: &MeshSpec) -> Result<Vec<(String, String, WallShape)>, MeshingError> {
    let plane = |point: Vec3, normal: Vec3| WallShape::Plane { point, normal };
    match mesh {
        MeshSpec::Box {
            origin,
            size,
            patches,
            cut,
            ..
        } => {
            let names = ["x-", "x+", "y-", "y+", "z-", "z+"];
            let side = |index: usize| {
                let mut inward = Vec3::zeros();
                inward[index / 2] = if index.is_multiple_of(2) { 1.0 } else { -1.0 };
                let corner = if index.is_multiple_of(2) {
                    *origin
                } else {
                    origin + size
                };
                let name = names[index].to_owned();
                (patches[index].clone(), name, plane(corner, inward))
            };
            let mut all: Vec<_> = (0..6).map(side).collect();
            all.extend(of_bodies(mesh, cut)?);
            Ok(all)
        }
        MeshSpec::Cylinder {
            origin,
            diameter,
            length,
            cut,
            ..
        } => {
            let round = WallShape::Cylinder {
                point: *origin,
                axis: Vec3::z(),
                radius: 0.5 * diameter,
            };
            let top = origin + *length * Vec3::z();
            let sides = [
                ("side", round),
                ("bottom", plane(*origin, Vec3::z())),
                ("top", plane(top, -Vec3::z())),
            ];
            let named = sides.map(|(name, shape)| (name.to_owned(), name.to_owned(), shape));
            let mut all = Vec::from(named);
            all.extend(of_bodies(mesh, cut)?);
            Ok(all)
        }
        MeshSpec::PolyMesh(_) => {
            let mesh = meshing::mesh(mesh)?;
            let patches = mesh.patches().iter();
            Ok(patches.map(|patch| part_of(&mesh, patch)).collect())
        }
    }
}

/// The surfaces of bodies that are cut out of a generated mesh.
fn of_bodies(
    spec: &MeshSpec,
    cut: &[Cut],
) -> Result<Vec<(String, String, WallShape)>, MeshingError> {
    if cut.is_empty() {
        return Ok(Vec::new());
    }
    let mesh = meshing::mesh(spec)?;
    let own = |patch: &&Patch| cut.iter().any(|body| body.name == patch.name);
    let patches = mesh.patches().iter().filter(own);
    Ok(patches.map(|patch| part_of(&mesh, patch)).collect())
}

/// A patch of a mesh as triangles.
fn part_of(mesh: &Mesh, patch: &Patch) -> (String, String, WallShape) {
    let triangles = triangles(mesh, patch);
    let name = patch.name.clone();
    (name.clone(), name, WallShape::Mesh { triangles })
}

fn motion(table: &TableReader<'_>) -> WallMotion {
    let translating = table.vector("velocity").map(Vec3::from);
    let rotating = table.table("rotating").and_then(|rotating| {
        let (point, angular_velocity) = turning(&rotating)?;
        Some(WallMotion::Rotating {
            point,
            angular_velocity,
        })
    });
    let moved = table.table("moved").and_then(|moved| {
        let direction = direction(&moved, "direction");
        let distance = moved.schedule("distance");
        if distance
            .as_ref()
            .is_some_and(|distance| distance.at(0.0) != 0.0)
        {
            let help = "begin with a distance of 0: the wall starts where its shape is stated";
            moved.fail("distance", "is not 0 at the start of the run", help);
        }
        moved.finish();
        Some(WallMotion::Scheduled {
            direction: direction?,
            distance: distance?.0,
        })
    });
    let oscillating = table.table("oscillating").and_then(|oscillating| {
        let amplitude = oscillating.vector("amplitude");
        let period = oscillating.number("period");
        oscillating.finish();
        Some(WallMotion::Oscillating {
            amplitude: amplitude?.into(),
            period: period?,
        })
    });
    let servo = table.table("servo").and_then(|table| servo(&table));
    let translating = translating.map(WallMotion::Translating);
    let mut stated = [translating, rotating, moved, oscillating, servo]
        .into_iter()
        .flatten();
    let first = stated.next();
    if stated.next().is_some() {
        let rule = "has several of `velocity`, `rotating`, `moved`, `oscillating` and `servo`";
        table.fail_whole(rule, "write one of them");
    }
    first.unwrap_or_default()
}

fn servo(table: &TableReader<'_>) -> Option<WallMotion> {
    let direction = direction(table, "direction");
    let kind = table.exactly_one();
    let [force, pressure, area] = ["force", "pressure", "area"].map(|key| table.number(key));
    let (mass, damping) = (table.number("mass"), table.number("damping"));
    if kind == Some("pressure") && area.is_none() {
        table.fail(
            "pressure",
            "stands without `area`",
            "write the area over which it presses",
        );
    }
    if kind == Some("force") && area.is_some() {
        table.fail("area", "goes with `pressure` only", "remove it");
    }
    table.finish();
    let force = match kind? {
        "force" => force?,
        _ => pressure? * area?,
    };
    Some(WallMotion::Servo {
        direction: direction?,
        force,
        mass: mass?,
        damping: damping?,
    })
}
