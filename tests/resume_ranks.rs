//! `--resume` after kill -9 where most is at stake: particles that move, come and go in LIGGGHTS on two ranks, and
//! an OpenFOAM gas on two ranks whose turbulence has a state of its own.

#![cfg(feature = "hdf5")]
#![allow(clippy::unwrap_used, clippy::print_stdout)]

use std::fs;
use std::path::Path;
use std::process::Command;

use crate::support::killed;
use crate::support::program::{self, shipped};

/// The moving bed with a turbulence model, on two ranks each: 24 windows, a checkpoint each four.
fn command(template: &Path, out: &Path) -> Command {
    let template = format!("openfoam.template={}", template.display());
    let set = [
        template.as_str(),
        "time.end=12 s",
        "time.checkpoint.every=2 s",
        "output.every=5 s",
        "output.series_every=0.5 s",
        "feeds[0].mass_rate=4 g/s",
        "outlets[0].mass_rate=4 g/s",
    ];
    let gas = ["--gas", "openfoam", "--ranks-gas", "2"];
    let particles = ["--particles", "liggghts", "--ranks-particles", "2"];
    let words = [gas, particles].concat();
    program::command(&shipped("moving-bed"), out, &words, &set)
}

fn resumes_to_the_same_bits(template: &Path, field: &str, directory: &Path) {
    let whole = killed::resumes_to_the_same_bits(directory, &[12], |out| command(template, out));
    let kept = fs::read(whole.join("checkpoint/gas/calcineModels.1")).unwrap();
    let mark = format!("\n{field}\n");
    assert!(
        kept.windows(mark.len())
            .any(|window| window == mark.as_bytes())
    );
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
