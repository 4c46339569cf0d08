//! The architecture is a test: the arrows between crates and between files, names of types, the length of files,
//! and nothing in them that belongs to one machine only.

#![allow(clippy::unwrap_used)]

mod imports;
mod source;

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use serde_json::Value;

use imports::{Modules, circles};

/// All arrows there may be: a crate and the crates of this workspace that it may use. Another
/// arrow is a change of the design (CONTRIBUTING.md), not of this table alone.
const ARROWS: [(&str, &[&str]); 14] = [
    (
        "calcine",
        &[
            "calcine-adapters",
            "calcine-coupler",
            "calcine-flowsheet",
            "calcine-interior",
            "calcine-native",
            "calcine-physics",
            "calcine-tuning",
            "calcine-wire",
        ],
    ),
    ("calcine-adapters", &["calcine-coupler", "calcine-wire"]),
    (
        "calcine-coupler",
        &["calcine-interior", "calcine-numerics", "calcine-physics"],
    ),
    (
        "calcine-flowsheet",
        &["calcine-numerics", "calcine-physics"],
    ),
    ("calcine-interior", &["calcine-numerics", "calcine-physics"]),
    ("calcine-liggghts", &["calcine-wire"]),
    // The same command line, where MPI spawns the solvers.
    ("calcine-mpi", &["calcine", "calcine-wire"]),
    ("calcine-native", &["calcine-coupler"]),
    ("calcine-numerics", &[]),
    ("calcine-physics", &["calcine-numerics"]),
    // Python's door to `calcine::simulation`.
    ("calcine-python", &["calcine"]),
    ("calcine-tuning", &["calcine-numerics", "calcine-physics"]),
    ("calcine-wire", &[]),
    ("xtask", &[]),
];

/// Libraries that only some crates may use: the coupler and the solvers know neither
/// transports, nor TOML, nor HDF5.
const KEPT_TO: [(&str, &[&str]); 8] = [
    ("hdf5-metno", &["calcine"]),
    ("toml", &["calcine"]),
    ("toml_edit", &["calcine"]),
    ("clap", &["calcine"]),
    ("iceoryx2", &["calcine-wire"]),
    ("mpi", &["calcine-mpi"]),
    ("numpy", &["calcine-python"]),
    ("pyo3", &["calcine-python"]),
];

/// The circles of imports that stay, by their files, each with the reason.
const CIRCLES: &[(&[&str], &str)] = &[];

/// Longest source file, in lines.
const LONGEST: usize = 800;

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// Each crate of the workspace with all its direct dependencies, those of its tests included.
fn dependencies() -> BTreeMap<String, BTreeSet<String>> {
    let output = Command::new(env!("CARGO"))
        .args([
            "metadata",
            "--no-deps",
            "--offline",
            "--format-version",
            "1",
        ])
        .current_dir(root())
        .output()
        .unwrap();
    assert!(
        output.status.success(),
        "{}",
        String::from_utf8_lossy(&output.stderr)
    );
    let metadata: Value = serde_json::from_slice(&output.stdout).unwrap();
    let name = |value: &Value| value["name"].as_str().unwrap().to_owned();
    let packages = metadata["packages"].as_array().unwrap();
    packages
        .iter()
        .map(|package| {
            let uses = package["dependencies"]
                .as_array()
                .unwrap()
                .iter()
                .map(name)
                .collect();
            (name(package), uses)
        })
        .collect()
}

/// Files of the clone that are ours; without git (an archive) everything but Cargo's output.
fn files() -> Vec<PathBuf> {
    let listed = Command::new("git")
        .args([
            "ls-files",
            "-z",
            "--cached",
            "--others",
            "--exclude-standard",
        ])
        .current_dir(root())
        .output();
    if let Ok(output) = listed
        && output.status.success()
    {
        let text = String::from_utf8_lossy(&output.stdout).into_owned();
        let all = text
            .split('\0')
            .filter(|name| !name.is_empty())
            .map(|name| root().join(name));
        return all.filter(|path| path.is_file()).collect();
    }
    let mut found = Vec::new();
    let mut folders = vec![root().to_path_buf()];
    while let Some(folder) = folders.pop() {
        for entry in fs::read_dir(folder).unwrap().flatten() {
            let path = entry.path();
            let name = entry.file_name();
            if path.is_dir()
                && !["target", ".git", "results"]
                    .iter()
                    .any(|skip| name == *skip)
            {
                folders.push(path);
            } else if path.is_file() {
                found.push(path);
            }
        }
    }
    found
}

fn shown(path: &Path) -> String {
    path.strip_prefix(root())
        .unwrap_or(path)
        .display()
        .to_string()
}

