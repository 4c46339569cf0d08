//! `results.h5` of a plant: the series and the distributions over time, each with unit and description.

use std::path::Path;

use hdf5::types::VarLenUnicode;
use hdf5::{File, Location};
use ndarray::{Array1, Array2};

use super::files::{TimeTable, distributions};
use super::measure::Column;
use crate::case::plant::PlantCase;
use crate::results::{ResultsError, STORE};

/// Writes the file from the tables of a results folder.
pub(super) fn write(
    folder: &Path,
    case: &PlantCase,
    columns: &[Column],
    series: &TimeTable,
) -> Result<(), ResultsError> {
    let path = folder.join(STORE);
    let (edges, places) = distributions(folder)?;
    let write = || -> hdf5::Result<()> {
        let mut builder = File::with_options();
        builder.with_fapl(|access| access.file_locking(false));
        let file = builder.create(&path)?;
        file.new_attr::<i64>().create("format")?.write_scalar(&1)?;
        note(&file, "kind", "flowsheet")?;
        note(&file, "case", &case.name)?;
        note(&file, "case_hash", &case.hash)?;
        note(&file, "title", &case.title)?;
        let first = case.plant.layout().grid().range().0;
        let all: Vec<f64> = std::iter::once(first)
            .chain(edges.iter().copied())
            .collect();
        let sizes = file.create_group("sizes")?;
        values(&sizes, "edges", &all, "m", "edges of the size classes")?;
        let group = file.create_group("series")?;
        values(&group, "time_s", series.times(), "s", "time")?;
        for column in columns {
            let (place, name) = parts(&column.name);
            let below = match group.link_exists(&place) {
                true => group.group(&place)?,
                false => group.create_group(&place)?,
            };
            let told = format!("{name} of {place}");
            let own = series.column(&column.name);
            values(&below, &name, own, column.unit, &told)?;
        }
        let group = file.create_group("distributions")?;
        for one in &places {
            let below = group.create_group(&group_name(&one.place))?;
            values(&below, "time_s", &one.times, "s", "time")?;
            let shape = (one.masses.len(), edges.len());
            let flat: Vec<f64> = one.masses.concat();
            let table = Array2::from_shape_vec(shape, flat)
                .map_err(|error| hdf5::Error::Internal(error.to_string()))?;
            let data = below.new_dataset_builder().deflate(1).with_data(&table);
            let data = data.create("by_size")?;
            let unit = match one.place.starts_with("streams.") {
                true => "kg/s",
                false => "kg",
            };
            note(&data, "unit", unit)?;
            note(&data, "description", "solids by time and size class")?;
        }
        file.flush()
    };
    write().map_err(|error| ResultsError::content(&path, error.to_string()))
}

/// `streams.product.d50` as group and dataset.
fn parts(column: &str) -> (String, String) {
    match column.rsplit_once('.') {
        Some((place, name)) => (group_name(place), name.to_owned()),
        None => ("plant".into(), column.to_owned()),
    }
}

/// A name without the mark that parts groups.
fn group_name(place: &str) -> String {
    place.replace('/', "_")
}

fn values(
    group: &hdf5::Group,
    name: &str,
    values: &[f64],
    unit: &str,
    told: &str,
) -> hdf5::Result<()> {
    let data = Array1::from(values.to_vec());
    let data = group.new_dataset_builder().with_data(&data);
    let data = data.create(group_name(name).as_str())?;
    note(&data, "unit", unit)?;
    note(&data, "description", told)
}

fn note(at: &Location, name: &str, text: &str) -> hdf5::Result<()> {
    let text: VarLenUnicode = text
        .parse()
        .map_err(|error| hdf5::Error::Internal(format!("{error}")))?;
    at.new_attr::<VarLenUnicode>()
        .create(name)?
        .write_scalar(&text)
}
