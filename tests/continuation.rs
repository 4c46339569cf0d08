//! `--from DIR`: a changed case continues from another run's results, without a rebuild of
//! anything, and says in its results what it came from.

#![allow(clippy::unwrap_used)]

use std::path::Path;
use std::process::{Command, Output};

use calcine::assembly::ParticleBackend;
use calcine::results::Summary;
use calcine::results::read::Series;
use calcine::simulation::Simulation;

fn run(case: &Path, out: &Path, more: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_calcine"))
        .arg("run")
        .arg(case)
        .args(["--quiet", "--out"])
        .arg(out)
        .args(more)
        .output()
        .unwrap()
}

fn column() -> std::path::PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("cases/heated-column.toml")
}

fn done(output: &Output) {
    let text = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{text}");
}

#[test]
fn a_run_in_two_parts_is_the_run_in_one_and_says_what_it_continued_from() {
    two_parts("native", "native", 1e-4);
}

#[test]
fn so_is_one_with_an_openfoam_gas() {
    two_parts("openfoam", "openfoam", 1e-4);
}

/// The two gases agree within a tenth of a kelvin on this column.
#[test]
fn either_gas_goes_on_from_the_other() {
    two_parts("native", "openfoam", 0.1);
    two_parts("openfoam", "native", 0.1);
}

/// A run of 60 s by one gas, and its second half again from its middle, by the same or by the other gas.
fn two_parts(gas: &str, other: &str, within: f64) {
    let directory = tempfile::tempdir().unwrap();
    let folder = |name: &str| directory.path().join(name);
    let (whole, first, second) = (folder("whole"), folder("first"), folder("second"));
    done(&run(
        &column(),
        &whole,
        &["--gas", gas, "--set", "time.end=60 s"],
    ));
    done(&run(
        &column(),
        &first,
        &["--gas", gas, "--set", "time.end=30 s"],
    ));
    // `time.end` is another case; the end of the first is the start of the second.
    let from = [
        "--gas",
        other,
        "--set",
        "time.end=30.0000 s",
        "--from",
        first.to_str().unwrap(),
    ];
    done(&run(&column(), &second, &from));
    let (whole, parts) = (
        Series::read(&whole).unwrap(),
        Series::read(&second).unwrap(),
    );
    let at = |series: &Series, time: f64, column: &str| {
        let times = series.column("process_time");
        let row = times.iter().position(|t| (t - time).abs() < 1e-9).unwrap();
        series.column(column)[row]
    };
    assert_eq!(at(&parts, 0.0, "process_time"), 0.0);
    for column in [
        "particles.temperature_min",
        "gas.temperature_max",
        "particles.temperature_mean",
    ] {
        for time in [0.0, 10.0, 30.0] {
            let (one, two) = (at(&whole, 30.0 + time, column), at(&parts, time, column));
            // The gas' mass is made anew from its temperature: 1e-6 of the span of 100 K.
            let within = if time == 0.0 { 1e-4 } else { within };
            assert!(
                (one - two).abs() < within,
                "{column} at {time} s: {one} {two}"
            );
        }
    }
    let (before, after) = (
        Summary::read(&first).unwrap(),
        Summary::read(&second).unwrap(),
    );
    let from = after.from.unwrap();
    assert_eq!(from.path, first);
    assert_eq!(from.hash, before.case.hash);
    assert_ne!(from.hash, after.case.hash);
    assert_eq!((from.process_time_s, from.windows), (30.0, before.windows));
    assert!(after.ledger.lines["energy"].relative_error < 1e-10);
    assert!(after.ledger.lines["mass"].relative_error < 1e-10);
    let page = std::fs::read_to_string(second.join("report.html")).unwrap();
    assert!(page.contains("continued from") && page.contains(first.to_str().unwrap()));
}

