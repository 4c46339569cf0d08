//! One sphere and pairs of spheres against exact solutions.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

use std::f64::consts::PI;

use calcine_coupler::motion::{ContactForce, Contacts};
use calcine_coupler::physics::Vec3;
use calcine_coupler::physics::contact::time_step::hertz_collision;

use crate::grains::*;

const RADIUS: f64 = 1e-3;
/// Effective modulus of the tests' material in Pa: E/(2 (1 − ν²)).
const MODULUS: f64 = 1e7 / (2.0 * 0.9375);

fn mass(radius: f64) -> f64 {
    4.0 / 3.0 * PI * radius.powi(3) * 2500.0
}

/// A floor, and a step of a share of the collision with it at a speed.
fn floor(speed: f64, steps: f64, restitution: f64, friction: f64) -> Contacts {
    let time = hertz_collision(RADIUS, mass(RADIUS), MODULUS, speed);
    let mut contacts = contacts(time / steps);
    contacts.pairs[0].restitution = restitution;
    contacts.pairs[0].friction = friction;
    contacts.walls = vec![plane(Vec3::zeros(), Vec3::z())];
    contacts
}

/// Throws a sphere at the floor and returns the bed after twice the collision's time.
fn thrown(contacts: Contacts, velocity: Vec3, steps: f64) -> Bed {
    let start = Vec3::z() * (RADIUS * (1.0 + 1e-9));
    let mut bed = Bed::new(contacts, &[sphere(1, start, velocity, RADIUS)]);
    bed.run((2.0 * steps) as u64);
    assert!(bed.place(0).z > RADIUS);
    bed
}

#[test]
fn a_sphere_falls_as_galileo_says_and_an_elastic_floor_gives_its_height_back() {
    let mut contacts = floor(1.0, 200.0, 1.0, 0.0);
    contacts.gravity = Vec3::z() * -9.81;
    let (step, height) = (contacts.step, 0.05);
    let mut bed = Bed::new(
        contacts,
        &[sphere(1, Vec3::z() * height, Vec3::zeros(), RADIUS)],
    );
    let fall = ((2.0 * (height - RADIUS) / 9.81).sqrt() / step) as u64;
    bed.run(fall);
    let time = fall as f64 * step;
    assert!((bed.place(0).z - (height - 0.5 * 9.81 * time * time)).abs() < 1e-13);
    assert!((bed.velocity(0).z + 9.81 * time).abs() < 1e-11);
    let mut highest = 0.0f64;
    for _ in 0..fall + 400 {
        bed.run(1);
        highest = highest.max(bed.place(0).z);
    }
    assert!((highest / height - 1.0).abs() < 1e-4, "{highest}");
}

#[test]
fn the_rebound_is_the_restitution_over_four_decades_of_speed() {
    for restitution in [0.1, 0.3, 0.5, 0.9, 1.0] {
        for speed in [1e-3, 1e-2, 0.1, 1.0, 10.0] {
            let bed = thrown(
                floor(speed, 1000.0, restitution, 0.3),
                Vec3::z() * -speed,
                4000.0,
            );
            let found = bed.velocity(0).z / speed;
            // A step of a thousandth of the contact; a low restitution damps much within a few steps.
            assert!(
                (found - restitution).abs() < 4e-3,
                "{restitution} at {speed} m/s: {found}"
            );
        }
    }
}

#[test]
fn clipped_damping_gives_055_for_a_restitution_of_05() {
    let mut contacts = floor(1.0, 1000.0, 0.5, 0.3);
    contacts.law.attractive_damping = false;
    let found = thrown(contacts, -Vec3::z(), 4000.0).velocity(0).z;
    assert!((found - 0.55).abs() < 5e-3, "{found}");
}

