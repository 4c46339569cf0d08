//! Cost of native parcels by what moves them: processor time of a parcel and a window on one thread, wall time on two, and memory. A bed that
//! has fallen together in a box, five parcels to a full cell, 1.2 parcels to a cell of the mesh. What each part takes is the difference
//! to the row before. `CALCINE_BENCH_LARGE=1` adds 150 000 and 450 000 parcels.
#![allow(clippy::unwrap_used, clippy::print_stdout, missing_docs)]

#[path = "../tests/common/mod.rs"]
mod common;
#[path = "../tests/grains/mod.rs"]
mod grains;
#[path = "../tests/parcel_beds.rs"]
mod parcel_beds;

use std::fs;
use std::process::Command;
use std::time::Instant;

use calcine_coupler::parcels::{ParcelFriction, ParcelMotion, ParcelPacking};
use calcine_coupler::part::{DRAG_COEFFICIENT, GAS_VELOCITY, ParticlePush, Particles};
use calcine_coupler::physics::parcels::HarrisCrighton;
use calcine_coupler::physics::{Vec3, sphere};
use common::named_box;
use parcel_beds::{ParcelBed, motion, setup};

/// Parcels of the beds; the last two on request.
const COUNTS: [usize; 4] = [5_000, 50_000, 150_000, 450_000];
/// Parcels to a cell of the mesh.
const OF_A_CELL: f64 = 1.2;
/// Edge of a cell in m.
const CELL: f64 = 5e-3;
/// Share of the mesh's height that the bed has.
const FILLED: f64 = 0.4;
const RADIUS: f64 = 0.5e-3;
/// Of a window in s.
const WINDOW: f64 = 2e-3;
/// Windows before the clock starts, in a round, and rounds of which the best counts.
const WARM: usize = 60;
const MEASURED: usize = 5;
const ROUNDS: usize = 3;
/// The variable by which a child is told to say what a bed of so many parcels holds.
const MEMORY: &str = "CALCINE_BENCH_MEMORY";
/// What a row adds to the one before.
const PARTS: [&str; 5] = [
    "flight with drag",
    "damping",
    "implicit stress",
    "friction",
    "isotropy",
];

fn main() {
    // Under `cargo test` there is nothing to measure.
    if !std::env::args().any(|word| word == "--bench") {
        return;
    }
    if let Ok(count) = std::env::var(MEMORY) {
        println!("{}", held(count.parse().unwrap()));
        return;
    }
    let large = std::env::var_os("CALCINE_BENCH_LARGE").is_some();
    println!("| parcels | cells | part | ns a parcel, one thread | two threads | B a parcel |");
    println!("|--------:|------:|------|------------------------:|------------:|-----------:|");
    for count in &COUNTS[..if large { 4 } else { 2 }] {
        let settled = settled(*count);
        let memory = memory_of_child(*count);
        let mut before = [0.0; 2];
        for (parts, name) in PARTS.iter().enumerate() {
            let whole = [1, 2].map(|threads| each(&settled, parts, threads));
            let own = [whole[0] - before[0], whole[1] - before[1]];
            row(&settled, (name, own), None);
            before = whole;
        }
        row(&settled, ("all", before), Some(memory / *count as f64));
    }
}

fn row(bed: &Settled, (name, [one, two]): (&str, [f64; 2]), memory: Option<f64>) {
    let count = bed.places.len();
    let memory = memory.map_or(String::new(), |memory| format!("{memory:.0}"));
    println!(
        "| {count} | {} | {name} | {:.0} | {:.0} | {memory} |",
        bed.cells.iter().product::<usize>(),
        1e9 * one,
        1e9 * two
    );
}

/// A bed at rest.
struct Settled {
    cells: [usize; 3],
    weight: f64,
    places: Vec<(Vec3, Vec3)>,
}

/// Cells along each axis of the mesh of so many parcels.
fn cells(count: usize) -> [usize; 3] {
    let across = (count as f64 / OF_A_CELL / 2.0).cbrt().round() as usize;
    [across, across, 2 * across]
}

/// Rules with so many of the parts.
fn rules(mesh: &calcine_coupler::mesh::Mesh, parts: usize) -> ParcelMotion {
    let mut rules = motion(mesh, 0.5, 0.3);
    rules.gravity = Vec3::z() * -9.81;
    rules.collisions.times.restitution = 0.8;
    rules.collisions.damping = parts >= 1;
    if parts >= 2 {
        rules.packing = ParcelPacking::Implicit(HarrisCrighton {
            pressure: 10.0,
            exponent: 2.0,
            floor: 1e-7,
            close_packing: 0.6,
        });
    }
    if parts >= 3 {
        rules.friction = Some(ParcelFriction {
            bed: 0.4,
            slip: 1e-4,
        });
    }
    rules.collisions.isotropy = parts >= 4;
    rules
}

