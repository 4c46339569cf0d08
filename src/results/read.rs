//! Results read back: the time series and the snapshots of a result directory.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

use super::{ResultsError, SERIES, files};

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
        let mut lines = text.lines();
        let mut series = Self::default();
        for head in lines.next().unwrap_or_default().split(',') {
            let (name, unit) = head
                .strip_suffix(']')
                .and_then(|head| head.rsplit_once(" ["))
                .ok_or_else(|| ResultsError::content(&path, format!("a column is `{head}`")))?;
            series.names.push(name.into());
            series.units.push(unit.into());
        }
        series.columns = vec![Vec::new(); series.names.len()];
        for line in lines {
            let row: Vec<f64> = line
                .split(',')
                .map_while(|value| value.parse().ok())
                .collect();
            if row.len() == series.names.len() {
                for (column, value) in series.columns.iter_mut().zip(row) {
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

/// The snapshots of a `.pvd` file: process time in s and file.
pub fn collection(directory: &Path, name: &str) -> Result<Vec<(f64, PathBuf)>, ResultsError> {
    let path = directory.join(name);
    let text = files::read(&path)?;
    text.split("<DataSet ")
        .skip(1)
        .map(|element| {
            let time = attribute(element, "timestep").and_then(|time| time.parse().ok());
            let file = attribute(element, "file");
            match (time, file) {
                (Some(time), Some(file)) => Ok((time, directory.join(file))),
                _ => Err(ResultsError::content(
                    &path,
                    "a data set has no time or file",
                )),
            }
        })
        .collect()
}

/// Reads the arrays of a `.vtu` or `.vtp` file that the recorder wrote.
pub fn arrays(path: &Path) -> Result<Arrays, ResultsError> {
    let bytes = fs::read(path).map_err(ResultsError::file("read", path))?;
    let mark = b"<AppendedData encoding=\"raw\">\n_";
    let short = || ResultsError::content(path, "it is cut short");
    let begin = bytes
        .windows(mark.len())
        .position(|window| window == mark)
        .ok_or_else(short)?;
    let head = String::from_utf8_lossy(&bytes[..begin]);
    let data = &bytes[begin + mark.len()..];
    let mut arrays = Arrays::new();
    for element in head.split("<DataArray ").skip(1) {
        let Some(offset) = attribute(element, "offset") else {
            continue;
        };
        let array = decode(element, offset, data).ok_or_else(short)?;
        let name = attribute(element, "Name").unwrap_or_default();
        arrays.insert(name.to_owned(), array);
    }
    Ok(arrays)
}

fn attribute<'a>(element: &'a str, name: &str) -> Option<&'a str> {
    let element = element.split('>').next()?;
    let rest = element.split_once(&format!("{name}=\""))?.1;
    rest.split_once('"').map(|(value, _)| value)
}

fn decode(element: &str, offset: &str, data: &[u8]) -> Option<Array> {
    let block = data.get(offset.parse::<usize>().ok()?..)?;
    let length = u64::from_le_bytes(block.get(..8)?.try_into().ok()?);
    let block = block.get(8..usize::try_from(length).ok()?.checked_add(8)?)?;
    let eights = || {
        block
            .chunks_exact(8)
            .filter_map(|bytes| bytes.try_into().ok())
    };
    let values = match attribute(element, "type")? {
        "Float64" => eights().map(f64::from_le_bytes).collect(),
        "Int64" => eights()
            .map(|bytes| i64::from_le_bytes(bytes) as f64)
            .collect(),
        "UInt8" => block.iter().map(|&byte| f64::from(byte)).collect(),
        _ => return None,
    };
    let components = attribute(element, "NumberOfComponents")?.parse().ok()?;
    Some(Array { components, values })
}
