//! `[coupling]`, `[openfoam]`, `[liggghts]`, `[external]`.

use std::path::Path;
use std::time::Duration;

use calcine_adapters::liggghts::template::ScriptTemplate;
use calcine_adapters::openfoam::stock::{StockSolver, refusal};
use calcine_coupler::momentum_model::MomentumModel;
use calcine_coupler::setup::GasSetup;
use calcine_coupler::time::GasStorage;

use super::existing;
use super::zone::zones;
use crate::case::model::{
    Coupling, ExternalProgram, ExternalSpec, Laws, MappingSpec, MotionSpec, Population, TimeSpec,
};
use crate::case::table::TableReader;
use crate::case::units::Dimension;

pub(super) fn read(root: &TableReader<'_>) -> Option<Coupling> {
    let section = root.required_table("coupling", "[coupling] with mapping = \"overlap\"")?;
    let mappings = [
        ("overlap", MappingSpec::Overlap),
        ("divided", MappingSpec::Divided),
        ("centroid", MappingSpec::Centroid),
    ];
    let mapping = section.required_choice("mapping", &mappings);
    let mut coupling = Coupling {
        mapping: mapping.unwrap_or(MappingSpec::Overlap),
        max_solid_fraction: 0.64,
        excluded: Vec::new(),
        smoother_tolerance: 1e-4,
        diffusion_length: None,
        exchange_tolerance: 1e-3,
        exchange_attempts: 4,
        deadline: Duration::from_secs(60),
    };
    if let Some(table) = section.table("smoother") {
        if let Some(fraction) = fraction(&table, "max_solid_fraction") {
            coupling.max_solid_fraction = fraction;
        }
        coupling.excluded = zones(&table, "excluded");
        coupling.smoother_tolerance =
            fraction(&table, "tolerance").unwrap_or(coupling.smoother_tolerance);
        if let Some(length) = table.quantity("diffusion_length", Dimension::LENGTH) {
            if length < 0.0 {
                table.fail(
                    "diffusion_length",
                    format!("is {length} m"),
                    "it is zero or above",
                );
            }
            coupling.diffusion_length = Some(length);
        }
        table.finish();
    }
    if let Some(table) = section.table("exchange") {
        coupling.exchange_tolerance =
            fraction(&table, "tolerance").unwrap_or(coupling.exchange_tolerance);
        let attempts = table
            .whole("attempts", 1..=1000)
            .and_then(|n| u32::try_from(n).ok());
        coupling.exchange_attempts = attempts.unwrap_or(coupling.exchange_attempts);
        table.finish();
    }
    if let Some(deadline) = section.wall_time("deadline") {
        coupling.deadline = deadline;
    }
    section.finish();
    mapping.map(|_| coupling)
}

/// A plain number in (0, 1).
fn fraction(table: &TableReader<'_>, key: &str) -> Option<f64> {
    let value = table.quantity(key, Dimension::NONE)?;
    if value > 0.0 && value < 1.0 {
        return Some(value);
    }
    table.fail(
        key,
        format!("is {value}"),
        "it must lie between 0 and 1, both excluded",
    );
    None
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
        let (rule, help) = error.parts();
        section.fail("template", format!("cannot be used: {rule}"), &help);
    }
}

/// `[external]`: solvers of the user's own.
pub(super) fn programs(root: &TableReader<'_>, folder: &Path) -> Option<ExternalProgram> {
    let section = root.table("external")?;
    let gas = section.table("gas").and_then(|table| {
        if !table.has("program") {
            table.missing("program", "\"column-gas\"");
        }
        let program = existing(&table, "program", folder);
        if let Some(path) = &program
            && !is_executable(path)
        {
            let rule = format!("names {}, which is no executable file", path.display());
            table.fail(
                "program",
                rule,
                "name the program itself; compile it, or chmod +x it",
            );
        }
        let arguments = table.texts("arguments").unwrap_or_default();
        let ranks = table.whole("ranks", 1..=100_000).unwrap_or(1);
        table.finish();
        Some(ExternalProgram {
            program: program?,
            arguments,
            ranks: u32::try_from(ranks).unwrap_or(1),
        })
    });
    section.finish();
    gas
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
            let solvers = StockSolver::ALL.map(|solver| (solver.name(), solver));
            external.solver = section.choice("solver", &solvers).unwrap_or_default();
        } else {
            external.wall_impulse = section.truth("wall_impulse").unwrap_or(false);
        }
        if let Some(ranks) = section.whole("ranks", 1..=100_000) {
            external.ranks = u32::try_from(ranks).unwrap_or(1);
        }
        section.finish();
    }
    external
}
