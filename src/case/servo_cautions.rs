//! Walls that hold a force and are too light for the contacts that may push them.

use calcine_coupler::mesh::Mesh;
use calcine_coupler::motion::WallMotion;
use calcine_coupler::physics::{Vec3, sphere};
use calcine_coupler::setup::ParticleSetup;

use super::model::Case;
use super::moving::moving_spheres;
use super::units::shown;

/// Least mass of a wall over that of all particles that it can touch: their contacts, which the step resolves with the mass of one particle each,
/// push the wall together. A wall of a tenth of a particle on 64 of them was thrown, one of a half was not.
const LEAST: f64 = 0.01;

/// A warning for each wall that is lighter.
pub(super) fn all(case: &Case, mesh: &Mesh, setup: &ParticleSetup) -> Vec<String> {
    let [low, high] = mesh.bounds();
    let size = high - low;
    let spheres = || moving_spheres(case, setup);
    let smallest = spheres()
        .map(|one| one.radius[0])
        .fold(f64::INFINITY, f64::min);
    let lightest = spheres().map(|one| sphere::mass(one.radius[0], one.density));
    let lightest = lightest.fold(f64::INFINITY, f64::min);
    if !smallest.is_finite() {
        return Vec::new();
    }
    let mut all = Vec::new();
    for wall in &case.walls {
        let WallMotion::Servo {
            direction, mass, ..
        } = wall.motion
        else {
            continue;
        };
        let across = Vec3::new(size.y * size.z, size.z * size.x, size.x * size.y);
        let touched = (across.dot(&direction.abs()) / (4.0 * smallest * smallest)).max(1.0);
        let least = LEAST * touched * lightest;
        if mass < least {
            all.push(format!(
                "the wall `{}`, which holds a force, has a mass of {} kg, less than a hundredth of the {:.0} particles that it can touch: their contacts may \
                 throw it; write a mass of {} kg or more",
                wall.name,
                shown(mass),
                touched,
                shown(least)
            ));
        }
    }
    all
}
