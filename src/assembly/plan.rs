//! What the coordinator is told of a case: its plan and its laws.

use calcine_coupler::closures::Closures;
use calcine_coupler::coordinator::{CheckpointPaths, ContactStepLimit, Plan};
use calcine_coupler::feeds::{Feed, FeedsAndOutlets};
use calcine_coupler::hold::Holds;
use calcine_coupler::motion::{LostParticles, Motion};
use calcine_coupler::paths::{HeatWall, PathsSetup};
use calcine_coupler::physics::Vec3;

use super::prepared::{PreparedCase, method};
use crate::case::model::Case;
use crate::laws;

pub(super) fn plan(case: &Case, prepared: &PreparedCase, checkpoint: CheckpointPaths) -> Plan {
    let [breaks, jumps] = crate::case::breaks(case);
    Plan {
        end: case.time.end,
        motion_window: case.time.motion_window,
        window_bounds: case.time.window_bounds,
        particle_step: match &prepared.particles.motion {
            Motion::Frozen | Motion::Parcels(_) => None,
            Motion::Free(contacts) => Some(contacts.step),
        },
        breaks,
        jumps,
        time_scheme: case.gas.controls.time_scheme,
        convection: case.gas.controls.convection,
        gas_reacts: case.gas.chemistry.reacting().is_some(),
        acceleration: case.time.acceleration.clone(),
        storage: case.time.storage,
        checkpoint_every: case.time.checkpoint_every,
        checkpoint_wall: case.time.checkpoint_wall,
        mapping: method(case),
        exchange_tolerance: case.coupling.exchange_tolerance,
        gas_tolerance: case.gas.controls.outer_tolerance,
        exchange_attempts: case.coupling.exchange_attempts,
        cuts: case.coupling.exchange_cuts,
        repeats: true,
        window_drag: case.coupling.window_drag,
        case_hash: case.hash.clone(),
        checkpoint,
        populations: case.particles.iter().map(|one| one.name.clone()).collect(),
        free: match &prepared.particles.motion {
            Motion::Frozen => Vec::new(),
            Motion::Free(contacts) => contacts.held.iter().map(|held| !held).collect(),
            Motion::Parcels(_) => vec![true; case.particles.len()],
        },
        holds: case
            .motion
            .as_ref()
            .map_or_else(Holds::default, |motion| motion.held.clone()),
        lost: case
            .motion
            .as_ref()
            .map_or_else(LostParticles::default, |motion| motion.lost),
        gravity: case.gas.gravity,
        feeds_and_outlets: feeds_and_outlets(case, prepared),
        substance: case.particles.iter().map(|one| one.material).collect(),
        paths: paths(case, prepared),
        step_limit: match &prepared.particles.motion {
            Motion::Frozen | Motion::Parcels(_) => None,
            Motion::Free(contacts) => {
                let waived = case.motion.as_ref().is_some_and(|motion| motion.long_step);
                (!waived).then(|| ContactStepLimit::of(contacts))
            }
        },
    }
}

/// Feeds and outlets of the case; ids go on after those of the start.
fn feeds_and_outlets(case: &Case, prepared: &PreparedCase) -> FeedsAndOutlets {
    let feeds = case.feeds.iter().map(|feed| {
        let population = &case.particles[feed.population];
        Feed {
            name: feed.name.clone(),
            population: u32::try_from(feed.population).unwrap_or(u32::MAX),
            zone: feed.zone,
            rate: feed.rate,
            period: feed.period,
            batch: feed.batch,
            sizes: population.sizes.clone(),
            density: case.materials[population.material].density,
            weight: population.weight,
            velocity: feed.velocity,
            temperature: feed.temperature,
            seed: feed.seed,
        }
    });
    let up = (-case.gas.gravity).try_normalize(0.0).unwrap_or(Vec3::z());
    let next = prepared.particles.id.last().map_or(1, |last| last + 1);
    let feeds = FeedsAndOutlets::new(feeds.collect(), case.outlets.clone(), up, next);
    feeds.in_periods(prepared.mesh.periodicity())
}

/// Heat between particles and to walls, as the coordinator finds it.
fn paths(case: &Case, prepared: &PreparedCase) -> PathsSetup {
    let Some(laws) = laws::heat(case) else {
        return PathsSetup::default();
    };
    let radii = &prepared.particles.radius;
    let fed = case
        .feeds
        .iter()
        .map(|feed| 0.5 * case.particles[feed.population].sizes.largest());
    let largest = radii.iter().copied().chain(fed).fold(0.0, f64::max);
    let emissivity = |material: usize| case.materials[material].emissivity.unwrap_or(1.0);
    let walls = case.walls.iter().zip(&case.wall_temperatures);
    let walls = walls.zip(&case.wall_bodies);
    let radiation = case.laws.radiation.as_ref();
    PathsSetup {
        walls: walls
            .map(|((wall, temperature), body)| HeatWall {
                body: *body,
                name: wall.name.clone(),
                shape: wall.shape.clone(),
                temperature: temperature.clone(),
                emissivity: emissivity(wall.material),
            })
            .collect(),
        emissivity: case
            .particles
            .iter()
            .map(|one| emissivity(one.material))
            .collect(),
        gap: laws.reach(largest),
        view_factors: radiation.map(|one| one.view_factors),
        surroundings: radiation.and_then(|one| one.surroundings.clone()),
        refresh: radiation.map_or(0.0, |one| one.refresh),
    }
}

pub(super) fn closures(case: &Case) -> Closures {
    Closures {
        gas: case.gas.properties.clone(),
        drag: case.laws.drag.make(),
        momentum: case.gas.momentum,
        heat_transfer: case.laws.heat_transfer.make(),
        heat_film: case.laws.heat_film,
        mass_transfer: case.laws.mass_transfer.make(),
        film_diffusivity: case.laws.film_diffusivity.clone(),
        bed_eddies: case.laws.bed_eddies.make(),
        film: case.laws.film,
    }
}
