//! Curves of the series: temperatures of particles, and quantities with their bands.

use super::colour;
use super::plot::{Curve, ExpectedBand, Plot, Stroke, TIME};
use crate::results::Summary;
use crate::results::read::Series;

/// Up to so many particles are named in the legend of their plot.
const NAMED_PARTICLES: usize = 20;

pub(super) fn plots(summary: &Summary, series: &Series) -> String {
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
        match series.particles().is_empty() {
            true => "Temperature of the particles in K".into(),
            false => "Temperature of each particle in K".into(),
        },
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
