//! Cases of the kind "tuning".

use std::path::{Path, PathBuf};

use calcine_coupler::physics::dimension::Dimension;
use calcine_tuning::law::{CONVERSION_LAWS, conversion_law};
use calcine_tuning::model::{
    HeatingRun, LUMPED_PARAMETERS, LumpedSettings, ModelParameter, SampleReaction,
};
use calcine_tuning::{
    ComparedQuantity, TargetCurve, TemperatureProgramme, TunedParameter, WholeLoss,
};

use crate::case::table::TableReader;
use crate::case::units::shown;
use crate::case::words::{
    DecimalName, DelimiterName, DifferenceName, ParameterScale, ReactionHeat, SampleCapacity,
    TunedModel, TuningAlgorithm,
};
use crate::tuning::case::{IntervalSpec, LawCandidate, MethodSpec, SampleSpec, TuningCase};
use crate::tuning::curves::{
    CurveColumn, CurveFile, CurveFileError, CurveRules, MassAtStart, MeasuredRun, SheetForm,
    read_curves,
};
use crate::tuning::warn;

/// Version of the format that this reader knows.
const FORMAT: u64 = 1;
/// Share of the sample's mass that all reactants may exceed it by, for round-off.
const ROUND_OFF: f64 = 1e-9;

/// Reads a tuning; `None` where it could not be read (its problems are recorded).
pub(in crate::case) fn tuning(
    root: &TableReader<'_>,
    path: &Path,
    effective: &str,
    hash: String,
) -> Option<TuningCase> {
    if root.whole("format").is_some_and(|format| format != FORMAT) {
        root.fail(
            "format",
            "is not 1, the only one there is",
            "write format = 1",
        );
    }
    let title = root.text("title");
    // Known, even where what comes before it cannot be read.
    root.has("parameters");
    let folder = path.parent().unwrap_or(Path::new("."));
    let model = root.table("model");
    let of = model
        .as_ref()
        .and_then(|table| table.choice::<TunedModel>("type"));
    let numbers = model.as_ref().map(lumped_numbers);
    let settings = model.as_ref().map(settings);
    if let Some(table) = &model {
        table.finish();
    }
    let method = method(&root.table_or_empty("method")?);
    let intervals = intervals(&root.table_or_empty("intervals")?);
    let reactions = reactions(root);
    let mut read = Targets::read(root, folder, of);
    let measured = WholeLoss::of(&read.curves);
    let (reactions, laws) = reactions?;
    let crucible = (of? == TunedModel::Lumped).then_some((settings?, numbers?));
    let mut model = SampleSpec {
        crucible,
        reactions,
        laws,
    };
    if read.curves.is_empty() {
        return None;
    }
    let stated = model.reactions.iter().all(|one| !one.mass_loss.is_nan());
    take_loss(root, &mut model, measured.map(|one| one.loss))?;
    let parameters = parameters(root, &known_parameters(&model));
    let tuned = parameters
        .iter()
        .any(|one| one.name.ends_with("mass_loss") || one.name.ends_with("reactant"));
    let losses = model
        .reactions
        .iter()
        .map(|one| one.reactant * one.mass_loss);
    // A loss that is tuned is not known before.
    let loss = match (stated && !tuned, measured) {
        (false, Some(measured)) => measured.loss,
        _ => losses.sum(),
    };
    read.count(loss);
    let mut warnings = std::mem::take(&mut read.warnings);
    if !stated
        && !tuned
        && let Some(measured) = measured
        && measured.unlike
    {
        warnings.push(warn::unlike_ends(measured.loss));
    }
    let name = path
        .file_stem()
        .map(|stem| stem.to_string_lossy().into_owned());
    let case = TuningCase {
        name: name.unwrap_or_else(|| "tuning".into()),
        title: title?.to_owned(),
        hash,
        path: path.to_owned(),
        effective: effective.to_owned(),
        changes: Vec::new(),
        model,
        parameters,
        files: read.files,
        targets: read.curves,
        starts: read.starts,
        loss,
        method: method?,
        intervals: intervals?,
        warnings,
    };
    chosen_is_compared(root, &case);
    Some(case)
}

