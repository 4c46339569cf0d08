//! Case files: TOML to a checked [`model::Case`].

mod bed;
mod boundaries;
pub mod buoyancy;
pub mod cautions;
mod check;
pub mod contacts;
pub mod expectations;
mod flow_numbers;
mod flow_time;
mod impact;
pub mod in_wall;
pub mod keys;
mod kind;
mod located;
mod mesh_shape;
mod meshing;
pub mod model;
mod moving;
mod overlap;
pub mod packed;
mod patch_cautions;
mod place;
mod place_error;
mod problem;
mod ranges;
mod reach_cautions;
mod resolved;
mod schedules;
pub mod schema;
mod sections;
mod set;
mod size_cautions;
pub mod sizes;
mod span;
mod splitting;
mod step;
mod stl;
mod syntax;
mod table;
mod temperature_cautions;
mod time_cautions;
mod touching;
pub mod units;
mod used_up;
mod wall_cautions;
pub mod warnings;
mod words;
mod work;

use std::path::Path;

use sha2::{Digest, Sha256};
use toml_edit::{Item, Value};

pub use boundaries::mesh_of;
pub use check::check_report;
pub use kind::{kind_of, kind_of_text};
pub use located::located;
pub use meshing::{MeshingError, mesh};
pub use place::{InitialParticles, particles};
pub use place_error::PlaceError;
pub use problem::{CaseErrors, Problem};
pub use schedules::breaks;
pub use step::settle;

use calcine_coupler::motion::WallShape;
use model::Case;
use syntax::{one, syntax};
use table::{Problems, TableReader};

use crate::laws::LawCatalogue;

/// Reads and checks a case file with `--set key=value` applied; all its errors at once.
pub fn read(path: &Path, set: &[String]) -> Result<Case, CaseErrors> {
    read_with(path, set, &LawCatalogue::default())
}

/// Reads a case file that may choose among these laws.
pub fn read_with(path: &Path, set: &[String], laws: &LawCatalogue) -> Result<Case, CaseErrors> {
    parse_with(path, &text_of(path)?, set, laws)
}

/// The text of a case file.
fn text_of(path: &Path) -> Result<String, CaseErrors> {
    let bytes = std::fs::read(path).map_err(|cause| {
        one(
            path,
            "",
            0..0,
            format!("the case file cannot be read: {cause}"),
            &table::instead_of_file(path),
        )
    })?;
    String::from_utf8(bytes).map_err(|error| not_utf8(path, &error))
}

/// A case file in another encoding: the first byte that is wrong, with its line.
fn not_utf8(path: &Path, error: &std::string::FromUtf8Error) -> CaseErrors {
    let (bytes, at) = (error.as_bytes(), error.utf8_error().valid_up_to());
    let before = bytes.get(..at).unwrap_or_default();
    let line = 1 + before.iter().filter(|&&byte| byte == b'\n').count();
    let start = before.iter().rposition(|&byte| byte == b'\n');
    let column = 1 + at - start.map_or(0, |newline| newline + 1);
    let byte = bytes.get(at).copied().unwrap_or_default();
    one(
        path,
        &String::from_utf8_lossy(bytes),
        at..at + char::REPLACEMENT_CHARACTER.len_utf8(),
        format!(
            "the case file is not UTF-8: byte {column} of line {line} is 0x{byte:02X}, which is no character there"
        ),
        "save the file as UTF-8",
    )
}

/// Checks the text of a case file; `path` places relative paths and messages.
pub fn parse(path: &Path, text: &str, set: &[String]) -> Result<Case, CaseErrors> {
    parse_with(path, text, set, &LawCatalogue::default())
}

/// Checks the text of a case file that may choose among these laws.
pub fn parse_with(
    path: &Path,
    text: &str,
    set: &[String],
    laws: &LawCatalogue,
) -> Result<Case, CaseErrors> {
    let (mut case, changes) = parse_as(
        path,
        text,
        set,
        &keys::KINDS[0],
        laws,
        |root, effective, hash| sections::case(root, path, effective, hash),
    )?;
    case.hash = with_files(&case);
    case.changes = changes;
    Ok(case)
}

