//! Parcels that OpenFOAM's cloud moves, alone: what acts on one of them, walls, checkpoints, changes, and what is refused.

#![allow(clippy::unwrap_used, clippy::print_stdout)]

use std::path::Path;
use std::sync::Arc;
use std::time::Duration;

use calcine_adapters::launch::Launcher;
use calcine_adapters::openfoam::parcels::ParcelLaunch;
use calcine_adapters::particles::LinkedParticles;
use calcine_coupler::error::{FailureKind, PartError};
use calcine_coupler::mesh::Mesh;
use calcine_coupler::mesh::block::{BoxSpec, box_mesh};
use calcine_coupler::motion::{Motion, NewParticle, ParticleChanges, Resized, WallMotion};
use calcine_coupler::parcels::{
    ParcelCollisions, ParcelFriction, ParcelImpact, ParcelMotion, ParcelPacking, ParcelResistance,
    ParcelWall,
};
use calcine_coupler::part::{
    Bed, DRAG_COEFFICIENT, DRAG_IMPULSE, GAS_VELOCITY, Part, ParticlePush, ParticleReceived,
    Particles,
};
use calcine_coupler::physics::parcels::{CollisionTimes, HarrisCrighton};
use calcine_coupler::physics::{Vec3, sphere};
use calcine_coupler::setup::ParticleSetup;
use calcine_coupler::supervisor::{Interrupts, Supervisor};
use calcine_coupler::time::{Clocks, Ticks, Window};

const RADIUS: f64 = 0.5e-3;
const DENSITY: f64 = 2500.0;
const STRESS: HarrisCrighton = HarrisCrighton {
    pressure: 10.0,
    exponent: 2.0,
    floor: 1e-2,
    close_packing: 0.6,
};

fn cube(size: f64, cells: usize) -> Arc<Mesh> {
    let mesh = box_mesh(&BoxSpec {
        origin: Vec3::zeros(),
        size: Vec3::repeat(size),
        cells: [cells; 3],
        patches: ["west", "east", "south", "north", "bottom", "top"].map(str::to_owned),
    });
    Arc::new(mesh.unwrap())
}

/// Parcels without gravity, stress and collisions, between walls of one restitution and friction.
fn motion(mesh: &Mesh, restitution: f64, friction: f64) -> ParcelMotion {
    let patches = mesh.patches().iter();
    let bounding = patches.filter(|patch| mesh.partner(patch).is_none());
    let walls = bounding.map(|patch| ParcelWall {
        patch: patch.name.clone(),
        motion: WallMotion::Still,
        impact: vec![ParcelImpact {
            restitution,
            friction,
        }],
    });
    ParcelMotion {
        gravity: Vec3::zeros(),
        courant: 1.0,
        most_steps: 10_000,
        walls: walls.collect(),
        packing: ParcelPacking::None,
        collisions: ParcelCollisions {
            times: CollisionTimes {
                restitution: 0.9,
                close_packing: STRESS.close_packing,
            },
            damping: false,
            isotropy: false,
            seed: 1,
        },
        friction: None,
        resistance: None,
    }
}

fn setup(motion: ParcelMotion, parcels: &[(Vec3, Vec3)], weight: f64) -> ParticleSetup {
    let count = parcels.len();
    ParticleSetup {
        id: (1..=count as u64).collect(),
        population: vec![0; count],
        position: parcels.iter().map(|one| one.0).collect(),
        radius: vec![RADIUS; count],
        density: vec![DENSITY; count],
        velocity: parcels.iter().map(|one| one.1).collect(),
        angular_velocity: Vec::new(),
        weight: vec![weight; count],
        motion: Motion::Parcels(Box::new(motion)),
    }
}

/// A running cloud with its clock.
struct Cloud {
    parcels: LinkedParticles,
    clock: Ticks,
    received: ParticleReceived,
    supervisor: Supervisor,
}

