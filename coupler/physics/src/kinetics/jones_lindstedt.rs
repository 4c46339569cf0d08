//! Jones and Lindstedt's four global steps of methane, 1988.

use super::error::KineticsError;
use super::falloff::RateConstant;
use super::mechanism::Mechanism;
use super::statement::ReactionStatement;
use crate::reaction::{Arrhenius, Equation};
use crate::thermo::Mixture;

/// One row of the table: equation; A in kmol, m³, s; b; E in J/kmol; orders.
type Row = (&'static str, f64, f64, f64, &'static [(&'static str, f64)]);

/// CH4 + ½ O2 → CO + 2 H2 and CH4 + H2O → CO + 3 H2 of both sets.
const FUEL: [Row; 2] = [
    (
        "CH4 + 0.5 O2 => CO + 2 H2",
        4.4e11,
        0.0,
        1.26e8,
        &[("CH4", 0.5), ("O2", 1.25)],
    ),
    (
        "CH4 + H2O => CO + 3 H2",
        3.0e8,
        0.0,
        1.26e8,
        &[("CH4", 1.0), ("H2O", 1.0)],
    ),
];

/// CO + H2O ⇌ CO2 + H2 of both sets.
const SHIFT: Row = (
    "CO + H2O <=> CO2 + H2",
    2.75e9,
    0.0,
    8.36e7,
    &[("CO", 1.0), ("H2O", 1.0)],
);

/// Refined so that the rate is regular where hydrogen ends.
const HYDROGEN_REFINED: Row = (
    "H2 + 0.5 O2 <=> H2O",
    5.69e11,
    0.0,
    1.465e8,
    &[("H2", 1.0), ("O2", 0.5)],
);

const HYDROGEN_ORIGINAL: Row = (
    "H2 + 0.5 O2 <=> H2O",
    6.8e15,
    -1.0,
    1.67e8,
    &[("H2", 0.25), ("O2", 1.5)],
);

/// The steps of the refined set, or of the original one (docs/theory.md, CHM-1).
///
/// Source: Jones and Lindstedt, Combust. Flame 73 (1988) 233, doi 10.1016/0010-2180(88)90021-1; the refined third step as in
/// docs/theory.md, CHM-1. Validity: methane with air, lean to moderately rich; there are no radicals, so that flames burn
/// a little too hot.
pub fn steps(refined: bool) -> Result<Vec<ReactionStatement>, KineticsError> {
    let hydrogen = if refined {
        HYDROGEN_REFINED
    } else {
        HYDROGEN_ORIGINAL
    };
    let rows = [FUEL[0], FUEL[1], hydrogen, SHIFT];
    rows.into_iter().map(statement).collect()
}

fn statement(
    (text, factor, exponent, energy, orders): Row,
) -> Result<ReactionStatement, KineticsError> {
    let equation = Equation::parse(text).map_err(|error| KineticsError::Equation {
        reaction: text.into(),
        why: error.to_string(),
    })?;
    let order: f64 = orders.iter().map(|(_, n)| n).sum();
    Ok(ReactionStatement {
        name: text.into(),
        equation,
        orders: Some(
            orders
                .iter()
                .map(|(name, n)| ((*name).into(), *n))
                .collect(),
        ),
        rate: RateConstant::Arrhenius(Arrhenius {
            // From kmol to mol.
            factor: factor * 1000f64.powf(1.0 - order),
            exponent,
            activation_energy: energy / 1000.0,
        }),
        collider: None,
    })
}

impl Mechanism {
    /// The refined four steps, for a mixture that has CH4, O2, CO, H2, H2O, CO2 and whatever does not react.
    pub fn jones_lindstedt(mixture: &Mixture) -> Result<Self, KineticsError> {
        Self::new(mixture, &steps(true)?)
    }

    /// The four steps as first published, whose third is singular where hydrogen ends (see
    /// [`super::mechanism::FLOOR`]).
    pub fn jones_lindstedt_original(mixture: &Mixture) -> Result<Self, KineticsError> {
        Self::new(mixture, &steps(false)?)
    }
}
