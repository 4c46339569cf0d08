//! The comparison as tables for a terminal.

use std::fmt::Write as _;

use super::agreement::Agreement;
use super::comparison::Comparison;
use crate::report::number::{figure, span, with_unit};

/// Rows of cells with aligned columns, the first to the left, the others to the right.
fn aligned(rows: &[Vec<String>]) -> String {
    let columns = rows.iter().map(Vec::len).max().unwrap_or(0);
    let width = |column: usize| {
        let cells = rows.iter().filter_map(|row| row.get(column));
        cells.map(|cell| cell.chars().count()).max().unwrap_or(0)
    };
    let widths: Vec<usize> = (0..columns).map(width).collect();
    let mut text = String::new();
    for row in rows {
        let mut line = String::new();
        for (column, cell) in row.iter().enumerate() {
            // Writing to a String cannot fail.
            let _ = match column {
                0 => write!(line, "  {cell:<0$}", widths[0]),
                _ => write!(line, "  {cell:>0$}", widths[column]),
            };
        }
        text.push_str(line.trim_end());
        text.push('\n');
    }
    text
}

fn row(cells: &[&str]) -> Vec<String> {
    cells.iter().map(|cell| (*cell).into()).collect()
}

/// Runs, quantities, fields, and the verdict.
pub(super) fn render(comparison: &Comparison) -> String {
    let mut runs = vec![row(&[
        "pairing",
        "process time",
        "wall time",
        "ledger error",
    ])];
    runs.extend(comparison.runs.iter().map(|run| {
        let early = if run.complete { "" } else { " (stopped early)" };
        vec![
            run.name.clone(),
            span(run.process_time_s) + early,
            span(run.wall_time_s),
            figure(run.ledger_error, 2),
        ]
    }));
    format!(
        "{}\n{}\n{}\n{}",
        aligned(&runs),
        aligned(&quantities(comparison)),
        aligned(&fields(comparison)),
        verdict(comparison)
    )
}

fn quantities(comparison: &Comparison) -> Vec<Vec<String>> {
    let mut rows = vec![row(&[
        "quantity", "largest", "at", "of span", "at end", "band", "",
    ])];
    rows.extend(comparison.quantities.iter().map(|quantity| {
        vec![
            quantity.name.clone(),
            with_unit(quantity.largest.difference, 3, &quantity.unit),
            span(quantity.largest.at_s),
            percent(quantity.largest.difference, quantity.span),
            with_unit(quantity.end.difference, 3, &quantity.unit),
            quantity.band.clone().unwrap_or_else(|| "–".into()),
            quantity.verdict.word().into(),
        ]
    }));
    rows
}

fn fields(comparison: &Comparison) -> Vec<Vec<String>> {
    let mut rows = vec![row(&[
        "field", "L2", "maximum", "of span", "where", "at", "band", "",
    ])];
    for field in &comparison.fields {
        let Some(worst) = field.worst() else { continue };
        rows.push(vec![
            field.name.clone(),
            with_unit(worst.l2, 3, &field.unit),
            with_unit(worst.maximum, 3, &field.unit),
            percent(worst.maximum, field.span),
            field.place(worst),
            span(worst.at_s),
            field.band.clone().unwrap_or_else(|| "–".into()),
            field.verdict.word().into(),
        ]);
    }
    rows
}

/// A share in per cent; none of a whole that is zero: what hardly varies has no span.
pub(super) fn percent(part: f64, whole: f64) -> String {
    if part == 0.0 {
        return "0 %".into();
    }
    if whole == 0.0 {
        return "–".into();
    }
    format!("{} %", figure(100.0 * part / whole, 2))
}

/// The last line.
pub(super) fn verdict(comparison: &Comparison) -> String {
    let quantities = comparison.quantities.iter().map(|q| (&q.name, q.verdict));
    let fields = comparison
        .fields
        .iter()
        .map(|field| (&field.name, field.verdict));
    let outside: Vec<&str> = quantities
        .chain(fields)
        .filter(|(_, verdict)| *verdict == Agreement::Outside)
        .map(|(name, _)| name.as_str())
        .collect();
    let short: Vec<&str> = comparison
        .runs
        .iter()
        .filter(|run| !run.complete)
        .map(|run| run.name.as_str())
        .collect();
    let mut text = if !comparison.has_bands() {
        format!(
            "{} runs, no bands stated: add `agree` to a quantity to have them judged.",
            comparison.runs.len()
        )
    } else if comparison.agrees {
        format!(
            "{} runs agree within the case's bands.",
            comparison.runs.len()
        )
    } else if outside.is_empty() {
        format!(
            "{} runs do not agree: their differences are within the case's bands, but not every run counts.",
            comparison.runs.len()
        )
    } else {
        format!("outside its band: {}.", outside.join(", "))
    };
    let restless = comparison.runs.iter().filter(|run| !run.converged);
    let restless: Vec<String> = restless
        .map(|run| {
            format!(
                "{} ({} of its windows)",
                run.name,
                percent(run.unconverged_share, 1.0)
            )
        })
        .collect();
    if !restless.is_empty() {
        let _ = write!(
            text,
            " Not converged: {}: raise the limit of iterations or shorten the windows, or state how many may (`agreement.unconverged`).",
            restless.join(", ")
        );
    }
    if !short.is_empty() {
        let _ = write!(
            text,
            " Stopped early: {}: let them go on to the end (`calcine run --resume DIR`).",
            short.join(", ")
        );
    }
    text + "\n"
}