impl Cloud {
    fn try_new(
        mesh: &Arc<Mesh>,
        setup: &ParticleSetup,
        (folder, resume): (&Path, Option<&Path>),
    ) -> Result<Self, PartError> {
        let mut supervisor = Supervisor::new(Duration::from_secs(30), Interrupts::default());
        let launch = ParcelLaunch {
            setup,
            mesh: Arc::clone(mesh),
            moving_drag: true,
            case_hash: "test".into(),
            folder: folder.join("case"),
            log: folder.join("log"),
            ranks: 1,
            launcher: Launcher::default(),
            resume: resume.map(Path::to_owned),
            deadline: Duration::from_secs(30),
        };
        Ok(Self {
            parcels: launch.launch(&mut supervisor)?,
            clock: Ticks::new(0),
            received: ParticleReceived::default(),
            supervisor,
        })
    }

    fn new(mesh: &Arc<Mesh>, setup: &ParticleSetup, folder: &Path) -> Self {
        Self::try_new(mesh, setup, (folder, None)).unwrap_or_else(|error| panic!("{error}"))
    }

    fn try_window(&mut self, seconds: f64, push: &ParticlePush) -> Result<(), PartError> {
        let span = Ticks::from_seconds(seconds).unwrap();
        let both = |ticks: Ticks| Clocks {
            motion: ticks,
            process: ticks,
        };
        let window = Window {
            index: 0,
            attempt: 0,
            start: both(self.clock),
            span: both(span),
        };
        self.parcels.start(&window, &Bed::default(), push)?;
        self.parcels.finish(&self.supervisor, &mut self.received)?;
        self.parcels.commit()?;
        self.clock = Ticks::new(self.clock.count() + span.count());
        Ok(())
    }

    fn push(&self) -> ParticlePush {
        ParticlePush {
            force: vec![Vec3::zeros(); self.parcels.fields().len()],
            ..ParticlePush::default()
        }
    }

    /// Windows without any force of the gas.
    fn run(&mut self, windows: usize, seconds: f64) {
        let push = self.push();
        for _ in 0..windows {
            self.try_window(seconds, &push).unwrap();
        }
    }

    fn place(&self, row: usize) -> Vec3 {
        self.parcels.fields().position[row]
    }

    fn velocity(&self, row: usize) -> Vec3 {
        self.parcels.fields().velocity[row]
    }

    fn bits(&self) -> Vec<u64> {
        let fields = self.parcels.fields();
        let vectors = fields.position.iter().chain(fields.velocity);
        vectors
            .flat_map(|vector| vector.iter().map(|x| x.to_bits()).collect::<Vec<_>>())
            .collect()
    }
}

/// One parcel in the middle of a cube of a metre, one cell.
fn alone(rules: impl FnOnce(&mut ParcelMotion), velocity: Vec3, folder: &Path) -> Cloud {
    let mesh = cube(1.0, 1);
    let mut motion = motion(&mesh, 1.0, 0.0);
    rules(&mut motion);
    let parcels = setup(motion, &[(Vec3::repeat(0.5), velocity)], 7.0);
    Cloud::new(&mesh, &parcels, folder)
}

#[test]
fn gravity_and_a_constant_force_are_those_of_the_cloud_and_meet_the_throw_in_first_order() {
    let folder = tempfile::tempdir().unwrap();
    let gravity = Vec3::z() * -9.81;
    let mass = sphere::mass(RADIUS, DENSITY);
    let (force, time) = (mass * Vec3::new(2.0, 0.0, 1.0), 0.2);
    let whole = gravity + force / mass;
    let start = Vec3::new(0.3, -0.2, 1.0);
    let mut errors = Vec::new();
    for windows in [10, 20, 40] {
        let span = time / windows as f64;
        let folder = folder.path().join(windows.to_string());
        std::fs::create_dir(&folder).unwrap();
        let mut cloud = alone(|rules| rules.gravity = gravity, start, &folder);
        let mut push = cloud.push();
        push.force[0] = force;
        for _ in 0..windows {
            cloud.try_window(span, &push).unwrap();
            assert!((cloud.received.impulse[0] - force * span).norm() < 1e-15 * mass);
        }
        let (place, velocity) = (cloud.place(0), cloud.velocity(0));
        assert!((velocity - start - whole * time).norm() < 1e-13);
        // The cloud moves by the velocity of the step's start: a sum over steps.
        let n = windows as f64;
        let summed = start * time + whole * span * span * n * (n - 1.0) / 2.0;
        assert!(
            (place - Vec3::repeat(0.5) - summed).norm() < 1e-13,
            "{place}"
        );
        let exact = start * time + whole * time * time / 2.0;
        errors.push((place - Vec3::repeat(0.5) - exact).norm());
    }
    println!("{errors:?}");
    assert!(
        (errors[0] / errors[1] - 2.0).abs() < 1e-9 && (errors[1] / errors[2] - 2.0).abs() < 1e-9
    );
}