/// What the gas gives in a window: drag of a tenth of a second towards a gas at rest.
fn push(bed: &ParcelBed) -> ParticlePush {
    let fields = bed.parcels.fields();
    let count = fields.len();
    let mut push = ParticlePush {
        force: vec![Vec3::zeros(); count],
        ..ParticlePush::default()
    };
    let coefficient = fields.mass.iter().map(|mass| 10.0 * mass).collect();
    push.columns.set(DRAG_COEFFICIENT, 1, coefficient);
    push.columns.set(GAS_VELOCITY, 3, vec![0.0; 3 * count]);
    push
}

/// A bed of so many parcels that has fallen together.
fn settled(count: usize) -> Settled {
    let cells = cells(count);
    let size = cells.map(|cells| cells as f64 * CELL);
    let mesh = named_box(size, cells, common_sides());
    let mut next = grains::scatter(5);
    let room = Vec3::new(size[0], size[1], FILLED * size[2]);
    let places: Vec<(Vec3, Vec3)> = (0..count)
        .map(|_| {
            let share = Vec3::new(next(), next(), next());
            (room.component_mul(&share), Vec3::zeros())
        })
        .collect();
    let weight = 0.45 * room.product() / (count as f64 * sphere::volume(RADIUS));
    let setup = setup(rules(&mesh, 2), &places, RADIUS, weight);
    let mut bed = ParcelBed::new(&mesh, &setup);
    for _ in 0..WARM {
        let push = push(&bed);
        bed.window(WINDOW, &push);
    }
    let fields = bed.parcels.fields();
    let places = fields.position.iter().zip(fields.velocity);
    Settled {
        cells,
        weight,
        places: places
            .map(|(place, velocity)| (*place, *velocity))
            .collect(),
    }
}

fn common_sides() -> [&'static str; 6] {
    ["west", "east", "south", "north", "bottom", "top"]
}

fn bed(settled: &Settled, parts: usize) -> ParcelBed {
    let size = settled.cells.map(|cells| cells as f64 * CELL);
    let mesh = named_box(size, settled.cells, common_sides());
    let setup = setup(rules(&mesh, parts), &settled.places, RADIUS, settled.weight);
    ParcelBed::new(&mesh, &setup)
}

/// Wall time in s of a parcel and a window with so many of the parts on so many threads, the least of some rounds.
fn each(settled: &Settled, parts: usize, threads: usize) -> f64 {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
    pool.unwrap().install(|| {
        let mut least = f64::INFINITY;
        for _ in 0..ROUNDS {
            let mut bed = bed(settled, parts);
            let push = push(&bed);
            bed.window(WINDOW, &push);
            let begun = Instant::now();
            for _ in 0..MEASURED {
                bed.window(WINDOW, &push);
            }
            least = least.min(begun.elapsed().as_secs_f64());
        }
        least / (MEASURED * settled.places.len()) as f64
    })
}

/// Memory in bytes that a process of its own needs more for a bed, so that nothing freed before is used again.
fn memory_of_child(count: usize) -> f64 {
    let mut child = Command::new(std::env::current_exe().unwrap());
    child.arg("--bench").env(MEMORY, count.to_string());
    let told = String::from_utf8(child.output().unwrap().stdout).unwrap();
    told.trim().parse().unwrap()
}

/// What a bed and its mesh add to this process at most, in bytes.
fn held(count: usize) -> f64 {
    let cells = cells(count);
    let size = cells.map(|cells| cells as f64 * CELL);
    let mut next = grains::scatter(5);
    let places = (0..count).map(|_| {
        let share = Vec3::new(next(), next(), FILLED * next());
        (Vec3::from(size).component_mul(&share), Vec3::zeros())
    });
    let room = FILLED * size.iter().product::<f64>();
    let settled = Settled {
        cells,
        weight: 0.45 * room / (count as f64 * sphere::volume(RADIUS)),
        places: places.collect(),
    };
    let before = peak();
    let mut bed = bed(&settled, PARTS.len());
    let push = push(&bed);
    bed.window(WINDOW, &push);
    peak() - before
}

/// The most memory in bytes that this process held.
fn peak() -> f64 {
    let text = fs::read_to_string("/proc/self/status").unwrap();
    let line = text.lines().find(|line| line.starts_with("VmHWM:"));
    let kilobytes = line.and_then(|line| line.split_whitespace().nth(1)?.parse::<f64>().ok());
    1024.0 * kilobytes.unwrap()
}
