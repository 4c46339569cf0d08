//! Columns of the state of particles that react.

use super::chemistry::SolidChemistry;
use crate::column::{ColumnRole, StateColumn};
use crate::thin::TEMPERATURE;

/// Name of the group of columns that hold the mass fraction of each solid.
const SOLIDS: &str = "solids";

/// Temperature, the amount of each solid in mol, and its mass fraction, which follows.
pub(super) fn columns(chemistry: &SolidChemistry) -> Vec<StateColumn> {
    let names = || chemistry.solids.iter().map(|solid| solid.name());
    let amount = |name: &str| {
        StateColumn::shown(&format!("amount.{name}"), "mol", "amount of this solid")
            .with_role(ColumnRole::Private)
    };
    let fraction = |name: &str| {
        StateColumn::shown(name, "1", "mass fraction of this solid")
            .with_role(ColumnRole::Derived)
            .in_group(SOLIDS)
    };
    let temperature = StateColumn::shown(TEMPERATURE, "K", "temperature of the particle");
    let others = names().map(amount).chain(names().map(fraction));
    std::iter::once(temperature).chain(others).collect()
}
