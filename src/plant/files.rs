//! The tables of a plant's results: the series, distributions over time, and the streams at the end.

use std::path::Path;

use calcine_flowsheet::{Plant, PlantRun};

use super::measure::{Column, field, places, state};
use crate::case::plant::{PlantField, PlantPlace};
use crate::results::ResultsError;
use crate::results::files::{self, DISTRIBUTIONS, SERIES, STREAMS};
use crate::results::marked::{FileMark, MarkedFile};
use crate::results::sheet::{line, number, rows};

/// First column of every table over time.
const TIME: &str = "time_s";

/// A table that grows by rows.
pub(super) struct Table(MarkedFile);

impl Table {
    /// Begins a table with its head.
    pub fn create(folder: &Path, name: &str, head: &[String]) -> Result<Self, ResultsError> {
        let mut table = Self(MarkedFile::create(folder.join(name))?);
        table.append(head)?;
        Ok(table)
    }

    /// Opens a table that was checked, and cuts it to where it was.
    pub fn resume(folder: &Path, name: &str, mark: &FileMark) -> Result<Self, ResultsError> {
        let path = folder.join(name);
        mark.cut(&path)?;
        let text = files::read(&path)?;
        MarkedFile::resume(path, &text).map(Self)
    }

    /// Appends a row.
    pub fn append(&mut self, words: &[String]) -> Result<(), ResultsError> {
        let row = line(self.0.path(), words)?;
        self.0.write(&row)?;
        self.0.flush()
    }

    /// Hands all rows to the disk; gives how far the table is.
    pub fn mark(&mut self) -> Result<FileMark, ResultsError> {
        self.0.mark()
    }
}

/// The head of the series.
pub(super) fn series_head(columns: &[Column]) -> Vec<String> {
    let names = columns.iter().map(|column| column.name.clone());
    std::iter::once(TIME.to_owned()).chain(names).collect()
}

/// The head of the distributions: time, place, and the edge above each size class in m.
pub(super) fn distribution_head(plant: &Plant) -> Vec<String> {
    let edges = plant.layout().grid().edges()[1..].iter();
    let edges = edges.map(|edge| format!("to_{}_m", number(*edge)));
    [TIME.to_owned(), "place".into()]
        .into_iter()
        .chain(edges)
        .collect()
}

/// Most combinations of attribute classes that have distributions of their own.
const MOST_CELLS: usize = 400;

/// A row of distributions for each place: kg/s or kg by size class; with attributes one more for each combination of their
/// classes, named by them: `streams.feed.colour_1.wet_3`.
pub(super) fn distribution_rows(run: &PlantRun<'_>, plant: &Plant) -> Vec<Vec<String>> {
    let layout = plant.layout();
    let cells = match layout.attributes().is_empty() || layout.cells() > MOST_CELLS {
        true => 0,
        false => layout.cells(),
    };
    let mut rows = Vec::new();
    let mut add = |name: String, sizes: Vec<f64>| {
        let words = [number(run.time()), name].into_iter();
        rows.push(words.chain(sizes.into_iter().map(number)).collect());
    };
    for (of, name) in places(plant) {
        let own = state(run, of);
        add(name.clone(), layout.by_size(&own));
        for cell in 0..cells {
            let classes = layout.classes_of(cell);
            let pairs = layout.attributes().iter().zip(&classes);
            let words = pairs.map(|(one, class)| format!(".{}_{}", one.name, class + 1));
            let name = name.clone() + &words.collect::<String>();
            add(name, layout.by_size_where(&own, |other| other == classes));
        }
    }
    rows
}

