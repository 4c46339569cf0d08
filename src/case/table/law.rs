//! Tables in which a law of a family is chosen: `drag = { law = "ergun-wen-yu" }`.

use calcine_coupler::physics::law::{
    LawChoice, LawEntry, LawParameter, LawSummary, LawTable, LawValues, NONE,
};

use super::words::quoted;
use super::{Key, TableReader};

/// The names of a law's keys.
fn keys(law: &LawSummary) -> impl Iterator<Item = &'static str> {
    let numbers = law.parameters.iter().map(|one| one.name);
    numbers.chain(law.tables.iter().map(|one| one.name))
}

impl<'a> TableReader<'a> {
    /// The law that a table below names, with the values of its keys, and the table for keys of its own; the caller
    /// finishes it.
    pub fn law<L: ?Sized>(
        &self,
        key: &str,
        laws: &[&'static LawEntry<L>],
    ) -> Option<(Option<LawChoice<L>>, TableReader<'a>)> {
        let table = self.table(key)?;
        Some((table.law_here(laws), table))
    }

    /// The law that this table names by its key `law`, with the values of the law's keys beside it.
    pub fn law_here<L: ?Sized>(&self, laws: &[&'static LawEntry<L>]) -> Option<LawChoice<L>> {
        let names: Vec<&str> = laws.iter().map(|law| law.name).collect();
        let name = self.word("law", &names);
        let entry = name.and_then(|name| laws.iter().find(|law| law.name == name).copied());
        let known: Vec<LawSummary> = laws.iter().map(|law| law.about()).collect();
        let Some(entry) = entry else {
            // The keys of all laws are known, whichever is meant.
            for name in known.iter().flat_map(keys) {
                self.has(name);
            }
            return None;
        };
        let values = self.law_values(&known, &entry.about())?;
        Some(LawChoice::new(entry, values))
    }

    /// The values of a law's keys in this table, and an error for each key of other laws.
    fn law_values(&self, known: &[LawSummary], law: &LawSummary) -> Option<LawValues> {
        // Keys of other laws are known, so that they are told by their law.
        for name in known.iter().flat_map(keys) {
            if self.has(name) && keys(law).all(|own| own != name) {
                let takes = known.iter().filter(|law| keys(law).any(|one| one == name));
                let takes: Vec<&str> = takes.map(|law| law.name).collect();
                let rule = format!("does not go with law = \"{}\"", law.name);
                let help = format!("remove it, or write law = {}", quoted(&takes));
                self.fail(name, rule, help);
            }
        }
        let numbers = law.parameters.iter();
        let numbers = numbers.map(|one| self.law_parameter(one, law.parameters));
        let numbers: Vec<Option<f64>> = numbers.collect();
        let tables = law.tables.iter();
        let tables = tables.map(|one| self.law_table(one, known, law));
        let tables: Vec<Option<Option<LawValues>>> = tables.collect();
        Some(LawValues {
            numbers: numbers.into_iter().collect::<Option<_>>()?,
            by_name: Vec::new(),
            tables: tables.into_iter().collect::<Option<_>>()?,
        })
    }

    fn law_parameter(&self, parameter: &LawParameter, beside: &[LawParameter]) -> Option<f64> {
        let read = |one: &LawParameter| {
            let key = Key::of_parameter(one);
            self.number_of(&key, one.dimension, one.bound)
        };
        if self.has(parameter.name) {
            return read(parameter);
        }
        let other = parameter.needed_with;
        let other = other.and_then(|name| beside.iter().find(|one| one.name == name));
        let needed = match other {
            Some(other) => read(other)? != 0.0,
            None => parameter.default.is_none(),
        };
        if needed {
            self.missing(parameter.name);
            return None;
        }
        parameter.default
    }

    /// A table of a law, `Some(None)` for one that need not be there.
    fn law_table(
        &self,
        table: &LawTable,
        known: &[LawSummary],
        law: &LawSummary,
    ) -> Option<Option<LawValues>> {
        if !self.has(table.name) {
            if table.required {
                self.missing(table.name);
                return None;
            }
            return Some(None);
        }
        let reader = self.table(table.name)?;
        if let Some(dimension) = table.by_name {
            let by_name = reader.all(dimension)?;
            return Some(Some(LawValues {
                by_name,
                ..LawValues::default()
            }));
        }
        let within = |law: &LawSummary| {
            let table = law.tables.iter().find(|one| one.name == table.name)?;
            Some(LawSummary {
                parameters: table.parameters,
                tables: table.tables,
                ..*law
            })
        };
        let known: Vec<LawSummary> = known.iter().filter_map(within).collect();
        let values = reader.law_values(&known, &within(law)?);
        reader.finish();
        values.map(Some)
    }

    /// A law whose table has no keys of its own.
    pub fn plain_law<L: ?Sized>(
        &self,
        key: &str,
        laws: &[&'static LawEntry<L>],
    ) -> Option<LawChoice<L>> {
        let (choice, table) = self.law(key, laws)?;
        table.finish();
        choice
    }

    /// A law whose table may be left out: then the one that does nothing.
    pub fn optional_law<L: ?Sized>(
        &self,
        key: &str,
        laws: &[&'static LawEntry<L>],
    ) -> Option<LawChoice<L>> {
        match self.has(key) {
            true => self.plain_law(key, laws),
            false => LawChoice::named(laws, NONE, Vec::new()),
        }
    }
}
