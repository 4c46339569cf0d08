//! `tuning` of a plant.

use calcine_coupler::regular_file;
use std::path::{Path, PathBuf};

use calcine_flowsheet::{MeasuredDistribution, MeasuredPlace, Plant};

use super::layout::refused;
use super::model::{PlantMeasuredValues, PlantPlace, PlantTunedKey, PlantTuningSpec};
use super::quantities::{dimension_of, field, number_and_unit, place, unit_of};
use super::words::PlantTunedState;
use crate::case::table::TableReader;
use crate::case::units::{Dimension, quantities};

/// `tuning`; `Some(None)` where the case has none.
pub(super) fn tuning(
    root: &TableReader<'_>,
    plant: Option<&Plant>,
    folder: &Path,
    end: Option<f64>,
) -> Option<Option<PlantTuningSpec>> {
    if !root.has("tuning") {
        return Some(None);
    }
    let table = root.table("tuning")?;
    let state = table.choice::<PlantTunedState>("state");
    let parameters = parameters(&table);
    let mut files = Vec::new();
    let mut distributions = Some(Vec::new());
    for own in table.tables("distributions") {
        let read = sieved(&own, plant, folder, &mut files);
        own.finish();
        match (read, &mut distributions) {
            (Some(read), Some(all)) => all.extend(read),
            (None, _) => distributions = None,
            _ => {}
        }
    }
    let mut values = Some(Vec::new());
    for own in table.tables("values") {
        let read = measured(&own, plant, folder, &mut files);
        own.finish();
        match (read, &mut values) {
            (Some(read), Some(all)) => all.push(read),
            (None, _) => values = None,
            _ => {}
        }
    }
    if !table.has("distributions") && !table.has("values") {
        let help = "add [[tuning.distributions]] or [[tuning.values]]";
        table.fail_whole("has nothing that was measured", help);
    }
    let counts = ["samples", "starts"].map(|key| table.whole(key));
    let (seed, level) = (table.whole("seed"), table.number("level"));
    table.finish();
    let [samples, starts] = counts.map(|count| usize::try_from(count?).ok());
    let (distributions, values) = (distributions?, values?);
    let steady = state? == PlantTunedState::Steady;
    let times = distributions.iter().map(|one| one.time);
    let others = values
        .iter()
        .flat_map(|one| one.points.iter().map(|point| point.0));
    let last = times.chain(others).fold(0.0, f64::max);
    if let Some(end) = end.filter(|end| !steady && last > *end) {
        let rule = format!("has measurements at {last} s, after the end of the run at {end} s");
        table.fail_whole(&rule, "raise `time.end`, or leave them out");
    }
    Some(Some(PlantTuningSpec {
        steady,
        parameters: parameters?,
        distributions,
        values,
        sets: [samples?, starts?],
        seed: seed?,
        level: level?,
        files,
    }))
}

/// A bound as a number and its unit.
fn bound<'t>(table: &TableReader<'_>, name: &str, text: Option<&'t str>) -> Option<(f64, &'t str)> {
    let text = text?;
    let found = number_and_unit(text);
    let known = found.filter(|(_, unit)| quantities(&format!("1 {unit}")).is_ok());
    if known.is_none() {
        let rule = format!("is \"{text}\", which is no number with a unit");
        table.fail(name, rule, "for example \"4\" or \"2.2 mm\"");
    }
    known
}

fn parameters(tuning: &TableReader<'_>) -> Option<Vec<PlantTunedKey>> {
    let mut all = Some(Vec::new());
    let tables = tuning.tables("parameters");
    for table in &tables {
        let (key, low, high) = (table.text("key"), table.text("low"), table.text("high"));
        let logarithmic = table.truth("logarithmic");
        table.finish();
        let (low, high) = (bound(table, "low", low), bound(table, "high", high));
        let made = (|| {
            let ((low, unit), (high, other)) = (low?, high?);
            if unit != other {
                let rule = format!("has the unit \"{other}\", and `low` has \"{unit}\"");
                table.fail("high", rule, "write both in one unit");
                return None;
            }
            if low >= high {
                table.fail("low", "is not below `high`", "exchange them");
                return None;
            }
            let logarithmic = logarithmic?;
            if logarithmic && low <= 0.0 {
                let help = "raise it, or leave `logarithmic` out";
                table.fail("low", "is not above zero, which a logarithm needs", help);
                return None;
            }
            Some(PlantTunedKey {
                key: key?.to_owned(),
                bounds: [low, high],
                unit: unit.to_owned(),
                logarithmic,
            })
        })();
        match (made, &mut all) {
            (Some(one), Some(all)) => all.push(one),
            _ => all = None,
        }
    }
    if tables.is_empty() && tuning.has("parameters") {
        tuning.fail("parameters", "names no key", "add [[tuning.parameters]]");
        return None;
    }
    all
}

/// The head of a file and its rows of numbers.
type MeasuredTable = (Vec<String>, Vec<Vec<f64>>);

