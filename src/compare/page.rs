//! The comparison as one self-contained page with overlaid plots.

use super::agreement::Agreement;
use super::comparison::{ComparedRun, Comparison};
use super::quantities::QuantityDifference;
use super::table::{percent, verdict};
use crate::report::colour;
use crate::report::number::{figure, span, with_unit};
use crate::report::page::{Page, bars, escape, table};
use crate::report::plot::{Curve, Plot, Stroke, TIME, between};

/// The page.
pub(super) fn render(comparison: &Comparison) -> String {
    let (class, word) = match comparison.agrees {
        true if !comparison.has_bands() => ("none", "no bands stated"),
        true => ("pass", "the runs agree"),
        false if comparison.has_outside() => ("fail", "outside its bands"),
        false if comparison.runs.iter().all(|run| run.complete) => ("fail", "not converged"),
        false => ("fail", "stopped early"),
    };
    let badge = format!("<span class=\"badge {class}\">{word}</span>");
    let names: Vec<&str> = comparison
        .runs
        .iter()
        .map(|run| run.name.as_str())
        .collect();
    let kicker = format!("{} · comparison of {}", comparison.case, names.join(", "));
    let mut page = Page::new(&kicker, &comparison.title, &badge);
    page.section(
        "Quantities of interest",
        verdict(comparison).trim(),
        &quantities(comparison),
    );
    page.section(
        "Overlaid",
        "Where lines cover each other, their colours take turns.",
        &plots(comparison),
    );
    page.section(
        "Fields",
        "The pair of runs that differs most, over all particles or cells and all times after the start.",
        &fields(comparison),
    );
    page.section("Every pair", "", &pairs(comparison));
    page.section("Wall time", "", &wall(comparison));
    page.finish(&format!(
        "SHA-256 of the case {} · all times are process (real) time",
        comparison.hash
    ))
}

fn word(verdict: Agreement) -> String {
    let class = match verdict {
        Agreement::Inside => "pass",
        Agreement::Outside => "fail",
        Agreement::None => return "–".into(),
    };
    format!("<span class=\"badge {class}\">{}</span>", verdict.word())
}

fn quantities(comparison: &Comparison) -> String {
    let mut head = vec!["quantity".to_owned()];
    head.extend(comparison.runs.iter().map(|run| format!("#{}", run.name)));
    head.extend(
        [
            "#largest difference",
            "#at",
            "#of span",
            "#at end",
            "#band",
            "",
        ]
        .map(String::from),
    );
    let rows: Vec<_> = comparison
        .quantities
        .iter()
        .map(|quantity| {
            let mut row = vec![escape(&quantity.name.replace('_', " "))];
            let values = quantity.end_values.iter();
            row.extend(values.map(|&value| with_unit(value, 6, &quantity.unit)));
            row.extend([
                with_unit(quantity.largest.difference, 3, &quantity.unit),
                span(quantity.largest.at_s),
                percent(quantity.largest.difference, quantity.span),
                with_unit(quantity.end.difference, 3, &quantity.unit),
                quantity.band.clone().unwrap_or_else(|| "–".into()),
                word(quantity.verdict),
            ]);
            row
        })
        .collect();
    let head: Vec<&str> = head.iter().map(String::as_str).collect();
    table(&head, &rows)
}

fn fields(comparison: &Comparison) -> String {
    let rows: Vec<_> = comparison
        .fields
        .iter()
        .filter_map(|field| {
            let worst = field.worst()?;
            Some(vec![
                escape(&field.name),
                with_unit(worst.l2, 3, &field.unit),
                with_unit(worst.maximum, 3, &field.unit),
                percent(worst.maximum, field.span),
                field.place(worst),
                span(worst.at_s),
                field.band.clone().unwrap_or_else(|| "–".into()),
                word(field.verdict),
            ])
        })
        .collect();
    table(
        &[
            "field", "#L2", "#maximum", "#of span", "where", "#at", "#band", "",
        ],
        &rows,
    )
}

