//! `results.h5` made anew from the series and the ParaView files, which hold the same numbers to the bit.
//!
//! An HDF5 file that a writer left in the middle cannot be cut back to where a checkpoint stands. The other files can: rows are appended
//! to `series.csv`, and each snapshot is a file that is never changed. So a checkpoint needs no copy of `results.h5`.

use std::fs;
use std::path::Path;

use calcine_coupler::interior::{ColumnKind, ColumnValues, Ragged};
use calcine_coupler::mesh::Mesh;
use calcine_coupler::physics::Vec3;

use super::files::{DRAFT, gas_file, particle_file};
use super::moment::SnapshotMoment;
use super::probe::{self, Site};
use super::read::Series;
use super::series::{Column, Row};
use super::snapshot::{Field, Values, lengths_of};
use super::store::Store;
use super::{ResultsError, STORE};
use crate::case::model::Case;
use crate::vtk_xml::{self, DataArray, VtkFile};

/// Rows of the series that go to the file at once.
const BATCH: usize = 256;

/// What the file is made of, beside the files of the folder.
pub(super) struct Source<'a> {
    /// The case.
    pub case: &'a Case,
    /// The mesh of the gas.
    pub mesh: &'a Mesh,
    /// Columns of the series.
    pub columns: &'a [Column],
    /// Particles with a column of their own.
    pub tracked: &'a [u64],
    /// Probes.
    pub sites: &'a [Site],
    /// Rows of the series.
    pub rows: usize,
    /// The snapshots.
    pub snapshots: &'a [SnapshotMoment],
    /// Fields of the gas, as a snapshot has them; their values are no matter.
    pub gas: &'a [Field<'a>],
    /// Fields of the particles, the same.
    pub particles: &'a [Field<'a>],
}

/// Makes the file beside the one that is there, then takes its place.
pub(super) fn rebuild(directory: &Path, source: &Source<'_>) -> Result<Store, ResultsError> {
    let path = directory.join(STORE);
    let draft = directory.join(DRAFT);
    let mut store = Store::create(
        &draft,
        source.case,
        source.mesh,
        source.columns,
        source.tracked,
        source.sites,
    )?;
    append_rows(directory, source, &mut store)?;
    for (number, moment) in source.snapshots.iter().enumerate() {
        let gas = read(&directory.join(gas_file(number)), "CellData", source.gas)?;
        let bed_file = directory.join(particle_file(number));
        let bed = read(&bed_file, "PointData", source.particles)?;
        let gas: Vec<Field<'_>> = gas.fields.iter().map(Kept::field).collect();
        let particles: Vec<Field<'_>> = bed.fields.iter().map(Kept::field).collect();
        let radius = particles.iter().find_map(|field| match field.values {
            Values::Scalar(list) if field.name == "radius" => Some(list),
            _ => None,
        });
        let radius = radius.ok_or_else(|| ResultsError::behind(&bed_file, "it has no radii"))?;
        let samples = probe::samples(source.sites, &gas, &particles, &bed.points, radius);
        store.snapshot(number, moment, &bed.points, &gas, &particles, &samples)?;
    }
    store.rename(&path)?;
    Ok(store)
}

fn append_rows(
    directory: &Path,
    source: &Source<'_>,
    store: &mut Store,
) -> Result<(), ResultsError> {
    let series = Series::read(directory)?;
    let found = series.columns.first().map_or(0, Vec::len);
    if found != source.rows {
        let fact = format!("it has {found} rows, the checkpoint {}", source.rows);
        return Err(ResultsError::behind(&directory.join(super::SERIES), fact));
    }
    let (values, particles) = series.columns.split_at(source.columns.len());
    let of = |columns: &[Vec<f64>], row: usize| columns.iter().map(|column| column[row]).collect();
    for first in (0..found).step_by(BATCH) {
        let rows: Vec<Row> = (first..found.min(first + BATCH))
            .map(|row| Row {
                values: of(values, row),
                particles: of(particles, row),
            })
            .collect();
        store.append(&rows)?;
    }
    Ok(())
}

