//! Walking a case file: reads keys, records every error, notices keys that nobody asked for.

use std::cell::RefCell;
use std::collections::BTreeSet;
use std::ops::Range;

use toml_edit::{Item, TableLike};

use super::problem::Problem;

mod nested;
mod quantity;
mod words;

use words::nearest;

/// What is said of a key that nobody asked for.
pub(super) const UNKNOWN: &str = " is not a key of a case";

/// Collects the problems of one file.
#[derive(Debug, Default)]
pub struct Problems {
    found: RefCell<Vec<Problem>>,
    asked: RefCell<BTreeSet<String>>,
}

impl Problems {
    /// Records one.
    pub fn add(&self, span: Range<usize>, message: String, help: String) {
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

/// A table of the file, with its place.
pub struct TableReader<'a> {
    problems: &'a Problems,
    table: &'a dyn TableLike,
    place: String,
    /// The place as the table of keys writes it: `materials.NAME`, `particles`.
    pattern: String,
    span: Range<usize>,
    known: RefCell<Vec<String>>,
}

impl<'a> TableReader<'a> {
    /// The whole file.
    pub fn root(problems: &'a Problems, table: &'a dyn TableLike) -> Self {
        Self {
            problems,
            table,
            place: String::new(),
            pattern: String::new(),
            span: 0..0,
            known: RefCell::default(),
        }
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

    fn item(&self, key: &str) -> Option<&'a Item> {
        self.known.borrow_mut().push(key.into());
        let asked = dotted(&self.pattern, key);
        self.problems.asked.borrow_mut().insert(asked);
        self.table.get(key)
    }

    /// True where the key is there; the key counts as known.
    pub fn has(&self, key: &str) -> bool {
        self.item(key).is_some()
    }

    /// Records that a key is missing.
    pub fn missing(&self, key: &str, example: &str) {
        let message = format!("`{}` is missing", self.place_of(key));
        self.problems.add(
            self.span.clone(),
            message,
            format!("add it, for example {key} = {example}"),
        );
    }

    fn wrong_type(&self, key: &str, needs: &str, item: &Item) {
        self.fail(
            key,
            format!("needs {needs}, but is {}", kind(item)),
            format!("write {needs}"),
        );
    }

    /// Reports every key that nobody asked for. Call it after all keys were read.
    pub fn finish(&self) {
        let known = self.known.borrow();
        for (key, item) in self.table.iter() {
            if known.iter().any(|name| name == key) {
                continue;
            }
            let span = self
                .table
                .get_key_value(key)
                .and_then(|(key, _)| key.span());
            let near = nearest(key, known.iter().map(String::as_str));
            let help = match near {
                Some(near) => format!("did you mean `{near}`?"),
                None if known.is_empty() => "remove it".into(),
                None => {
                    let mut names: Vec<&str> = known.iter().map(String::as_str).collect();
                    names.sort_unstable();
                    names.dedup();
                    format!("remove it; known here: {}", names.join(", "))
                }
            };
            let span = span
                .or_else(|| item.span())
                .unwrap_or_else(|| self.span.clone());
            self.problems
                .add(span, format!("`{}`{UNKNOWN}", self.place_of(key)), help);
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