#[test]
fn drag_by_coefficient_relaxes_exactly_and_its_impulse_is_what_the_parcel_gains() {
    let folder = tempfile::tempdir().unwrap();
    let gravity = Vec3::z() * -9.81;
    let start = Vec3::new(0.5, 0.0, 0.0);
    let mut cloud = alone(|rules| rules.gravity = gravity, start, folder.path());
    let mass = cloud.parcels.fields().mass[0];
    assert!((mass / sphere::mass(RADIUS, DENSITY) - 1.0).abs() < 1e-14);
    let (rate, gas) = (40.0, Vec3::new(0.0, 0.3, 0.1));
    let mut push = cloud.push();
    push.columns.set(DRAG_COEFFICIENT, 1, vec![rate * mass]);
    push.columns.set(GAS_VELOCITY, 3, gas.as_slice().to_vec());
    let mut dragged = Vec3::zeros();
    for _ in 0..10 {
        cloud.try_window(0.01, &push).unwrap();
        let impulse = cloud.received.columns.get(DRAG_IMPULSE, 3, 1).unwrap();
        dragged += Vec3::new(impulse[0], impulse[1], impulse[2]);
        assert_eq!(cloud.received.impulse[0].as_slice(), impulse);
    }
    let settled = gas + gravity / rate;
    let exact = settled + (start - settled) * (-rate * 0.1_f64).exp();
    let velocity = cloud.velocity(0);
    assert!((velocity - exact).norm() < 1e-13, "{velocity} {exact}");
    let gained = mass * (velocity - start - gravity * 0.1);
    assert!((gained - dragged).norm() < 1e-13 * gained.norm());
}

#[test]
fn walls_rebound_rub_and_carry_along() {
    let folder = tempfile::tempdir().unwrap();
    let case = |name: &str| {
        let path = folder.path().join(name);
        std::fs::create_dir(&path).unwrap();
        path
    };
    // One wall after another; friction is limited by the impact, then by the slip.
    let mesh = cube(1.0, 4);
    let rules = motion(&mesh, 0.6, 0.25);
    let parcels = [
        (Vec3::new(0.1, 0.5, 0.1), Vec3::new(3.0, 0.0, -1.0)),
        (Vec3::new(0.5, 0.5, 0.1), Vec3::new(0.1, -0.1, -1.0)),
    ];
    let mut cloud = Cloud::new(&mesh, &setup(rules, &parcels, 1.0), &case("still"));
    cloud.run(1, 0.15);
    assert!((cloud.velocity(0) - Vec3::new(2.6, 0.0, 0.6)).norm() < 1e-13);
    assert!((cloud.velocity(1) - Vec3::new(0.0, 0.0, 0.6)).norm() < 1e-13);
    // A belt.
    let mut rules = motion(&mesh, 0.0, 0.5);
    rules.walls[4].motion = WallMotion::Translating(Vec3::new(2.0, 0.0, 0.0));
    assert_eq!(rules.walls[4].patch, "bottom");
    // A wall that turns about an axis through its middle: at a quarter from it.
    rules.walls[5].motion = WallMotion::Rotating {
        point: Vec3::new(0.5, 0.5, 0.0),
        angular_velocity: Vec3::z() * 4.0,
    };
    let parcels = [
        (Vec3::new(0.5, 0.5, 0.1), Vec3::new(0.0, 0.0, -1.0)),
        (Vec3::new(0.875, 0.625, 0.9), Vec3::new(0.0, 0.0, 10.0)),
    ];
    let mut cloud = Cloud::new(&mesh, &setup(rules, &parcels, 1.0), &case("moving"));
    cloud.run(1, 0.12);
    assert!((cloud.velocity(0) - Vec3::new(0.5, 0.0, 0.0)).norm() < 1e-13);
    // The velocity of the face's centre, as U has it there.
    let turned = Vec3::z().cross(&Vec3::new(0.375, 0.125, 0.0)) * 4.0;
    assert!(
        (cloud.velocity(1) - turned).norm() < 1e-12,
        "{}",
        cloud.velocity(1)
    );
}

