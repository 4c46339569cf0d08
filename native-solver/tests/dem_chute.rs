//! Spheres down a rough chute that repeats itself along and across the flow (Silbert, Ertaş, Grest, Halsey, Levine and Plimpton, Phys.
//! Rev. E 64 (2001) 051302, doi 10.1103/PhysRevE.64.051302, with fewer of them): gravity is inclined, and held spheres are the bottom.
#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::panic,
    clippy::print_stdout
)]

use calcine_coupler::motion::{Contacts, NewParticle};
use calcine_coupler::part::Particles;
use calcine_coupler::periodicity::{PeriodicSpan, Periodicity};
use calcine_coupler::physics::{Vec3, sphere};

use crate::grains::{Bed, contacts as spheres_of, scatter, sphere as one};

/// Time step in s: a seventh of Rayleigh's time.
const STEP: f64 = 4e-5;
/// Steps of a window.
const STEPS: u64 = 500;
/// Diameter in m.
const DIAMETER: f64 = 2e-3;
/// Periods along and across in m.
const PERIODS: [f64; 2] = [8.1 * DIAMETER, 5.1 * DIAMETER];
/// Held spheres along and across, and layers of free ones.
const COUNTS: [usize; 3] = [8, 5, 9];
/// Gravity in m/s², and the inclination in degrees.
const GRAVITY: (f64, f64) = (9.81, 25.0);
/// Height of a slab of the profiles in m, and their number.
const SLABS: (f64, usize) = (1.5 * DIAMETER, 7);
/// Windows until the flow is steady, and windows that are averaged.
const WINDOWS: [usize; 2] = [100, 100];

fn contacts() -> Contacts {
    let span = |high: f64| Some(PeriodicSpan { low: 0.0, high });
    let angle = GRAVITY.1.to_radians();
    let mut contacts = Contacts {
        gravity: GRAVITY.0 * Vec3::new(angle.sin(), 0.0, -angle.cos()),
        bounds: (
            Vec3::new(0.0, 0.0, -DIAMETER),
            Vec3::new(PERIODS[0], PERIODS[1], 30.0 * DIAMETER),
        ),
        periodicity: Periodicity {
            axes: [span(PERIODS[0]), span(PERIODS[1]), None],
        },
        material_of: vec![0, 0],
        held: vec![false, true],
        ..spheres_of(STEP)
    };
    contacts.materials[0].young = 1e6;
    contacts.pairs[0].restitution = 0.7;
    contacts.pairs[0].friction = 0.5;
    contacts
}

/// The chute, all places moved by a shift in m.
fn chute(shift: Vec3) -> Bed {
    let contacts = contacts();
    let mut unit = scatter(5);
    let mut next = || 2.0 * unit() - 1.0;
    let [nx, ny, layers] = COUNTS;
    let mut all: Vec<NewParticle> = Vec::new();
    for layer in 0..=layers {
        for j in 0..ny {
            for i in 0..nx {
                let along = [(i, nx, PERIODS[0]), (j, ny, PERIODS[1])]
                    .map(|(index, count, period)| (index as f64 + 0.5) * period / count as f64);
                // The bottom is uneven by half a diameter; layers above begin apart from each other.
                let (height, jitter) = match layer {
                    0 => (0.0, Vec3::new(0.0, 0.0, 0.25)),
                    _ => (1.35 * layer as f64 + 0.25, Vec3::new(0.0, 0.0, 0.1)),
                };
                let random = Vec3::new(next(), next(), next());
                let place = Vec3::new(along[0], along[1], height * DIAMETER);
                let place = place + DIAMETER * random.component_mul(&jitter) + shift;
                let velocity = match layer {
                    0 => Vec3::zeros(),
                    _ => Vec3::x() * (0.05 * layer as f64) + random * 0.05,
                };
                let place = contacts.periodicity.wrap(place);
                let id = all.len() as u64 + 1;
                let mut new = one(id, place, velocity, 0.5 * DIAMETER);
                new.population = u32::from(layer == 0);
                all.push(new);
            }
        }
    }
    Bed::new(contacts, &all)
}

/// Mean velocity along the flow and solid fraction of each slab, over windows.
#[derive(Clone, Debug, Default)]
struct Profile {
    velocity: Vec<f64>,
    solid: Vec<f64>,
}

