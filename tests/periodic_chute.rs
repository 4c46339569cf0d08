//! Spheres down a rough chute that repeats itself along and across the flow (Silbert, Ertaş, Grest, Halsey, Levine and
//! Plimpton, Phys. Rev. E 64 (2001) 051302, doi 10.1103/PhysRevE.64.051302, with fewer of them): gravity is inclined, and held
//! spheres are the bottom. LIGGGHTS takes part: `cargo xtask test` builds its host.
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
    Cohesion, ContactForce, ContactLaw, Contacts, Elastic, Motion, Pair, Rolling,
};
use calcine_coupler::part::{
    Bed as VoidFractions, ParticleFields, ParticlePush, ParticleReceived, Particles,
};
use calcine_coupler::periodicity::{PeriodicSpan, Periodicity};
use calcine_coupler::physics::{Vec3, sphere};
use calcine_coupler::setup::ParticleSetup;
use calcine_coupler::supervisor::{Interrupts, Supervisor};
use calcine_coupler::time::{Clocks, Ticks, Window};
use calcine_native::particles::NativeParticles;

/// Time step in s: 7 % of Rayleigh's time.
const STEP: f64 = 2e-5;
/// Steps of a window.
const STEPS: i64 = 500;
/// Diameter in m.
const DIAMETER: f64 = 2e-3;
/// Periods along and across in m.
const PERIODS: [f64; 2] = [8.1 * DIAMETER, 5.1 * DIAMETER];
/// Held spheres along and across, and layers of free ones.
const COUNTS: [usize; 3] = [8, 5, 9];
/// Gravity in m/s², and the inclination in degrees.
const GRAVITY: (f64, f64) = (9.81, 25.0);
/// Height of a slab of the profiles in m, and their number: the flow is some 9 diameters high.
const SLABS: (f64, usize) = (1.5 * DIAMETER, 7);

fn contacts() -> Contacts {
    let span = |high: f64| Some(PeriodicSpan { low: 0.0, high });
    let angle = GRAVITY.1.to_radians();
    Contacts {
        step: STEP,
        gravity: GRAVITY.0 * Vec3::new(angle.sin(), 0.0, -angle.cos()),
        bounds: (
            Vec3::new(0.0, 0.0, -DIAMETER),
            Vec3::new(PERIODS[0], PERIODS[1], 30.0 * DIAMETER),
        ),
        periodicity: Periodicity {
            axes: [span(PERIODS[0]), span(PERIODS[1]), None],
        },
        materials: vec![Elastic {
            young: 1e6,
            poisson: 0.25,
        }],
        material_of: vec![0, 0],
        held: vec![false, true],
        law: ContactLaw {
            force: ContactForce::HertzMindlin,
            attractive_damping: true,
            rolling: Rolling::None,
            cohesion: Cohesion::None,
        },
        pairs: vec![Pair {
            restitution: 0.7,
            friction: 0.5,
            ..Pair::default()
        }],
        walls: Vec::new(),
    }
}

/// Numbers in [−1, 1) of a linear congruential generator (Knuth's MMIX constants).
fn scatter() -> impl FnMut() -> f64 {
    let mut state = 5u64;
    move || {
        state = state
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        2.0 * (state >> 11) as f64 / (1u64 << 53) as f64 - 1.0
    }
}

/// The chute, all places moved by a shift in m.
fn chute(shift: Vec3) -> ParticleSetup {
    let contacts = contacts();
    let mut next = scatter();
    let [nx, ny, layers] = COUNTS;
    let mut setup = ParticleSetup::default();
    for layer in 0..=layers {
        for j in 0..ny {
            for i in 0..nx {
                let spacing = Vec3::new(PERIODS[0] / nx as f64, PERIODS[1] / ny as f64, 0.0);
                let at = |index: usize, axis: usize| (index as f64 + 0.5) * spacing[axis];
                let random = Vec3::new(next(), next(), next());
                // The bottom is uneven by half a diameter; layers above begin apart from each other.
                let (height, jitter) = match layer {
                    0 => (0.0, Vec3::new(0.0, 0.0, 0.25)),
                    _ => (1.35 * layer as f64 + 0.25, Vec3::new(0.0, 0.0, 0.1)),
                };
                let place = Vec3::new(at(i, 0), at(j, 1), height * DIAMETER);
                let place = place + DIAMETER * random.component_mul(&jitter) + shift;
                setup.id.push(setup.id.len() as u64 + 1);
                setup.population.push(u32::from(layer == 0));
                setup.position.push(contacts.periodicity.wrap(place));
                setup.radius.push(0.5 * DIAMETER);
                setup.density.push(2500.0);
                let along = if layer == 0 { 0.0 } else { 0.02 * layer as f64 };
                let shaken = if layer == 0 {
                    Vec3::zeros()
                } else {
                    random * 0.05
                };
                setup.velocity.push(Vec3::x() * along + shaken);
            }
        }
    }
    setup.motion = Motion::Free(Box::new(contacts));
    setup
}

/// Profiles over the height, as means over time.
#[derive(Clone, Debug, Default)]
struct Profiles {
    velocity: Vec<f64>,
    solid_fraction: Vec<f64>,
    windows: f64,
}

