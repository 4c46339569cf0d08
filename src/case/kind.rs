//! Of which kind a case file is: its key `kind`.

use calcine_coupler::regular_file;
use std::path::Path;

use super::keys::{CaseKind, KINDS, kind_named, kind_names};
use super::problem::CaseErrors;
use super::set;
use super::syntax::{one, syntax};
use super::table::nearest;

/// The kind of a case file, with `--set key=value` applied; a bed where it states none. A file that cannot be read
/// counts as a bed, whose reader tells why.
pub fn kind_of(path: &Path, settings: &[String]) -> Result<&'static CaseKind, CaseErrors> {
    match regular_file::read_to_string(path) {
        Ok(text) => kind_of_text(path, &text, settings),
        Err(_) => Ok(&KINDS[0]),
    }
}

/// The kind of the text of a case file; `path` places messages.
pub fn kind_of_text(
    path: &Path,
    text: &str,
    settings: &[String],
) -> Result<&'static CaseKind, CaseErrors> {
    let (effective, _) = set::apply(path, text, settings)?;
    let document = syntax(path, &effective)?;
    let Some(item) = document.get("kind") else {
        return Ok(&KINDS[0]);
    };
    let span = item.span().unwrap_or(0..0);
    let wrong = |fact: String, hint: String| {
        let names: Vec<String> = kind_names().iter().map(|n| format!("\"{n}\"")).collect();
        let help = format!("it may be {}{hint}", names.join(", "));
        one(path, &effective, span.clone(), fact, &help).numbered(set::lines(text, &effective))
    };
    let Some(name) = item.as_str() else {
        let fact = format!("`kind` needs a text in quotes, but is {}", item.type_name());
        return Err(wrong(fact, String::new()));
    };
    kind_named(name).ok_or_else(|| {
        let near = nearest(name, kind_names().into_iter());
        let hint = near.map(|near| format!("; did you mean \"{near}\"?"));
        wrong(format!("`kind` is \"{name}\""), hint.unwrap_or_default())
    })
}

/// Refuses the text of a case of another kind than is read.
pub(super) fn same_kind(
    path: &Path,
    text: &str,
    settings: &[String],
    wanted: &CaseKind,
) -> Result<(), CaseErrors> {
    let found = kind_of_text(path, text, settings)?;
    if found.name == wanted.name {
        return Ok(());
    }
    let message = format!(
        "`kind` is \"{}\", {}, where {} is read",
        found.name, found.summary, wanted.summary
    );
    let help = "run it with `calcine run`, which reads every kind";
    Err(one(path, text, 0..0, message, help))
}