fn settings(table: &TableReader<'_>) -> LumpedSettings {
    LumpedSettings {
        heat_capacity_of_composition: table
            .choice::<SampleCapacity>("heat_capacity")
            .is_some_and(|one| one.0),
        enthalpy_of_temperature: table
            .choice::<ReactionHeat>("reaction_heat")
            .is_some_and(|one| one.0),
    }
}

fn lumped_numbers(table: &TableReader<'_>) -> Vec<(&'static str, f64)> {
    let numbers = LUMPED_PARAMETERS.iter();
    let numbers = numbers.filter_map(|(name, ..)| Some((*name, table.number(name)?)));
    numbers.collect()
}

type Reactions = (Vec<SampleReaction>, Vec<LawCandidate>);

fn reactions(root: &TableReader<'_>) -> Option<Reactions> {
    let tables = root.tables("reactions");
    let several = tables.len() > 1;
    let (mut reactions, mut laws): (Vec<SampleReaction>, _) = (Vec::new(), Vec::new());
    let mut complete = true;
    for table in &tables {
        let name = table.text("name").unwrap_or_default().to_owned();
        if several && name.is_empty() {
            table.missing("name");
        }
        if several && reactions.iter().any(|other| other.name == name) {
            table.fail(
                "name",
                format!("is \"{name}\" a second time"),
                "names must differ",
            );
        }
        let own = candidates(table);
        let number = |key: &str| table.number(key);
        let made = (|| {
            let first = own.first()?;
            Some(SampleReaction {
                name: if several { name } else { String::new() },
                law: first.law,
                law_numbers: first.numbers.clone(),
                pre_exponential: number("pre_exponential")?,
                activation_energy: number("activation_energy")?,
                reactant: number("reactant")?,
                mass_loss: if table.has("mass_loss") {
                    number("mass_loss")?
                } else {
                    f64::NAN
                },
                enthalpy: number("reaction_enthalpy")?,
            })
        })();
        table.finish();
        if several && own.len() > 1 {
            let help =
                "name one law for each of several reactions, and compare by files of their own";
            table.fail("laws", format!("has {} laws", own.len()), help);
        }
        if several && !table.has("mass_loss") {
            table.missing("mass_loss");
        }
        complete &= made.is_some();
        reactions.extend(made);
        laws = own;
    }
    let sum: f64 = reactions.iter().map(|one| one.reactant).sum();
    if sum > 1.0 + ROUND_OFF {
        let rule = format!(
            "have reactants of {} of the sample's mass together",
            shown(sum)
        );
        root.fail("reactions", rule, "they are 1 at most");
    }
    if tables.is_empty() {
        return None;
    }
    complete.then_some((reactions, laws))
}

/// The laws that a reaction names, with the values of their numbers.
fn candidates(table: &TableReader<'_>) -> Vec<LawCandidate> {
    let names = match table.has("laws") {
        true => table.texts("laws").unwrap_or_default(),
        false => vec!["F1".to_owned()],
    };
    let stated = |name: &str| table.number(name);
    let mut found: Vec<LawCandidate> = Vec::new();
    for name in names {
        let entries = match name.as_str() {
            "all" => CONVERSION_LAWS.to_vec(),
            one => conversion_law(one).into_iter().collect(),
        };
        if entries.is_empty() {
            let known: Vec<&str> = CONVERSION_LAWS.iter().map(|law| law.name).collect();
            let help = format!("it may be {}, or all", known.join(", "));
            table.fail(
                "laws",
                format!("has the law \"{name}\", which is not known"),
                help,
            );
        }
        for law in entries {
            if found.iter().all(|other| other.law.name != law.name) {
                let numbers = law.parameters.iter().filter_map(|one| stated(one.name));
                found.push(LawCandidate {
                    law,
                    numbers: numbers.collect(),
                });
            }
        }
    }
    for number in ["order", "exponent", "structure"] {
        let used = |one: &LawCandidate| one.law.parameters.iter().any(|own| own.name == number);
        if table.has(number) && !found.iter().any(used) {
            table.fail(
                number,
                "has no effect with these laws",
                "remove it, or name a law that has it",
            );
        }
    }
    found
}