/// Of two spheres and of a sphere on a plane; more impacts in `dem_impacts.rs`.
#[test]
fn an_elastic_impact_has_the_depth_and_duration_of_hertz() {
    for pair in [true, false] {
        let (radius, reduced) = if pair {
            (0.5 * RADIUS, 0.5 * mass(RADIUS))
        } else {
            (RADIUS, mass(RADIUS))
        };
        let time = hertz_collision(radius, reduced, MODULUS, 2.0);
        let mut contacts = floor(1.0, 1.0, 1.0, 0.0);
        contacts.step = time / 2000.0;
        let above = |z: f64, v: f64, id| sphere(id, Vec3::z() * z, Vec3::z() * v, RADIUS);
        let mut bed = if pair {
            contacts.walls.clear();
            Bed::new(contacts, &[above(-RADIUS, 1.0, 1), above(RADIUS, -1.0, 2)])
        } else {
            Bed::new(contacts, &[above(RADIUS, -2.0, 1)])
        };
        let (mut deepest, mut steps) = (0.0f64, 0);
        loop {
            bed.run(1);
            steps += 1;
            let overlap = if pair {
                2.0 * RADIUS - (bed.place(1).z - bed.place(0).z)
            } else {
                RADIUS - bed.place(0).z
            };
            deepest = deepest.max(overlap);
            if overlap <= 0.0 || steps > 5000 {
                break;
            }
        }
        let depth = (15.0 * reduced * 4.0 / (16.0 * radius.sqrt() * MODULUS)).powf(0.4);
        assert!((deepest / depth - 1.0).abs() < 1e-5, "{deepest} {depth}");
        assert!((f64::from(steps) / 2000.0 - 1.0).abs() < 1.5e-3, "{steps}");
    }
}

#[test]
fn two_stacked_spheres_rest_at_the_overlaps_of_hertz() {
    let mut contacts = floor(0.1, 100.0, 0.2, 0.3);
    contacts.gravity = Vec3::z() * -9.81;
    let at = |id, z| sphere(id, Vec3::z() * z, Vec3::zeros(), RADIUS);
    let mut bed = Bed::new(contacts, &[at(1, RADIUS), at(2, 3.0 * RADIUS)]);
    bed.run(40_000);
    let weight = mass(RADIUS) * 9.81;
    let lower = (2.0 * weight / (4.0 / 3.0 * MODULUS * RADIUS.sqrt())).powf(2.0 / 3.0);
    let upper = (weight / (4.0 / 3.0 * MODULUS * (0.5 * RADIUS).sqrt())).powf(2.0 / 3.0);
    let found = [
        RADIUS - bed.place(0).z,
        2.0 * RADIUS - (bed.place(1).z - bed.place(0).z),
    ];
    assert!(
        (found[0] / lower - 1.0).abs() < 1e-6,
        "{} {lower}",
        found[0]
    );
    assert!(
        (found[1] / upper - 1.0).abs() < 1e-6,
        "{} {upper}",
        found[1]
    );
}

#[test]
fn a_sliding_sphere_ends_rolling_with_five_sevenths_of_its_speed() {
    let mut contacts = floor(0.1, 50.0, 0.3, 0.3);
    contacts.gravity = Vec3::z() * -9.81;
    let weight = mass(RADIUS) * 9.81;
    let rest = (weight / (4.0 / 3.0 * MODULUS * RADIUS.sqrt())).powf(2.0 / 3.0);
    let start = Vec3::z() * (RADIUS - rest);
    let step = contacts.step;
    let mut bed = Bed::new(contacts, &[sphere(1, start, Vec3::x() * 0.2, RADIUS)]);
    // It slides until 2 v/(7 μ g).
    let slides = 2.0 * 0.2 / (7.0 * 0.3 * 9.81);
    bed.run((0.9 * slides / step) as u64);
    let wanted = 0.2 - 0.3 * 9.81 * bed.clocks.motion.seconds();
    assert!(
        (bed.velocity(0).x / wanted - 1.0).abs() < 1e-4,
        "{}",
        bed.velocity(0).x
    );
    bed.run((0.6 * slides / step) as u64);
    let found = bed.velocity(0).x / 0.2;
    assert!((found - 5.0 / 7.0).abs() < 2e-3, "{found}");
    assert!((bed.spin(0).y * RADIUS / bed.velocity(0).x - 1.0).abs() < 5e-3);
}

