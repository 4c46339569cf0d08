//! `[[targets]]` of a tuning.

use std::path::{Path, PathBuf};

use calcine_tuning::model::HeatingRun;
use calcine_tuning::{ComparedQuantity, TargetCurve, TemperatureProgramme};

use crate::case::table::TableReader;
use crate::case::units::short3;
use crate::case::words::{DecimalName, DelimiterName, TunedModel};
use crate::tuning::curves::{
    CurveColumn, CurveFile, CurveFileError, CurveRules, MassAtStart, MeasuredRun, SheetForm,
    read_curves,
};
use crate::tuning::warn;

/// A stated heating rate may differ from that of the file's temperatures by this share: a sample lags behind its furnace.
const OTHER_RATE: f64 = 0.1;
/// That lag in s, and what the start of a furnace may differ by in K: half of the rows are nearer to the stated temperatures.
const LONGEST_LAG: f64 = 120.0;
const OTHER_START: f64 = 15.0;
/// Below this temperature in K no furnace begins.
const COLD: f64 = 230.0;
/// A value that stands alone is above or below both of its neighbours, by so many times the change from most values to the next, and by this share of all
/// that the curve spans.
const ALONE: [f64; 2] = [12.0, 0.05];

/// What the targets say.
#[derive(Default)]
pub(super) struct Targets {
    /// Files that were read.
    pub files: Vec<PathBuf>,
    /// Curves that are fitted.
    pub curves: Vec<TargetCurve>,
    /// Curves that the tuned model is compared with afterwards.
    pub kept_back: Vec<TargetCurve>,
    /// What the masses of each curve are relative to.
    pub starts: Vec<Option<MassAtStart>>,
    /// Range of the conversion that counts, of each curve that is fitted and of each that is kept back.
    ranges: [Vec<Option<[f64; 2]>>; 2],
    /// What is to be told of them.
    pub warnings: Vec<String>,
}

impl Targets {
    /// Reads all targets of a file; problems are recorded.
    pub fn read(root: &TableReader<'_>, folder: &Path, of: Option<TunedModel>) -> Self {
        let mut read = Self::default();
        let mut sources: Vec<(PathBuf, CurveFile, Vec<ComparedQuantity>)> = Vec::new();
        let mut repeated = None;
        for table in &root.tables("targets") {
            let mut target = Target::of(table, folder);
            read.files.extend(target.path.clone());
            target.lumped = of == Some(TunedModel::Lumped);
            let curves = target.curves().unwrap_or_default();
            if let (Some(path), Some((curve, ..))) = (&target.path, curves.first()) {
                let quantities = curve.values.iter().map(|one| one.0);
                let quantities: Vec<ComparedQuantity> = quantities.collect();
                let again = sources.iter().any(|(file, form, known)| {
                    file == path
                        && form.columns == target.file.columns
                        && known.iter().any(|one| quantities.contains(one))
                });
                if again {
                    repeated = path
                        .file_name()
                        .map(|name| name.to_string_lossy().into_owned());
                }
                sources.push((path.clone(), target.file.clone(), quantities));
            }
            for (curve, start, told) in curves {
                read.warnings.extend(told);
                if let Some(start) = &start
                    && target.sample_mass.is_some()
                    && !target.lumped
                    && !CurveColumn::Mass.is_weighed(&start.unit)
                    && curve.of(ComparedQuantity::LossRate).is_none()
                {
                    read.warnings.push(warn::weighs_no_share(&start.unit));
                }
                if target.fit {
                    read.curves.push(curve);
                    read.starts.push(start);
                } else {
                    read.kept_back.push(curve);
                }
                read.ranges[usize::from(!target.fit)].push(target.conversion);
            }
            table.finish();
        }
        if read.curves.is_empty() && !read.kept_back.is_empty() {
            let help = "remove `fit = false` from at least one of them";
            root.fail("targets", "has no curve that is fitted", help);
        }
        let mut names: Vec<String> = Vec::new();
        for curve in read.curves.iter_mut().chain(&mut read.kept_back) {
            let mut name = curve.name.clone();
            while names.contains(&name) {
                name.push('\'');
            }
            names.push(name.clone());
            curve.name = name;
        }
        let twins = read.curves.iter().enumerate().find_map(|(k, one)| {
            let same = |other: &&TargetCurve| {
                other.run.times == one.run.times && other.values == one.values
            };
            Some((one, read.curves[k + 1..].iter().find(same)?))
        });
        if let Some((one, other)) = twins {
            read.warnings.push(warn::same_curve(&one.name, &other.name));
        } else if let Some(file) = repeated {
            read.warnings.push(warn::same_file(&file));
        }
        read
    }

