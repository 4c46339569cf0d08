//! A checkpoint that was cut short, changed or lost in part: `--resume` says which file, and goes on from the one before to the
//! same bits; `--from` begins from the one before.

#![cfg(feature = "hdf5")]
#![allow(clippy::unwrap_used)]

use std::fs;
use std::path::Path;
use std::process::Output;

use crate::support::checkpoint_harm::Harm;
use crate::support::program::{self, shipped};
use crate::support::{results_equal, stopped};

const SET: [&str; 6] = [
    "time.end=10 min",
    "output.every=2 min",
    "output.series_every=20 s",
    "mesh.box.size=24 24 132 mm",
    "mesh.box.cells=[2, 2, 11]",
    "particles[0].place.grid.counts=[2, 2, 8]",
];

fn run(out: &Path, words: &[&str]) -> Output {
    let set = [&SET[..], &["time.checkpoint.every=1 min"]].concat();
    let mut command = program::command(&shipped("ore-reduction"), out, words, &set);
    command.output().unwrap()
}

/// Stops a run after some rows, when there are two checkpoints.
fn stop(out: &Path) {
    let set = [&SET[..], &["time.checkpoint.every=1 min"]].concat();
    let command = program::command(&shipped("ore-reduction"), out, &[], &set);
    let due = |_| out.join("checkpoint.before").is_dir() && stopped::rows(out) >= 12;
    assert_eq!(stopped::stop(command, due), stopped::Stopped::Checkpointed);
}

fn said(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

#[test]
fn the_one_before_a_damaged_one_goes_on_to_the_same_bits() {
    let directory = tempfile::tempdir().unwrap();
    let whole = directory.path().join("whole");
    assert!(run(&whole, &[]).status.success());
    for (number, harm, what) in [
        (0, Harm::Truncated(500), "SHA256SUMS"),
        (1, Harm::Flipped(700), "another content than was written"),
        (2, Harm::Removed, "cannot be read: No such file"),
    ] {
        let out = directory.path().join(format!("out-{number}"));
        stop(&out);
        let file = harm.to_one_of(&out.join("checkpoint"), number);
        let resumed = run(&out, &["--resume"]);
        let text = said(&resumed);
        assert!(resumed.status.success(), "{text}");
        let name = file.file_name().unwrap().to_str().unwrap();
        for word in [
            what,
            name,
            "the run goes on from the checkpoint before it, of ",
            "checkpoint.damaged",
        ] {
            assert!(text.contains(word), "`{word}` is missing in: {text}");
        }
        let differing = results_equal::values_that_differ(&whole, &out);
        assert!(differing.is_empty(), "{harm:?} of {name}: {differing:?}");
        assert!(out.join("checkpoint.damaged").is_dir());
    }
}

#[test]
fn a_run_without_a_whole_checkpoint_is_refused_and_one_from_it_takes_the_one_before() {
    let directory = tempfile::tempdir().unwrap();
    let out = directory.path().join("out");
    stop(&out);
    Harm::Flipped(300).to_one_of(&out.join("checkpoint"), 3);
    let next = directory.path().join("next");
    let from = ["--from", out.to_str().unwrap()];
    let continued = run(&next, &from);
    let text = said(&continued);
    assert!(continued.status.success(), "{text}");
    assert!(
        text.contains("this run begins from the checkpoint before it"),
        "{text}"
    );
    assert!(out.join("checkpoint.before").is_dir());

    Harm::Truncated(0).to_one_of(&out.join("checkpoint.before"), 1);
    let refused = run(&out, &["--resume"]);
    let text = said(&refused);
    assert_eq!(refused.status.code(), Some(1), "{text}");
    for word in ["checkpoint is damaged: ", "no older one is whole", "--from"] {
        assert!(text.contains(word), "`{word}` is missing in: {text}");
    }
    // Nothing is lost: the folder is as it was.
    assert!(out.join("checkpoint").is_dir() && out.join("series.csv").is_file());
    let elsewhere = directory.path().join("elsewhere");
    let refused = run(&elsewhere, &from);
    assert_eq!(refused.status.code(), Some(2), "{}", said(&refused));
    assert!(!elsewhere.exists());
    assert!(fs::read_dir(directory.path()).unwrap().count() == 2);
}
