//! The LIGGGHTS host, as it is built, with spheres that move: exact impulses, particles that come and go,
//! contacts, checkpoints, losses.

#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

use std::path::Path;

use calcine_adapters::particles::LinkedParticles;
use calcine_coupler::motion::{
    Cohesion, ContactForce, Contacts, NewParticle, ParticleChanges, Resized, Wall, WallMotion,
    WallShape,
};
use calcine_coupler::named_columns::NamedColumns;
use calcine_coupler::part::{DRAG_COEFFICIENT, GAS_VELOCITY, Part, ParticlePush, Particles};
use calcine_coupler::physics::Vec3;

use crate::liggghts_support::{Bench, MASS, contacts, heap, momentum, setup, setup_with};

#[test]
fn the_impulse_of_a_force_is_exact_also_where_it_changes_and_the_window_is_no_whole_number_of_steps()
 {
    let mut bench = Bench::new();
    let still = (Vec3::repeat(0.05), Vec3::zeros());
    let setup = setup(contacts(Vec3::zeros()), &[still]);
    let mut particles = bench.launch(&setup, "a", None);
    let mut expected = Vec3::zeros();
    for (force, span) in [(1e-3, 1e-4), (-3e-3, 1.004e-4), (2e-3, 5.3e-6)] {
        let force = Vec3::new(force, 0.0, 0.5 * force);
        let impulse = bench.window(&mut particles, span, &[force]).unwrap();
        expected += force * span;
        assert!((impulse[0] - force * span).norm() < 1e-15 * impulse[0].norm());
        let momentum = MASS * particles.fields().velocity[0];
        assert!(
            (momentum - expected).norm() < 1e-12 * expected.norm(),
            "{momentum} {expected}"
        );
    }
}

#[test]
fn gravity_and_restitution_are_those_of_the_case() {
    let mut bench = Bench::new();
    let down = Vec3::new(0.0, 0.0, -0.5);
    let setup = setup(
        contacts(Vec3::zeros()),
        &[(Vec3::new(0.05, 0.05, 0.004), down)],
    );
    let mut particles = bench.launch(&setup, "a", None);
    bench
        .window(&mut particles, 8e-3, &[Vec3::zeros()])
        .unwrap();
    let up = particles.fields().velocity[0].z;
    // Damping that may attract gives the stated restitution.
    assert!((up / 0.5 - 0.5).abs() < 0.005, "{up}");

    // A force that is cut at zero gives more: 0.55 for 0.5.
    let mut cut = contacts(Vec3::zeros());
    cut.law.attractive_damping = false;
    let setup = setup_with(cut, &setup);
    let mut particles = bench.launch(&setup, "b", None);
    bench
        .window(&mut particles, 8e-3, &[Vec3::zeros()])
        .unwrap();
    let up = particles.fields().velocity[0].z;
    assert!((up / 0.5 - 0.55).abs() < 0.01, "{up}");

    let free = self::setup(
        contacts(Vec3::new(0.0, 0.0, -9.81)),
        &[(Vec3::repeat(0.05), Vec3::zeros())],
    );
    let mut particles = bench.launch(&free, "c", None);
    bench
        .window(&mut particles, 1e-2, &[Vec3::zeros()])
        .unwrap();
    let speed = particles.fields().velocity[0].z;
    assert!((speed + 0.0981).abs() < 1e-12, "{speed}");
}

