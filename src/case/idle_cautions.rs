//! What a case states without an effect or beyond what is likely meant, or leaves out with an effect that is likely not meant.

use calcine_coupler::feeds::places;
use calcine_coupler::mesh::Mesh;
use calcine_coupler::mesh::surface::triangles;
use calcine_coupler::mesh::zone::Zone;
use calcine_coupler::motion::{Cohesion, Motion, Rolling, WallMotion, WallShape};
use calcine_coupler::physics::Vec3;
use calcine_coupler::physics::law::NONE;
use calcine_coupler::setup::{GasPatch, ParticleSetup};

use super::in_wall;
use super::model::{Case, ContactSpec, FeedSpec, MotionSpec};
use super::place_error::PlaceError;
use super::units::{listed, short3};

/// Places in the region of a feed that are tried.
const PLACES: usize = 1000;
/// Coefficients of friction above this are not those of materials.
const FRICTION: f64 = 2.0;
/// Share of the extent of a mesh by which a wall lies within it.
const WITHIN: f64 = 0.02;

/// Warnings about a case by itself, in a fixed order.
pub(super) fn all(case: &Case) -> Vec<String> {
    let mut all: Vec<String> = without_gravity(case).into_iter().collect();
    all.extend(held_inlets(case));
    all.extend(wall_temperatures(case));
    all.extend(unused_materials(case));
    all.extend(doubled_walls(case));
    all.extend(unused_contacts(case));
    all.extend(high_friction(case));
    all
}

/// Coefficients of friction that are likely percentages or lack a decimal point.
fn high_friction(case: &Case) -> Vec<String> {
    let contacts = case.contacts.iter().enumerate();
    let stated = contacts.flat_map(|(index, one)| {
        [
            (index, "friction", one.friction),
            (index, "rolling_friction", one.rolling_friction),
        ]
    });
    let high = stated.filter_map(|(index, key, value)| {
        let value = value.filter(|value| *value > FRICTION)?;
        Some(format!(
            "`contacts[{index}].{key}` is {}: coefficients of friction of materials are below {}; is it a percentage, or does it lack a \
             decimal point?",
            short3(value),
            short3(FRICTION)
        ))
    });
    high.collect()
}

/// Properties of contacts that belong to a law which is not chosen.
fn unused_contacts(case: &Case) -> Vec<String> {
    let Some(motion) = &case.motion else {
        return Vec::new();
    };
    let no_rolling = motion.parcels.is_some() || motion.law.rolling == Rolling::None;
    let cohesive = |law: Cohesion| motion.parcels.is_none() && motion.law.cohesion == law;
    let of_cohesion = match motion.law.cohesion {
        Cohesion::None => NONE,
        Cohesion::Sjkr => "sjkr",
        Cohesion::Jkr => "jkr",
    };
    let idle = |key: &str, [law, chosen]: [&str; 2], stated: fn(&ContactSpec) -> Option<f64>| {
        let mut contacts = case.contacts.iter().enumerate();
        let (index, _) = contacts.find(|(_, one)| stated(one).is_some_and(|value| value > 0.0))?;
        Some(match motion.parcels {
            Some(_) => format!("`contacts[{index}].{key}` has no effect: parcels have no contacts"),
            None => {
                format!(
                    "`contacts[{index}].{key}` has no effect: the law of `motion.{law}` is \"{chosen}\""
                )
            }
        })
    };
    let rolling = idle("rolling_friction", ["rolling", NONE], |one| {
        one.rolling_friction
    });
    let law = ["cohesion", of_cohesion];
    let cohesion = idle("cohesion_energy", law, |one| one.cohesion_energy);
    let adhesion = idle("work_of_adhesion", law, |one| one.work_of_adhesion);
    let rolling = rolling.filter(|_| no_rolling);
    rolling
        .into_iter()
        .chain(cohesion.filter(|_| !cohesive(Cohesion::Sjkr)))
        .chain(adhesion.filter(|_| !cohesive(Cohesion::Jkr)))
        .collect()
}

/// Materials that nothing is made of.
fn unused_materials(case: &Case) -> Option<String> {
    let used = |index: usize| {
        case.particles.iter().any(|one| one.material == index)
            || case.walls.iter().any(|wall| wall.material == index)
            || case.body_materials.contains(&index)
    };
    let unused = case.materials.iter().enumerate();
    let unused: Vec<&str> = unused
        .filter(|(index, _)| !used(*index))
        .map(|(_, material)| material.name.as_str())
        .collect();
    listed(&unused).map(|names| format!("no particles and no wall are of the material {names}"))
}

/// Walls in one place, whose contacts count twice.
fn doubled_walls(case: &Case) -> Vec<String> {
    let walls = case.walls.iter().enumerate();
    let twice = walls.filter_map(|(index, wall)| {
        let mut before = case.walls[..index].iter();
        let other = before.find(|other| other.shape == wall.shape)?;
        Some(format!(
            "the walls `{}` and `{}` are one surface: what touches it feels both; leave one out",
            other.name, wall.name
        ))
    });
    twice.collect()
}

