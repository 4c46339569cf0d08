//! Rows that stand for several particles: a held bed of particles of weight w gives the gas what w particles in the
//! place give it; the ledger closes, runs resume to the same bits, and LIGGGHTS and particles in C
//! carry the weights too.

#![cfg(feature = "hdf5")]
#![allow(clippy::unwrap_used, clippy::print_stdout)]

use std::fmt::Write;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use calcine::results::Summary;
use calcine::results::read::{Arrays, Series, arrays, collection};

use crate::support::{c_solver, killed, program};

/// A file of centres in a grid from half a pitch on, `times` beside each other about each place, a diameter and a bit
/// apart: in one cell of the mesh.
fn grid(
    path: &Path,
    counts: [usize; 3],
    [pitch, apart]: [f64; 2],
    above: f64,
    times: usize,
) -> String {
    let mut text = String::from("x,y,z\n");
    let place = |k: usize| (k as f64 + 0.5) * pitch;
    for z in 0..counts[2] {
        for y in 0..counts[1] {
            for x in 0..counts[0] {
                for k in 0..times {
                    let beside = (k as f64 - 0.5 * (times as f64 - 1.0)) * apart;
                    let [x, y, z] = [beside + place(x), place(y), above + place(z)];
                    let _ = writeln!(text, "{x},{y},{z}");
                }
            }
        }
    }
    fs::write(path, text).unwrap();
    format!("particles[0].place={{ file = \"{}\" }}", path.display())
}

/// The last snapshot of the gas or the particles.
fn last(out: &Path, name: &str) -> Arrays {
    let files = collection(out, name).unwrap();
    arrays(&files.last().unwrap().1).unwrap()
}

/// The largest difference of a field of the gas between two runs, over its largest magnitude.
fn off(one: &Path, other: &Path, field: &str) -> f64 {
    let [one, other] = [one, other].map(|out| last(out, "gas.pvd")[field].values.clone());
    let most = one.iter().fold(0.0, |most: f64, x| most.max(x.abs()));
    let pairs = one.iter().zip(&other);
    let apart = pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    apart / most
}

fn closes(out: &Path) -> Summary {
    let summary = Summary::read(out).unwrap();
    for (name, line) in &summary.ledger.lines {
        println!("{}: {name} {:.1e}", out.display(), line.relative_error);
    }
    for name in ["mass", "energy", "energy_exchange", "momentum"] {
        let error = summary.ledger.lines[name].relative_error;
        assert!(error < 1e-11, "{name}: {error}");
    }
    for (element, line) in &summary.ledger.elements {
        let error = line.relative_error;
        assert!(error < 1e-11, "{element}: {error}");
    }
    summary
}

/// Two rows beside each other at each place, and one of weight 2; each with the same keys set.
fn pair(
    folder: &Path,
    case: &str,
    grid: impl Fn(&Path, usize) -> String,
    set: &[&str],
) -> [PathBuf; 2] {
    let run = |name: &str, times: usize, weight: &str| {
        let place = grid(&folder.join(format!("{name}.csv")), times);
        let mut keys = vec![place.as_str(), weight];
        keys.extend(set);
        let out = folder.join(name);
        program::run(&program::shipped(case), &out, &[], &keys);
        closes(&out);
        out
    };
    [
        run("two", 2, "particles[0].weight=1"),
        run("one", 1, "particles[0].weight=2"),
    ]
}

const COLUMN: [&str; 5] = [
    "particles[0].diameter=4 mm",
    "time.end=20 s",
    "output.every=10 s",
    "quantities[1].measure.number=1",
    "time.checkpoint.every=2 s",
];

fn column(path: &Path, times: usize) -> String {
    grid(path, [1, 1, 10], [0.01, 0.0045], 0.0, times)
}

#[test]
fn two_particles_in_a_cell_are_one_of_weight_two() {
    let folder = tempfile::tempdir().unwrap();
    let [two, one] = pair(folder.path(), "heated-column", column, &COLUMN);
    for field in ["temperature", "velocity", "pressure", "void_fraction"] {
        let off = off(&two, &one, field);
        println!("{field}: {off:.1e}");
        // Sums in another order, in 400 windows.
        assert!(off < 1e-11, "{field}: {off}");
    }
    let mean = |out: &Path| {
        Series::read(out)
            .unwrap()
            .column("quantities.mean_temperature")
            .to_vec()
    };
    let [ours, other] = [&one, &two].map(|out| mean(out));
    for (a, b) in ours.iter().zip(&other) {
        assert!((a / b - 1.0).abs() < 1e-11, "{a} {b}");
    }
    assert!(ours.last().unwrap() > &310.0);
    assert_eq!(last(&one, "particles.pvd")["weight"].values, [2.0; 10]);
    assert!(!last(&two, "particles.pvd").contains_key("weight"));
}

