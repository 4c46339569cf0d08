//! The report of a tuning: one self-contained page, written with the results.

use std::path::{Path, PathBuf};

use super::case::TuningCase;
use super::outcome::{FittedCurve, TuningOutcome};
use crate::report::REPORT;
use crate::report::colour::line;
use crate::report::number::figure;
use crate::report::page::{Page, escape, table, tiles};
use crate::report::plot::{Curve, Plot, Stroke};
use crate::results::{ResultsError, files};

/// Writes `report.html` into the results folder.
pub fn write_page(
    folder: &Path,
    case: &TuningCase,
    found: &TuningOutcome,
) -> Result<PathBuf, ResultsError> {
    let law = found
        .laws
        .get(found.chosen)
        .map_or("whole case", |one| one.law);
    let mut page = Page::new(&format!("{} · tuning · {law}", case.name), &case.title, "");
    page.raw(&headline(case, found));
    let told: String = found
        .warnings
        .iter()
        .map(|one| format!("<li>{}</li>", escape(one)))
        .collect();
    if !told.is_empty() {
        page.section("Warnings", "", &format!("<ul>{told}</ul>"));
    }
    let level = figure(100.0 * case.intervals.level, 3);
    let text = format!(
        "Intervals hold the true value with a probability of {level} % where the model is right and differences are noise."
    );
    page.section("Parameters", &text, &parameters(found));
    page.section("Laws", "Akaike's criterion: the lowest, unless a law with fewer numbers of its own comes within 6 of it.", &laws(found));
    page.section(
        "Measured and fitted",
        "Points are measured, lines are the model.",
        &fitted(found, false),
    );
    page.section(
        "Errors of the curves",
        "Of the mass where it reacts: the largest difference as a share of its whole loss, at conversions of 0.001 to 0.999.",
        &errors(case, found),
    );
    page.section(
        "Differences",
        "Model less measurement, over time.",
        &fitted(found, true),
    );
    page.section(
        "Front",
        "All evaluations that no other beats in every objective, and the chosen one.",
        &front(found),
    );
    page.section(
        "Profiles of the likelihood",
        "Rise of the deviance along one parameter with all others refitted; the interval ends where it crosses the line.",
        &profiles(found),
    );
    page.section("Energies without a law", "", &energies(found));
    let text = format!(
        "<details><summary>The case as it was tuned</summary><pre>{}</pre></details>",
        escape(&case.effective)
    );
    page.section("Case file", "", &text);
    let footer = format!("Calcine {}", env!("CARGO_PKG_VERSION"));
    let path = folder.join(REPORT);
    files::replace(&path, page.finish(&footer).as_bytes())?;
    Ok(path)
}

fn headline(case: &TuningCase, found: &TuningOutcome) -> String {
    let mut entries: Vec<(&str, String, String)> = found
        .parameters
        .iter()
        .take(4)
        .map(|one| {
            let ends = one.interval.or(one.bootstrap);
            let ends = ends.map(|[low, high]| {
                format!("{} to {} {}", figure(low, 4), figure(high, 4), one.unit)
            });
            (
                one.name.as_str(),
                format!("{} {}", figure(one.value, 4), one.unit),
                ends.unwrap_or_default(),
            )
        })
        .collect();
    let algorithm = if case.method.evolution {
        "nsga2"
    } else {
        "least squares"
    };
    entries.push((
        "evaluations",
        found.evaluations.to_string(),
        format!("{algorithm}, seed {}", case.method.seed),
    ));
    tiles(&entries)
}

fn parameters(found: &TuningOutcome) -> String {
    let ends = |ends: Option<[f64; 2]>| {
        ends.map_or("–".into(), |[low, high]| {
            format!("{} … {}", figure(low, 5), figure(high, 5))
        })
    };
    let rows = found.parameters.iter().map(|one| {
        let note = match (one.at_bound, one.open) {
            (true, _) => "on a bound",
            (_, [false, false]) => "",
            _ => "not limited by the targets",
        };
        vec![
            escape(&one.name),
            figure(one.value, 6),
            escape(&one.unit),
            ends(one.interval),
            ends(one.bootstrap),
            ends(Some(one.bounds)),
            note.into(),
        ]
    });
    let head = [
        "parameter",
        "#value",
        "unit",
        "#profile",
        "#bootstrap",
        "#bounds",
        "",
    ];
    table(&head, &rows.collect::<Vec<_>>())
}

