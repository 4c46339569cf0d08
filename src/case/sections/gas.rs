//! `[gas]`.

use std::path::{Path, PathBuf};

use calcine_coupler::gas_chemistry::{Combustion, GasChemistry};
use calcine_coupler::momentum_model::MomentumModel;
use calcine_coupler::physics::Vec3;
use calcine_coupler::physics::gas::GasProperties;
use calcine_coupler::physics::gas_model::{ConstantGas, GasModel};
use calcine_coupler::physics::law::{LawChoice, NONE};
use calcine_coupler::physics::turbulence::BedEddies;
use calcine_coupler::setup::{Convection, GasControls, GasSetup, Turbulence};
use calcine_coupler::time::GasStorage;

use super::chemistry::{Around, chemistry};
use super::composition::{no_species, of_gas};
use super::gas_patch::{BodySurface, boundary};
use super::species_data;
use super::turbulence::turbulence;
use crate::case::model::{Laws, MeshSpec};
use crate::case::table::TableReader;

/// The mixture that is none.
const VACUUM: &str = "vacuum";

/// What the section says.
pub(super) struct GasRead {
    pub setup: GasSetup,
    pub held: bool,
    pub gravity_is_stated: bool,
    /// Files of its chemistry.
    pub files: Vec<PathBuf>,
    /// What the particles of a bed make of its eddies.
    pub bed_eddies: LawChoice<dyn BedEddies>,
    /// Patches that are surfaces of bodies.
    pub surfaces: Vec<BodySurface>,
}

pub(super) fn read(
    root: &TableReader<'_>,
    mesh: Option<&MeshSpec>,
    storage: Option<GasStorage>,
    folder: &Path,
) -> Option<GasRead> {
    let section = root.table("gas")?;
    let mixture = section.text("mixture");
    if mixture == Some(VACUUM) {
        return vacuum(&section);
    }
    let (properties, mut files) = match properties(&section, mixture, folder) {
        Some((gas, files)) => (Some(gas), files),
        None => (None, Vec::new()),
    };
    let schmidt = schmidt(&section, properties.as_ref());
    let initial = initial(&section, properties.as_ref());
    let gravity_is_stated = section.has("gravity");
    let gravity = section.vector("gravity").unwrap_or([0.0; 3]);
    let pressure_gradient = section.vector("pressure_gradient").unwrap_or([0.0; 3]);
    let held = section.truth("held").unwrap_or(false);
    let turbulence = turbulence(&section);
    let turbulent = turbulence.as_ref().map(|(model, _)| !model.is_laminar());
    let mut surfaces = Vec::new();
    let patches = boundary(
        &section,
        mesh,
        properties.as_ref(),
        turbulent,
        &mut surfaces,
    );
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
    let (turbulence, bed_eddies) = turbulence?;
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
        pressure_gradient: Vec3::from(pressure_gradient),
        turbulence,
        momentum: MomentumModel::default(), // `laws.drag.model` says
        patches: patches?,
        controls: controls?,
    };
    Some(GasRead {
        setup,
        held,
        gravity_is_stated,
        files,
        bed_eddies,
        surfaces,
    })
}

/// No gas: what else the section says of one is an error.
fn vacuum(section: &TableReader<'_>) -> Option<GasRead> {
    for key in [
        "initial",
        "patch",
        "properties",
        "constant",
        "species",
        "species_data",
        "schmidt",
        "chemistry",
        "pressure_gradient",
        "turbulence",
    ] {
        if section.has(key) {
            let rule = "stands beside a vacuum, which has none";
            section.fail(key, rule, "remove it, or write another `gas.mixture`");
        }
    }
    let gravity_is_stated = section.has("gravity");
    let gravity = section.vector("gravity").unwrap_or([0.0; 3]);
    // A vacuum stays as it is, held or not, and nothing is solved for.
    section.truth("held");
    let controls = controls(section);
    section.finish();
    let setup = GasSetup {
        mixture: VACUUM.into(),
        properties: GasModel::VACUUM,
        schmidt: 1.0,
        chemistry: GasChemistry::default(),
        storage: GasStorage::default(),
        temperature: 0.0,
        composition: Vec::new(),
        pressure: 0.0,
        velocity: Vec3::zeros(),
        gravity: Vec3::from(gravity),
        pressure_gradient: Vec3::zeros(),
        momentum: MomentumModel::default(),
        turbulence: Turbulence::Laminar,
        patches: Vec::new(),
        controls: controls?,
    };
    Some(GasRead {
        setup,
        held: true,
        gravity_is_stated,
        files: Vec::new(),
        surfaces: Vec::new(),
        bed_eddies: LawChoice::named(&section.laws().bed_eddies, NONE, Vec::new())?,
    })
}

