//! Agreement of two codes: parcels that Calcine moves and parcels that OpenFOAM's cloud moves, of the same case.
//! OpenFOAM takes part: `cargo xtask test` builds calcineParcelFoam.

#![allow(clippy::unwrap_used, clippy::panic, clippy::print_stdout)]

use std::path::Path;
use std::sync::Arc;
use std::time::Duration;

use calcine_adapters::launch::Launcher;
use calcine_adapters::openfoam::parcels::ParcelLaunch;
use calcine_coupler::mesh::Mesh;
use calcine_coupler::mesh::block::{BoxSpec, box_mesh};
use calcine_coupler::motion::{Motion, WallMotion};
use calcine_coupler::parcels::{
    ParcelCollisions, ParcelImpact, ParcelMotion, ParcelPacking, ParcelWall,
};
use calcine_coupler::part::{
    Bed, DRAG_COEFFICIENT, GAS_VELOCITY, ParticlePush, ParticleReceived, Particles,
};
use calcine_coupler::physics::parcels::{CollisionTimes, HarrisCrighton};
use calcine_coupler::physics::{Vec3, sphere};
use calcine_coupler::setup::ParticleSetup;
use calcine_coupler::supervisor::{Interrupts, Supervisor};
use calcine_coupler::time::{Clocks, Ticks, Window};
use calcine_native::parcels::NativeParcels;

/// A column of 200 mm with a suspension, in a gas that stands still and drags such that a parcel falls with
/// 0.1 m/s (1 − α)³.
const HEIGHT: f64 = 0.2;
const WIDTH: f64 = 0.01;
const LAYERS: usize = 50;
const FALL: f64 = 0.1;
const POWER: i32 = 3;
const RADIUS: f64 = 0.1e-3;
const GRAVITY: f64 = 9.81;
const STRESS: HarrisCrighton = HarrisCrighton {
    pressure: 10.0,
    exponent: 2.0,
    floor: 1e-2,
    close_packing: 0.6,
};

fn mesh() -> Arc<Mesh> {
    let mesh = box_mesh(&BoxSpec {
        origin: Vec3::zeros(),
        size: Vec3::new(WIDTH, WIDTH, HEIGHT),
        cells: [1, 1, LAYERS],
        patches: ["side", "side", "side", "side", "bottom", "top"].map(str::to_owned),
    });
    Arc::new(mesh.unwrap())
}

/// An even suspension at rest.
fn suspension(mesh: &Mesh, fraction: f64) -> ParticleSetup {
    let walls = mesh.patches().iter().map(|patch| ParcelWall {
        patch: patch.name.clone(),
        motion: WallMotion::Still,
        impact: vec![ParcelImpact {
            restitution: 0.0,
            friction: 0.0,
        }],
    });
    let motion = ParcelMotion {
        gravity: Vec3::z() * -GRAVITY,
        courant: 0.5,
        most_steps: 10_000,
        walls: walls.collect(),
        packing: ParcelPacking::Implicit(STRESS),
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
    };
    let (across, levels) = (3, 150);
    let at = |k: usize, of: usize, size: f64| (k as f64 + 0.5) / of as f64 * size;
    let places = (0..levels * across * across).map(|row| {
        let (i, j, k) = (row % across, row / across % across, row / (across * across));
        Vec3::new(
            at(i, across, WIDTH),
            at(j, across, WIDTH),
            at(k, levels, HEIGHT),
        )
    });
    let position: Vec<Vec3> = places.collect();
    let count = position.len();
    let weight = fraction * WIDTH * WIDTH * HEIGHT / (count as f64 * sphere::volume(RADIUS));
    ParticleSetup {
        id: (1..=count as u64).collect(),
        population: vec![0; count],
        position,
        radius: vec![RADIUS; count],
        density: vec![2500.0; count],
        velocity: Vec::new(),
        angular_velocity: Vec::new(),
        weight: vec![weight; count],
        motion: Motion::Parcels(Box::new(motion)),
    }
}

/// Solid fraction of each layer by linear weights between the centres of layers.
fn profile(parcels: &dyn Particles) -> Vec<f64> {
    let fields = parcels.fields();
    let cell = HEIGHT / LAYERS as f64;
    let mut solid = vec![0.0; LAYERS];
    for row in 0..fields.len() {
        let volume = fields.weight[row] * sphere::volume(fields.radius[row]);
        let place = (fields.position[row].z / cell - 0.5).clamp(0.0, LAYERS as f64 - 1.0);
        let below = (place as usize).min(LAYERS - 2);
        let share = place - below as f64;
        solid[below] += (1.0 - share) * volume;
        solid[below + 1] += share * volume;
    }
    solid
        .iter()
        .map(|volume| volume / (WIDTH * WIDTH * cell))
        .collect()
}

/// What is seen of a suspension that settles.
struct Settled {
    /// Speeds in m/s of the front of the bed and of the top of what falls.
    fronts: [f64; 2],
    /// Mean heights in m, window by window.
    heights: Vec<f64>,
    /// Solid fractions of the layers at the end.
    profile: Vec<f64>,
}

