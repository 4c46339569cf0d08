//! Particle-steps per CPU-second and per second of wall time of the native particles and of Debian's LIGGGHTS: the
//! same settled bed, the same law and step, one and two threads (LIGGGHTS: ranks), in one table, with the memory of
//! each particle. `CALCINE_BENCH_LARGE=1` adds a million; `CALCINE_BENCH_PARTICLES=100000` measures one bed alone.
//!
//! The bed settles once and is kept in Cargo's folder for benchmarks.
#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::print_stdout,
    missing_docs
)]

#[path = "../tests/grains/mod.rs"]
mod grains;

use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::Instant;

use calcine_coupler::motion::{Contacts, NewParticle};
use calcine_coupler::packing::{Fill, RandomSpec, Sizes, random_in_box};
use calcine_coupler::part::Particles;
use calcine_coupler::physics::Vec3;
use grains::*;

/// Radius in m.
const RADIUS: f64 = 2e-3;
/// Time step in s: a tenth of the Rayleigh time.
const STEP: f64 = 2e-5;
/// Skin of LIGGGHTS in m: of 0.1, 0.2, 0.4 and 0.8 mm none is faster than this on a settled bed, by more
/// than the scatter of a tenth.
const SKIN: f64 = 1e-4;
/// Steps of a window, as few as coupled runs have.
const PIECE: u64 = 20;
/// The variable by which a child is told to say what a bed of so many particles of a width holds.
const MEMORY: &str = "CALCINE_BENCH_MEMORY";

/// A bed and how it is measured.
#[derive(Clone, Copy)]
struct Size {
    /// Particles.
    count: usize,
    /// Width of the box in diameters.
    across: f64,
    /// Steps before the clock starts: contacts get their history.
    warm: u64,
    /// Steps that are measured.
    steps: u64,
    /// Measurements of each solver, of which the best counts.
    rounds: usize,
}

/// All beds; the last one on request.
const SIZES: [Size; 3] = [
    Size {
        count: 10_000,
        across: 20.0,
        warm: 200,
        steps: 2000,
        rounds: 3,
    },
    Size {
        count: 100_000,
        across: 44.0,
        warm: 200,
        steps: 200,
        rounds: 3,
    },
    Size {
        count: 1_000_000,
        across: 100.0,
        warm: 60,
        steps: 60,
        rounds: 1,
    },
];

fn main() {
    // Under `cargo test` there is nothing to measure.
    if !std::env::args().any(|word| word == "--bench") {
        return;
    }
    if let Ok(told) = std::env::var(MEMORY) {
        let (count, width) = told.split_once(' ').unwrap();
        println!("{}", held(count.parse().unwrap(), width.parse().unwrap()));
        return;
    }
    let large = std::env::var_os("CALCINE_BENCH_LARGE").is_some();
    let small = std::env::var_os("CALCINE_BENCH_SMALL").is_some();
    let only = std::env::var("CALCINE_BENCH_PARTICLES").ok();
    let only: Option<usize> = only.map(|count| count.parse().unwrap());
    let measured = if small { 1 } else { 2 + usize::from(large) };
    println!(
        "| {:>9} | {:<12} | {:>7} | {:>7} | {:>7} | {:>11} | {:>11} | {:>9} | {:>10} |",
        "particles",
        "solver",
        "threads",
        "CPU s",
        "wall s",
        "per CPU-s",
        "per wall s",
        "ratio",
        "B/particle"
    );
    println!(
        "|----------:|--------------|--------:|--------:|--------:|------------:|------------:|----------:|-----------:|"
    );
    for size in &SIZES[..measured] {
        let count = size.count;
        if only.is_some_and(|only| only != count) {
            continue;
        }
        let width = size.across * 2.0 * RADIUS;
        let bed = settled(count, width);
        let memory = memory_of_child(count, width);
        // In turns, and the best of each: other work on the machine slows now the one, now the other.
        let mut best: [Option<Cost>; 4] = [None; 4];
        for _ in 0..size.rounds {
            let costs = [
                liggghts(&bed, width, 1, size),
                liggghts(&bed, width, 2, size),
                Some(native(&bed, width, 1, size, memory)),
                Some(native(&bed, width, 2, size, memory)),
            ];
            for (best, cost) in best.iter_mut().zip(costs) {
                *best = less(*best, cost);
            }
        }
        if best[0].is_none() {
            println!("liggghts is not here: nothing to compare with");
        }
        let reference = best[0].or(best[2]).unwrap();
        let solvers = ["LIGGGHTS 3.8", "LIGGGHTS 3.8", "native", "native"];
        for ((solver, threads), cost) in solvers.iter().zip([1, 2, 1, 2]).zip(best) {
            if let Some(cost) = cost {
                row(size, solver, threads, cost, reference);
            }
        }
    }
}

/// CPU and wall time in s, and memory in bytes.
type Cost = [f64; 3];