#[test]
fn a_parcel_that_leaves_through_a_periodic_plane_comes_in_through_the_other() {
    let folder = tempfile::tempdir().unwrap();
    let pairs = [["west", "east"], ["south", "north"]].map(|pair| pair.map(str::to_owned));
    let mesh = Mesh::clone(&cube(1.0, 4)).with_periodic(&pairs).unwrap();
    let mesh = Arc::new(mesh);
    let start = Vec3::new(0.6, 0.3, 0.5);
    let velocity = Vec3::new(2.0, -1.5, 0.1);
    let parcels = setup(motion(&mesh, 1.0, 0.0), &[(start, velocity)], 1.0);
    let mut cloud = Cloud::new(&mesh, &parcels, folder.path());
    cloud.run(5, 0.25);
    let due = (start + velocity * 1.25).map(|x| x.rem_euclid(1.0));
    assert!((cloud.place(0) - due).norm() < 1e-12, "{}", cloud.place(0));
    assert!((cloud.velocity(0) - velocity).norm() < 1e-15);
}

/// A bed that falls together, with all that the cloud does.
fn crowded(mesh: &Mesh, rules: impl FnOnce(&mut ParcelMotion)) -> ParticleSetup {
    let mut motion = motion(mesh, 0.5, 0.2);
    motion.gravity = Vec3::z() * -9.81;
    motion.packing = ParcelPacking::Implicit(STRESS);
    motion.collisions.damping = true;
    motion.collisions.isotropy = true;
    rules(&mut motion);
    let mut state = 1u64;
    let mut next = || {
        state = state
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1u64 << 53) as f64
    };
    let count = 2000;
    let parcels: Vec<(Vec3, Vec3)> = (0..count)
        .map(|_| {
            let mut three = || Vec3::new(next(), next(), next());
            (three() * 0.1, (three() - Vec3::repeat(0.5)) * 0.5)
        })
        .collect();
    let weight = 0.4 * 1e-3 / (count as f64 * sphere::volume(RADIUS));
    setup(motion, &parcels, weight)
}

#[test]
fn a_run_goes_on_from_a_checkpoint_to_the_same_bits() {
    let folder = tempfile::tempdir().unwrap();
    let mesh = cube(0.1, 4);
    let explicit = ParcelPacking::Explicit {
        stress: STRESS,
        restitution: 0.9,
    };
    for (name, packing) in [
        ("implicit", ParcelPacking::Implicit(STRESS)),
        ("explicit", explicit),
    ] {
        let parcels = crowded(&mesh, |rules| rules.packing = packing);
        let kept = folder.path().join(format!("{name}-kept"));
        let mut places =
            ["whole", "resumed", "never"].map(|one| folder.path().join(format!("{name}-{one}")));
        places
            .iter_mut()
            .for_each(|one| std::fs::create_dir(one).unwrap());
        std::fs::create_dir(&kept).unwrap();
        let mut whole = Cloud::new(&mesh, &parcels, &places[0]);
        whole.run(5, 2e-3);
        whole.parcels.checkpoint(&kept).unwrap();
        let resumed = Cloud::try_new(&mesh, &parcels, (&places[1], Some(&kept)));
        let mut resumed = resumed.unwrap_or_else(|error| panic!("{error}"));
        assert!(
            whole.bits() == resumed.bits(),
            "{name}: the state that was written"
        );
        for cloud in [&mut whole, &mut resumed] {
            cloud.run(5, 2e-3);
        }
        assert!(whole.bits() == resumed.bits(), "{name}: ten windows later");
        let mut never = Cloud::new(&mesh, &parcels, &places[2]);
        never.run(10, 2e-3);
        assert!(
            whole.bits() == never.bits(),
            "{name}: without any checkpoint"
        );
    }
}

