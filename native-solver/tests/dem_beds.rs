//! Many spheres: conservation, packing, threads, coming and going.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

use std::f64::consts::PI;

use calcine_coupler::motion::{
    Cohesion, ContactForce, Contacts, ParticleChanges, Resized, Rolling, WallMotion, WallShape,
};
use calcine_coupler::part::Particles;
use calcine_coupler::physics::Vec3;

use crate::grains::*;

#[test]
fn a_frictionless_elastic_box_keeps_its_energy() {
    let mut contacts = contacts(2e-6);
    contacts.pairs[0].restitution = 1.0;
    contacts.pairs[0].friction = 0.0;
    contacts.walls = cuboid(Vec3::zeros(), Vec3::repeat(0.03));
    let mut bed = Bed::new(contacts, &loose([10, 10, 10], 3e-3, 1e-3, 1.0));
    bed.particles.count_energy(true);
    bed.run(1);
    let before = bed.particles.energy();
    bed.run(9999);
    let after = bed.particles.energy();
    let drift = after.stored() / before.stored() - 1.0;
    assert!(drift.abs() < 1e-4, "{drift}");
    assert_eq!(after.lost(), 0.0);
    assert_eq!(after.rotational, 0.0);
    let (searches, _) = bed.particles.engine().unwrap().effort();
    assert!((10..2000).contains(&searches), "{searches}");
}

#[test]
fn a_cloud_keeps_its_momentum_to_round_off() {
    let mut contacts = contacts(5e-6);
    contacts.pairs[0].restitution = 0.7;
    // A cloud that falls in on itself.
    let mut spheres = loose([8, 8, 8], 3e-3, 1.2e-3, 0.3);
    for sphere in &mut spheres {
        sphere.velocity += (Vec3::repeat(0.012) - sphere.position) * 80.0 + Vec3::x();
    }
    let mut bed = Bed::new(contacts, &spheres);
    let before = bed.particles.energy();
    bed.run(3000);
    let after = bed.particles.energy();
    assert!(after.kinetic < 0.9 * before.kinetic);
    let drift = (after.momentum - before.momentum).norm() / before.momentum.norm();
    assert!(drift < 1e-12, "{drift}");
}

/// A cylinder of ten diameters across.
fn cylinder(step: f64, radius: f64) -> Contacts {
    let mut contacts = contacts(step);
    contacts.gravity = Vec3::z() * -9.81;
    contacts.materials[0].young = 5e6;
    contacts.walls = vec![
        plane(Vec3::zeros(), Vec3::z()),
        wall(WallShape::Cylinder {
            point: Vec3::zeros(),
            axis: Vec3::z(),
            radius,
        }),
    ];
    contacts
}

#[test]
fn spheres_settle_in_a_cylinder_to_the_void_fraction_of_a_random_bed() {
    let radius = 2e-3;
    let contacts = cylinder(4e-5, 0.02);
    let mut spheres = loose([8, 8, 30], 4.8e-3, radius, 0.2);
    for sphere in &mut spheres {
        sphere.position -= Vec3::new(0.0192, 0.0192, 0.0);
    }
    spheres.retain(|sphere| sphere.position.xy().norm() < 0.0175);
    for (k, sphere) in spheres.iter_mut().enumerate() {
        sphere.id = k as u64 + 1;
    }
    let count = spheres.len();
    let mut bed = Bed::new(contacts, &spheres);
    bed.particles.count_energy(true);
    bed.run(12_000);
    let energy = bed.particles.energy();
    assert!(energy.kinetic < 1e-4 * energy.work(), "{energy:?}");
    let fields = bed.particles.fields();
    // Volume within a core: a diameter from the wall, two above the floor and below the top.
    let mut heights: Vec<f64> = fields.position.iter().map(|place| place.z).collect();
    heights.sort_by(f64::total_cmp);
    let (low, high, core) = (
        4.0 * radius,
        heights[count - 40] - 4.0 * radius,
        0.02 - 2.0 * radius,
    );
    let mut next = scatter(3);
    let points = 40_000;
    let mut inside = 0;
    for _ in 0..points {
        let (angle, out) = (2.0 * PI * next(), core * next().sqrt());
        let point = Vec3::new(
            out * angle.cos(),
            out * angle.sin(),
            low + (high - low) * next(),
        );
        let near = |place: &Vec3| (place - point).norm_squared() < radius * radius;
        inside += u32::from(fields.position.iter().any(near));
    }
    let void = 1.0 - f64::from(inside) / f64::from(points);
    assert!(
        (0.38..0.42).contains(&void),
        "{void}, {count} spheres up to {high} m"
    );
    // Half a diameter from the wall the first layer leaves least (Benenati and Brosilow 1962, doi
    // 10.1002/aic.690080319: 0.2 to 0.25 in wider beds), a whole one from it much; more: `cargo xtask validate`.
    let mut at = |from_wall: f64| {
        let out = 0.02 - from_wall * 2.0 * radius;
        let free = (0..points).filter(|_| {
            let (angle, height) = (2.0 * PI * next(), low + (high - low) * next());
            let point = Vec3::new(out * angle.cos(), out * angle.sin(), height);
            let near = |place: &Vec3| (place - point).norm_squared() < radius * radius;
            !fields.position.iter().any(near)
        });
        free.count() as f64 / f64::from(points)
    };
    let (half, whole) = (at(0.55), at(0.98));
    assert!(
        (0.17..0.33).contains(&half) && whole > 0.42,
        "{half} {whole}"
    );
}