#[test]
fn a_heap_gains_what_gravity_the_floor_and_its_pushes_give() {
    let mut bench = Bench::new();
    let mut all_free = contacts(Vec3::new(0.0, 0.0, -9.81));
    all_free.held = vec![false, false];
    let setup = setup_with(all_free, &heap());
    let mut particles = bench.launch(&setup, "a", None);
    let push: Vec<Vec3> = (0..40).map(|k| Vec3::x() * 1e-4 * f64::from(k)).collect();
    let mut given = 0.0;
    for span in [1e-3, 1.004e-3, 7.31e-3, 2e-2] {
        let before = momentum(&particles);
        let impulse = bench.window(&mut particles, span, &push).unwrap();
        let support = bench.support.unwrap();
        let weight = 40.0 * MASS * bench.acted * Vec3::new(0.0, 0.0, -9.81);
        let pushed: Vec3 = impulse.iter().sum();
        let left = momentum(&particles) - before - pushed - weight - support;
        assert!(left.norm() < 1e-12 * weight.norm(), "{left} of {weight}");
        given += support.z;
    }
    // In the end the floor carries them.
    assert!(given > 0.5 * 40.0 * MASS * 9.81 * 2e-2, "{given}");

    // What held particles give LIGGGHTS does not tell: then nothing is said.
    let mut bench = Bench::new();
    let mut particles = bench.launch(&heap(), "b", None);
    bench.window(&mut particles, 1e-3, &push).unwrap();
    assert_eq!(bench.support, None);
}

#[test]
fn particles_come_and_go_with_the_ids_they_are_given_and_the_others_do_not_notice() {
    let mut bench = Bench::new();
    let setup = heap();
    let mut particles = bench.launch(&setup, "a", None);
    bench
        .window(&mut particles, 1e-3, &[Vec3::zeros(); 40])
        .unwrap();
    let before: Vec<Vec3> = particles.fields().position.to_vec();
    let new = |id: u64, x: f64| NewParticle {
        id,
        population: 0,
        position: Vec3::new(x, 1.0 / 30.0, 0.08),
        velocity: Vec3::new(0.1, 0.0, -1.0 / 3.0),
        radius: 0.002,
        density: 2000.0,
        weight: 1.0,
    };
    // The highest ids go; those that come go on behind them, with a gap.
    let change = ParticleChanges {
        remove: vec![3, 39, 40],
        insert: vec![new(41, 0.01), new(57, 0.02)],
        ..ParticleChanges::default()
    };
    particles.change(&bench.supervisor, &change).unwrap();
    let fields = particles.fields();
    let expected: Vec<u64> = (1..=38).filter(|id| *id != 3).chain([41, 57]).collect();
    assert_eq!(fields.id, expected);
    assert_eq!(fields.position[0], before[0]);
    assert_eq!(fields.position[2], before[3]);
    let last = fields.len() - 1;
    assert_eq!(fields.position[last], new(57, 0.02).position);
    assert_eq!(fields.velocity[last].z, -1.0 / 3.0);
    assert_eq!(fields.radius[last], 0.002);
    assert!(
        (fields.mass[last] / (4.0 / 3.0 * std::f64::consts::PI * 8e-9 * 2000.0) - 1.0).abs()
            < 1e-14
    );
    // A particle that went leaves a gap; the rest goes on as a heap at rest does.
    let forces = vec![Vec3::zeros(); 39];
    bench.window(&mut particles, 1e-3, &forces).unwrap();
    let fall = particles.fields().velocity[38] - new(57, 0.02).velocity;
    assert!(
        (fall - Vec3::new(0.0, 0.0, -9.81e-3)).norm() < 1e-12,
        "it falls: {fall}"
    );
    let speeds = particles.fields().velocity[..30].iter().map(|v| v.norm());
    assert!(speeds.fold(0.0, f64::max) < 0.2);
    // All may be replaced, again and again.
    let all = particles.fields().id.to_vec();
    let change = ParticleChanges {
        remove: all,
        insert: vec![new(100, 0.03)],
        ..ParticleChanges::default()
    };
    particles.change(&bench.supervisor, &change).unwrap();
    assert_eq!(particles.fields().id, [100]);
    bench
        .window(&mut particles, 1e-3, &[Vec3::zeros()])
        .unwrap();
}

