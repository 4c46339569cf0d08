//! Tables below a table: one by its key, lists of them, those named by the user.

use std::borrow::Cow;
use std::cell::RefCell;
use std::ops::Range;
use std::sync::LazyLock;

use toml_edit::{Item, TableLike, Value};

use super::{Key, KeyPresence, KeyValue, TableReader, dotted};
use crate::case::units::Dimension;

/// What stands for a table that a case leaves out.
static EMPTY: LazyLock<toml_edit::Table> = LazyLock::new(toml_edit::Table::new);

/// Numbers by names of the user's, in the order of the file.
type NamedNumbers = Vec<(String, f64)>;

impl<'a> TableReader<'a> {
    /// A list or single value as it stands, for forms of its own.
    pub fn raw(&self, key: &str) -> Option<&'a Item> {
        self.item_of(&self.declared(key)?)
    }

    /// True where the value of a key, which may be something else too, is a table.
    pub fn is_table(&self, key: &str) -> bool {
        self.has(key)
            && self
                .table
                .get(key)
                .is_some_and(|item| item.as_table_like().is_some())
    }

    /// A table below a key.
    pub fn table(&self, key: &str) -> Option<TableReader<'a>> {
        let (declared, ()) = self.declared_as(key, |value| match value {
            KeyValue::Table(_)
            | KeyValue::Named(_)
            | KeyValue::ByName(_)
            | KeyValue::Law(..)
            | KeyValue::LawTable(..) => Some(()),
            _ => None,
        })?;
        let item = self.item_of(&declared)?;
        let Some(table) = item.as_table_like() else {
            let needs = match (
                declared.value.alternatives(self.laws).first(),
                item.as_str(),
            ) {
                (Some(KeyValue::Law(..)), Some(name)) => {
                    format!("a table such as {{ law = \"{name}\" }}")
                }
                _ => "a table".into(),
            };
            self.wrong_type(key, &needs, item);
            return None;
        };
        Some(self.below(self.place_of(key), key, &declared, table, item.span()))
    }

    /// A table below a key, or one without keys: then its defaults hold.
    pub fn table_or_empty(&self, key: &str) -> Option<TableReader<'a>> {
        if self.has(key) {
            return self.table(key);
        }
        let declared = self.declared(key)?;
        let span = Some(self.span.clone());
        Some(self.below(self.place_of(key), key, &declared, &*EMPTY, span))
    }

    /// All tables of a list such as `[[particles]]`.
    pub fn tables(&self, key: &str) -> Vec<TableReader<'a>> {
        let declared = self.declared_as(key, |value| {
            matches!(value, KeyValue::Tables(_)).then_some(())
        });
        let Some((declared, ())) = declared else {
            return Vec::new();
        };
        let Some(item) = self.item_of(&declared) else {
            return Vec::new();
        };
        let inline = item.as_array().map(|array| array.is_empty());
        let listed = item.as_array_of_tables().map(|list| list.is_empty());
        if inline.or(listed) == Some(true) && declared.presence == KeyPresence::Required {
            let help = format!("add one: [[{}]]", self.place_of(key));
            self.unread(key, "is an empty list", help);
            return Vec::new();
        }
        let reader = |index: usize, table: &'a dyn TableLike, span| {
            let place = format!("{}[{index}]", self.place_of(key));
            self.below(place, key, &declared, table, span)
        };
        if let Some(list) = item.as_array_of_tables() {
            let tables = list.iter().enumerate();
            return tables
                .map(|(index, table)| reader(index, table, table.span()))
                .collect();
        }
        let inline = item.as_array().map(|array| {
            let tables = array.iter().map(Value::as_inline_table);
            tables.collect::<Option<Vec<_>>>()
        });
        if let Some(Some(list)) = inline {
            let tables = list.into_iter().enumerate();
            return tables
                .map(|(index, table)| reader(index, table, table.span()))
                .collect();
        }
        let needs = format!("a list of tables: [[{}]]", self.place_of(key));
        self.wrong_type(key, &needs, item);
        Vec::new()
    }

    /// Tables below this one by name, in the order of the file, such as `[materials.glass]`.
    pub fn named(&self) -> Vec<(String, TableReader<'a>)> {
        let mut found = Vec::new();
        for (name, item) in self.table.iter() {
            self.asked.borrow_mut().push(name.into());
            match item.as_table_like() {
                Some(table) => {
                    let span = item.span().unwrap_or_else(|| self.span.clone());
                    let reader = TableReader {
                        keys: self.keys.clone(),
                        ..self.reader(
                            self.place_of(name),
                            dotted(&self.pattern, "NAME"),
                            table,
                            span,
                        )
                    };
                    found.push((name.to_owned(), reader));
                }
                None => self.wrong_type(name, "a table", item),
            }
        }
        found
    }

    /// True where there is an entry of a name that the user chooses, whatever it holds.
    pub fn has_named(&self, name: &str) -> bool {
        self.table.contains_key(name)
    }

    /// A table at a time of 0 s, or a list of [time, table] with increasing times in s.
    pub fn dated_tables(&self, key: &str) -> Option<Vec<(f64, TableReader<'a>)>> {
        let (declared, ()) = self.declared_as(key, |value| {
            matches!(value, KeyValue::Dated(_)).then_some(())
        })?;
        let item = self.item_of(&declared)?;
        let Some(array) = item.as_array() else {
            let Some(table) = item.as_table_like() else {
                self.wrong_type(key, "a table", item);
                return None;
            };
            let reader = self.below(self.place_of(key), key, &declared, table, item.span());
            return Some(vec![(0.0, reader)]);
        };
        let mut found: Vec<(f64, TableReader<'a>)> = Vec::new();
        for (i, entry) in array.iter().enumerate() {
            let pair = entry.as_array().filter(|pair| pair.len() == 2);
            let pair = pair.and_then(|pair| Some((pair.get(0)?, pair.get(1)?.as_inline_table()?)));
            let Some((time, table)) = pair else {
                let help = format!("for example {}", declared.example);
                self.unread(key, "needs a table, or pairs of time and table", help);
                return None;
            };
            let time = self.value(key, time, Dimension::TIME)?;
            if found.last().is_some_and(|(last, _)| *last >= time) {
                self.refuse(
                    key,
                    format!("has the time {time} s after a later or equal one"),
                    "the times must increase",
                );
                return None;
            }
            let place = format!("{}[{i}]", self.place_of(key));
            found.push((time, self.below(place, key, &declared, table, table.span())));
        }
        if found.is_empty() {
            let help = "write at least one pair of time and table";
            self.refuse(key, "is an empty schedule", help);
            return None;
        }
        Some(found)
    }

    /// All numbers of a table whose keys are names of the user's, with the table; quantities where it is declared so.
    pub fn by_name(&self, key: &str) -> Option<(TableReader<'a>, Option<NamedNumbers>)> {
        let (_, dimension) = self.declared_as(key, |value| match value {
            KeyValue::ByName(dimension) => Some(dimension),
            _ => None,
        })?;
        let table = self.table(key)?;
        let numbers = table.all(dimension);
        Some((table, numbers))
    }

    /// All numbers of this table, whose keys are names of the user's.
    pub(super) fn all(&self, dimension: Dimension) -> Option<NamedNumbers> {
        let mut found = Vec::new();
        for (name, item) in self.table.iter() {
            self.asked.borrow_mut().push(name.into());
            if let Some(rest) = item.as_table_like().and_then(dots) {
                let whole = format!("{name}.{rest}");
                let rule = "is a table: a dot in a name without quotes parts it";
                self.unread(name, rule, format!("write the name in quotes: \"{whole}\""));
                return None;
            }
            let number = item
                .as_float()
                .or_else(|| item.as_integer().map(|n| n as f64));
            let value = match (dimension, number, item.as_value()) {
                (Dimension::NONE, Some(number), _) => number,
                (Dimension::NONE, None, _) => {
                    self.wrong_type(name, "a number", item);
                    return None;
                }
                (_, _, Some(value)) => self.value(name, value, dimension)?,
                (_, _, None) => {
                    self.wrong_type(name, "a quantity", item);
                    return None;
                }
            };
            found.push((name.to_owned(), value));
        }
        Some(found)
    }

    fn below(
        &self,
        place: String,
        key: &str,
        declared: &Key,
        table: &'a dyn TableLike,
        span: Option<Range<usize>>,
    ) -> TableReader<'a> {
        let span = span.unwrap_or_else(|| self.span.clone());
        TableReader {
            keys: Cow::Owned(declared.below(self.laws)),
            ..self.reader(place, dotted(&self.pattern, key), table, span)
        }
    }

    fn reader(
        &self,
        place: String,
        pattern: String,
        table: &'a dyn TableLike,
        span: Range<usize>,
    ) -> TableReader<'a> {
        TableReader {
            problems: self.problems,
            laws: self.laws,
            table,
            file: self.file,
            keys: Cow::Borrowed(&[]),
            place,
            pattern,
            span,
            asked: RefCell::default(),
        }
    }
}

/// The rest of a name that TOML has parted at its dots, where a table comes of that.
fn dots(table: &dyn TableLike) -> Option<String> {
    let mut entries = table.iter();
    let (name, item) = entries.next().filter(|_| table.is_dotted())?;
    let rest = item.as_table_like().and_then(dots);
    let one = entries.next().is_none();
    one.then(|| rest.map_or(name.to_owned(), |rest| format!("{name}.{rest}")))
}
