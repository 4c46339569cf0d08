//! Agreement of single contacts, native and LIGGGHTS, step by step: the same law, the same step, every step a
//! window of its own. LIGGGHTS takes part: `cargo xtask test` builds its host.
#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::panic,
    clippy::print_stdout
)]

use std::path::Path;
use std::time::Duration;

use calcine_adapters::launch::Launcher;
use calcine_adapters::liggghts::LiggghtsLaunch;
use calcine_adapters::liggghts::inputs::Inputs;
use calcine_adapters::particles::LinkedParticles;
use calcine_coupler::motion::{
    Cohesion, ContactForce, ContactLaw, Contacts, Elastic, Motion, Pair, Rolling, Wall, WallMotion,
    WallShape,
};
use calcine_coupler::part::{
    Bed as VoidFractions, DRAG_COEFFICIENT, GAS_VELOCITY, ParticlePush, ParticleReceived, Particles,
};
use calcine_coupler::physics::Vec3;
use calcine_coupler::setup::ParticleSetup;
use calcine_coupler::supervisor::{Interrupts, Supervisor};
use calcine_coupler::time::{Clocks, Ticks, Window};
use calcine_native::particles::NativeParticles;

/// Time step in s: a contact takes some 700 of them.
const STEP: f64 = 1e-6;
/// Edge of the domain in m.
const BOX: f64 = 0.1;
/// Radii in m.
const RADII: [f64; 2] = [2.5e-3, 1.5e-3];

/// Largest differences over all steps: of places over the deepest overlap, of velocities over the speed at the
/// start, of rotations over that speed and the first radius.
#[derive(Debug, Default)]
struct Differences {
    place: f64,
    velocity: f64,
    spin: f64,
}

fn law() -> ContactLaw {
    ContactLaw {
        force: ContactForce::HertzMindlin,
        attractive_damping: true,
        rolling: Rolling::None,
        cohesion: Cohesion::None,
    }
}

/// Two materials with every property, no wall, no gravity.
fn contacts(law: ContactLaw) -> Contacts {
    let pair = |restitution: f64, friction: f64| Pair {
        restitution,
        friction,
        rolling_friction: 0.1,
        rolling_damping: 0.3,
        cohesion_energy: 2e4,
        work_of_adhesion: 0.0,
    };
    let (own, mixed) = (pair(0.6, 0.4), pair(0.5, 0.3));
    Contacts {
        step: STEP,
        gravity: Vec3::zeros(),
        bounds: (Vec3::zeros(), Vec3::repeat(BOX)),
        lost: Default::default(),
        periodicity: Default::default(),
        materials: vec![
            Elastic {
                young: 5e7,
                poisson: 0.25,
            },
            Elastic {
                young: 2e7,
                poisson: 0.35,
            },
        ],
        material_of: vec![0, 1],
        held: vec![false, false],
        law,
        pairs: vec![own, mixed, mixed, pair(0.8, 0.2)],
        walls: Vec::new(),
    }
}

fn setup(contacts: Contacts, spheres: &[(Vec3, Vec3)]) -> ParticleSetup {
    let count = spheres.len();
    ParticleSetup {
        id: (1..=count as u64).collect(),
        population: (0..count as u32).collect(),
        position: spheres.iter().map(|sphere| sphere.0).collect(),
        radius: RADII[..count].to_vec(),
        density: vec![2500.0, 1800.0][..count].to_vec(),
        velocity: spheres.iter().map(|sphere| sphere.1).collect(),
        motion: Motion::Free(Box::new(contacts)),
        ..ParticleSetup::default()
    }
}

/// Two spheres of different sizes and materials, a hair apart, which meet at an angle.
fn pair(law: ContactLaw, velocity: Vec3) -> ParticleSetup {
    let normal = Vec3::new(0.6, 0.0, 0.8);
    let first = Vec3::repeat(0.05);
    let second = first - normal * (RADII[0] + RADII[1] + 1e-7);
    setup(
        contacts(law),
        &[(first, velocity), (second, -0.5 * velocity)],
    )
}

/// A sphere over a wall of the other material.
fn on_wall(law: ContactLaw, velocity: Vec3, shape: WallShape, gravity: Vec3) -> ParticleSetup {
    let mut contacts = contacts(law);
    contacts.gravity = gravity;
    contacts.walls = vec![Wall {
        name: "floor".into(),
        material: 1,
        shape,
        motion: WallMotion::Still,
    }];
    let centre = Vec3::new(0.05, 0.05, 0.01 + RADII[0] + 1e-7);
    setup(contacts, &[(centre, velocity)])
}