/// Beads that burn have shrunk, and some are gone.
#[test]
fn a_run_goes_on_from_particles_that_have_changed_their_size_or_are_gone() {
    let case = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/inputs/good/burning-beads.toml");
    let directory = tempfile::tempdir().unwrap();
    let text = std::fs::read_to_string(&case).unwrap();
    let (large, _) = text.split_once("[[reactions]]").unwrap();
    let (_, large) = large.split_once("[[particles]]").unwrap();
    let small = large
        .replace("\"beads\"", "\"dust\"")
        .replace("\"1 mm\"", "\"0.4 mm\"")
        .replace("5 5 25 mm", "5 5 45 mm");
    let text = text.replace(
        "[[reactions]]",
        &format!("[[particles]]{small}[[reactions]]"),
    );
    let case = directory.path().join("beads.toml");
    std::fs::write(&case, text).unwrap();
    let folder = |name: &str| directory.path().join(name);
    let (whole, first, second) = (folder("whole"), folder("first"), folder("second"));
    let end = |time: &'static str| ["--set", time, "--set", "time.process_step=0.25 s"];
    done(&run(&case, &whole, &end("time.end=4 s")));
    done(&run(&case, &first, &end("time.end=2 s")));
    let mut from = end("time.end=2.000 s").to_vec();
    from.extend(["--from", first.to_str().unwrap()]);
    done(&run(&case, &second, &from));
    let [whole, first, second] = [whole, first, second].map(|out| Summary::read(&out).unwrap());
    let gone = |summary: &Summary| summary.passed.used_up.rows;
    assert_eq!([gone(&whole), gone(&first), gone(&second)], [4, 4, 0]);
    let mass = |summary: &Summary| summary.quantities["mass"].value.unwrap();
    let ratio = mass(&second) / mass(&whole);
    // The laws of a first window are evaluated on its own gas, those of others on the gas before: 3e-4 here.
    assert!(
        mass(&whole) < 0.9 * mass(&first) && (ratio - 1.0).abs() < 1e-3,
        "{ratio}"
    );
    for line in ["mass", "energy"] {
        assert!(second.ledger.lines[line].relative_error < 1e-10);
    }
}

/// Stones that are fed, sink, react and are drawn off: the second half, by either solver of the particles, goes on with all that
/// the first half left, though the case places others at its start.
#[test]
fn a_bed_that_moves_goes_on_with_all_that_another_run_left() {
    let case =
        Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/inputs/good/moving-reactions.toml");
    let directory = tempfile::tempdir().unwrap();
    let folder = |name: &str| directory.path().join(name);
    let (whole, first) = (folder("whole"), folder("first"));
    done(&run(&case, &whole, &[]));
    done(&run(&case, &first, &["--set", "time.end=80 s"]));
    let from = ["--from", first.to_str().unwrap(), "--set"];
    let states = |out: &Path| (Summary::read(out).unwrap(), Series::read(out).unwrap());
    let (whole, first) = (states(&whole), states(&first));
    let value = |one: &(Summary, Series), name: &str| one.0.quantities[name].value.unwrap();
    for solver in ["native", "liggghts"] {
        let out = folder(solver);
        let with = ["time.end=80.000 s", "--particles", solver];
        done(&run(&case, &out, &[&from[..], &with].concat()));
        let second = states(&out);
        for name in ["lime", "mean_mass", "mean_height", "least_diameter"] {
            let column = format!("quantities.{name}");
            let [left, taken] = [&first.1, &second.1].map(|series| series.column(&column));
            let (left, taken) = (*left.last().unwrap(), taken[0]);
            assert!((taken / left - 1.0).abs() < 1e-9, "{name}: {left} {taken}");
        }
        // Stones lie otherwise, as contacts begin anew: 0.1 % here. The bed of the case's own start has 60 % of the lime.
        let lime = value(&second, "lime") / value(&whole, "lime");
        assert!((lime - 1.0).abs() < 0.01, "{solver}: {lime}");
        let fed = |one: &(Summary, Series)| one.0.passed.fed.rows;
        assert_eq!(fed(&first) + fed(&second), fed(&whole), "{solver}");
        for (name, line) in second
            .0
            .ledger
            .lines
            .iter()
            .chain(&second.0.ledger.elements)
        {
            let books = name != "gas_momentum" && name != "storage_clock";
            assert!(
                !books || line.relative_error < 1e-10,
                "{solver}, {name}: {line:?}"
            );
        }
    }
    let other = [
        "particles[0].name=pebbles",
        "--set",
        "feeds[0].population=pebbles",
    ];
    let output = run(&case, &folder("other"), &[&from[..], &other].concat());
    let text = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(2), "{text}");
    assert!(text.contains("[stones], this case has [pebbles]"), "{text}");
}