#[test]
fn only_the_arrows_of_the_design_run_between_crates() {
    let all = dependencies();
    let allowed: BTreeMap<&str, &[&str]> = ARROWS.into_iter().collect();
    let known: Vec<&str> = allowed.keys().copied().collect();
    assert_eq!(
        all.keys().collect::<Vec<_>>(),
        known,
        "crates of the workspace"
    );
    let mut wrong = Vec::new();
    for (from, uses) in &all {
        let may = allowed[from.as_str()];
        let ours = uses.iter().filter(|to| all.contains_key(*to));
        wrong.extend(
            ours.filter(|to| !may.contains(&to.as_str()))
                .map(|to| (from, to)),
        );
    }
    assert!(
        wrong.is_empty(),
        "arrows that the design does not have: {wrong:?}"
    );
}

#[test]
fn libraries_of_one_concern_stay_in_their_crate() {
    let mut wrong = Vec::new();
    for (from, uses) in dependencies() {
        for (library, may) in KEPT_TO {
            if uses.contains(library) && !may.contains(&from.as_str()) {
                wrong.push(format!("{from} -> {library}"));
            }
        }
    }
    assert!(wrong.is_empty(), "kept to other crates: {wrong:?}");
}

#[test]
fn the_build_tool_uses_the_standard_library_alone() {
    assert_eq!(dependencies()["xtask"], BTreeSet::new());
}

#[test]
fn no_source_file_is_longer_than_one_can_read() {
    let mut wrong = Vec::new();
    let mut seen = 0;
    for path in files() {
        let extension = path
            .extension()
            .and_then(|text| text.to_str())
            .unwrap_or_default();
        if ["rs", "C", "H", "h", "cpp"].contains(&extension) {
            seen += 1;
            let lines = fs::read_to_string(&path).unwrap().lines().count();
            if lines > LONGEST {
                wrong.push(format!("{}: {lines} lines", shown(&path)));
            }
        }
    }
    assert!(
        seen > 20,
        "only {seen} source files found below {}",
        root().display()
    );
    assert!(wrong.is_empty(), "longer than {LONGEST} lines: {wrong:#?}");
}

#[test]
fn no_file_holds_a_path_of_the_machine_it_was_written_on() {
    // The clone's own place, unless that is too short to mean anything, and home folders.
    let clone = root().to_string_lossy().into_owned();
    let homes = [
        ["/ho", "me/"].concat(),
        ["/ro", "ot/"].concat(),
        ["/Use", "rs/"].concat(),
    ];
    let mut wrong = Vec::new();
    for path in files() {
        let Ok(text) = fs::read_to_string(&path) else {
            continue;
        };
        let place = clone.matches('/').count() >= 2 && text.contains(&clone);
        if place || homes.iter().any(|home| text.contains(home.as_str())) {
            wrong.push(shown(&path));
        }
    }
    assert!(
        wrong.is_empty(),
        "files with a path of one machine: {wrong:?}"
    );
}

/// Rust files below a folder of the clone, with their text; comments are left out.
fn sources(folder: &str) -> Vec<(String, String)> {
    let below = root().join(folder);
    let rust = |path: &PathBuf| {
        path.starts_with(&below) && path.extension().is_some_and(|ending| ending == "rs")
    };
    let code = |path: PathBuf| {
        let text = fs::read_to_string(&path).unwrap();
        let lines = text
            .lines()
            .filter(|line| !line.trim_start().starts_with("//"));
        (shown(&path), lines.collect::<Vec<_>>().join("\n"))
    };
    files().into_iter().filter(rust).map(code).collect()
}

#[test]
fn the_coordinator_names_no_model_of_particles() {
    // Every type that implements the trait, and the modules that they live in.
    let mut named = BTreeSet::new();
    for (path, text) in sources("coupler/interior/src") {
        for rest in text.split("impl ParticleModel for ").skip(1) {
            let name = rest.split(|c: char| !c.is_alphanumeric()).next().unwrap();
            named.insert(name.to_owned());
            let inside = path.trim_start_matches("coupler/interior/src/");
            let module = inside.split(['/', '.']).next().unwrap();
            named.insert(module.to_owned());
        }
    }
    let models = ["Reacting", "Thin", "reacting", "thin"];
    assert!(models.iter().all(|name| named.contains(*name)), "{named:?}");
    let words = |text: &str| -> BTreeSet<String> {
        let split = text.split(|c: char| !(c.is_alphanumeric() || c == '_'));
        split.map(str::to_owned).collect()
    };
    let mut wrong = Vec::new();
    for (path, text) in sources("coupler/src") {
        // A variant of the gas' own chemistry is called as a model is: only what comes from the crate counts.
        if words(&text).contains("calcine_interior") {
            let found = words(&text);
            wrong.extend(
                named
                    .intersection(&found)
                    .map(|name| format!("{path}: {name}")),
            );
        }
    }
    // The root makes models in its assembly and nowhere else; `Simulation` passes on what others make.
    for (path, text) in sources("src") {
        let makes = |name: &str| text.contains(&format!("{name}::new("));
        if !path.starts_with("src/assembly/") && (makes("Reacting") || makes("Thin")) {
            wrong.push(path);
        }
    }
    assert!(
        wrong.is_empty(),
        "models named outside the assembly: {wrong:#?}"
    );
}