fn floor() -> WallShape {
    WallShape::Plane {
        point: Vec3::z() * 0.01,
        normal: Vec3::z(),
    }
}

fn triangles() -> WallShape {
    let corner = |x: f64, y: f64| Vec3::new(x, y, 0.01);
    WallShape::Mesh {
        triangles: vec![
            [corner(0.02, 0.02), corner(0.08, 0.02), corner(0.08, 0.075)],
            [corner(0.02, 0.02), corner(0.08, 0.075), corner(0.02, 0.075)],
        ],
    }
}

fn liggghts(setup: &ParticleSetup, supervisor: &mut Supervisor, folder: &Path) -> LinkedParticles {
    let launch = LiggghtsLaunch {
        inputs: Inputs {
            setup,
            bounds: (Vec3::zeros(), Vec3::repeat(BOX)),
            step: STEP,
            ranks: 1,
            wall_impulse: false,
            moving_drag: true,
            template: None,
        },
        case_hash: "contacts".into(),
        launcher: Launcher::Mpirun,
        log: folder.join("liggghts.log"),
        folder: folder.join("run"),
        resume: None,
        deadline: Duration::from_secs(30),
    };
    launch.launch(supervisor).unwrap()
}

/// Runs both without a gas, a window a step.
fn compare(setup: &ParticleSetup, steps: u64) -> Differences {
    let push = ParticlePush {
        force: vec![Vec3::zeros(); setup.id.len()],
        ..ParticlePush::default()
    };
    compare_pushed(setup, steps, 1, &push)
}

/// Runs both, so many steps a window.
fn compare_pushed(
    setup: &ParticleSetup,
    windows: u64,
    steps: u32,
    push: &ParticlePush,
) -> Differences {
    let mut supervisor = Supervisor::new(Duration::from_secs(30), Interrupts::default());
    let folder = tempfile::tempdir().unwrap();
    let mut other = liggghts(setup, &mut supervisor, folder.path());
    let mut own = NativeParticles::new(setup).unwrap();
    let span = Ticks::from_seconds(f64::from(steps) * STEP).unwrap();
    let mut start = Ticks::ZERO;
    // A sphere at rest is dragged by a wall that passes at some 0.1 m/s.
    let speed = setup.velocity[0].norm().max(0.1);
    let mut received = ParticleReceived::default();
    let mut found = Differences::default();
    let (mut deepest, mut apart) = (0.0f64, 0.0f64);
    for index in 0..windows {
        let window = Window {
            index,
            attempt: 0,
            start: Clocks {
                motion: start,
                process: start,
            },
            span: Clocks {
                motion: span,
                process: span,
            },
        };
        for part in [&mut own as &mut dyn Particles, &mut other] {
            part.start(&window, &VoidFractions::default(), push)
                .unwrap();
            part.finish(&supervisor, &mut received).unwrap();
            part.commit().unwrap();
        }
        start = start.checked_add(span).unwrap();
        let (a, b) = (own.fields(), other.fields());
        let most = |a: &[Vec3], b: &[Vec3]| {
            let pairs = a.iter().zip(b);
            pairs.map(|(a, b)| (a - b).norm()).fold(0.0, f64::max)
        };
        apart = apart.max(most(a.position, b.position));
        found.velocity = found.velocity.max(most(a.velocity, b.velocity) / speed);
        let spin = most(a.angular_velocity, b.angular_velocity) * RADII[0] / speed;
        found.spin = found.spin.max(spin);
        let overlap = match a.position {
            [one, two] => RADII[0] + RADII[1] - (one - two).norm(),
            _ => nearest(setup, a.position[0]),
        };
        deepest = deepest.max(overlap);
    }
    assert!(deepest > 1e-8, "nothing touched: {deepest}");
    found.place = apart / deepest;
    found
}

/// Overlap in m of the first sphere with the wall.
fn nearest(setup: &ParticleSetup, place: Vec3) -> f64 {
    let Motion::Free(contacts) = &setup.motion else {
        return 0.0;
    };
    match &contacts.walls[0].shape {
        WallShape::Plane { point, normal } => RADII[0] - (place - point).dot(normal),
        WallShape::Cylinder {
            point,
            axis,
            radius,
        } => {
            let from = place - point;
            RADII[0] - radius + (from - from.dot(axis) * axis).norm()
        }
        WallShape::Mesh { .. } => RADII[0] + 0.01 - place.z,
        // About what its weight presses in.
        WallShape::Cone { .. } => 1e-6,
    }
}

