//! The report of a run: one self-contained HTML page made from a result directory.

mod bed_columns;
mod cells;
pub(crate) mod colour;
mod flows;
pub(crate) mod links;
pub(crate) mod number;
pub(crate) mod overview;
pub(crate) mod page;
mod picture;
pub(crate) mod plot;
mod probes;
mod profiles;
mod section;
mod shade;
mod spread;
mod swept_axis;
mod ticks;
mod view;
mod voids;
mod warnings;

use std::path::{Path, PathBuf};

use calcine_coupler::ledger::{DRAG_CARRY, PRESCRIBED_HEAT, STORAGE_CLOCK};

use self::number::{figure, span, with_unit};
use self::page::{Page, badge, bars, escape, table, tiles};
use self::plot::{Curve, ExpectedBand, Plot, Stroke, TIME};
use self::view::View;
use crate::results::read::Series;
use crate::results::summary::{QuantityResult, SolverSummary};
use crate::results::{CASE, ResultsError, Summary, Verdict, files};

/// Name of the page in a result directory.
pub use crate::results::files::REPORT;
/// Up to so many particles are named in the legend of their plot.
const NAMED_PARTICLES: usize = 20;

/// Bytes of a page at most, as far as its view of the bed can see to that.
const PAGE: usize = 3_000_000;
/// Stands for the view until it is known how much room there is for it.
const VIEW_PLACE: &str = "<!--view-->";

/// Writes `report.html` into a result directory, from the files that are in it.
pub fn write(directory: &Path) -> Result<PathBuf, ResultsError> {
    let path = directory.join(REPORT);
    files::replace(&path, page(directory)?.as_bytes())?;
    Ok(path)
}

/// The page of a result directory, from the files that are in it.
pub(crate) fn page(directory: &Path) -> Result<String, ResultsError> {
    let summary = Summary::now(directory)?;
    let series = Series::read(directory)?;
    let case = files::read(&directory.join(CASE))?;
    let kicker = format!(
        "{} · {} gas · {} particles",
        summary.case.name, summary.backend.gas, summary.backend.particles
    );
    let mut page = Page::new(&kicker, &summary.case.title, &badge(summary.verdict));
    page.raw(&headline(&summary));
    let told = warnings::render(&summary);
    if !told.is_empty() {
        let text =
            "What was outside the range of a law, or did not converge, in committed windows.";
        page.section("Warnings", text, &told);
    }
    page.section("Quantities of interest", "", &quantities(&summary));
    let came_and_went = passed(&summary);
    if !came_and_went.is_empty() {
        let text = "Particles that feeds brought, that outlets took, and what was left of those that reactions used up.";
        page.section("Particles that came and went", text, &came_and_went);
    }
    let view = View::read(directory)?;
    let picture = picture::render(directory, |shade| view.as_ref()?.range(shade))?;
    page.section(
        "Bed and gas",
        "A cut through the middle, seen from the side: gas cells and particles in one colour scale, that of \
         particles' speeds where all have one temperature.",
        &picture.html,
    );
    let view = view.zip(picture.shade);
    if view.is_some() {
        let text = "All particles, snapshot by snapshot, and walls as they are at the start, in the colours of the picture above.";
        page.section("The bed in three dimensions", text, VIEW_PLACE);
        page.adds(view::STYLE, view::SCRIPT);
    }
    let text = "What came in and went out, as the ledger counts it.";
    page.section("Heat and mass in and out", text, &flows::render(&summary));
    page.section("Over time", "", &plots(&summary, &series));
    let sampled = probes::render(directory)?;
    if !sampled.is_empty() {
        let text = "Fields at the points of the case's probes, snapshot by snapshot.";
        page.section("Probes", text, &sampled);
    }
    let distributions = profiles::render(directory)?;
    page.section(
        "Profiles",
        "Means over layers across the longest side: of the gas by volume, of the particles by number.",
        &distributions.profiles,
    );
    page.section(
        "Histograms",
        "Of the number of particles, at the first snapshot and at the last.",
        &distributions.histograms,
    );
    let profiles = voids::render(directory)?;
    if !profiles.is_empty() {
        let text = "Share of the cross-section, and in a cylinder of the surface of each distance from its wall, \
                    that no particle covers, at the end.";
        page.section("Void fraction", text, &profiles);
    }
    page.section(
        "Ledger",
        "What did not close, relative to all that moved, over the whole run.",
        &ledger(&summary),
    );
    page.section("Where the wall time went", "", &timing(&summary));
    let phases = gas_phases(&summary);
    if !phases.is_empty() {
        page.section("Where the gas' wall time went", "", &phases);
    }
    page.section(
        "Convergence of the gas",
        &converged(&summary),
        &residuals(&series),
    );
    page.section("What was run", "", &provenance(&summary));
    let text = "They open where they lie beside this page.";
    page.section("Files", text, &links::render(directory));
    let text = format!(
        "<details><summary>The case as it was run</summary><pre>{}</pre></details>",
        escape(&case)
    );
    page.section("Case file", "", &text);
    let footer = format!(
        "Calcine {} · all times are process (real) time unless said otherwise",
        summary.calcine
    );
    let text = page.finish(&footer);
    Ok(match view {
        Some((view, shade)) => {
            let room = PAGE.saturating_sub(text.len());
            let html = view.render(shade, picture.range, room);
            text.replacen(VIEW_PLACE, &html, 1)
        }
        None => text,
    })
}

