//! Columns of the state of particles with shells.

use super::physics::RadialPhysics;
use crate::column::{ColumnRole, StateColumn};
use crate::thin::TEMPERATURE;

/// What each column is, in the order of [`columns`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum RadialColumn {
    Surface,
    Shells,
    Amount(usize),
    Pore(usize),
    OwedHeat,
    OwedGas(usize),
    FirstMass,
    FirstVolume,
    Mean,
    Centre,
    Conversion,
    ShellConversion,
    Radii,
    Count,
    Pressure,
    Porosity,
    Fraction(usize),
    ShellFraction(usize),
}

/// The columns of a material.
pub(super) fn kinds(physics: &RadialPhysics) -> Vec<RadialColumn> {
    let (solids, gases) = (0..physics.solids(), 0..physics.gases());
    let mut all = vec![RadialColumn::Surface, RadialColumn::Shells];
    all.extend(solids.clone().map(RadialColumn::Amount));
    all.extend(gases.clone().map(RadialColumn::Pore));
    all.push(RadialColumn::OwedHeat);
    all.extend(gases.map(RadialColumn::OwedGas));
    all.extend([
        RadialColumn::FirstMass,
        RadialColumn::FirstVolume,
        RadialColumn::Mean,
        RadialColumn::Centre,
        RadialColumn::Radii,
        RadialColumn::Count,
    ]);
    if physics.reactions() > 0 {
        all.extend([RadialColumn::Conversion, RadialColumn::ShellConversion]);
        all.extend(solids.clone().map(RadialColumn::Fraction));
        all.extend(solids.map(RadialColumn::ShellFraction));
    }
    if physics.gases() > 0 {
        all.extend([RadialColumn::Pressure, RadialColumn::Porosity]);
    }
    all
}

pub(super) fn columns(physics: &RadialPhysics) -> Vec<StateColumn> {
    let kinds = kinds(physics);
    kinds.iter().map(|kind| column(*kind, physics)).collect()
}

fn column(kind: RadialColumn, physics: &RadialPhysics) -> StateColumn {
    let solid = |k: usize| physics.chemistry.solids[k].name();
    let gas = |k: usize| match &physics.chemistry.gas {
        Some(gas) => gas.names()[k].as_str(),
        None => "",
    };
    let private = |name: &str, unit, what: &str| {
        StateColumn::shown(name, unit, what).with_role(ColumnRole::Private)
    };
    let derived = |name: &str, unit, what: &str| {
        StateColumn::shown(name, unit, what).with_role(ColumnRole::Derived)
    };
    match kind {
        RadialColumn::Surface => {
            StateColumn::shown(TEMPERATURE, "K", "temperature of the particle")
        }
        RadialColumn::Shells => StateColumn::shown(
            "shell_temperature",
            "K",
            "temperature of each shell, from the centre outwards",
        )
        .ragged()
        .in_group(SHELLS),
        RadialColumn::Amount(k) => private(
            &format!("shell_amount.{}", solid(k)),
            "mol",
            "amount of this solid in each shell",
        )
        .ragged(),
        RadialColumn::Pore(k) => private(
            &format!("pore_gas.{}", gas(k)),
            "mol",
            "amount of this gas in the pores of each shell",
        )
        .ragged(),
        RadialColumn::OwedHeat => private(
            "owed_heat",
            "J",
            "heat that windows brought and the next one gives",
        ),
        RadialColumn::OwedGas(k) => private(
            &format!("owed_gas.{}", gas(k)),
            "mol",
            "gas that windows brought and the next one gives",
        ),
        RadialColumn::FirstMass => private("first_mass", "kg", "mass with which the particle came"),
        RadialColumn::FirstVolume => {
            private("first_volume", "m^3", "volume with which the particle came")
        }
        RadialColumn::Mean => derived(
            "mean_temperature",
            "K",
            "temperature, a mean over the volume",
        )
        .in_group(SHELLS),
        RadialColumn::Centre => derived(
            "centre_temperature",
            "K",
            "temperature of the innermost shell",
        )
        .in_group(SHELLS),
        RadialColumn::Radii => derived(
            "shell_radius",
            "m",
            "radius of the outer face of each shell",
        )
        .ragged()
        .in_group(SHELLS),
        RadialColumn::Count => derived(
            "shell_count",
            "1",
            "number of shells, one of a particle that has not turned radial",
        )
        .in_group(SHELLS),
        RadialColumn::Conversion => derived(
            "conversion",
            "1",
            "share of the solid that the first reaction uses up which is converted",
        )
        .in_group(SHELLS),
        RadialColumn::ShellConversion => derived("shell_conversion", "1", "the same of each shell")
            .ragged()
            .in_group(SHELLS),
        RadialColumn::Pressure => derived(
            "shell_pressure",
            "Pa",
            "pressure in the pores of each shell",
        )
        .ragged()
        .in_group(SHELLS),
        RadialColumn::Porosity => derived("shell_porosity", "1", "porosity of each shell")
            .ragged()
            .in_group(SHELLS),
        RadialColumn::ShellFraction(k) => derived(
            &format!("shell_fraction.{}", solid(k)),
            "1",
            "mass fraction of this solid in the solids of each shell",
        )
        .ragged()
        .in_group(SHELLS),
        RadialColumn::Fraction(k) => {
            derived(solid(k), "1", "mass fraction of this solid").in_group("solids")
        }
    }
}

/// Name of the group of columns that show the inside of particles.
const SHELLS: &str = "shells";