fn laws(found: &TuningOutcome) -> String {
    if found.laws.len() < 2 {
        return String::new();
    }
    let rows = found.laws.iter().enumerate().map(|(k, one)| {
        let values = one
            .values
            .iter()
            .map(|(name, value)| format!("{} {}", escape(name), figure(*value, 5)));
        let errors = found.objectives.iter().zip(&one.errors);
        let errors = errors.map(|(name, rms)| format!("{} {}", escape(name), figure(*rms, 3)));
        vec![
            format!(
                "{}{}",
                one.law,
                if k == found.chosen { " (chosen)" } else { "" }
            ),
            figure(one.criterion, 6),
            figure(one.weight, 3),
            errors.collect::<Vec<_>>().join(", "),
            values.collect::<Vec<_>>().join(", "),
        ]
    });
    let mut rows: Vec<(f64, Vec<String>)> = found
        .laws
        .iter()
        .map(|one| one.criterion)
        .zip(rows)
        .collect();
    rows.sort_by(|a, b| a.0.total_cmp(&b.0));
    let rows: Vec<Vec<String>> = rows.into_iter().map(|row| row.1).collect();
    table(
        &[
            "law",
            "#criterion",
            "#weight",
            "root mean square",
            "parameters in SI units",
        ],
        &rows,
    )
}

/// A row each curve.
fn errors(case: &TuningCase, found: &TuningOutcome) -> String {
    let share = |value: Option<f64>| value.map_or("–".into(), |it| figure(100.0 * it, 3));
    let rows = found.curves.iter().map(|one| {
        let errors = one.errors(case.loss);
        vec![
            escape(&one.target),
            one.quantity.name().replace('_', " "),
            if one.is_fitted { "yes" } else { "no" }.into(),
            format!("{} {}", figure(errors.root_mean_square, 3), one.unit),
            share(errors.mean_relative),
            share(errors.largest_of_loss),
        ]
    });
    let rows: Vec<Vec<String>> = rows.collect();
    table(
        &[
            "curve",
            "quantity",
            "fitted",
            "#root mean square",
            "#mean relative error, %",
            "#of the mass where it reacts, %",
        ],
        &rows,
    )
}

/// A plot each compared quantity.
fn fitted(found: &TuningOutcome, differences: bool) -> String {
    let mut names: Vec<&str> = found.curves.iter().map(|one| one.quantity.name()).collect();
    names.dedup();
    names.sort_unstable();
    names.dedup();
    let mut html = String::new();
    for name in names {
        let own: Vec<&FittedCurve> = found
            .curves
            .iter()
            .filter(|one| one.quantity.name() == name)
            .collect();
        let unit = own.first().map_or("", |one| one.unit.as_str());
        let over_temperature = !differences
            && name != "temperature"
            && own.iter().all(|one| !one.temperature.is_empty());
        let axes: Vec<Vec<f64>> = own
            .iter()
            .map(|one| match over_temperature {
                true => one.temperature.iter().map(|t| t - 273.15).collect(),
                false => one.time.clone(),
            })
            .collect();
        let off: Vec<Vec<f64>> = own
            .iter()
            .map(|one| {
                one.model
                    .iter()
                    .zip(&one.measured)
                    .map(|(a, b)| a - b)
                    .collect()
            })
            .collect();
        let mut curves = Vec::new();
        for (k, (one, x)) in own.iter().zip(&axes).enumerate() {
            let curve = |label: String, y, stroke| Curve {
                label,
                colour: line(k),
                x,
                y,
                stroke,
            };
            let label = match one.is_fitted {
                true => one.target.clone(),
                false => format!("{} (not fitted)", one.target),
            };
            if differences {
                curves.push(curve(label, &off[k], Stroke::Solid));
            } else {
                curves.push(curve(String::new(), &one.measured, Stroke::Points));
                curves.push(curve(label, &one.model, Stroke::Solid));
            }
        }
        let title = match (differences, unit) {
            (false, "") => name.replace('_', " "),
            (false, unit) => format!("{} in {unit}", name.replace('_', " ")),
            (true, "") => format!("difference of {}", name.replace('_', " ")),
            (true, unit) => format!("difference of {} in {unit}", name.replace('_', " ")),
        };
        html += &Plot {
            title,
            x_label: if over_temperature {
                "temperature in °C"
            } else {
                "time in s"
            },
            logarithmic: false,
            above: None,
            band: None,
            curves,
        }
        .render();
    }
    plots(&html)
}

fn plots(html: &str) -> String {
    match html.is_empty() {
        true => String::new(),
        false => format!("<div class=\"plots\">{html}</div>"),
    }
}