/// Particles that move where gravity is not stated.
fn without_gravity(case: &Case) -> Option<String> {
    let mut moving = case.particles.iter();
    let one = moving.find(|one| one.motion != MotionSpec::Frozen)?;
    (!case.gravity_is_stated).then(|| {
        format!(
            "`gas.gravity` is not stated, so that `{}` do not fall: write gravity = \"0 0 -9.81 m/s^2\", or \"0 0 0 m/s^2\" if that is meant",
            one.name
        )
    })
}

/// Inlets of a gas that is held.
fn held_inlets(case: &Case) -> Option<String> {
    let mut patches = case.gas.patches.iter();
    let (name, _) = patches.find(|(_, patch)| matches!(patch, GasPatch::Inlet { .. }))?;
    case.gas_held.then(|| {
        format!(
            "`gas.held` keeps the gas as it is at the start: the inlet `{name}` has no effect; remove one of both"
        )
    })
}

/// Temperatures of walls that nothing is exchanged with.
fn wall_temperatures(case: &Case) -> Option<String> {
    let stated = case.wall_temperatures.iter().position(Option::is_some)?;
    let alone = !case.laws.conducts() && case.laws.radiation.is_none();
    alone.then(|| {
        let key = match case.wall_bodies[stated] {
            Some(_) => "body",
            None => "temperature",
        };
        format!(
            "`{key}` of the wall `{}` has no effect: `laws.conduction` and `laws.radiation` are \"none\"",
            case.walls[stated].name
        )
    })
}

/// Walls within the mesh, which the gas does not see.
pub(super) fn unseen_walls(case: &Case, mesh: &Mesh) -> Option<String> {
    if case.gas_held || case.gas.properties.is_vacuum() {
        return None;
    }
    let [low, high] = mesh.bounds();
    let edge = WITHIN * (high - low);
    let inside = |point: Vec3| {
        let (low, high) = (low + edge, high - edge);
        (0..3).all(|axis| (low[axis]..=high[axis]).contains(&point[axis]))
    };
    let within = |shape: &WallShape| match shape {
        WallShape::Mesh { triangles } => {
            let mut centres = triangles.iter().map(|[a, b, c]| (a + b + c) / 3.0);
            centres.any(inside)
        }
        _ => false,
    };
    let moves = |motion: &WallMotion| {
        matches!(
            motion,
            WallMotion::Scheduled { .. }
                | WallMotion::Oscillating { .. }
                | WallMotion::Servo { .. }
        )
    };
    let found = case
        .walls
        .iter()
        .filter(|wall| within(&wall.shape) && !is_of(mesh, &wall.shape) || moves(&wall.motion));
    let names: Vec<&str> = found.map(|wall| wall.name.as_str()).collect();
    listed(&names).map(|names| {
        format!(
            "the gas does not see walls within its mesh and flows through {}: they are for particles; cut them out of the mesh \
             (`mesh.box.cut`, `mesh.cylinder.cut` or `mesh.polymesh`) where the gas has to go around them",
            names
        )
    })
}

/// True where a shape is a patch of the mesh.
fn is_of(mesh: &Mesh, shape: &WallShape) -> bool {
    let WallShape::Mesh { triangles: own } = shape else {
        return false;
    };
    let mut patches = mesh.patches().iter();
    patches.any(|patch| triangles(mesh, patch) == *own)
}

/// Regions of feeds and outlets that lie beside the mesh, or of feeds in walls.
pub(super) fn regions(case: &Case, mesh: &Mesh, setup: &ParticleSetup) -> Vec<String> {
    let [low, high] = mesh.bounds();
    let beside = |zone: &Zone| {
        let [from, to] = zone.bounds();
        (0..3).any(|axis| to[axis] < low[axis] || from[axis] > high[axis])
    };
    let mut told = Vec::new();
    for feed in &case.feeds {
        if beside(&feed.zone) {
            told.push(format!(
                "the region of the feed `{}` lies beside the mesh: its particles leave as soon as they come; correct `region`",
                feed.name
            ));
        } else {
            told.extend(into_wall(case, setup, feed));
        }
    }
    for outlet in case.outlets.iter().filter(|outlet| beside(&outlet.zone)) {
        told.push(format!(
            "the region of the outlet `{}` lies beside the mesh, where no particle comes; correct `region`",
            outlet.name
        ));
    }
    told
}

/// A feed that places particles in a wall.
fn into_wall(case: &Case, setup: &ParticleSetup, feed: &FeedSpec) -> Option<String> {
    if !matches!(setup.motion, Motion::Free(_)) {
        return None;
    }
    let radius = 0.5 * case.particles[feed.population].sizes.largest();
    let position: Vec<Vec3> = places(feed.zone, radius, feed.seed).take(PLACES).collect();
    let count = position.len();
    let fed = ParticleSetup {
        id: (1..=count as u64).collect(),
        population: vec![feed.population as u32; count],
        radius: vec![radius; count],
        density: vec![1.0; count],
        velocity: Vec::new(),
        angular_velocity: Vec::new(),
        weight: Vec::new(),
        position,
        motion: setup.motion.clone(),
    };
    match in_wall::check(case, &fed) {
        Err(PlaceError::InWall { wall, .. }) => Some(format!(
            "the region of the feed `{}` reaches into the wall `{wall}`: particles that come there are shot out of it; keep `region` a \
             particle's radius away from walls",
            feed.name
        )),
        _ => None,
    }
}