fn settle(parcels: &mut dyn Particles, start: f64) -> Settled {
    let falls = FALL * (1.0 - start).powi(POWER);
    let rises = start * falls / (STRESS.close_packing - start);
    let span = 4e-3;
    // Until the fronts are well apart from each other and from the ends.
    let windows = (0.85 * HEIGHT / (falls + rises) / span).round() as usize;
    let supervisor = Supervisor::new(Duration::from_secs(60), Interrupts::default());
    let ticks = Ticks::from_seconds(span).unwrap();
    let (mut heights, mut seen) = (Vec::new(), Vec::new());
    for index in 0..4 * windows {
        let layers = profile(parcels);
        if index == windows / 4 || index == windows {
            seen.push(fronts(&layers, start));
        }
        let fields = parcels.fields();
        let count = fields.len();
        let mut push = ParticlePush {
            force: vec![Vec3::zeros(); count],
            ..ParticlePush::default()
        };
        let drag = (0..count).map(|row| {
            let layer = (fields.position[row].z / HEIGHT * LAYERS as f64) as usize;
            let void = (1.0 - layers[layer.min(LAYERS - 1)]).max(0.2);
            fields.mass[row] * GRAVITY / (FALL * void.powi(POWER))
        });
        push.columns.set(DRAG_COEFFICIENT, 1, drag.collect());
        push.columns.set(GAS_VELOCITY, 3, vec![0.0; 3 * count]);
        let both = |count: i64| Clocks {
            motion: Ticks::new(count),
            process: Ticks::new(count),
        };
        let window = Window {
            index: index as u64,
            attempt: 0,
            start: both(index as i64 * ticks.count()),
            span: both(ticks.count()),
        };
        let mut received = ParticleReceived::default();
        parcels.start(&window, &Bed::default(), &push).unwrap();
        parcels.finish(&supervisor, &mut received).unwrap();
        parcels.commit().unwrap();
        let heights_now = parcels.fields().position.iter().map(|place| place.z);
        heights.push(heights_now.sum::<f64>() / count as f64);
    }
    let seconds = span * (windows - windows / 4) as f64;
    Settled {
        fronts: [
            (seen[1][0] - seen[0][0]) / seconds,
            (seen[0][1] - seen[1][1]) / seconds,
        ],
        heights,
        profile: profile(parcels),
    }
}

/// Heights of the front of the bed, and of the top of what still falls.
fn fronts(profile: &[f64], start: f64) -> [f64; 2] {
    let cell = HEIGHT / LAYERS as f64;
    let down = |level: f64| {
        let above = profile.iter().rposition(|one| *one > level).unwrap();
        let next = profile.get(above + 1).copied().unwrap_or(0.0);
        let share = (profile[above] - level) / (profile[above] - next);
        (above as f64 + 0.5 + share) * cell
    };
    [
        down(0.5 * (start + STRESS.close_packing)),
        down(0.5 * start),
    ]
}

fn openfoam(mesh: &Arc<Mesh>, setup: &ParticleSetup, folder: &Path) -> Box<dyn Particles> {
    let mut supervisor = Supervisor::new(Duration::from_secs(60), Interrupts::default());
    let launch = ParcelLaunch {
        setup,
        mesh: Arc::clone(mesh),
        moving_drag: true,
        case_hash: "test".into(),
        folder: folder.join("case"),
        log: folder.join("log"),
        ranks: 1,
        launcher: Launcher::default(),
        resume: None,
        deadline: Duration::from_secs(60),
    };
    let launched = launch.launch(&mut supervisor);
    Box::new(launched.unwrap_or_else(|error| panic!("{error}")))
}

#[test]
fn a_suspension_settles_alike_natively_and_in_openfoam_and_as_kinematic_waves_do() {
    for start in [0.1, 0.15, 0.2] {
        let folder = tempfile::tempdir().unwrap();
        let mesh = mesh();
        let setup = suspension(&mesh, start);
        let falls = FALL * (1.0 - start).powi(POWER);
        let rises = start * falls / (STRESS.close_packing - start);
        let mut native = NativeParcels::new(Arc::clone(&mesh), &setup).unwrap();
        let native = settle(&mut native, start);
        let foam = settle(&mut *openfoam(&mesh, &setup, folder.path()), start);
        for (name, one) in [("native", &native), ("OpenFOAM", &foam)] {
            let most = one.profile.iter().copied().fold(0.0, f64::max);
            println!(
                "{start} {name}: fronts {:?} of {rises} {falls}, height at the end {}, most {most}",
                one.fronts,
                one.heights.last().unwrap()
            );
        }
        let apart = native.heights.iter().zip(&foam.heights);
        let apart = apart.map(|(a, b)| (b / a - 1.0).abs()).fold(0.0, f64::max);
        let layers = native.profile.iter().zip(&foam.profile);
        let worst = layers.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max) / STRESS.close_packing;
        println!("{start}: heights {apart}, layers {worst}");
        println!("{:.3?}\n{:.3?}", native.profile, foam.profile);
    }
}
