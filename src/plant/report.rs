//! The report of a plant: one self-contained HTML page made from a results folder.

mod flowsheet;
mod labels;

use std::path::{Path, PathBuf};

use super::files::{Distributions, TimeTable, distributions};
use super::measure;
use super::summary::{PlantMode, PlantSummary, PlantTuningSummary};
use crate::case::plant::{PlantCase, read_plant_results};
use crate::report::REPORT;
use crate::report::colour;
use crate::report::number::{figure, span, with_unit};
use crate::report::page::{Page, badge, escape, table, tiles};
use crate::report::plot::{Curve, ExpectedBand, Plot, Stroke};
use crate::results::summary::QuantityResult;
use crate::results::{CASE, ResultsError, Verdict, files};

/// Label of the axes of time.
const TIME: &str = "time in s";
/// Label of the axes of diameters.
const DIAMETER: &str = "diameter in mm";
/// Most distributions of a plot.
const CURVES: usize = 6;

/// Writes `report.html` into a results folder of a plant, from the files that are in it.
pub fn write_plant_report(directory: &Path) -> Result<PathBuf, ResultsError> {
    let summary = PlantSummary::read(directory)?;
    let series = TimeTable::series(directory)?;
    let kept = directory.join(CASE);
    let text = files::read(&kept)?;
    let case = read_plant_results(&kept)
        .map_err(|wrong| ResultsError::content(&kept, wrong.to_string()))?;
    let kicker = format!(
        "{} · {} units · {} streams",
        summary.case.name,
        case.plant.units().len(),
        case.plant.streams().len()
    );
    let mut page = Page::new(&kicker, &summary.case.title, &badge(summary.verdict));
    page.raw(&headline(&summary));
    page.section("Quantities of interest", "", &quantities(&summary));
    page.section(
        "Flowsheet",
        match summary.tears.is_empty() {
            true => {
                "Streams at the end of the run: mass flow and median diameter; lines are wider where more flows."
            }
            false => {
                "Streams at the end of the run: mass flow and median diameter; lines are wider where more flows. Streams at which recycles are torn are dashed."
            }
        },
        &flowsheet::draw(&case, &series, &summary),
    );
    if let Some(found) = &summary.tuning {
        page.section(
            "Tuned keys",
            "Keys that were fitted to measurements, each with its interval, and how the quantities depend on them.",
            &tuned(found),
        );
    }
    page.section("Over time", "", &plots(&summary, &series, &case));
    let (edges, places) = distributions(directory)?;
    page.section(
        "Distributions",
        "Mass per width of the size classes, from the first (dark) to the last (light).",
        &shapes(&case, &edges, &places),
    );
    page.section("Stability", "", &stability(&summary));
    page.section("Streams at the end", "", &streams(&case, &series));
    page.section(
        "Ledger",
        "What came in, went out and is held since the start, and what does not close, relative to these.",
        &ledger(&summary),
    );
    let text = format!(
        "<details><summary>The case as it was run</summary><pre>{}</pre></details>",
        escape(&text)
    );
    page.section("Case file", "", &text);
    let footer = format!("Calcine {} · all units are SI", summary.calcine);
    let path = directory.join(REPORT);
    files::replace(&path, page.finish(&footer).as_bytes())?;
    Ok(path)
}

fn headline(summary: &PlantSummary) -> String {
    let stable = match &summary.stability {
        Some(mode) if mode.growth_rate_per_s < 0.0 => "stable",
        Some(mode) if mode.growth_rate_per_s == 0.0 => "neutral",
        Some(_) => "not stable",
        None => "–",
    };
    let detail = summary.stability.as_ref().map_or_else(
        || "no steady state asked for".to_owned(),
        |mode| format!("{} 1/s", figure(mode.growth_rate_per_s, 3)),
    );
    tiles(&[
        (
            "time",
            span(summary.time_s),
            format!("of {}", span(summary.end_s)),
        ),
        (
            "wall time",
            span(summary.wall_time_s),
            format!("{} steps, {}", summary.steps, summary.integrator),
        ),
        (
            "unknowns",
            summary.unknowns.to_string(),
            format!("{} size classes", summary.classes),
        ),
        (
            "recycles close to",
            figure(summary.ledger.loop_closure, 2),
            format!("{}, torn at {}", summary.recycles, summary.tears.len()),
        ),
        (
            "balances close to",
            figure(summary.ledger.largest_relative_error, 2),
            "relative, of all units".into(),
        ),
        ("steady state", stable.into(), detail),
    ])
}

