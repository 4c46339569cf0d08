//! Which rate constants a case may state.

use calcine_coupler::interior::reacting::Rate;
use calcine_coupler::physics::reaction::Arrhenius;

use crate::case::table::TableReader;

/// Temperatures in K at which rate constants are looked at.
const LOOKED_AT: [f64; 3] = [298.15, 1000.0, 3000.0];
/// Largest rate constant of a surface in m/s. Molecules meet it at some 1e3 m/s at most; what is faster than film and layer by far
/// is at its equilibrium, whatever its rate constant, up to where fields and particles would overflow.
const FASTEST_SURFACE: f64 = 1e30;
/// Largest rate constant in mol, m and s: molecules vibrate 1e14 times a second, and what orders do to the unit is within
/// a factor of 1e16, three orders of the concentration of a solid.
const FASTEST_VOLUME: f64 = 1e30;
/// Its unit, and what is said of it.
const WORDS: (&str, &str) = (
    " in mol, m and s",
    "above 1e30, where molecules vibrate 1e14 times a second",
);

/// Refuses rate constants that no reaction has: with them fields and particles would overflow.
pub(super) fn possible(reaction: &TableReader<'_>, rate: &Rate) {
    let Some(table) = reaction.table("rate") else {
        return;
    };
    match rate {
        Rate::Core { rate_constant, .. } => {
            let why = "above 1e30 m/s, where molecules meet a surface at 1400 m/s at most";
            within(&table, rate_constant, FASTEST_SURFACE, (" m/s", why));
        }
        Rate::Conversion { rate_constant, .. } | Rate::Grains { rate_constant, .. } => {
            within(&table, rate_constant, FASTEST_VOLUME, WORDS);
        }
        Rate::Devolatilisation(law) => {
            within(&table, &law.rate, FASTEST_VOLUME, WORDS);
        }
        Rate::Evaporation(_) => {}
        Rate::Power(law) => {
            within(&table, &law.rate_constant, FASTEST_VOLUME, WORDS);
            if let (Some(constant), Some(table)) = (&law.in_series, table.table("in_series")) {
                within(&table, constant, FASTEST_VOLUME, WORDS);
            }
        }
    }
}

/// Refuses rate constants of the gas' own reactions that none has.
pub(super) fn possible_in_gas(rate: &TableReader<'_>, constant: &Arrhenius) {
    within(rate, constant, FASTEST_VOLUME, WORDS);
}

/// What is wrong with a rate constant of a mechanism, which may be negative beside another one of the same reaction; `None`
/// where it is one that a reaction may have.
pub(super) fn impossible(constant: &Arrhenius) -> Option<String> {
    let (kelvin, value) = beyond(|kelvin| constant.at(kelvin).abs(), FASTEST_VOLUME)?;
    let (unit, why) = WORDS;
    Some(format!(
        "a rate constant of {value:.3e}{unit} at {kelvin} K, {why}"
    ))
}

fn within(table: &TableReader<'_>, constant: &Arrhenius, most: f64, words: (&str, &str)) {
    let (unit, why) = words;
    if let Some((kelvin, value)) = beyond(|kelvin| constant.at(kelvin), most) {
        let rule = format!("makes the rate constant {value:.3e}{unit} at {kelvin} K, {why}");
        let help = "correct the factor and its unit, `exponent` or `activation_energy`";
        table.fail("factor", rule, help);
    }
}

/// The first temperature in K at which a rate constant is below zero, above the most, or no number, and what it is there.
fn beyond(at: impl Fn(f64) -> f64, most: f64) -> Option<(f64, f64)> {
    let values = LOOKED_AT.iter().map(|&kelvin| (kelvin, at(kelvin)));
    values
        .into_iter()
        .find(|(_, value)| !(0.0..=most).contains(value))
}