    /// Counts what lies within the ranges of conversions, of the loss that goes with a conversion of one.
    pub fn count(&mut self, loss: f64) {
        let [fitted, kept_back] = &self.ranges;
        let all = self.curves.iter_mut().zip(fitted);
        for (curve, range) in all.chain(self.kept_back.iter_mut().zip(kept_back)) {
            if let Some([low, high]) = *range {
                curve.count_within(low, high, loss);
            }
        }
    }
}

/// A curve, what its masses are relative to, and what is to be told of it.
type ReadCurve = (TargetCurve, Option<MassAtStart>, Vec<String>);

/// One `[[targets]]`.
struct Target<'t, 'a> {
    table: &'t TableReader<'a>,
    path: Option<PathBuf>,
    name: Option<String>,
    file: CurveFile,
    compare: Option<Vec<String>>,
    sample_mass: Option<f64>,
    heating_rate: Option<f64>,
    start_temperature: Option<f64>,
    conversion: Option<[f64; 2]>,
    fit: bool,
    lumped: bool,
}

impl<'t, 'a> Target<'t, 'a> {
    fn of(table: &'t TableReader<'a>, folder: &Path) -> Self {
        let mut file = CurveFile::default();
        if let Some(columns) = table.table_or_empty("columns") {
            for (choice, column) in file.columns.iter_mut().zip(CurveColumn::ALL) {
                choice.heading = columns.text(column.key()).map(str::to_owned);
            }
            columns.finish();
        }
        if let Some(units) = table.table_or_empty("units") {
            for (choice, column) in file.columns.iter_mut().zip(CurveColumn::ALL) {
                if column != CurveColumn::Run {
                    choice.unit = units.text(column.key()).map(str::to_owned);
                }
            }
            units.finish();
        }
        file.form = SheetForm {
            delimiter: table.choice::<DelimiterName>("delimiter").map(|one| one.0),
            decimal_comma: table.choice::<DecimalName>("decimal").map(|one| one.0),
        };
        let heating_rate = table.number("heating_rate");
        let sample_mass = table.number("sample_mass");
        file.rules = CurveRules {
            needs_temperature: heating_rate.is_none(),
            largest_rise: table.number("largest_rise").unwrap_or(0.0),
            initial_mass: sample_mass,
            initial_share: table
                .has("sample_share")
                .then(|| table.number("sample_share"))
                .flatten(),
        };
        Self {
            path: table.text("file").map(|file| folder.join(file)),
            name: table.text("name").map(str::to_owned),
            file,
            compare: table
                .has("compare")
                .then(|| table.choices("compare"))
                .flatten(),
            sample_mass,
            heating_rate,
            start_temperature: table.number("start_temperature"),
            conversion: range(table),
            fit: table.truth("fit").unwrap_or(true),
            lumped: false,
            table,
        }
    }

    fn refused(&self, error: &CurveFileError) {
        self.table.fail(
            "file",
            format!("cannot be taken: {error}"),
            error.help.clone(),
        );
    }

    /// Each curve with what its masses are relative to and what is to be told of it.
    fn curves(&self) -> Option<Vec<ReadCurve>> {
        let path = self.path.as_ref()?;
        let runs = match read_curves(path, &self.file) {
            Ok(runs) => runs,
            Err(error) => {
                self.refused(&error);
                return None;
            }
        };
        let several = runs.len() > 1;
        let curves = runs.into_iter().map(|run| {
            let start = run.start.clone();
            let told = self.told(path, &run);
            Some((self.curve(run, several)?, start, told))
        });
        curves.collect()
    }