fn profile(bed: &mut Bed, windows: usize) -> Profile {
    let mut made = Profile {
        velocity: vec![0.0; SLABS.1],
        solid: vec![0.0; SLABS.1],
    };
    let volume = sphere::volume(0.5 * DIAMETER) / (PERIODS[0] * PERIODS[1] * SLABS.0);
    for _ in 0..windows {
        bed.run(STEPS);
        let fields = bed.particles.fields();
        let mut count = vec![0.0; SLABS.1];
        let mut speed = vec![0.0; SLABS.1];
        for row in (0..fields.len()).filter(|&row| fields.population[row] == 0) {
            let slab = (fields.position[row].z / SLABS.0) as usize;
            if slab < SLABS.1 {
                count[slab] += 1.0;
                speed[slab] += fields.velocity[row].x;
            }
        }
        for slab in 0..SLABS.1 {
            made.velocity[slab] += speed[slab] / f64::max(count[slab], 1.0) / windows as f64;
            made.solid[slab] += volume * count[slab] / windows as f64;
        }
    }
    made
}

/// The middle of the flow, where neither the bottom nor the surface is near.
const BULK: std::ops::Range<usize> = 1..4;

/// The largest differences of velocities over the largest one, and of solid fractions.
fn apart(one: &Profile, other: &Profile) -> [f64; 2] {
    let most = |a: &[f64], b: &[f64]| {
        let each = BULK.clone().map(|slab| (a[slab] - b[slab]).abs());
        each.fold(0.0, f64::max)
    };
    let fastest = one.velocity.iter().copied().fold(0.0, f64::max);
    [
        most(&one.velocity, &other.velocity) / fastest,
        most(&one.solid, &other.solid),
    ]
}

#[test]
fn a_periodic_chute_flows_alike_wherever_its_planes_cut() {
    let mut beds = [
        Vec3::zeros(),
        Vec3::new(0.5 * PERIODS[0], 0.5 * PERIODS[1], 0.0),
    ]
    .map(chute);
    let [own, moved] = beds.each_mut().map(|bed| {
        profile(bed, WINDOWS[0]);
        let halves = [0, 1].map(|_| profile(bed, WINDOWS[1] / 2));
        let mean = |of: fn(&Profile) -> &Vec<f64>| {
            let [a, b] = [of(&halves[0]), of(&halves[1])];
            a.iter().zip(b).map(|(a, b)| 0.5 * (a + b)).collect()
        };
        let whole = Profile {
            velocity: mean(|one| &one.velocity),
            solid: mean(|one| &one.solid),
        };
        (whole, apart(&halves[0], &halves[1]))
    });
    let found = apart(&own.0, &moved.0);
    println!("{own:?}\n{moved:?}\n{found:?}");
    // It flows, dense, faster above than below.
    let Profile { velocity, solid } = &own.0;
    assert!(
        velocity[3] > 1.5 * velocity[1] && velocity[1] > 0.0,
        "{velocity:?}"
    );
    assert!(
        BULK.clone().all(|slab| (0.4..0.62).contains(&solid[slab])),
        "{solid:?}"
    );
    // What two runs of these lengths differ by.
    assert!(found[0] < 0.1 && found[1] < 0.02, "{found:?}");
}

/// What gravity gives a window and what the bottom takes are the change of momentum, across planes too.
#[test]
fn gravity_and_the_bottom_are_all_that_changes_the_momentum_of_a_chute() {
    let mut bed = chute(Vec3::zeros());
    let mass = 2500.0 * sphere::volume(0.5 * DIAMETER);
    let momentum = |bed: &Bed| -> Vec3 {
        let fields = bed.particles.fields();
        let free = (0..fields.len()).filter(|&row| fields.population[row] == 0);
        free.map(|row| mass * fields.velocity[row]).sum()
    };
    let count = (COUNTS[0] * COUNTS[1] * COUNTS[2]) as f64;
    for _ in 0..20 {
        let before = momentum(&bed);
        bed.run(STEPS);
        let gravity = contacts().gravity * (count * mass * STEP * STEPS as f64);
        let left = momentum(&bed) - before - gravity - bed.received.support.unwrap();
        assert!(left.norm() < 1e-12 * gravity.norm(), "{left}");
    }
}