fn quantities(summary: &PlantSummary) -> String {
    let band = |result: &QuantityResult| match result.band {
        Some((low, high)) => {
            format!("{} … {}", figure(low, 5), with_unit(high, 5, &result.unit))
        }
        None => "none stated".into(),
    };
    let verdict = |result: &QuantityResult| {
        let word = match result.verdict {
            Verdict::Pass => "inside",
            Verdict::Fail => "outside",
            Verdict::Running | Verdict::Stopped => "not known yet",
            Verdict::None => return "–".to_owned(),
        };
        format!(
            "<span class=\"badge {}\">{word}</span>",
            result.verdict.word()
        )
    };
    let rows: Vec<_> = summary
        .quantities
        .iter()
        .map(|(name, result)| {
            let value = result.value;
            vec![
                escape(&name.replace('_', " ")),
                value.map_or("–".into(), |value| with_unit(value, 6, &result.unit)),
                band(result),
                verdict(result),
            ]
        })
        .collect();
    table(&["quantity", "#value", "#expected", "verdict"], &rows)
}

/// Keys with their intervals, and derivatives of quantities.
fn tuned(found: &PlantTuningSummary) -> String {
    let keys: Vec<Vec<String>> = found
        .parameters
        .iter()
        .map(|one| {
            let [low, high] = one.interval.map(|end| figure(end, 5));
            vec![
                escape(&one.key),
                with_unit(one.value, 6, &one.unit),
                format!("{low} … {high}"),
                format!(
                    "{} … {}",
                    figure(one.bounds[0], 5),
                    figure(one.bounds[1], 5)
                ),
            ]
        })
        .collect();
    let head = ["key", "#value", "#interval", "#bounds"];
    let mut html = table(&head, &keys);
    if let Some(failure) = &found.failure {
        let (failed, trials) = (found.failed, found.trials);
        let failure = escape(failure);
        html.push_str(&format!(
            "<p>{failed} of {trials} trials failed, one of them: {failure}</p>"
        ));
    }
    if let Some(cause) = &found.not_sensitive {
        let cause = escape(cause);
        html.push_str(&format!(
            "<p>No derivatives beside what was found: {cause}</p>"
        ));
    }
    let slopes: Vec<Vec<String>> = found
        .sensitivities
        .iter()
        .flat_map(|one| {
            found.parameters.iter().zip(&one.by).map(|(key, slope)| {
                let per = if key.unit.is_empty() { "1" } else { &key.unit };
                vec![
                    escape(&one.quantity.replace('_', " ")),
                    escape(&key.key),
                    format!("{} {} per {per}", figure(*slope, 4), one.unit),
                ]
            })
        })
        .collect();
    if !slopes.is_empty() {
        html.push_str(&table(&["quantity", "key", "#derivative"], &slopes));
    }
    html
}

