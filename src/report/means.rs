//! Means of fields over time, and how far these fluctuate about them, in the cut of the picture of bed and gas.

use std::fmt::Write as _;
use std::path::Path;

use super::bed_columns::{BedColumn, columns};
use super::cells::cells;
use super::colour::Range;
use super::page::escape;
use super::section::{self, Polygon, Spot};
use crate::results::{ResultsError, read};

/// Pictures at most.
const PICTURES: usize = 12;
/// Polygons of all pictures together at most.
const SHAPES: usize = 12_000;
const HEIGHT: f64 = 240.0;
const WIDEST: f64 = 230.0;
/// Room for the scale and its numbers at the right, and above.
const BAR: f64 = 128.0;
const TOP: f64 = 12.0;
const TALLEST_BAR: f64 = 160.0;

/// A picture of each mean and root mean square; empty where the run has none.
pub(super) fn render(directory: &Path) -> Result<String, ResultsError> {
    let Some(means) = read::means(directory)? else {
        return Ok(String::new());
    };
    let polygons = section::polygons(&means.arrays, section::plane(&means.arrays));
    let count = cells(&means.arrays).len();
    let Some((low, high)) = section::extent(&polygons) else {
        return Ok(String::new());
    };
    let room = (SHAPES / polygons.len()).clamp(1, PICTURES);
    let mut shown = columns(&means.arrays, count, &means.units);
    // What does not fluctuate in the cut has no picture, and means come first.
    shown.retain(|column| {
        !column.name.ends_with("_rms")
            || of_cut(column, &polygons).is_some_and(|range| range.high > 0.0)
    });
    shown.sort_by_key(|column| column.name.ends_with("_rms"));
    let pictures = shown.iter().take(room).enumerate();
    let html: String = pictures
        .map(|(number, column)| draw(number, column, &polygons, low, high))
        .collect();
    Ok(match html.is_empty() {
        true => html,
        false => format!("<div class=\"plots\">{html}</div>"),
    })
}

/// The range of a column's values in the cut.
fn of_cut(column: &BedColumn, polygons: &[Polygon]) -> Option<Range> {
    Range::of(polygons.iter().map(|one| column.values[one.cell]))
}

fn draw(number: usize, column: &BedColumn, polygons: &[Polygon], low: Spot, high: Spot) -> String {
    let scale = (HEIGHT / (high[1] - low[1])).min(WIDEST / (high[0] - low[0]));
    let [wide, tall] = [0, 1].map(|axis| scale * (high[axis] - low[axis]));
    let bar = tall.clamp(60.0, TALLEST_BAR);
    let (width, height) = (wide + BAR, tall.max(bar) + TOP + 12.0);
    let range = of_cut(column, polygons);
    let mut svg = format!(
        "<figure class=\"picture\"><figcaption>{0}</figcaption><svg viewBox=\"0 0 {width:.0} {height:.0}\" width=\"{width:.0}\" \
         role=\"img\" aria-label=\"{0}\">",
        escape(&column.label)
    );
    for polygon in polygons {
        let value = column.values[polygon.cell];
        let fill = match range {
            Some(range) if value.is_finite() => range.colour(value),
            _ => "var(--rule)".into(),
        };
        svg.push_str("<polygon points=\"");
        for [x, z] in &polygon.corners {
            // Writing to a String cannot fail.
            let _ = write!(
                svg,
                "{:.1},{:.1} ",
                (x - low[0]) * scale,
                TOP + (high[1] - z) * scale
            );
        }
        let _ = write!(
            svg,
            "\" fill=\"{fill}\" stroke=\"{fill}\" stroke-width=\".6\"/>"
        );
    }
    if let Some(range) = range {
        svg.push_str(&range.bar(&format!("mean{number}"), wide + 18.0, TOP, bar, ""));
    }
    svg.push_str("</svg></figure>");
    svg
}