/// The less of each.
fn less(best: Option<Cost>, cost: Option<Cost>) -> Option<Cost> {
    match (best, cost) {
        (Some(best), Some(cost)) => Some([0, 1, 2].map(|k| f64::min(best[k], cost[k]))),
        (best, cost) => best.or(cost),
    }
}

/// The ratio is of CPU times, to one rank of LIGGGHTS.
fn row(size: &Size, solver: &str, threads: usize, cost: Cost, reference: Cost) {
    let count = size.count;
    let done = count as f64 * size.steps as f64 / 1e6;
    println!(
        "| {count:>9} | {solver:<12} | {threads:>7} | {:>7.3} | {:>7.3} | {:>9.2} M | {:>9.2} M | {:>9.2} | {:>10.0} |",
        cost[0],
        cost[1],
        done / cost[0],
        done / cost[1],
        reference[0] / cost[0],
        cost[2] / count as f64
    );
}

/// An open box, and soft glass.
fn rules(width: f64) -> Contacts {
    let mut contacts = contacts(STEP);
    contacts.gravity = Vec3::z() * -9.81;
    contacts.walls = cuboid(Vec3::zeros(), Vec3::new(width, width, 1.0));
    contacts.walls.truncate(5);
    contacts.walls.remove(2);
    contacts.walls.push(plane(Vec3::zeros(), Vec3::z()));
    contacts
}

/// A bed at rest in a box of this width, from the folder of benchmarks if it was settled before.
fn settled(count: usize, width: f64) -> Vec<NewParticle> {
    let kept = folder().join(format!("bed-{count}.txt"));
    if let Ok(text) = fs::read_to_string(&kept) {
        let row = |(id, line): (usize, &str)| {
            let v: Vec<f64> = line.split(' ').map(|word| word.parse().unwrap()).collect();
            let velocity = Vec3::new(v[3], v[4], v[5]);
            sphere(id as u64 + 1, Vec3::new(v[0], v[1], v[2]), velocity, RADIUS)
        };
        return text.lines().enumerate().map(row).collect();
    }
    let spec = RandomSpec {
        sizes: Sizes::Equal(2.0 * RADIUS),
        fill: Fill::Number {
            number: count,
            solid_fraction: 0.58,
        },
        seed: 1,
        size_seed: 1,
        periodicity: Default::default(),
    };
    let packing = random_in_box(Vec3::zeros(), [width; 2], &spec).unwrap();
    let spheres: Vec<NewParticle> = packing
        .centres
        .iter()
        .zip(1..)
        .map(|(&centre, id)| sphere(id, centre, Vec3::zeros(), RADIUS))
        .collect();
    let mut bed = Bed::new(rules(width), &spheres);
    // A million would take a quarter of an hour; after a sixth of that they have not come to rest, and touch fewer.
    bed.run(if count > 200_000 { 1000 } else { 6000 });
    let fields = bed.particles.fields();
    let mut text = String::new();
    let mut rest = Vec::new();
    for (row, (place, velocity)) in fields.position.iter().zip(fields.velocity).enumerate() {
        let [p, v] = [place, velocity];
        writeln!(text, "{} {} {} {} {} {}", p.x, p.y, p.z, v.x, v.y, v.z).unwrap();
        rest.push(sphere(row as u64 + 1, *place, *velocity, RADIUS));
    }
    fs::write(kept, text).unwrap();
    rest
}

fn native(bed: &[NewParticle], width: f64, threads: usize, size: &Size, memory: f64) -> Cost {
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(threads)
        .build()
        .unwrap();
    pool.install(|| {
        let mut bed = Bed::new(rules(width), bed);
        bed.run(size.warm);
        let (cpu, wall) = (used(false), Instant::now());
        let mut least = f64::INFINITY;
        for _ in 0..size.steps / PIECE {
            let begun = Instant::now();
            bed.run(PIECE);
            least = least.min(begun.elapsed().as_secs_f64());
        }
        let cost = [used(false) - cpu, wall.elapsed().as_secs_f64(), memory];
        let (searches, candidates) = bed.particles.engine().unwrap().effort();
        if std::env::var_os("CALCINE_BENCH_EFFORT").is_some() {
            let step = 1e6 * least / PIECE as f64;
            println!(
                "{threads}: {searches} searches, {candidates} candidates, best {step:.1} us a step"
            );
        }
        cost
    })
}