#[test]
fn so_are_two_that_react() {
    let folder = tempfile::tempdir().unwrap();
    let set = [
        "particles[0].diameter=9 mm",
        "time.end=400 s",
        "output.every=400 s",
        "output.series_every=20 s",
    ];
    let stones = |path: &Path, times| grid(path, [5, 5, 7], [0.02, 0.0095], 0.02, times);
    let [two, one] = pair(folder.path(), "lime-burning", stones, &set);
    for field in ["temperature", "velocity", "void_fraction"] {
        let off = off(&two, &one, field);
        println!("{field}: {off:.1e}");
        assert!(off < 1e-9, "{field}: {off}");
    }
    let lime = |out: &Path| {
        Summary::read(out).unwrap().quantities["lime"]
            .value
            .unwrap()
    };
    let (ours, other) = (lime(&one), lime(&two));
    assert!(
        ours > 1e-3 && (ours / other - 1.0).abs() < 1e-9,
        "{ours} {other}"
    );
}

#[test]
fn and_two_that_dry() {
    let folder = tempfile::tempdir().unwrap();
    let set = [
        "particles[0].diameter=1.8 mm",
        "time.end=2 min",
        "output.every=2 min",
        "output.series_every=20 s",
    ];
    let chips = |path: &Path, times| grid(path, [6, 6, 12], [0.004, 0.0019], 0.008, times);
    let [two, one] = pair(folder.path(), "wood-drying", chips, &set);
    for field in ["temperature", "void_fraction", "H2O"] {
        let off = off(&two, &one, field);
        println!("{field}: {off:.1e}");
        assert!(off < 1e-10, "{field}: {off}");
    }
    let masses = [&one, &two].map(|out| last(out, "particles.pvd")["mass"].values.clone());
    for (a, b) in masses[0].iter().zip(masses[1].iter().step_by(2)) {
        assert!((a / b - 1.0).abs() < 1e-12, "{a} {b}");
    }
}

#[test]
fn a_bed_with_weights_resumes_to_the_same_bits() {
    let program = c_solver::particles().display();
    let external = [
        format!("external.particles.program={program}"),
        "external.particles.arguments=[\"width=1\", \"depth=1\", \"height=1\"]".into(),
    ];
    for particles in ["native", "liggghts", "external"] {
        let folder = tempfile::tempdir().unwrap();
        let place = column(&folder.path().join("bed.csv"), 1);
        let command = |out: &Path| -> Command {
            let mut keys = vec![place.as_str(), "particles[0].weight=1.7"];
            keys.extend(COLUMN);
            keys.extend(external.iter().map(String::as_str));
            let words = ["--particles", particles];
            program::command(&program::shipped("heated-column"), out, &words, &keys)
        };
        let whole = killed::resumes_to_the_same_bits(folder.path(), &[8], command);
        closes(&whole);
        assert_eq!(last(&whole, "particles.pvd")["weight"].values, [1.7; 10]);
    }
}

#[test]
fn a_snapshot_brings_its_weights() {
    let folder = tempfile::tempdir().unwrap();
    let place = column(&folder.path().join("bed.csv"), 1);
    let mut keys = vec![place.as_str(), "particles[0].weight=1.7"];
    keys.extend(COLUMN);
    let [first, second] = ["first", "second"].map(|name| folder.path().join(name));
    let case = program::shipped("heated-column");
    program::run(&case, &first, &[], &keys);
    let snapshot = collection(&first, "particles.pvd")
        .unwrap()
        .pop()
        .unwrap()
        .1;
    let place = format!("particles[0].place={{ file = \"{}\" }}", snapshot.display());
    program::run(
        &case,
        &second,
        &[],
        &[&[place.as_str()], &COLUMN[..]].concat(),
    );
    closes(&second);
    assert_eq!(last(&second, "particles.pvd")["weight"].values, [1.7; 10]);
    // Of those of a population of its own.
    let none = place.replace(" }", ", type = 1 }");
    let refused = program::command(&case, &second, &[], &[&none])
        .output()
        .unwrap();
    let told = String::from_utf8_lossy(&refused.stderr).into_owned();
    assert!(told.contains("no particle of type 1"), "{told}");
    // What is free stands for itself.
    let refused = program::command(
        &program::shipped("settling-sphere"),
        &second,
        &[],
        &[&place],
    )
    .output()
    .unwrap();
    let told = String::from_utf8_lossy(&refused.stderr).into_owned();
    let told = told.split_whitespace().collect::<Vec<_>>().join(" ");
    assert!(
        told.contains("the weight is 1.7, but the particles are free"),
        "{told}"
    );
}

