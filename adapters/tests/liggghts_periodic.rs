//! The LIGGGHTS host with spheres in a domain that repeats itself: contacts across the planes, triangles that end at them,
//! particles that come in beside them, ranks and checkpoints.

use std::path::PathBuf;

use calcine_adapters::particles::LinkedParticles;
use calcine_coupler::motion::{
    Contacts, Motion, NewParticle, ParticleChanges, Wall, WallMotion, WallShape,
};
use calcine_coupler::part::{Part, Particles};
use calcine_coupler::periodicity::{PeriodicSpan, Periodicity};
use calcine_coupler::physics::Vec3;
use calcine_coupler::setup::ParticleSetup;

use crate::liggghts_support::{BOX, Bench, contacts, setup};

/// Periods along x and y of the box's width, from the origin.
fn periodic(gravity: Vec3) -> Contacts {
    let span = Some(PeriodicSpan {
        low: 0.0,
        high: BOX,
    });
    Contacts {
        periodicity: Periodicity {
            axes: [span, span, None],
        },
        held: vec![false],
        material_of: vec![0],
        walls: Vec::new(),
        ..contacts(gravity)
    }
}

fn run(bench: &mut Bench, particles: &mut LinkedParticles, windows: usize, span: f64) {
    let still = vec![Vec3::zeros(); particles.fields().len()];
    for _ in 0..windows {
        bench.window(particles, span, &still).unwrap();
    }
}

#[test]
fn places_are_wrapped_and_flight_goes_on() {
    let mut bench = Bench::new();
    let velocity = Vec3::new(3.0, -2.0, 0.1);
    let start = Vec3::new(0.095, 0.004, 0.05);
    let setup = setup(periodic(Vec3::zeros()), &[(start, velocity)]);
    let mut particles = bench.launch(&setup, "a", None);
    run(&mut bench, &mut particles, 11, 0.01);
    let periodicity = match &setup.motion {
        Motion::Free(contacts) => contacts.periodicity,
        _ => Periodicity::default(),
    };
    let wanted = periodicity.wrap(start + velocity * 0.11);
    let off = particles.fields().position[0] - wanted;
    assert!(off.norm() < 1e-12, "{off}");
}

/// A host of its own: a supervisor ends what it watches with the first host that is dropped.
fn bench(ranks: u32) -> Bench {
    let mut bench = Bench::new();
    bench.ranks = ranks;
    bench
}

/// Velocities and rotations of two spheres that meet at an angle around a place.
fn impact(ranks: u32, at: Vec3) -> Vec<Vec3> {
    let mut bench = bench(ranks);
    let apart = Vec3::x() * 2.6e-3;
    let aside = Vec3::y() * 1e-3;
    let contacts = periodic(Vec3::zeros());
    let wrap = |place| contacts.periodicity.wrap(place);
    let spheres = [
        (wrap(at - apart), Vec3::new(0.5, 0.1, 0.0)),
        (wrap(at + apart + aside), Vec3::new(-0.4, 0.0, 0.2)),
    ];
    let setup = setup(contacts.clone(), &spheres);
    let mut particles = bench.launch(&setup, "a", None);
    run(&mut bench, &mut particles, 4, 1e-3);
    let fields = particles.fields();
    fields
        .velocity
        .iter()
        .chain(fields.angular_velocity)
        .copied()
        .collect()
}

#[test]
fn spheres_that_meet_across_a_plane_part_as_they_do_elsewhere() {
    let within = impact(1, Vec3::new(0.03, 0.05, 0.05));
    assert!(within[0].x < 0.2 && within[2].norm() > 1.0, "{within:?}");
    // On two ranks the planes along x border on two ranks.
    for (ranks, at) in [
        (1, Vec3::new(0.0, 0.05, 0.05)),
        (1, Vec3::new(0.03, -4e-4, 0.05)),
        (1, Vec3::new(2e-4, BOX, 0.05)),
        (2, Vec3::new(2e-4, BOX, 0.05)),
        (2, Vec3::new(0.5 * BOX, 0.0, 0.05)),
    ] {
        let across = impact(ranks, at);
        for (found, wanted) in across.iter().zip(&within) {
            let off = (found - wanted).norm() / wanted.norm();
            assert!(off < 1e-9, "{ranks} ranks, {at}: {off:e}");
        }
    }
}

/// Two triangles at z = 0 over the whole domain, which end at its planes.
fn floor() -> Wall {
    let corner = |x: f64, y: f64| Vec3::new(x, y, 0.0);
    Wall {
        name: "floor".into(),
        material: 0,
        shape: WallShape::Mesh {
            triangles: vec![
                [corner(0.0, 0.0), corner(BOX, 0.0), corner(BOX, BOX)],
                [corner(0.0, 0.0), corner(BOX, BOX), corner(0.0, BOX)],
            ],
        },
        motion: WallMotion::Still,
    }
}

