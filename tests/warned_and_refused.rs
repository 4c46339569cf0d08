//! What somebody meets who writes a case for the first time: warnings that count, comparisons and sweeps that judge,
//! refusals that say what to change.

#![allow(clippy::unwrap_used)]

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use calcine::exit;
use calcine::results::Summary;

use crate::support::program::shipped;

fn good(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("tests/inputs/good/{name}.toml"))
}

fn calcine(folder: &Path, case: &Path, words: &[&str], set: &[&str]) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_calcine"));
    command.current_dir(folder).arg(words[0]).arg(case);
    command.args(&words[1..]);
    for setting in set {
        command.args(["--set", setting]);
    }
    command.output().unwrap()
}

/// Standard output and error, one behind the other.
fn said(output: &Output) -> String {
    let [out, err] =
        [&output.stdout, &output.stderr].map(|bytes| String::from_utf8_lossy(bytes).into_owned());
    out + &err
}

#[test]
fn a_warning_of_check_is_one_of_run_of_its_log_its_report_and_its_exit_code() {
    let folder = tempfile::tempdir().unwrap();
    let step = ["time.process_step=60 s"];
    let checked = said(&calcine(folder.path(), &good("chimney"), &["check"], &step));
    let warnings: Vec<&str> = checked
        .lines()
        .filter_map(|line| line.trim().strip_prefix("warning: "))
        .collect();
    assert!(
        warnings
            .iter()
            .any(|one| one.contains("the flow does not develop")),
        "{checked}"
    );
    let words = ["run", "--quiet", "--out", "out", "--strict"];
    let output = calcine(folder.path(), &good("chimney"), &words, &step);
    assert_eq!(output.status.code(), Some(i32::from(exit::WARNINGS)));
    let told = said(&output);
    let out = folder.path().join("out");
    let log = fs::read_to_string(out.join("log/calcine.log")).unwrap();
    let page = fs::read_to_string(out.join("report.html")).unwrap();
    let summary = Summary::read(&out).unwrap();
    assert_eq!(summary.case_warnings, warnings);
    for warning in warnings {
        assert_eq!(told.matches(warning).count(), 1, "{told}");
        assert_eq!(log.matches(warning).count(), 1, "{log}");
    }
    assert!(page.contains("the flow does not develop"));
}

#[test]
fn particles_that_were_used_up_are_counted_at_the_end() {
    let folder = tempfile::tempdir().unwrap();
    let words = ["run", "--quiet", "--out", "out"];
    let set = ["materials.char.used_up=0.9"];
    let output = calcine(folder.path(), &good("burning-beads"), &words, &set);
    let told = said(&output);
    let summary = Summary::read(&folder.path().join("out")).unwrap();
    let used_up = summary.passed.used_up.rows;
    assert!(used_up > 0, "{told}");
    let line = format!("used up (burnt out) and taken out: {used_up} particles, with ");
    assert!(told.contains(&line), "{told}");
}

#[test]
fn other_solids_than_those_of_the_run_before_are_refused_with_their_names() {
    let folder = tempfile::tempdir().unwrap();
    let words = ["run", "--quiet", "--out", "first"];
    let end = "time.end=1 min";
    let done = calcine(folder.path(), &good("calcining-box"), &words, &[end]);
    assert_eq!(done.status.code(), Some(0), "{}", said(&done));
    let words = ["run", "--quiet", "--out", "second", "--from", "first"];
    let clay = "materials.limestone.composition={ mass = { CaCO3 = 0.9, Al2O3 = 0.1 } }";
    let output = calcine(folder.path(), &good("calcining-box"), &words, &[end, clay]);
    let told = said(&output);
    assert_eq!(output.status.code(), Some(i32::from(exit::CASE)), "{told}");
    assert!(
        told.contains(
            "are made of the solids [CaCO3, CaO], those of this case of [Al2O3, CaCO3, CaO]"
        ),
        "{told}"
    );
}

/// The heated column with a quantity that is expected to be colder than it is.
fn missed(folder: &Path) -> PathBuf {
    let quantity = "\n[[quantities]]\nname = \"missed\"\nmeasure = { particle = \"temperature\", number = 1 }\n\
                    expect = { value = \"900 K\", within = \"1 %\" }\n";
    let text = fs::read_to_string(shipped("heated-column")).unwrap();
    let path = folder.join("case.toml");
    fs::write(&path, text + quantity).unwrap();
    path
}

#[test]
fn a_sweep_shows_which_runs_are_outside_their_bands_and_ends_with_that_code() {
    let folder = tempfile::tempdir().unwrap();
    let words = ["sweep", "--quiet", "--out", "out"];
    let end = ["time.end=0.5 s,1 s"];
    let output = calcine(folder.path(), &missed(folder.path()), &words, &end);
    let told = said(&output);
    assert_eq!(
        output.status.code(),
        Some(i32::from(exit::OUTSIDE_BANDS)),
        "{told}"
    );
    let rows: Vec<&str> = told.lines().filter(|line| line.starts_with("| ")).collect();
    assert!(rows[0].ends_with("| verdict |"), "{told}");
    assert_eq!(rows.len(), 3, "{told}");
    assert!(
        rows[1..]
            .iter()
            .all(|row| row.contains("| outside: missed")),
        "{told}"
    );
}

#[test]
fn a_pairing_that_stands_there_twice_is_refused_before_anything_runs() {
    let folder = tempfile::tempdir().unwrap();
    let words = ["compare", "--pairings", "native+native,native+native"];
    let output = calcine(folder.path(), &shipped("heated-column"), &words, &[]);
    let told = said(&output);
    assert_eq!(output.status.code(), Some(i32::from(exit::CASE)), "{told}");
    assert!(
        told.contains("`native+native` stands there twice"),
        "{told}"
    );
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 0);
}

#[test]
fn a_resumption_with_another_case_names_what_differs() {
    let folder = tempfile::tempdir().unwrap();
    let words = ["run", "--quiet", "--out", "out"];
    let first = calcine(
        folder.path(),
        &shipped("heated-column"),
        &words,
        &["time.end=1 s"],
    );
    assert_eq!(first.status.code(), Some(0));
    let words = ["run", "--quiet", "--out", "out", "--resume"];
    let output = calcine(
        folder.path(),
        &shipped("heated-column"),
        &words,
        &["time.end=2 s"],
    );
    let told = said(&output);
    assert_eq!(output.status.code(), Some(i32::from(exit::CASE)), "{told}");
    assert!(
        told.contains("`time.end` is \"1 s\" there and \"2 s\" here"),
        "{told}"
    );
}

#[test]
fn helps_name_the_form_the_table_and_the_built_in_names_that_are_meant() {
    let help = |name: &str, words: &str| {
        let path =
            Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("tests/inputs/bad/{name}.toml"));
        let told = said(&calcine(Path::new("."), &path, &["check"], &[]));
        assert!(told.contains(words), "{name}: {told}");
    };
    help("mechanism-misspelt", "did you mean \"jones-lindstedt\"?");
    help(
        "forms-of-values",
        "write the decimal point as a point, \"2.5 mm\"",
    );
    help("forms-of-values", "pressures are absolute");
    help("forms-of-values", "backflow = { temperature = \"300 K\" }");
    help(
        "keys-of-other-tables",
        "it is a key of another table: `gas.gravity`",
    );
    help("keys-of-other-tables", "`gas.chemistry.reactions`");
    help(
        "composition-without-species",
        "name its species, for example gas.species",
    );
}