    /// What of a run is likely not meant so.
    fn told(&self, path: &Path, run: &MeasuredRun) -> Vec<String> {
        let file = path.file_name().unwrap_or_default().to_string_lossy();
        let mut told = Vec::new();
        let start = run.temperature.first().copied();
        if let Some(start) = start.or(self.start_temperature)
            && start < COLD
        {
            told.push(warn::cold_start(&file, start));
        }
        if let Some(k) = lone_value(&run.mass) {
            told.push(warn::lone_value(&file, run.lines[k]));
        }
        told
    }

    /// Refuses a stated heating rate that the file's own temperatures contradict.
    fn agrees(&self, rate: f64, run: &MeasuredRun) -> Option<()> {
        // What is wrong with the temperatures themselves is told where they are taken.
        let measured = TemperatureProgramme::new(run.time.clone(), run.temperature.clone());
        let (Ok(measured), Some(start)) = (measured, self.start_temperature) else {
            return Some(());
        };
        let own = measured.ramp_rate();
        let own = own.unwrap_or_else(|| measured.heating_rate());
        if (own / rate - 1.0).abs() <= OTHER_RATE {
            let rows = run.time.iter().zip(&run.temperature);
            let mut above: Vec<f64> = rows.map(|(time, own)| start + rate * time - own).collect();
            above.sort_by(f64::total_cmp);
            let middle = above[above.len() / 2];
            if middle.abs() <= OTHER_START.max(LONGEST_LAG * rate) {
                return Some(());
            }
            let rule = format!(
                "is {:.4} K/min from {:.1} °C on, {:.0} K {} the temperatures of the file",
                60.0 * rate,
                start - 273.15,
                middle.abs(),
                if middle > 0.0 { "above" } else { "below" }
            );
            let help = "cut the rows before the ramp, state `start_temperature`, or remove `heating_rate`: the temperatures of the file are taken then";
            self.table.fail("heating_rate", rule, help);
            return None;
        }
        let rule = format!(
            "is {:.4} K/min, but the temperatures of the file rise by {:.4} K/min",
            60.0 * rate,
            60.0 * own
        );
        let help = "remove it, and the temperatures of the file are taken, or correct it";
        self.table.fail("heating_rate", rule, help);
        None
    }

    /// Name of a curve that has none: the rate of its ramp, or its file, with the run of it.
    fn rate_or_file(&self, programme: &TemperatureProgramme, label: &str) -> String {
        if let Some(rate) = programme.ramp_rate() {
            return format!("{} K/min", short3(60.0 * rate));
        }
        let stem = self.path.as_ref().and_then(|path| path.file_stem());
        let stem = stem.unwrap_or_default().to_string_lossy();
        format!("{stem} {label}").trim_end().to_owned()
    }

