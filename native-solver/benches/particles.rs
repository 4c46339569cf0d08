//! Particle-steps per CPU-second of the native particles and of Debian's LIGGGHTS: the same settled bed,
//! the same law and step, one core, in one table. `CALCINE_BENCH_LARGE=1` adds a hundred thousand.
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
/// Measurements of each, of which the best counts.
const ROUNDS: usize = 3;
/// Steps before the clock starts: contacts get their history.
const WARM: u64 = 200;

fn main() {
    // Under `cargo test` there is nothing to measure.
    if !std::env::args().any(|word| word == "--bench") {
        return;
    }
    let mut sizes = vec![(10_000usize, 20.0, 2000u64)];
    if std::env::var_os("CALCINE_BENCH_LARGE").is_some() {
        sizes.push((100_000, 44.0, 300));
    }
    println!(
        "| {:>9} | {:<22} | {:>7} | {:>9} | {:>9} | {:>13} | {:>6} |",
        "particles", "solver", "threads", "CPU s", "wall s", "per CPU-s", "ratio"
    );
    println!(
        "|----------:|------------------------|--------:|----------:|----------:|--------------:|-------:|"
    );
    for (count, across, steps) in sizes {
        let width = across * 2.0 * RADIUS;
        let bed = settled(count, width);
        // In turns, and the best of each: other work on the machine slows now the one, now the other.
        let mut best: [Option<Times>; 3] = [None; 3];
        for _ in 0..ROUNDS {
            let threads = rayon::current_num_threads();
            let times = [
                liggghts(&bed, width, steps),
                Some(native(&bed, width, 1, steps)),
                Some(native(&bed, width, threads, steps)),
            ];
            for (best, time) in best.iter_mut().zip(times) {
                *best = faster(*best, time);
            }
        }
        if best[0].is_none() {
            println!("liggghts is not here: nothing to compare with");
        }
        let reference = best[0].or(best[1]).unwrap();
        let solvers = ["LIGGGHTS 3.8", "native", "native"];
        for ((solver, threads), time) in solvers
            .iter()
            .zip([1, 1, rayon::current_num_threads()])
            .zip(best)
        {
            if let Some(time) = time {
                row(count, solver, threads, time, steps, reference);
            }
        }
    }
}

/// The less of each time.
fn faster(best: Option<Times>, time: Option<Times>) -> Option<Times> {
    match (best, time) {
        (Some(best), Some(time)) => Some([best[0].min(time[0]), best[1].min(time[1])]),
        (best, time) => best.or(time),
    }
}

/// CPU and wall time in s.
type Times = [f64; 2];

fn row(count: usize, solver: &str, threads: usize, time: Times, steps: u64, reference: Times) {
    let rate = count as f64 * steps as f64 / time[0];
    println!(
        "| {count:>9} | {solver:<22} | {threads:>7} | {:>9.3} | {:>9.3} | {:>11.2} M | {:>6.2} |",
        time[0],
        time[1],
        rate / 1e6,
        reference[0] / time[0]
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
        fill: Fill::Number(count),
        solid_fraction: 0.58,
        seed: 1,
        size_seed: 1,
    };
    let packing = random_in_box(Vec3::zeros(), [width; 2], &spec).unwrap();
    let spheres: Vec<NewParticle> = packing
        .centres
        .iter()
        .zip(1..)
        .map(|(&centre, id)| sphere(id, centre, Vec3::zeros(), RADIUS))
        .collect();
    let mut bed = Bed::new(rules(width), &spheres);
    bed.run(6000);
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

fn native(bed: &[NewParticle], width: f64, threads: usize, steps: u64) -> Times {
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(threads)
        .build()
        .unwrap();
    pool.install(|| {
        let mut bed = Bed::new(rules(width), bed);
        bed.run(WARM);
        let (cpu, wall) = (used(false), Instant::now());
        bed.run(steps);
        let times = [used(false) - cpu, wall.elapsed().as_secs_f64()];
        let (searches, candidates) = bed.particles.engine().unwrap().effort();
        if std::env::var_os("CALCINE_BENCH_EFFORT").is_some() {
            println!("{searches} searches, {candidates} candidates");
        }
        times
    })
}

/// Time of `steps` steps: of a run with them, less that of a run without. `None` where it is not installed.
fn liggghts(bed: &[NewParticle], width: f64, steps: u64) -> Option<Times> {
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
        fs::write(folder.join("in.bed"), script(width, steps)).unwrap();
        let (cpu, wall) = (used(true), Instant::now());
        let mut command = Command::new("liggghts");
        command.args(["-in", "in.bed", "-log", "log.bed", "-screen", "none"]);
        let status = command
            .current_dir(&folder)
            .stdout(Stdio::null())
            .status()
            .ok()?;
        assert!(status.success(), "see {}", folder.join("log.bed").display());
        Some([used(true) - cpu, wall.elapsed().as_secs_f64()])
    };
    let (none, all) = (run(WARM)?, run(WARM + steps)?);
    Some([all[0] - none[0], all[1] - none[1]])
}

fn script(width: f64, steps: u64) -> String {
    let model = "model hertz tangential history";
    let mut script = format!(
        "units si\natom_style granular\natom_modify map array\ncommunicate single vel yes\n\
         boundary f f f\nnewton off\nprocessors 1 1 1\nread_data bed.data\n\
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