#[test]
fn weights_go_with_their_particles_to_two_ranks_and_into_comparisons() {
    let folder = tempfile::tempdir().unwrap();
    let case = program::shipped("lime-burning");
    let place = grid(
        &folder.path().join("bed.csv"),
        [5, 5, 7],
        [0.02, 0.0095],
        0.02,
        1,
    );
    let keys = [
        place.as_str(),
        "particles[0].weight=1.7",
        "particles[0].diameter=9 mm",
        "time.end=40 s",
        "output.every=40 s",
        "output.series_every=20 s",
    ];
    // Side by side along x, so that each rank has some of the 175.
    let words = ["--particles", "liggghts", "--ranks-particles", "2"];
    let [native, ranks] = [("native", &[][..]), ("ranks", &words[..])].map(|(name, words)| {
        let out = folder.path().join(name);
        program::run(&case, &out, words, &keys);
        closes(&out);
        assert_eq!(last(&out, "particles.pvd")["weight"].values, [1.7; 175]);
        out
    });
    for field in ["temperature", "velocity", "void_fraction"] {
        // A held bed: LIGGGHTS has no part in what the gas does but for its columns.
        assert!(off(&native, &ranks, field) < 1e-12, "{field}");
    }
    let out = folder.path().join("compared");
    program::compare(&case, &out, "native+native,native+liggghts", &keys);
}

#[test]
fn a_run_continues_only_with_the_same_weights() {
    let folder = tempfile::tempdir().unwrap();
    let place = column(&folder.path().join("bed.csv"), 1);
    let mut keys = vec![place.as_str(), "particles[0].weight=1.5"];
    keys.extend(COLUMN);
    let (case, first) = (
        program::shipped("heated-column"),
        folder.path().join("first"),
    );
    program::run(&case, &first, &[], &keys);
    let origin = first.display().to_string();
    let more = |weight: &str, end: &str| {
        let mut keys = vec![place.as_str(), weight];
        keys.extend(COLUMN);
        keys.push(end);
        let out = folder.path().join(weight);
        let words = ["--from", &origin];
        program::command(&case, &out, &words, &keys)
            .output()
            .unwrap()
    };
    let same = more("particles[0].weight=1.5", "time.end=4 s");
    assert!(same.status.success(), "{same:?}");
    let other = more("particles[0].weight=3", "time.end=4 s");
    let told = String::from_utf8_lossy(&other.stderr).into_owned();
    let told = told.split_whitespace().collect::<Vec<_>>().join(" ");
    assert!(!other.status.success());
    assert!(
        told.contains("stands for 1.5") && told.contains("in this case for 3"),
        "{told}"
    );
}

#[test]
fn weights_that_mean_nothing_or_do_not_go_with_the_case_are_refused() {
    let refused = |case: &str, set: &[&str]| {
        let folder = tempfile::tempdir().unwrap();
        let out = folder.path().join("out");
        let output = program::command(&program::shipped(case), &out, &[], set)
            .output()
            .unwrap();
        assert!(!output.status.success(), "{set:?}");
        let told = String::from_utf8_lossy(&output.stderr).into_owned();
        told.split_whitespace().collect::<Vec<_>>().join(" ")
    };
    for weight in ["0", "-2", "inf", "nan"] {
        let told = refused("heated-column", &[&format!("particles[0].weight={weight}")]);
        assert!(told.contains("particles[0].weight"), "{told}");
    }
    let told = refused("settling-sphere", &["particles[0].weight=2"]);
    assert!(told.contains("the particles are free"), "{told}");
    let told = refused("iron-stack", &["particles[0].weight=2"]);
    assert!(told.contains("exchanges heat between particles"), "{told}");
}
