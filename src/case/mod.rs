//! Case files: TOML to a checked [`model::Case`].

mod bed;
pub mod buoyancy;
pub mod cautions;
mod check;
pub mod contacts;
pub mod expectations;
pub mod keys;
mod located;
mod meshing;
pub mod model;
mod overlap;
mod place;
mod place_error;
mod problem;
mod ranges;
pub mod schema;
mod sections;
pub mod sizes;
mod step;
mod stl;
mod table;
pub mod units;
mod words;

use std::path::Path;

use sha2::{Digest, Sha256};
use toml_edit::{Document, DocumentMut, Item, Value};

pub use check::check_report;
pub use located::located;
pub use meshing::{MeshingError, mesh};
pub use place::{InitialParticles, particles};
pub use place_error::PlaceError;
pub use problem::{CaseErrors, Problem};
pub use step::settle;

use calcine_coupler::motion::WallShape;
use model::Case;
use table::{Problems, TableReader};

use crate::laws::LawCatalogue;

/// Reads and checks a case file with `--set key=value` applied; all its errors at once.
pub fn read(path: &Path, set: &[String]) -> Result<Case, CaseErrors> {
    read_with(path, set, &LawCatalogue::default())
}

/// Reads a case file that may choose among these laws.
pub fn read_with(path: &Path, set: &[String], laws: &LawCatalogue) -> Result<Case, CaseErrors> {
    let bytes = std::fs::read(path).map_err(|cause| {
        one(
            path,
            "",
            0..0,
            format!("the case file cannot be read: {cause}"),
            &table::instead_of_file(path),
        )
    })?;
    let text = String::from_utf8(bytes).map_err(|error| not_utf8(path, &error))?;
    parse_with(path, &text, set, laws)
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
    let (effective, keys) = apply(path, text, set)?;
    let document = syntax(path, &effective)?;
    let problems = Problems::default();
    problems.not_finite("", document.as_table());
    let root = TableReader::root(&problems, laws, document.as_table());
    let case = sections::case(&root, path, &effective, hash(document.as_table()));
    root.finish();
    let mut problems = problems.take();
    for problem in &mut problems {
        let mut given = set.iter().zip(&keys).rev();
        if let Some((setting, _)) = given.find(|(_, key)| blamed(problem, key)) {
            problem.message = format!("`--set {setting}`: {}", problem.message);
        }
    }
    match case {
        Some(mut case) if problems.is_empty() => {
            case.hash = with_files(&case);
            Ok(case)
        }
        _ if problems.is_empty() => {
            let message = "the case could not be read, but nothing says why".into();
            let help = "report it: this is a fault of Calcine, not of the case";
            Err(one(path, &effective, 0..0, message, help))
        }
        _ => Err(CaseErrors::new(path, &effective, problems)),
    }
}

fn one(
    path: &Path,
    text: &str,
    span: std::ops::Range<usize>,
    message: String,
    help: &str,
) -> CaseErrors {
    let problem = Problem {
        message,
        help: help.into(),
        span,
        line: 0,
    };
    CaseErrors::new(path, text, vec![problem])
}

fn syntax<'t>(path: &Path, text: &'t str) -> Result<Document<&'t str>, CaseErrors> {
    Document::parse(text).map_err(|error| {
        let message = format!("not TOML: {}", error.message().replace('\n', ", "));
        one(
            path,
            text,
            error.span().unwrap_or(0..0),
            message,
            "see toml.io for the syntax",
        )
    })
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

/// The text with `--set` applied, in which lines stay where they are unless a key is new; and the key that each changed,
/// entries of lists by their numbers.
fn apply(path: &Path, text: &str, set: &[String]) -> Result<(String, Vec<String>), CaseErrors> {
    if set.is_empty() {
        return Ok((text.to_owned(), Vec::new()));
    }
    let mut keys = Vec::new();
    syntax(path, text)?;
    let mut document: DocumentMut = text.parse().map_err(|error: toml_edit::TomlError| {
        one(path, text, 0..0, error.to_string(), "see toml.io")
    })?;
    for setting in set {
        let wrong = |why: &str, help: &str| {
            let message = format!("`--set {setting}`: {why}");
            one(path, text, 0..0, message, help)
        };
        let (key, value) = setting.split_once('=').ok_or_else(|| {
            let help = "write it as --set time.acceleration=200";
            wrong("there is no `=`", help)
        })?;
        let value = value.trim();
        // A bare text such as 10 s or native needs no quotes on the command line.
        let value: Value = value.parse().unwrap_or_else(|_| value.into());
        let mut item: &mut Item = document.as_item_mut();
        let mut place = String::new();
        for part in key.trim().split('.') {
            let help = entries(item, &place);
            if let Some(index) = entry(item, part) {
                place.push_str(&format!("[{index}]"));
            } else {
                place = table::dotted(&place, part);
            }
            item = step(item, part)
                .ok_or_else(|| wrong(&format!("there is no `{part}` to change"), &help))?;
        }
        *item = Item::Value(value);
        keys.push(place);
    }
    Ok((document.to_string(), keys))
}

/// One step down a dotted key; `name[2]` steps into a list, and so does the name of one of its entries.
fn step<'i>(item: &'i mut Item, part: &str) -> Option<&'i mut Item> {
    if let Some(index) = entry(item, part) {
        return item.get_mut(index);
    }
    let (name, index) = match part.strip_suffix(']').and_then(|part| part.split_once('[')) {
        Some((name, index)) => (name, Some(index.parse::<usize>().ok()?)),
        None => (part, None),
    };
    if name.is_empty() {
        return None;
    }
    let table = item.as_table_like_mut()?;
    if index.is_some() && !table.contains_key(name) {
        return None;
    }
    let below = table.entry(name).or_insert(Item::None);
    match index {
        None if below.is_none() => {
            *below = Item::Value(Value::InlineTable(toml_edit::InlineTable::new()));
            Some(below)
        }
        None => Some(below),
        Some(index) => below.get_mut(index),
    }
}

/// The entry of a list that has this name.
fn entry(list: &Item, name: &str) -> Option<usize> {
    let named = |own: Option<&str>| own == Some(name);
    if let Some(tables) = list.as_array_of_tables() {
        let mut tables = tables.iter();
        return tables.position(|one| named(one.get("name").and_then(Item::as_str)));
    }
    let mut values = list.as_array()?.iter();
    values.position(|one| {
        let table = one.as_inline_table();
        named(
            table
                .and_then(|table| table.get("name"))
                .and_then(Value::as_str),
        )
    })
}

/// What a key may be in place of one that is not there: the entries of a list.
fn entries(item: &Item, key: &str) -> String {
    let count = match (item.as_array_of_tables(), item.as_array()) {
        (Some(tables), _) => tables.len(),
        (None, Some(values)) => values.len(),
        (None, None) => return "write it as --set time.acceleration=200".into(),
    };
    let last = count.saturating_sub(1);
    format!("`{key}` is a list: name one of its entries, or write {key}[0] to {key}[{last}]")
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
