//! `[gas.patch.NAME]`: boundary conditions of the gas.

use calcine_coupler::physics::Vec3;
use calcine_coupler::physics::gas_model::GasModel;
use calcine_coupler::physics::thermo::Mixture;
use calcine_coupler::setup::{
    CompositionSchedule, GasPatch, InletFlow, Schedule, WallHeat, WallVelocity,
};

use super::composition::{EXAMPLE, fractions};
use super::patches;
use super::turbulence::of_inlet;
use crate::case::model::MeshSpec;
use crate::case::table::TableReader;
use crate::case::units::Dimension;

/// Conditions of all patches, for a gas, turbulent or not; one of constant density cannot flow into a closed domain.
pub(super) fn boundary(
    section: &TableReader<'_>,
    mesh: Option<&MeshSpec>,
    gas: Option<&GasModel>,
    turbulent: Option<bool>,
) -> Option<Vec<(String, GasPatch)>> {
    let table = section.required_table("patch", "[gas.patch.bottom]")?;
    let named = table.named();
    let mut made = Vec::new();
    let mut complete = true;
    for (name, reader) in &named {
        match patch(reader, gas, turbulent) {
            Some(patch) => made.push((name.clone(), patch)),
            None => complete = false,
        }
        reader.finish();
    }
    if let Some(known) = patches(mesh) {
        for (name, _) in &named {
            if !known.contains(&name.as_str()) {
                let help = format!("the patches of the mesh are {}", known.join(", "));
                table.fail(name, "is not a patch of the mesh", help);
            }
        }
        for name in known {
            if !named.iter().any(|(other, _)| other == name) {
                table.missing(
                    name,
                    "{ wall = { velocity = \"no-slip\", heat = \"adiabatic\" } }",
                );
                complete = false;
            }
        }
    }
    let has = |kind: fn(&GasPatch) -> bool| made.iter().any(|(_, patch)| kind(patch));
    let (inlet, outlet) = (
        has(|patch| matches!(patch, GasPatch::Inlet { .. })),
        has(|patch| matches!(patch, GasPatch::Outlet { .. })),
    );
    let fixed = gas.is_some_and(|gas| !gas.compressible());
    if complete && inlet && !outlet && fixed {
        section.fail(
            "patch",
            "lets a gas of constant density in and has no outlet",
            "give one patch outlet = { pressure = \"1 atm\" }",
        );
    }
    complete.then_some(made)
}

fn patch(
    reader: &TableReader<'_>,
    gas: Option<&GasModel>,
    turbulent: Option<bool>,
) -> Option<GasPatch> {
    let kinds = ["inlet", "outlet", "wall", "symmetry"];
    let mut given = kinds.iter().filter(|kind| reader.has(kind));
    let (kind, more) = (given.next(), given.next());
    let (Some(kind), None) = (kind, more) else {
        let message = "needs exactly one of inlet, outlet, wall and symmetry";
        reader.fail_whole(message, "for example outlet = { pressure = \"1 atm\" }");
        return None;
    };
    let table = reader.table(kind)?;
    let made = match *kind {
        "inlet" => inlet(&table, gas, turbulent),
        "outlet" => table
            .pressures("pressure")
            .map(|pressure| GasPatch::Outlet { pressure }),
        "symmetry" => Some(GasPatch::Symmetry),
        _ => wall(&table),
    };
    table.finish();
    made
}

fn inlet(
    table: &TableReader<'_>,
    gas: Option<&GasModel>,
    turbulent: Option<bool>,
) -> Option<GasPatch> {
    let flow = flow(table);
    let temperature = table.temperatures("temperature");
    let turbulence = of_inlet(table, turbulent);
    Some(GasPatch::Inlet {
        flow: flow?,
        temperature: temperature?,
        composition: match gas {
            Some(GasModel::Mixture(mixture)) => Some(composition(table, mixture)?),
            _ => None,
        },
        turbulence: turbulence?,
    })
}

