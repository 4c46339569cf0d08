//! The constant resistance of parcels against a wall, against its closed form (docs/theory.md, NSP-2).

use std::sync::Arc;

use calcine_coupler::mesh::Mesh;
use calcine_coupler::motion::WallMotion;
use calcine_coupler::parcels::ParcelResistance;
use calcine_coupler::part::{
    DRAG_COEFFICIENT, DRAG_IMPULSE, GAS_VELOCITY, ParticlePush, Particles,
};
use calcine_coupler::physics::Vec3;

use crate::common::named_box;
use crate::parcel_beds::{ParcelBed, motion, setup};

fn wide() -> Arc<Mesh> {
    let patches = ["west", "east", "south", "north", "bottom", "top"];
    named_box([10.0, 10.0, 10.0], [4, 4, 4], patches)
}

const RATE: f64 = 0.7;
const BELT: Vec3 = Vec3::new(0.3, -0.1, 0.0);

/// A parcel of 7 particles in the middle that is thrown, with a resistance against a belt, after a second in windows of equal length.
fn thrown(windows: usize, gravity: Vec3) -> ParcelBed {
    let mesh = wide();
    let mut rules = motion(&mesh, 1.0, 0.0);
    rules.gravity = gravity;
    rules.resistance = Some(ParcelResistance {
        rate: RATE,
        wall: WallMotion::Translating(BELT),
    });
    let start = Vec3::new(5.0, 5.0, 5.0);
    let parcels = [(start, Vec3::new(1.0, 2.0, -0.5))];
    let mut bed = ParcelBed::new(&mesh, &setup(rules, &parcels, 1e-3, 7.0));
    bed.run(windows, 1.0 / windows as f64);
    bed
}

#[test]
fn a_velocity_decays_to_that_of_the_wall_at_any_window() {
    for windows in [1, 2, 50] {
        let bed = thrown(windows, Vec3::zeros());
        let fields = bed.parcels.fields();
        let off = Vec3::new(1.0, 2.0, -0.5) - BELT;
        let velocity = BELT + (-RATE).exp() * off;
        let place = Vec3::new(5.0, 5.0, 5.0) + BELT + (1.0 - (-RATE).exp()) / RATE * off;
        assert!((fields.velocity[0] - velocity).norm() < 1e-13, "{windows}");
        assert!((fields.position[0] - place).norm() < 1e-13, "{windows}");
    }
}

#[test]
fn what_falls_comes_to_g_over_c_and_the_wall_is_told_of_its_impulse() {
    let gravity = Vec3::new(0.0, 0.0, -0.4);
    let bed = thrown(1, gravity);
    let fields = bed.parcels.fields();
    let end = gravity / RATE + BELT;
    let velocity = end + (-RATE).exp() * (Vec3::new(1.0, 2.0, -0.5) - end);
    assert!((fields.velocity[0] - velocity).norm() < 1e-13);
    let mass = fields.row_mass(0);
    let given = mass * (velocity - Vec3::new(1.0, 2.0, -0.5) - gravity);
    let support = bed.received.support.unwrap();
    assert!((support - given).norm() < 1e-13 * given.norm(), "{support}");
}

#[test]
fn drag_and_resistance_are_booked_to_gas_and_wall_apart() {
    let mesh = wide();
    let mut rules = motion(&mesh, 1.0, 0.0);
    rules.resistance = Some(ParcelResistance {
        rate: RATE,
        wall: WallMotion::Translating(BELT),
    });
    let start = Vec3::new(1.0, 2.0, -0.5);
    let parcels = [(Vec3::new(5.0, 5.0, 5.0), start)];
    let mut bed = ParcelBed::new(&mesh, &setup(rules, &parcels, 1e-3, 7.0));
    let mass = bed.parcels.fields().mass[0];
    let (k, gas) = (1.3, Vec3::new(0.0, 0.5, 1.0));
    let mut push = ParticlePush {
        force: vec![Vec3::zeros()],
        ..ParticlePush::default()
    };
    push.columns.set(DRAG_COEFFICIENT, 1, vec![k * mass]);
    push.columns
        .set(GAS_VELOCITY, 3, <[f64; 3]>::from(gas).to_vec());
    bed.window(1.0, &push);
    let fields = bed.parcels.fields();
    let mean = (k * gas + RATE * BELT) / (k + RATE);
    let left = (-(k + RATE)).exp();
    let velocity = mean + left * (start - mean);
    let way = mean + (1.0 - left) / (k + RATE) * (start - mean);
    assert!((fields.velocity[0] - velocity).norm() < 1e-13);
    let by_gas = mass * k * (gas - way);
    let by_wall = fields.row_mass(0) * RATE * (BELT - way);
    let told = bed.received.columns.get(DRAG_IMPULSE, 3, 1).unwrap();
    let told = Vec3::new(told[0], told[1], told[2]);
    assert!((told - by_gas).norm() < 1e-13 * by_gas.norm(), "{told}");
    let support = bed.received.support.unwrap();
    assert!(
        (support - by_wall).norm() < 1e-13 * by_wall.norm(),
        "{support}"
    );
}
