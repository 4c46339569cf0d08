//! Walking a case file: reads keys as they are declared, records every error, notices keys that are not declared.

use std::borrow::Cow;
use std::cell::RefCell;
use std::collections::BTreeSet;
use std::ops::Range;

use toml_edit::{Item, TableLike, Value};

use super::keys::{CaseKind, Key, KeyPresence, KeyValue};
use super::problem::Problem;
use crate::laws::LawCatalogue;

mod absent;
mod consequences;
mod law;
mod nearest;
mod nested;
mod quantity;
mod words;

pub(super) use absent::{NO_DRYING, is_moisture};
use consequences::{beside, follows, names, uses};
pub(super) use nearest::{instead_of_file, nearest};

/// What is said of a key that is not declared.
pub(super) const UNKNOWN: &str = "is not a key of a case";
/// Most places at which a key stands elsewhere that are named.
const MOST_PLACES: usize = 3;
/// What is said of a key that goes with another choice.
const NO_EFFECT: &str = "has no effect here";

/// Collects the problems of one file.
#[derive(Debug, Default)]
pub struct Problems {
    found: RefCell<Vec<(Problem, ProblemKind)>>,
    told: RefCell<BTreeSet<(usize, String)>>,
    asked: RefCell<BTreeSet<String>>,
    /// Places whose values are of another kind, or have no meaning.
    unread: RefCell<BTreeSet<String>>,
    /// Places whose values can be read, but are not taken, and those of keys that are there misspelt.
    refused: RefCell<BTreeSet<String>>,
    /// Sections of which nothing could be made.
    unusable: RefCell<BTreeSet<String>>,
    /// Values that are no finite numbers; whatever else may be said of them is left out.
    spoilt: RefCell<Vec<Range<usize>>>,
}

/// What a problem is about.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum ProblemKind {
    /// A place whose value cannot be read, is missing, or is not known.
    Value,
    /// A rule that values which were read break at this place.
    Rule(String),
    /// A key at this place that goes with another choice of its table.
    Idle(String),
    /// A key that something else needs.
    Missing(String),
}

impl Problems {
    /// Records one; what was said of a place already is not said again.
    fn add(&self, span: Range<usize>, message: String, help: String, kind: ProblemKind) {
        let inside = |spoilt: &Range<usize>| spoilt.contains(&span.start) || spoilt == &span;
        let holds = |spoilt: &Range<usize>| span.start <= spoilt.start && spoilt.end <= span.end;
        let of_whole = kind == ProblemKind::Value;
        let spoilt = self.spoilt.borrow();
        if spoilt
            .iter()
            .any(|one| inside(one) || of_whole && holds(one))
        {
            return;
        }
        drop(spoilt);
        if !self.told.borrow_mut().insert((span.start, message.clone())) {
            return;
        }
        let problem = Problem {
            message,
            help,
            span,
            line: 0,
        };
        self.found.borrow_mut().push((problem, kind));
    }

    /// Records every number of a table, and of all that is in it, that is not finite.
    pub fn not_finite(&self, place: &str, table: &dyn TableLike) {
        for (key, item) in table.iter() {
            let place = dotted(place, key);
            if let Some(list) = item.as_array_of_tables() {
                for (index, table) in list.iter().enumerate() {
                    self.not_finite(&format!("{place}[{index}]"), table);
                }
            } else if let Some(value) = item.as_value() {
                self.not_finite_value(&place, value);
            } else if let Some(table) = item.as_table_like() {
                self.not_finite(&place, table);
            }
        }
    }

    fn not_finite_value(&self, place: &str, value: &Value) {
        match value {
            Value::Float(number) if !number.value().is_finite() => {
                let span = value.span().unwrap_or(0..0);
                let text = value.to_string();
                let message = format!("`{place}` is {}, not a finite number", text.trim());
                let help = "write a finite number".into();
                self.unread.borrow_mut().insert(place.to_owned());
                self.add(span.clone(), message, help, ProblemKind::Value);
                self.spoilt.borrow_mut().push(span);
            }
            Value::Array(array) => {
                for (index, value) in array.iter().enumerate() {
                    self.not_finite_value(&format!("{place}[{index}]"), value);
                }
            }
            Value::InlineTable(table) => self.not_finite(place, table),
            _ => {}
        }
    }