/// Writes the table of streams and units at the end.
pub(super) fn write_streams(
    folder: &Path,
    run: &PlantRun<'_>,
    plant: &Plant,
) -> Result<(), ResultsError> {
    let path = folder.join(STREAMS);
    let layout = plant.layout();
    let compounds = layout.compounds();
    let mut head: Vec<String> = ["place", "from", "to", "unit_of_masses", "mass", "solids"]
        .map(str::to_owned)
        .to_vec();
    for compound in compounds {
        for phase in ["solid", "liquid", "vapour"] {
            head.push(format!("{phase} {}", compound.name));
        }
    }
    let last = [
        "enthalpy",
        "temperature_K",
        "mean_m",
        "d10_m",
        "d50_m",
        "d90_m",
    ];
    head.extend(last.map(str::to_owned));
    let mut text = line(&path, &head)?;
    for (of, name) in places(plant) {
        let (ends, unit) = match of {
            PlantPlace::Stream(stream) => {
                let (from, to) = plant.ends_of(stream);
                let name = |unit: usize| plant.units()[unit].name.clone();
                ([name(from), name(to)], "kg/s")
            }
            PlantPlace::Unit(_) => ([String::new(), String::new()], "kg"),
        };
        let own = state(run, of);
        let value = |which| number(field(layout, &own, which, None));
        let [from, to] = ends;
        let mut row = vec![name, from, to, unit.to_owned()];
        row.extend([value(PlantField::Mass), value(PlantField::Solids)]);
        for k in 0..compounds.len() {
            let solid = own[..layout.solids()].iter().skip(k);
            let solid: f64 = solid.step_by(compounds.len()).sum();
            let phases = [solid, own[layout.liquid(k)], own[layout.vapour(k)]];
            row.extend(phases.map(number));
        }
        row.push(number(own[layout.enthalpy()]));
        let fields = [
            PlantField::Temperature,
            PlantField::MeanDiameter,
            PlantField::Quantile(10),
            PlantField::Quantile(50),
            PlantField::Quantile(90),
        ];
        row.extend(fields.map(value));
        text.extend(line(&path, &row)?);
    }
    files::replace(&path, &text)
}

/// A table over time as it is read back.
pub(super) struct TimeTable {
    /// Names of the columns.
    pub names: Vec<String>,
    /// Values, column by column.
    pub columns: Vec<Vec<f64>>,
}

impl TimeTable {
    /// Reads the series of a results folder.
    pub fn series(folder: &Path) -> Result<Self, ResultsError> {
        let path = folder.join(SERIES);
        let text = files::read(&path)?;
        let mut rows = rows(&path, &text)?.into_iter();
        let Some(head) = rows.next() else {
            return Err(ResultsError::content(&path, "it is empty"));
        };
        let names: Vec<String> = head.iter().map(str::to_owned).collect();
        let mut columns = vec![Vec::new(); names.len()];
        for row in rows {
            if row.len() != names.len() {
                let fact = format!("a row has {} values, the head {}", row.len(), names.len());
                return Err(ResultsError::content(&path, fact));
            }
            for (column, word) in columns.iter_mut().zip(row.iter()) {
                let value = word.parse::<f64>();
                let value = value.map_err(|error| {
                    ResultsError::content(&path, format!("\"{word}\": {error}"))
                })?;
                column.push(value);
            }
        }
        Ok(Self { names, columns })
    }

    /// A column by its name; empty where there is none.
    pub fn column(&self, name: &str) -> &[f64] {
        let place = self.names.iter().position(|own| own == name);
        place.map_or(&[], |place| &self.columns[place])
    }

    /// Times in s.
    pub fn times(&self) -> &[f64] {
        self.column(TIME)
    }
}

/// Distributions of one place over time.
pub(super) struct Distributions {
    /// Name of the place.
    pub place: String,
    /// Times in s.
    pub times: Vec<f64>,
    /// kg/s or kg by size class, time by time.
    pub masses: Vec<Vec<f64>>,
}

/// Reads the distributions of a results folder: the edge above each class in m, and each place.
pub(super) fn distributions(folder: &Path) -> Result<(Vec<f64>, Vec<Distributions>), ResultsError> {
    let path = folder.join(DISTRIBUTIONS);
    let text = files::read(&path)?;
    let mut rows = rows(&path, &text)?.into_iter();
    let wrong = |fact: &str| ResultsError::content(&path, fact);
    let head = rows.next().ok_or_else(|| wrong("it is empty"))?;
    let edge = |word: &str| {
        let number = word.strip_prefix("to_").and_then(|w| w.strip_suffix("_m"));
        number.and_then(|number| number.parse::<f64>().ok())
    };
    let edges: Option<Vec<f64>> = head.iter().skip(2).map(edge).collect();
    let edges = edges.ok_or_else(|| wrong("its head has no edges"))?;
    let mut all: Vec<Distributions> = Vec::new();
    for row in rows {
        let mut words = row.iter();
        let time = words.next().and_then(|word| word.parse::<f64>().ok());
        let place = words.next();
        let masses: Result<Vec<f64>, _> = words.map(str::parse::<f64>).collect();
        let (Some(time), Some(place), Ok(masses)) = (time, place, masses) else {
            return Err(wrong("a row is no time, place and masses"));
        };
        let index = match all.iter().position(|one| one.place == place) {
            Some(index) => index,
            None => {
                all.push(Distributions {
                    place: place.to_owned(),
                    times: Vec::new(),
                    masses: Vec::new(),
                });
                all.len() - 1
            }
        };
        all[index].times.push(time);
        all[index].masses.push(masses);
    }
    Ok((edges, all))
}