#[test]
fn counting_energies_changes_no_bit_of_the_motion() {
    for force in [
        ContactForce::HertzMindlin,
        ContactForce::Linear {
            characteristic_speed: 1.0,
        },
    ] {
        let run = |count: bool| {
            let mut contacts = cylinder(2e-5, 0.02);
            contacts.law.force = force;
            let mut spheres = loose([5, 5, 20], 4.5e-3, 2e-3, 1.0);
            let mut next = scatter(11);
            for sphere in &mut spheres {
                sphere.position -= Vec3::new(0.01125, 0.01125, 0.0);
                sphere.radius *= 0.5 + 0.5 * next();
            }
            let mut bed = Bed::new(contacts, &spheres);
            bed.particles.count_energy(count);
            bed.run(3000);
            bed.bits()
        };
        assert_eq!(run(false), run(true));
    }
}

/// What becomes of the energy of a shower of rough, damped spheres on a rising floor.
#[test]
fn the_energy_budget_closes_with_the_order_of_the_step() {
    let error = |step: f64, steps: u64| {
        let mut contacts = cylinder(step, 0.02);
        contacts.law.rolling = Rolling::ElasticPlastic;
        contacts.pairs[0].rolling_friction = 0.1;
        contacts.walls[0].motion = WallMotion::Translating(Vec3::z() * 0.2);
        let mut spheres = loose([4, 4, 4], 4.5e-3, 2e-3, 1.0);
        for sphere in &mut spheres {
            sphere.position -= Vec3::new(0.009, 0.009, 0.0);
        }
        let mut bed = Bed::new(contacts, &spheres);
        bed.particles.count_energy(true);
        let before = bed.particles.energy();
        bed.run(steps);
        let after = bed.particles.energy();
        assert!(after.lost() > 0.5 * before.stored());
        (after.balance() - before.balance()) / after.lost()
    };
    let (coarse, fine) = (error(4e-6, 10_000), error(1e-6, 40_000));
    assert!(coarse.abs() < 0.04, "{coarse}");
    assert!(fine.abs() < 0.4 * coarse.abs(), "{coarse} {fine}");
}

/// A few thousand spheres of all sizes in a turning drum, with every law's memory.
pub fn drum(rolling: Rolling, force: ContactForce) -> Bed {
    drum_with(rolling, force, |_| ())
}

/// The same with contacts that are changed.
pub fn drum_with(rolling: Rolling, force: ContactForce, change: impl Fn(&mut Contacts)) -> Bed {
    let mut contacts = cylinder(2e-5, 0.02);
    contacts.law.rolling = rolling;
    contacts.law.force = force;
    contacts.law.cohesion = Cohesion::Sjkr;
    contacts.pairs[0].rolling_friction = 0.1;
    contacts.pairs[0].rolling_damping = 0.3;
    contacts.pairs[0].cohesion_energy = 2e3;
    contacts.gravity = Vec3::new(-9.81, 0.0, -3.0);
    contacts.walls[1].motion = WallMotion::Rotating {
        point: Vec3::zeros(),
        angular_velocity: Vec3::z() * 20.0,
    };
    change(&mut contacts);
    let mut spheres = loose([10, 10, 26], 2.6e-3, 1.1e-3, 0.5);
    let mut next = scatter(5);
    for sphere in &mut spheres {
        sphere.position -= Vec3::new(0.013, 0.013, -1e-3);
        sphere.radius *= 0.2 + 0.8 * next();
    }
    Bed::new(contacts, &spheres)
}

#[test]
fn one_and_two_threads_give_the_same_bits() {
    let run = |threads| {
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(threads)
            .build()
            .unwrap();
        pool.install(|| {
            let mut bed = drum(Rolling::ElasticPlastic, ContactForce::HertzMindlin);
            bed.run(1500);
            bed.bits()
        })
    };
    assert_eq!(run(1), run(2));
}

