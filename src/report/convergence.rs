//! How well windows converged: in words and as curves.

use super::colour;
use super::number::figure;
use super::plot::{Curve, Plot, Stroke, TIME};
use crate::results::Summary;
use crate::results::read::Series;

pub(super) fn converged(summary: &Summary) -> String {
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

pub(super) fn residuals(series: &Series) -> String {
    let time = series.column("process_time");
    let plot = |title: &str, columns: &[(&str, &str)]| {
        let curve = |(number, &(label, name)): (usize, &(&str, &str))| Curve {
            label: label.into(),
            colour: colour::line(number),
            x: time,
            y: series.column(name),
            stroke: Stroke::Solid,
        };
        // What this run does not tell has no name beside the plot either.
        let curves = columns.iter().enumerate().map(curve);
        let curves = curves.filter(|curve| curve.y.iter().any(|value| *value > 0.0));
        let plot = Plot {
            title: title.into(),
            x_label: TIME,
            logarithmic: true,
            above: None,
            band: None,
            curves: curves.collect(),
        };
        plot.render()
    };
    let plots = [
        (
            "Residuals of the window",
            &[
                ("residual", "gas.residual"),
                ("volume residual", "gas.volume_residual"),
            ][..],
        ),
        (
            "Iterations of the window",
            &[
                ("outer", "gas.outer_iterations"),
                ("linear", "gas.linear_iterations"),
            ],
        ),
        (
            "Estimated error of the window's step",
            &[
                ("velocity", "step.velocity_error"),
                ("temperature", "step.temperature_error"),
                ("composition", "step.composition_error"),
            ],
        ),
        (
            "Window in s of motion time, and its Courant number",
            &[
                ("window", "step.motion_window"),
                ("Courant number", "step.courant"),
            ],
        ),
    ];
    let html: String = plots
        .iter()
        .map(|(title, columns)| plot(title, columns))
        .collect();
    format!("<div class=\"plots\">{html}</div>")
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
