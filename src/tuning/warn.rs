//! What is to be told of a tuning beside its numbers.

use calcine_tuning::ParameterSpace;
use calcine_tuning::interval::ParameterPair;
use calcine_tuning::least_squares::FittedPlaces;

use super::case::TuningCase;
use super::outcome::{FoundParameter, LawFit, LawFreeEnergies};
use crate::case::units::short3;

/// Heating rates that differ by less than this share are one.
const SAME_RATE: f64 = 0.1;
/// Difference of temperature in K up to which holds count as one.
const SAME_HOLD: f64 = 5.0;
/// Energies that differ by more than this share are told, and by less where only one law was fitted.
const OTHER_ENERGY: f64 = 0.1;
const OF_ONE_LAW: f64 = 0.05;

/// A run that begins colder than a furnace does.
pub(crate) fn cold_start(file: &str, start: f64) -> String {
    format!(
        "{file} begins at {:.1} °C ({start:.1} K): is the unit of its temperature right? State it as `units.temperature`",
        start - 273.15
    )
}

/// A value that nothing beside it goes with.
pub(crate) fn lone_value(file: &str, line: usize) -> String {
    format!(
        "{file}, line {line}: the mass stands alone, far off the rows before and after it; one such row can change law and energy: remove it if a reading failed"
    )
}

/// One curve under two names.
pub(crate) fn same_curve(one: &str, other: &str) -> String {
    format!(
        "the targets {one} and {other} have the same values: one of them counts twice; remove it"
    )
}

/// One file in two targets.
pub(crate) fn same_file(file: &str) -> String {
    format!(
        "{file} is named by two targets with the same columns: what both compare counts twice, or is fitted where it is kept back; remove one of them"
    )
}

/// A mass at the start that a curve of shares has no use for.
pub(crate) fn weighs_no_share(unit: &str) -> String {
    format!(
        "`sample_mass` has no effect on masses in {unit}: they are relative to their own start, which `sample_share` states"
    )
}

/// Curves that end at unlike masses, with a loss that nobody states.
pub(crate) fn unlike_ends(loss: f64) -> String {
    format!(
        "the curves end at unlike masses: the mass loss is taken as the largest, {} of the sample, and is too small where no curve runs to \
         completion; state `mass_loss`, or tune it",
        short3(loss)
    )
}

/// A number that none of the laws has.
pub(crate) fn of_no_law(name: &str) -> String {
    format!("`parameters.{name}` has no effect: none of the laws that are compared has it")
}

/// Bounds of a number of many decades that are searched evenly.
pub(crate) fn wide_linear(name: &str) -> String {
    format!(
        "`parameters.{name}` has bounds of several decades on a linear scale: nine tenths of the search lie in the topmost one, and the \
         best value may be missed; write scale = \"logarithmic\" with a lower bound above zero"
    )
}

/// A curve that tells nothing of energies without a law.
pub(super) fn left_out(name: &str) -> String {
    format!("{name} is left out: it has no mass, too few values, or a conversion below 5 %")
}

/// Differences whose neighbours go together.
pub(super) fn memory(lag: f64) -> String {
    format!(
        "differences between model and measurement go together from point to point (correlation {}): the model misses something, \
         or the noise has a memory; intervals by profiles are too narrow then, those of the bootstrap, drawn in blocks, less so",
        short3(lag)
    )
}

/// Parameters on a bound, and intervals that end there.
pub(super) fn bounds(found: &[FoundParameter]) -> Vec<String> {
    let mut told = Vec::new();
    for one in found {
        let side = |k: usize| ["lower", "upper"][k];
        let unit = if one.unit.is_empty() {
            String::new()
        } else {
            format!(" {}", one.unit)
        };
        if one.at_bound {
            let near = |bound: f64| (one.value - bound).abs();
            let k = usize::from(near(one.bounds[1]) < near(one.bounds[0]));
            told.push(format!(
                "`{}` stands on its {} bound, {}{unit}: widen the bounds, or doubt the model; its interval means little",
                one.name,
                side(k),
                short3(one.bounds[k])
            ));
        } else if let Some(k) = one.open.iter().position(|open| *open) {
            told.push(format!(
                "the targets do not limit `{}` towards its {} bound, {}{unit}",
                one.name,
                side(k),
                short3(one.bounds[k])
            ));
        }
    }
    told
}

/// Parameters that move nothing.
pub(super) fn without_effect(space: &ParameterSpace, fitted: &FittedPlaces) -> String {
    let still = |column: &Vec<f64>| column.iter().all(|one| *one == 0.0);
    let free = fitted.free.iter().zip(&fitted.jacobian);
    let names = free
        .filter(|(_, column)| still(column))
        .map(|(&k, _)| format!("`{}`", space.parameters()[k].name));
    let names: Vec<String> = names.collect();
    match names.is_empty() {
        true => {
            "some combination of the parameters has no effect on what is compared: fix one of them"
                .into()
        }
        false => format!(
            "{} has no effect on what is compared: fix it",
            names.join(", ")
        ),
    }
}

