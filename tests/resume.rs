//! `--resume` after kill -9: the same values in every dataset as the uninterrupted run.

#![cfg(feature = "hdf5")]
#![allow(clippy::unwrap_used, clippy::print_stdout)]

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

/// A run with checkpoints each 2 s of process time; long enough to be killed in its middle.
fn command(pairing: [&str; 2], out: &Path, end: &str) -> Command {
    let case = Path::new(env!("CARGO_MANIFEST_DIR")).join("cases/heated-column.toml");
    let mut command = Command::new(env!("CARGO_BIN_EXE_calcine"));
    command
        .arg("run")
        .arg(case)
        .args(["--gas", pairing[0], "--particles", pairing[1], "--quiet"])
        .args([
            "--set",
            "time.acceleration=5",
            "--set",
            &format!("time.end={end}"),
        ])
        .args(["--set", "time.checkpoint.every=2 s"])
        .args([
            "--set",
            "output.every=7 s",
            "--set",
            "output.series_every=0.1 s",
        ])
        .arg("--out")
        .arg(out)
        .stdin(Stdio::null())
        .stdout(Stdio::null())
        .stderr(Stdio::piped());
    command
}

/// All values of `results.h5`, by dataset, as bits; wall times aside.
fn datasets(path: &Path) -> BTreeMap<String, Vec<u64>> {
    fn walk(group: &hdf5::Group, found: &mut BTreeMap<String, Vec<u64>>) {
        for dataset in group.datasets().unwrap() {
            if let Ok(values) = dataset.read_raw::<f64>() {
                found.insert(
                    dataset.name(),
                    values.iter().map(|value| value.to_bits()).collect(),
                );
            }
        }
        for inner in group.groups().unwrap() {
            walk(&inner, found);
        }
    }
    let file = hdf5::File::open(path).unwrap();
    let mut found = BTreeMap::new();
    walk(&file.as_group().unwrap(), &mut found);
    assert!(found.len() > 10, "{} datasets", found.len());
    found
}

/// Kills a run when its series is so many rows long, resumes it, and compares.
fn killed_and_resumed(pairing: [&str; 2], end: &str, rows: &[usize]) {
    let directory = tempfile::tempdir().unwrap();
    let whole = directory.path().join("whole");
    assert!(command(pairing, &whole, end).status().unwrap().success());
    let expected = datasets(&whole.join("results.h5"));
    for &limit in rows {
        let out: PathBuf = directory.path().join(format!("killed-{limit}"));
        let mut run = command(pairing, &out, end).spawn().unwrap();
        let begun = Instant::now();
        loop {
            let written =
                fs::read_to_string(out.join("series.csv")).map_or(0, |text| text.lines().count());
            let ready = out.join("checkpoint/coordinator.state").is_file();
            if (written >= limit && ready) || run.try_wait().unwrap().is_some() {
                break;
            }
            assert!(
                begun.elapsed() < Duration::from_secs(120),
                "no checkpoint in time"
            );
            std::thread::sleep(Duration::from_micros(200));
        }
        let killed = run.kill().is_ok();
        let status = run.wait().unwrap();
        println!("{pairing:?}: killed after {limit} rows: {killed}, {status}");
        let mut resumed = command(pairing, &out, end);
        let output = resumed.arg("--resume").output().unwrap();
        assert!(
            output.status.success(),
            "{}",
            String::from_utf8_lossy(&output.stderr)
        );
        let found = datasets(&out.join("results.h5"));
        assert_eq!(
            found.keys().collect::<Vec<_>>(),
            expected.keys().collect::<Vec<_>>()
        );
        for (name, values) in &expected {
            assert_eq!(&found[name], values, "{name} differs after {limit} rows");
        }
        let series = |folder: &Path| fs::read(folder.join("series.csv")).unwrap();
        assert_eq!(series(&whole), series(&out));
    }
}

#[test]
fn a_native_run_resumes_to_the_same_bits() {
    killed_and_resumed(["native", "native"], "40 s", &[30, 111, 250]);
}

#[test]
fn a_run_with_liggghts_resumes_to_the_same_bits() {
    killed_and_resumed(["native", "liggghts"], "20 s", &[60]);
}

#[test]
fn a_run_with_openfoam_resumes_to_the_same_bits() {
    killed_and_resumed(["openfoam", "native"], "20 s", &[60]);
}

#[test]
fn a_run_with_both_external_solvers_resumes_to_the_same_bits() {
    killed_and_resumed(["openfoam", "liggghts"], "20 s", &[90]);
}
