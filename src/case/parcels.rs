//! From the sections of a case to what the solver of parcels is told.

use calcine_coupler::mesh::Mesh;
use calcine_coupler::motion::{Motion, Wall, WallMotion, WallShape};
use calcine_coupler::parcels::{ParcelImpact, ParcelMotion, ParcelResistance, ParcelWall};
use calcine_coupler::physics::Vec3;
use calcine_coupler::setup::ParticleSetup;
use calcine_native::particles::dem::{distance_to_shape, distance_to_triangle};

use super::contacts;
use super::model::{Case, ContactSpec, ParcelSpec, belongs};
use super::parcel_wall_error::ParcelWallError;
use super::place_error::PlaceError;

/// How the particles of a case move, on the motion clock.
pub fn motion_of(case: &Case, mesh: &Mesh, setup: &ParticleSetup) -> Result<Motion, PlaceError> {
    let spec = case
        .motion
        .as_ref()
        .and_then(|motion| motion.parcels.as_ref());
    match spec {
        Some(spec) => Ok(motion(case, spec, mesh)?),
        None => Ok(contacts::motion(case, mesh, setup)?),
    }
}

/// How the parcels of a case move: each patch rebounds them as the wall that lies at it.
fn motion(case: &Case, spec: &ParcelSpec, mesh: &Mesh) -> Result<Motion, ParcelWallError> {
    let patches = mesh.patches().iter();
    let bounding = patches.filter(|patch| patch.count > 0 && mesh.partner(patch).is_none());
    let walls = bounding.map(|patch| {
        let mut found: Option<&Wall> = None;
        for face in patch.faces() {
            let wall = nearest(case, mesh, face).ok_or_else(|| ParcelWallError::None {
                patch: patch.name.clone(),
            })?;
            if let Some(other) = found.filter(|other| !alike(other, wall)) {
                return Err(ParcelWallError::Several {
                    patch: patch.name.clone(),
                    one: other.name.clone(),
                    other: wall.name.clone(),
                });
            }
            found = Some(wall);
        }
        let wall = found.ok_or_else(|| ParcelWallError::None {
            patch: patch.name.clone(),
        })?;
        if let WallMotion::Scheduled { .. } | WallMotion::Oscillating { .. } = wall.motion {
            let wall = wall.name.clone();
            return Err(ParcelWallError::Moves { wall });
        }
        Ok(ParcelWall {
            patch: patch.name.clone(),
            motion: wall.motion.clone(),
            impact: impacts(case, wall)?,
        })
    });
    Ok(Motion::Parcels(Box::new(ParcelMotion {
        gravity: case.gas.gravity,
        courant: spec.courant,
        most_steps: spec.most_steps,
        walls: walls.collect::<Result<_, _>>()?,
        packing: spec.packing,
        collisions: spec.collisions,
        friction: spec.friction,
        resistance: spec
            .resistance
            .as_ref()
            .map(|(rate, wall)| resistance(case, *rate, wall))
            .transpose()?,
    })))
}

/// The resistance of a rate in 1/s against the wall of a name.
fn resistance(case: &Case, rate: f64, name: &str) -> Result<ParcelResistance, ParcelWallError> {
    let mut walls = case.walls.iter();
    let wall = walls.find(|wall| belongs(&wall.name, name));
    let wall = wall.ok_or_else(|| {
        let names: Vec<&str> = case.walls.iter().map(|wall| &*wall.name).collect();
        ParcelWallError::Unknown {
            wall: name.to_owned(),
            known: names.join(", "),
        }
    })?;
    Ok(ParcelResistance {
        rate,
        wall: wall.motion.clone(),
    })
}

/// True where parcels rebound alike from both.
fn alike(one: &Wall, other: &Wall) -> bool {
    one.material == other.material && one.motion == other.motion
}

/// The wall nearest to a boundary face of those that it lies in: no point of the face is farther from it than half of
/// its shortest edge, as faces that only begin at a wall are.
fn nearest<'a>(case: &'a Case, mesh: &Mesh, face: usize) -> Option<&'a Wall> {
    let all = &mesh.topology().points;
    let points: Vec<Vec3> = mesh
        .face_points(face)
        .iter()
        .map(|&point| all[point as usize])
        .collect();
    let next = points.iter().cycle().skip(1);
    let edges = points.iter().zip(next).map(|(a, b)| (b - a).norm());
    let shortest = edges.fold(f64::INFINITY, f64::min);
    let farthest = |wall: &Wall| {
        let distances = points.iter().map(|&point| distance(wall, point));
        distances.fold(0.0, f64::max)
    };
    let with_distance = case.walls.iter().map(|wall| (wall, farthest(wall)));
    let within = with_distance.filter(|(_, distance)| *distance < 0.5 * shortest);
    within
        .min_by(|a, b| a.1.total_cmp(&b.1))
        .map(|(wall, _)| wall)
}

fn distance(wall: &Wall, place: Vec3) -> f64 {
    if let WallShape::Mesh { triangles } = &wall.shape {
        let each = triangles.iter().map(|one| distance_to_triangle(one, place));
        return each.fold(f64::INFINITY, f64::min);
    }
    distance_to_shape(&wall.shape, place).map_or(f64::INFINITY, f64::abs)
}

/// The impact of each population on a wall.
fn impacts(case: &Case, wall: &Wall) -> Result<Vec<ParcelImpact>, ParcelWallError> {
    let of = |material: usize| {
        let between = |contact: &&ContactSpec| {
            let [a, b] = contact.between;
            [a, b] == [material, wall.material] || [b, a] == [material, wall.material]
        };
        let contact = case.contacts.iter().find(between);
        let impact = contact.and_then(|contact| {
            Some(ParcelImpact {
                restitution: contact.restitution?,
                friction: contact.friction?,
            })
        });
        impact.ok_or_else(|| ParcelWallError::Contact {
            material: case.materials[material].name.clone(),
            wall: wall.name.clone(),
            other: case.materials[wall.material].name.clone(),
        })
    };
    case.particles.iter().map(|one| of(one.material)).collect()
}
