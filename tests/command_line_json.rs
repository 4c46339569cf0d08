//! The end of a run for machines.

#![allow(clippy::unwrap_used)]

use std::fs;
use std::process::{Command, Output};

use serde_json::Value;

use crate::support::program::shipped;

/// `run --json` of the heated column over a minute, in a folder.
fn run(folder: &std::path::Path, more: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_calcine"))
        .args(["run", shipped("heated-column").to_str().unwrap(), "--json"])
        .args(["--out", "out", "--set", "time.end=\"60 s\""])
        .args(more)
        .current_dir(folder)
        .output()
        .unwrap()
}

#[test]
fn the_line_has_exit_code_folder_report_and_summary() {
    let folder = tempfile::tempdir().unwrap();
    let output = run(folder.path(), &[]);
    let text = String::from_utf8(output.stdout).unwrap();
    assert_eq!(text.lines().count(), 1, "{text}");
    let end: Value = serde_json::from_str(&text).unwrap();
    assert_eq!(end["exit_code"], i64::from(output.status.code().unwrap()));
    assert_eq!(end["out"], "out");
    assert_eq!(end["report"], "out/report.html");
    let summary = fs::read_to_string(folder.path().join("out/summary.json")).unwrap();
    let summary: Value = serde_json::from_str(&summary).unwrap();
    assert_eq!(end["summary"], summary);
    assert_eq!(summary["process_time_s"], 60.0);
}

#[test]
fn a_stopped_run_has_no_report_and_a_failed_one_its_error() {
    let folder = tempfile::tempdir().unwrap();
    let output = run(folder.path(), &["--stop-after", "0.001 s"]);
    let end: Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!(end["exit_code"], i64::from(output.status.code().unwrap()));
    assert_eq!(
        (&end["report"], &end["error"]),
        (&Value::Null, &Value::Null)
    );
    let diverging = "gas.patch.bottom.inlet.superficial_velocity=\"1e7 m/s\"";
    for (code, wrong) in [(2, "gas.nonsense=1"), (3, diverging)] {
        let folder = tempfile::tempdir().unwrap();
        let output = run(folder.path(), &["--set", wrong]);
        assert_eq!(output.status.code(), Some(code));
        let end: Value = serde_json::from_slice(&output.stdout).unwrap();
        assert_eq!(
            (&end["exit_code"], &end["report"]),
            (&code.into(), &Value::Null)
        );
        let begun = code == 3;
        let out = if begun { "out".into() } else { Value::Null };
        assert_eq!(end["out"], out);
        assert_eq!(end["summary"]["verdict"].is_string(), begun);
        let told = String::from_utf8(output.stderr).unwrap();
        let error = end["error"].as_str().unwrap();
        assert!(
            !error.is_empty() && told.trim_end().ends_with(error),
            "{told}"
        );
    }
}
