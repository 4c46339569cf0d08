//! `[gas]`.

use std::path::{Path, PathBuf};

use calcine_coupler::gas_chemistry::Combustion;
use calcine_coupler::momentum_model::MomentumModel;
use calcine_coupler::physics::Vec3;
use calcine_coupler::physics::gas::GasProperties;
use calcine_coupler::physics::gas_model::{ConstantGas, GasModel};
use calcine_coupler::setup::{Convection, GasControls, GasSetup};
use calcine_coupler::time::GasStorage;

use super::chemistry::{Around, chemistry};
use super::composition::fractions;
use super::gas_patch::boundary;
use super::species_data;
use super::turbulence::turbulence;
use crate::case::model::MeshSpec;
use crate::case::table::TableReader;
use crate::case::units::Dimension;

/// What the section says.
pub(super) struct GasRead {
    pub setup: GasSetup,
    pub held: bool,
    /// Files of its chemistry.
    pub files: Vec<PathBuf>,
}

pub(super) fn read(
    root: &TableReader<'_>,
    mesh: Option<&MeshSpec>,
    storage: Option<GasStorage>,
    folder: &Path,
) -> Option<GasRead> {
    let section = root.required_table("gas", "[gas] with mixture = \"air\"")?;
    let mixture = section.required_text("mixture", "\"air\"");
    let (properties, mut files) = match properties(&section, mixture, folder) {
        Some((gas, files)) => (Some(gas), files),
        None => (None, Vec::new()),
    };
    let schmidt = schmidt(&section, properties.as_ref());
    let initial = initial(&section, properties.as_ref());
    let gravity = section
        .vector("gravity", Dimension::ACCELERATION)
        .unwrap_or([0.0; 3]);
    let held = section.truth("held").unwrap_or(false);
    let turbulence = turbulence(&section);
    let turbulent = turbulence.map(|model| !model.is_laminar());
    let patches = boundary(&section, mesh, properties.as_ref(), turbulent);
    let controls = controls(&section);
    let around = Around {
        gas: properties.as_ref(),
        initial: initial.as_ref().map_or(&[], |initial| &initial.3),
        patches: patches.as_deref().unwrap_or_default(),
    };
    let chemistry = chemistry(&section, &around, folder);
    section.finish();
    let (temperature, pressure, velocity, composition) = initial?;
    let (reacting, more) = chemistry?;
    files.extend(more);
    let stirred = reacting
        .reacting()
        .is_some_and(|gas| gas.combustion != Combustion::Laminar);
    if stirred && turbulent == Some(false) {
        let help = "state [gas.turbulence], or write model = \"laminar\"";
        let rule = "has the model `pasr`, but the gas has no eddies to mix it";
        section.fail("chemistry", rule, help);
    }
    if held && reacting.reacting().is_some() {
        let help = "leave `gas.held` out, or `gas.chemistry`";
        let rule = "reacts, but `gas.held` leaves the gas as it is at the start";
        section.fail("chemistry", rule, help);
    }
    let setup = GasSetup {
        mixture: mixture?.into(),
        properties: properties?,
        schmidt: schmidt?,
        chemistry: reacting,
        storage: storage.unwrap_or_default(),
        temperature,
        composition,
        pressure,
        velocity,
        gravity: Vec3::from(gravity),
        turbulence: turbulence?,
        momentum: MomentumModel::default(), // `laws.drag.model` says
        patches: patches?,
        controls,
    };
    Some(GasRead { setup, held, files })
}

/// A built-in mixture, or the properties of `[gas.properties]` or `[gas.constant]`.
fn properties(
    section: &TableReader<'_>,
    mixture: Option<&str>,
    folder: &Path,
) -> Option<(GasModel, Vec<PathBuf>)> {
    if let Some(species) = section.texts("species") {
        let made = species_data::mixture(section, &species, folder);
        return made.map(|(mixture, files)| (GasModel::Mixture(mixture), files));
    }
    if let Some(table) = section.table("species_data") {
        table.fail_whole(
            "stands beside a gas without species",
            "state `gas.species`, or remove it",
        );
        return None;
    }
    single(section, mixture).map(|gas| (gas, Vec::new()))
}

/// A gas without species.
fn single(section: &TableReader<'_>, mixture: Option<&str>) -> Option<GasModel> {
    if let Some(table) = section.table("constant") {
        let density = table.required_positive("density", Dimension::DENSITY);
        let heat_capacity = table.required_positive("heat_capacity", Dimension::HEAT_CAPACITY);
        let viscosity = table.required_positive("viscosity", Dimension::VISCOSITY);
        let conductivity = table.required_positive("conductivity", Dimension::CONDUCTIVITY);
        table.finish();
        if section.has("properties") {
            section.fail(
                "constant",
                "stands beside `properties`",
                "a gas is either ideal (properties) or of constant density (constant)",
            );
            return None;
        }
        return Some(GasModel::Constant(ConstantGas {
            density: density?,
            heat_capacity: heat_capacity?,
            viscosity: viscosity?,
            conductivity: conductivity?,
        }));
    }
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
        return Some(made.into());
    }
    match mixture? {
        "air" => Some(GasProperties::air().into()),
        other => {
            section.fail(
                "mixture",
                format!("is \"{other}\", which is not built in"),
                "write \"air\", or state its [gas.properties] or [gas.constant]",
            );
            None
        }
    }
}

/// The Schmidt number of a mixture; 1 where there are no species.
fn schmidt(section: &TableReader<'_>, gas: Option<&GasModel>) -> Option<f64> {
    if !matches!(gas, Some(GasModel::Mixture(_))) {
        return Some(1.0);
    }
    if !section.has("schmidt") {
        section.missing("schmidt", "0.7");
    }
    section.positive("schmidt", Dimension::NONE)
}

fn initial(
    section: &TableReader<'_>,
    gas: Option<&GasModel>,
) -> Option<(f64, f64, Vec3, Vec<f64>)> {
    let initial = section.required_table(
        "initial",
        "initial = { temperature = \"300 K\", pressure = \"1 atm\" }",
    )?;
    let temperature = initial.required_positive("temperature", Dimension::TEMPERATURE);
    let pressure = initial.required_positive("pressure", Dimension::PRESSURE);
    let velocity = initial
        .vector("velocity", Dimension::VELOCITY)
        .unwrap_or([0.0; 3]);
    let composition = match gas {
        Some(GasModel::Mixture(mixture)) => {
            let table = initial.required_table(
                "composition",
                "composition = { mole = { N2 = 0.79, O2 = 0.21 } }",
            );
            table.and_then(|table| fractions(&table, mixture))
        }
        _ => Some(Vec::new()),
    };
    initial.finish();
    Some((temperature?, pressure?, Vec3::from(velocity), composition?))
}

/// Defaults: 20 outer iterations to 1e-8, 2 pressure corrections, linear solvers to 1e-13, van Leer's
/// limiter.
fn controls(section: &TableReader<'_>) -> GasControls {
    let mut controls = GasControls {
        outer_iterations: 20,
        convection: Convection::default(),
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
        let schemes = [
            ("van-leer", Convection::VanLeer),
            ("upwind", Convection::Upwind),
        ];
        controls.convection = table.choice("convection", &schemes).unwrap_or_default();
        let tolerance = |key| table.positive(key, Dimension::NONE);
        controls.outer_tolerance = tolerance("outer_tolerance").unwrap_or(controls.outer_tolerance);
        controls.linear_tolerance =
            tolerance("linear_tolerance").unwrap_or(controls.linear_tolerance);
        table.finish();
    }
    controls
}
