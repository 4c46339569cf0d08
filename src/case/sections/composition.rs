//! Compositions of a gas mixture and of solids: `{ mole = { N2 = 79, O2 = 21 } }` in any ratio, or fractions by `mass`.

use calcine_coupler::physics::solids::SolidSpecies;
use calcine_coupler::physics::thermo::Mixture;

use crate::case::table::{NO_DRYING, TableReader, is_moisture};
use crate::case::units::shown;

/// How far fractions may be from summing to 1: what printed digits leave; they are then scaled.
const SLACK: f64 = 1e-3;

/// What a composition may be of.
struct Constituents<'a> {
    /// Names, in the order of the fractions.
    names: Vec<&'a str>,
    /// Molar masses in kg/mol in that order.
    molar_masses: Vec<f64>,
    /// What is wrong with a name that is none of these, and what to do.
    stranger: &'a dyn Fn(&str) -> [String; 2],
}

/// The mass fractions that a table states, in the order of the mixture's species.
pub(super) fn of_gas(table: &TableReader<'_>, mixture: &Mixture) -> Option<Vec<f64>> {
    let stranger = |_: &str| {
        let help = format!("the species of the gas are {}", mixture.names().join(", "));
        ["is no species of the gas".to_owned(), help]
    };
    let constituents = Constituents {
        names: mixture.names().iter().map(String::as_str).collect(),
        molar_masses: mixture
            .species()
            .iter()
            .map(|one| one.molar_mass())
            .collect(),
        stranger: &stranger,
    };
    read(table, &constituents)
}

/// Refuses the composition of a gas without species.
pub(super) fn no_species(table: &TableReader<'_>) {
    if table.has("composition") {
        let help = "name its species, for example gas.species = [\"O2\", \"N2\"] with gas.schmidt = 0.7, or remove it";
        table.fail("composition", "is of a gas without `gas.species`", help);
    }
}

/// The same of solids.
pub(super) fn of_solids(table: &TableReader<'_>, solids: &[SolidSpecies]) -> Option<Vec<f64>> {
    let names: Vec<&str> = solids.iter().map(SolidSpecies::name).collect();
    let stranger = |name: &str| {
        if is_moisture(name) {
            return NO_DRYING.map(str::to_owned);
        }
        let all = names.join(", ");
        let help = format!("the solids are {all}; others go into [solids]");
        ["is no solid of the case".to_owned(), help]
    };
    let constituents = Constituents {
        names: names.clone(),
        molar_masses: solids.iter().map(SolidSpecies::molar_mass).collect(),
        stranger: &stranger,
    };
    read(table, &constituents)
}

fn read(table: &TableReader<'_>, of: &Constituents<'_>) -> Option<Vec<f64>> {
    let kind = table.exactly_one()?;
    let (inner, numbers) = table.by_name(kind)?;
    let amounts = kind == "mole";
    let mut fractions = vec![0.0; of.names.len()];
    for (name, value) in numbers? {
        let Some(k) = of.names.iter().position(|other| *other == name) else {
            let [rule, help] = (of.stranger)(&name);
            inner.fail(&name, rule, help);
            return None;
        };
        let most = if amounts { f64::MAX } else { 1.0 + SLACK };
        if !(0.0..=most).contains(&value) {
            let help = "mass fractions are between 0 and 1, amounts (`mole`) zero or above";
            inner.fail(&name, format!("is {value}"), help);
            return None;
        }
        fractions[k] = value;
    }
    table.finish();
    let sum: f64 = fractions.iter().sum();
    if let Some(help) = unfit(amounts, sum) {
        table.fail(kind, format!("sums to {}", shown(sum)), help);
        return None;
    }
    if amounts {
        for (fraction, molar_mass) in fractions.iter_mut().zip(&of.molar_masses) {
            *fraction *= molar_mass;
        }
    }
    let sum: f64 = fractions.iter().sum();
    fractions.iter_mut().for_each(|fraction| *fraction /= sum);
    Some(fractions)
}

/// What to do where the numbers of a composition do not come to the right sum: mass fractions to one, amounts to anything but
/// nothing.
fn unfit(amounts: bool, sum: f64) -> Option<&'static str> {
    if amounts && !(sum > 0.0 && sum.is_finite()) {
        return Some("write how many moles there are of at least one");
    }
    (!amounts && (sum - 1.0).abs() > SLACK).then_some("fractions sum to 1")
}