fn headline(summary: &Summary) -> String {
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
            span(wall),
            match summary.verdict {
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

fn quantities(summary: &Summary) -> String {
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
fn passed(summary: &Summary) -> String {
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

fn plots(summary: &Summary, series: &Series) -> String {
    let time = series.column("process_time");
    let motion = series.column("motion_time");
    let plot = |title: String, band, curves| Plot {
        title,
        x_label: TIME,
        logarithmic: false,
        above: Some(("motion time in s", time, motion)),
        band,
        curves,
    };
    let mut html = plot(
        "Temperature of each particle in K".into(),
        None,
        particle_curves(series, time),
    )
    .render();
    for (name, result) in &summary.quantities {
        let curve = Curve {
            label: String::new(),
            colour: colour::line(0),
            x: time,
            y: series.column(&format!("quantities.{name}")),
            stroke: Stroke::Solid,
        };
        let title = format!("{} in {}", name.replace('_', " "), result.unit);
        let band = result.band.map(|range| ExpectedBand {
            range,
            at: result.expected_at_s,
            label: format!("expected: {}", result.expectation().unwrap_or_default()),
        });
        html.push_str(&plot(title, band, vec![curve]).render());
    }
    format!("<div class=\"plots\">{html}</div>")
}

/// One line per particle from cold to hot along the order of ids; mean, least and largest where
/// there are too many.
fn particle_curves<'a>(series: &'a Series, time: &'a [f64]) -> Vec<Curve<'a>> {
    let tracks = series.particles();
    if tracks.is_empty() {
        let names = ["mean", "min", "max"];
        return names
            .iter()
            .enumerate()
            .map(|(place, name)| Curve {
                label: (*name).into(),
                colour: colour::line(place),
                x: time,
                y: series.column(&format!("particles.temperature_{name}")),
                stroke: Stroke::Solid,
            })
            .collect();
    }
    let (named, last) = (tracks.len() <= NAMED_PARTICLES, tracks.len().max(2) - 1);
    tracks
        .iter()
        .enumerate()
        .map(|(place, (id, values))| Curve {
            label: if named { (*id).into() } else { String::new() },
            // The ends of the scale are too dark and too light for a line.
            colour: colour::scale(0.2 + 0.62 * place as f64 / last as f64),
            x: time,
            y: values,
            stroke: Stroke::Solid,
        })
        .collect()
}

fn ledger(summary: &Summary) -> String {
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

fn timing(summary: &Summary) -> String {
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
fn gas_phases(summary: &Summary) -> String {
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

fn converged(summary: &Summary) -> String {
    let sums = &summary.convergence;
    let per_window = |count: u64| figure(count as f64 / summary.windows.max(1) as f64, 3);
    format!(
        "{} of {} windows ended at the limit of outer iterations; {} outer and {} linear \
         iterations a window; largest residual {}, largest volume residual {}. The exchange took {} \
         attempts a window; {} windows ended at their limit, the largest misplaced share is {}; windows were cut {} times. \
         {} \
         The smoother moved {} % of the solid volume out of cells above its threshold at the end, {} % at most.",
        sums.unconverged_windows,
        summary.windows,
        per_window(sums.outer_iterations),
        per_window(sums.linear_iterations),
        figure(sums.largest_residual, 2),
        figure(sums.largest_volume_residual, 2),
        per_window(sums.attempts),
        sums.unsettled_windows,
        figure(sums.largest_misplaced, 2),
        sums.cuts,
        steps(summary),
        figure(100.0 * summary.smoother.moved_share, 3),
        figure(100.0 * summary.smoother.largest_moved_share, 3),
    )
}

/// Lengths of windows and errors of their steps, in words.
fn steps(summary: &Summary) -> String {
    let steps = &summary.steps;
    if steps.longest_window_s == 0.0 {
        return String::new();
    }
    format!(
        "Windows were {} to {} s of motion time long, with Courant numbers of {} at most; the errors of their steps are estimated \
         at {} of the velocity, {} of the temperature and {} of mass fractions at most.",
        figure(steps.shortest_window_s, 3),
        figure(steps.longest_window_s, 3),
        figure(steps.largest_courant, 3),
        figure(steps.largest_velocity_error, 2),
        figure(steps.largest_temperature_error, 2),
        figure(steps.largest_composition_error, 2),
    )
}

fn residuals(series: &Series) -> String {
    let time = series.column("process_time");
    let curve = |label: &str, name: &str, number| Curve {
        label: label.into(),
        colour: colour::line(number),
        x: time,
        y: series.column(name),
        stroke: Stroke::Solid,
    };
    let plot = |title: &str, logarithmic, curves| {
        let plot = Plot {
            title: title.into(),
            x_label: TIME,
            logarithmic,
            above: None,
            band: None,
            curves,
        };
        plot.render()
    };
    let left = plot(
        "Residuals of the window",
        true,
        vec![
            curve("residual", "gas.residual", 0),
            curve("volume residual", "gas.volume_residual", 1),
        ],
    );
    let right = plot(
        "Iterations of the window",
        true,
        vec![
            curve("outer", "gas.outer_iterations", 0),
            curve("linear", "gas.linear_iterations", 1),
        ],
    );
    let errors = plot(
        "Estimated error of the window's step",
        true,
        vec![
            curve("velocity", "step.velocity_error", 0),
            curve("temperature", "step.temperature_error", 1),
            curve("composition", "step.composition_error", 2),
        ],
    );
    let lengths = plot(
        "Window in s of motion time, and its Courant number",
        true,
        vec![
            curve("window", "step.motion_window", 0),
            curve("Courant number", "step.courant", 1),
        ],
    );
    format!("<div class=\"plots\">{left}{right}{errors}{lengths}</div>")
}

fn provenance(summary: &Summary) -> String {
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