/// Laws of what a gas does to particles are none in a vacuum.
pub(super) fn acts(root: &TableReader<'_>, gas: &GasSetup, laws: &Laws) {
    let Some(section) = root.table("laws").filter(|_| gas.properties.is_vacuum()) else {
        return;
    };
    let stated = [
        ("drag", laws.drag.entry().name, laws.drag.is_none()),
        (
            "heat_transfer",
            laws.heat_transfer.entry().name,
            laws.heat_transfer.is_none(),
        ),
        (
            "mass_transfer",
            laws.mass_transfer.entry().name,
            laws.mass_transfer.is_none(),
        ),
    ];
    for (key, name, is_none) in stated {
        if !is_none {
            let rule =
                format!("is \"{name}\", but the gas is a vacuum, which does nothing to particles");
            section.fail(key, rule, format!("write {key} = {{ law = \"none\" }}"));
        }
    }
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
        let density = table.number("density");
        let heat_capacity = table.number("heat_capacity");
        let viscosity = table.number("viscosity");
        let conductivity = table.number("conductivity");
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
        let molar_mass = table.number("molar_mass");
        let heat_capacity = table.number("heat_capacity");
        let viscosity = table.number("viscosity");
        let at = table.number("viscosity_at");
        let sutherland = table.number("sutherland_temperature");
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
    match gas {
        Some(GasModel::Mixture(_)) => section.need("schmidt"),
        Some(_) => return Some(1.0),
        // What could not be read is told already.
        None => return section.has("schmidt").then_some(1.0),
    }
    section.number("schmidt")
}

fn initial(
    section: &TableReader<'_>,
    gas: Option<&GasModel>,
) -> Option<(f64, f64, Vec3, Vec<f64>)> {
    section.need("initial");
    let initial = section.table("initial")?;
    let temperature = initial.number("temperature");
    let pressure = initial.number("pressure");
    let velocity = initial.vector("velocity").unwrap_or([0.0; 3]);
    let composition = match gas {
        Some(GasModel::Mixture(mixture)) => {
            initial.need("composition");
            let table = initial.table("composition");
            table.and_then(|table| of_gas(&table, mixture))
        }
        Some(_) => {
            no_species(&initial);
            Some(Vec::new())
        }
        None => {
            initial.has("composition");
            None
        }
    };
    initial.finish();
    Some((temperature?, pressure?, Vec3::from(velocity), composition?))
}

/// A scheme by its name, or central differences with a share of upwind or with a limiter of a coefficient.
fn convection(table: &TableReader<'_>) -> Option<Convection> {
    if !table.is_table("convection") {
        return table.choice("convection");
    }
    let scheme = table.table("convection")?;
    let kind = scheme.exactly_one();
    let number = kind.and_then(|kind| scheme.number(kind));
    scheme.finish();
    number.map(|number| match kind {
        Some("limited_linear") => Convection::LimitedLinear(number),
        _ => Convection::Central(number),
    })
}

/// Accuracy, with its defaults where the case says nothing.
fn controls(section: &TableReader<'_>) -> Option<GasControls> {
    let table = section.table_or_empty("controls")?;
    let outer_iterations = table.small_whole("outer_iterations");
    let convection = convection(&table);
    let time_scheme = table.choice("time_scheme");
    let pressure_corrections = table.small_whole("pressure_corrections");
    let most_pressure_corrections = table.small_whole("most_pressure_corrections");
    let outer_tolerance = table.number("outer_tolerance");
    let linear_tolerance = match table.has("linear_tolerance") {
        true => table.number("linear_tolerance").map(Some),
        false => Some(None),
    };
    table.finish();
    Some(GasControls {
        outer_iterations: outer_iterations?,
        convection: convection?,
        time_scheme: time_scheme?,
        pressure_corrections: pressure_corrections?,
        most_pressure_corrections: most_pressure_corrections?,
        outer_tolerance: outer_tolerance?,
        linear_tolerance: linear_tolerance?,
    })
}
