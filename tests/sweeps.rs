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

/// Runs of about a second, two at once.
fn sweep(folder: &Path, values: &str) -> Command {
    sweep_at_once(folder, values, Some("2"))
}

fn sweep_at_once(folder: &Path, values: &str, jobs: Option<&str>) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_calcine"));
    command.arg("sweep").arg(shipped("heated-column"));
    if let Some(jobs) = jobs {
        command.args(["--jobs", jobs]);
    }
    command
        .args(["--quiet", "--out", "out", "--set"])
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

/// The page of a sweep.
fn page(out: &Path) -> String {
    fs::read_to_string(out.join("index.html")).unwrap()
}

/// What the page links by a word; all of it is there.
fn linked(out: &Path, page: &str, word: &str) -> Vec<PathBuf> {
    let links = page.split("<a href=\"").skip(1);
    let links = links.filter_map(|rest| rest.split_once(&format!("\">{word}</a>")));
    let paths = links.filter(|(path, _)| !path.contains('"'));
    let paths: Vec<PathBuf> = paths.map(|(path, _)| out.join(path)).collect();
    assert!(paths.iter().all(|path| path.exists()), "{paths:?}");
    paths
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
    let begun = fs::read_dir(&out).unwrap();
    let begun = begun.filter(|run| run.as_ref().unwrap().path().join("lock").is_file());
    // So many are begun anew, or go on.
    assert!(begun.count() - kept.len() <= 2, "{kept:?}");
    // What had ended when it was killed; a run may have ended by itself after that.
    let before = page(&out);
    assert!(before.contains("not all have ended</span>"), "{before}");
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
    let after = page(&out);
    assert!(after.contains("<b>8</b><small>of 8</small>"), "{after}");
    assert_eq!(linked(&out, &after, "report").len(), 8, "{after}");
    // A third time nothing is left to do, and the page stays as it is.
    assert!(sweep(folder.path(), values).status().unwrap().success());
    assert_eq!(page(&out), after);
}

#[test]
fn the_page_of_a_sweep_has_its_runs_their_quantities_over_the_key_and_links() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out");
    let output = sweep(folder.path(), "4,8").output().unwrap();
    assert!(output.status.success(), "{}", said(&output));
    let page = page(&out);
    for text in [
        "<p class=\"note\">All runs have time.end = 100 s, output.every = 50 s.</p>",
        "<th>acceleration</th>",
        "<th class=\"n\">pressure drop in Pa</th>",
        "<figcaption>mean temperature in K</figcaption>",
        ">acceleration</text>",
    ] {
        assert!(page.contains(text), "`{text}` is missing: {page}");
    }
    // The values of the table are those of the runs.
    let links = linked(&out, &page, "report");
    assert_eq!(links.len(), 2);
    let rows: Vec<&str> = page.split("<tr>").skip(2).collect();
    for (row, link) in rows.iter().zip(&links) {
        let summary = Summary::read(link.parent().unwrap()).unwrap();
        for (name, quantity) in &summary.quantities {
            let heading = format!(
                "data-label=\"{} in {}\">",
                name.replace('_', " "),
                quantity.unit
            );
            let cell = row.split(&heading).nth(1).unwrap();
            let cell = cell.split('<').next().unwrap().replace('−', "-");
            let (shown, value) = (cell.parse::<f64>().unwrap(), quantity.value.unwrap());
            assert!(
                (shown - value).abs() <= 1e-5 * value.abs(),
                "{shown} {value}"
            );
        }
    }
    // Three quantities over one key, a point for each run.
    assert_eq!(page.matches("<figure>").count(), 3);
    assert_eq!(page.matches("h0M").count(), 3, "{page}");
    assert!(!page.contains("http"), "it loads something: {page}");
    assert!(page.len() < 40_000, "{}", page.len());
}