#[test]
fn a_change_takes_out_puts_in_and_resizes_what_it_names_alone() {
    let folder = tempfile::tempdir().unwrap();
    let mesh = cube(0.1, 4);
    let parcels = crowded(&mesh, |rules| rules.packing = ParcelPacking::None);
    let mut cloud = Cloud::new(&mesh, &parcels, folder.path());
    let before = cloud.parcels.fields().position.to_vec();
    let change = ParticleChanges {
        remove: vec![1, 7],
        insert: vec![NewParticle {
            id: 2001,
            population: 0,
            position: Vec3::repeat(0.03),
            velocity: Vec3::x(),
            radius: 2.0 * RADIUS,
            density: 1000.0,
            weight: 3.0,
        }],
        resize: vec![Resized {
            id: 4,
            radius: 0.5 * RADIUS,
            mass: 1e-7,
        }],
        rest: false,
    };
    let supervisor = Supervisor::new(Duration::from_secs(30), Interrupts::default());
    cloud.parcels.change(&supervisor, &change).unwrap();
    let fields = cloud.parcels.fields();
    assert_eq!(fields.len(), 1999);
    assert_eq!(
        [fields.id[0], fields.id[4], fields.id[5], fields.id[1998]],
        [2, 6, 8, 2001]
    );
    assert_eq!(
        [fields.position[0], fields.position[5]],
        [before[1], before[7]]
    );
    assert!((fields.position[1998] - Vec3::repeat(0.03)).norm() < 1e-16);
    assert_eq!(fields.velocity[1998], Vec3::x());
    assert_eq!(fields.weight[1998], 3.0);
    assert_eq!(fields.radius[2], 0.5 * RADIUS);
    assert!((fields.mass[2] / 1e-7 - 1.0).abs() < 1e-14);
    cloud.run(2, 1e-3);
}

#[test]
fn what_the_cloud_cannot_do_is_refused_by_name() {
    let folder = tempfile::tempdir().unwrap();
    let mesh = cube(0.1, 2);
    let refused = |rules: &dyn Fn(&mut ParcelMotion), place: Vec3| {
        let mut motion = motion(&mesh, 0.5, 0.2);
        rules(&mut motion);
        let parcels = setup(motion, &[(place, Vec3::x() * 50.0)], 1.0);
        let cloud = Cloud::try_new(&mesh, &parcels, (folder.path(), None));
        let outcome = cloud.and_then(|mut cloud| {
            let push = cloud.push();
            cloud.try_window(0.1, &push)
        });
        let error = outcome.unwrap_err();
        println!("{error}");
        error
    };
    let within = Vec3::repeat(0.05);
    let friction = ParcelFriction {
        bed: 0.5,
        slip: 1e-3,
    };
    let error = refused(&|rules| rules.friction = Some(friction), within);
    assert!(error.to_string().contains("motion.parcels.friction"));
    let resistance = ParcelResistance {
        rate: 1.0,
        wall: WallMotion::Still,
    };
    let error = refused(&|rules| rules.resistance = Some(resistance.clone()), within);
    assert!(error.to_string().contains("motion.parcels.resistance"));
    let stiff = HarrisCrighton {
        floor: 1e-7,
        ..STRESS
    };
    let error = refused(
        &|rules| rules.packing = ParcelPacking::Implicit(stiff),
        within,
    );
    assert_eq!(error.kind, FailureKind::Refused);
    assert!(
        error.to_string().contains("motion.parcels.floor"),
        "{error}"
    );
    let error = refused(&|_| {}, Vec3::repeat(0.2));
    assert!(
        error
            .to_string()
            .contains("parcel 1 is at (0.2, 0.2, 0.2) m, outside the mesh")
    );
    let mut spheres = setup(motion(&mesh, 0.5, 0.2), &[(within, Vec3::zeros())], 1.0);
    spheres.motion = Motion::Frozen;
    let error = Cloud::try_new(&mesh, &spheres, (folder.path(), None))
        .err()
        .unwrap();
    assert!(error.to_string().contains("[motion.parcels]"), "{error}");
}