    /// All of them but those that only follow from values that could not be read.
    pub fn take(&self) -> Vec<Problem> {
        let (unread, unusable) = (self.unread.take(), self.unusable.take());
        let refused = self.refused.take();
        let only_follows = |place: &str, message: &str| {
            unusable.iter().any(|other| uses(place, other))
                || unread.iter().any(|other| follows(place, other))
                || refused.iter().any(|other| names(place, message, other))
        };
        let mut found = self.found.take();
        found.retain(|(problem, kind)| match kind {
            ProblemKind::Value => true,
            ProblemKind::Rule(place) => !only_follows(place, &problem.message),
            ProblemKind::Idle(place) => {
                let chosen = refused.iter().any(|other| beside(place, other));
                !chosen && !only_follows(place, &problem.message)
            }
            ProblemKind::Missing(place) => !unread.contains(place) && !refused.contains(place),
        });
        found.into_iter().map(|(problem, _)| problem).collect()
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
    /// The keys of the whole file.
    file: &'static [Key],
    keys: Cow<'static, [Key]>,
    place: String,
    /// The place as the declarations have it: `materials.NAME`, `particles`.
    pattern: String,
    span: Range<usize>,
    asked: RefCell<Vec<String>>,
}

impl<'a> TableReader<'a> {
    /// The whole file, for a case of a kind that may choose among these laws.
    pub fn root(
        problems: &'a Problems,
        kind: &CaseKind,
        laws: &'a LawCatalogue,
        table: &'a dyn TableLike,
    ) -> Self {
        Self {
            problems,
            laws,
            table,
            file: kind.keys,
            keys: Cow::Borrowed(kind.keys),
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

    /// Records a rule that the value of a key breaks.
    pub fn fail(&self, key: &str, rule: impl AsRef<str>, help: impl Into<String>) {
        let place = self.place_of(key);
        let message = format!("`{place}` {}", rule.as_ref());
        let kind = ProblemKind::Rule(place);
        self.problems
            .add(self.span_of(key), message, help.into(), kind);
    }

    /// Records that the value of a key cannot be read; checks that use it are left out.
    fn unread(&self, key: &str, rule: impl AsRef<str>, help: impl Into<String>) {
        let place = self.place_of(key);
        let message = format!("`{place}` {}", rule.as_ref());
        self.problems.unread.borrow_mut().insert(place);
        let kind = ProblemKind::Value;
        self.problems
            .add(self.span_of(key), message, help.into(), kind);
    }

    /// Records that the value of a key, which can be read, is not taken.
    fn refuse(&self, key: &str, rule: impl AsRef<str>, help: impl Into<String>) {
        let place = self.place_of(key);
        let message = format!("`{place}` {}", rule.as_ref());
        self.problems.refused.borrow_mut().insert(place);
        let kind = ProblemKind::Value;
        self.problems
            .add(self.span_of(key), message, help.into(), kind);
    }

    /// Leaves out the checks that use a section, of which something is wrong that was told.
    pub fn unusable(&self, section: &str) {
        let mut unusable = self.problems.unusable.borrow_mut();
        unusable.insert(section.to_owned());
    }

    /// Records an error about this table as a whole.
    pub fn fail_whole(&self, rule: &str, help: &str) {
        let message = format!("`{}` {rule}", self.place);
        let kind = ProblemKind::Rule(self.place.clone());
        self.problems
            .add(self.span.clone(), message, help.into(), kind);
    }

    /// The declaration of a key. That there is one is this program's own affair: a test asks every reader.
    fn declared(&self, key: &str) -> Option<Key> {
        let found = self.keys.iter().find(|one| one.name == key);
        if found.is_none() {
            let help = "report it: this is a fault of Calcine, not of the case";
            self.unread(key, "is asked for but not declared", help);
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
        let found = declared
            .value
            .alternatives(self.laws)
            .into_iter()
            .find_map(wanted);
        if found.is_none() {
            let help = "report it: this is a fault of Calcine, not of the case";
            self.unread(key, "is read as something else than it is declared", help);
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
        let place = self.place_of(key);
        let message = format!("`{place}` is missing");
        // The heading of a table, such as [mesh], stands by itself.
        let help = match example.starts_with('[') && !example.contains(['"', ',', '{']) {
            true => format!("add {example}"),
            false => format!("add it, for example {key} = {example}"),
        };
        let kind = ProblemKind::Missing(place);
        self.problems.add(self.span.clone(), message, help, kind);
    }

    /// Records that a key is missing unless it is there.
    pub fn need(&self, key: &str) {
        if !self.has(key) {
            self.missing(key);
        }
    }

    /// An example of a key, as the end of a help that has none yet.
    fn like(&self, key: &str, needs: &str) -> String {
        let declared = self.keys.iter().find(|one| one.name == key);
        let example = declared.map_or("", |one| one.example);
        let is_value =
            !example.is_empty() && !example.starts_with('[') && !needs.contains("such as");
        match is_value {
            true => format!(", for example {key} = {example}"),
            false => String::new(),
        }
    }

    fn wrong_type(&self, key: &str, needs: &str, item: &Item) {
        self.unread(
            key,
            format!("needs {needs}, but is {}", kind(item)),
            format!("write {needs}{}", self.like(key, needs)),
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
                Some(KeyPresence::With(other)) => {
                    (NO_EFFECT, format!("remove it: it goes with `{other}`"))
                }
                Some(_) => {
                    let help = "remove it: it belongs to another choice than this table's";
                    (NO_EFFECT, help.into())
                }
                None => {
                    self.stands_for_missing(key);
                    let help = self.elsewhere(key).unwrap_or_else(|| self.instead_of(key));
                    (UNKNOWN, help)
                }
            };
            let is_known = declared.is_some();
            let drying = !is_known && self.pattern.starts_with("materials") && is_moisture(key);
            let (rule, help) = match drying {
                true => (NO_DRYING[0], NO_DRYING[1].into()),
                false => (rule, help),
            };
            let place = self.table.get_key_value(key);
            let span = place
                .and_then(|(key, _)| key.span())
                .or_else(|| item.span());
            let span = span.unwrap_or_else(|| self.span.clone());
            let place = self.place_of(key);
            let message = format!("`{place}` {rule}");
            let kind = match is_known {
                true => ProblemKind::Idle(place),
                false => ProblemKind::Value,
            };
            self.problems.add(span, message, help, kind);
        }
    }

    /// Where a key that is not declared is near a declared one which is not there, that one is not told as missing too.
    fn stands_for_missing(&self, key: &str) {
        let absent = self.keys.iter().map(|one| one.name);
        let absent = absent.filter(|name| self.table.get(name).is_none());
        if let Some(near) = nearest(key, absent) {
            let mut refused = self.problems.refused.borrow_mut();
            refused.insert(self.place_of(near));
        }
    }

    /// Where a key stands that is not declared here, where it is a key of other tables near the top.
    fn elsewhere(&self, key: &str) -> Option<String> {
        let misspelt = nearest(key, self.keys.iter().map(|one| one.name)).is_some();
        let mut places = Vec::new();
        for section in self.file {
            if section.name == key {
                places.push(key.to_owned());
            }
            for below in section.below(self.laws) {
                let own = dotted(section.name, below.name);
                if below.name == key {
                    places.push(own.clone());
                }
                let deeper = below.below(self.laws);
                if deeper.iter().any(|one| one.name == key) {
                    places.push(dotted(&own, key));
                }
            }
        }
        let few = !misspelt && (1..=MOST_PLACES).contains(&places.len());
        few.then(|| format!("it is a key of another table: `{}`", places.join("`, `")))
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

pub(in crate::case) fn dotted(place: &str, key: &str) -> String {
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
