//! No file of tests is left out: each Rust file below a `tests` folder is part of a test program.

#![allow(clippy::unwrap_used)]

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use serde_json::Value;

/// Folders of each package of the workspace, and the first files of its test programs.
fn packages() -> Vec<(PathBuf, Vec<PathBuf>)> {
    let words = [
        "metadata",
        "--no-deps",
        "--offline",
        "--format-version",
        "1",
    ];
    let output = Command::new(env!("CARGO"))
        .args(words)
        .current_dir(env!("CARGO_MANIFEST_DIR"))
        .output()
        .unwrap();
    let told = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{told}");
    let metadata: Value = serde_json::from_slice(&output.stdout).unwrap();
    let text = |value: &Value| PathBuf::from(value.as_str().unwrap());
    let packages = metadata["packages"].as_array().unwrap().iter();
    let of = |package: &Value| {
        let targets = package["targets"].as_array().unwrap().iter();
        let tests = targets.filter(|target| target["kind"][0] == "test");
        let folder = text(&package["manifest_path"]).parent().unwrap().to_owned();
        (
            folder,
            tests.map(|target| text(&target["src_path"])).collect(),
        )
    };
    packages.map(of).collect()
}

/// All Rust files below a folder.
fn files(folder: &Path, found: &mut BTreeSet<PathBuf>) {
    for entry in fs::read_dir(folder).into_iter().flatten().flatten() {
        let path = entry.path();
        if path.is_dir() {
            files(&path, found);
        } else if path.extension().is_some_and(|ending| ending == "rs") {
            found.insert(path);
        }
    }
}

/// Adds a file and, by its `mod NAME;` and `#[path = "…"]`, the files of its modules; `inside` is where those without
/// a path lie.
fn follow(file: &Path, inside: &Path, found: &mut BTreeSet<PathBuf>) {
    let file = fs::canonicalize(file).unwrap();
    if !found.insert(file.clone()) {
        return;
    }
    let text = fs::read_to_string(&file).unwrap();
    let mut at = None;
    for line in text.lines() {
        if let Some(rest) = line.strip_prefix("#[path = \"") {
            at = rest.strip_suffix("\"]").map(str::to_owned);
            continue;
        }
        let declared = line.strip_prefix("pub ").unwrap_or(line);
        let name = declared
            .strip_prefix("mod ")
            .and_then(|it| it.strip_suffix(';'));
        let Some(name) = name else { continue };
        // A file named by its path has the modules of its own beside it, as a `mod.rs` has.
        if let Some(at) = at.take() {
            let path = file.parent().unwrap().join(at);
            follow(&path, path.parent().unwrap(), found);
            continue;
        }
        let (flat, folder) = (inside.join(format!("{name}.rs")), inside.join(name));
        let path = if flat.is_file() {
            flat
        } else {
            folder.join("mod.rs")
        };
        follow(&path, &folder, found);
    }
}

#[test]
fn each_file_of_tests_is_part_of_a_test_program() {
    let (mut all, mut reached) = (BTreeSet::new(), BTreeSet::new());
    for (folder, programs) in packages() {
        files(&fs::canonicalize(folder).unwrap().join("tests"), &mut all);
        for program in programs {
            follow(&program, program.parent().unwrap(), &mut reached);
        }
    }
    assert!(all.len() > 50, "only {} files of tests found", all.len());
    let left: Vec<&PathBuf> = all.difference(&reached).collect();
    assert!(left.is_empty(), "part of no test program: {left:#?}");
}
