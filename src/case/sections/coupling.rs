//! `[coupling]`, `[openfoam]`, `[liggghts]`.

use std::path::Path;
use std::time::Duration;

use super::existing;
use super::zone::zones;
use crate::case::model::{Coupling, External, Mapping};
use crate::case::table::Reader;
use crate::case::units::Dimension;

pub(super) fn read(root: &Reader<'_>) -> Option<Coupling> {
    let section = root.required_table("coupling", "[coupling] with mapping = \"overlap\"")?;
    let mappings = [
        ("overlap", Mapping::Overlap),
        ("divided", Mapping::Divided),
        ("centroid", Mapping::Centroid),
    ];
    let mapping = section.required_choice("mapping", &mappings);
    let mut coupling = Coupling {
        mapping: mapping.unwrap_or(Mapping::Overlap),
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
fn fraction(table: &Reader<'_>, key: &str) -> Option<f64> {
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

/// `[openfoam]` or `[liggghts]`.
pub(super) fn external(root: &Reader<'_>, key: &str, folder: &Path) -> External {
    let mut external = External {
        template: None,
        start: None,
        ranks: 1,
    };
    if let Some(section) = root.table(key) {
        external.template = existing(&section, "template", folder);
        if key == "openfoam" {
            external.start = existing(&section, "start", folder);
        }
        if let Some(ranks) = section.whole("ranks", 1..=100_000) {
            if ranks > 1 {
                section.fail(
                    "ranks",
                    format!("is {ranks}; more than one rank is not supported yet"),
                    "write 1, or leave it out",
                );
            }
            external.ranks = usize::try_from(ranks).unwrap_or(1);
        }
        section.finish();
    }
    external
}
