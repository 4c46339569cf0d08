//! `--resume` after kill -9 where most is at stake: particles that move, come and go in LIGGGHTS on two ranks, and
//! an OpenFOAM gas on two ranks whose turbulence has a state of its own.

#![cfg(feature = "hdf5")]
#![allow(clippy::unwrap_used, clippy::print_stdout)]

#[path = "support/results_equal.rs"]
mod results_equal;

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

/// The moving bed with a turbulence model, on two ranks each: 24 windows, a checkpoint each four.
fn command(template: &Path, out: &Path) -> Command {
    let case = Path::new(env!("CARGO_MANIFEST_DIR")).join("cases/moving-bed.toml");
    let mut command = Command::new(env!("CARGO_BIN_EXE_calcine"));
    command
        .arg("run")
        .arg(case)
        .args(["--gas", "openfoam", "--ranks-gas", "2"])
        .args([
            "--particles",
            "liggghts",
            "--ranks-particles",
            "2",
            "--quiet",
        ])
        .args([
            "--set",
            &format!("openfoam.template={}", template.display()),
        ]);
    for setting in [
        "time.end=12 s",
        "time.checkpoint.every=2 s",
        "output.every=5 s",
        "output.series_every=0.5 s",
        "feeds[0].mass_rate=4 g/s",
        "outlets[0].mass_rate=4 g/s",
    ] {
        command.args(["--set", setting]);
    }
    command
        .arg("--out")
        .arg(out)
        .stdin(Stdio::null())
        .stdout(Stdio::null())
        .stderr(Stdio::piped());
    command
}

fn resumes_to_the_same_bits(template: &Path, field: &str, directory: &Path) {
    let whole = directory.join("whole");
    let output = command(template, &whole).output().unwrap();
    let text = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{text}");
    let kept = fs::read(whole.join("checkpoint/gas/calcineModels.1")).unwrap();
    let mark = format!("\n{field}\n");
    assert!(
        kept.windows(mark.len())
            .any(|window| window == mark.as_bytes())
    );
    let out: PathBuf = directory.join("killed");
    let mut run = command(template, &out).spawn().unwrap();
    let begun = Instant::now();
    loop {
        let rows =
            fs::read_to_string(out.join("series.csv")).map_or(0, |text| text.lines().count());
        let ready = out.join("checkpoint/coordinator.state").is_file();
        if rows >= 12 && ready || run.try_wait().unwrap().is_some() {
            break;
        }
        assert!(
            begun.elapsed() < Duration::from_secs(120),
            "no checkpoint in time"
        );
        std::thread::sleep(Duration::from_millis(1));
    }
    run.kill().unwrap();
    let status = run.wait().unwrap();
    assert!(!status.success(), "it had ended before it was killed");
    let output = command(template, &out).arg("--resume").output().unwrap();
    let text = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{text}");
    let differing = results_equal::differences(&whole, &out);
    assert!(differing.is_empty(), "{differing:?}");
}

#[test]
fn a_moving_bed_with_k_epsilon_on_two_ranks_each_resumes_to_the_same_bits() {
    let directory = tempfile::tempdir().unwrap();
    let template = Path::new(env!("CARGO_MANIFEST_DIR")).join("of-cases/k-epsilon");
    resumes_to_the_same_bits(&template, "epsilon", directory.path());
}

/// The k-omega model of Wilcox in place of k-epsilon, with the same walls.
#[test]
fn a_moving_bed_with_k_omega_on_two_ranks_each_resumes_to_the_same_bits() {
    let directory = tempfile::tempdir().unwrap();
    let source = Path::new(env!("CARGO_MANIFEST_DIR")).join("of-cases/k-epsilon");
    let template = directory.path().join("k-omega");
    for folder in ["0", "constant"] {
        fs::create_dir_all(template.join(folder)).unwrap();
        for entry in fs::read_dir(source.join(folder)).unwrap().flatten() {
            let name = entry
                .file_name()
                .to_string_lossy()
                .replace("epsilon", "omega");
            let text = fs::read_to_string(entry.path()).unwrap();
            let text = text
                .replace("kEpsilon", "kOmega")
                .replace("[0 2 -3 0 0 0 0]", "[0 0 -1 0 0 0 0]")
                .replace("epsilonWallFunction", "omegaWallFunction")
                .replace("epsilon", "omega");
            fs::write(template.join(folder).join(name), text).unwrap();
        }
    }
    resumes_to_the_same_bits(&template, "omega", directory.path());
}