/// Checks the text of a case file of a kind by the reader of that kind, which is given the root table, the text with
/// `--set` applied and the hash of its values; what it makes, and the changes by `--set` in words.
fn parse_as<C>(
    path: &Path,
    text: &str,
    set: &[String],
    kind: &keys::CaseKind,
    laws: &LawCatalogue,
    read: impl FnOnce(&TableReader<'_>, &str, String) -> Option<C>,
) -> Result<(C, Vec<String>), CaseErrors> {
    kind::same_kind(path, text, set, kind)?;
    let (effective, changes) = set::apply(path, text, set)?;
    let document = syntax(path, &effective)?;
    let problems = Problems::default();
    problems.not_finite("", document.as_table());
    let root = TableReader::root(&problems, kind, laws, document.as_table());
    root.has("kind");
    let case = read(&root, &effective, hash(document.as_table()));
    root.finish();
    let mut problems = problems.take();
    for problem in &mut problems {
        let mut given = set.iter().zip(&changes).rev();
        if let Some((setting, _)) = given.find(|(_, change)| blamed(problem, &change.key)) {
            problem.message = format!("`--set {setting}`: {}", problem.message);
        }
    }
    match case {
        Some(case) if problems.is_empty() => {
            Ok((case, changes.iter().map(set::Change::line).collect()))
        }
        _ if problems.is_empty() => {
            let message = "the case could not be read, but nothing says why".into();
            let help = "report it: this is a fault of Calcine, not of the case";
            Err(one(path, &effective, 0..0, message, help))
        }
        _ => Err(CaseErrors::new(path, &effective, problems)),
    }
}

/// True where a problem is about the key of a `--set`, or about a table that it made.
fn blamed(problem: &Problem, key: &str) -> bool {
    let Some((place, rule)) = problem
        .message
        .strip_prefix('`')
        .and_then(|message| message.split_once('`'))
    else {
        return false;
    };
    let inside = |inner: &str, outer: &str| {
        inner
            .strip_prefix(outer)
            .is_some_and(|rest| rest.is_empty() || rest.starts_with(['.', '[']))
    };
    inside(place, key) || (rule.trim_start() == table::UNKNOWN && inside(key, place))
}

/// SHA-256 (hex) of the values, whatever their order, spacing and comments.
fn hash(table: &dyn toml_edit::TableLike) -> String {
    let mut text = String::new();
    canonical(&mut text, "", table);
    Sha256::digest(text.as_bytes())
        .iter()
        .map(|byte| format!("{byte:02x}"))
        .collect()
}

/// The hash extended by the contents of the files that the case names, so that a changed bed or
/// mesh is not taken for the same case.
fn with_files(case: &Case) -> String {
    let places = case
        .particles
        .iter()
        .filter_map(|population| match &population.place {
            model::PlacementSpec::File { path, .. } => Some(path.clone()),
            _ => None,
        });
    let mesh = match &case.mesh {
        model::MeshSpec::PolyMesh(folder) => ["points", "faces", "owner", "neighbour", "boundary"]
            .map(|name| folder.join(name))
            .to_vec(),
        model::MeshSpec::Box { .. } | model::MeshSpec::Cylinder { .. } => Vec::new(),
    };
    let files: Vec<_> = places
        .chain(mesh)
        .chain(case.gas_files.iter().cloned())
        .collect();
    let triangles: Vec<_> = case
        .walls
        .iter()
        .filter_map(|wall| match &wall.shape {
            WallShape::Mesh { triangles } => Some(triangles),
            _ => None,
        })
        .collect();
    if files.is_empty() && triangles.is_empty() {
        return case.hash.clone();
    }
    let mut digest = Sha256::new();
    digest.update(case.hash.as_bytes());
    for file in files {
        // A file that cannot be read is an error of the mesh or of the bed, told there.
        digest.update(std::fs::read(file).unwrap_or_default());
    }
    for corner in triangles.into_iter().flatten().flatten() {
        for value in corner.iter() {
            digest.update(value.to_le_bytes());
        }
    }
    digest
        .finalize()
        .iter()
        .map(|byte| format!("{byte:02x}"))
        .collect()
}

fn canonical(text: &mut String, place: &str, table: &dyn toml_edit::TableLike) {
    let mut entries: Vec<(&str, &Item)> = table.iter().collect();
    entries.sort_by_key(|(key, _)| *key);
    for (key, item) in entries {
        let place = format!("{place}.{key}");
        if let Some(list) = item.as_array_of_tables() {
            for (i, table) in list.iter().enumerate() {
                canonical(text, &format!("{place}[{i}]"), table);
            }
        } else if let Some(table) = item.as_table_like() {
            canonical(text, &place, table);
        } else if let Some(value) = item.as_value() {
            text.push_str(&format!("{place}={}\n", plain(value)));
        }
    }
}

/// A value without the file's spacing.
fn plain(value: &Value) -> String {
    match value {
        Value::Array(array) => {
            let parts: Vec<String> = array.iter().map(plain).collect();
            format!("[{}]", parts.join(","))
        }
        Value::InlineTable(table) => {
            let mut text = String::new();
            canonical(&mut text, "", table);
            format!("{{{text}}}")
        }
        other => {
            let mut bare = other.clone();
            bare.decor_mut().clear();
            bare.to_string()
        }
    }
}
