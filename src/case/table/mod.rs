//! Walking a case file: reads keys as they are declared, records every error, notices keys that are not declared.

use std::borrow::Cow;
use std::cell::RefCell;
use std::collections::BTreeSet;
use std::ops::Range;

use toml_edit::{Item, TableLike};

use super::keys::{Key, KeyPresence, KeyValue, ROOT};
use super::problem::Problem;
use crate::laws::LawCatalogue;

mod law;
mod nearest;
mod nested;
mod quantity;
mod words;

use nearest::nearest;

/// What is said of a key that is not declared.
pub(super) const UNKNOWN: &str = " is not a key of a case";

/// Collects the problems of one file.
#[derive(Debug, Default)]
pub struct Problems {
    found: RefCell<Vec<Problem>>,
    told: RefCell<BTreeSet<(usize, String)>>,
    asked: RefCell<BTreeSet<String>>,
}

impl Problems {
    /// Records one; what was said of a place already is not said again.
    pub fn add(&self, span: Range<usize>, message: String, help: String) {
        if !self.told.borrow_mut().insert((span.start, message.clone())) {
            return;
        }
        self.found.borrow_mut().push(Problem {
            message,
            help,
            span,
            line: 0,
        });
    }

    /// All of them.
    pub fn take(&self) -> Vec<Problem> {
        self.found.take()
    }

    /// Every key that the reader asked for; names chosen by the user as `NAME`.
    #[cfg(test)]
    pub fn asked(&self) -> BTreeSet<String> {
        self.asked.take()
    }
}

/// A table of the file, with its place and the keys that are declared for it.
pub struct TableReader<'a> {
    problems: &'a Problems,
    laws: &'a LawCatalogue,
    table: &'a dyn TableLike,
    keys: Cow<'static, [Key]>,
    place: String,
    /// The place as the declarations have it: `materials.NAME`, `particles`.
    pattern: String,
    span: Range<usize>,
    asked: RefCell<Vec<String>>,
}

impl<'a> TableReader<'a> {
    /// The whole file, for a case that may choose among these laws.
    pub fn root(problems: &'a Problems, laws: &'a LawCatalogue, table: &'a dyn TableLike) -> Self {
        Self {
            problems,
            laws,
            table,
            keys: Cow::Borrowed(ROOT),
            place: String::new(),
            pattern: String::new(),
            span: 0..0,
            asked: RefCell::default(),
        }
    }