/// Time of `steps` steps: of a run with them, less that of a run without. `None` where it is not installed.
fn liggghts(bed: &[NewParticle], width: f64, ranks: usize, size: &Size) -> Option<Cost> {
    let folder = folder();
    let mut data = format!(
        "settled bed\n\n{} atoms\n1 atom types\n0 {width} xlo xhi\n0 {width} ylo yhi\n-0.001 1 zlo zhi\n\nAtoms\n\n",
        bed.len()
    );
    for one in bed {
        let p = one.position;
        writeln!(
            data,
            "{} 1 {} 2500 {} {} {}",
            one.id,
            2.0 * RADIUS,
            p.x,
            p.y,
            p.z
        )
        .unwrap();
    }
    data.push_str("\nVelocities\n\n");
    for one in bed {
        let v = one.velocity;
        writeln!(data, "{} {} {} {} 0 0 0", one.id, v.x, v.y, v.z).unwrap();
    }
    fs::write(folder.join("bed.data"), data).unwrap();
    let run = |steps: u64| {
        fs::write(folder.join("in.bed"), script(width, ranks, steps)).unwrap();
        let (cpu, wall) = (used(true), Instant::now());
        let mut command = Command::new(if ranks == 1 { "liggghts" } else { "mpirun" });
        if ranks > 1 {
            // Containers run as root, and may count fewer cores than there are.
            command.args(["--allow-run-as-root", "--oversubscribe", "-np"]);
            command.args([&ranks.to_string(), "liggghts"]);
        }
        command.args(["-in", "in.bed", "-log", "log.bed", "-screen", "none"]);
        let status = command
            .current_dir(&folder)
            .stdout(Stdio::null())
            .status()
            .ok()?;
        assert!(status.success(), "see {}", folder.join("log.bed").display());
        Some([used(true) - cpu, wall.elapsed().as_secs_f64()])
    };
    let (none, all) = (run(size.warm)?, run(size.warm + size.steps)?);
    Some([
        all[0] - none[0],
        all[1] - none[1],
        memory(&folder) * ranks as f64,
    ])
}

/// Memory in bytes of each rank, as LIGGGHTS tells it in its log.
fn memory(folder: &Path) -> f64 {
    let log = fs::read_to_string(folder.join("log.bed")).unwrap_or_default();
    let told = log.split("Memory usage per processor = ").nth(1);
    let number = told.and_then(|text| text.split(' ').next()?.parse().ok());
    number.unwrap_or(f64::NAN) * 1e6
}

/// Memory in bytes that a process of its own needs more for a bed, so that nothing freed before is used again.
fn memory_of_child(count: usize, width: f64) -> f64 {
    let mut child = Command::new(std::env::current_exe().unwrap());
    child.arg("--bench").env(MEMORY, format!("{count} {width}"));
    let told = String::from_utf8(child.output().unwrap().stdout).unwrap();
    told.trim().parse().unwrap()
}

/// What a settled bed adds to this process.
fn held(count: usize, width: f64) -> f64 {
    let bed = settled(count, width);
    let free = resident();
    let mut bed = Bed::new(rules(width), &bed);
    bed.run(10);
    resident() - free
}

/// Memory in bytes that this process holds.
fn resident() -> f64 {
    let text = fs::read_to_string("/proc/self/statm").unwrap();
    let pages: f64 = text.split(' ').nth(1).unwrap().parse().unwrap();
    pages * 4096.0
}

fn script(width: f64, ranks: usize, steps: u64) -> String {
    let model = "model hertz tangential history";
    let mut script = format!(
        "units si\natom_style granular\natom_modify map array\ncommunicate single vel yes\n\
         boundary f f f\nnewton off\nprocessors {ranks} 1 1\nread_data bed.data\n\
         neighbor {SKIN} bin\nneigh_modify delay 0\n\
         fix m1 all property/global youngsModulus peratomtype 1e7\n\
         fix m2 all property/global poissonsRatio peratomtype 0.25\n\
         fix m3 all property/global coefficientRestitution peratomtypepair 1 0.5\n\
         fix m4 all property/global coefficientFriction peratomtypepair 1 0.3\n\
         pair_style gran {model}\npair_coeff * *\ntimestep {STEP}\n\
         fix gravity all gravity 9.81 vector 0.0 0.0 -1.0\n"
    );
    for (name, axis, at) in [
        ("w1", "xplane", 0.0),
        ("w2", "xplane", width),
        ("w3", "yplane", 0.0),
        ("w4", "yplane", width),
        ("w5", "zplane", 0.0),
    ] {
        writeln!(
            script,
            "fix {name} all wall/gran {model} primitive type 1 {axis} {at}"
        )
        .unwrap();
    }
    writeln!(
        script,
        "fix move all nve/sphere\nthermo 100000\nthermo_modify lost error norm no\nrun {steps}"
    )
    .unwrap();
    script
}

/// CPU time in s of this process, or of its children that have ended, in clock ticks of 10 ms.
fn used(children: bool) -> f64 {
    let text = fs::read_to_string("/proc/self/stat").unwrap();
    let after = text.rsplit_once(')').unwrap().1;
    let fields: Vec<&str> = after.split_whitespace().collect();
    // utime, stime, cutime, cstime are fields 14 to 17 of proc(5); the third is the first after the name.
    let first = if children { 13 } else { 11 };
    let ticks: f64 = fields[first..first + 2]
        .iter()
        .map(|word| word.parse::<f64>().unwrap())
        .sum();
    ticks / 100.0
}

fn folder() -> PathBuf {
    Path::new(env!("CARGO_TARGET_TMPDIR")).to_owned()
}