#[test]
fn settings_of_the_bed_the_gas_and_the_boundaries_may_change() {
    let directory = tempfile::tempdir().unwrap();
    let (first, second) = (
        directory.path().join("first"),
        directory.path().join("second"),
    );
    done(&run(&column(), &first, &["--set", "time.end=20 s"]));
    let changed = [
        "time.end=2 s",
        "time.acceleration=20",
        "laws.heat_transfer.law=wakao",
        "coupling.mapping=centroid",
        "coupling.smoother.max_solid_fraction=0.5",
        "gas.initial.pressure=2 atm",
        "gas.patch.top.outlet.pressure=2 atm",
        "gas.patch.bottom.inlet.superficial_velocity=0.2 m/s",
        "materials.glass.heat_capacity=900 J/kg/K",
        "output.series_every=0.1 s",
    ];
    let mut more = vec!["--from", first.to_str().unwrap()];
    more.extend(changed.iter().flat_map(|setting| ["--set", setting]));
    done(&run(&column(), &second, &more));
    let (old, new) = (
        Series::read(&first).unwrap(),
        Series::read(&second).unwrap(),
    );
    let name = "particles.temperature_max";
    assert_eq!(old.column(name).last(), new.column(name).first());
    for value in new.column("gas.temperature_max") {
        assert!((300.0..=400.0 + 1e-6).contains(value), "{value}");
    }
    let summary = Summary::read(&second).unwrap();
    assert!(summary.ledger.lines["energy"].relative_error < 1e-10);
}

#[test]
fn what_does_not_fit_is_refused_with_its_reason() {
    let directory = tempfile::tempdir().unwrap();
    let first = directory.path().join("first");
    done(&run(&column(), &first, &["--set", "time.end=1 s"]));
    let out = directory.path().join("out");
    let refused = |more: &[&str], from: &Path| {
        let all = [&["--from", from.to_str().unwrap()][..], more].concat();
        let output = run(&column(), &out, &all);
        assert_eq!(output.status.code(), Some(2), "{more:?}");
        String::from_utf8_lossy(&output.stderr).into_owned()
    };
    let set = |setting| refused(&["--set", setting], &first);
    let text = set("mesh.box.cells=[1, 1, 22]");
    assert!(
        text.contains("another gas mesh (11 cells, this case 22)"),
        "{text}"
    );
    let text = set("mesh.box.size=\"10 10 120 mm\"");
    assert!(text.contains("another gas mesh"), "{text}");
    let text = set("particles[0].place.grid.counts=[1, 1, 11]");
    assert!(
        text.contains("holds 10 particles, this case has 11"),
        "{text}"
    );
    let text = set("particles[0].diameter=9 mm");
    assert!(text.contains("particle 1 in the order of ids"), "{text}");
    let text = refused(&[], directory.path());
    assert!(text.contains("summary.json"), "{text}");
    for name in ["checkpoint", "checkpoint.before"] {
        let _ = std::fs::remove_dir_all(first.join(name));
    }
    let text = refused(&[], &first);
    assert!(text.contains("there is no checkpoint in it"), "{text}");
}

