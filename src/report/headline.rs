//! What a run came to, at the top of its report: tiles, quantities of interest, particles that came and went.

use super::number::{figure, span, with_unit};
use super::page::{escape, table, tiles};
use crate::results::summary::QuantityResult;
use crate::results::{Summary, Verdict};

pub(super) fn headline(summary: &Summary) -> String {
    let largest = summary
        .acceleration
        .iter()
        .map(|step| step.1)
        .fold(1.0, f64::max);
    let wall = summary.wall_time_s.total;
    let energy = summary.ledger.lines.get("energy");
    tiles(&[
        (
            "process time",
            span(summary.process_time_s),
            format!("of {}", span(summary.process_end_s)),
        ),
        (
            "motion time",
            span(summary.motion_time_s),
            format!("acceleration up to {}", figure(largest, 4)),
        ),
        (
            "windows",
            summary.windows.to_string(),
            format!("gas stores: {}", summary.storage),
        ),
        (
            "particles",
            summary.particles.to_string(),
            format!("{} gas cells", summary.cells),
        ),
        (
            "wall time",
            if wall.is_finite() {
                span(wall)
            } else {
                "–".into()
            },
            match summary.verdict {
                Verdict::Running if wall.is_nan() => "told by the first checkpoint".into(),
                // That of the last checkpoint, unlike the process time.
                Verdict::Running => "at the last checkpoint".into(),
                _ => format!(
                    "{} s of process time a second",
                    figure(summary.process_time_s / wall, 3)
                ),
            },
        ),
        (
            "energy closes to",
            energy.map_or("–".into(), |line| figure(line.relative_error, 2)),
            "relative to all that moved".into(),
        ),
    ])
}

pub(super) fn quantities(summary: &Summary) -> String {
    let band = |result: &QuantityResult| match result.band {
        Some((low, high)) => {
            format!("{} … {}", figure(low, 5), with_unit(high, 5, &result.unit))
        }
        None => "none stated".into(),
    };
    let rows: Vec<_> = summary
        .quantities
        .iter()
        .map(|(name, result)| {
            vec![
                escape(&name.replace('_', " ")),
                result
                    .value
                    .map_or("–".into(), |value| with_unit(value, 6, &result.unit)),
                result.at_s.map_or("–".into(), span),
                band(result),
                verdict(result),
            ]
        })
        .collect();
    table(
        &["quantity", "#value", "#at", "#expected", "verdict"],
        &rows,
    )
}

/// Particles that came and went; empty where none did.
pub(super) fn passed(summary: &Summary) -> String {
    let passed = &summary.passed;
    let rows: Vec<Vec<String>> = [
        ("fed", passed.fed),
        ("discharged", passed.discharged),
        ("used up", passed.used_up),
        ("lost", passed.lost),
    ]
    .into_iter()
    .filter(|(_, inventory)| inventory.rows > 0)
    .map(|(name, inventory)| {
        vec![
            name.into(),
            inventory.rows.to_string(),
            with_unit(inventory.mass_kg, 4, "kg"),
            with_unit(inventory.energy_j, 4, "J"),
        ]
    })
    .collect();
    match rows.is_empty() {
        true => String::new(),
        false => table(&["", "#rows", "#mass", "#energy"], &rows),
    }
}

fn verdict(result: &QuantityResult) -> String {
    use crate::results::Verdict::{Fail, None, Pass, Running, Stopped};
    let word = match result.verdict {
        Pass => "inside",
        Fail => "outside",
        Running | Stopped => "not known yet",
        None => "–",
    };
    match result.verdict {
        None => word.into(),
        verdict => format!("<span class=\"badge {}\">{word}</span>", verdict.word()),
    }
}
