//! `results.h5`: mesh, time series, snapshots and probes, each with unit and description.
//!
//! Arrays are shuffled and deflated at level 1, which every HDF5 reader knows.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use calcine_coupler::interior::ColumnValues;
use calcine_coupler::mesh::Mesh;
use calcine_coupler::physics::Vec3;
use hdf5::file::MetadataCacheConfig;
use hdf5::types::VarLenUnicode;
use hdf5::{Dataset, File, FileBuilder, Group, H5Type, Location};
use ndarray::{Array2, ArrayView1, ArrayView2};

use super::ResultsError;
use super::moment::SnapshotMoment;
use super::probe::{Column as Sampled, Sample, Site};
use super::series::{Column, Row};
use super::snapshot::{Field, Values, lengths_of};
use crate::case::model::Case;

/// The group of means.
const MEANS: &str = "means";

/// Rows of one chunk of the series.
const CHUNK_ROWS: usize = 256;
/// Values of one chunk of a field.
const CHUNK_VALUES: usize = 1 << 16;

/// HDF5's cache of metadata in bytes; it takes some fifteen times as much memory. A snapshot is written once and not looked at again.
const METADATA_CACHE: usize = 1 << 16;

/// Slots and bytes of the cache of chunks of each open dataset: rows of the series come at the end, in some of its last chunk. By
/// HDF5's defaults each column would come to hold a megabyte of chunks that are full.
const CHUNK_CACHE: (usize, usize) = (521, 1 << 14);

/// The open file.
pub(super) struct Store {
    path: PathBuf,
    file: File,
    columns: Vec<Dataset>,
    particles: Option<Dataset>,
    rows: usize,
}

impl Store {
    /// Begins a file: the mesh, an empty series, the points of the probes.
    pub fn create(
        path: &Path,
        case: &Case,
        mesh: &Mesh,
        columns: &[Column],
        tracked: &[u64],
        sites: &[Site],
    ) -> Result<Self, ResultsError> {
        let begin = || -> hdf5::Result<Self> {
            let file = unlocked().create(path)?;
            file.new_attr::<i64>().create("format")?.write_scalar(&1)?;
            note(&file, "case", &case.name)?;
            note(&file, "case_hash", &case.hash)?;
            note(&file, "title", &case.title)?;
            write_mesh(&file.create_group("mesh")?, mesh)?;
            let series = file.create_group("series")?;
            let columns = columns
                .iter()
                .map(|column| create_column(&series, column))
                .collect::<hdf5::Result<_>>()?;
            let particles = create_tracks(&series, tracked)?;
            file.create_group("snapshots")?;
            create_probes(&file.create_group("probes")?, sites)?;
            Ok(Self {
                path: path.to_owned(),
                file,
                columns,
                particles,
                rows: 0,
            })
        };
        begin().map_err(failure("create", path))
    }

    /// Opens a file that holds so many rows and snapshots.
    pub fn resume(
        path: &Path,
        columns: &[Column],
        rows: usize,
        snapshots: usize,
    ) -> Result<Self, ResultsError> {
        let mut found = 0;
        let mut begin = || -> hdf5::Result<Self> {
            let file = unlocked().open_rw(path)?;
            found = file.group("snapshots")?.len() as usize;
            let series = file.group("series")?;
            let columns = columns
                .iter()
                .map(|column| series.dataset(&place(column)))
                .collect::<hdf5::Result<_>>()?;
            let particles = series
                .link_exists("particle_temperature")
                .then(|| series.dataset("particle_temperature"))
                .transpose()?;
            Ok(Self {
                path: path.to_owned(),
                file,
                columns,
                particles,
                rows,
            })
        };
        let store = begin().map_err(failure("open", path))?;
        if found != snapshots {
            let fact = format!("it has {found} snapshots, the checkpoint {snapshots}");
            return Err(ResultsError::content(path, fact));
        }
        match store.columns.iter().find(|column| column.size() != rows) {
            None => Ok(store),
            Some(column) => Err(ResultsError::content(
                path,
                format!(
                    "the dataset `{}` has {} rows, the checkpoint {rows}",
                    column.name(),
                    column.size()
                ),
            )),
        }
    }

