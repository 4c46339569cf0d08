//! `cargo xtask bench stock`: what a simulated second costs in Calcine's pairings and in programs that are in use, on one core
//! and the same bed: DPMFoam and MPPICFoam by Debian's tutorials, LIGGGHTS and pimpleFoam by themselves.

mod beads;
mod comparison;
mod gas;
mod parcels;
mod particles;
mod programs;
mod still;

use crate::packages::{self, Needs};
use crate::steps::{TaskResult, say};
use crate::table::Table;
use crate::tasks::{self, BuildScope};
use crate::workspace::Workspace;

/// Measures one table.
type Measure = fn(&Workspace) -> TaskResult<Table>;

/// The tables by their names.
const TABLES: [(&str, Measure); 7] = [
    ("beads", beads::table),
    ("fluidised", beads::fluidised),
    ("still", still::table),
    ("parcels", parcels::coarse),
    ("parcels-fine", parcels::fine),
    ("particles", particles::table),
    ("gas", gas::table),
];

/// What is asked for.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct StockChoice {
    /// Names of tables; all of them if there are none.
    pub names: Vec<String>,
    /// Measures the programs that were built last.
    pub built: bool,
}

impl StockChoice {
    /// From the words behind `stock`; nothing where one is neither a table nor an option.
    pub fn read<'w>(words: impl Iterator<Item = Option<&'w str>>) -> Option<Self> {
        let mut choice = Self::default();
        for word in words {
            match word? {
                "--no-build" => choice.built = true,
                name if TABLES.iter().any(|(table, _)| *table == name) => {
                    choice.names.push(name.to_owned());
                }
                _ => return None,
            }
        }
        Some(choice)
    }
}

/// Builds unless told not to, measures, and prints the tables.
pub fn run(workspace: &Workspace, choice: &StockChoice) -> TaskResult<()> {
    let needs = Needs {
        openfoam: true,
        liggghts: true,
        examples: true,
        ..Needs::NATIVE
    };
    packages::install(needs, &workspace.logs)?;
    if !choice.built {
        let _lock = workspace.lock()?;
        tasks::build_parts(workspace, needs, BuildScope::Runs)?;
    }
    let wanted = |name: &str| choice.names.is_empty() || choice.names.iter().any(|n| n == name);
    for (_, measure) in TABLES.iter().filter(|(name, _)| wanted(name)) {
        let table = measure(workspace)?;
        say(&format!("\n{table}"));
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tables_are_chosen_by_name() {
        let read = |line: &str| StockChoice::read(line.split_whitespace().map(Some));
        let choice = read("beads gas --no-build").unwrap();
        assert_eq!(choice.names, ["beads", "gas"]);
        assert!(choice.built);
        assert_eq!(read(""), Some(StockChoice::default()));
        assert_eq!(read("bubbles"), None);
    }
}
