//! What was run, with which solvers, and what it continues.

use super::number::{figure, span};
use super::page::{escape, table};
use crate::results::Summary;
use crate::results::summary::SolverSummary;

pub(super) fn provenance(summary: &Summary) -> String {
    let solver = |solver: &SolverSummary, backend: &str| {
        let ranks = if solver.ranks == 1 { "rank" } else { "ranks" };
        format!(
            "{} {} ({}), {} {ranks}",
            escape(&solver.name),
            escape(&solver.version),
            escape(backend),
            solver.ranks
        )
    };
    let schedule: Vec<_> = summary
        .acceleration
        .iter()
        .map(|&(from, factor)| format!("{} from {}", figure(factor, 4), span(from)))
        .collect();
    let mut rows = vec![
        ("case", escape(&summary.case.name)),
        (
            "SHA-256 of the case",
            format!("<code>{}</code>", escape(&summary.case.hash)),
        ),
        ("gas", solver(&summary.solver.gas, &summary.backend.gas)),
        (
            "particles",
            solver(&summary.solver.particles, &summary.backend.particles),
        ),
        ("transport", escape(&summary.transport)),
        ("storage of the gas", escape(&summary.storage)),
        ("acceleration", schedule.join(", ")),
        ("Calcine", escape(&summary.calcine)),
    ];
    if let Some(pace) = &summary.pace {
        let numbers = format!(
            "{} in the mean, {} at most",
            figure(pace.inertial_number_mean, 3),
            figure(pace.inertial_number_largest, 3)
        );
        let words = pace.warning().unwrap_or_else(|| "quasi-static".into());
        rows.push(("inertial number", format!("{numbers}: {}", escape(&words))));
    }
    let mut from = summary.from.as_ref();
    while let Some(run) = from {
        let text = format!(
            "{} of <code>{}</code> (case {} …), at {} of process time after {} windows",
            escape(&run.case),
            escape(&run.path.display().to_string()),
            escape(run.hash.get(..12).unwrap_or(&run.hash)),
            span(run.process_time_s),
            run.windows
        );
        rows.push(("continued from", text));
        from = run.from.as_deref();
    }
    let rows: Vec<Vec<String>> = rows
        .into_iter()
        .map(|(name, value)| vec![name.to_owned(), value])
        .collect();
    table(&["", ""], &rows)
}