/// Pairs that cannot be told apart.
pub(super) fn pairs(space: &ParameterSpace, pairs: &[ParameterPair]) -> Vec<String> {
    let name = |k: usize| &space.parameters()[k].name;
    let told = pairs.iter().map(|pair| {
        format!(
            "`{}` and `{}` are correlated by {:.4}: each is known only together with the other",
            name(pair.first),
            name(pair.second),
            pair.correlation
        )
    });
    told.collect()
}

/// Laws whose best fit is no better than no reaction.
pub(super) fn explain_nothing(laws: &[LawFit]) -> Option<String> {
    let names = laws.iter().filter(|one| one.explains_nothing());
    let names: Vec<&str> = names.map(|one| one.law).collect();
    (!names.is_empty()).then(|| {
        format!(
            "within the bounds the best fit by {} is no better than a sample that does not react: these values mean nothing; widen the \
             bounds of pre_exponential and activation_energy, or raise `method.samples`",
            names.join(", ")
        )
    })
}

/// One heating rate cannot tell energy, pre-exponential factor and law apart.
pub(super) fn one_rate(
    case: &TuningCase,
    laws: &[LawFit],
    chosen: usize,
    found: &[FoundParameter],
) -> Option<String> {
    let tuned = |end: &str| found.iter().find(|one| one.name.ends_with(end));
    let energy = tuned("activation_energy")?;
    tuned("pre_exponential")?;
    let rates: Vec<f64> = case
        .targets
        .iter()
        .map(|one| one.run.programme.heating_rate())
        .collect();
    let (low, high) = rates
        .iter()
        .fold((f64::INFINITY, 0.0f64), |(low, high), &rate| {
            (low.min(rate), high.max(rate))
        });
    if high > low * (1.0 + SAME_RATE) {
        return None;
    }
    // Holds at several temperatures tell the energy as several heating rates do.
    let held = case.targets.iter().filter_map(|one| {
        let programme = &one.run.programme;
        let hold = programme.ramp_rate().is_none();
        hold.then(|| programme.points().1.last().copied()).flatten()
    });
    let (coldest, hottest) = held.fold((f64::INFINITY, 0.0f64), |(low, high), kelvin| {
        (low.min(kelvin), high.max(kelvin))
    });
    if hottest - coldest > SAME_HOLD {
        return None;
    }
    let law = laws.get(chosen).map_or("", |one| one.law);
    let ramps = case.targets.iter();
    let ramp = ramps.filter_map(|one| one.run.programme.ramp_rate()).next();
    let mut text = format!(
        "all targets have one heating rate, {} K/min: energy, pre-exponential factor and law cannot be told apart by it. The energy of \
         {} kJ/mol holds only if {law} is the law",
        short3(60.0 * ramp.unwrap_or(high)),
        short3(energy.value / 1e3)
    );
    let others = laws.iter();
    let others = others.filter(|one| one.law != law && !one.explains_nothing());
    let others = others.filter_map(|one| {
        let energy = one
            .values
            .iter()
            .find(|(name, _)| name.ends_with("activation_energy"))?;
        Some(format!(
            "{} gives {} kJ/mol",
            one.law,
            short3(energy.1 / 1e3)
        ))
    });
    let others: Vec<String> = others.collect();
    if others.is_empty() {
        text.push_str(
            ": by first order on a solid that shrinks it comes out 20 to 40 % too high (docs/theory.md, TUN-11). Compare laws: laws = [\"all\"]",
        );
    } else {
        text.push_str(&format!(" ({})", others.join(", ")));
    }
    text.push_str("; measure three heating rates or more");
    Some(text)
}

/// An energy far from those without a law.
pub(super) fn energies_differ(
    energies: &LawFreeEnergies,
    found: &[FoundParameter],
    laws: &[LawFit],
) -> Option<String> {
    let energy = found
        .iter()
        .find(|one| one.name == "activation_energy")?
        .value;
    let inner = energies
        .friedman
        .iter()
        .filter(|one| (0.2..0.81).contains(&one.conversion));
    let inner: Vec<f64> = inner.map(|one| one.energy).collect();
    if inner.is_empty() {
        return None;
    }
    let mean = inner.iter().sum::<f64>() / inner.len() as f64;
    let off = (energy / mean - 1.0).abs();
    let (most, advice) = match laws {
        [one] => (
            OF_ONE_LAW,
            format!("; only {} was fitted: compare laws = [\"all\"]", one.law),
        ),
        _ => (OTHER_ENERGY, String::new()),
    };
    (off > most).then(|| {
        format!(
            "the energy of {} kJ/mol differs from that without a law (Friedman, {} kJ/mol) by {:.0} %: the law does not fit, or heat \
             transfer limits the rate{advice}",
            short3(energy / 1e3),
            short3(mean / 1e3),
            100.0 * off
        )
    })
}
