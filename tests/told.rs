//! What of a case is told: inputs with the message that refuses them or warns of them, `tests/inputs/told.toml`. Each is a case that is in
//! order but for what `set`, a file of particles (`bed`), a file of triangles (`wall`) or a `template` changes.

#![allow(clippy::unwrap_used, clippy::panic)]

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

use calcine::valid::{InvalidCase, ValidCase};
use serde::Deserialize;

/// Least number of inputs: the issue that asked for them wanted sixty new ones.
const LEAST: usize = 60;

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Told {
    /// The case, from the root of the repository.
    case: String,
    /// Keys that are set.
    #[serde(default)]
    set: Vec<String>,
    /// `bed.csv`, in the place of the particles of the first population.
    bed: Option<String>,
    /// `wall.stl`, a wall more.
    wall: Option<String>,
    /// Files of a template for OpenFOAM.
    #[serde(default)]
    template: BTreeMap<String, String>,
    /// What to do about it, with `refused`.
    help: Option<String>,
    /// Messages that refuse it beside `refused`, all at once.
    #[serde(default)]
    refused_too: Vec<String>,
    /// What the message that refuses it begins with, a path before it left out.
    refused: Option<String>,
    /// What a warning begins with; empty: there is none.
    warned: Option<String>,
}

#[derive(Deserialize)]
struct AllTold {
    told: Vec<Told>,
}

/// The messages of an error, one a line.
fn messages(error: &InvalidCase) -> Vec<String> {
    match error {
        InvalidCase::File(errors) => {
            let problems = errors.problems().iter();
            problems.map(|one| one.message.clone()).collect()
        }
        other => vec![other.to_string()],
    }
}

/// What helps against them.
fn helps(error: &InvalidCase) -> Vec<String> {
    match error {
        InvalidCase::File(errors) => errors
            .problems()
            .iter()
            .map(|one| one.help.clone())
            .collect(),
        _ => Vec::new(),
    }
}

#[test]
fn every_input_is_told_in_its_words() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let text = fs::read_to_string(root.join("tests/inputs/told.toml")).unwrap();
    let all: AllTold = toml::from_str(&text).unwrap();
    assert!(all.told.len() >= LEAST, "{}", all.told.len());
    let mut wrong = Vec::new();
    for (number, one) in all.told.iter().enumerate() {
        let folder = tempfile::tempdir().unwrap();
        let mut text = fs::read_to_string(root.join(&one.case)).unwrap();
        let mut set = one.set.clone();
        if let Some(bed) = &one.bed {
            fs::write(folder.path().join("bed.csv"), bed).unwrap();
            set.push("particles[0].place={ file = \"bed.csv\" }".to_owned());
        }
        if let Some(wall) = &one.wall {
            fs::write(folder.path().join("wall.stl"), wall).unwrap();
            text += "\n[[walls]]\nname = \"surface\"\nmaterial = \"glass\"\nstl = \"wall.stl\"\n";
        }
        for (name, text) in &one.template {
            let file = folder.path().join("template").join(name);
            fs::create_dir_all(file.parent().unwrap()).unwrap();
            fs::write(file, text).unwrap();
        }
        if !one.template.is_empty() {
            text += "\n[openfoam]\ntemplate = \"template\"\n";
        }
        let path = folder.path().join("case.toml");
        fs::write(&path, text).unwrap();
        let found = match ValidCase::open(&path, &set) {
            Ok(valid) => (false, valid.case.warnings, Vec::new()),
            Err(error) => (true, messages(&error), helps(&error)),
        };
        let place = folder.path().display().to_string();
        let begins = |message: &String, words: &String| {
            let message = message.replace(&format!("{place}/"), "");
            message.starts_with(words.as_str())
        };
        let as_wanted = match (&one.refused, &one.warned) {
            (Some(words), None) => {
                let told = |words: &String| found.1.iter().any(|told| begins(told, words));
                let helped = one
                    .help
                    .as_ref()
                    .is_none_or(|words| found.2.contains(words));
                found.0 && told(words) && one.refused_too.iter().all(told) && helped
            }
            (None, Some(words)) if words.is_empty() => !found.0 && found.1.is_empty(),
            (None, Some(words)) => !found.0 && found.1.iter().any(|told| begins(told, words)),
            _ => panic!("input {number} states not exactly one of `refused` and `warned`"),
        };
        if !as_wanted {
            wrong.push((number, &one.case, set, found));
        }
    }
    assert!(wrong.is_empty(), "{wrong:#?}");
}
