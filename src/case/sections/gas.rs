//! `[gas]`.

use calcine_coupler::physics::Vec3;
use calcine_coupler::physics::gas::GasProperties;
use calcine_coupler::setup::{GasControls, GasPatch, GasSetup, WallHeat};
use calcine_coupler::time::GasStorage;

use super::patches;
use crate::case::model::MeshSpec;
use crate::case::table::Reader;
use crate::case::units::Dimension;

pub(super) fn read(
    root: &Reader<'_>,
    mesh: Option<&MeshSpec>,
    storage: Option<GasStorage>,
) -> Option<GasSetup> {
    let section = root.required_table("gas", "[gas] with mixture = \"air\"")?;
    let mixture = section.required_text("mixture", "\"air\"");
    let properties = properties(&section, mixture);
    let initial = initial(&section);
    let gravity = section
        .vector("gravity", Dimension::ACCELERATION)
        .unwrap_or([0.0; 3]);
    let patches = boundary(&section, mesh);
    let controls = controls(&section);
    section.finish();
    let (temperature, pressure, velocity) = initial?;
    Some(GasSetup {
        mixture: mixture?.into(),
        properties: properties?,
        storage: storage.unwrap_or_default(),
        temperature,
        pressure,
        velocity,
        gravity: Vec3::from(gravity),
        patches: patches?,
        controls,
    })
}

/// A built-in mixture, or the properties of `[gas.properties]`.
fn properties(section: &Reader<'_>, mixture: Option<&str>) -> Option<GasProperties> {
    if let Some(table) = section.table("properties") {
        let molar_mass = table.required_positive("molar_mass", Dimension::MOLAR_MASS);
        let heat_capacity = table.required_positive("heat_capacity", Dimension::HEAT_CAPACITY);
        let viscosity = table.required_positive("viscosity", Dimension::VISCOSITY);
        let at = table.required_positive("viscosity_at", Dimension::TEMPERATURE);
        let sutherland = table.required_positive("sutherland_temperature", Dimension::TEMPERATURE);
        table.finish();
        let (viscosity, at, sutherland_temperature) = (viscosity?, at?, sutherland?);
        let made = GasProperties {
            molar_mass: molar_mass?,
            heat_capacity: heat_capacity?,
            // μ = A_s √T/(1 + T_s/T), solved for A_s
            sutherland_coefficient: viscosity * (1.0 + sutherland_temperature / at) / at.sqrt(),
            sutherland_temperature,
        };
        if made.heat_capacity <= made.specific_gas_constant() {
            let rule = format!("is not above R/M = {} J/kg/K", made.specific_gas_constant());
            table.fail("heat_capacity", rule, "c_v = c_p - R/M must be positive");
            return None;
        }
        return Some(made);
    }
    match mixture? {
        "air" => Some(GasProperties::air()),
        other => {
            section.fail(
                "mixture",
                format!("is \"{other}\", which is not built in"),
                "write \"air\", or state its [gas.properties]",
            );
            None
        }
    }
}

fn initial(section: &Reader<'_>) -> Option<(f64, f64, Vec3)> {
    let initial = section.required_table(
        "initial",
        "initial = { temperature = \"300 K\", pressure = \"1 atm\" }",
    )?;
    let temperature = initial.required_positive("temperature", Dimension::TEMPERATURE);
    let pressure = initial.required_positive("pressure", Dimension::PRESSURE);
    let velocity = initial
        .vector("velocity", Dimension::VELOCITY)
        .unwrap_or([0.0; 3]);
    initial.finish();
    Some((temperature?, pressure?, Vec3::from(velocity)))
}

fn boundary(section: &Reader<'_>, mesh: Option<&MeshSpec>) -> Option<Vec<(String, GasPatch)>> {
    let table = section.required_table("patch", "[gas.patch.bottom]")?;
    let named = table.named();
    let mut made = Vec::new();
    let mut complete = true;
    for (name, reader) in &named {
        match patch(reader) {
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
    if complete
        && !made
            .iter()
            .any(|(_, patch)| matches!(patch, GasPatch::Outlet { .. }))
    {
        section.fail(
            "patch",
            "has no outlet; a closed domain is not supported yet",
            "give one patch outlet = { pressure = \"1 atm\" }",
        );
    }
    complete.then_some(made)
}

fn patch(reader: &Reader<'_>) -> Option<GasPatch> {
    let kinds = ["inlet", "outlet", "wall"];
    let mut given = kinds.iter().filter(|kind| reader.has(kind));
    let (kind, more) = (given.next(), given.next());
    let (Some(kind), None) = (kind, more) else {
        let message = "needs exactly one of inlet, outlet and wall";
        reader.fail_whole(message, "for example outlet = { pressure = \"1 atm\" }");
        return None;
    };
    let table = reader.table(kind)?;
    let made = match *kind {
        "inlet" => inlet(&table),
        "outlet" => table
            .required_positive("pressure", Dimension::PRESSURE)
            .map(|pressure| GasPatch::Outlet { pressure }),
        _ => wall(&table),
    };
    table.finish();
    made
}

fn inlet(table: &Reader<'_>) -> Option<GasPatch> {
    let velocity = table.schedule("superficial_velocity", Dimension::VELOCITY);
    let temperature = table.temperatures("temperature");
    let (superficial_velocity, temperature) = (velocity?, temperature?);
    if superficial_velocity.0.iter().any(|entry| entry.1 < 0.0) {
        table.fail(
            "superficial_velocity",
            "is negative",
            "it counts into the domain; make the patch an outlet",
        );
        return None;
    }
    Some(GasPatch::Inlet {
        superficial_velocity,
        temperature,
    })
}

fn wall(table: &Reader<'_>) -> Option<GasPatch> {
    let no_slip = table.required_choice("velocity", &[("no-slip", true), ("slip", false)]);
    let heat = match table.raw("heat") {
        None => {
            table.missing("heat", "\"adiabatic\"");
            None
        }
        Some(item) if item.as_table_like().is_some() => {
            let inner = table.table("heat")?;
            let temperature = inner.temperatures("temperature");
            inner.finish();
            temperature.map(WallHeat::Temperature)
        }
        Some(_) => table
            .choice("heat", &[("adiabatic", ())])
            .map(|()| WallHeat::Adiabatic),
    };
    Some(GasPatch::Wall {
        no_slip: no_slip?,
        heat: heat?,
    })
}

/// Defaults: 20 outer iterations to 1e-8, 2 pressure corrections, linear solvers to 1e-13.
fn controls(section: &Reader<'_>) -> GasControls {
    let mut controls = GasControls {
        outer_iterations: 20,
        pressure_corrections: 2,
        outer_tolerance: 1e-8,
        linear_tolerance: 1e-13,
    };
    if let Some(table) = section.table("controls") {
        let count = |key| {
            table
                .whole(key, 1..=10_000)
                .and_then(|n| u32::try_from(n).ok())
        };
        controls.outer_iterations = count("outer_iterations").unwrap_or(controls.outer_iterations);
        controls.pressure_corrections =
            count("pressure_corrections").unwrap_or(controls.pressure_corrections);
        let tolerance = |key| table.positive(key, Dimension::NONE);
        controls.outer_tolerance = tolerance("outer_tolerance").unwrap_or(controls.outer_tolerance);
        controls.linear_tolerance =
            tolerance("linear_tolerance").unwrap_or(controls.linear_tolerance);
        table.finish();
    }
    controls
}
