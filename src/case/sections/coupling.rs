//! `[coupling]`, `[openfoam]`, `[liggghts]`, `[external]`.

use std::path::Path;

use calcine_adapters::liggghts::template::ScriptTemplate;
use calcine_adapters::openfoam::stock::{StockSolver, refusal};
use calcine_adapters::openfoam::template;
use calcine_coupler::momentum_model::MomentumModel;
use calcine_coupler::setup::GasSetup;
use calcine_coupler::time::GasStorage;

use super::common::{existing, gas_alone};
use super::zone::zones;
use crate::case::model::{
    Coupling, ExternalProgram, ExternalSpec, Laws, MappingSpec, MotionSpec, Population, TimeSpec,
};
use crate::case::table::TableReader;

pub(super) fn read(root: &TableReader<'_>) -> Option<Coupling> {
    let alone = gas_alone(root);
    let section = match alone {
        true => root.table_or_empty("coupling")?,
        false => root.table("coupling")?,
    };
    let parcels = root.has("motion") && root.table("motion").is_some_and(|one| one.has("parcels"));
    if !parcels && !alone {
        section.need("mapping");
    }
    let implied = (parcels || alone) && !section.has("mapping");
    let mapping = section.choice("mapping");
    let smoother = section.table_or_empty("smoother")?;
    let max_solid_fraction = smoother.number("max_solid_fraction");
    let excluded = zones(&smoother, "excluded");
    let smoother_tolerance = smoother.number("tolerance");
    let diffusion_length = smoother.number("diffusion_length");
    smoother.finish();
    let exchange = section.table_or_empty("exchange")?;
    let exchange_tolerance = exchange.number("tolerance");
    let exchange_attempts = exchange.small_whole("attempts");
    let exchange_cuts = exchange.small_whole("cuts");
    exchange.finish();
    let window_drag = section.choice("window_drag");
    let deadline = section.wall_time("deadline");
    section.finish();
    Some(Coupling {
        mapping: match implied {
            // Nothing is mapped where there are no particles.
            true if alone => MappingSpec::Centroid,
            true => MappingSpec::Linear,
            false => mapping?,
        },
        max_solid_fraction: max_solid_fraction?,
        excluded,
        smoother_tolerance: smoother_tolerance?,
        // Without particles there is no diameter to take it from.
        diffusion_length: diffusion_length.or(alone.then_some(0.0)),
        exchange_tolerance: exchange_tolerance?,
        exchange_attempts: exchange_attempts?,
        exchange_cuts: exchange_cuts?,
        window_drag: window_drag.unwrap_or_default(),
        deadline: deadline?,
    })
}

/// Drag within a window acts on particles that move.
pub(super) fn check_drag(root: &TableReader<'_>, particles: &[Population]) {
    let moves = |population: &Population| population.motion != MotionSpec::Frozen;
    // Particles that could not be read may move.
    if particles.is_empty() || particles.iter().any(moves) {
        return;
    }
    if let Some(section) = root.table("coupling").filter(|one| one.has("window_drag")) {
        let help = "remove it, or write motion = \"free\"";
        let rule = "has no effect: all particles are frozen, and none moves within a window";
        section.fail("window_drag", rule, help);
    }
}

/// A stock solver does less than calcineGasFoam: what this case asks of it in vain.
pub(super) fn check_stock(
    root: &TableReader<'_>,
    openfoam: &ExternalSpec,
    gas: &GasSetup,
    time: &TimeSpec,
    laws: Option<&Laws>,
) {
    if !openfoam.solver.is_stock() {
        return;
    }
    let Some(section) = root.table("openfoam") else {
        return;
    };
    let name = openfoam.solver.name();
    let other = "let calcineGasFoam do it: leave `openfoam.solver` out";
    let splits = time.acceleration.largest() > 1.0;
    if splits && time.storage == GasStorage::Process {
        let rule = format!(
            "names {name}, which stores over its own time step: with `time.acceleration` above 1 it \
             cannot do `process` storage"
        );
        let help = "write `gas_storage = \"accelerated\"`, or leave `openfoam.solver` out";
        section.fail("solver", rule, help);
    }
    if laws.is_some_and(|laws| laws.momentum != MomentumModel::A) {
        let rule = format!(
            "names {name}, which knows no void fraction in its momentum, but `laws.drag.model` is \"b\""
        );
        let help = "leave `laws.drag.model` out, or leave `openfoam.solver` out";
        section.fail("solver", rule, help);
    }
    if !gas.turbulence.is_laminar() {
        let rule = format!("names {name}, which takes no `gas.turbulence`");
        let help = "take the model from `openfoam.template`, or leave `openfoam.solver` out";
        section.fail("solver", rule, help);
    }
    if let Some(why) = refusal(openfoam.solver, gas, splits) {
        section.fail("solver", format!("names {name}, but {why}"), other);
    }
}

