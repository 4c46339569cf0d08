//! Runs of a sample from columns.

use std::path::Path;

use super::CurveFileError;
use super::columns::{ColumnChoice, FoundColumn, find};
use super::curve_column::CurveColumn;
use super::sheet::{Sheet, SheetForm, decode, sheet};
use super::start::{MassAtStart, noise, plateau};
use crate::report::number::figure;

/// How a file of curves is read.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct CurveFile {
    /// How numbers are written.
    pub form: SheetForm,
    /// What is said of each column, in the order of [`CurveColumn::ALL`].
    pub columns: [ColumnChoice; 5],
    /// What no sample does.
    pub rules: CurveRules,
}

/// What a run must have, and what it may not do.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CurveRules {
    /// True: a temperature is needed, as the case states no heating rate.
    pub needs_temperature: bool,
    /// Largest rise of the mass, as a share of its whole fall.
    pub largest_rise: f64,
    /// Mass at the start in kg, where it is stated.
    pub initial_mass: Option<f64>,
    /// Share that a mass in % has at the start, where it is stated.
    pub initial_share: Option<f64>,
}

impl Default for CurveRules {
    fn default() -> Self {
        Self {
            needs_temperature: true,
            largest_rise: LARGEST_RISE,
            initial_mass: None,
            initial_share: None,
        }
    }
}

/// Largest rise of a mass unless a case says otherwise: above the noise of a balance, below what buoyancy does to a small
/// sample.
pub(crate) const LARGEST_RISE: f64 = 0.05;
/// Rows of a run at least.
const LEAST_ROWS: usize = 10;
/// Share of the mass at the start that a file begins with at least, where that mass is stated.
const LEAST_START: f64 = 0.05;
/// A loss above the whole mass that is let pass, as the drift of a balance: this share, or so many standard deviations of the noise.
const LARGEST_EXCESS: f64 = 0.05;
const NOISE: f64 = 5.0;
/// Least fall of the mass that counts as one.
const LEAST_FALL: f64 = 1e-3;

/// One run of a sample, in SI.
#[derive(Clone, Debug, PartialEq)]
pub struct MeasuredRun {
    /// Value of the column that tells runs apart, as written; empty where there is none.
    pub label: String,
    /// Times in s from the first row on.
    pub time: Vec<f64>,
    /// Temperatures in K; empty where there is no such column.
    pub temperature: Vec<f64>,
    /// Mass relative to that at the start; empty where there is no such column.
    pub mass: Vec<f64>,
    /// Rate of its fall in 1/s; empty where there is no such column.
    pub loss_rate: Vec<f64>,
    /// Mass at the start in kg, where the file has it.
    pub initial_mass: Option<f64>,
    /// What its masses are relative to, where it has any.
    pub start: Option<MassAtStart>,
    /// Line of each row.
    pub lines: Vec<usize>,
}

/// Reads all runs of a file.
pub fn read_curves(path: &Path, file: &CurveFile) -> Result<Vec<MeasuredRun>, CurveFileError> {
    let bytes = std::fs::read(path).map_err(|cause| {
        let help = "paths are relative to the case file";
        CurveFileError::new(path, None, format!("it cannot be read: {cause}"), help)
    })?;
    parse_curves(path, &bytes, file)
}

/// Reads all runs of the bytes of a file; `path` is what messages name.
pub fn parse_curves(
    path: &Path,
    bytes: &[u8],
    file: &CurveFile,
) -> Result<Vec<MeasuredRun>, CurveFileError> {
    let text = decode(path, bytes)?;
    let runs = CurveColumn::ALL.iter().zip(&file.columns);
    let mut runs = runs.filter(|(column, _)| **column == CurveColumn::Run);
    let runs = runs.find_map(|(_, choice)| choice.heading.as_deref());
    let sheet = sheet(path, &text, file.form, runs)?;
    let mut found: [Option<FoundColumn>; 5] = Default::default();
    for ((column, choice), place) in CurveColumn::ALL.iter().zip(&file.columns).zip(&mut found) {
        *place = find(path, &sheet, *column, choice)?;
    }
    let [time, temperature, mass, rate, run] = found;
    let Some(time) = time else {
        return Err(no_column(path, &sheet, CurveColumn::Time));
    };
    if temperature.is_none() && file.rules.needs_temperature {
        return Err(no_column(path, &sheet, CurveColumn::Temperature));
    }
    if mass.is_none() && rate.is_none() {
        return Err(no_column(path, &sheet, CurveColumn::Mass));
    }
    let columns = Columns {
        time,
        temperature,
        mass,
        rate,
    };
    let groups = groups(&sheet, run.as_ref());
    let runs = groups
        .into_iter()
        .map(|(label, rows)| columns.run(path, &sheet, label, &rows, &file.rules));
    runs.collect()
}