#[test]
fn windows_of_any_length_give_the_same_bits() {
    let mut long = drum(Rolling::ConstantTorque, ContactForce::HertzMindlin);
    let mut short = drum(Rolling::ConstantTorque, ContactForce::HertzMindlin);
    long.run(600);
    for _ in 0..200 {
        short.run(3);
    }
    assert_eq!(long.bits(), short.bits());
}

#[test]
fn what_comes_to_rest_keeps_the_springs_of_its_contacts() {
    let mut contacts = contacts(1e-6);
    contacts.walls = vec![plane(Vec3::zeros(), Vec3::z())];
    contacts.gravity = Vec3::new(0.2 * 9.81, 0.0, -9.81);
    // No dashpot: springs alone decide how fast it gets.
    contacts.pairs[0].restitution = 1.0;
    let start = sphere(1, Vec3::z() * 1e-3, Vec3::zeros(), 1e-3);
    let mut bed = Bed::new(contacts, &[start]);
    bed.run(200);
    let before = bed.velocity(0);
    bed.run(1);
    let (step, place) = (bed.velocity(0) - before, bed.place(0));
    let rest = ParticleChanges {
        rest: true,
        ..ParticleChanges::default()
    };
    bed.change(&rest).unwrap();
    assert_eq!((bed.velocity(0), bed.spin(0)), Default::default());
    assert_eq!(bed.place(0), place);
    bed.run(1);
    let off = (bed.velocity(0) - step).norm() / step.norm();
    // Without its spring it would feel the full slope.
    let slope = 0.2 * 9.81e-6;
    assert!(off < 0.02 && step.x < 0.9 * slope, "{off}: {step}");
}

#[test]
fn particles_come_and_go_and_the_others_do_not_notice() {
    let mut contacts = contacts(1e-5);
    contacts.walls = vec![plane(Vec3::zeros(), Vec3::z())];
    contacts.gravity = Vec3::z() * -9.81;
    let at = |id, x: f64| sphere(id, Vec3::new(x, 0.0, 9.9e-4), Vec3::x() * 0.1, 1e-3);
    let spheres = [at(1, 0.0), at(2, 0.01), at(5, 0.02)];
    let mut alone = Bed::new(contacts.clone(), &[at(1, 0.0)]);
    let mut bed = Bed::new(contacts, &spheres);
    alone.run(300);
    bed.run(300);
    let change = ParticleChanges {
        remove: vec![5, 2],
        insert: vec![at(6, 0.03), at(9, 0.04)],
        ..ParticleChanges::default()
    };
    bed.change(&change).unwrap();
    let fields = bed.particles.fields();
    assert_eq!(fields.id, [1, 6, 9]);
    assert_eq!(fields.position[1], Vec3::new(0.03, 0.0, 9.9e-4));
    assert!((fields.velocity[1].x / 0.1 - 1.0).abs() < 1e-15);
    alone.run(300);
    bed.run(300);
    assert!((bed.place(0) - alone.place(0)).norm() < 1e-9);
    for wrong in [
        ParticleChanges {
            remove: vec![7],
            insert: vec![],
            ..ParticleChanges::default()
        },
        ParticleChanges {
            remove: vec![],
            insert: vec![at(4, 0.0)],
            ..ParticleChanges::default()
        },
    ] {
        assert!(bed.change(&wrong).is_err());
        assert_eq!(bed.particles.fields().id, [1, 6, 9]);
    }
}

#[test]
fn a_bead_that_becomes_smaller_and_lighter_sinks_into_the_floor_as_hertz_says() {
    let mut contacts = contacts(1e-5);
    contacts.walls = vec![plane(Vec3::zeros(), Vec3::z())];
    contacts.gravity = Vec3::z() * -9.81;
    let mut bed = Bed::new(
        contacts,
        &[sphere(1, Vec3::new(0.0, 0.0, 1e-3), Vec3::zeros(), 1e-3)],
    );
    bed.run(20_000);
    let overlap = |bed: &Bed| bed.particles.fields().radius[0] - bed.place(0).z;
    let before = overlap(&bed);
    let mass = bed.particles.fields().mass[0];
    let new = Resized {
        id: 1,
        radius: 0.5e-3,
        mass: 0.25 * mass,
    };
    let change = ParticleChanges {
        resize: vec![new],
        ..ParticleChanges::default()
    };
    bed.change(&change).unwrap();
    let fields = bed.particles.fields();
    assert_eq!((fields.radius[0], fields.mass[0]), (0.5e-3, 0.25 * mass));
    assert_eq!(bed.place(0).x, 0.0);
    bed.run(40_000);
    // 4/3 E* √R δ^1.5 = m g: δ goes by (m²/R)^(1/3), here (1/16 · 2)^(1/3) = 1/2.
    let after = overlap(&bed);
    assert!((after / before - 0.5).abs() < 1e-3, "{before} {after}");
    let nobody = ParticleChanges {
        resize: vec![Resized { id: 7, ..new }],
        ..ParticleChanges::default()
    };
    assert!(bed.change(&nobody).is_err());
}

