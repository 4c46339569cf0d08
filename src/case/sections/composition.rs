//! Compositions of a gas mixture: `{ mole = { N2 = 79, O2 = 21 } }` in any ratio, or fractions by `mass`.

use calcine_coupler::physics::thermo::Mixture;

use crate::case::table::TableReader;

/// How far fractions may be from summing to 1: what printed digits leave; they are then scaled.
pub(super) const SLACK: f64 = 1e-3;

/// The mass fractions that a table states, in the order of the mixture's species.
pub(super) fn fractions(table: &TableReader<'_>, mixture: &Mixture) -> Option<Vec<f64>> {
    let kind = table.exactly_one()?;
    let (inner, numbers) = table.by_name(kind)?;
    let mut fractions = vec![0.0; mixture.names().len()];
    for (name, value) in numbers? {
        let Some(k) = mixture.names().iter().position(|other| *other == name) else {
            let help = format!("the species of the gas are {}", mixture.names().join(", "));
            inner.fail(&name, "is no species of the gas", help);
            return None;
        };
        let most = if kind == "mole" {
            f64::MAX
        } else {
            1.0 + SLACK
        };
        if !(0.0..=most).contains(&value) {
            let help = "mass fractions are between 0 and 1, amounts (`mole`) zero or above";
            inner.fail(&name, format!("is {value}"), help);
            return None;
        }
        fractions[k] = value;
    }
    table.finish();
    let sum: f64 = fractions.iter().sum();
    if let Some(help) = unfit(kind, sum) {
        table.fail(kind, format!("sums to {sum}"), help);
        return None;
    }
    Some(if kind == "mole" {
        mixture.mass_fractions(&fractions)
    } else {
        fractions.iter().map(|fraction| fraction / sum).collect()
    })
}

/// What to do where the numbers of a composition do not come to the right sum: mass fractions to one, amounts to anything but
/// nothing.
pub(super) fn unfit(kind: &str, sum: f64) -> Option<&'static str> {
    let amounts = kind == "mole";
    if amounts && !(sum > 0.0 && sum.is_finite()) {
        return Some("write how many moles there are of at least one");
    }
    (!amounts && (sum - 1.0).abs() > SLACK).then_some("fractions sum to 1")
}