/// Flows of all streams, diameters of what units hold, and of the streams that leave the plant.
fn plots(summary: &PlantSummary, series: &TimeTable, case: &PlantCase) -> String {
    let time = series.times();
    let plot = |title: &str, curves: Vec<(String, Vec<f64>)>| {
        let curves = curves.iter().enumerate();
        let curves = curves.map(|(place, (label, values))| Curve {
            label: label.clone(),
            colour: colour::line(place),
            x: time,
            y: values,
            stroke: Stroke::Solid,
        });
        let plot = Plot {
            title: title.into(),
            x_label: TIME,
            logarithmic: false,
            above: None,
            band: None::<ExpectedBand>,
            curves: curves.collect(),
        };
        plot.render()
    };
    let own = |place: &str, field: &str, factor: f64| {
        let values = series.column(&format!("{place}.{field}"));
        values.iter().map(|v| factor * v).collect::<Vec<f64>>()
    };
    let plant = &case.plant;
    let inside = |stream: &usize| {
        let (from, to) = plant.ends_of(*stream);
        let ends = [from, to].map(|unit| &plant.units()[unit]);
        !ends[0].entering().is_empty() && !ends[1].leaving().is_empty()
    };
    let all = 0..plant.streams().len();
    let (within, rest): (Vec<usize>, Vec<usize>) = all.partition(inside);
    let mut html = String::new();
    for (title, streams) in [
        ("Mass flow of streams between units in kg/s", within),
        (
            "Mass flow of streams that enter and leave the plant in kg/s",
            rest,
        ),
    ] {
        for (part, some) in streams.chunks(6).enumerate() {
            let flow = |stream: &usize| {
                let name = &plant.streams()[*stream];
                (
                    name.clone(),
                    own(&format!("streams.{name}"), "mass_flow", 1.0),
                )
            };
            let title = match part {
                0 => title.to_owned(),
                part => format!("{title} ({})", part + 1),
            };
            html.push_str(&plot(&title, some.iter().map(flow).collect()));
        }
    }
    for (unit, _) in plant
        .units()
        .iter()
        .enumerate()
        .filter(|(k, _)| plant.holds(*k))
    {
        let name = &plant.units()[unit].name;
        let place = format!("units.{name}");
        let quantiles = ["d10", "d50", "d90", "mean_diameter"];
        let curves = quantiles.map(|field| (field.replace('_', " "), own(&place, field, 1e3)));
        html.push_str(&plot(
            &format!("Diameters in {name} in mm"),
            curves.to_vec(),
        ));
        let mass = vec![(String::new(), own(&place, "mass", 1.0))];
        html.push_str(&plot(&format!("Mass in {name} in kg"), mass));
    }
    let leaves = (0..plant.streams().len()).filter(|stream| {
        let to = plant.ends_of(*stream).1;
        plant.units()[to].leaving().is_empty()
    });
    for stream in leaves {
        let name = &plant.streams()[stream];
        let place = format!("streams.{name}");
        let curves = ["d10", "d50", "d90"].map(|field| (field.into(), own(&place, field, 1e3)));
        html.push_str(&plot(
            &format!("Diameters of {name} in mm"),
            curves.to_vec(),
        ));
    }
    if let Some(states) = &summary.continuation {
        html.push_str(&continuation(states));
    }
    format!("<div class=\"plots\">{html}</div>")
}

/// Growth rate of the dominant mode over the key.
fn continuation(states: &super::summary::PlantContinuationSummary) -> String {
    let x: Vec<f64> = states.points.iter().map(|point| point.value).collect();
    let rates = states.points.iter();
    let rates: Vec<f64> = rates
        .map(|point| 1e3 * point.mode.growth_rate_per_s)
        .collect();
    let zero = vec![0.0; x.len()];
    let curve = |label: &str, y, number| Curve {
        label: label.into(),
        colour: colour::line(number),
        x: &x,
        y,
        stroke: Stroke::Solid,
    };
    let plot = Plot {
        title: "Growth rate of the dominant mode in 1/1000 s over the key".into(),
        x_label: "value of the key",
        logarithmic: false,
        above: None,
        band: None::<ExpectedBand>,
        curves: vec![curve("growth rate", &rates, 0), curve("limit", &zero, 1)],
    };
    plot.render()
}

/// Distributions of each place over time, as densities.
fn shapes(case: &PlantCase, edges: &[f64], places: &[Distributions]) -> String {
    let grid = case.plant.layout().grid();
    if grid.classes() != edges.len() {
        return String::new();
    }
    let middles: Vec<f64> = grid.diameters().iter().map(|d| 1e3 * d).collect();
    let mut html = String::new();
    let own = measure::places(&case.plant);
    // Those of attribute classes are in the files alone.
    let is_whole = |place: &&Distributions| own.iter().any(|(_, name)| *name == place.place);
    for place in places.iter().filter(is_whole) {
        let any = place.masses.iter().flatten().any(|mass| *mass > 0.0);
        if !any {
            continue;
        }
        let count = place.times.len();
        let shown = count.min(CURVES);
        // Evenly over what is there, the first and the last among them.
        let picked = (0..shown).map(|k| match shown {
            1 => 0,
            _ => k * (count - 1) / (shown - 1),
        });
        let picked: Vec<usize> = picked.collect();
        let densities = picked.iter().map(|time| {
            let masses = &place.masses[*time];
            let sum: f64 = masses.iter().sum();
            let density = |(class, mass): (usize, &f64)| mass / sum / (1e3 * grid.width(class));
            masses.iter().enumerate().map(density).collect::<Vec<f64>>()
        });
        let densities: Vec<Vec<f64>> = densities.collect();
        let curves = picked.iter().zip(&densities).enumerate();
        let curves = curves.map(|(number, (time, density))| Curve {
            label: span(place.times[*time]),
            colour: colour::scale(0.1 + 0.72 * number as f64 / shown.max(2) as f64),
            x: &middles,
            y: density,
            stroke: Stroke::Solid,
        });
        let name = place.place.replacen("streams.", "stream ", 1);
        let name = name.replacen("units.", "unit ", 1);
        let plot = Plot {
            title: format!("Density of {name} in 1/mm"),
            x_label: DIAMETER,
            logarithmic: false,
            above: None,
            band: None::<ExpectedBand>,
            curves: curves.collect(),
        };
        html.push_str(&plot.render());
    }
    match html.is_empty() {
        true => html,
        false => format!("<div class=\"plots\">{html}</div>"),
    }
}

