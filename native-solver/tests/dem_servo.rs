//! Walls that are moved to hold a force.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

use calcine_coupler::motion::{Contacts, WallMotion};
use calcine_coupler::part::Part;
use calcine_coupler::physics::Vec3;

use crate::grains::*;

const RADIUS: f64 = 1e-3;
/// Force of the plate in N.
const FORCE: f64 = 0.05;

/// A box 10 mm wide and deep, whose top is a plate at a height that presses down.
fn pressed(step: f64, height: f64, damping: f64) -> Contacts {
    let mut contacts = contacts(step);
    contacts.gravity = Vec3::z() * -9.81;
    let (low, high) = (Vec3::zeros(), Vec3::new(0.01, 0.01, height));
    contacts.walls = cuboid(low, high);
    contacts.walls[5].motion = WallMotion::Servo {
        direction: -Vec3::z(),
        force: FORCE,
        mass: 1e-3,
        damping,
    };
    contacts
}

/// Overlap of a sphere and a wall under a force in N by Hertz, with E* = 10 MPa/(2 (1 - 0.25²)) of like materials.
fn overlap(force: f64) -> f64 {
    let stiff = 1e7 / (2.0 * (1.0 - 0.0625));
    (0.75 * force / (stiff * f64::sqrt(RADIUS))).powf(2.0 / 3.0)
}

fn plate(bed: &Bed) -> calcine_native::particles::dem::ServoState {
    bed.particles.engine().unwrap().servo_states()[0]
}

#[test]
fn a_plate_presses_a_sphere_with_its_force() {
    let contacts = pressed(2e-6, 2.4e-3, 1.0);
    let centre = Vec3::new(5e-3, 5e-3, RADIUS);
    let mut bed = Bed::new(contacts, &[sphere(1, centre, Vec3::zeros(), RADIUS)]);
    bed.run(200_000);
    let weight = 9.81 * 2500.0 * 4.0 / 3.0 * std::f64::consts::PI * RADIUS.powi(3);
    // What the sphere presses against the plate, and how far it and the plate are pressed.
    let plate = plate(&bed);
    assert!((plate.pressed.z / FORCE - 1.0).abs() < 1e-9, "{plate:?}");
    assert!(plate.pressed.xy().norm() < 1e-12, "{plate:?}");
    let floor = overlap(FORCE + weight);
    let place = bed.place(0).z - (RADIUS - floor);
    assert!(place.abs() < 1e-9 * RADIUS, "{place}");
    let sunk = 2.4e-3 - 2.0 * RADIUS + floor + overlap(FORCE);
    assert!(
        (plate.distance / sunk - 1.0).abs() < 1e-9,
        "{plate:?} {sunk}"
    );
    assert!(plate.rate.abs() < 1e-12, "{plate:?}");
}

#[test]
fn a_bed_carries_the_plate_to_its_floor() {
    let mut contacts = pressed(1e-5, 20e-3, 0.2);
    contacts.pairs[0].friction = 0.0;
    let mut spheres = loose([4, 4, 8], 2.3e-3, RADIUS, 0.0);
    for sphere in &mut spheres {
        sphere.position += Vec3::repeat(2e-4);
    }
    let count = spheres.len() as f64;
    let mut bed = Bed::new(contacts, &spheres);
    bed.run(150_000);
    let plate = plate(&bed);
    assert!((plate.pressed.z / FORCE - 1.0).abs() < 1e-3, "{plate:?}");
    let fastest = (0..spheres.len()).map(|row| bed.velocity(row).norm());
    assert!(fastest.fold(0.0, f64::max) < 1e-3);
    // All walls together carry the particles' weight: floor less plate.
    let weight = count * 9.81 * 2500.0 * 4.0 / 3.0 * std::f64::consts::PI * RADIUS.powi(3);
    bed.run(1000);
    let support = bed.received.support.unwrap().z / (1000.0 * 1e-5);
    assert!((support / weight - 1.0).abs() < 1e-3, "{support} {weight}");
}

#[test]
fn a_plate_above_nothing_falls_by_its_force() {
    let mut contacts = pressed(1e-5, 50e-3, 0.0);
    contacts.gravity = Vec3::zeros();
    let far = sphere(1, Vec3::new(5e-3, 5e-3, 2e-3), Vec3::zeros(), RADIUS);
    let mut bed = Bed::new(contacts, &[far]);
    for _ in 0..4 {
        bed.run(500);
    }
    let plate = plate(&bed);
    let time: f64 = 0.02;
    let fallen = 0.5 * FORCE / 1e-3 * time * time;
    assert!((plate.distance / fallen - 1.0).abs() < 1e-12, "{plate:?}");
    assert!((plate.rate / (FORCE / 1e-3 * time) - 1.0).abs() < 1e-12);
}

#[test]
fn a_checkpoint_changes_nothing_under_a_plate() {
    let make = || {
        let contacts = pressed(1e-5, 20e-3, 0.2);
        let mut spheres = loose([4, 4, 8], 2.3e-3, RADIUS, 0.3);
        for sphere in &mut spheres {
            sphere.position += Vec3::repeat(2e-4);
        }
        Bed::new(contacts, &spheres)
    };
    for before in [1, 997, 9000] {
        let folder = tempfile::tempdir().unwrap();
        let (mut alone, mut through, mut resumed) = (make(), make(), make());
        alone.run(before);
        through.run(before);
        through.particles.checkpoint(folder.path()).unwrap();
        resumed.particles.restore(folder.path()).unwrap();
        resumed.clocks = through.clocks;
        for steps in [1, 99, 3000] {
            for bed in [&mut alone, &mut through, &mut resumed] {
                bed.run(steps);
            }
            assert_eq!(through.bits(), alone.bits(), "{before}, {steps}");
            assert_eq!(resumed.bits(), alone.bits(), "{before}, {steps}");
            assert_eq!(plate(&resumed), plate(&alone), "{before}, {steps}");
        }
        assert!(plate(&alone).distance > 0.0);
    }
}
