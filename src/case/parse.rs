//! From the text of a case file to what a reader makes of it, or to all its errors.

use calcine_coupler::regular_file;
use std::path::Path;

use sha2::{Digest, Sha256};
use toml_edit::{Item, Value};

use super::keys::CaseKind;
use super::kind::same_kind;
use super::problem::{CaseErrors, Problem};
use super::set;
use super::syntax::{one, syntax};
use super::table::{self, Problems, TableReader};
use crate::hex::hex;
use crate::laws::LawCatalogue;

/// Version of the format that the readers know.
pub(super) const FORMAT: u64 = 1;

/// Place of the title, which is for people and changes nothing of a run.
const TITLE: &str = ".title";

/// The text of a case file.
pub(super) fn text_of(path: &Path) -> Result<String, CaseErrors> {
    let bytes = regular_file::read(path).map_err(|cause| {
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

/// Checks the text of a case file of a kind by the reader of that kind, which is given the root table, the text with
/// `--set` applied and the hash of its values; what it makes, and the changes by `--set` in words.
pub(super) fn parse_as<C>(
    path: &Path,
    text: &str,
    set: &[String],
    kind: &CaseKind,
    laws: &LawCatalogue,
    read: impl FnOnce(&TableReader<'_>, &str, String) -> Option<C>,
) -> Result<(C, Vec<String>), CaseErrors> {
    same_kind(path, text, set, kind)?;
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
        _ => {
            let lines = set::lines(text, &effective);
            Err(CaseErrors::new(path, &effective, problems).numbered(lines))
        }
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

/// SHA-256 (hex) of the values, whatever their order, spacing and comments, without the title.
fn hash(table: &dyn toml_edit::TableLike) -> String {
    let mut text = String::new();
    canonical(&mut text, "", table);
    hex(Sha256::digest(text.as_bytes()))
}

fn canonical(text: &mut String, place: &str, table: &dyn toml_edit::TableLike) {
    let mut entries: Vec<(&str, &Item)> = table.iter().collect();
    entries.sort_by_key(|(key, _)| *key);
    for (key, item) in entries {
        let place = format!("{place}.{key}");
        if place == TITLE {
            continue;
        }
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