/// `composition` of the gas that flows in.
fn composition(table: &TableReader<'_>, mixture: &Mixture) -> Option<CompositionSchedule> {
    let Some(dated) = table.dated_tables("composition", EXAMPLE) else {
        if !table.has("composition") {
            table.missing("composition", EXAMPLE);
        }
        return None;
    };
    let mut entries = Vec::new();
    for (time, entry) in &dated {
        entries.push((*time, fractions(entry, mixture)?));
    }
    Some(CompositionSchedule(entries))
}

/// `superficial_velocity` or `mass_flow`.
fn flow(table: &TableReader<'_>) -> Option<InletFlow> {
    let keys = ["superficial_velocity", "mass_flow"];
    let mut given = keys.iter().copied().filter(|key| table.has(key));
    let (key, more) = (given.next().unwrap_or(keys[0]), given.next());
    if more.is_some() {
        table.fail(
            "mass_flow",
            "stands beside `superficial_velocity`",
            "state one of the two",
        );
        return None;
    }
    let velocity = key == keys[0];
    let schedule = if velocity {
        table.schedule(key, Dimension::VELOCITY)?
    } else {
        table.schedule(key, Dimension::MASS_FLOW)?
    };
    if schedule.0.iter().any(|entry| entry.1 < 0.0) {
        let help = "it counts into the domain; make the patch an outlet";
        table.fail(key, "is negative", help);
        return None;
    }
    Some(if velocity {
        InletFlow::SuperficialVelocity(schedule)
    } else {
        InletFlow::MassFlow(schedule)
    })
}

fn wall(table: &TableReader<'_>) -> Option<GasPatch> {
    let velocity = wall_velocity(table);
    let heat = match table.raw("heat") {
        None => {
            table.missing("heat", "\"adiabatic\"");
            None
        }
        Some(item) if item.as_table_like().is_some() => {
            let inner = table.table("heat")?;
            let heat = wall_heat(&inner);
            inner.finish();
            heat
        }
        Some(_) => table
            .choice("heat", &[("adiabatic", ())])
            .map(|()| WallHeat::Adiabatic),
    };
    Some(GasPatch::Wall {
        velocity: velocity?,
        heat: heat?,
    })
}

/// `"no-slip"`, `"slip"`, or `{ moving = "1 0 0 m/s" }`.
fn wall_velocity(table: &TableReader<'_>) -> Option<WallVelocity> {
    match table.raw("velocity") {
        Some(item) if item.as_table_like().is_some() => {
            let inner = table.table("velocity")?;
            let velocity = inner.required_vector("moving", Dimension::VELOCITY);
            inner.finish();
            velocity.map(|v| WallVelocity::Moving(Vec3::from(v)))
        }
        _ => table.required_choice(
            "velocity",
            &[
                ("no-slip", WallVelocity::NoSlip),
                ("slip", WallVelocity::Slip),
            ],
        ),
    }
}

/// `{ temperature = … }`, `{ flux = … }`, or `{ coefficient = …, ambient = … }`.
fn wall_heat(table: &TableReader<'_>) -> Option<WallHeat> {
    let kinds = ["temperature", "flux", "coefficient"];
    let mut given = kinds.iter().copied().filter(|kind| table.has(kind));
    let (kind, more) = (given.next(), given.next());
    let (Some(kind), None) = (kind, more) else {
        table.fail_whole(
            "needs exactly one of temperature, flux, and coefficient with ambient",
            "for example { coefficient = \"10 W/m^2/K\", ambient = \"300 K\" }",
        );
        return None;
    };
    match kind {
        "temperature" => table.temperatures(kind).map(WallHeat::Temperature),
        "flux" => table
            .schedule(kind, Dimension::HEAT_FLUX)
            .map(WallHeat::Flux),
        _ => {
            let coefficient = table.schedule(kind, Dimension::HEAT_TRANSFER);
            let ambient = table.temperatures("ambient");
            let coefficient: Schedule = coefficient?;
            if coefficient.0.iter().any(|entry| entry.1 < 0.0) {
                table.fail(kind, "is negative", "heat flows from hot to cold");
                return None;
            }
            Some(WallHeat::Convective {
                coefficient,
                ambient: ambient?,
            })
        }
    }
}
