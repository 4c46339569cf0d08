//! `calcine schema`: an independent validator finds nothing in cases that are in order, and finds
//! what is misspelt, missing, too much or without a unit. `calcine new` puts it beside a case.

#![allow(clippy::unwrap_used, clippy::print_stdout)]

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::process::Command;

use serde_json::Value;

fn cases(folder: &str) -> Vec<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join(folder);
    let entries = std::fs::read_dir(folder).unwrap();
    let paths = entries.map(|entry| entry.unwrap().path());
    paths
        .filter(|path| path.extension().is_some_and(|ending| ending == "toml"))
        .collect()
}

fn calcine(directory: &Path, arguments: &[&str]) -> String {
    let mut command = Command::new(env!("CARGO_BIN_EXE_calcine"));
    let output = command.args(arguments).current_dir(directory).output();
    let output = output.unwrap();
    assert!(output.status.success(), "{arguments:?}");
    String::from_utf8(output.stdout).unwrap()
}

/// What Debian's python3-jsonschema says of the schema's own examples and of case files.
fn checked(schema: &Path, files: &[PathBuf]) -> Value {
    let output = Command::new("/usr/bin/python3")
        .args(["-c", include_str!("readers/check_schema.py")])
        .arg(schema)
        .args(files)
        .output()
        .unwrap();
    assert!(
        output.status.success(),
        "python3-jsonschema is needed (`cargo xtask setup`): {}",
        String::from_utf8_lossy(&output.stderr)
    );
    serde_json::from_slice(&output.stdout).unwrap()
}

#[test]
fn the_schema_accepts_every_good_case_and_finds_what_an_editor_can_know_to_be_wrong() {
    let directory = tempfile::tempdir().unwrap();
    let file = directory.path().join("case.schema.json");
    std::fs::write(&file, calcine(directory.path(), &["schema"])).unwrap();
    let mut good = [
        cases("cases"),
        cases("cases/full-size"),
        cases("tests/inputs/good"),
    ]
    .concat();
    good.retain(|path| calcine::case::kind_of(path, &[]).unwrap().name == "bed");
    let bad = cases("tests/inputs/bad");
    let found = checked(&file, &[good.clone(), bad.clone()].concat());
    assert_eq!(
        found["shown"],
        serde_json::json!({}),
        "examples and defaults"
    );
    let said = |path: &PathBuf| found["cases"][path.to_str().unwrap()].clone();
    for path in &good {
        assert_eq!(said(path), Value::Null, "{}", path.display());
    }
    let names = bad.iter().map(|path| {
        let name = path.file_stem().unwrap().to_string_lossy().into_owned();
        (name, said(path).as_str().map(str::to_owned))
    });
    let names: BTreeMap<String, Option<String>> = names.collect();
    for (name, message) in &names {
        println!("{name}: {}", message.as_deref().unwrap_or("-"));
    }
    for (name, what) in [
        ("four-errors", "densty"),
        ("kind-misspelt", "kind"),
        ("law-misspelt", "laws.drag.law"),
        ("laws-not-stated", "laws"),
        ("storage-misspelt", "time.gas_storage"),
        ("diameter-without-unit", "particles[0].diameter"),
        ("unit-unknown", ""),
        ("patch-with-two-conditions", "gas.patch"),
        ("packing-misspelt", "packing"),
        ("inlet-flow-twice", "inlet"),
        ("vector-too-short", ""),
        ("probe-points-without-unit", "points"),
        ("schmidt-missing", "gas"),
        ("diameters-without-share", "diameter"),
    ] {
        let message = names[name].as_deref();
        assert!(
            message.is_some_and(|text| text.contains(what)),
            "{name}: {message:?}"
        );
    }
}

#[test]
fn a_new_case_has_its_schema_beside_it_and_names_it() {
    let directory = tempfile::tempdir().unwrap();
    calcine(directory.path(), &["new", "mine"]);
    let folder = directory.path().join("mine");
    let case = folder.join("mine.toml");
    let text = std::fs::read_to_string(&case).unwrap();
    assert!(text.starts_with("#:schema case.schema.json\n"), "{text}");
    let found = checked(
        &folder.join("case.schema.json"),
        std::slice::from_ref(&case),
    );
    assert_eq!(found["cases"][case.to_str().unwrap()], Value::Null);
    calcine(directory.path(), &["check", "mine/mine.toml"]);
}

#[test]
fn a_reader_that_stops_early_is_no_error() {
    let mut command = Command::new("sh");
    command.args(["-c", "\"$1\" schema | head -n 1", "sh"]);
    let output = command.arg(env!("CARGO_BIN_EXE_calcine")).output().unwrap();
    assert!(output.status.success());
    assert_eq!(String::from_utf8_lossy(&output.stderr), "");
}