/// Fills in the loss of one reaction from the targets.
fn take_loss(root: &TableReader<'_>, spec: &mut SampleSpec, measured: Option<f64>) -> Option<()> {
    let [only] = &mut spec.reactions[..] else {
        return Some(());
    };
    if !only.mass_loss.is_nan() {
        return Some(());
    }
    if let Some(loss) = measured {
        only.mass_loss = loss / only.reactant;
        return Some(());
    }
    root.tables("reactions").first()?.missing("mass_loss");
    None
}

/// The numbers that a model has with any of its laws.
fn known_parameters(spec: &SampleSpec) -> Vec<ModelParameter> {
    let mut all: Vec<ModelParameter> = Vec::new();
    for candidate in &spec.laws {
        for one in spec.model(candidate).parameters() {
            if all.iter().all(|other| other.name != one.name) {
                all.push(one.clone());
            }
        }
    }
    all
}

/// The parameters.
fn parameters(root: &TableReader<'_>, known: &[ModelParameter]) -> Vec<TunedParameter> {
    let Some(table) = root.table("parameters") else {
        return Vec::new();
    };
    let mut all = Vec::new();
    for (name, one) in table.named() {
        let own = known.iter().find(|own| own.name == name);
        if own.is_none() {
            let names: Vec<&str> = known.iter().map(|one| one.name.as_str()).collect();
            let help = format!("its parameters are {}", names.join(", "));
            one.fail_whole("is not a parameter of this model", &help);
        }
        let bound = |key: &str| {
            let dimension = own?.dimension;
            let item = one.raw(key)?;
            if (item.is_float() || item.is_integer()) && dimension == Dimension::ANGULAR_VELOCITY {
                let rule = "needs a unit, for example \"1e10 1/s\"";
                one.fail(key, rule, "write it in quotes with 1/s or 1/min");
                return None;
            }
            one.number_as(key, dimension)
        };
        let (low, high) = (bound("low"), bound("high"));
        for key in ["low", "high"] {
            one.need(key);
        }
        let scale = one.choice::<ParameterScale>("scale").map(|scale| scale.0);
        one.finish();
        let (Some(low), Some(high), Some(own)) = (low, high, own) else {
            continue;
        };
        let dimension = own.dimension;
        let logarithmic = scale.unwrap_or(own.logarithmic);
        if low >= high {
            let rule = format!("is {} {}, not below `high`", shown(low), dimension.unit());
            let help = "the lower bound comes first: exchange them";
            one.fail("low", rule.replace(" ,", ","), help);
            continue;
        }
        if logarithmic && low <= 0.0 {
            let help = "raise it, or write scale = \"linear\"";
            one.fail(
                "low",
                "is not above zero, which a logarithmic scale needs",
                help,
            );
            continue;
        }
        all.push(TunedParameter {
            name,
            dimension,
            low,
            high,
            logarithmic,
        });
    }
    table.finish();
    if all.is_empty() {
        let help = "add one: [parameters.activation_energy]";
        table.fail_whole("names no parameter that can be tuned", help);
    }
    all
}

fn method(table: &TableReader<'_>) -> Option<MethodSpec> {
    let count = |key: &str| {
        table
            .whole(key)
            .and_then(|count| usize::try_from(count).ok())
    };
    let read = (
        table.choice::<TuningAlgorithm>("algorithm"),
        count("population"),
        count("generations"),
        table.whole("seed"),
        count("samples"),
        count("starts"),
        table.choice::<DifferenceName>("differences"),
        table.text("choose").map(str::to_owned),
        table.truth("polish"),
    );
    table.finish();
    Some(MethodSpec {
        evolution: read.0?.0,
        population: read.1?,
        generations: read.2?,
        seed: read.3?,
        samples: read.4?,
        starts: read.5?,
        differences: read.6?.0,
        choose: read.7,
        polish: read.8?,
    })
}