    fn curve(&self, run: MeasuredRun, several: bool) -> Option<TargetCurve> {
        let programme = match self.heating_rate {
            Some(rate) => {
                self.agrees(rate, &run)?;
                let end = run.time.last().copied()?;
                TemperatureProgramme::heating(self.start_temperature?, rate, end.max(1.0))
            }
            None => TemperatureProgramme::new(run.time.clone(), run.temperature.clone()),
        };
        let programme = match programme {
            Ok(programme) => programme,
            Err(error) => {
                self.table.fail(
                    "file",
                    format!("cannot be taken: {error}"),
                    "correct the file",
                );
                return None;
            }
        };
        let mass = self.sample_mass.or(run.initial_mass);
        if self.lumped && mass.is_none() {
            self.table.missing("sample_mass");
            return None;
        }
        let has = |quantity: ComparedQuantity| match quantity {
            ComparedQuantity::Temperature => &run.temperature,
            ComparedQuantity::Mass => &run.mass,
            ComparedQuantity::LossRate => &run.loss_rate,
        };
        let wanted = |quantity: ComparedQuantity| match &self.compare {
            Some(named) => named.iter().any(|name| name == quantity.name()),
            None if has(ComparedQuantity::Mass).is_empty() => {
                quantity == ComparedQuantity::LossRate
            }
            None => quantity == ComparedQuantity::Mass,
        };
        let mut values = Vec::new();
        for quantity in ComparedQuantity::ALL.into_iter().filter(|one| wanted(*one)) {
            let list = has(quantity);
            if list.is_empty() {
                let rule = format!("has {}, for which the file has no column", quantity.name());
                self.table.fail(
                    "compare",
                    rule,
                    "remove it, or name its column in `columns`",
                );
                return None;
            }
            if quantity == ComparedQuantity::Temperature && !self.lumped {
                let help = "remove it: a kinetic model takes the temperature of the file as it is";
                self.table.fail("compare", "has temperature", help);
                return None;
            }
            if quantity == ComparedQuantity::Temperature && self.heating_rate.is_none() {
                let help = "the furnace's temperature comes from heating_rate then: state it, for example \"15 K/min\"";
                self.table
                    .fail("compare", "has temperature, the sample's", help);
                return None;
            }
            values.push((quantity, list.clone()));
        }
        if values.is_empty() {
            self.table
                .fail("compare", "is empty", "name mass, loss_rate or temperature");
            return None;
        }
        let start_values = run.start.as_ref().and_then(|one| one.rows);
        let curve = TargetCurve {
            name: match &self.name {
                Some(name) if several => format!("{name} {}", run.label),
                Some(name) => name.clone(),
                // A run that the file names.
                None if !run.label.is_empty() && run.label.parse::<f64>().is_err() => {
                    run.label.clone()
                }
                None => self.rate_or_file(&programme, &run.label),
            },
            run: HeatingRun {
                programme,
                sample_mass: mass.unwrap_or(0.0),
                times: run.time,
            },
            values,
            counted: Vec::new(),
            start_values,
        };
        if self.conversion.is_some() && curve.of(ComparedQuantity::Mass).is_none() {
            let help = "add mass to `compare`, or remove it";
            self.table
                .fail("conversion", "needs the mass to be compared", help);
        }
        Some(curve)
    }
}

/// The value farthest above or below both of its neighbours, where it stands alone.
fn lone_value(values: &[f64]) -> Option<usize> {
    let bend = |k: usize| {
        let [before, after] = [values[k - 1], values[k + 1]].map(|beside| values[k] - beside);
        if before * after > 0.0 {
            0.5 * (before + after).abs()
        } else {
            0.0
        }
    };
    let bends = (1..values.len().saturating_sub(1)).map(bend);
    let (place, worst) = bends.enumerate().max_by(|a, b| a.1.total_cmp(&b.1))?;
    let changes = values.windows(2).map(|pair| (pair[1] - pair[0]).abs());
    let mut sorted: Vec<f64> = changes.collect();
    sorted.sort_by(f64::total_cmp);
    let usual = sorted[sorted.len() / 2];
    let ends = |pick: fn(f64, f64) -> f64| values.iter().copied().reduce(pick).unwrap_or(0.0);
    let span = ends(f64::max) - ends(f64::min);
    (worst > ALONE[0] * usual && worst > ALONE[1] * span).then_some(place + 1)
}

/// `conversion = [low, high]`.
fn range(table: &TableReader<'_>) -> Option<[f64; 2]> {
    if !table.has("conversion") {
        return None;
    }
    let item = table.raw("conversion")?;
    let number = |value: &toml_edit::Value| {
        value
            .as_float()
            .or_else(|| value.as_integer().map(|n| n as f64))
    };
    let numbers = item
        .as_array()
        .map(|list| list.iter().map(number).collect::<Vec<_>>());
    match numbers.as_deref() {
        Some([Some(low), Some(high)]) if 0.0 <= *low && low < high && *high <= 1.0 => {
            Some([*low, *high])
        }
        _ => {
            let rule = "needs two numbers from 0 to 1, the lower one first";
            table.fail(
                "conversion",
                rule,
                "for example conversion = [0.001, 0.999]",
            );
            None
        }
    }
}
