//! Friction of parcels under the stress of the solid (docs/theory.md, NSP-1).
#![allow(clippy::print_stdout)]

use std::sync::Arc;

use calcine_coupler::mesh::Mesh;
use calcine_coupler::parcels::{ParcelCollisions, ParcelFriction, ParcelPacking};
use calcine_coupler::part::Particles;
use calcine_coupler::physics::parcels::{CollisionTimes, HarrisCrighton};
use calcine_coupler::physics::{Vec3, sphere};

use crate::common::named_box;
use crate::parcel_beds::{ParcelBed, motion, setup};

const SIDES: [&str; 6] = ["west", "east", "south", "north", "bottom", "top"];

/// A bed of 40 mm on the floor of a box that repeats itself sideways, with gravity along z, turned about y by an angle.
fn incline(angle: f64, bed: f64, wall: f64) -> ParcelBed {
    let mesh = named_box([0.04, 0.02, 0.06], [8, 4, 12], SIDES);
    let pairs = [["west", "east"], ["south", "north"]];
    let pairs = pairs.map(|pair| pair.map(String::from));
    let mesh: Arc<Mesh> = Arc::new(Mesh::clone(&mesh).with_periodic(&pairs).unwrap());
    let mut rules = motion(&mesh, 0.0, wall);
    rules.gravity = 9.81 * Vec3::new(angle.sin(), 0.0, -angle.cos());
    rules.packing = ParcelPacking::Implicit(HarrisCrighton {
        pressure: 1.0,
        exponent: 2.0,
        floor: 1e-7,
        close_packing: 0.6,
    });
    rules.collisions = ParcelCollisions {
        times: CollisionTimes {
            restitution: 0.5,
            close_packing: 0.6,
        },
        damping: true,
        isotropy: false,
        seed: 1,
    };
    rules.friction = Some(ParcelFriction { bed, slip: 1e-4 });
    let mut parcels = Vec::new();
    for z in 0..16 {
        for y in 0..8 {
            for x in 0..16 {
                let place =
                    2.5e-3 * (Vec3::new(f64::from(x), f64::from(y), f64::from(z)).add_scalar(0.5));
                parcels.push((place, Vec3::zeros()));
            }
        }
    }
    let radius = 0.5e-3;
    let weight = 0.58 * 2.5e-3_f64.powi(3) / sphere::volume(radius);
    ParcelBed::new(&mesh, &setup(rules, &parcels, radius, weight))
}

/// Mean velocity along x of all parcels, and of those in the upper quarter of the bed.
fn speeds(bed: &ParcelBed) -> [f64; 2] {
    let fields = bed.parcels.fields();
    let mean = |from: f64| {
        let rows = fields.position.iter().zip(fields.velocity);
        let chosen: Vec<f64> = rows
            .filter(|(place, _)| place.z >= from)
            .map(|(_, velocity)| velocity.x)
            .collect();
        chosen.iter().sum::<f64>() / chosen.len() as f64
    };
    [mean(0.0), mean(0.03)]
}

/// Accelerations between 0.1 and 0.3 s.
fn accelerations(mut bed: ParcelBed) -> [f64; 2] {
    bed.run(100, 1e-3);
    let before = speeds(&bed);
    bed.run(200, 1e-3);
    let after = speeds(&bed);
    println!("{before:?} {after:?}");
    [0, 1].map(|k| (after[k] - before[k]) / 0.2)
}

/// Friction along an incline, as an acceleration tells it, over what Coulomb's law gives.
fn share_of_coulomb(acceleration: f64, (angle, friction): (f64, f64)) -> f64 {
    (9.81 * angle.sin() - acceleration) / (9.81 * friction * angle.cos())
}

#[test]
fn a_bed_slides_on_its_floor_as_a_block_does() {
    let angle = 25.0_f64.to_radians();
    let found = accelerations(incline(angle, 0.6, 0.3));
    let shares = found.map(|found| share_of_coulomb(found, (angle, 0.3)));
    println!("{shares:?}");
    assert!(shares.iter().all(|share| (share - 1.0).abs() < 0.01));
}

#[test]
fn a_bed_on_a_rough_floor_slips_within_itself() {
    let angle = 25.0_f64.to_radians();
    let found = accelerations(incline(angle, 0.3, 2.0));
    let share = share_of_coulomb(found[1], (angle, 0.3));
    println!("{share} {found:?}");
    assert!((share - 1.0).abs() < 0.12);
    // What lies on the floor stays behind.
    assert!(found[0] < 0.85 * found[1]);
}

#[test]
fn below_its_angle_of_friction_it_creeps_at_most() {
    let angle = 20.0_f64.to_radians();
    let mut bed = incline(angle, 0.45, 0.6);
    bed.run(100, 1e-3);
    let mut travelled = [0.0; 2];
    for _ in 0..200 {
        bed.run(1, 1e-3);
        for (way, speed) in travelled.iter_mut().zip(speeds(&bed)) {
            *way += 1e-3 * speed;
        }
    }
    println!("{travelled:?}");
    // A block without friction comes 67 mm far in that time.
    assert!(travelled.iter().all(|way| way.abs() < 1.5e-3));
}
