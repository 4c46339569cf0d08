//! Runs of one plant beside each other: how far quantities and series differ.

use std::fmt::Write as _;
use std::path::Path;

use super::files::TimeTable;
use super::summary::PlantSummary;
use crate::case::model::ToleranceBand;
use crate::case::plant::PlantCase;
use crate::results::ResultsError;
use crate::results::quantities::allowance;

/// What a comparison found.
pub(crate) struct PlantComparison {
    /// The table to print.
    pub text: String,
    /// False where a quantity differs by more than its band.
    pub agrees: bool,
}

/// Compares the results of two runs of a case; quantities are judged by its bands.
pub(crate) fn compare(
    case: &PlantCase,
    names: [&str; 2],
    folders: [&Path; 2],
) -> Result<PlantComparison, ResultsError> {
    let [one, other] = [
        PlantSummary::read(folders[0])?,
        PlantSummary::read(folders[1])?,
    ];
    let mut text = format!(
        "{:24} {:>18} {:>18} {:>12}\n",
        "", names[0], names[1], "difference"
    );
    let mut agrees = true;
    for quantity in &case.quantities {
        let of = |summary: &PlantSummary| summary.quantities.get(&quantity.name)?.value;
        let (Some(a), Some(b)) = (of(&one), of(&other)) else {
            agrees &= quantity.agree.is_none();
            let _ = writeln!(text, "{:24} not known in both", quantity.name);
            continue;
        };
        let verdict = match quantity.agree {
            None => "no band",
            Some(band) if (a - b).abs() <= allowance(band, a.abs().max(b.abs())) => "agrees",
            Some(_) => {
                agrees = false;
                "differs"
            }
        };
        let band = match quantity.agree {
            Some(ToleranceBand::Relative(share)) => format!(" within {share:e}"),
            Some(ToleranceBand::Absolute(most)) => format!(" within {most:e} {}", quantity.unit),
            None => String::new(),
        };
        let _ = writeln!(
            text,
            "{:24} {a:>18.10e} {b:>18.10e} {:>12.3e} {verdict}{band}",
            quantity.name,
            (a - b).abs()
        );
    }
    let [rows, others] = [
        TimeTable::series(folders[0])?,
        TimeTable::series(folders[1])?,
    ];
    match (rows.names == others.names, rows.times() == others.times()) {
        (true, true) => {
            let (name, most) = largest(&rows, &others);
            let _ = writeln!(
                text,
                "largest difference of the series: {most:.3e} of the largest value of {name}"
            );
        }
        _ => text.push_str("the series have other columns or times and are not compared\n"),
    }
    for (name, summary) in names.iter().zip([&one, &other]) {
        let _ = writeln!(
            text,
            "{name}: recycles close to {:.2e}, the ledger to {:.2e}, {:.2} s",
            summary.ledger.loop_closure, summary.ledger.largest_relative_error, summary.wall_time_s
        );
    }
    Ok(PlantComparison { text, agrees })
}

/// The column whose values differ most, relative to its largest value, and by how much.
fn largest<'a>(one: &'a TimeTable, other: &TimeTable) -> (&'a str, f64) {
    let mut found = ("none", 0.0);
    for (name, (a, b)) in one.names.iter().zip(one.columns.iter().zip(&other.columns)) {
        let size = a.iter().chain(b).filter(|v| v.is_finite());
        let size = size.map(|v| v.abs()).fold(0.0, f64::max);
        let apart = a.iter().zip(b).map(|(a, b)| (a - b).abs());
        let apart = apart.filter(|d| d.is_finite()).fold(0.0, f64::max);
        if apart > 0.0 && apart / size > found.1 {
            found = (name, apart / size);
        }
    }
    found
}
