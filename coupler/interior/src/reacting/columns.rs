//! Columns of the state of particles that react.

use super::chemistry::SolidChemistry;
use crate::column::{ColumnRole, StateColumn};
use crate::thin::TEMPERATURE;

/// Name of the group of columns that hold the mass fraction of each solid.
const SOLIDS: &str = "solids";

/// Name of the column of the mass with which a particle came.
const FIRST_MASS: &str = "first_mass";

/// Name of the column of heat that is owed to a particle.
const OWED_HEAT: &str = "owed_heat";

/// Temperature, the amount of each solid in mol, the mass with which it came, the heat that is owed to it, and the mass
/// fraction of each solid, which follows.
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
    let first = StateColumn::shown(FIRST_MASS, "kg", "mass with which the particle came")
        .with_role(ColumnRole::Private);
    let owed = StateColumn::shown(
        OWED_HEAT,
        "J",
        "heat that windows brought and the next one gives",
    )
    .with_role(ColumnRole::Private);
    let state = std::iter::once(temperature).chain(names().map(amount));
    let all = state.chain([first, owed]).chain(names().map(fraction));
    all.collect()
}