fn agree(what: &str, setup: &ParticleSetup, steps: u64) {
    agree_within(what, setup, steps, 1e-6);
}

fn agree_within(what: &str, setup: &ParticleSetup, steps: u64, limit: f64) {
    let found = compare(setup, steps);
    println!("{what}: {found:?}");
    assert!(
        found.velocity < limit && found.spin < limit,
        "{what}: {found:?}"
    );
    assert!(found.place < 20.0 * limit, "{what}: {found:?}");
}

const ALONG: Vec3 = Vec3::new(-0.3, 0.1, -0.4);
/// Slips past at a small angle.
const ASIDE: Vec3 = Vec3::new(-0.9, 0.3, 0.3);

#[test]
fn pairs_of_spheres_take_the_same_path_under_every_law() {
    let linear = ContactForce::Linear {
        characteristic_speed: 0.5,
    };
    for (what, law, velocity) in [
        ("pair, sticking", law(), ALONG),
        ("pair, sliding", law(), ASIDE),
        (
            "pair, force cut at zero",
            ContactLaw {
                attractive_damping: false,
                ..law()
            },
            ALONG,
        ),
        (
            "pair, linear",
            ContactLaw {
                force: linear,
                ..law()
            },
            ALONG,
        ),
        (
            "pair, constant rolling torque",
            ContactLaw {
                rolling: Rolling::ConstantTorque,
                ..law()
            },
            ALONG,
        ),
        (
            "pair, rolling spring",
            ContactLaw {
                rolling: Rolling::ElasticPlastic,
                ..law()
            },
            ALONG,
        ),
        (
            "pair, cohesion",
            ContactLaw {
                cohesion: Cohesion::Sjkr,
                ..law()
            },
            ALONG,
        ),
    ] {
        agree(what, &pair(law, velocity), 1500);
    }
}

#[test]
fn pairs_that_touch_take_the_same_path_under_drag_that_follows_them() {
    let setup = pair(law(), ALONG);
    let count = setup.id.len();
    let mass = NativeParticles::new(&setup).unwrap().fields().mass.to_vec();
    for (steps, relaxation) in [(1, 1e-4), (50, 1e-4), (50, 5e-6), (50, 1e-7)] {
        let mut push = ParticlePush {
            force: vec![Vec3::new(1e-4, 0.0, -2e-4); count],
            ..ParticlePush::default()
        };
        let coefficient = mass.iter().map(|mass| mass / relaxation).collect();
        push.columns.set(DRAG_COEFFICIENT, 1, coefficient);
        // Gas that pushes the two against each other, with some newtons at most.
        let gas = [-0.6, 0.1, -0.8, 0.3, 0.0, 0.4].map(|speed| speed * relaxation / 1e-4);
        push.columns.set(GAS_VELOCITY, 3, gas.to_vec());
        let windows = 1500 / u64::from(steps);
        let found = compare_pushed(&setup, windows, steps, &push);
        println!("{steps} steps a window, m/K of {relaxation} s: {found:?}");
        // As without drag: another order of sums in stiff contacts.
        let most = found.velocity.max(found.spin).max(found.place / 20.0);
        assert!(most < 1e-6, "{found:?}");
    }
}

#[test]
fn a_sphere_and_a_wall_take_the_same_path_under_every_law() {
    let linear = ContactForce::Linear {
        characteristic_speed: 0.5,
    };
    let none = Vec3::zeros();
    for (what, law, velocity, shape) in [
        ("plane, sticking", law(), ALONG, floor()),
        ("plane, sliding", law(), Vec3::new(0.9, 0.3, -0.2), floor()),
        ("triangles, sticking", law(), ALONG, triangles()),
        (
            "plane, force cut at zero",
            ContactLaw {
                attractive_damping: false,
                ..law()
            },
            ALONG,
            floor(),
        ),
        (
            "plane, linear",
            ContactLaw {
                force: linear,
                ..law()
            },
            ALONG,
            floor(),
        ),
        (
            "plane, constant rolling torque",
            ContactLaw {
                rolling: Rolling::ConstantTorque,
                ..law()
            },
            ALONG,
            floor(),
        ),
        (
            "plane, rolling spring",
            ContactLaw {
                rolling: Rolling::ElasticPlastic,
                ..law()
            },
            ALONG,
            floor(),
        ),
        (
            "plane, cohesion",
            ContactLaw {
                cohesion: Cohesion::Sjkr,
                ..law()
            },
            ALONG,
            floor(),
        ),
    ] {
        // LIGGGHTS takes the rotation at a wall (R − δ/2)/(R − δ) times too fast for its rolling spring.
        let limit = if law.rolling == Rolling::ElasticPlastic {
            2e-3
        } else {
            1e-6
        };
        agree_within(what, &on_wall(law, velocity, shape, none), 1500, limit);
    }
}