#[test]
fn after_a_checkpoint_the_resumed_run_takes_the_same_path_as_the_one_that_went_on() {
    let mut bench = Bench::new();
    let setup = heap();
    let mut particles = bench.launch(&setup, "a", None);
    let push = vec![Vec3::new(1e-4, 0.0, 2e-4); 40];
    for _ in 0..5 {
        bench.window(&mut particles, 1e-3, &push).unwrap();
    }
    let remove = ParticleChanges {
        remove: vec![7],
        insert: Vec::new(),
        ..ParticleChanges::default()
    };
    particles.change(&bench.supervisor, &remove).unwrap();
    let checkpoint = bench.path("checkpoint");
    std::fs::create_dir_all(&checkpoint).unwrap();
    particles.checkpoint(&checkpoint).unwrap();
    let (index, start) = (bench.index, bench.start);
    let path = |bench: &mut Bench, particles: &mut LinkedParticles| {
        (bench.index, bench.start) = (index, start);
        for window in 0..5 {
            let push = vec![Vec3::new(1e-4, 0.0, -1e-4 * f64::from(window)); 39];
            bench.window(particles, 1e-3, &push).unwrap();
        }
        let fields = particles.fields();
        (
            fields.position.to_vec(),
            fields.velocity.to_vec(),
            fields.angular_velocity.to_vec(),
        )
    };
    let went_on = path(&mut bench, &mut particles);
    let mut resumed = bench.launch(&setup, "b", Some(checkpoint));
    assert_eq!(resumed.fields().len(), 39);
    let again = path(&mut bench, &mut resumed);
    assert!(went_on == again, "the paths differ");
}

/// What LIGGGHTS' setup finds anew is the order of sums alone: forces, torques, drag and the forces of walls are kept.
#[test]
fn a_checkpoint_leaves_the_path_by_round_off_at_most() {
    let mut bench = Bench::new();
    let mut all_free = contacts(Vec3::new(0.0, 0.0, -9.81));
    all_free.held = vec![false, false];
    let setup = setup_with(all_free, &heap());
    let push = vec![Vec3::new(1e-4, 0.0, 2e-4); 40];
    let drag = |bench: &mut Bench, particles: &mut LinkedParticles, span: f64| {
        let mut columns = NamedColumns::default();
        columns.set(DRAG_COEFFICIENT, 1, vec![2e-4; 40]);
        columns.set(GAS_VELOCITY, 3, vec![0.3; 120]);
        let force = push.clone();
        bench
            .push(particles, span, &ParticlePush { force, columns })
            .unwrap();
    };
    let mut run = |name: &str, writes: bool| {
        (bench.index, bench.start) = Default::default();
        let mut particles = bench.launch(&setup, name, None);
        for _ in 0..8 {
            drag(&mut bench, &mut particles, 2e-3);
        }
        if writes {
            let checkpoint = bench.path("checkpoint");
            std::fs::create_dir_all(&checkpoint).unwrap();
            particles.checkpoint(&checkpoint).unwrap();
        }
        // A few steps: round-off grows from contact to contact.
        drag(&mut bench, &mut particles, 2e-5);
        let fields = particles.fields();
        let speeds = [fields.velocity.to_vec(), fields.angular_velocity.to_vec()];
        (speeds, bench.support.unwrap(), particles)
    };
    let (alone, support, _first) = run("a", false);
    let (through, again, _second) = run("c", true);
    for (alone, through) in alone.iter().zip(&through) {
        let largest = alone.iter().map(|one| one.norm()).fold(0.0, f64::max);
        let pairs = alone.iter().zip(through);
        let off = pairs.map(|(a, b)| (a - b).norm()).fold(0.0, f64::max);
        assert!(off < 1e-12 * largest, "{off} of {largest}");
    }
    let off = (support - again).norm() / support.norm();
    assert!(off < 1e-12, "{off}");
}

