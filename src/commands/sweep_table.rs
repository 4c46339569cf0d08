//! The table of a sweep: a row for each run.

use std::fmt::Write as _;
use std::path::Path;

use super::failure::Failure;
use crate::exit;
use crate::results::files;
use crate::results::sheet::line;

/// Name of the table in the folder of a sweep.
pub(super) const TABLE: &str = "sweep.csv";

/// Names of columns, and rows of any length up to theirs.
#[derive(Clone, Debug, Default)]
pub(super) struct SweepTable {
    /// Names of the columns.
    pub(super) header: Vec<String>,
    /// Their values in each row.
    pub(super) rows: Vec<Vec<String>>,
}

impl SweepTable {
    /// Puts a value into a row, in the column of a name.
    pub(super) fn put(&mut self, row: &mut Vec<String>, name: &str, value: String) {
        // Runs of other quantities have other columns.
        let place = self.header.iter().position(|one| one == name);
        let place = place.unwrap_or_else(|| {
            self.header.push(name.to_owned());
            self.header.len() - 1
        });
        row.resize(row.len().max(place + 1), String::new());
        row[place] = value;
    }

    /// Adds a last column.
    pub(super) fn close(&mut self, name: &str, values: Vec<String>) {
        let columns = self
            .rows
            .iter()
            .map(Vec::len)
            .fold(self.header.len(), usize::max);
        self.header.resize(columns, String::new());
        self.header.push(name.to_owned());
        for (row, value) in self.rows.iter_mut().zip(values) {
            row.resize(columns, String::new());
            row.push(value);
        }
    }

    /// As Markdown.
    pub(super) fn markdown(&self) -> String {
        let lines = "---|".repeat(self.header.len());
        let mut text = format!("| {} |\n|{lines}\n", self.header.join(" | "));
        for row in &self.rows {
            let _ = writeln!(text, "| {} |", row.join(" | "));
        }
        text
    }

    /// Writes it into the folder of a sweep, at once.
    pub(super) fn write(&self, folder: &Path) -> Result<(), Failure> {
        let path = folder.join(TABLE);
        let lines = [&self.header].into_iter().chain(&self.rows);
        let text: Result<Vec<Vec<u8>>, _> = lines.map(|words| line(&path, words)).collect();
        let written = text.and_then(|text| files::replace(&path, &text.concat()));
        written.map_err(|error| Failure::told(exit::OTHER, &error))
    }
}
