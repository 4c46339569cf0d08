//! Tables in which a law of a family is chosen: `drag = { law = "ergun-wen-yu" }`.

use calcine_coupler::physics::law::{LawChoice, LawEntry, NONE};

use super::TableReader;
use super::words::quoted;

impl<'a> TableReader<'a> {
    /// The law that a table below names, with the values of its keys, and the table for keys of its own; the caller
    /// finishes it.
    pub fn law<L: ?Sized>(
        &self,
        key: &str,
        laws: &[&'static LawEntry<L>],
    ) -> Option<(Option<LawChoice<L>>, TableReader<'a>)> {
        let table = self.table(key)?;
        let names: Vec<&str> = laws.iter().map(|law| law.name).collect();
        let name = table.word("law", &names);
        let entry = name.and_then(|name| laws.iter().find(|law| law.name == name).copied());
        // Keys of other laws are known, so that they are told by their law.
        for parameter in laws.iter().flat_map(|law| law.parameters) {
            let own =
                entry.is_none_or(|law| law.parameters.iter().any(|one| one.name == parameter.name));
            if table.has(parameter.name) && !own {
                let takes = laws.iter().filter(|law| {
                    let mut parameters = law.parameters.iter();
                    parameters.any(|one| one.name == parameter.name)
                });
                let takes: Vec<&str> = takes.map(|law| law.name).collect();
                let chosen = entry.map_or("", |law| law.name);
                let rule = format!("does not go with law = \"{chosen}\"");
                let help = format!("remove it, or write law = {}", quoted(&takes));
                table.fail(parameter.name, rule, help);
            }
        }
        let choice = entry.and_then(|law| {
            let values: Vec<Option<f64>> = law
                .parameters
                .iter()
                .map(|parameter| {
                    if parameter.default.is_none() {
                        table.need(parameter.name);
                    }
                    table.number(parameter.name)
                })
                .collect();
            let values: Option<Vec<f64>> = values.into_iter().collect();
            Some(LawChoice::new(law, values?))
        });
        Some((choice, table))
    }

    /// A law without keys of its own that a key of this table names.
    pub fn named_law<L: ?Sized>(
        &self,
        key: &str,
        laws: &[&'static LawEntry<L>],
    ) -> Option<LawChoice<L>> {
        let names: Vec<&str> = laws.iter().map(|law| law.name).collect();
        LawChoice::named(laws, self.word(key, &names)?, Vec::new())
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
