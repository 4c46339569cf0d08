//! Plots of the void fraction of the bed at the end.

use std::path::Path;

use super::colour;
use super::plot::{Curve, Plot, Stroke};
use crate::results::ResultsError;
use crate::results::voids::{VoidProfile, VoidProfiles};

/// Both profiles; empty where the results have none.
pub(super) fn render(directory: &Path) -> Result<String, ResultsError> {
    let Some(voids) = VoidProfiles::read(directory)? else {
        return Ok(String::new());
    };
    let plots = [
        ("over the height", "height in m", &voids.height),
        (
            "from the wall inwards",
            "distance from the wall in m",
            &voids.wall,
        ),
    ];
    let plots: String = plots
        .into_iter()
        .map(|(what, x_label, profile)| plot(what, x_label, profile))
        .collect();
    if plots.is_empty() {
        return Ok(plots);
    }
    Ok(format!("<div class=\"plots\">{plots}</div>"))
}

fn plot(what: &str, x_label: &str, profile: &VoidProfile) -> String {
    let curve = Curve {
        label: String::new(),
        colour: colour::line(0),
        x: &profile.place,
        y: &profile.void_fraction,
        stroke: Stroke::Solid,
    };
    let plot = Plot {
        title: format!("Void fraction {what}"),
        x_label,
        logarithmic: false,
        above: None,
        band: None,
        curves: vec![curve],
    };
    plot.render()
}