/// Slowing of a sphere that slides on a floor, over μ g, with steps of a share of the usual one.
fn slowing(force: ContactForce, share: f64) -> f64 {
    let mut contacts = floor(0.1, 50.0 / share, 0.3, 0.3);
    contacts.gravity = Vec3::z() * -9.81;
    contacts.law.force = force;
    let weight = mass(RADIUS) * 9.81;
    let rest = (weight / (4.0 / 3.0 * MODULUS * RADIUS.sqrt())).powf(2.0 / 3.0);
    let step = contacts.step;
    let start = sphere(1, Vec3::z() * (RADIUS - rest), Vec3::x() * 0.2, RADIUS);
    let mut bed = Bed::new(contacts, &[start]);
    // Half of the time for which it slides.
    bed.run((0.2 / (7.0 * 0.3 * 9.81) / step) as u64);
    (0.2 - bed.velocity(0).x) / (0.3 * 9.81 * bed.clocks.motion.seconds())
}

#[test]
fn a_sphere_that_slides_on_spring_slider_and_dashpot_is_slowed_by_mu_g_at_any_step() {
    for share in [1.0, 0.2, 0.05] {
        let found = slowing(ContactForce::SpringSliderDashpot, share);
        assert!((found - 1.0).abs() < 1e-3, "{share}: {found}");
    }
    // OpenFOAM's own form depends on the step.
    let own = [1.0, 0.05].map(|share| slowing(ContactForce::OpenfoamSpringSliderDashpot, share));
    assert!(own[0] < 1.1 && own[1] > 1.2, "{own:?}");
}

#[test]
fn a_pushed_sphere_takes_up_exactly_the_impulse_that_is_reported() {
    let mut bed = Bed::new(
        contacts(1e-5),
        &[sphere(1, Vec3::zeros(), Vec3::zeros(), RADIUS)],
    );
    let mut given = Vec3::zeros();
    for window in 0..20 {
        bed.push.force[0] = Vec3::new(1e-5, -2e-5, 3e-6 * f64::from(window));
        bed.run(7 + window as u64 % 3);
        given += bed.received.impulse[0];
    }
    let taken = mass(RADIUS) * bed.velocity(0);
    assert!(
        (taken - given).norm() < 1e-13 * given.norm(),
        "{taken} {given}"
    );
}

#[test]
fn a_projectile_follows_its_parabola() {
    let mut contacts = contacts(1e-4);
    contacts.gravity = Vec3::z() * -9.81;
    let mut bed = Bed::new(
        contacts,
        &[sphere(1, Vec3::zeros(), Vec3::new(1.0, 0.0, 2.0), RADIUS)],
    );
    bed.push.force[0] = Vec3::y() * mass(RADIUS) * 3.0;
    bed.run(2000);
    let wanted = Vec3::new(0.2, 0.5 * 3.0 * 0.04, 0.4 - 0.5 * 9.81 * 0.04);
    assert!((bed.place(0) - wanted).norm() < 1e-13, "{}", bed.place(0));
}

#[test]
fn elastic_motion_is_of_second_order_in_the_step() {
    let place = |steps: u64| {
        let mut contacts = floor(1.0, 1.0, 1.0, 0.0);
        contacts.step = 6e-5 / steps as f64;
        let start = Vec3::z() * (0.98 * RADIUS);
        let mut bed = Bed::new(contacts, &[sphere(1, start, Vec3::z() * -0.5, RADIUS)]);
        bed.run(steps);
        bed.place(0).z
    };
    let [coarse, middle, fine] = [50, 100, 200].map(place);
    let order = ((coarse - middle) / (middle - fine)).abs().log2();
    assert!((order - 2.0).abs() < 0.05, "{order}");
}
