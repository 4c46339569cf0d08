//! Tables below a table: one by its key, lists of them, those named by the user.

use std::cell::RefCell;
use std::ops::Range;

use toml_edit::{Item, TableLike, Value};

use super::{TableReader, dotted};
use crate::case::units::Dimension;

impl<'a> TableReader<'a> {
    /// A list or single value as it stands, for forms of its own.
    pub fn raw(&self, key: &str) -> Option<&'a Item> {
        self.item(key)
    }

    /// A table below a key.
    pub fn table(&self, key: &str) -> Option<TableReader<'a>> {
        let item = self.item(key)?;
        let Some(table) = item.as_table_like() else {
            self.wrong_type(key, "a table", item);
            return None;
        };
        Some(self.below(self.place_of(key), key, table, item.span()))
    }

    /// A table that must be there.
    pub fn required_table(&self, key: &str, example: &str) -> Option<TableReader<'a>> {
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
    pub fn tables(&self, key: &str) -> Vec<TableReader<'a>> {
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
    pub fn named(&self) -> Vec<(String, TableReader<'a>)> {
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

    /// A table at a time of 0 s, or a list of [time, table] with increasing times in s.
    pub fn dated_tables(&self, key: &str, example: &str) -> Option<Vec<(f64, TableReader<'a>)>> {
        let item = self.item(key)?;
        let Some(array) = item.as_array() else {
            return Some(vec![(0.0, self.table(key)?)]);
        };
        let mut found: Vec<(f64, TableReader<'a>)> = Vec::new();
        for (i, entry) in array.iter().enumerate() {
            let pair = entry.as_array().filter(|pair| pair.len() == 2);
            let pair = pair.and_then(|pair| Some((pair.get(0)?, pair.get(1)?.as_inline_table()?)));
            let Some((time, table)) = pair else {
                self.fail(
                    key,
                    "needs a table, or pairs of time and table",
                    format!("for example [[\"0 s\", {example}], [\"10 s\", {example}]]"),
                );
                return None;
            };
            let time = self.value(key, time, Dimension::TIME)?;
            if found.last().is_some_and(|(last, _)| *last >= time) {
                self.fail(
                    key,
                    format!("has the time {time} s after a later or equal one"),
                    "the times must increase",
                );
                return None;
            }
            let place = format!("{}[{i}]", self.place_of(key));
            found.push((time, self.below(place, key, table, table.span())));
        }
        if found.is_empty() {
            let help = "write at least one pair of time and table";
            self.fail(key, "is an empty schedule", help);
            return None;
        }
        Some(found)
    }

    /// All numbers of a table whose keys are names of the user's.
    pub fn numbers(&self) -> Option<Vec<(String, f64)>> {
        let mut found = Vec::new();
        for (name, item) in self.table.iter() {
            self.known.borrow_mut().push(name.into());
            let number = item
                .as_float()
                .or_else(|| item.as_integer().map(|n| n as f64));
            let Some(number) = number else {
                self.wrong_type(name, "a number", item);
                return None;
            };
            found.push((name.to_owned(), number));
        }
        Some(found)
    }

    /// All quantities of a table whose keys are names of the user's.
    pub fn quantities(&self, dimension: Dimension) -> Option<Vec<(String, f64)>> {
        let mut found = Vec::new();
        for (name, item) in self.table.iter() {
            self.known.borrow_mut().push(name.into());
            let Some(value) = item.as_value() else {
                self.wrong_type(name, "a quantity", item);
                return None;
            };
            found.push((name.to_owned(), self.value(name, value, dimension)?));
        }
        Some(found)
    }

    fn below(
        &self,
        place: String,
        key: &str,
        table: &'a dyn TableLike,
        span: Option<Range<usize>>,
    ) -> TableReader<'a> {
        let span = span.unwrap_or_else(|| self.span.clone());
        TableReader {
            problems: self.problems,
            table,
            place,
            pattern: dotted(&self.pattern, key),
            span,
            known: RefCell::default(),
        }
    }
}