    /// Appends rows to the series.
    pub fn append(&mut self, rows: &[Row]) -> Result<(), ResultsError> {
        if rows.is_empty() {
            return Ok(());
        }
        let (from, to) = (self.rows, self.rows + rows.len());
        let write = || -> hdf5::Result<()> {
            for (place, column) in self.columns.iter().enumerate() {
                let values: Vec<f64> = rows.iter().map(|row| row.values[place]).collect();
                column.resize(to)?;
                column.write_slice(ArrayView1::from(&values), from..to)?;
            }
            if let Some(dataset) = &self.particles {
                let width = rows[0].particles.len();
                let values: Vec<f64> = rows
                    .iter()
                    .flat_map(|row| row.particles.iter().copied())
                    .collect();
                let block = Array2::from_shape_vec((rows.len(), width), values)
                    .map_err(|error| hdf5::Error::Internal(error.to_string()))?;
                dataset.resize((to, width))?;
                dataset.write_slice(&block, (from..to, ..))?;
            }
            Ok(())
        };
        write().map_err(failure("write the series of", &self.path))?;
        self.rows = to;
        Ok(())
    }

    /// Writes a snapshot and the probes' values.
    pub fn snapshot(
        &mut self,
        number: usize,
        moment: &SnapshotMoment,
        positions: &[Vec3],
        gas: &[Field<'_>],
        particles: &[Field<'_>],
        samples: &[Sample<'_>],
    ) -> Result<(), ResultsError> {
        let write = || -> hdf5::Result<()> {
            let group = self.file.create_group(&format!("snapshots/{number:04}"))?;
            let times = [
                ("process_time", moment.process_time),
                ("motion_time", moment.motion_time),
                ("windows", moment.windows as f64),
            ];
            for (name, value) in times {
                group.new_attr::<f64>().create(name)?.write_scalar(&value)?;
            }
            let gas_group = group.create_group("gas")?;
            for field in gas {
                write_field(&gas_group, field)?;
            }
            let bed = group.create_group("particles")?;
            let position = Field {
                name: "position",
                unit: "m",
                description: "particle centres",
                values: Values::Vector(positions),
            };
            for field in std::iter::once(&position).chain(particles) {
                write_field(&bed, field)?;
            }
            for sample in samples {
                let probe = self.file.group("probes")?.group(&sample.site.probe.name)?;
                for column in &sample.columns {
                    if column.of_particles {
                        write_probe(&probe.group("particles")?, column, number)?;
                    } else {
                        write_probe(&probe, column, number)?;
                    }
                }
            }
            Ok(())
        };
        write().map_err(failure("write a snapshot to", &self.path))
    }

    /// Writes the means of fields over an interval from and to process times in s, of which so much has passed; in place of those that
    /// are there.
    pub fn means(&mut self, interval: [f64; 3], fields: &[Field<'_>]) -> Result<(), ResultsError> {
        let write = || -> hdf5::Result<()> {
            if self.file.link_exists(MEANS) {
                self.file.unlink(MEANS)?;
            }
            let group = self.file.create_group(MEANS)?;
            for (name, value) in ["from", "to", "averaged"].into_iter().zip(interval) {
                group.new_attr::<f64>().create(name)?.write_scalar(&value)?;
            }
            fields
                .iter()
                .try_for_each(|field| write_field(&group, field))
        };
        write().map_err(failure("write means to", &self.path))
    }

    /// Takes the place of the file of another name.
    pub fn rename(&mut self, to: &Path) -> Result<(), ResultsError> {
        self.flush()?;
        std::fs::rename(&self.path, to).map_err(ResultsError::file("replace", to))?;
        self.path = to.to_owned();
        Ok(())
    }

    /// Hands everything to the operating system.
    pub fn flush(&self) -> Result<(), ResultsError> {
        self.file.flush().map_err(failure("flush", &self.path))
    }
}

/// Opens without HDF5's lock on the file: solvers that the run starts would inherit it and could
/// keep it past the run's end, network file systems may not have it, and it would keep users from
/// reading while the run goes on. The summary guards the directory instead.
fn unlocked() -> FileBuilder {
    let mut builder = File::with_options();
    // By its defaults the cache grows with the snapshots, up to 32 MiB.
    let cache = MetadataCacheConfig {
        initial_size: METADATA_CACHE,
        min_size: METADATA_CACHE,
        max_size: METADATA_CACHE,
        ..MetadataCacheConfig::default()
    };
    let (slots, bytes) = CHUNK_CACHE;
    builder.with_fapl(|access| {
        let access = access.file_locking(false).mdc_config(&cache);
        access.chunk_cache(slots, bytes, 1.0)
    });
    builder
}

/// Units of the fields of the gas and of the particles by their names, as the first snapshot states them; a file that a run
/// is writing may tell none.
pub(super) fn units(path: &Path) -> [BTreeMap<String, String>; 2] {
    ["gas", "particles"].map(|part| units_of(path, &format!("snapshots/0000/{part}")))
}

/// Units of the means over time by their names.
pub(super) fn units_of_means(path: &Path) -> BTreeMap<String, String> {
    units_of(path, MEANS)
}

/// Units of the datasets of a group; none where it cannot be read.
fn units_of(path: &Path, group: &str) -> BTreeMap<String, String> {
    let read = || -> hdf5::Result<BTreeMap<String, String>> {
        let file = unlocked().open(path)?;
        let group = file.group(group)?;
        let unit = |name: String| {
            let unit = group.dataset(&name)?.attr("unit")?;
            let text = unit.read_scalar::<VarLenUnicode>()?;
            Ok((name, text.to_string()))
        };
        group.member_names()?.into_iter().map(unit).collect()
    };
    read().unwrap_or_default()
}

fn failure(action: &'static str, path: &Path) -> impl FnOnce(hdf5::Error) -> ResultsError {
    let path = path.to_owned();
    move |source| ResultsError::Store {
        action,
        path,
        source,
    }
}

fn place(column: &Column) -> String {
    if column.group.is_empty() {
        column.name.clone()
    } else {
        format!("{}/{}", column.group, column.name)
    }
}

/// Writes a text attribute.
fn note(location: &Location, name: &str, text: &str) -> hdf5::Result<()> {
    let text: VarLenUnicode = text
        .parse()
        .map_err(|_| hdf5::Error::Internal(format!("`{name}` holds a zero byte")))?;
    let attribute = location.new_attr::<VarLenUnicode>().create(name)?;
    attribute.write_scalar(&text)
}

fn describe(dataset: &Dataset, unit: &str, description: &str) -> hdf5::Result<()> {
    note(dataset, "unit", unit)?;
    note(dataset, "description", description)
}

fn create_column(series: &Group, column: &Column) -> hdf5::Result<Dataset> {
    if !column.group.is_empty() && !series.link_exists(column.group) {
        series.create_group(column.group)?;
    }
    let dataset = series
        .new_dataset::<f64>()
        .shape(0..)
        .chunk(CHUNK_ROWS)
        .shuffle()
        .deflate(1)
        .create(place(column).as_str())?;
    describe(&dataset, &column.unit, &column.description)?;
    Ok(dataset)
}

/// The matrix time × particle, where there are particles to follow.
fn create_tracks(series: &Group, tracked: &[u64]) -> hdf5::Result<Option<Dataset>> {
    if tracked.is_empty() {
        return Ok(None);
    }
    let ids = series
        .new_dataset::<u64>()
        .shape(tracked.len())
        .create("particle_id")?;
    ids.write(ArrayView1::from(tracked))?;
    describe(&ids, "1", "ids of the columns of particle_temperature")?;
    let dataset = series
        .new_dataset::<f64>()
        .shape((0.., tracked.len()))
        .chunk((CHUNK_ROWS, tracked.len().min(64)))
        .shuffle()
        .deflate(1)
        .create("particle_temperature")?;
    let text = "particle temperatures, time by particle; NaN where a particle is gone";
    describe(&dataset, "K", text)?;
    Ok(Some(dataset))
}

fn write_mesh(group: &Group, mesh: &Mesh) -> hdf5::Result<()> {
    let centres = Field {
        name: "cell_centre",
        unit: "m",
        description: "centres of the gas cells",
        values: Values::Vector(mesh.cell_centre()),
    };
    let volumes = Field {
        name: "cell_volume",
        unit: "m^3",
        description: "volumes of the gas cells",
        values: Values::Scalar(mesh.cell_volume()),
    };
    write_field(group, &centres)?;
    write_field(group, &volumes)
}

fn write_field(group: &Group, field: &Field<'_>) -> hdf5::Result<()> {
    let dataset = match field.values {
        Values::Scalar(list) => write_list(group, field.name, list)?,
        Values::Whole(list) => write_list(group, field.name, list)?,
        Values::Small(list) => write_list(group, field.name, list)?,
        Values::Column {
            table,
            column,
            columns,
        } => write_list(group, field.name, &Values::column(table, column, columns))?,
        Values::Vector(list) => write_vectors(group, field.name, list)?,
        Values::Ragged(rows) => {
            let lengths: Vec<u64> = rows.lengths().map(|length| length as u64).collect();
            let counts = write_list(group, &lengths_of(field.name), &lengths)?;
            describe(&counts, "1", "how many values each particle has")?;
            match rows.values() {
                ColumnValues::Real(list) => write_list(group, field.name, list)?,
                ColumnValues::Count(list) => write_list(group, field.name, list)?,
            }
        }
    };
    describe(&dataset, field.unit, field.description)
}

fn write_list<T: H5Type>(group: &Group, name: &str, list: &[T]) -> hdf5::Result<Dataset> {
    let builder = group.new_dataset::<T>().shape(list.len());
    if list.is_empty() {
        return builder.create(name);
    }
    let dataset = builder
        .chunk(list.len().min(CHUNK_VALUES))
        .shuffle()
        .deflate(1)
        .create(name)?;
    dataset.write(ArrayView1::from(list))?;
    Ok(dataset)
}

fn write_vectors(group: &Group, name: &str, list: &[Vec3]) -> hdf5::Result<Dataset> {
    let builder = group.new_dataset::<f64>().shape((list.len(), 3));
    if list.is_empty() {
        return builder.create(name);
    }
    let dataset = builder
        .chunk((list.len().min(CHUNK_VALUES), 3))
        .shuffle()
        .deflate(1)
        .create(name)?;
    let flat: Vec<f64> = list
        .iter()
        .flat_map(|vector| vector.iter().copied())
        .collect();
    let view = ArrayView2::from_shape((list.len(), 3), &flat)
        .map_err(|error| hdf5::Error::Internal(error.to_string()))?;
    dataset.write(view)?;
    Ok(dataset)
}

fn create_probes(group: &Group, sites: &[Site]) -> hdf5::Result<()> {
    for site in sites {
        let probe = group.create_group(&site.probe.name)?;
        let dataset = write_vectors(&probe, "position", &site.probe.points)?;
        describe(&dataset, "m", "points of the probe")?;
        if site.probe.particles {
            probe.create_group("particles")?;
        }
    }
    Ok(())
}

/// Appends one snapshot's row to a probe's matrix snapshot × point.
fn write_probe(group: &Group, column: &Sampled, number: usize) -> hdf5::Result<()> {
    let points = column.values.len();
    let dataset = if group.link_exists(&column.name) {
        group.dataset(&column.name)?
    } else {
        let dataset = group
            .new_dataset::<f64>()
            .shape((0.., points))
            .chunk((16, points))
            .shuffle()
            .deflate(1)
            .create(&*column.name)?;
        describe(&dataset, column.unit, &column.description)?;
        dataset
    };
    let view = ArrayView2::from_shape((1, points), &column.values)
        .map_err(|error| hdf5::Error::Internal(error.to_string()))?;
    dataset.resize((number + 1, points))?;
    dataset.write_slice(view, (number..number + 1, ..))
}
