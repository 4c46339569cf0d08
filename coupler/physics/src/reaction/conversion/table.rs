//! Keys that all laws of conversion take from a case.

use crate::dimension::Dimension;
use crate::law::{Bound, LawParameter, LawTable, LawValues};
use crate::reaction::arrhenius::{ACTIVATION_ENERGY, Arrhenius, EXPONENT};
use crate::reaction::conversion::Conversion;
use crate::reaction::rate_law::RateLaw;

/// The rate constant, and the orders of gases.
pub(super) const RATE: LawTable = LawTable {
    name: "rate",
    required: true,
    meaning: "Rate constant k = factor T^exponent exp(-activation_energy/RT) of the forward reaction.",
    example: "{ factor = 1.235e15, activation_energy = \"325.1 kJ/mol\" }",
    by_name: None,
    parameters: &[FACTOR, EXPONENT, ACTIVATION_ENERGY],
    tables: &[ORDERS],
};

const FACTOR: LawParameter = LawParameter {
    name: "factor",
    dimension: Dimension::NONE,
    bound: Bound::Positive,
    default: None,
    needed_with: None,
    meaning: "A number in mol, m and s: 1/s where no gas has an order.",
    example: "1.235e15",
};

const ORDERS: LawTable = LawTable {
    name: "orders",
    required: false,
    meaning: "Order of each gas, by its concentration in the pores; of none where it is left out.",
    example: "{ CO2 = 0.5 }",
    by_name: Some(Dimension::NONE),
    parameters: &[],
    tables: &[],
};

/// A law of a case from the values of its tables.
pub(super) fn made(values: &LawValues, conversion: Conversion) -> RateLaw {
    let rate = values.table(0).cloned().unwrap_or_default();
    let orders = rate.table(0).cloned().unwrap_or_default();
    RateLaw::Conversion {
        rate_constant: Arrhenius::from_values(&rate),
        conversion,
        orders: orders.by_name,
    }
}