fn no_column(path: &Path, sheet: &Sheet, column: CurveColumn) -> CurveFileError {
    let key = column.key();
    let names: Vec<String> = sheet
        .headings
        .iter()
        .map(|name| format!("\"{name}\""))
        .collect();
    let (line, of) = match &sheet.unknown {
        Some((line, text)) => (
            Some(*line),
            format!(
                "the {} columns, whose headings were not recognised: the line above them is \"{text}\"",
                names.len()
            ),
        ),
        None if sheet.heading_line.is_none() => (
            None,
            format!("the {} columns, which have no headings", names.len()),
        ),
        None => (sheet.heading_line, names.join(", ")),
    };
    let fact = format!("no column was recognised as the {key} among {of}");
    let rate = match column {
        CurveColumn::Temperature => ", or state `heating_rate`",
        _ => "",
    };
    let help =
        format!("name it as `columns.{key}` of the target, by its heading or its number{rate}");
    CurveFileError::new(path, line, fact, help)
}

/// Rows by the value of the column of runs, in the order of the file.
fn groups(sheet: &Sheet, run: Option<&FoundColumn>) -> Vec<(String, Vec<usize>)> {
    let Some(run) = run else {
        return vec![(String::new(), (0..sheet.rows.len()).collect())];
    };
    let mut all: Vec<(String, Vec<usize>)> = Vec::new();
    for (k, row) in sheet.rows.iter().enumerate() {
        let label = match &sheet.labels {
            Some((place, labels)) if *place == run.place => labels[k].clone(),
            _ => row[run.place].to_string(),
        };
        match all.iter_mut().find(|(known, _)| *known == label) {
            Some((_, rows)) => rows.push(k),
            None => all.push((label, vec![k])),
        }
    }
    all
}

struct Columns {
    time: FoundColumn,
    temperature: Option<FoundColumn>,
    mass: Option<FoundColumn>,
    rate: Option<FoundColumn>,
}

impl Columns {
    fn run(
        &self,
        path: &Path,
        sheet: &Sheet,
        label: String,
        rows: &[usize],
        rules: &CurveRules,
    ) -> Result<MeasuredRun, CurveFileError> {
        let of = match label.is_empty() {
            true => String::new(),
            false => format!(" of run {label}"),
        };
        let wrong = |k: usize, fact: String, help: &str| {
            Err(CurveFileError::new(
                path,
                Some(sheet.lines[rows[k]]),
                fact + &of,
                help,
            ))
        };
        if rows.len() < LEAST_ROWS {
            let fact = format!("{} rows are no curve", rows.len());
            return wrong(0, fact, "export the whole curve, ten rows or more");
        }
        let column = |found: &FoundColumn| -> Vec<f64> {
            let value = |&k: &usize| sheet.rows[k][found.place] * found.factor + found.offset;
            rows.iter().map(value).collect()
        };
        let optional =
            |found: &Option<FoundColumn>| found.as_ref().map(&column).unwrap_or_default();
        let time = column(&self.time);
        let finite =
            |found: &FoundColumn| column(found).iter().position(|value| !value.is_finite());
        let others = [&self.temperature, &self.mass, &self.rate]
            .into_iter()
            .flatten();
        if let Some((k, found)) = others
            .chain([&self.time])
            .find_map(|found| Some((finite(found)?, found)))
        {
            let fact = match sheet.rows[rows[k]][found.place].is_nan() {
                true => format!("column {} has NaN", found.place + 1),
                false => "a number is too large for any unit".into(),
            };
            return wrong(k, fact, "correct or remove the row");
        }
        let written = |k: usize, found: &FoundColumn| sheet.rows[rows[k]][found.place];
        let since: Vec<f64> = time.iter().map(|t| t - time[0]).collect();
        if let Some(k) = (1..time.len()).find(|&k| since[k] <= since[k - 1]) {
            let (before, after) = (written(k - 1, &self.time), written(k, &self.time));
            let unit = &self.time.unit;
            let (fact, help) = if time[k] == time[k - 1] {
                (
                    format!("the time {after} {unit} stands there twice"),
                    "remove one of the rows",
                )
            } else if time[k] > time[k - 1] {
                let first = written(0, &self.time);
                (
                    format!(
                        "the times {before} and {after} {unit} are too near each other, so far from the first one, {first} {unit}"
                    ),
                    "correct the first row, or export times from the start of the run",
                )
            } else {
                (
                    format!("the time goes back from {before} to {after} {unit}"),
                    "give each run a file of its own, or a column that tells runs apart as `columns.run`",
                )
            };
            return wrong(k, fact, help);
        }
        let temperature = optional(&self.temperature);
        if let Some(found) = &self.temperature
            && let Some(k) = temperature
                .iter()
                .position(|&t| !(1.0..4000.0).contains(&t))
        {
            let fact = format!(
                "the temperature {} {} is none",
                written(k, found),
                found.unit
            );
            return wrong(k, fact, "correct the row, or the unit of the temperature");
        }
        let (mut mass, mut loss_rate) = (optional(&self.mass), optional(&self.rate));
        let mut initial = rules.initial_mass;
        let mut relative_to = None;
        // Rates in % go by the share of the start as masses do.
        let mut share = rules.initial_share.unwrap_or(1.0);
        if let Some(found) = &self.mass {
            let weighed = CurveColumn::Mass.is_weighed(&found.unit);
            if weighed && rules.initial_share.is_some() {
                let fact = format!("the mass is in {}, of which no share is stated", found.unit);
                return wrong(0, fact, "state `sample_mass` in place of `sample_share`");
            }
            let stated = match weighed {
                true => rules.initial_mass,
                false => rules.initial_share,
            };
            let rows = plateau(&mass);
            let start = stated.unwrap_or_else(|| mass[..rows].iter().sum::<f64>() / rows as f64);
            if !(start > 0.0 && mass[0] > 0.0) {
                let fact = format!(
                    "the mass is {} {} at the start",
                    written(0, found),
                    found.unit
                );
                return wrong(0, fact, "export the mass of the sample, not its change");
            }
            if !weighed && !(0.2..=1.5).contains(&mass[0]) {
                let fact = format!(
                    "the mass is {} {} at the start, where 100 % are meant",
                    written(0, found),
                    found.unit
                );
                return wrong(
                    0,
                    fact,
                    "export the mass of the sample, not its change, relative to that at the start, or state the unit as `units.mass`",
                );
            }
            if weighed && initial.is_none() {
                initial = Some(start);
            }
            if !weighed {
                share = start;
            }
            relative_to = Some(MassAtStart {
                value: start,
                written: start / found.factor,
                unit: found.unit.clone(),
                rows: stated.is_none().then_some(rows),
            });
            mass.iter_mut().for_each(|m| *m /= start);
            let change = "export the mass of the sample, not its change";
            if mass[0] < LEAST_START {
                let fact = format!(
                    "the mass is {} {} at the start, of the {} {} that masses are relative to",
                    written(0, found),
                    found.unit,
                    figure(start / found.factor, 4),
                    found.unit
                );
                return wrong(0, fact, change);
            }
            // A sample may lose all of its mass, and a balance may drift below zero then.
            let least = -LARGEST_EXCESS.max(NOISE * noise(&mass));
            if let Some(k) = mass.iter().position(|&m| m < least) {
                let fact = format!(
                    "the mass is {} {}: the sample loses more than its mass at the start, {} {}",
                    written(k, found),
                    found.unit,
                    figure(start / found.factor, 4),
                    found.unit
                );
                return wrong(k, fact, change);
            }
            if let Err((k, fact, help)) = falls(&mass, rules.largest_rise) {
                return wrong(k, fact, &help);
            }
        }
        if let Some(found) = &self.rate {
            if CurveColumn::LossRate.is_weighed(&found.unit) {
                let Some(start) = initial else {
                    let fact = format!(
                        "the rate is in {}, but the mass at the start is not known",
                        found.unit
                    );
                    return wrong(0, fact, "state `sample_mass` of the target");
                };
                loss_rate.iter_mut().for_each(|r| *r /= start);
            } else {
                loss_rate.iter_mut().for_each(|r| *r /= share);
            }
            // Instruments write the derivative of the mass, which is negative, or its size.
            let sum: f64 = loss_rate.iter().sum();
            loss_rate.iter_mut().for_each(|r| *r *= sum.signum());
        }
        Ok(MeasuredRun {
            label,
            time: since,
            temperature,
            mass,
            loss_rate,
            initial_mass: initial,
            start: relative_to,
            lines: rows.iter().map(|&k| sheet.lines[k]).collect(),
        })
    }
}

