//! In place of `results.h5` where Calcine is built without HDF5: nothing is written.

use std::collections::BTreeMap;
use std::path::Path;

use calcine_coupler::mesh::Mesh;
use calcine_coupler::physics::Vec3;

use super::ResultsError;
use super::moment::SnapshotMoment;
use super::probe::{Sample, Site};
use super::series::{Column, Row};
use super::snapshot::Field;
use crate::case::model::Case;

/// No file.
pub(super) struct Store;

impl Store {
    /// Begins nothing.
    pub fn create(
        _path: &Path,
        _case: &Case,
        _mesh: &Mesh,
        _columns: &[Column],
        _tracked: &[u64],
        _sites: &[Site],
    ) -> Result<Self, ResultsError> {
        Ok(Self)
    }

    /// Opens nothing.
    pub fn resume(
        _path: &Path,
        _columns: &[Column],
        _rows: usize,
        _snapshots: usize,
    ) -> Result<Self, ResultsError> {
        Ok(Self)
    }

    /// Appends nothing.
    pub fn append(&mut self, _rows: &[Row]) -> Result<(), ResultsError> {
        Ok(())
    }

    /// Writes nothing.
    pub fn snapshot(
        &mut self,
        _number: usize,
        _moment: &SnapshotMoment,
        _positions: &[Vec3],
        _gas: &[Field<'_>],
        _particles: &[Field<'_>],
        _samples: &[Sample<'_>],
    ) -> Result<(), ResultsError> {
        Ok(())
    }

    /// Writes nothing.
    pub fn means(
        &mut self,
        _interval: [f64; 3],
        _fields: &[Field<'_>],
    ) -> Result<(), ResultsError> {
        Ok(())
    }

    /// Renames nothing.
    pub fn rename(&mut self, _to: &Path) -> Result<(), ResultsError> {
        Ok(())
    }

    /// Flushes nothing.
    pub fn flush(&self) -> Result<(), ResultsError> {
        Ok(())
    }
}

/// None are known.
pub(super) fn units(_path: &Path) -> [BTreeMap<String, String>; 2] {
    Default::default()
}

/// None are known.
pub(super) fn units_of_means(_path: &Path) -> BTreeMap<String, String> {
    BTreeMap::new()
}
