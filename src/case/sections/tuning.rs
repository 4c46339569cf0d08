//! Cases of the kind "tuning".

use std::path::Path;

use calcine_coupler::physics::dimension::Dimension;
use calcine_tuning::law::{CONVERSION_LAWS, conversion_law};
use calcine_tuning::model::{LUMPED_PARAMETERS, LumpedSettings, ModelParameter, SampleReaction};
use calcine_tuning::{TunedParameter, WholeLoss};

use super::tuning_targets::Targets;
use crate::case::table::TableReader;
use crate::case::units::shown;
use crate::case::words::{
    DifferenceName, ParameterScale, ReactionHeat, SampleCapacity, TunedModel, TuningAlgorithm,
};
use crate::tuning::case::{IntervalSpec, LawCandidate, MethodSpec, SampleSpec, TuningCase};
use crate::tuning::warn;

/// Version of the format that this reader knows.
const FORMAT: u64 = 1;
/// Share of the sample's mass that all reactants may exceed it by, for round-off.
const ROUND_OFF: f64 = 1e-9;
/// Upper over lower bound above which a linear scale leaves the lower decades out of the search.
const WIDE_LINEAR: f64 = 1e3;

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
    let Reactions {
        reactions,
        laws,
        complete,
    } = reactions?;
    let crucible = (of? == TunedModel::Lumped).then_some((settings?, numbers?));
    let mut model = SampleSpec {
        crucible,
        reactions,
        laws,
    };
    let stated = model.reactions.iter().all(|one| !one.mass_loss.is_nan());
    // What is wrong with the parameters is told beside what is wrong with curves and reactions.
    let complete = complete
        && !read.curves.is_empty()
        && take_loss(root, &mut model, measured.map(|one| one.loss)).is_some();
    let parameters = parameters(root, &known_parameters(&model), &mut read.warnings);
    if !complete {
        return None;
    }
    take_middles(&mut model.reactions, &parameters);
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
        kept_back: read.kept_back,
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

/// Reactions as far as they could be read, and the laws of the last one.
struct Reactions {
    reactions: Vec<SampleReaction>,
    laws: Vec<LawCandidate>,
    /// True where nothing is wrong with them.
    complete: bool,
}

/// The reactions; `None` where they have no law, so that nothing can be said of parameters.
fn reactions(root: &TableReader<'_>) -> Option<Reactions> {
    let tables = root.tables("reactions");
    let several = tables.len() > 1;
    let (mut reactions, mut laws): (Vec<SampleReaction>, _) = (Vec::new(), Vec::new());
    let (mut complete, mut lawless) = (true, false);
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
        let mut number = |key: &str| {
            let found = table.number(key);
            complete &= found.is_some();
            found.unwrap_or(f64::NAN)
        };
        let [pre_exponential, activation_energy, reactant, enthalpy] = [
            "pre_exponential",
            "activation_energy",
            "reactant",
            "reaction_enthalpy",
        ]
        .map(&mut number);
        let mass_loss = match table.has("mass_loss") {
            true => number("mass_loss"),
            false => f64::NAN,
        };
        let made = own.first().map(|first| SampleReaction {
            name: if several { name.clone() } else { String::new() },
            law: first.law,
            law_numbers: first.numbers.clone(),
            pre_exponential,
            activation_energy,
            reactant,
            mass_loss,
            enthalpy,
        });
        table.finish();
        if several && own.len() > 1 {
            let help =
                "name one law for each of several reactions, and compare by files of their own";
            table.fail("laws", format!("has {} laws", own.len()), help);
        }
        let tuned = names_parameter(root, &format!("{name}.mass_loss"));
        if several && !table.has("mass_loss") && !tuned {
            table.missing("mass_loss");
        }
        lawless |= made.is_none();
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
    let some = !tables.is_empty() && !lawless;
    some.then_some(Reactions {
        reactions,
        laws,
        complete,
    })
}

/// The laws that a reaction names, with the values of their numbers.
fn candidates(table: &TableReader<'_>) -> Vec<LawCandidate> {
    let names = match table.has("laws") {
        true => table.texts("laws").unwrap_or_default(),
        false => vec!["F1".to_owned()],
    };
    if names.is_empty() && table.has("laws") {
        let help = "name some, such as [\"F1\", \"R3\"] or [\"all\"], or leave it out: it is [\"F1\"] then";
        table.fail("laws", "names no law", help);
    }
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

/// True of a name below `[parameters]`.
fn names_parameter(root: &TableReader<'_>, name: &str) -> bool {
    let table = root.has("parameters").then(|| root.table("parameters"));
    table
        .flatten()
        .is_some_and(|table| table.named().iter().any(|(one, _)| one == name))
}

/// Gives losses that are tuned and not stated the middle of their bounds.
fn take_middles(reactions: &mut [SampleReaction], parameters: &[TunedParameter]) {
    for one in reactions.iter_mut().filter(|one| one.mass_loss.is_nan()) {
        let name = one.number_name("mass_loss");
        if let Some(tuned) = parameters.iter().find(|tuned| tuned.name == name) {
            one.mass_loss = 0.5 * (tuned.low + tuned.high);
        }
    }
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
    if names_parameter(root, "mass_loss") {
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

/// True of the number of some law, be it compared or not.
fn of_another_law(name: &str) -> bool {
    let number = name.rsplit('.').next().unwrap_or(name);
    let mut numbers = CONVERSION_LAWS.iter().flat_map(|law| law.parameters);
    numbers.any(|one| one.name == number)
}

/// The parameters.
fn parameters(
    root: &TableReader<'_>,
    known: &[ModelParameter],
    warnings: &mut Vec<String>,
) -> Vec<TunedParameter> {
    let Some(table) = root.table("parameters") else {
        return Vec::new();
    };
    let mut all = Vec::new();
    for (name, one) in table.named() {
        let own = known.iter().find(|own| own.name == name);
        if own.is_none() && of_another_law(&name) {
            warnings.push(warn::of_no_law(&name));
        } else if own.is_none() {
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
        // What a model takes by its logarithm is above zero by its nature.
        if own.logarithmic && !logarithmic && low < 0.0 {
            let help = "raise it: this number is zero or above";
            one.fail(
                "low",
                format!("is {} {}", shown(low), dimension.unit()),
                help,
            );
            continue;
        }
        if name.rsplit('.').next() == Some("mass_loss") && !(low >= 0.0 && high <= 1.0) {
            let end = if low < 0.0 { "low" } else { "high" };
            let help = "a sample loses between 0 and 1 of its mass";
            one.fail(end, "is no share of a mass", help);
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
        if own.logarithmic && !logarithmic && high > WIDE_LINEAR * low {
            warnings.push(warn::wide_linear(&name));
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
