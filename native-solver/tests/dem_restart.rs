//! Checkpoints of moving spheres: to the bit, writing one changes nothing, and a bed goes on from one as from itself.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

use calcine_coupler::motion::{
    ContactForce, Contacts, ParticleChanges, Rolling, WallMotion, WallShape,
};
use calcine_coupler::part::Part;
use calcine_coupler::physics::Vec3;

use crate::dem_beds::drum;
use crate::grains::*;

/// A bed that goes on after `before` steps, one that writes a checkpoint there, and one that goes on from it.
pub fn goes_on_alike(make: impl Fn() -> Bed, before: u64) {
    let folder = tempfile::tempdir().unwrap();
    let (mut alone, mut through, mut resumed) = (make(), make(), make());
    if before > 0 {
        alone.run(before);
        through.run(before);
    }
    through.particles.checkpoint(folder.path()).unwrap();
    resumed.particles.restore(folder.path()).unwrap();
    resumed.clocks = through.clocks;
    assert_eq!(resumed.bits(), through.bits());
    // Across several searches for neighbours.
    for steps in [1, 99, 300] {
        for bed in [&mut alone, &mut through, &mut resumed] {
            bed.run(steps);
        }
        assert_eq!(through.bits(), alone.bits());
        assert_eq!(resumed.bits(), alone.bits());
        assert_eq!(through.received, alone.received);
        assert_eq!(resumed.received, alone.received);
    }
    assert!(resumed.particles.engine().unwrap().effort().0 > 3);
}

#[test]
fn a_checkpoint_changes_nothing_and_a_resumed_bed_goes_on_alike_with_every_law() {
    let linear = ContactForce::Linear {
        characteristic_speed: 1.0,
    };
    for (rolling, force) in [
        (Rolling::ElasticPlastic, ContactForce::HertzMindlin),
        (Rolling::ConstantTorque, ContactForce::SpringSliderDashpot),
        (Rolling::None, ContactForce::OpenfoamSpringSliderDashpot),
        (Rolling::None, linear),
    ] {
        goes_on_alike(|| drum(rolling, force), 1000);
    }
}

/// The faces of a box, each of 2 n² triangles.
fn faces(low: Vec3, high: Vec3, n: usize) -> WallShape {
    let size = high - low;
    let mut triangles = Vec::new();
    for axis in 0..3 {
        let [mut a, mut b] = [Vec3::zeros(), Vec3::zeros()];
        let (along, across) = ((axis + 1) % 3, (axis + 2) % 3);
        a[along] = size[along] / n as f64;
        b[across] = size[across] / n as f64;
        for far in [false, true] {
            let mut corner = low;
            if far {
                corner[axis] = high[axis];
            }
            for i in 0..n {
                for j in 0..n {
                    let at = corner + i as f64 * a + j as f64 * b;
                    triangles.extend([[at, at + a, at + b], [at + a, at + a + b, at + b]]);
                }
            }
        }
    }
    WallShape::Mesh { triangles }
}

/// Rough spheres in a turning box of triangles, in whose edges and corners they touch several, one of them held.
fn box_of_triangles() -> Bed {
    box_with(|_| ())
}

/// The same with contacts that are changed.
pub fn box_with(change: impl Fn(&mut Contacts)) -> Bed {
    let mut contacts = contacts(1e-5);
    contacts.gravity = Vec3::z() * -9.81;
    contacts.material_of = vec![0; 2];
    contacts.held = vec![false, true];
    let (low, high) = (Vec3::new(-8e-3, -8e-3, 0.0), Vec3::new(8e-3, 8e-3, 0.03));
    contacts.walls = vec![wall(faces(low, high, 4))];
    contacts.walls[0].motion = WallMotion::Rotating {
        point: Vec3::zeros(),
        angular_velocity: Vec3::y() * 5.0,
    };
    change(&mut contacts);
    let mut spheres = loose([6, 6, 8], 2.5e-3, 1e-3, 0.5);
    for sphere in &mut spheres {
        sphere.position -= Vec3::new(7.5e-3, 7.5e-3, 0.0);
        sphere.population = u32::from(sphere.id == 100);
    }
    Bed::new(contacts, &spheres)
}

#[test]
fn a_checkpoint_changes_nothing_at_moving_triangles_and_held_spheres() {
    for before in [997, 4000] {
        goes_on_alike(box_of_triangles, before);
    }
}

/// What comes and goes has forces evaluated anew; a checkpoint right after that has them, too.
#[test]
fn a_checkpoint_right_after_a_change_changes_nothing() {
    let make = || {
        let mut bed = box_of_triangles();
        bed.run(1500);
        let change = ParticleChanges {
            remove: vec![3, 50],
            insert: vec![sphere(500, Vec3::new(0.0, 0.0, 0.028), Vec3::zeros(), 5e-4)],
            ..ParticleChanges::default()
        };
        bed.change(&change).unwrap();
        bed
    };
    goes_on_alike(make, 0);
    goes_on_alike(make, 7);
}

#[test]
fn a_checkpoint_keeps_the_springs_of_resting_contacts() {
    let folder = tempfile::tempdir().unwrap();
    let mut contacts = contacts(1e-6);
    contacts.walls = vec![plane(Vec3::zeros(), Vec3::z())];
    // On an incline that friction holds.
    contacts.gravity = Vec3::new(0.2 * 9.81, 0.0, -9.81);
    let mut bed = Bed::new(
        contacts,
        &[sphere(1, Vec3::z() * 1e-3, Vec3::zeros(), 1e-3)],
    );
    bed.run(200);
    let before = bed.velocity(0);
    bed.run(1);
    let step = bed.velocity(0) - before;
    bed.particles.checkpoint(folder.path()).unwrap();
    let before = bed.velocity(0);
    bed.run(1);
    // Without its spring it would feel the full slope.
    assert!(((bed.velocity(0) - before) - step).norm() < 0.1 * step.norm());
}