#[test]
fn single_runs_of_a_sweep_fill_its_folder_and_are_gathered() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out");
    let alone = |words: &[&str]| {
        let mut command = sweep_at_once(folder.path(), "4,5,6", None);
        command.args(words).output().unwrap()
    };
    // Two tasks of a queue at once.
    let (first, third) = std::thread::scope(|scope| {
        let first = scope.spawn(|| alone(&["--only", "1"]));
        let third = alone(&["--only", "3"]);
        (first.join().unwrap(), third)
    });
    assert!(first.status.success(), "{}", said(&first));
    assert!(third.status.success(), "{}", said(&third));
    let gathered = alone(&["--gather"]);
    assert_eq!(gathered.status.code(), Some(75), "{}", said(&gathered));
    assert!(said(&gathered).contains("2 of 3 runs have ended"));
    assert_eq!(linked(&out, &page(&out), "report").len(), 2);
    let table = || fs::read_to_string(out.join("sweep.csv")).unwrap();
    let rows: Vec<String> = table().lines().map(str::to_owned).collect();
    assert!(rows.len() == 3 && rows[1].starts_with("4,") && rows[2].starts_with("6,"));
    let kept = complete(&out);
    let rest = alone(&[]);
    assert!(rest.status.success(), "{}", said(&rest));
    let all = complete(&out);
    assert!(kept.iter().all(|(run, made)| all[run] == *made));
    assert_eq!(linked(&out, &page(&out), "report").len(), 3);
    assert_eq!(table().lines().count(), 4);
    let beyond = alone(&["--only", "4"]);
    assert_eq!(beyond.status.code(), Some(2));
    assert!(said(&beyond).contains("there are 3 combinations"));
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
    let shown = page(&folder.path().join("out"));
    let (_, failures) = shown.split_once("<h2>Runs that failed</h2>").unwrap();
    let failures = failures.split("</section>").next().unwrap();
    assert!(
        failures.contains("acceleration = 50: failed, exit code 2"),
        "{failures}"
    );
    assert!(failures.contains("holds `case.toml`"), "{failures}");
    assert_eq!(
        linked(&folder.path().join("out"), &shown, "report").len(),
        2
    );
    assert_eq!(
        linked(&folder.path().join("out"), &shown, "folder").len(),
        1
    );
    // Without what was in the way the same command mends it, and the page with it.
    fs::remove_file(in_the_way.join("case.toml")).unwrap();
    let output = sweep(folder.path(), "50,60,70").output().unwrap();
    assert!(output.status.success(), "{}", said(&output));
    let shown = page(&folder.path().join("out"));
    assert!(!shown.contains("Runs that failed"), "{shown}");
    assert_eq!(
        linked(&folder.path().join("out"), &shown, "report").len(),
        3
    );
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
fn a_key_that_stands_there_twice_and_a_table_or_page_of_the_users_own_are_refused() {
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
    fs::remove_file(&table).unwrap();
    let own = folder.path().join("out/index.html");
    fs::write(&own, "<p>mine</p>").unwrap();
    let foreign = run(&["--set", "time.end=1 s,2 s"]);
    assert_eq!(foreign.status.code(), Some(2));
    assert!(said(&foreign).contains("is no page of a sweep"));
    assert_eq!(fs::read_to_string(&own).unwrap(), "<p>mine</p>");
}

#[test]
fn a_folder_with_runs_of_other_values_is_refused_and_more_values_keep_them() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out");
    let run = |values: &str| sweep(folder.path(), values).output().unwrap();
    assert!(run("5000,6000").status.success());
    let (table, before) = (fs::read(out.join("sweep.csv")).unwrap(), complete(&out));
    let refused = run("7000");
    assert_eq!(refused.status.code(), Some(2));
    let text = said(&refused);
    assert!(
        text.contains("acceleration=5000,end=100s,every=50s has a run that is not of this sweep")
            && text.contains("(2 in all)"),
        "{text}"
    );
    assert_eq!(fs::read(out.join("sweep.csv")).unwrap(), table);
    assert!(run("5000,6000,7000").status.success());
    let after = complete(&out);
    assert_eq!(after.len(), 3);
    assert!(before.iter().all(|(run, made)| after[run] == *made));
}