/// Source files of the crates of the workspace, without tests, benches and examples.
fn crate_sources() -> Vec<PathBuf> {
    let of_crates = files().into_iter().filter(|path| {
        let below = shown(path);
        let folders: Vec<&str> = below.split('/').collect();
        below.ends_with(".rs")
            && folders.contains(&"src")
            && !["tests", "benches", "examples"]
                .iter()
                .any(|other| folders.contains(other))
    });
    of_crates.collect()
}

/// Counted are `pub struct`, `enum`, `union`, `trait` and `type` of all crates, whether or not their module is
/// public, but not those of a module or crate alone (`pub(super)`, `pub(crate)`) and of tests.
#[test]
fn no_two_public_types_share_a_name() {
    let mut places: BTreeMap<String, Vec<String>> = BTreeMap::new();
    for path in crate_sources() {
        let words = source::words(&fs::read_to_string(&path).unwrap());
        for name in source::public_types(&words) {
            places
                .entry(name.to_owned())
                .or_default()
                .push(shown(&path));
        }
    }
    assert!(places.len() > 300, "only {} types found", places.len());
    places.retain(|_, places| places.len() > 1);
    assert!(places.is_empty(), "names of several types: {places:#?}");
}

/// What ties a file to another: see [`imports`]. A circle is named by all its files; one that is gone must go from
/// the list.
#[test]
fn files_of_a_crate_import_one_way() {
    let roots = crate_sources().into_iter().filter(|path| {
        let below = shown(path);
        below.ends_with("src/lib.rs") || below.ends_with("src/main.rs")
    });
    let (mut count, mut staying, mut wrong) = (0, Vec::new(), String::new());
    for root in roots {
        let modules = Modules::read(&root);
        count += modules.len();
        let ties = modules.ties();
        for circle in circles(&ties) {
            let names: Vec<String> = circle.iter().map(|file| shown(file)).collect();
            if CIRCLES.iter().any(|(files, _)| *files == names) {
                staying.push(names);
                continue;
            }
            wrong += &format!("a circle of {} files:\n", circle.len());
            for from in &circle {
                for (to, names) in ties[from].iter().filter(|(to, _)| circle.contains(to)) {
                    wrong += &format!("  {} takes {names:?} from {}\n", shown(from), shown(to));
                }
            }
        }
    }
    assert!(count > 300, "only {count} files found");
    assert!(wrong.is_empty(), "files that import each other:\n{wrong}");
    for (files, reason) in CIRCLES {
        let stays = staying.iter().any(|names| names == files);
        assert!(stays, "no circle any more ({reason}): {files:?}");
    }
}

#[test]
fn a_circle_is_found_and_a_parent_that_hands_on_makes_none() {
    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str, text: &str| fs::write(folder.path().join(name), text).unwrap();
    let found = || {
        let ties = Modules::read(&folder.path().join("lib.rs")).ties();
        let circles = circles(&ties).into_iter();
        let name = |path: &PathBuf| path.file_name().unwrap().to_string_lossy().into_owned();
        circles
            .map(|circle| circle.iter().map(name).collect::<Vec<_>>())
            .collect::<Vec<_>>()
    };
    write(
        "lib.rs",
        "mod a;\nmod b;\npub use a::A;\n/// `b::B`\npub struct Own;\n",
    );
    write(
        "a.rs",
        "pub struct A;\n#[cfg(test)]\nmod tests {\n    use crate::b::B;\n}\n",
    );
    write(
        "b.rs",
        "use super::{A, Own};\npub struct B(A, Own, &'static str);\nconst TEXT: &str = \"a::A\";\n",
    );
    assert!(found().is_empty(), "{:?}", found());
    // Through what the parent hands on.
    write(
        "a.rs",
        "pub struct A;\nfn f() -> usize { std::mem::size_of::<crate::b::B>() }\n",
    );
    assert_eq!(found(), [["a.rs", "b.rs"]]);
    // With an item of the parent, that uses the child itself.
    write("a.rs", "pub struct A;\n");
    write(
        "lib.rs",
        "mod a;\nmod b;\npub use a::A;\npub struct Own;\nfn f(b: b::B) -> b::B { b }\n",
    );
    assert_eq!(found(), [["b.rs", "lib.rs"]]);
}
