//! Spheres that touch across LIGGGHTS' ranks, while others come and go: springs stay with their contacts, and
//! what the two ranks of a pair give each other cancels.

#![allow(
    clippy::print_stdout,
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::panic
)]

use calcine_adapters::particles::LinkedParticles;
use calcine_coupler::motion::{NewParticle, ParticleChanges};
use calcine_coupler::part::{
    DRAG_COEFFICIENT, DRAG_IMPULSE, GAS_VELOCITY, ParticlePush, Particles,
};
use calcine_coupler::physics::Vec3;
use calcine_coupler::setup::ParticleSetup;

use crate::liggghts_support::{
    Bench, MASS, contacts, heap, heap_from, momentum, setup, setup_with,
};

/// A sphere that comes in above the heap and away from it, at a place along x in m.
fn elsewhere(id: u64, x: f64) -> NewParticle {
    NewParticle {
        id,
        population: 0,
        position: Vec3::new(x, 0.09, 0.08),
        velocity: Vec3::zeros(),
        radius: 0.0025,
        density: 2500.0,
        weight: 1.0,
    }
}

/// The heap behind a lone sphere of id 1, which goes first.
fn heap_and_one() -> ParticleSetup {
    let mut spheres = vec![(Vec3::new(0.01, 0.01, 0.08), Vec3::zeros())];
    let heap = heap();
    spheres.extend(heap.position.iter().map(|&centre| (centre, Vec3::zeros())));
    setup(contacts(Vec3::new(0.0, 0.0, -9.81)), &spheres)
}

/// Pushed aside and pressed down, so that contacts slide and stick.
fn press(particles: &LinkedParticles) -> Vec<Vec3> {
    let each = particles.fields().id.iter();
    each.map(|&id| Vec3::new(2e-4 * (id % 5) as f64, 1e-4, -1e-3))
        .collect()
}

/// Velocities after 15 ms in which the heap comes to rest on itself, a change, and 1 ms more; of the heap.
fn after(change: &ParticleChanges) -> Vec<Vec3> {
    let mut bench = Bench::new();
    let mut particles = bench.launch(&heap_and_one(), "a", None);
    let push = press(&particles);
    bench.window(&mut particles, 1.5e-2, &push).unwrap();
    particles.change(&bench.supervisor, change).unwrap();
    let push = press(&particles);
    bench.window(&mut particles, 1e-3, &push).unwrap();
    let fields = particles.fields();
    let own = fields.id.iter().zip(fields.velocity);
    own.filter(|(id, _)| (2..=41).contains(*id))
        .map(|(_, velocity)| *velocity)
        .collect()
}

#[test]
fn springs_stay_with_their_contacts_where_others_come_and_go() {
    let change = |remove: &[u64], insert: &[u64]| ParticleChanges {
        remove: remove.to_vec(),
        insert: insert.iter().map(|&id| elsewhere(id, 0.09)).collect(),
        ..ParticleChanges::default()
    };
    // One that comes takes the last place: nobody moves.
    let undisturbed = after(&change(&[], &[50]));
    // The first that goes has the last one, of the heap, take its place.
    let moved = after(&change(&[1], &[]));
    let largest = undisturbed.iter().map(|v| v.norm()).fold(0.0, f64::max);
    assert!(largest > 1e-3, "{largest}");
    let apart = undisturbed.iter().zip(&moved).map(|(a, b)| (a - b).norm());
    let apart = apart.fold(0.0, f64::max);
    println!("{apart:.1e} m/s apart of {largest:.1e}");
    // Another order of the sums, over 1000 steps of contacts.
    assert!(apart < 1e-9 * largest, "{apart} of {largest} m/s");
}

/// The heap from a place along x in m on, pushed together until its spheres touch.
fn touching_from(x: f64) -> ParticleSetup {
    let mut all_free = contacts(Vec3::new(0.0, 0.0, -9.81));
    all_free.held = vec![false, false];
    let mut setup = setup_with(all_free, &heap_from(x));
    for centre in &mut setup.position {
        // From 5.2 and 5.1 mm apart to 4.99 mm, the lowest on the floor.
        let corner = Vec3::new(x, 0.04, 0.0026);
        let apart = (*centre - corner).component_mul(&Vec3::new(0.9596, 0.9596, 0.9784));
        *centre = corner + apart - Vec3::new(0.0, 0.0, 1.05e-4);
    }
    setup
}