/// A snapshot's file.
struct Snapshot<'a> {
    /// Centres of particles in m, or points of the mesh.
    points: Vec<Vec3>,
    fields: Vec<Kept<'a>>,
}

/// A field that was read back.
struct Kept<'a> {
    /// Name, unit and description.
    of: Field<'a>,
    values: KeptValues,
}

enum KeptValues {
    Scalar(Vec<f64>),
    Vector(Vec<Vec3>),
    Whole(Vec<u64>),
    Small(Vec<u32>),
    Ragged(Ragged),
}

impl Kept<'_> {
    fn field(&self) -> Field<'_> {
        let values = match &self.values {
            KeptValues::Scalar(list) => Values::Scalar(list),
            KeptValues::Vector(list) => Values::Vector(list),
            KeptValues::Whole(list) => Values::Whole(list),
            KeptValues::Small(list) => Values::Small(list),
            KeptValues::Ragged(rows) => Values::Ragged(rows),
        };
        Field { values, ..self.of }
    }
}

/// Reads the fields of a section in the order in which a snapshot has them; those that it did not have yet are left out.
fn read<'a>(
    path: &Path,
    section: &str,
    wanted: &[Field<'a>],
) -> Result<Snapshot<'a>, ResultsError> {
    let bytes = fs::read(path).map_err(ResultsError::file("read", path))?;
    let wrong = |error: vtk_xml::VtkError| ResultsError::behind(path, error.to_string());
    let file = vtk_xml::read(&bytes).map_err(wrong)?;
    let arrays: Vec<&DataArray> = file.pieces.iter().flatten().collect();
    let find = |section: &str, name: &str| {
        let mut arrays = arrays.iter();
        arrays.find(|array| array.section == section && array.name == name)
    };
    let mut fields = Vec::new();
    for field in wanted {
        let Some(array) = find(section, field.name) else {
            continue;
        };
        let lengths = find(section, &lengths_of(field.name));
        let values = values(&file, array, lengths.copied(), field).map_err(wrong)?;
        let values = values.ok_or_else(|| {
            ResultsError::behind(path, format!("the array `{}` is cut short", field.name))
        })?;
        fields.push(Kept { of: *field, values });
    }
    let known = |name: &str| {
        let mut fields = wanted.iter();
        fields.any(|field| field.name == name || lengths_of(field.name) == name)
    };
    let mut own = arrays.iter().filter(|array| array.section == section);
    if let Some(array) = own.find(|array| !known(&array.name)) {
        let fact = format!(
            "it has an array `{}`, which this run does not write",
            array.name
        );
        return Err(ResultsError::behind(path, fact));
    }
    let points = match find("Points", "points") {
        Some(array) => vectors(&numbers(
            file.bytes(array).map_err(wrong)?,
            f64::from_le_bytes,
        )),
        None => Vec::new(),
    };
    Ok(Snapshot { points, fields })
}

/// The values of an array in the type in which the field has them; `None` where lengths and values do not fit.
fn values(
    file: &VtkFile<'_>,
    array: &DataArray,
    lengths: Option<&DataArray>,
    field: &Field<'_>,
) -> Result<Option<KeptValues>, vtk_xml::VtkError> {
    let bytes = file.bytes(array)?;
    let real = || numbers(bytes, f64::from_le_bytes);
    if let Some(lengths) = lengths {
        let lengths = numbers(file.bytes(lengths)?, u64::from_le_bytes);
        let counted = match field.values {
            Values::Whole(_) | Values::Small(_) => true,
            Values::Ragged(rows) => rows.kind() == ColumnKind::Count,
            _ => false,
        };
        return Ok(ragged(&real(), array.components, &lengths, counted).map(KeptValues::Ragged));
    }
    Ok(Some(match (array.is_whole(), field.values) {
        (true, Values::Small(_)) => {
            KeptValues::Small(numbers(bytes, |word| i64::from_le_bytes(word) as u32))
        }
        (true, _) => KeptValues::Whole(numbers(bytes, u64::from_le_bytes)),
        (false, _) if array.components == 3 => KeptValues::Vector(vectors(&real())),
        (false, _) => KeptValues::Scalar(real()),
    }))
}