fn pairs(comparison: &Comparison) -> String {
    let mut rows = Vec::new();
    for field in &comparison.fields {
        for pair in &field.pairs {
            rows.push(vec![
                escape(&field.name),
                escape(&pair.runs[0]),
                escape(&pair.runs[1]),
                with_unit(pair.l2, 3, &field.unit),
                with_unit(pair.maximum, 3, &field.unit),
                percent(pair.maximum, field.span),
            ]);
        }
    }
    let table = table(
        &["field", "run", "run", "#L2", "#maximum", "#of span"],
        &rows,
    );
    format!("<details><summary>Norms of each pair of runs</summary>{table}</details>")
}

fn plots(comparison: &Comparison) -> String {
    let mut html = String::new();
    for quantity in &comparison.quantities {
        let column = format!("quantities.{}", quantity.name);
        html.push_str(&overlay(
            comparison,
            &format!("{} in {}", quantity.name.replace('_', " "), quantity.unit),
            &[&column],
        ));
        html.push_str(&above_the_first(comparison, quantity));
    }
    let tracks = comparison.series[0].particles();
    if !tracks.is_empty() {
        let picks = [0, tracks.len() / 2, tracks.len() - 1];
        let mut names: Vec<String> = picks
            .iter()
            .map(|&place| format!("particle_temperature.{}", tracks[place].0))
            .collect();
        names.dedup();
        let ids: Vec<&str> = names
            .iter()
            .filter_map(|name| name.rsplit('.').next())
            .collect();
        let title = format!("Temperature of the particles {} in K", ids.join(", "));
        let names: Vec<&str> = names.iter().map(String::as_str).collect();
        html.push_str(&overlay(comparison, &title, &names));
    }
    format!("<div class=\"plots\">{html}</div>")
}

/// What a quantity of every other run is above that of the first.
fn above_the_first(comparison: &Comparison, quantity: &QuantityDifference) -> String {
    let column = format!("quantities.{}", quantity.name);
    let first = &comparison.series[0];
    let (times, values) = (first.column("process_time"), first.column(&column));
    let rows: Vec<Vec<f64>> = comparison.series[1..]
        .iter()
        .map(|series| {
            let (over, other) = (series.column("process_time"), series.column(&column));
            let pairs = times.iter().zip(values);
            pairs
                .map(|(&time, value)| between(over, other, time) - value)
                .collect()
        })
        .collect();
    let curves = rows.iter().zip(&comparison.runs[1..]).enumerate();
    let plot = Plot {
        title: format!(
            "{}: difference to {} in {}",
            quantity.name.replace('_', " "),
            comparison.runs[0].name,
            quantity.unit
        ),
        x_label: TIME,
        logarithmic: false,
        above: None,
        band: None,
        curves: curves
            .map(|(number, (row, run))| Curve {
                label: run.name.clone(),
                colour: colour::line(number + 1),
                x: times,
                y: row,
                stroke: Stroke::Solid,
            })
            .collect(),
    };
    plot.render()
}

/// The same columns of every run in one plot; where they agree, their colours take turns.
fn overlay(comparison: &Comparison, title: &str, columns: &[&str]) -> String {
    let mut curves = Vec::new();
    for (number, (run, series)) in comparison.runs.iter().zip(&comparison.series).enumerate() {
        for (place, column) in columns.iter().enumerate() {
            curves.push(Curve {
                label: if place == 0 {
                    run.name.clone()
                } else {
                    String::new()
                },
                colour: colour::line(number),
                x: series.column("process_time"),
                y: series.column(column),
                stroke: Stroke::Share(number, comparison.runs.len()),
            });
        }
    }
    let plot = Plot {
        title: title.into(),
        x_label: TIME,
        logarithmic: false,
        above: None,
        band: None,
        curves,
    };
    plot.render()
}

fn wall(comparison: &Comparison) -> String {
    let bar = |run: &ComparedRun| {
        let text = format!(
            "{} · ledger {}",
            span(run.wall_time_s),
            figure(run.ledger_error, 2)
        );
        (run.name.clone(), run.wall_time_s, text)
    };
    let entries: Vec<_> = comparison.runs.iter().map(bar).collect();
    let entries: Vec<_> = entries
        .iter()
        .map(|(name, value, text)| (name.as_str(), *value, text.clone()))
        .collect();
    bars(&entries)
}
