//! What of a template cannot be used, all of it at once, before anything is started.
//!
//! OpenFOAM ends at the first fault that it meets. Here every file is looked at as far as its own text goes; what it includes,
//! and what only OpenFOAM knows (names of schemes, models, boundary conditions), stays OpenFOAM's to refuse.

use std::fs;
use std::path::{Path, PathBuf};

use calcine_coupler::setup::GasSetup;

use super::dictionary::{Dictionary, Value};
use super::stock::StockSolver;
use super::turbulence;

/// What of a template cannot be used.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct TemplateFinding {
    /// The file, below the template.
    pub file: String,
    /// The line, from 1, where there is one.
    pub line: Option<usize>,
    /// What is wrong.
    pub what: String,
    /// What to do.
    pub remedy: String,
}

impl TemplateFinding {
    /// Place and fact, and the remedy.
    pub fn parts(&self) -> (String, &str) {
        let place = match self.line {
            Some(line) => format!("{}, line {line}", self.file),
            None => self.file.clone(),
        };
        (format!("{place}: {}", self.what), &self.remedy)
    }
}

/// Loops of other solvers; calcineGasFoam refuses them too where a file is included.
const LOOPS: [&str; 3] = ["PIMPLE", "PISO", "SIMPLE"];
/// Schemes of time that say nothing else than what calcineGasFoam does.
const TIMES: [&str; 3] = ["Euler", "steadyState", "none"];
/// Dictionaries without which no solver of OpenFOAM starts.
const NEEDED: [(&str, &[&str]); 2] = [
    (
        "system/fvSchemes",
        &["divSchemes", "gradSchemes", "laplacianSchemes"],
    ),
    ("system/fvSolution", &["solvers"]),
];
/// Kinds of turbulence models.
const KINDS: [&str; 3] = ["laminar", "RAS", "LES"];

/// What of a template for a solver and a gas cannot be used, by files and lines.
pub fn findings(template: &Path, solver: StockSolver, setup: &GasSetup) -> Vec<TemplateFinding> {
    let mut found = Vec::new();
    let written = written(setup);
    for folder in ["0", "constant", "system"] {
        for path in files(&template.join(folder)) {
            let name = path.file_name().unwrap_or_default().to_string_lossy();
            let file = format!("{folder}/{name}");
            if written.contains(&file) {
                continue;
            }
            // Binary fields are OpenFOAM's own.
            let Ok(text) = fs::read_to_string(&path) else {
                continue;
            };
            let mut note = |line: Option<usize>, what: String, remedy: &str| {
                found.push(TemplateFinding {
                    file: file.clone(),
                    line,
                    what,
                    remedy: remedy.into(),
                });
            };
            match Dictionary::parse(&text) {
                Err((line, what)) => note(Some(line), what, "correct the dictionary there"),
                Ok(read) => look(&file, &read, solver, &mut note),
            }
        }
    }
    found
}

/// Files of a template over which OpenFOAM's case is written, without those of reactions.
pub fn written(setup: &GasSetup) -> Vec<String> {
    let always = [
        "0/U",
        "0/T",
        "0/p",
        "0/p_rgh",
        "constant/g",
        "constant/thermophysicalProperties",
    ];
    let eddies = turbulence::files(setup, "").into_iter();
    let eddies = eddies
        .map(|file| file.0)
        // A template's own options stay beside.
        .filter(|name| *name != "constant/fvOptions");
    let species = setup.properties.species().iter();
    let species = species.map(|name| format!("0/{name}"));
    let names = always.into_iter().chain(eddies).map(str::to_owned);
    names.chain(species).collect()
}

/// The files of a folder, by name; none where there is no such folder.
fn files(folder: &Path) -> Vec<PathBuf> {
    let entries = fs::read_dir(folder).into_iter().flatten();
    let paths = entries.filter_map(|entry| entry.ok().map(|entry| entry.path()));
    let mut files: Vec<PathBuf> = paths.filter(|path| path.is_file()).collect();
    files.sort();
    files
}

fn look(
    file: &str,
    read: &Dictionary,
    solver: StockSolver,
    note: &mut impl FnMut(Option<usize>, String, &str),
) {
    let needed = NEEDED.iter().filter(|(name, _)| *name == file);
    for name in needed.flat_map(|(_, names)| names.iter()) {
        if read.lacks(name) {
            let remedy = "add it, or leave the file out: Calcine writes one that suits the case";
            note(None, format!("it has no `{name}`"), remedy);
        }
    }
    match file {
        "system/fvSolution" if !solver.is_stock() => solution(read, note),
        "system/fvSchemes" if !solver.is_stock() => times(read, note),
        "constant/turbulenceProperties" => turbulence_model(read, note),
        _ => {}
    }
}

fn solution(read: &Dictionary, note: &mut impl FnMut(Option<usize>, String, &str)) {
    for name in LOOPS {
        if let Some((_, line)) = read.dictionary(name) {
            let remedy = "remove it, and state outer_iterations, pressure_corrections and outer_tolerance in `gas.controls`";
            note(
                Some(line),
                format!("`{name}` has no effect in calcineGasFoam"),
                remedy,
            );
        }
    }
    if let Some((factors, line)) = read.dictionary("relaxationFactors")
        && !factors.entries().is_empty()
    {
        let what = "`relaxationFactors` have no effect in calcineGasFoam".to_owned();
        note(Some(line), what, "remove them");
    }
}

fn times(read: &Dictionary, note: &mut impl FnMut(Option<usize>, String, &str)) {
    let Some((times, _)) = read.dictionary("ddtSchemes") else {
        return;
    };
    for entry in times.entries() {
        let Value::Words(words) = &entry.value else {
            continue;
        };
        let [scheme, ..] = &words[..] else {
            continue;
        };
        let plain = !scheme.starts_with(['$', '#']);
        if plain && !TIMES.contains(&scheme.as_str()) {
            let what = format!(
                "`{} {scheme}` of ddtSchemes has no effect in calcineGasFoam, which steps in time itself",
                entry.keyword
            );
            note(
                Some(entry.line),
                what,
                "remove it, and state `gas.controls.time_scheme`",
            );
        }
    }
}

fn turbulence_model(read: &Dictionary, note: &mut impl FnMut(Option<usize>, String, &str)) {
    let names = KINDS.join(", ");
    let Some(entry) = read.entry("simulationType") else {
        if read.lacks("simulationType") {
            let what = "it has no `simulationType`".to_owned();
            note(
                None,
                what,
                &format!("write `simulationType` with one of {names}"),
            );
        }
        return;
    };
    let Value::Words(words) = &entry.value else {
        let what = "`simulationType` is a dictionary".to_owned();
        note(Some(entry.line), what, &format!("write one of {names}"));
        return;
    };
    let kind = words.first().map(String::as_str).unwrap_or_default();
    if kind.starts_with(['$', '#']) {
        return;
    }
    if !KINDS.contains(&kind) {
        let what = format!("`simulationType {kind}` is no kind of turbulence model");
        note(Some(entry.line), what, &format!("write one of {names}"));
        return;
    }
    if kind == "laminar" {
        return;
    }
    let model = format!("{kind}Model");
    match read.dictionary(kind) {
        None if read.lacks(kind) => {
            let remedy = format!("add it with `{model}`, or write `simulationType laminar`");
            note(
                Some(entry.line),
                format!("it has no dictionary `{kind}`"),
                &remedy,
            );
        }
        Some((inner, line)) if inner.lacks(&model) && inner.lacks("model") => {
            note(
                Some(line),
                format!("`{kind}` names no `{model}`"),
                "name the model",
            );
        }
        _ => {}
    }
}
