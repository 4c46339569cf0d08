//! A checkpoint holds no results: `--resume` cuts those of the folder back, and makes `results.h5` anew where a writer may have left it
//! in the middle.

#![cfg(feature = "hdf5")]
#![allow(clippy::unwrap_used)]

use std::fs;
use std::path::Path;
use std::process::{Command, Output};

use crate::support::program::{self, shipped};
use crate::support::{results_equal, stopped};

/// A bed that reacts, with all columns of its particles, and probes of gas and particles.
const SET: [&str; 8] = [
    "time.end=8 min",
    "output.every=1 min",
    "output.series_every=20 s",
    "output.particles=[\"temperature\", \"velocity\", \"inside\"]",
    "mesh.box.size=24 24 132 mm",
    "mesh.box.cells=[2, 2, 11]",
    "particles[0].place.grid.counts=[2, 2, 8]",
    "probes=[{ name = \"axis\", line = { from = \"12 12 0 mm\", to = \"12 12 132 mm\", points = 12 }, of = [\"gas\", \"particles\"] }]",
];

fn command(out: &Path, words: &[&str]) -> Command {
    program::command(&shipped("ore-reduction"), out, words, &SET)
}

fn stop(out: &Path) {
    let due = |_| stopped::rows(out) >= 13;
    assert_eq!(
        stopped::stop(command(out, &[]), due),
        stopped::Stopped::Checkpointed
    );
}

fn resumed(out: &Path) -> Output {
    command(out, &["--resume"]).output().unwrap()
}

fn log(out: &Path) -> String {
    fs::read_to_string(out.join("log/calcine.log")).unwrap()
}

const ANEW: &str = "results.h5 is made anew from series.csv";

/// Changes one bit in the middle of a file.
fn flip(path: &Path) {
    let mut bytes = fs::read(path).unwrap();
    let middle = bytes.len() / 2;
    bytes[middle] ^= 0x10;
    fs::write(path, bytes).unwrap();
}

#[test]
fn results_that_were_left_in_order_are_taken_others_are_made_anew_to_the_bit() {
    let directory = tempfile::tempdir().unwrap();
    let whole = directory.path().join("whole");
    stopped::finish(command(&whole, &[]));
    let many = results_equal::datasets(&whole.join("results.h5"));
    assert!(
        many.keys()
            .any(|name| name.starts_with("/probes/axis/particles/"))
    );
    type Harm = fn(&Path);
    let torn: Harm = |out| {
        let bytes = fs::read(out.join("results.h5")).unwrap();
        fs::write(out.join("results.h5"), &bytes[..bytes.len() / 2]).unwrap();
    };
    for (number, anew, harm) in [
        (0, false, (|_| ()) as Harm),
        (1, true, torn),
        (2, true, |out| {
            fs::remove_file(out.join("results.h5")).unwrap()
        }),
        (3, true, |out| flip(&out.join("results.h5"))),
    ] {
        let out = directory.path().join(format!("out-{number}"));
        stop(&out);
        let files: Vec<_> = fs::read_dir(out.join("checkpoint")).unwrap().collect();
        let names = files.into_iter().map(|file| file.unwrap().file_name());
        let names: Vec<_> = names.map(|name| name.into_string().unwrap()).collect();
        assert!(
            !names
                .iter()
                .any(|name| ["results.h5", "series.csv"].contains(&&**name))
        );
        harm(&out);
        let output = resumed(&out);
        assert!(output.status.success(), "{output:?}");
        assert_eq!(log(&out).contains(ANEW), anew, "{number}");
        let differing = results_equal::differences(&whole, &out);
        assert!(differing.is_empty(), "{number}: {differing:?}");
        assert!(!out.join("results.h5.new").exists());
    }
}

#[test]
fn results_that_a_checkpoint_counts_on_and_that_are_gone_are_named_and_nothing_is_changed() {
    let directory = tempfile::tempdir().unwrap();
    let out = directory.path().join("out");
    stop(&out);
    let series = out.join("series.csv");
    let text = fs::read_to_string(&series).unwrap();
    let snapshot = out.join("particles/particles_0001.vtp");
    let kept = directory.path().join("kept.vtp");
    let refused = |words: &[&str]| {
        let before = fs::read(out.join("results.h5")).unwrap();
        let output = resumed(&out);
        let told = String::from_utf8_lossy(&output.stderr).into_owned();
        assert!(!output.status.success(), "{told}");
        for word in words {
            assert!(told.contains(word), "`{word}` is missing in: {told}");
        }
        assert!(before == fs::read(out.join("results.h5")).unwrap());
    };
    let changed = text.replacen('3', "4", 1);
    fs::write(&series, &changed).unwrap();
    refused(&[
        "series.csv is not as the run left it",
        "what was in it is changed",
        "--from",
    ]);
    assert_eq!(fs::read_to_string(&series).unwrap(), changed);
    fs::write(&series, &text[..text.len() / 2]).unwrap();
    refused(&["series.csv is not as the run left it", "bytes in place of"]);
    fs::write(&series, format!("{text}1,2,3")).unwrap();
    fs::rename(&snapshot, &kept).unwrap();
    refused(&[
        "particles_0001.vtp is not as the run left it",
        "it is missing",
    ]);
    let bytes = fs::read(&kept).unwrap();
    let another = [
        "particles_0001.vtp is not as the run left it",
        "it has another content than was written",
    ];
    // One bit of a number that is changed, where results.h5 is whole.
    fs::write(&snapshot, &bytes).unwrap();
    flip(&snapshot);
    refused(&another);
    fs::write(out.join("results.h5"), "torn").unwrap();
    refused(&another);
    fs::write(&snapshot, &bytes[..bytes.len() - 200]).unwrap();
    refused(&another);
    fs::copy(out.join("particles/particles_0000.vtp"), &snapshot).unwrap();
    refused(&another);
    // Put back, it goes on; what was in the series after the checkpoint is cut.
    fs::rename(&kept, &snapshot).unwrap();
    let output = resumed(&out);
    assert!(output.status.success(), "{output:?}");
    let whole = directory.path().join("whole");
    stopped::finish(command(&whole, &[]));
    let differing = results_equal::differences(&whole, &out);
    assert!(differing.is_empty(), "{differing:?}");
}