#[test]
fn what_two_and_three_ranks_give_each_other_cancels_while_particles_come_and_go() {
    for (ranks, x) in [(1, 0.04), (2, 0.045), (3, 0.028)] {
        let mut bench = Bench::new();
        bench.ranks = ranks;
        let setup = touching_from(x);
        let mut particles = bench.launch(&setup, "a", None);
        let mut worst = 0.0f64;
        for round in 0..8u64 {
            let push = press(&particles);
            let before = momentum(&particles);
            let impulse = bench.window(&mut particles, 2e-4, &push).unwrap();
            let count = particles.fields().len() as f64;
            let weight = count * MASS * bench.acted * Vec3::new(0.0, 0.0, -9.81);
            let pushed: Vec3 = impulse.iter().sum();
            let support = bench.support.unwrap();
            let left = momentum(&particles) - before - pushed - weight - support;
            worst = worst.max(left.norm() / weight.norm());
            let ids = particles.fields().id;
            let change = ParticleChanges {
                remove: vec![ids[ids.len() / 2]],
                insert: vec![elsewhere(100 + round, 0.01 + 0.01 * round as f64)],
                ..ParticleChanges::default()
            };
            particles.change(&bench.supervisor, &change).unwrap();
            assert_eq!(particles.fields().len(), 40);
        }
        println!("{ranks} ranks: {worst:.1e} of the weight");
        assert!(worst < 1e-12, "{ranks} ranks: {worst}");
    }
}

#[test]
fn drag_that_follows_particles_goes_with_them_from_rank_to_rank_and_closes_their_momentum() {
    let gravity = Vec3::new(0.0, 0.0, -9.81);
    for (ranks, x) in [(1, 0.04), (2, 0.045), (3, 0.028)] {
        let mut bench = Bench::new();
        bench.ranks = ranks;
        let mut particles = bench.launch(&touching_from(x), "a", None);
        let (start, mut worst) = (particles.fields().position[0].x, 0.0f64);
        for round in 0..8u64 {
            // A gale along x with relaxation times of a third of a window, which carries the heap over a rank's end.
            let count = particles.fields().len();
            let mut push = ParticlePush {
                force: press(&particles),
                ..ParticlePush::default()
            };
            let gas = (0..count).flat_map(|p| [5.0, 0.1 * p as f64, 0.0]);
            push.columns.set(GAS_VELOCITY, 3, gas.collect());
            let drag = vec![MASS / 7e-5; count];
            push.columns.set(DRAG_COEFFICIENT, 1, drag);
            let before = momentum(&particles);
            let received = bench.push(&mut particles, 2.003e-4, &push).unwrap();
            let drags = received.columns.get(DRAG_IMPULSE, 3, count).unwrap();
            let dragged: Vec3 = drags
                .as_chunks::<3>()
                .0
                .iter()
                .map(|x| Vec3::from(*x))
                .sum();
            let forced: Vec3 = push.force.iter().map(|force| force * 2.003e-4).sum();
            let pushed: Vec3 = received.impulse.iter().sum();
            assert!((pushed - forced - dragged).norm() < 1e-13 * dragged.norm());
            let weight = count as f64 * MASS * received.acted * gravity;
            let left = momentum(&particles) - before - pushed - weight - received.support.unwrap();
            worst = worst.max(left.norm() / dragged.norm().max(weight.norm()));
            let ids = particles.fields().id;
            let change = ParticleChanges {
                remove: vec![ids[ids.len() / 2]],
                insert: vec![elsewhere(100 + round, 0.01 + 0.01 * round as f64)],
                ..ParticleChanges::default()
            };
            particles.change(&bench.supervisor, &change).unwrap();
        }
        let way = particles.fields().position[0].x - start;
        println!("{ranks} ranks: {worst:.1e}; the first particle went {way} m");
        assert!(worst < 1e-12, "{ranks} ranks: {worst}");
        assert!(way > 5e-3, "{way}");
    }
}
