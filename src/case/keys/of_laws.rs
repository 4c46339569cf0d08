//! Keys that laws declare: those of all laws of a family, in one table.

use calcine_coupler::physics::law::{LawParameter, LawSummary, LawTable};

use super::key::{Key, KeyPresence, KeyValue};
use super::law_path::{LawFamily, LawPath};
use crate::laws::LawCatalogue;

/// What a law declares of a key.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Declared {
    Number(&'static LawParameter),
    Table(&'static LawTable),
}

impl Declared {
    fn name(&self) -> &'static str {
        match self {
            Self::Number(parameter) => parameter.name,
            Self::Table(table) => table.name,
        }
    }

    fn meaning(&self) -> &'static str {
        match self {
            Self::Number(parameter) => parameter.meaning,
            Self::Table(table) => table.meaning,
        }
    }

    /// The key of a law alone.
    fn key(&self, family: LawFamily, path: LawPath) -> Key {
        match self {
            Self::Number(parameter) => Key::of_parameter(parameter),
            Self::Table(table) => Key {
                name: table.name,
                value: match table.by_name {
                    Some(dimension) => KeyValue::ByName(dimension),
                    None => KeyValue::LawTable(family, path),
                },
                presence: match table.required {
                    true => KeyPresence::OfLaw(None),
                    false => KeyPresence::Without("none"),
                },
                meaning: table.meaning,
                example: table.example,
            },
        }
    }

    /// True where both say the same of the key; tables may hold different keys.
    fn is_like(&self, other: &Self) -> bool {
        match (self, other) {
            (Self::Number(one), Self::Number(other)) => one == other,
            (Self::Table(one), Self::Table(other)) => {
                let said = |table: &LawTable| (table.meaning, table.by_name, table.required);
                said(one) == said(other)
            }
            _ => false,
        }
    }
}

/// What a law declares in its table at a path; `None` where it has no such table.
fn declared(law: &LawSummary, path: &[&str]) -> Option<Vec<Declared>> {
    let (mut parameters, mut tables) = (law.parameters, law.tables);
    for name in path {
        let table = tables.iter().find(|table| table.name == *name)?;
        if table.by_name.is_some() {
            return None;
        }
        (parameters, tables) = (table.parameters, table.tables);
    }
    let numbers = parameters.iter().map(Declared::Number);
    Some(numbers.chain(tables.iter().map(Declared::Table)).collect())
}

/// The keys of a family's table at a path, and how many laws have the table.
fn level(laws: &[LawSummary], path: &[&str]) -> Vec<(&'static str, Vec<Declared>)> {
    let of = |law: &LawSummary| Some((law.name, declared(law, path)?));
    laws.iter().filter_map(of).collect()
}

/// What laws declare of the key at a path.
fn of_key(laws: &[LawSummary], path: LawPath) -> Vec<(&'static str, Declared)> {
    let Some((name, above)) = path.names().split_last() else {
        return Vec::new();
    };
    let of = |(law, keys): (&'static str, Vec<Declared>)| {
        let key = keys.into_iter().find(|key| key.name() == *name);
        key.map(|key| (law, key))
    };
    level(laws, above).into_iter().filter_map(of).collect()
}

/// The keys of all laws of a family in the table at a path.
pub(super) fn keys(family: LawFamily, known: &LawCatalogue, path: LawPath) -> Vec<Key> {
    let laws = family(known);
    let level = level(&laws, path.names());
    let mut keys: Vec<Key> = Vec::new();
    for one in level.iter().flat_map(|(_, keys)| keys) {
        let Some(at) = path.with(one.name()) else {
            continue;
        };
        if keys.iter().any(|key| key.name == one.name()) {
            continue;
        }
        let all = of_key(&laws, at);
        let mut key = one.key(family, at);
        let needs =
            |declared: &Declared| declared.key(family, at).presence == KeyPresence::OfLaw(None);
        let needing = all.iter().filter(|(_, declared)| needs(declared)).count();
        if needing == level.len() {
            key.presence = KeyPresence::Required;
        } else if needing > 0 {
            key.presence = KeyPresence::OfLaw(None);
        }
        if !all.iter().all(|(_, other)| one.is_like(other)) {
            key.value = KeyValue::OfLaws(family, at);
            if needing == 0 {
                key.presence = KeyPresence::Without("as the law has it");
            }
        }
        keys.push(key);
    }
    keys
}

/// The values that a key may have with one law or another.
pub(super) fn values(family: LawFamily, known: &LawCatalogue, path: LawPath) -> Vec<KeyValue> {
    let declared = of_key(&family(known), path);
    let values = declared.iter().map(|(_, one)| one.key(family, path).value);
    values.collect()
}

/// What a key means with each law.
pub(super) fn meaning(family: LawFamily, known: &LawCatalogue, path: LawPath) -> String {
    let mut told: Vec<(&str, Vec<String>)> = Vec::new();
    for (law, declared) in of_key(&family(known), path) {
        let law = format!("`{law}`");
        match told.iter_mut().find(|one| one.0 == declared.meaning()) {
            Some((_, laws)) => laws.push(law),
            None => told.push((declared.meaning(), vec![law])),
        }
    }
    let sentence = |(meaning, laws): (&str, Vec<String>)| {
        let laws = laws.join(", ");
        let bare = meaning.trim_end_matches('.');
        format!("With {laws}: {bare}.")
    };
    let told: Vec<String> = told.into_iter().map(sentence).collect();
    told.join(" ")
}

/// The laws that take a key of the table at a path; none where all that have the table do, or where it is no law's.
pub(super) fn takers(
    family: LawFamily,
    known: &LawCatalogue,
    path: LawPath,
    name: &'static str,
) -> Vec<&'static str> {
    let laws = family(known);
    let all = path.with(name).map(|path| of_key(&laws, path));
    let all = all.unwrap_or_default();
    match all.len() == level(&laws, path.names()).len() {
        true => Vec::new(),
        false => all.into_iter().map(|(law, _)| law).collect(),
    }
}