fn intervals(table: &TableReader<'_>) -> Option<IntervalSpec> {
    let read = (
        table.number("level"),
        table.truth("profile"),
        table.whole("bootstrap"),
    );
    table.finish();
    Some(IntervalSpec {
        level: read.0?,
        profile: read.1?,
        bootstrap: usize::try_from(read.2?).ok()?,
    })
}

/// Refuses an objective that nothing compares.
fn chosen_is_compared(root: &TableReader<'_>, case: &TuningCase) {
    let Some(chosen) = &case.method.choose else {
        return;
    };
    let all = case.targets.iter().flat_map(|target| &target.values);
    let mut names: Vec<&str> = all.map(|(quantity, _)| quantity.name()).collect();
    names.sort_unstable();
    names.dedup();
    if !names.is_empty()
        && !names.contains(&chosen.as_str())
        && let Some(table) = root.table("method")
    {
        let help = format!("it may be {}", names.join(", "));
        table.fail(
            "choose",
            format!("is \"{chosen}\", which no target compares"),
            help,
        );
    }
}

/// What the targets say.
#[derive(Default)]
struct Targets {
    files: Vec<PathBuf>,
    curves: Vec<TargetCurve>,
    /// What the masses of each curve are relative to.
    starts: Vec<Option<MassAtStart>>,
    /// Range of the conversion that counts, of each curve.
    ranges: Vec<Option<[f64; 2]>>,
    /// What is to be told of them.
    warnings: Vec<String>,
}

impl Targets {
    fn read(root: &TableReader<'_>, folder: &Path, of: Option<TunedModel>) -> Self {
        let mut read = Self::default();
        for table in &root.tables("targets") {
            let mut target = Target::of(table, folder);
            read.files.extend(target.path.clone());
            target.lumped = of == Some(TunedModel::Lumped);
            for (curve, start) in target.curves().unwrap_or_default() {
                if let Some(start) = &start
                    && target.sample_mass.is_some()
                    && !target.lumped
                    && !CurveColumn::Mass.is_weighed(&start.unit)
                    && curve.of(ComparedQuantity::LossRate).is_none()
                {
                    read.warnings.push(warn::weighs_no_share(&start.unit));
                }
                read.curves.push(curve);
                read.starts.push(start);
                read.ranges.push(target.conversion);
            }
            table.finish();
        }
        let mut names: Vec<String> = Vec::new();
        for curve in &mut read.curves {
            let mut name = curve.name.clone();
            while names.contains(&name) {
                name.push('\'');
            }
            names.push(name.clone());
            curve.name = name;
        }
        read
    }

    /// Counts what lies within the ranges of conversions, of the loss that goes with a conversion of one.
    fn count(&mut self, loss: f64) {
        for (curve, range) in self.curves.iter_mut().zip(&self.ranges) {
            if let Some([low, high]) = *range {
                curve.count_within(low, high, loss);
            }
        }
    }
}

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

    fn curves(&self) -> Option<Vec<(TargetCurve, Option<MassAtStart>)>> {
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
            Some((self.curve(run, several)?, start))
        });
        curves.collect()
    }

    fn curve(&self, run: MeasuredRun, several: bool) -> Option<TargetCurve> {
        let programme = match self.heating_rate {
            Some(rate) => {
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
        let rate = programme.heating_rate() * 60.0;
        let start_values = run.start.as_ref().and_then(|one| one.rows);
        let curve = TargetCurve {
            name: match &self.name {
                Some(name) if several => format!("{name} {}", run.label),
                Some(name) => name.clone(),
                None => format!("{:.3} K/min", rate).replace(".000", ""),
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