fn front(found: &TuningOutcome) -> String {
    let Some(front) = &found.front else {
        return String::new();
    };
    let points = front.archive.front();
    let mut html = String::new();
    if let [first, second, ..] = &found.objectives[..] {
        let x: Vec<f64> = points.iter().map(|one| one.objectives[0]).collect();
        let y: Vec<f64> = points.iter().map(|one| one.objectives[1]).collect();
        let (chosen_x, chosen_y) = ([found.sums[0]], [found.sums[1]]);
        html += &Plot {
            title: format!("sum of squares of {second}"),
            x_label: &format!("sum of squares of {first}"),
            logarithmic: false,
            above: None,
            band: None,
            curves: vec![
                Curve {
                    label: "front".into(),
                    colour: line(0),
                    x: &x,
                    y: &y,
                    stroke: Stroke::Points,
                },
                Curve {
                    label: "chosen, after the polish".into(),
                    colour: line(1),
                    x: &chosen_x,
                    y: &chosen_y,
                    stroke: Stroke::Points,
                },
            ],
        }
        .render();
    }
    let generations: Vec<f64> = (0..front.hypervolumes.len()).map(|k| k as f64).collect();
    let short: Vec<f64> = front.hypervolumes.iter().map(|one| 1.0 - one).collect();
    html += &Plot {
        title:
            "one less the hypervolume of the front, relative to the first generation's worst point"
                .into(),
        x_label: "generation",
        logarithmic: true,
        above: None,
        band: None,
        curves: vec![Curve {
            label: String::new(),
            colour: line(0),
            x: &generations,
            y: &short,
            stroke: Stroke::Solid,
        }],
    }
    .render();
    plots(&html)
}

fn profiles(found: &TuningOutcome) -> String {
    let mut html = String::new();
    for profile in &found.profiles {
        let one = &found.space.parameters()[profile.parameter];
        let near: Vec<(f64, f64)> = profile
            .points
            .iter()
            .copied()
            .filter(|(_, rise)| *rise < 4.0 * profile.threshold)
            .collect();
        let x: Vec<f64> = near
            .iter()
            .map(|(place, _)| found.space.value(profile.parameter, *place))
            .collect();
        let y: Vec<f64> = near.iter().map(|(_, rise)| *rise).collect();
        let threshold = vec![profile.threshold; x.len()];
        html += &Plot {
            title: format!("{}: rise of the deviance", one.name.replace('_', " ")),
            x_label: &format!(
                "{} in {}",
                one.name.replace('_', " "),
                super::write::unit_name(one.dimension)
            ),
            logarithmic: false,
            above: None,
            band: None,
            curves: vec![
                Curve {
                    label: "profile".into(),
                    colour: line(0),
                    x: &x,
                    y: &y,
                    stroke: Stroke::Solid,
                },
                Curve {
                    label: "end of the interval".into(),
                    colour: line(1),
                    x: &x,
                    y: &threshold,
                    stroke: Stroke::Solid,
                },
            ],
        }
        .render();
    }
    plots(&html)
}

fn energies(found: &TuningOutcome) -> String {
    let energies = &found.energies;
    let mut html = String::new();
    if let Some(one) = &energies.kissinger {
        let rows: Vec<Vec<String>> = one
            .peaks
            .iter()
            .map(|(rate, peak)| vec![figure(60.0 * rate, 4), figure(peak - 273.15, 5)])
            .collect();
        html += &format!(
            "<p>Kissinger: {} ± {} kJ/mol (standard error).</p>{}",
            figure(one.energy / 1e3, 5),
            figure(one.energy_error / 1e3, 2),
            table(&["#heating rate in K/min", "#largest rate at °C"], &rows)
        );
    }
    let lists = [
        ("Friedman", &energies.friedman),
        ("Ozawa, Flynn and Wall", &energies.ozawa_flynn_wall),
    ];
    let lists: Vec<(&str, Vec<f64>, Vec<f64>)> = lists
        .into_iter()
        .filter(|(_, list)| !list.is_empty())
        .map(|(name, list)| {
            (
                name,
                list.iter().map(|one| one.conversion).collect(),
                list.iter().map(|one| one.energy / 1e3).collect(),
            )
        })
        .collect();
    let curves = lists.iter().enumerate().map(|(k, (name, x, y))| Curve {
        label: (*name).into(),
        colour: line(k),
        x,
        y,
        stroke: Stroke::Solid,
    });
    let plot = Plot {
        title: "energy in kJ/mol".into(),
        x_label: "conversion",
        logarithmic: false,
        above: None,
        band: None,
        curves: curves.collect(),
    };
    html += &plots(&plot.render());
    for note in &energies.notes {
        html += &format!("<p class=\"note\">{}</p>", escape(note));
    }
    html
}