#[test]
fn a_run_goes_on_from_its_checkpoint_when_all_of_the_first_population_or_all_particles_have_left() {
    let mut bench = Bench::new();
    let mut contacts = contacts(Vec3::new(0.0, 0.0, -9.81));
    contacts.held = vec![false, false];
    let mut setup = setup_with(contacts, &heap());
    setup.population[20..].fill(1);
    let mut particles = bench.launch(&setup, "a", None);
    let mut left = 40;
    // Hosts that end while their supervisor lives are missed.
    let mut hosts = Vec::new();
    for (round, gone) in [1..=20, 21..=40].into_iter().enumerate() {
        bench
            .window(&mut particles, 1e-3, &vec![Vec3::zeros(); left])
            .unwrap();
        let change = ParticleChanges {
            remove: gone.collect(),
            ..ParticleChanges::default()
        };
        particles.change(&bench.supervisor, &change).unwrap();
        left -= 20;
        let checkpoint = bench.path(&format!("checkpoint{round}"));
        std::fs::create_dir_all(&checkpoint).unwrap();
        particles.checkpoint(&checkpoint).unwrap();
        let (index, start) = (bench.index, bench.start);
        let path = |bench: &mut Bench, particles: &mut LinkedParticles| {
            (bench.index, bench.start) = (index, start);
            bench
                .window(particles, 1e-3, &vec![Vec3::zeros(); left])
                .unwrap();
            particles.fields().position.to_vec()
        };
        let went_on = path(&mut bench, &mut particles);
        let mut resumed = bench.launch(&setup, &format!("b{round}"), Some(checkpoint));
        assert_eq!(went_on, path(&mut bench, &mut resumed));
        hosts.push(resumed);
    }
}

#[test]
fn a_particle_that_gets_another_size_moves_by_its_new_mass_and_keeps_it_in_checkpoints() {
    let mut bench = Bench::new();
    let at = |x: f64| (Vec3::new(x, 0.05, 0.05), Vec3::zeros());
    let setup = setup(contacts(Vec3::zeros()), &[at(0.02), at(0.05), at(0.08)]);
    let mut particles = bench.launch(&setup, "a", None);
    let still = [Vec3::zeros(); 3];
    bench.window(&mut particles, 1e-4, &still).unwrap();
    let new = Resized {
        id: 2,
        radius: 0.0021,
        mass: 0.4 * MASS,
    };
    let change = ParticleChanges {
        resize: vec![new],
        ..ParticleChanges::default()
    };
    particles.change(&bench.supervisor, &change).unwrap();
    let fields = particles.fields();
    assert_eq!(fields.radius, [0.0025, 0.0021, 0.0025]);
    assert_eq!(fields.mass[1], 0.4 * MASS);
    let push = [Vec3::x() * 1e-3; 3];
    bench.window(&mut particles, 1e-3, &push).unwrap();
    let speeds: Vec<f64> = particles.fields().velocity.iter().map(|v| v.x).collect();
    for (speed, mass) in speeds.iter().zip([MASS, 0.4 * MASS, MASS]) {
        assert!(
            (speed / (1e-6 / mass) - 1.0).abs() < 1e-12,
            "{speed} {mass}"
        );
    }
    let checkpoint = bench.path("checkpoint");
    std::fs::create_dir_all(&checkpoint).unwrap();
    particles.checkpoint(&checkpoint).unwrap();
    let resumed = bench.launch(&setup, "b", Some(checkpoint));
    for fields in [particles.fields(), resumed.fields()] {
        assert_eq!(fields.radius[1].to_bits(), new.radius.to_bits());
        assert_eq!(fields.mass[1].to_bits(), new.mass.to_bits());
    }
}

#[test]
fn what_comes_to_rest_keeps_the_springs_of_its_contacts() {
    let mut bench = Bench::new();
    let mut sloped = contacts(Vec3::new(0.2 * 9.81, 0.0, -9.81));
    // No dashpot: springs alone decide how fast it gets.
    sloped.pairs[0].restitution = 1.0;
    let start = (Vec3::new(0.05, 0.05, 0.0025), Vec3::zeros());
    let mut particles = bench.launch(&setup(sloped, &[start]), "a", None);
    let speed = |bench: &mut Bench, particles: &mut LinkedParticles, span: f64| {
        bench.window(particles, span, &[Vec3::zeros()]).unwrap();
        particles.fields().velocity[0]
    };
    let before = speed(&mut bench, &mut particles, 2e-4);
    let step = speed(&mut bench, &mut particles, 1e-6) - before;
    let place = particles.fields().position[0];
    let rest = ParticleChanges {
        rest: true,
        ..ParticleChanges::default()
    };
    particles.change(&bench.supervisor, &rest).unwrap();
    let fields = particles.fields();
    let speeds = [fields.velocity[0], fields.angular_velocity[0]];
    assert_eq!((fields.position[0], speeds), (place, [Vec3::zeros(); 2]));
    let off = (speed(&mut bench, &mut particles, 1e-6) - step).norm() / step.norm();
    // Without its spring it would feel the full slope.
    let slope = 0.2 * 9.81e-6;
    assert!(off < 0.02 && step.x < 0.9 * slope, "{off}: {step}");
}