#[test]
fn an_openfoam_gas_starts_from_a_time_directory_that_openfoam_wrote() {
    let directory = tempfile::tempdir().unwrap();
    let inputs = directory.path().join("inputs");
    let prepared = Command::new(env!("CARGO_BIN_EXE_calcine"))
        .args(["prepare", "--gas", "openfoam", "--out"])
        .arg(&inputs)
        .arg(column())
        .output()
        .unwrap();
    done(&prepared);
    // OpenFOAM itself sets the upper half of the column to 350 K and writes it in binary.
    let case = inputs.join("openfoam");
    std::fs::write(
        case.join("system/setFieldsDict"),
        "FoamFile { version 2.0; format ascii; class dictionary; object setFieldsDict; }\n\
         defaultFieldValues ();\nregions ( boxToCell { box (-1 -1 0.05) (1 1 1); \
         fieldValues ( volScalarFieldValue T 350 ); } );\n",
    )
    .unwrap();
    let set = Command::new("setFields")
        .current_dir(&case)
        .env("PWD", &case)
        .env("WM_PROJECT_DIR", "/usr/share/openfoam")
        .output()
        .unwrap();
    assert!(
        set.status.success(),
        "{}",
        String::from_utf8_lossy(&set.stderr)
    );
    let start = format!("openfoam.start={}", case.join("0").display());
    let out = directory.path().join("out");
    let settings = [
        "--gas",
        "openfoam",
        "--set",
        "time.end=1 s",
        "--set",
        &start,
    ];
    done(&run(&column(), &out, &settings));
    let series = Series::read(&out).unwrap();
    let first = |name: &str| series.column(name)[0];
    assert_eq!(first("gas.temperature_min"), 300.0);
    assert!((first("gas.temperature_max") - 350.0).abs() < 1e-9);
    let summary = Summary::read(&out).unwrap();
    assert!(summary.ledger.lines["energy"].relative_error < 1e-10);
    // A directory of another mesh, and one without fields.
    let text = |path: &Path| {
        let set = format!("openfoam.start={}", path.display());
        let output = run(
            &column(),
            &directory.path().join("refused"),
            &[
                "--gas",
                "openfoam",
                "--set",
                &set,
                "--set",
                "mesh.box.cells=[1, 1, 22]",
            ],
        );
        assert!(!output.status.success());
        String::from_utf8_lossy(&output.stderr).into_owned()
    };
    let other = text(&case.join("0"));
    assert!(
        other.contains("11 values for a mesh of 22 cells"),
        "{other}"
    );
    let none = text(&case.join("system"));
    assert!(none.contains("none of the fields T, p, U"), "{none}");
}

/// Speeds and spins of beads in free fall, which nothing turns: natively to the bit, and taken over by LIGGGHTS.
#[test]
fn beads_go_on_with_the_speeds_and_spins_that_they_had() {
    let directory = tempfile::tempdir().unwrap();
    let bed = directory.path().join("bed.csv");
    let text = "x,y,z,vx,vy,vz,omegax,omegay,omegaz\n0.005,0.005,0.29,0.1,0,-0.2,1,30,-2\n0.015,0.015,0.28,0,0.1,0,0,0,7\n";
    std::fs::write(&bed, text).unwrap();
    let place = format!("particles[0].place={{ file = \"{}\" }}", bed.display());
    let open = |out: &str| {
        let case = Path::new(env!("CARGO_MANIFEST_DIR")).join("cases/settling-sphere.toml");
        let builder = Simulation::open(case).out(directory.path().join(out));
        builder.set(&place).set("time.end=20 ms")
    };
    let motions = |run: &Simulation| {
        let fields = run.particles();
        (fields.velocity.to_vec(), fields.angular_velocity.to_vec())
    };
    let mut first = open("first").start().unwrap();
    first.finish().unwrap();
    let left = motions(&first);
    assert!(left.1[0].y == 30.0 && left.0[0].z < -0.3, "{left:?}");
    drop(first);
    let from = directory.path().join("first");
    let native = open("native").from(&from).start().unwrap();
    assert_eq!(motions(&native), left);
    let liggghts = open("liggghts").particles(ParticleBackend::Liggghts);
    let taken = motions(&liggghts.from(&from).start().unwrap());
    for (found, left) in [(taken.0, left.0), (taken.1, left.1)] {
        for (found, left) in found.iter().zip(&left) {
            assert!(
                (found - left).norm() <= 1e-12 * left.norm(),
                "{found} {left}"
            );
        }
    }
}
