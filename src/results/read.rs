//! Results read back: the time series and the snapshots of a result directory.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

use super::{ResultsError, SERIES, STORE, files, sheet, store};
use crate::vtk_xml;

/// The time series of a run.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Series {
    /// Names of the columns, groups before a dot.
    pub names: Vec<String>,
    /// Units of the columns.
    pub units: Vec<String>,
    /// Values, column by column.
    pub columns: Vec<Vec<f64>>,
}

impl Series {
    /// Reads `series.csv` of a result directory; a last line cut short is left out.
    pub fn read(directory: &Path) -> Result<Self, ResultsError> {
        let path = directory.join(SERIES);
        let text = files::read(&path)?;
        // What a run that was killed wrote last may end inside a number.
        let whole = text.rfind('\n').map_or("", |end| &text[..end]);
        let mut rows = sheet::rows(&path, whole)?.into_iter();
        let mut series = Self::default();
        for head in &rows.next().unwrap_or_default() {
            let (name, unit) = head
                .strip_suffix(']')
                .and_then(|head| head.rsplit_once(" ["))
                .ok_or_else(|| ResultsError::content(&path, format!("a column is `{head}`")))?;
            series.names.push(name.into());
            series.units.push(unit.into());
        }
        series.columns = vec![Vec::new(); series.names.len()];
        for row in rows {
            let values: Vec<f64> = row.iter().map_while(|value| value.parse().ok()).collect();
            if values.len() == series.names.len() {
                for (column, value) in series.columns.iter_mut().zip(values) {
                    column.push(value);
                }
            }
        }
        Ok(series)
    }

    /// A column by its name; empty where there is none.
    pub fn column(&self, name: &str) -> &[f64] {
        let place = self.names.iter().position(|other| other == name);
        place.map_or(&[], |place| &self.columns[place])
    }

    /// The columns `particle_temperature.ID`, as (ID, values).
    pub fn particles(&self) -> Vec<(&str, &[f64])> {
        let columns = self.names.iter().zip(&self.columns);
        columns
            .filter_map(|(name, column)| {
                let id = name.strip_prefix("particle_temperature.")?;
                Some((id, column.as_slice()))
            })
            .collect()
    }
}

/// One array of a VTK file.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Array {
    /// Components per cell, point or entry.
    pub components: usize,
    /// Values; whole numbers too.
    pub values: Vec<f64>,
}

/// The arrays of a snapshot file by name: `points`, connectivity, and the fields.
pub type Arrays = BTreeMap<String, Array>;

/// False of the arrays of a snapshot file that say where things are or which, not how they are.
pub fn is_field(name: &str) -> bool {
    !name.ends_with(".lengths")
        && ![
            "points",
            "connectivity",
            "offsets",
            "types",
            "faces",
            "faceoffsets",
            "id",
            "population",
            "TimeValue",
        ]
        .contains(&name)
}

/// The snapshots of a `.pvd` file: process time in s and file.
pub fn collection(directory: &Path, name: &str) -> Result<Vec<(f64, PathBuf)>, ResultsError> {
    let path = directory.join(name);
    let entries = vtk_xml::collection(&files::read(&path)?);
    let entries = entries.map_err(|error| ResultsError::content(&path, error.to_string()))?;
    let entries = entries.into_iter();
    Ok(entries
        .map(|(time, file)| (time, directory.join(file)))
        .collect())
}

/// Units of the fields of the gas and of the particles in snapshots by their names; empty where the results do not tell.
pub fn units(directory: &Path) -> [BTreeMap<String, String>; 2] {
    store::units(&directory.join(STORE))
}

/// Means of fields over time, on the cells of the gas.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ReadMeans {
    /// The arrays of `means.vtu`, with its mesh.
    pub arrays: Arrays,
    /// Units by names; empty where the results do not tell.
    pub units: BTreeMap<String, String>,
}

/// The means over time of a result directory; `None` where it has none, or not yet.
pub fn means(directory: &Path) -> Result<Option<ReadMeans>, ResultsError> {
    let path = directory.join(files::MEANS);
    if !path.is_file() {
        return Ok(None);
    }
    Ok(Some(ReadMeans {
        arrays: arrays(&path)?,
        units: store::units_of_means(&directory.join(STORE)),
    }))
}

/// Reads the arrays of a `.vtu` or `.vtp` file that the recorder wrote.
pub fn arrays(path: &Path) -> Result<Arrays, ResultsError> {
    let wrong = |error: vtk_xml::VtkError| ResultsError::content(path, error.to_string());
    let bytes = fs::read(path).map_err(ResultsError::file("read", path))?;
    let file = vtk_xml::read(&bytes).map_err(wrong)?;
    let mut arrays = Arrays::new();
    for array in file.pieces.iter().flatten() {
        let read = Array {
            components: array.components,
            values: file.values(array).map_err(wrong)?,
        };
        arrays.insert(array.name.clone(), read);
    }
    Ok(arrays)
}