/// Reads a file of measurements.
fn table_of(
    table: &TableReader<'_>,
    folder: &Path,
    files: &mut Vec<PathBuf>,
) -> Option<MeasuredTable> {
    let own = table.text("file")?;
    let path = folder.join(own);
    let refuse = |rule: String, help: &str| -> Option<MeasuredTable> {
        table.fail("file", rule, help);
        None
    };
    let text = match regular_file::read_to_string(&path) {
        Ok(text) => text,
        Err(cause) => {
            let rule = format!("names {own}, which cannot be read: {cause}");
            return refuse(rule, "correct the path; it is relative to this file");
        }
    };
    files.push(path.clone());
    let lines = text
        .lines()
        .enumerate()
        .map(|(number, line)| (number + 1, line.trim()));
    let mut lines = lines.filter(|(_, line)| !line.is_empty() && !line.starts_with('#'));
    let split = |line: &str| {
        line.split(',')
            .map(|word| word.trim().to_owned())
            .collect::<Vec<_>>()
    };
    let head = lines
        .next()
        .map(|(_, line)| split(line))
        .unwrap_or_default();
    if head.len() < 2 || head[0] != "time_s" {
        let rule = format!("names {own}, whose head is not time_s and one column or more");
        return refuse(
            rule,
            "begin the file with a line such as: time_s, 1 mm, 2 mm",
        );
    }
    let mut rows = Vec::new();
    for (number, line) in lines {
        let words = split(line);
        let values: Vec<f64> = words.iter().filter_map(|word| word.parse().ok()).collect();
        if values.len() != head.len() || values.iter().any(|value: &f64| !value.is_finite()) {
            let rule = format!(
                "names {own}, whose line {number} is not {} numbers with commas between them",
                head.len()
            );
            return refuse(rule, "write one number for each column of the head");
        }
        rows.push(values);
    }
    if rows.is_empty() {
        let rule = format!("names {own}, which has no row");
        return refuse(rule, "add a row for each measurement");
    }
    Some((head, rows))
}

fn sieved(
    table: &TableReader<'_>,
    plant: Option<&Plant>,
    folder: &Path,
    files: &mut Vec<PathBuf>,
) -> Option<Vec<MeasuredDistribution>> {
    let kind = table.exactly_one();
    let deviation = table.number("deviation");
    let read = table_of(table, folder, files);
    let plant = plant?;
    let of = place(table, kind?, Some(plant))?;
    let (head, rows) = read?;
    let mut apertures = Vec::new();
    for text in &head[1..] {
        let value = toml_edit::Value::from(text.as_str());
        apertures.push(table.value("file", &value, Dimension::LENGTH)?);
    }
    let name = match of {
        PlantPlace::Stream(stream) => MeasuredPlace::Stream(plant.streams()[stream].clone()),
        PlantPlace::Unit(unit) => MeasuredPlace::Unit(plant.units()[unit].name.clone()),
    };
    let mut all = Vec::new();
    for row in rows {
        let mut below = 0.0;
        let mut shares = Vec::new();
        for passing in &row[1..] {
            shares.push(passing - below);
            below = *passing;
        }
        let one = MeasuredDistribution {
            place: name.clone(),
            time: row[0],
            edges: std::iter::once(0.0)
                .chain(apertures.iter().copied())
                .collect(),
            shares,
            deviation: deviation?,
        };
        if let Err(error) = one.check() {
            refused(table, "file", &error);
            return None;
        }
        all.push(one);
    }
    Some(all)
}

fn measured(
    table: &TableReader<'_>,
    plant: Option<&Plant>,
    folder: &Path,
    files: &mut Vec<PathBuf>,
) -> Option<PlantMeasuredValues> {
    let kind = table.exactly_one();
    let read = table_of(table, folder, files);
    let plant = plant?;
    let of = place(table, kind?, Some(plant));
    let (field, compound) = field(table, Some(plant))?;
    let of = of?;
    let dimension = dimension_of(field, of);
    let deviation = table.number_as("deviation", dimension)?;
    if deviation <= 0.0 {
        table.fail(
            "deviation",
            "is not above zero",
            "write how far values scatter",
        );
        return None;
    }
    let (head, rows) = read?;
    if head.len() != 2 {
        let rule = format!("names a file of {} columns", head.len());
        table.fail(
            "file",
            rule,
            "it has two: time_s, and the value in SI units",
        );
        return None;
    }
    let name = match of {
        PlantPlace::Stream(stream) => plant.streams()[stream].clone(),
        PlantPlace::Unit(unit) => plant.units()[unit].name.clone(),
    };
    let word = table.raw("field").and_then(|item| item.as_str())?;
    Some(PlantMeasuredValues {
        name: format!("{} of {name}", word.replace('_', " ")),
        of,
        field,
        compound,
        unit: unit_of(dimension),
        points: rows.iter().map(|row| (row[0], row[1])).collect(),
        deviation,
    })
}