/// Rows without what fills them up to the same length.
fn ragged(values: &[f64], width: usize, lengths: &[u64], counted: bool) -> Option<Ragged> {
    let lengths: Vec<usize> = lengths.iter().map(|&length| length as usize).collect();
    if values.len() != width * lengths.len() || lengths.iter().any(|&length| length > width) {
        return None;
    }
    let rows = values.chunks_exact(width).zip(&lengths);
    let kept = rows.flat_map(|(row, &length)| row[..length].iter().copied());
    let values = match counted {
        true => ColumnValues::Count(kept.map(|value| value as u64).collect()),
        false => ColumnValues::Real(kept.collect()),
    };
    Ragged::from_lengths(&lengths, values)
}

fn numbers<T>(bytes: &[u8], of: impl Fn([u8; 8]) -> T) -> Vec<T> {
    bytes
        .as_chunks::<8>()
        .0
        .iter()
        .map(|word| of(*word))
        .collect()
}

fn vectors(values: &[f64]) -> Vec<Vec3> {
    let triples = values.as_chunks::<3>().0.iter();
    triples.map(|&[x, y, z]| Vec3::new(x, y, z)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::results::vtk;

    fn field<'a>(name: &'a str, values: Values<'a>) -> Field<'a> {
        Field {
            name,
            unit: "1",
            description: "as a test has it",
            values,
        }
    }

    /// Values of a field as text that tells types, lengths and bits.
    fn shown(field: &Field<'_>) -> String {
        match field.values {
            Values::Scalar(list) => {
                let bits: Vec<u64> = list.iter().map(|value| value.to_bits()).collect();
                format!("{} {bits:?}", field.name)
            }
            other => format!("{} {other:?}", field.name),
        }
    }

    #[test]
    fn fields_of_every_type_come_back_to_the_bit() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("particles_0000.vtp");
        let points = [Vec3::new(0.1, -0.0, 1e-310), Vec3::new(0.2, 3.0, 4.0)];
        let mut real = Ragged::new(ColumnKind::Real);
        real.push_reals(&[0.1, 0.2, 0.3]);
        real.push_reals(&[]);
        let mut count = Ragged::new(ColumnKind::Count);
        count.push_counts(&[7]);
        count.push_counts(&[8, 9]);
        let fields = [
            field("id", Values::Whole(&[1, (1 << 60) + 1])),
            field("population", Values::Small(&[0, 3])),
            field("radius", Values::Scalar(&[f64::NAN, -0.0])),
            field("velocity", Values::Vector(&points)),
            field("layers", Values::Ragged(&real)),
            field("parts", Values::Ragged(&count)),
        ];
        vtk::write_particles(&path, &points, 1.5, &fields).unwrap();
        // As the run that goes on has them: all of one value now.
        let (ones, whole) = (Ragged::scalars(vec![1.0; 2]), [1, 2]);
        let now = fields.map(|one| match one.name {
            "layers" => Field {
                values: Values::Ragged(&ones),
                ..one
            },
            "parts" => Field {
                values: Values::Whole(&whole),
                ..one
            },
            _ => one,
        });
        let read_back = read(&path, "PointData", &now).unwrap();
        assert_eq!(read_back.points, points);
        let found: Vec<String> = read_back
            .fields
            .iter()
            .map(|one| shown(&one.field()))
            .collect();
        let wanted: Vec<String> = fields.iter().map(shown).collect();
        assert_eq!(found, wanted);
        // A column that the run does not write is told.
        let error = read(&path, "PointData", &now[..5])
            .err()
            .unwrap()
            .to_string();
        assert!(
            error.contains("an array `parts`, which this run does not write"),
            "{error}"
        );
    }
}
