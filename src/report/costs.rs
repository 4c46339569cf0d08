//! What did not close, and where the wall time went.

use calcine_coupler::ledger::{DRAG_CARRY, PRESCRIBED_HEAT, STORAGE_CLOCK};

use super::number::{figure, span, with_unit};
use super::page::{bars, escape, table};
use crate::results::Summary;

pub(super) fn ledger(summary: &Summary) -> String {
    let lines = summary.ledger.lines.iter().chain(&summary.ledger.elements);
    let rows: Vec<_> = lines
        .map(|(name, line)| {
            vec![
                escape(&match name.as_str() {
                    STORAGE_CLOCK => "storage clock (not an error)".to_owned(),
                    PRESCRIBED_HEAT => "prescribed heat (not an error)".to_owned(),
                    DRAG_CARRY => "drag carried over (not an error)".to_owned(),
                    _ => name.replace('_', " "),
                }),
                figure(line.relative_error, 3),
                with_unit(line.drift, 3, &line.unit),
                with_unit(line.throughput, 4, &line.unit),
            ]
        })
        .collect();
    table(
        &["balance", "#relative error", "#drift", "#moved in all"],
        &rows,
    )
}

pub(super) fn timing(summary: &Summary) -> String {
    let wall = &summary.wall_time_s;
    let mut entries: Vec<_> = wall.stages().to_vec();
    let other = wall.total - entries.iter().map(|entry| entry.1).sum::<f64>();
    entries.push(("other", other.max(0.0)));
    entries.sort_by(|a, b| b.1.total_cmp(&a.1));
    let bar = |&(name, seconds): &(&'static str, f64)| {
        let share = 100.0 * seconds / wall.total.max(f64::MIN_POSITIVE);
        (
            name,
            seconds,
            format!("{} · {} %", span(seconds), figure(share, 2)),
        )
    };
    bars(&entries.iter().map(bar).collect::<Vec<_>>())
}

/// Wall time of the gas' phases, of each cell and window.
pub(super) fn gas_phases(summary: &Summary) -> String {
    let steps = (summary.cells as u64 * summary.windows).max(1) as f64;
    let taken = summary.gas_phases_s.iter().filter(|phase| *phase.1 > 0.0);
    let mut phases: Vec<_> = taken.collect();
    phases.sort_by(|a, b| b.1.total_cmp(a.1));
    let bar = |(name, &seconds): (&String, &f64)| {
        let each = figure(1e6 * seconds / steps, 2);
        let text = format!("{} · {each} µs a cell and window", span(seconds));
        (name.clone(), seconds, text)
    };
    let entries: Vec<(String, f64, String)> = phases.into_iter().map(bar).collect();
    let entries = entries
        .iter()
        .map(|(name, s, text)| (&name[..], *s, text.clone()));
    let entries: Vec<_> = entries.collect();
    match entries.is_empty() {
        true => String::new(),
        false => bars(&entries),
    }
}