    /// The laws that the case may choose among.
    pub fn laws(&self) -> &'a LawCatalogue {
        self.laws
    }

    /// Dotted name of a key in this table.
    pub fn place_of(&self, key: &str) -> String {
        dotted(&self.place, key)
    }

    /// Where a key (with its value) stands, or this table where it is missing.
    pub fn span_of(&self, key: &str) -> Range<usize> {
        self.table
            .get(key)
            .and_then(Item::span)
            .unwrap_or_else(|| self.span.clone())
    }

    /// Records an error about the value of a key.
    pub fn fail(&self, key: &str, rule: impl AsRef<str>, help: impl Into<String>) {
        let message = format!("`{}` {}", self.place_of(key), rule.as_ref());
        self.problems.add(self.span_of(key), message, help.into());
    }

    /// Records an error about this table as a whole.
    pub fn fail_whole(&self, rule: &str, help: &str) {
        let message = format!("`{}` {rule}", self.place);
        self.problems.add(self.span.clone(), message, help.into());
    }

    /// The declaration of a key. That there is one is this program's own affair: a test asks every reader.
    fn declared(&self, key: &str) -> Option<Key> {
        let found = self.keys.iter().find(|one| one.name == key);
        if found.is_none() {
            let help = "report it: this is a fault of Calcine, not of the case";
            self.fail(key, "is asked for but not declared", help);
        }
        found.copied()
    }

    /// The declaration of a key where one of the values that it may be is as wanted.
    fn declared_as<T>(
        &self,
        key: &str,
        wanted: impl Fn(KeyValue) -> Option<T>,
    ) -> Option<(Key, T)> {
        let declared = self.declared(key)?;
        let found = declared.value.alternatives().into_iter().find_map(wanted);
        if found.is_none() {
            let help = "report it: this is a fault of Calcine, not of the case";
            self.fail(key, "is read as something else than it is declared", help);
        }
        Some((declared, found?))
    }

    /// The value of a key, which counts as asked for.
    fn item(&self, key: &str) -> Option<&'a Item> {
        self.asked.borrow_mut().push(key.into());
        let asked = dotted(&self.pattern, key);
        self.problems.asked.borrow_mut().insert(asked);
        self.table.get(key)
    }

    /// The value of a declared key; an error where it is missing and must be there.
    fn item_of(&self, key: &Key) -> Option<&'a Item> {
        let item = self.item(key.name);
        if item.is_none() && key.presence == KeyPresence::Required {
            self.missing(key.name);
        }
        item
    }

    /// True where the key is there; the key counts as known.
    pub fn has(&self, key: &str) -> bool {
        self.declared(key).is_some() && self.item(key).is_some()
    }

    /// Records that a key is missing, which is needed here.
    pub fn missing(&self, key: &str) {
        let found = self.keys.iter().find(|one| one.name == key);
        let example = match found {
            Some(Key {
                value: KeyValue::LawName(family),
                ..
            }) => {
                let first = family(self.laws).first().map_or("none", |law| law.name);
                format!("\"{first}\"")
            }
            Some(key) => key.example.to_owned(),
            None => String::new(),
        };
        self.missing_like(key, &example);
    }

    /// Records that a key of the user's own name is missing.
    pub fn missing_like(&self, key: &str, example: &str) {
        let message = format!("`{}` is missing", self.place_of(key));
        // The heading of a table, such as [mesh], stands by itself.
        let help = match example.starts_with('[') && !example.contains(['"', ',', '{']) {
            true => format!("add {example}"),
            false => format!("add it, for example {key} = {example}"),
        };
        self.problems.add(self.span.clone(), message, help);
    }

    /// Records that a key is missing unless it is there.
    pub fn need(&self, key: &str) {
        if !self.has(key) {
            self.missing(key);
        }
    }

    fn wrong_type(&self, key: &str, needs: &str, item: &Item) {
        self.fail(
            key,
            format!("needs {needs}, but is {}", kind(item)),
            format!("write {needs}"),
        );
    }

    /// Of the keys that exclude each other the one that is there; an error where there is none, or more.
    pub fn exactly_one(&self) -> Option<&'static str> {
        let exclusive = self
            .keys
            .iter()
            .filter(|key| key.presence == KeyPresence::OneOf);
        let exclusive: Vec<&Key> = exclusive.collect();
        let given = exclusive.iter().filter(|key| self.has(key.name));
        let given: Vec<&&Key> = given.collect();
        if let [one] = given[..] {
            return Some(one.name);
        }
        let names: Vec<&str> = exclusive.iter().map(|key| key.name).collect();
        let (names, example) = match (&names[..], exclusive.first()) {
            ([others @ .., last], Some(first)) => (
                format!("{} and {last}", others.join(", ")),
                format!("for example {} = {}", first.name, first.example),
            ),
            _ => Default::default(),
        };
        self.fail_whole(&format!("needs exactly one of {names}"), &example);
        None
    }

    /// Reports every key that is not declared, or that has no effect beside the others. Call it after all keys
    /// were read.
    pub fn finish(&self) {
        let asked = self.asked.borrow();
        for (key, item) in self.table.iter() {
            if asked.iter().any(|name| name == key) {
                continue;
            }
            let declared = self.keys.iter().find(|one| one.name == key);
            let (rule, help) = match declared.map(|one| one.presence) {
                Some(KeyPresence::With(other)) => (
                    " has no effect here",
                    format!("remove it: it goes with `{other}`"),
                ),
                Some(_) => {
                    let help = "remove it: it belongs to another choice than this table's";
                    (" has no effect here", help.into())
                }
                None => (UNKNOWN, self.instead_of(key)),
            };
            let place = self.table.get_key_value(key);
            let span = place
                .and_then(|(key, _)| key.span())
                .or_else(|| item.span());
            let span = span.unwrap_or_else(|| self.span.clone());
            let message = format!("`{}`{rule}", self.place_of(key));
            self.problems.add(span, message, help);
        }
    }

    /// What to do about a key that is not declared.
    fn instead_of(&self, key: &str) -> String {
        let mut names: Vec<&str> = self.keys.iter().map(|one| one.name).collect();
        match nearest(key, names.iter().copied()) {
            Some(near) => format!("did you mean `{near}`?"),
            None if names.is_empty() => "remove it".into(),
            None => {
                names.sort_unstable();
                format!("remove it; known here: {}", names.join(", "))
            }
        }
    }
}

fn dotted(place: &str, key: &str) -> String {
    if place.is_empty() {
        key.into()
    } else {
        format!("{place}.{key}")
    }
}

fn kind(item: &Item) -> String {
    match item.as_value() {
        Some(value) => format!("{} ({})", value.type_name(), value.to_string().trim()),
        None => item.type_name().into(),
    }
}