impl Profiles {
    fn add(&mut self, bed: &ParticleFields<'_>) {
        self.velocity.resize(SLABS.1, 0.0);
        self.solid_fraction.resize(SLABS.1, 0.0);
        let (mut speed, mut count) = (vec![0.0; SLABS.1], vec![0.0; SLABS.1]);
        for row in (0..bed.len()).filter(|&row| bed.population[row] == 0) {
            let slab = (bed.position[row].z / SLABS.0) as usize;
            if slab < SLABS.1 {
                speed[slab] += bed.velocity[row].x;
                count[slab] += 1.0;
            }
        }
        let one = sphere::volume(0.5 * DIAMETER) / (PERIODS[0] * PERIODS[1] * SLABS.0);
        for slab in 0..SLABS.1 {
            self.velocity[slab] += speed[slab] / f64::max(count[slab], 1.0);
            self.solid_fraction[slab] += one * count[slab];
        }
        self.windows += 1.0;
    }

    fn mean(&self) -> (Vec<f64>, Vec<f64>) {
        let mean = |list: &[f64]| list.iter().map(|value| value / self.windows).collect();
        (mean(&self.velocity), mean(&self.solid_fraction))
    }
}

/// Runs so many windows, and has each looked at.
fn run(
    part: &mut dyn Particles,
    supervisor: &Supervisor,
    windows: u64,
    mut look: impl FnMut(u64, &ParticleFields<'_>, &ParticleReceived),
) {
    let push = ParticlePush {
        force: vec![Vec3::zeros(); part.fields().len()],
        ..ParticlePush::default()
    };
    let span = Ticks::from_seconds(STEPS as f64 * STEP).unwrap();
    let mut start = Ticks::ZERO;
    let mut received = ParticleReceived::default();
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
        part.start(&window, &VoidFractions::default(), &push)
            .unwrap();
        part.finish(supervisor, &mut received).unwrap();
        part.commit().unwrap();
        start = start.checked_add(span).unwrap();
        look(index, &part.fields(), &received);
    }
}

fn supervisor() -> Supervisor {
    Supervisor::new(Duration::from_secs(120), Interrupts::default())
}

/// Windows until the flow is steady, and windows that are averaged: 2 s and 2 s.
const WINDOWS: [u64; 2] = [200, 200];

/// Profiles of the first and the second half of the time that is averaged.
fn profiles(part: &mut dyn Particles, supervisor: &Supervisor) -> [Profiles; 2] {
    let mut found = [Profiles::default(), Profiles::default()];
    run(
        part,
        supervisor,
        WINDOWS[0] + WINDOWS[1],
        |index, bed, _| {
            if index >= WINDOWS[0] {
                found[usize::from(index >= WINDOWS[0] + WINDOWS[1] / 2)].add(bed);
            }
        },
    );
    found
}

fn both([one, other]: &[Profiles; 2]) -> (Vec<f64>, Vec<f64>) {
    let sum = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| 0.5 * (a + b)).collect();
    let ((u, s), (v, t)) = (one.mean(), other.mean());
    (sum(&u, &v), sum(&s, &t))
}

fn liggghts(setup: &ParticleSetup, supervisor: &mut Supervisor, folder: &Path) -> LinkedParticles {
    let Motion::Free(contacts) = &setup.motion else {
        panic!("they move");
    };
    let launch = LiggghtsLaunch {
        inputs: Inputs {
            setup,
            bounds: contacts.bounds,
            step: STEP,
            ranks: 1,
            wall_impulse: false,
            moving_drag: false,
            template: None,
        },
        case_hash: "chute".into(),
        launcher: Launcher::Mpirun,
        log: folder.join("liggghts.log"),
        folder: folder.join("run"),
        resume: None,
        deadline: Duration::from_secs(120),
    };
    launch.launch(supervisor).unwrap()
}

/// The middle of the flow, where neither the bottom nor the surface is near.
const BULK: std::ops::Range<usize> = 1..5;

/// The largest differences of the profiles: of velocities over the largest one, and of solid fractions.
fn differences(one: &(Vec<f64>, Vec<f64>), other: &(Vec<f64>, Vec<f64>)) -> [f64; 2] {
    let most = |a: &[f64], b: &[f64]| {
        let each = BULK.map(|slab| (a[slab] - b[slab]).abs());
        each.fold(0.0, f64::max)
    };
    let fastest = one.0.iter().copied().fold(0.0, f64::max);
    [most(&one.0, &other.0) / fastest, most(&one.1, &other.1)]
}

#[test]
fn native_and_liggghts_flow_down_a_periodic_chute_alike_wherever_the_planes_cut() {
    let setup = chute(Vec3::zeros());
    let mut supervisor = supervisor();
    let folder = tempfile::tempdir().unwrap();
    let mut other = liggghts(&setup, &mut supervisor, folder.path());
    let theirs = profiles(&mut other, &supervisor);
    let own = profiles(&mut NativeParticles::new(&setup).unwrap(), &supervisor);
    let moved = chute(Vec3::new(0.5 * PERIODS[0], 0.5 * PERIODS[1], 0.0));
    let moved = profiles(&mut NativeParticles::new(&moved).unwrap(), &supervisor);
    for (name, [first, second]) in [("native", &own), ("moved", &moved), ("LIGGGHTS", &theirs)] {
        println!("{name}: {:?} {:?}", first.mean(), second.mean());
        let steady = differences(&first.mean(), &second.mean());
        println!("{name}, steady: {steady:?}");
    }
    for (what, other) in [("LIGGGHTS", &theirs), ("moved", &moved)] {
        let found = differences(&both(&own), &both(other));
        println!("native against {what}: {found:?}");
    }
}
