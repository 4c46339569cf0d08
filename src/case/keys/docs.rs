//! The reference part of the docs' page of a kind of case, made from the keys and the laws.

use calcine_coupler::physics::law::{LawParameter, LawSummary, LawTable};

use super::describe::number_words;
use super::key::{KeyPresence, KeyValue};
use super::kinds::CaseKind;
use super::placed::{PlacedKey, keys};
use crate::laws::LawCatalogue;

/// Where the part of a page that is made from the keys begins.
pub const BEGIN: &str = "## All keys\n";

const HEAD: &str = "
Made from the declarations that the reader works with. A required key is so where its table is there; `NAME` is a
name that you choose; entries of lists count from 0, `--set \"particles[0].diameter=9 mm\"`, or go by their `name`,
`--set \"feeds.charge.mass_rate=2 kg/h\"`.
";

const TABLE: &str =
    "| Key | Value | Required, or default | Meaning | Example |\n|---|---|---|---|---|\n";

const LAWS: &str = "
### Laws

What a case may choose by `law`, and the keys that go with it.
";

/// The last part of a kind's page, from [`BEGIN`] on.
pub fn markdown(kind: &CaseKind) -> String {
    let laws = &LawCatalogue::default();
    let mut text = format!("{BEGIN}{HEAD}");
    text.push_str("\n### The file\n\n");
    text.push_str(TABLE);
    for placed in &keys(kind, laws) {
        let PlacedKey { place, key, .. } = placed;
        let section = !place.contains('.') && !key.below(laws).is_empty();
        if section {
            text.push_str(&format!("\n### `{place}`\n\n{TABLE}"));
        }
        text.push_str(&format!(
            "| `{place}` | {} | {} | {} | `{}` |\n",
            key.value.words(laws),
            presence(placed),
            placed.meaning(),
            placed.example(laws)
        ));
    }
    text.push_str(LAWS);
    for (family, entries) in (kind.families)(laws) {
        text.push_str(&format!(
            "\n#### `{family}`\n\n| Law | What | Keys | Source |\n|---|---|---|---|\n"
        ));
        for law in &entries {
            text.push_str(&row(law));
        }
    }
    text
}

fn row(law: &LawSummary) -> String {
    let mut keys = Vec::new();
    names("", law.parameters, law.tables, &mut keys);
    let keys = if keys.is_empty() {
        "–".to_owned()
    } else {
        keys.join(", ")
    };
    let source = if law.source.is_empty() {
        "–"
    } else {
        law.source
    };
    format!("| `{}` | {} | {keys} | {source} |\n", law.name, law.summary)
}

/// The dotted names of a law's keys; of a table those that are in it.
fn names(above: &str, parameters: &[LawParameter], tables: &[LawTable], keys: &mut Vec<String>) {
    let numbers = parameters.iter();
    keys.extend(numbers.map(|one| format!("`{above}{}`", one.name)));
    for table in tables {
        match table.by_name {
            Some(_) => keys.push(format!("`{above}{}`", table.name)),
            None => {
                let within = format!("{above}{}.", table.name);
                names(&within, table.parameters, table.tables, keys);
            }
        }
    }
}

/// What stands in the docs for the need of a key, or for what holds without it.
pub(in crate::case) fn presence(placed: &PlacedKey) -> String {
    let key = &placed.key;
    match (key.presence, key.value) {
        (KeyPresence::Required, _) => "required".into(),
        (KeyPresence::OneOf, _) => "one of".into(),
        (
            KeyPresence::Default(word),
            KeyValue::Choice(_) | KeyValue::Choices(_) | KeyValue::Either(KeyValue::Choice(_), _),
        ) => {
            format!("`{word}`")
        }
        (KeyPresence::Default(text) | KeyPresence::Without(text), _) => text.into(),
        (KeyPresence::With(other), _) => format!("goes with `{other}`"),
        (KeyPresence::OfLaw(Some(value)), KeyValue::Number(dimension, _)) => {
            number_words(value, dimension)
        }
        (KeyPresence::OfLaw(_), _) => {
            let laws: Vec<String> = placed.laws.iter().map(|law| format!("`{law}`")).collect();
            format!("required with {}", laws.join(", "))
        }
    }
}
