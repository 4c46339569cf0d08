//! Compositions of a gas mixture: `{ mole = { N2 = 0.79, O2 = 0.21 } }`, or by `mass`.

use calcine_coupler::physics::thermo::Mixture;

use crate::case::table::TableReader;

/// How far fractions may be from summing to 1: what printed digits leave; they are then scaled.
const SLACK: f64 = 1e-3;

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
        if !(0.0..=1.0 + SLACK).contains(&value) {
            inner.fail(
                &name,
                format!("is {value}"),
                "fractions are between 0 and 1",
            );
            return None;
        }
        fractions[k] = value;
    }
    table.finish();
    let sum: f64 = fractions.iter().sum();
    if (sum - 1.0).abs() > SLACK {
        let rule = format!("sums to {sum}");
        table.fail(kind, rule, "fractions sum to 1");
        return None;
    }
    Some(if kind == "mole" {
        mixture.mass_fractions(&fractions)
    } else {
        fractions.iter().map(|fraction| fraction / sum).collect()
    })
}