#[test]
fn a_particle_that_leaves_is_named_with_the_place_where_it_was() {
    let mut bench = Bench::new();
    let fast = (Vec3::new(0.09, 0.05, 0.05), Vec3::new(5.0, 0.0, 0.0));
    let calm = (Vec3::repeat(0.05), Vec3::zeros());
    let setup = setup(contacts(Vec3::zeros()), &[calm, fast]);
    let mut particles = bench.launch(&setup, "a", None);
    let error = bench
        .window(&mut particles, 2e-2, &[Vec3::zeros(); 2])
        .unwrap_err()
        .to_string();
    assert!(error.contains("particle 2"), "{error}");
    assert!(
        error.contains("0.09") && error.contains("1 of 2 particles"),
        "{error}"
    );
}

#[test]
fn a_turning_wall_of_triangles_drags_what_lies_on_it() {
    let mut bench = Bench::new();
    let mut moving = contacts(Vec3::new(0.0, 0.0, -9.81));
    let corner = |x: f64, y: f64| Vec3::new(x, y, 0.02);
    moving.walls.push(Wall {
        name: "belt".into(),
        material: 0,
        shape: WallShape::Mesh {
            triangles: vec![
                [corner(0.02, 0.02), corner(0.08, 0.02), corner(0.08, 0.08)],
                [corner(0.02, 0.02), corner(0.08, 0.08), corner(0.02, 0.08)],
            ],
        },
        motion: WallMotion::Rotating {
            point: Vec3::new(0.05, 0.05, 0.0),
            angular_velocity: Vec3::new(0.0, 0.0, 2.0),
        },
    });
    let sphere = (Vec3::new(0.06, 0.05, 0.0225), Vec3::zeros());
    let setup = setup(moving, &[sphere]);
    let mut particles = bench.launch(&setup, "a", None);
    bench
        .window(&mut particles, 3e-2, &[Vec3::zeros()])
        .unwrap();
    let velocity = particles.fields().velocity[0];
    // It lies 10 mm off the axis: the plate passes below at 20 mm/s along y, and drags it.
    assert!(velocity.y > 1e-3 && velocity.y < 0.021, "{velocity}");
    assert!(particles.fields().position[0].z > 0.022);
}

#[test]
fn what_it_does_not_have_is_refused_before_it_starts() {
    let mut bench = Bench::new();
    let refused = |bench: &mut Bench, contacts: Contacts| {
        let setup = setup(contacts, &[(Vec3::repeat(0.05), Vec3::zeros())]);
        let error = bench.try_launch(&setup, "x", None).err().unwrap();
        error.to_string()
    };
    let mut forgetful = contacts(Vec3::zeros());
    forgetful.law.force = ContactForce::SpringSliderDashpot;
    assert!(refused(&mut bench, forgetful).contains("spring-slider-dashpot"));
    let mut adhesive = contacts(Vec3::zeros());
    adhesive.law.cohesion = Cohesion::Jkr;
    assert!(refused(&mut bench, adhesive).contains("no cohesion law \"jkr\""));
    let mut soft = contacts(Vec3::zeros());
    soft.pairs[0].restitution = 0.01;
    assert!(refused(&mut bench, soft).contains("0.01"));
    assert!(!Path::new(&bench.path("x")).exists());
}
