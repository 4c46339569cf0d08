//! Sweeps of several runs at once: killed, started again, with a run that fails.

#![cfg(feature = "hdf5")]
#![allow(clippy::unwrap_used)]

use std::collections::BTreeMap;
use std::fs;
use std::os::unix::fs::MetadataExt;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};
use std::time::{Duration, Instant, SystemTime};

use calcine::results::Summary;

use crate::support::program::shipped;

/// Eight runs of about a second, two at once.
fn sweep(folder: &Path, values: &str) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_calcine"));
    command
        .arg("sweep")
        .arg(shipped("heated-column"))
        .args(["--quiet", "--jobs", "2", "--out", "out", "--set"])
        .arg(format!("time.acceleration={values}"))
        .args(["--set", "time.end=100 s", "--set", "output.every=50 s"])
        .current_dir(folder)
        .stdout(Stdio::piped())
        .stderr(Stdio::piped());
    command
}

fn said(output: &Output) -> String {
    let text = [&output.stdout[..], &output.stderr[..]].concat();
    String::from_utf8(text).unwrap()
}

/// The runs that have come to their ends, with when their series was made.
fn complete(out: &Path) -> BTreeMap<PathBuf, (u64, SystemTime)> {
    let runs = fs::read_dir(out).into_iter().flatten();
    let folders = runs.map(|run| run.unwrap().path());
    let ended = folders
        .filter(|run| Summary::read(run).is_ok_and(|summary| summary.process_time_s == 100.0));
    let made = |run: &PathBuf| {
        let data = fs::metadata(run.join("series.csv")).unwrap();
        (data.ino(), data.modified().unwrap())
    };
    ended.map(|run| (run.clone(), made(&run))).collect()
}

#[test]
fn a_sweep_that_is_killed_keeps_what_has_ended_and_goes_on() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out");
    let values = "4,5,6,7,8,9,10,11";
    let mut first = sweep(folder.path(), values).spawn().unwrap();
    let begun = Instant::now();
    while complete(&out).len() < 3 {
        assert!(begun.elapsed() < Duration::from_secs(120));
        std::thread::sleep(Duration::from_millis(10));
    }
    first.kill().unwrap();
    first.wait().unwrap();
    // What it had begun leaves a checkpoint and ends.
    let busy = |run: &Path| {
        fs::read_to_string(run.join("status.json")).is_ok_and(|text| text.contains("\"running\""))
    };
    while fs::read_dir(&out)
        .unwrap()
        .any(|run| busy(&run.unwrap().path()))
    {
        assert!(begun.elapsed() < Duration::from_secs(180));
        std::thread::sleep(Duration::from_millis(20));
    }
    let kept = complete(&out);
    assert!((3..8).contains(&kept.len()), "{kept:?}");
    let second = sweep(folder.path(), values).output().unwrap();
    assert!(second.status.success(), "{}", said(&second));
    let all = complete(&out);
    assert_eq!(all.len(), 8);
    for (run, made) in &kept {
        assert_eq!(&all[run], made, "{} was made again", run.display());
    }
    let table = fs::read_to_string(out.join("sweep.csv")).unwrap();
    assert_eq!(table.lines().count(), 9, "{table}");
    assert!(
        table.starts_with("time.acceleration,time.end,output.every,loop s,"),
        "{table}"
    );
    let rows = said(&second);
    let rows = rows.lines().filter(|line| line.starts_with("| ")).count();
    assert_eq!(rows, 9, "{}", said(&second));
}

#[test]
fn a_run_that_fails_ends_no_other_and_its_words_are_told() {
    let folder = tempfile::tempdir().unwrap();
    let in_the_way = folder.path().join("out/acceleration=50,end=100s,every=50s");
    fs::create_dir_all(&in_the_way).unwrap();
    fs::write(in_the_way.join("case.toml"), "mine").unwrap();
    let output = sweep(folder.path(), "50,60,70").output().unwrap();
    let told = said(&output);
    assert_eq!(output.status.code(), Some(2), "{told}");
    assert!(told.contains("holds `case.toml`"), "{told}");
    assert_eq!(complete(&folder.path().join("out")).len(), 2, "{told}");
    let table = fs::read_to_string(folder.path().join("out/sweep.csv")).unwrap();
    let failed = table.lines().find(|line| line.starts_with("50,")).unwrap();
    assert!(failed.ends_with("\"failed, exit code 2\""), "{table}");
    // Results that cannot be read are refused before anything runs.
    fs::write(
        folder
            .path()
            .join("out/acceleration=70,end=100s,every=50s/summary.json"),
        "{}",
    )
    .unwrap();
    let output = sweep(folder.path(), "70").output().unwrap();
    assert_eq!(output.status.code(), Some(2), "{}", said(&output));
}

#[test]
fn a_key_that_stands_there_twice_and_a_table_of_the_users_own_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let run = |words: &[&str]| {
        let mut command = Command::new(env!("CARGO_BIN_EXE_calcine"));
        let case = shipped("heated-column");
        command
            .arg("sweep")
            .arg(case)
            .args(["--quiet", "--out", "out"])
            .args(words);
        command.current_dir(folder.path()).output().unwrap()
    };
    let twice = run(&["--set", "time.end=1 s", "--set", "time.end=2 s"]);
    assert_eq!(twice.status.code(), Some(2));
    assert!(
        said(&twice).contains("`time.end` stands in two `--set`"),
        "{}",
        said(&twice)
    );
    let table = folder.path().join("out/sweep.csv");
    fs::create_dir(folder.path().join("out")).unwrap();
    fs::write(&table, "my,data\n1,2\n").unwrap();
    let foreign = run(&["--set", "time.end=1 s,2 s"]);
    assert_eq!(foreign.status.code(), Some(2));
    assert!(
        said(&foreign).contains("is no table of a sweep"),
        "{}",
        said(&foreign)
    );
    assert_eq!(fs::read_to_string(&table).unwrap(), "my,data\n1,2\n");
}
