//! The files of a run that are open while it goes on.

use crate::results::ResultsError;
use crate::results::probe::Site;
use crate::results::series::{Row, Table};
use crate::results::store::Store;
use crate::results::vtk::Cells;

/// So many rows are gathered before they go to the HDF5 file.
const BATCH: usize = 256;

/// What exists once the first moment is known.
pub(super) struct Open {
    pub table: Table,
    pub sites: Vec<Site>,
    pub cells: Cells,
    /// Rows not yet in the HDF5 file.
    pub pending: Vec<Row>,
    pub store: Store,
}

impl Open {
    /// Keeps a row for the HDF5 file.
    pub fn keep(&mut self, row: Row) -> Result<(), ResultsError> {
        self.pending.push(row);
        if self.pending.len() >= BATCH {
            self.flush()?;
        }
        Ok(())
    }

    /// Writes all rows that are kept.
    pub fn flush(&mut self) -> Result<(), ResultsError> {
        self.store.append(&self.pending)?;
        self.pending.clear();
        self.store.flush()?;
        self.table.flush()
    }
}