#[test]
fn triangles_that_end_at_a_plane_carry_a_sphere_across_it() {
    let rolled = |wall: Wall| {
        let mut bench = bench(1);
        let mut contacts = periodic(Vec3::new(3.0, 1.0, -9.0));
        contacts.walls = vec![wall];
        let start = (Vec3::new(0.09, 0.06, 0.0025), Vec3::new(1.0, -0.4, 0.0));
        let setup = setup(contacts, &[start]);
        let mut particles = bench.launch(&setup, "a", None);
        let mut highest = 0.0f64;
        for _ in 0..30 {
            run(&mut bench, &mut particles, 1, 1e-3);
            highest = highest.max(particles.fields().position[0].z);
        }
        let fields = particles.fields();
        (
            fields.position[0],
            fields.velocity[0],
            fields.angular_velocity[0],
            highest,
        )
    };
    let shape = WallShape::Plane {
        point: Vec3::zeros(),
        normal: Vec3::z(),
    };
    let plane = rolled(Wall { shape, ..floor() });
    let mesh = rolled(floor());
    // It is beyond the plane, and was not thrown up by the edge.
    assert!(mesh.0.x < 0.05 && mesh.3 < 0.00252, "{mesh:?}");
    for (found, wanted) in [(mesh.1, plane.1), (mesh.2, plane.2)] {
        let off = (found - wanted).norm() / wanted.norm();
        assert!(off < 1e-3, "{mesh:?} {plane:?}");
    }
}

/// A shower on a floor of triangles down an incline, across both pairs of planes.
fn shower() -> ParticleSetup {
    let mut contacts = periodic(Vec3::new(5.0, 2.0, -8.0));
    contacts.walls = vec![floor()];
    let spheres: Vec<(Vec3, Vec3)> = (0..60)
        .map(|k| {
            let (i, j, layer) = (k % 5, (k / 5) % 4, k / 20);
            let wiggle = 1e-4 * f64::from(k % 7);
            let centre = Vec3::new(
                0.09 + 0.0053 * f64::from(i) + wiggle,
                0.09 + 0.0053 * f64::from(j) - wiggle,
                0.003 + 0.0052 * f64::from(layer),
            );
            (contacts.periodicity.wrap(centre), Vec3::new(0.5, 0.3, 0.0))
        })
        .collect();
    setup(contacts, &spheres)
}

fn bits(particles: &LinkedParticles) -> Vec<u64> {
    let fields = particles.fields();
    let all = fields
        .position
        .iter()
        .chain(fields.velocity)
        .chain(fields.angular_velocity);
    all.flat_map(|vector| [vector.x, vector.y, vector.z])
        .map(f64::to_bits)
        .collect()
}

#[test]
fn a_resumed_bed_goes_on_to_the_bit_after_a_checkpoint() {
    let mut bench = Bench::new();
    let setup = shower();
    let mut alone = bench.launch(&setup, "a", None);
    run(&mut bench, &mut alone, 10, 1e-3);
    let folder: PathBuf = bench.path("checkpoint");
    std::fs::create_dir_all(&folder).unwrap();
    alone.checkpoint(&folder).unwrap();
    let (index, start) = (bench.index, bench.start);
    run(&mut bench, &mut alone, 20, 1e-3);
    (bench.index, bench.start) = (index, start);
    let mut resumed = bench.launch(&setup, "b", Some(folder));
    run(&mut bench, &mut resumed, 20, 1e-3);
    assert!(bits(&alone) == bits(&resumed));
    let places = alone.fields().position;
    assert!(
        places
            .iter()
            .all(|at| (0.0..BOX).contains(&at.x) && (0.0..BOX).contains(&at.y))
    );
}

#[test]
fn particles_come_in_beside_a_plane_and_touch_across_it() {
    let mut bench = Bench::new();
    let setup = setup(
        periodic(Vec3::zeros()),
        &[(Vec3::new(0.0995, 0.05, 0.05), Vec3::zeros())],
    );
    let mut particles = bench.launch(&setup, "a", None);
    let new = NewParticle {
        id: 7,
        population: 0,
        position: Vec3::new(0.0045, 0.05, 0.05),
        velocity: Vec3::x() * -0.5,
        radius: 0.0025,
        density: 2500.0,
        weight: 1.0,
    };
    let change = ParticleChanges {
        insert: vec![new],
        ..ParticleChanges::default()
    };
    particles.change(&bench.supervisor, &change).unwrap();
    run(&mut bench, &mut particles, 4, 1e-3);
    let fields = particles.fields();
    let speeds: Vec<f64> = fields.velocity.iter().map(|v| v.x).collect();
    // The restitution of 0.5 leaves a quarter and three quarters of the speed.
    assert!(
        (speeds[0] + 0.375).abs() < 5e-3 && (speeds[1] + 0.125).abs() < 5e-3,
        "{speeds:?}"
    );
}

#[test]
fn what_does_not_repeat_is_refused_with_its_name_and_remedy() {
    let mut bench = Bench::new();
    let mut contacts = periodic(Vec3::zeros());
    contacts.walls = vec![Wall {
        shape: WallShape::Plane {
            point: Vec3::zeros(),
            normal: Vec3::x(),
        },
        ..floor()
    }];
    let setup = setup(contacts, &[(Vec3::repeat(0.05), Vec3::zeros())]);
    let error = bench
        .try_launch(&setup, "a", None)
        .err()
        .unwrap()
        .to_string();
    assert!(
        error.contains("wall `floor`, a plane across or inclined to this direction, does not repeat with the domain along x"),
        "{error}"
    );
    assert!(error.contains("tilt `gas.gravity`"), "{error}");
}