/// Refuses a mass that does not fall, or that rises by more than a share of its fall.
fn falls(mass: &[f64], largest: f64) -> Result<(), (usize, String, String)> {
    let fall = mass[0] - mass.iter().copied().fold(f64::INFINITY, f64::min);
    let (mut low, mut worst, mut dip) = (0, (0, 0.0), 0);
    for (k, &m) in mass.iter().enumerate() {
        if m < mass[low] {
            low = k;
        }
        if m - mass[low] > worst.1 {
            worst = (k, m - mass[low]);
            dip = low;
        }
    }
    let percent = |share: f64| format!("{:.3}", 100.0 * share);
    if fall < LEAST_FALL {
        let fact = format!("the mass falls by {} % in all", percent(fall));
        let help = "a loss of mass is tuned: name the right column as `columns.mass`".into();
        return Err((mass.len() - 1, fact, help));
    }
    // A row that falls far below both beside it is what is wrong, not the rise after it.
    let alone = dip > 0 && worst.0 > dip && {
        let least = mass[dip - 1].min(mass[dip + 1]);
        least - mass[dip] > 0.5 * worst.1
    };
    if worst.1 > largest * fall && alone {
        let fact = format!(
            "the mass is {} % of that at the start in this row alone, and {} % in the next",
            percent(mass[dip]),
            percent(mass[dip + 1])
        );
        return Err((dip, fact, "remove the row if the reading failed".into()));
    }
    if worst.1 > largest * fall {
        let fact = format!(
            "the mass rises by {} % of that at the start, {:.1} % of its whole fall",
            percent(worst.1),
            100.0 * worst.1 / fall
        );
        let help = format!(
            "subtract the blank run (buoyancy), cut the row, or, of noise, smooth it or allow it: largest_rise = \"{:.0} %\"",
            (100.0 * worst.1 / fall).ceil()
        );
        return Err((worst.0, fact, help));
    }
    Ok(())
}
