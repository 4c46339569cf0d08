//! The time step against the times that bound it.
#![allow(clippy::unwrap_used)]

mod grains;

use calcine_coupler::physics::Vec3;
use calcine_native::particles::dem::step::check_step;
use grains::*;

#[test]
fn the_smallest_sphere_bounds_the_step() {
    let mut contacts = contacts(1e-5);
    contacts.materials[0].young = 5e7;
    contacts.materials[0].poisson = 0.22;
    let at = |id, radius| sphere(id, Vec3::x() * (0.01 * id as f64), Vec3::zeros(), radius);
    let setup = setup(contacts.clone(), &[at(1, 2e-3), at(2, 1e-3), at(3, 3e-3)]);
    let found = check_step(&setup, &contacts, 1.0).unwrap();
    assert_eq!(found.particle, 1);
    // By hand, as in the unit test of the Rayleigh time.
    assert!((found.rayleigh_fraction / (1e-5 / 3.802_817_5e-5) - 1.0).abs() < 1e-6);
    // m* = 5.235988e-6 kg, R* = 0.5 mm, E* = 2.6271542e7 Pa: (m*²/(R* E*² V))^0.2 = 3.80...e-5 s
    let star = 5e7 / (2.0 * (1.0 - 0.22 * 0.22));
    let wanted = 2.868_265_7 * (5.235_988e-6f64.powi(2) / (5e-4 * star * star)).powf(0.2);
    assert!((found.collision / wanted - 1.0).abs() < 1e-6);
    assert!(check_step(&grains::setup(contacts.clone(), &[]), &contacts, 1.0).is_none());
}