fn stability(summary: &PlantSummary) -> String {
    let row = |what: String, mode: &PlantMode| {
        let rate = mode.growth_rate_per_s;
        vec![
            escape(&what),
            format!("{} 1/s", figure(rate, 4)),
            mode.period_s
                .map_or("–".into(), |period| with_unit(period, 5, "s")),
            if rate < 0.0 { "decays" } else { "grows" }.into(),
        ]
    };
    let mut rows = Vec::new();
    if let Some(steady) = &summary.steady {
        let modes = steady.modes.iter().enumerate();
        rows.extend(
            modes.map(|(k, mode)| row(format!("mode {} at the steady state", k + 1), mode)),
        );
    }
    if let Some(states) = &summary.continuation {
        let value = |value: f64| with_unit(value, 6, &states.unit);
        let points = states.points.iter();
        rows.extend(points.map(|point| row(value(point.value), &point.mode)));
        let limits = states.limits.iter();
        rows.extend(limits.map(|one| row(format!("limit: {}", value(one.value)), &one.mode)));
    }
    let why = summary.not_steady.as_ref();
    let why = why.map(|text| format!("<p class=\"note\">{}</p>", escape(text)));
    let modes = table(&["", "#growth rate", "#period", "small deviations"], &rows);
    why.unwrap_or_default() + &modes
}

fn streams(case: &PlantCase, series: &TimeTable) -> String {
    let plant = &case.plant;
    let last = |name: &str, field: &str| {
        let values = series.column(&format!("streams.{name}.{field}"));
        values.last().copied().unwrap_or(f64::NAN)
    };
    let rows: Vec<_> = plant
        .streams()
        .iter()
        .enumerate()
        .map(|(k, name)| {
            let (from, to) = plant.ends_of(k);
            let mm = |field| figure(1e3 * last(name, field), 4);
            vec![
                escape(name),
                escape(&plant.units()[from].name),
                escape(&plant.units()[to].name),
                figure(last(name, "mass_flow"), 5),
                figure(last(name, "solid_flow"), 5),
                figure(last(name, "temperature"), 5),
                mm("d10"),
                mm("d50"),
                mm("d90"),
            ]
        })
        .collect();
    table(
        &[
            "stream", "from", "to", "#kg/s", "#solids", "#K", "#d10 mm", "#d50 mm", "#d90 mm",
        ],
        &rows,
    )
}

fn ledger(summary: &PlantSummary) -> String {
    let mut rows: Vec<_> = summary
        .ledger
        .lines
        .iter()
        .map(|line| {
            let unit = match line.what.as_str() {
                "enthalpy" => "J",
                _ => "kg",
            };
            let value = |value| with_unit(value, 5, unit);
            vec![
                escape(&line.place),
                escape(&line.what),
                value(line.enters),
                value(line.leaves),
                value(line.stored),
                value(line.heat),
                figure(line.relative_error, 2),
            ]
        })
        .collect();
    for (stream, apart) in &summary.ledger.tears {
        let mut row = vec![escape(stream), "torn stream against itself".into()];
        row.extend(std::iter::repeat_n(String::from("–"), 4));
        row.push(figure(*apart, 2));
        rows.push(row);
    }
    let head = [
        "unit",
        "balance",
        "#in",
        "#out",
        "#stored",
        "#heat",
        "#relative error",
    ];
    table(&head, &rows)
}
