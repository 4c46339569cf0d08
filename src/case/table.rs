//! Walking a case file: reads keys, records every error, notices keys that nobody asked for.

use std::cell::RefCell;
use std::collections::BTreeSet;
use std::ops::Range;

use calcine_coupler::setup::Schedule;
use toml_edit::{Item, TableLike, Value};

use super::problem::Problem;
use super::units::{Dimension, UnitError, quantities};

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
pub struct Reader<'a> {
    problems: &'a Problems,
    table: &'a dyn TableLike,
    place: String,
    /// The place as the table of keys writes it: `materials.NAME`, `particles`.
    pattern: String,
    span: Range<usize>,
    known: RefCell<Vec<String>>,
}

impl<'a> Reader<'a> {
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

    /// A text.
    pub fn text(&self, key: &str) -> Option<&'a str> {
        let item = self.item(key)?;
        let text = item.as_str();
        if text.is_none() {
            self.wrong_type(key, "a text in quotes", item);
        }
        text
    }

    /// A text that must be there.
    pub fn required_text(&self, key: &str, example: &str) -> Option<&'a str> {
        if !self.has(key) {
            self.missing(key, example);
        }
        self.text(key)
    }

    /// One of several words.
    pub fn choice<T: Copy>(&self, key: &str, choices: &[(&str, T)]) -> Option<T> {
        let text = self.text(key)?;
        let found = choices
            .iter()
            .find(|(name, _)| *name == text)
            .map(|(_, value)| *value);
        if found.is_none() {
            let names: Vec<&str> = choices.iter().map(|(name, _)| *name).collect();
            let near = nearest(text, names.iter().copied());
            let hint = near
                .map(|name| format!("; did you mean \"{name}\"?"))
                .unwrap_or_default();
            self.fail(
                key,
                format!("is \"{text}\""),
                format!("it may be {}{hint}", quoted(&names)),
            );
        }
        found
    }

    /// One of several words that must be there.
    pub fn required_choice<T: Copy>(&self, key: &str, choices: &[(&str, T)]) -> Option<T> {
        if !self.has(key) {
            let example = choices.first().map_or("", |(name, _)| name);
            self.missing(key, &format!("\"{example}\""));
        }
        self.choice(key, choices)
    }

    /// A whole number in a range.
    pub fn whole(&self, key: &str, range: std::ops::RangeInclusive<i64>) -> Option<u64> {
        let item = self.item(key)?;
        match item.as_integer() {
            Some(number) if range.contains(&number) => u64::try_from(number).ok(),
            Some(number) => {
                let rule = format!("is {number}");
                let help = format!("it must lie between {} and {}", range.start(), range.end());
                self.fail(key, rule, help);
                None
            }
            None => {
                self.wrong_type(key, "a whole number", item);
                None
            }
        }
    }

    /// Several whole numbers, at least 1 each.
    pub fn wholes<const N: usize>(&self, key: &str) -> Option<[usize; N]> {
        let Some(item) = self.item(key) else {
            self.missing(key, &format!("[{}]", vec!["10"; N].join(", ")));
            return None;
        };
        let numbers: Option<Vec<usize>> = item.as_array().and_then(|array| {
            array
                .iter()
                .map(|value| {
                    value
                        .as_integer()
                        .and_then(|n| usize::try_from(n).ok())
                        .filter(|n| (1..=1 << 32).contains(n))
                })
                .collect()
        });
        let numbers = numbers.and_then(|numbers| <[usize; N]>::try_from(numbers).ok());
        if numbers.is_none() {
            self.fail(
                key,
                format!("needs {N} whole numbers of at least 1"),
                format!("for example [{}]", vec!["10"; N].join(", ")),
            );
        }
        numbers
    }

    /// A list of texts.
    pub fn texts(&self, key: &str) -> Option<Vec<String>> {
        let item = self.item(key)?;
        let texts: Option<Vec<String>> = item.as_array().and_then(|array| {
            array
                .iter()
                .map(|value| value.as_str().map(str::to_owned))
                .collect()
        });
        if texts.is_none() {
            self.wrong_type(key, "a list of texts such as [\"temperature\"]", item);
        }
        texts
    }

    /// A quantity with its unit, in SI.
    pub fn quantity(&self, key: &str, dimension: Dimension) -> Option<f64> {
        let item = self.item(key)?;
        match item.as_value() {
            Some(value) => self.value(key, value, dimension),
            None => {
                self.wrong_type(
                    key,
                    &format!("{} such as \"{}\"", dimension.words(), dimension.example()),
                    item,
                );
                None
            }
        }
    }

    /// A quantity that must be there.
    pub fn required_quantity(&self, key: &str, dimension: Dimension) -> Option<f64> {
        if !self.has(key) {
            self.missing(key, &format!("\"{}\"", dimension.example()));
        }
        self.quantity(key, dimension)
    }

    /// A quantity above zero.
    pub fn positive(&self, key: &str, dimension: Dimension) -> Option<f64> {
        self.quantity(key, dimension)
            .and_then(|value| self.above_zero(key, value))
    }

    /// A quantity above zero that must be there.
    pub fn required_positive(&self, key: &str, dimension: Dimension) -> Option<f64> {
        self.required_quantity(key, dimension)
            .and_then(|value| self.above_zero(key, value))
    }

    fn above_zero(&self, key: &str, value: f64) -> Option<f64> {
        if value > 0.0 {
            return Some(value);
        }
        self.fail(
            key,
            format!("is {value} (in SI units)"),
            "it must be above zero",
        );
        None
    }

    /// A wall time above zero.
    pub fn wall_time(&self, key: &str) -> Option<std::time::Duration> {
        let seconds = self.positive(key, Dimension::TIME)?;
        let time = std::time::Duration::try_from_secs_f64(seconds).ok();
        if time.is_none() {
            self.fail(
                key,
                format!("is {seconds:e} s, beyond any clock"),
                "write a shorter time",
            );
        }
        time
    }

    /// Three components with one unit: "x y z unit".
    pub fn vector(&self, key: &str, dimension: Dimension) -> Option<[f64; 3]> {
        let item = self.item(key)?;
        let example = dimension
            .example()
            .split_once(' ')
            .map_or("", |(_, unit)| unit);
        let needs = format!("three numbers and a unit such as \"0 0 1 {example}\"");
        let Some(text) = item.as_str() else {
            self.wrong_type(key, &needs, item);
            return None;
        };
        let numbers = self.parsed(key, text, dimension)?;
        let vector = <[f64; 3]>::try_from(numbers.as_slice()).ok();
        if vector.is_none() {
            self.fail(
                key,
                format!("has {} numbers in \"{text}\"", numbers.len()),
                format!("write {needs}"),
            );
        }
        vector
    }

    /// A vector that must be there.
    pub fn required_vector(&self, key: &str, dimension: Dimension) -> Option<[f64; 3]> {
        if !self.has(key) {
            let unit = dimension
                .example()
                .split_once(' ')
                .map_or("", |(_, unit)| unit);
            self.missing(key, &format!("\"0 0 1 {unit}\""));
        }
        self.vector(key, dimension)
    }

    /// A value, or a list of [time, value] with increasing times.
    pub fn schedule(&self, key: &str, dimension: Dimension) -> Option<Schedule> {
        let Some(item) = self.item(key) else {
            self.missing(key, &format!("\"{}\"", dimension.example()));
            return None;
        };
        let Some(array) = item.as_array() else {
            return self.quantity(key, dimension).map(Schedule::constant);
        };
        let mut entries: Vec<(f64, f64)> = Vec::new();
        for entry in array {
            let pair = entry.as_array().filter(|pair| pair.len() == 2);
            let Some((time, value)) = pair.and_then(|pair| Some((pair.get(0)?, pair.get(1)?)))
            else {
                let example = format!(
                    "[[\"0 s\", \"{0}\"], [\"10 s\", \"{0}\"]]",
                    dimension.example()
                );
                self.fail(
                    key,
                    "needs pairs of time and value",
                    format!("for example {example}"),
                );
                return None;
            };
            let time = self.value(key, time, Dimension::TIME)?;
            let value = self.value(key, value, dimension)?;
            if entries.last().is_some_and(|last| last.0 >= time) {
                self.fail(
                    key,
                    format!("has the time {time} s after a later or equal one"),
                    "the times must increase",
                );
                return None;
            }
            entries.push((time, value));
        }
        if entries.is_empty() {
            self.fail(
                key,
                "is an empty schedule",
                "write at least one pair of time and value",
            );
            return None;
        }
        Some(Schedule(entries))
    }

    /// A schedule of absolute temperatures.
    pub fn temperatures(&self, key: &str) -> Option<Schedule> {
        let schedule = self.schedule(key, Dimension::TEMPERATURE)?;
        if let Some((_, value)) = schedule.0.iter().find(|entry| entry.1 <= 0.0) {
            self.fail(
                key,
                format!("is {value} K"),
                "temperatures are absolute: above 0 K",
            );
            return None;
        }
        Some(schedule)
    }

    /// One value of a key (or of an entry of its list) as a quantity.
    pub fn value(&self, key: &str, value: &Value, dimension: Dimension) -> Option<f64> {
        let example = dimension.example();
        let plain = value
            .as_float()
            .or_else(|| value.as_integer().map(|number| number as f64));
        if let Some(number) = plain {
            if dimension == Dimension::NONE && number.is_finite() {
                return Some(number);
            }
            self.fail(
                key,
                format!("needs a unit, for example \"{example}\""),
                format!("{number} has none: write it in quotes with a unit"),
            );
            return None;
        }
        let Some(text) = value.as_str() else {
            let rule = format!(
                "needs {} such as \"{example}\", but is {}",
                dimension.words(),
                value.type_name()
            );
            self.fail(key, rule, format!("write \"{example}\""));
            return None;
        };
        let numbers = self.parsed(key, text, dimension)?;
        if let [number] = numbers[..] {
            return Some(number);
        }
        self.fail(
            key,
            format!("has {} numbers in \"{text}\"", numbers.len()),
            format!("write one, for example \"{example}\""),
        );
        None
    }

    fn parsed(&self, key: &str, text: &str, dimension: Dimension) -> Option<Vec<f64>> {
        let (words, example) = (dimension.words(), dimension.example());
        match quantities(text) {
            Ok((numbers, found)) if found == dimension => return Some(numbers),
            Ok((_, Dimension::NONE)) => self.fail(
                key,
                format!("needs a unit, for example \"{example}\""),
                format!("\"{text}\" has none"),
            ),
            Ok((_, found)) => self.fail(
                key,
                format!(
                    "needs {words} such as \"{example}\", but \"{text}\" is {}",
                    found.words()
                ),
                format!("write {words}"),
            ),
            Err(UnitError::Unknown(unit)) => self.fail(
                key,
                format!("has the unit \"{unit}\", which is not known"),
                format!("it needs {words} such as \"{example}\""),
            ),
            Err(UnitError::Number(text)) => self.fail(
                key,
                format!("needs {words} such as \"{example}\", but \"{text}\" has no finite number"),
                "write a number and a unit",
            ),
        }
        None
    }

    /// A list or single value as it stands, for forms of its own.
    pub fn raw(&self, key: &str) -> Option<&'a Item> {
        self.item(key)
    }

    /// A table below a key.
    pub fn table(&self, key: &str) -> Option<Reader<'a>> {
        let item = self.item(key)?;
        let Some(table) = item.as_table_like() else {
            self.wrong_type(key, "a table", item);
            return None;
        };
        Some(self.below(self.place_of(key), key, table, item.span()))
    }

    /// A table that must be there.
    pub fn required_table(&self, key: &str, example: &str) -> Option<Reader<'a>> {
        if !self.has(key) {
            let message = format!("`{}` is missing", self.place_of(key));
            self.problems.add(
                self.span.clone(),
                message,
                format!("add it, for example {example}"),
            );
        }
        self.table(key)
    }

    /// All tables of a list such as `[[particles]]`.
    pub fn tables(&self, key: &str) -> Vec<Reader<'a>> {
        let Some(item) = self.item(key) else {
            return Vec::new();
        };
        if let Some(list) = item.as_array_of_tables() {
            let tables = list.iter().enumerate();
            return tables
                .map(|(i, table)| {
                    self.below(
                        format!("{}[{i}]", self.place_of(key)),
                        key,
                        table,
                        table.span(),
                    )
                })
                .collect();
        }
        let inline = item.as_array().map(|array| {
            array
                .iter()
                .map(Value::as_inline_table)
                .collect::<Option<Vec<_>>>()
        });
        if let Some(Some(list)) = inline {
            let tables = list.into_iter().enumerate();
            return tables
                .map(|(i, table)| {
                    self.below(
                        format!("{}[{i}]", self.place_of(key)),
                        key,
                        table,
                        table.span(),
                    )
                })
                .collect();
        }
        self.wrong_type(
            key,
            &format!("a list of tables: [[{}]]", self.place_of(key)),
            item,
        );
        Vec::new()
    }

    /// Tables below this one by name, in the order of the file, such as `[materials.glass]`.
    pub fn named(&self) -> Vec<(String, Reader<'a>)> {
        let mut found = Vec::new();
        for (name, item) in self.table.iter() {
            self.known.borrow_mut().push(name.into());
            match item.as_table_like() {
                Some(table) => found.push((
                    name.to_owned(),
                    self.below(self.place_of(name), "NAME", table, item.span()),
                )),
                None => self.wrong_type(name, "a table", item),
            }
        }
        found
    }

    fn below(
        &self,
        place: String,
        key: &str,
        table: &'a dyn TableLike,
        span: Option<Range<usize>>,
    ) -> Reader<'a> {
        let span = span.unwrap_or_else(|| self.span.clone());
        Reader {
            problems: self.problems,
            table,
            place,
            pattern: dotted(&self.pattern, key),
            span,
            known: RefCell::default(),
        }
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

fn quoted(names: &[&str]) -> String {
    names
        .iter()
        .map(|name| format!("\"{name}\""))
        .collect::<Vec<_>>()
        .join(", ")
}

/// The nearest of several names, if it is near enough to be meant.
fn nearest<'n>(word: &str, names: impl Iterator<Item = &'n str>) -> Option<&'n str> {
    let limit = 1 + word.chars().count() / 4;
    names
        .map(|name| (distance(word, name), name))
        .filter(|(distance, _)| *distance <= limit)
        .min()
        .map(|(_, name)| name)
}

/// Levenshtein's distance.
fn distance(a: &str, b: &str) -> usize {
    let b: Vec<char> = b.chars().collect();
    let mut row: Vec<usize> = (0..=b.len()).collect();
    for (i, x) in a.chars().enumerate() {
        let mut diagonal = row[0];
        row[0] = i + 1;
        for (j, y) in b.iter().enumerate() {
            let changed = diagonal + usize::from(x != *y);
            diagonal = row[j + 1];
            row[j + 1] = changed.min(row[j] + 1).min(diagonal + 1);
        }
    }
    row[b.len()]
}