/// A sphere that slides under its weight until it rolls: many contacts' lengths with history.
#[test]
fn a_sphere_that_comes_to_roll_takes_the_same_path() {
    for rolling in [
        Rolling::None,
        Rolling::ConstantTorque,
        Rolling::ElasticPlastic,
    ] {
        let law = ContactLaw { rolling, ..law() };
        let start = Vec3::new(0.1, 0.04, 0.0);
        let setup = on_wall(law, start, floor(), Vec3::z() * -9.81);
        let limit = if rolling == Rolling::ElasticPlastic {
            1e-4
        } else {
            1e-6
        };
        agree_within(&format!("rolling, {rolling:?}"), &setup, 6000, limit);
    }
}

/// LIGGGHTS has cylinders along each axis itself, and gets the triangles of a slanted plane.
#[test]
fn walls_at_rest_are_where_they_are_in_both() {
    let centre = Vec3::new(0.03, 0.04, 0.05);
    for axis in 0..3 {
        let mut along = Vec3::zeros();
        along[axis] = 1.0;
        let mut out = Vec3::zeros();
        out[(axis + 1) % 3] = 0.6;
        out[(axis + 2) % 3] = 0.8;
        let shape = WallShape::Cylinder {
            point: centre,
            axis: along,
            radius: 0.02,
        };
        let mut setup = on_wall(law(), 0.4 * out + 0.3 * along, shape, Vec3::zeros());
        setup.position[0] = centre + out * (0.02 - RADII[0] - 1e-7);
        agree(&format!("cylinder along {axis}"), &setup, 1500);
    }
    let normal = Vec3::new(0.48, 0.6, 0.64);
    let point = Vec3::repeat(0.05);
    let mut setup = on_wall(
        law(),
        Vec3::new(0.1, -0.4, -0.3),
        WallShape::Plane { point, normal },
        Vec3::zeros(),
    );
    setup.position[0] = point + normal * (RADII[0] + 1e-7);
    agree("slanted plane", &setup, 1500);
}

/// Walls that move within themselves: a drum about its axis, a plate about its normal, a belt; where LIGGGHTS has
/// facets for a round wall, paths agree as well as these do.
#[test]
fn walls_that_move_within_themselves_drag_alike() {
    let turning = |angular_velocity: Vec3, point: Vec3| WallMotion::Rotating {
        point,
        angular_velocity,
    };
    let centre = Vec3::new(0.05, 0.02, 0.05);
    let down = Vec3::z() * -9.81;
    let drum = WallShape::Cylinder {
        point: centre,
        axis: Vec3::y(),
        radius: 0.04,
    };
    let cone = WallShape::Cone {
        ends: [Vec3::new(0.05, 0.0, 0.05), Vec3::new(0.05, 0.08, 0.05)],
        radii: [0.03, 0.034],
    };
    for (what, shape, motion, height, limit) in [
        (
            "plate",
            floor(),
            turning(Vec3::z() * 8.0, Vec3::new(0.04, 0.05, 0.0)),
            0.01,
            1e-6,
        ),
        (
            "belt",
            floor(),
            WallMotion::Translating(Vec3::new(0.1, -0.05, 0.0)),
            0.01,
            1e-6,
        ),
        ("drum", drum, turning(Vec3::y() * 3.0, centre), 0.01, 0.02),
        (
            "cone",
            cone,
            turning(Vec3::y() * -3.0, Vec3::new(0.05, 0.0, 0.05)),
            0.02 - 0.0025 + 2e-6,
            0.05,
        ),
    ] {
        let mut setup = on_wall(law(), Vec3::zeros(), shape, down);
        setup.position[0].z = height + RADII[0] + 1e-7;
        if let Motion::Free(contacts) = &mut setup.motion {
            contacts.walls[0].motion = motion;
        }
        let found = compare(&setup, 8000);
        println!("{what}: {found:?}");
        assert!(
            found.velocity < limit && found.spin < limit,
            "{what}: {found:?}"
        );
    }
}
