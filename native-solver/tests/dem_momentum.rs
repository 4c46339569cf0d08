//! The momentum of a bed: what the free particles gain is what they are pushed with, gravity, and what walls
//! and held particles are reported to give them, in windows that are no whole number of steps.
#![allow(clippy::unwrap_used)]

use calcine_coupler::motion::{NewParticle, WallMotion};
use calcine_coupler::part::Particles;
use calcine_coupler::physics::Vec3;

use crate::grains::{Bed, contacts, cuboid, loose};

const STEP: f64 = 1e-5;

/// A shaken box of 120 spheres, every seventh of which is held, and a floor that slides.
fn shaken() -> Bed {
    let mut contacts = contacts(STEP);
    contacts.gravity = Vec3::new(0.0, 0.0, -9.81);
    contacts.walls = cuboid(Vec3::zeros(), Vec3::new(0.02, 0.02, 0.05));
    contacts.walls[2].motion = WallMotion::Translating(Vec3::new(0.1, 0.0, 0.0));
    let mut spheres = loose([4, 4, 8], 0.0049, 0.002, 0.5);
    for (index, sphere) in spheres.iter_mut().enumerate() {
        if index % 7 == 0 {
            *sphere = NewParticle {
                population: 1,
                velocity: Vec3::zeros(),
                ..*sphere
            };
        }
    }
    let mut bed = Bed::new(contacts, &spheres);
    for (index, force) in bed.push.force.iter_mut().enumerate() {
        let wave = 0.3 * index as f64;
        *force = 1e-3 * Vec3::new(wave.sin(), wave.cos(), 0.5);
    }
    bed
}

/// Momentum of the free particles in kg m/s, and their mass in kg.
fn momentum(bed: &Bed) -> (Vec3, f64) {
    let fields = bed.particles.fields();
    let free = (0..fields.len()).filter(|&p| fields.population[p] == 0);
    free.fold((Vec3::zeros(), 0.0), |(sum, mass), p| {
        (
            sum + fields.mass[p] * fields.velocity[p],
            mass + fields.mass[p],
        )
    })
}

#[test]
fn free_particles_gain_what_pushes_gravity_walls_and_held_particles_give() {
    let mut bed = shaken();
    let (mut supports, mut weights) = (0.0, 0.0);
    for window in 0..60 {
        let (before, mass) = momentum(&bed);
        bed.try_span(STEP * (37.0 + 0.37 * f64::from(window % 5)))
            .unwrap();
        let received = &bed.received;
        let support = received.support.unwrap();
        let weight = mass * received.acted * Vec3::new(0.0, 0.0, -9.81);
        let population = bed.particles.fields().population;
        let pushed: Vec3 = (0..population.len())
            .filter(|&p| population[p] == 0)
            .map(|p| received.impulse[p])
            .sum();
        let left = momentum(&bed).0 - before - pushed - weight - support;
        let moved = weight.norm() + support.norm() + pushed.norm();
        assert!(
            left.norm() < 1e-12 * moved,
            "window {window}: {left} of {moved}"
        );
        supports += support.norm();
        weights += weight.norm();
    }
    // They do give: more than a tenth of the weight.
    assert!(supports > 0.1 * weights, "{supports} {weights}");
}

#[test]
fn a_lone_sphere_gains_exactly_the_impulse_over_the_window() {
    let mut bed = Bed::new(contacts(STEP), &loose([1, 1, 1], 0.01, 0.002, 0.0));
    bed.push.force[0] = Vec3::new(1e-3, 0.0, -2e-3);
    let mass = bed.particles.fields().mass[0];
    for steps in [0.6, 1.0, 10.4, 33.33] {
        let before = bed.velocity(0);
        bed.try_span(STEP * steps).unwrap();
        let gained = mass * (bed.velocity(0) - before);
        let due = bed.push.force[0] * STEP * steps;
        assert!(
            (gained - due).norm() < 1e-6 * due.norm(),
            "{steps}: {gained} {due}"
        );
        assert!((gained - bed.received.impulse[0]).norm() < 1e-12 * due.norm());
    }
}

#[test]
fn a_window_without_a_step_is_refused() {
    let mut bed = Bed::new(contacts(STEP), &loose([1, 1, 1], 0.01, 0.002, 0.0));
    let error = bed.try_span(0.3 * STEP).unwrap_err().to_string();
    assert!(error.contains("holds no time step"), "{error}");
}