/// A template of the user's own must be readable, and say nothing that has no effect.
pub(super) fn check_template(root: &TableReader<'_>, openfoam: &ExternalSpec, gas: &GasSetup) {
    let (Some(path), Some(section)) = (&openfoam.template, root.table("openfoam")) else {
        return;
    };
    for finding in template::findings(path, openfoam.solver, gas) {
        let (rule, help) = finding.parts();
        section.fail("template", format!("cannot be used: {rule}"), help);
    }
}

/// A script of the user's own is for particles that move, and must let Calcine drive it.
pub(super) fn check_script(
    root: &TableReader<'_>,
    liggghts: &ExternalSpec,
    particles: &[Population],
) {
    let (Some(path), Some(section)) = (&liggghts.template, root.table("liggghts")) else {
        return;
    };
    if particles.iter().all(|one| one.motion == MotionSpec::Frozen) {
        let rule = "names a script, but no population moves";
        let help = "leave it out: a bed that is held needs no script, or write motion = \"free\"";
        section.fail("template", rule, help);
    }
    if let Err(error) = ScriptTemplate::read(path, Vec::new(), Vec::new()) {
        for finding in error.findings() {
            let (rule, help) = finding.parts();
            section.fail("template", format!("cannot be used: {rule}"), &help);
        }
    }
}

/// `[external]`: solvers of the user's own, that of the gas and that of the particles.
pub(super) fn programs(
    root: &TableReader<'_>,
    folder: &Path,
) -> (Option<ExternalProgram>, Option<ExternalProgram>) {
    let Some(section) = root.table("external") else {
        return (None, None);
    };
    let gas = section.table("gas");
    let particles = section.table("particles");
    section.finish();
    let read = |table: TableReader<'_>| program(&table, folder);
    (gas.and_then(read), particles.and_then(read))
}

/// A program of the user's own.
fn program(table: &TableReader<'_>, folder: &Path) -> Option<ExternalProgram> {
    let program = existing(table, "program", folder);
    if program.as_deref().is_some_and(|path| !is_executable(path)) {
        let rule = "names no executable file".to_owned();
        table.fail(
            "program",
            rule,
            "name the program itself; compile it, or chmod +x it",
        );
    }
    let arguments = table.texts("arguments").unwrap_or_default();
    let ranks = table.small_whole("ranks");
    table.finish();
    Some(ExternalProgram {
        program: program?,
        arguments,
        ranks: ranks?,
    })
}

fn is_executable(path: &Path) -> bool {
    use std::os::unix::fs::PermissionsExt;
    path.metadata()
        .is_ok_and(|data| data.is_file() && data.permissions().mode() & 0o111 != 0)
}

/// `[openfoam]` or `[liggghts]`.
pub(super) fn external(root: &TableReader<'_>, key: &str, folder: &Path) -> ExternalSpec {
    let mut external = ExternalSpec {
        template: None,
        start: None,
        solver: StockSolver::default(),
        wall_impulse: false,
        ranks: 1,
    };
    if let Some(section) = root.table(key) {
        external.template = existing(&section, "template", folder);
        if key == "openfoam" {
            external.start = existing(&section, "start", folder);
            external.solver = section.choice("solver").unwrap_or_default();
        } else {
            external.wall_impulse = section.truth("wall_impulse").unwrap_or(false);
        }
        external.ranks = section.small_whole("ranks").unwrap_or(1);
        section.finish();
    }
    external
}