#[test]
fn unequal_spheres_of_one_class_of_sizes_lie_on_each_other() {
    let mut contacts = contacts(1e-5);
    contacts.gravity = Vec3::z() * -9.81;
    contacts.walls = cuboid(Vec3::zeros(), Vec3::repeat(0.02));
    let mut spheres = loose([8, 8, 8], 2.5e-3, 1e-3, 0.1);
    for (k, sphere) in spheres.iter_mut().enumerate() {
        sphere.radius = 1e-3 * (0.8 + 0.02 * ((7 * k) % 11) as f64);
    }
    let mut bed = Bed::new(contacts, &spheres);
    bed.run(30_000);
    let fields = bed.particles.fields();
    let mut deepest = 0.0f64;
    for a in 0..fields.len() {
        for b in a + 1..fields.len() {
            let apart = (fields.position[a] - fields.position[b]).norm();
            deepest = deepest.max(fields.radius[a] + fields.radius[b] - apart);
        }
    }
    // 20 mm of glass on 10 MPa press them together by less than a hundredth of a radius.
    assert!(deepest < 8e-6, "{deepest} m");
}

#[test]
fn a_held_population_stays_and_carries_the_others() {
    let mut contacts = contacts(1e-5);
    contacts.gravity = Vec3::z() * -9.81;
    let mut below = sphere(1, Vec3::zeros(), Vec3::x(), 1e-3);
    below.population = 1;
    let above = sphere(2, Vec3::z() * 2e-3, Vec3::zeros(), 1e-3);
    let mut bed = Bed::new(contacts, &[below, above]);
    bed.push.force[0] = Vec3::x();
    bed.run(20_000);
    assert_eq!(bed.place(0), Vec3::zeros());
    assert_eq!(bed.velocity(0), Vec3::zeros());
    assert!((bed.received.impulse[0].x / 0.2 - 1.0).abs() < 1e-12);
    let weight = bed.particles.fields().mass[1] * 9.81;
    let stiffness = 4.0 / 3.0 * (1e7 / 1.875) * 5e-4f64.sqrt();
    let rest = 2e-3 - (weight / stiffness).powf(2.0 / 3.0);
    assert!(
        (bed.place(1).z - rest).abs() < 1e-5 * (2e-3 - rest),
        "{}",
        bed.place(1).z
    );
}

#[test]
fn a_sphere_that_leaves_its_bounds_is_named_with_place_and_velocity() {
    let at = |id, speed: f64| sphere(id, Vec3::x() * (0.1 * id as f64), Vec3::z() * speed, 1e-3);
    let mut bed = Bed::new(contacts(1e-3), &[at(3, 0.1), at(8, 30.0)]);
    let text = bed.try_run(100).unwrap_err().to_string();
    assert!(
        text.contains("particle 8 left the box about the gas mesh at (0.8, 0, 1."),
        "{text}"
    );
    assert!(text.contains("velocity of (0, 0, 30) m/s"), "{text}");
    let outside = sphere(4, Vec3::x() * 2.0, Vec3::zeros(), 1e-3);
    let text = Bed::try_new(contacts(1e-3), &[outside])
        .err()
        .unwrap()
        .to_string();
    assert!(text.contains("particle 4 left the box"), "{text}");
}

#[test]
fn setups_without_meaning_are_refused_with_their_place() {
    let refused = |contacts: Contacts| {
        let sphere = sphere(1, Vec3::zeros(), Vec3::zeros(), 1e-3);
        Bed::try_new(contacts, &[sphere]).err().unwrap().to_string()
    };
    let mut wrong = contacts(0.0);
    assert!(refused(wrong.clone()).contains("the time step of the motion of particles is 0 s"));
    wrong.step = 1e-5;
    wrong.pairs[0].restitution = 0.0;
    let text = refused(wrong.clone());
    assert!(
        text.contains("the restitution of materials 0 and 0 is 0"),
        "{text}"
    );
    wrong.pairs[0].restitution = 0.5;
    wrong.walls = vec![plane(Vec3::zeros(), Vec3::z() * 2.0)];
    let text = refused(wrong.clone());
    assert!(
        text.contains("the length of the normal of wall `wall` is 2"),
        "{text}"
    );
    wrong.walls[0].material = 3;
    assert!(refused(wrong).contains("the index of the material of wall `wall` is 3"));
}
