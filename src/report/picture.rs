//! The picture of bed and gas: a side view at several times, one colour scale for all.

use std::fmt::Write as _;
use std::path::Path;

use super::colour::Range;
use super::number::span;
use super::section::{self, Circle, Polygon, Spot};
use super::shade::Shade;
use crate::results::ResultsError;
use crate::results::read::{self, Arrays};

const HEIGHT: f64 = 460.0;
const WIDEST: f64 = 1050.0;
const BAR: f64 = 128.0;
/// Room above for the label of the colour bar.
const TOP: f64 = 36.0;

/// Polygons and circles of all views together at most, where two views have not more.
const SHAPES: usize = 8000;

/// The picture, and the colours that it shares with what else shows the bed.
#[derive(Default)]
pub(super) struct BedPicture {
    /// As HTML; empty where there are no snapshots.
    pub html: String,
    /// What colours it.
    pub shade: Option<Shade>,
    /// Ends of the scale.
    pub range: Option<Range>,
}

/// One snapshot, cut.
struct View {
    time: f64,
    gas: Arrays,
    particles: Arrays,
    polygons: Vec<Polygon>,
    circles: Vec<Circle>,
}

/// Side views at the start, the end and times between; `wider` gives what else the scale has to span.
pub(super) fn render(
    directory: &Path,
    wider: impl Fn(Shade) -> Option<Range>,
) -> Result<BedPicture, ResultsError> {
    let gas = read::collection(directory, "gas.pvd")?;
    let particles = read::collection(directory, "particles.pvd")?;
    let count = gas.len().min(particles.len());
    let Some((_, first)) = gas.first() else {
        return Ok(BedPicture::default());
    };
    let outline = read::arrays(first)?;
    let plane = section::plane(&outline);
    let Some((low, high)) = section::extent(&section::polygons(&outline, plane)) else {
        return Ok(BedPicture::default());
    };
    let view = |number: usize| {
        let (time, gas_file) = &gas[number];
        let gas = read::arrays(gas_file)?;
        let bed = read::arrays(&particles[number].1)?;
        Ok(View {
            time: *time,
            polygons: section::polygons(&gas, plane),
            circles: section::circles(&bed, plane),
            gas,
            particles: bed,
        })
    };
    let Some(last) = count.checked_sub(1).map(view).transpose()? else {
        return Ok(BedPicture::default());
    };
    let aspect = (high[0] - low[0]) / (high[1] - low[1]);
    let room = SHAPES / (last.polygons.len() + last.circles.len()).max(1);
    let shown = frames(aspect).min(room.max(2)).min(count);
    let mut views = (0..shown - 1)
        .map(|frame| view(frame * (count - 1) / (shown - 1)))
        .collect::<Result<Vec<_>, ResultsError>>()?;
    views.push(last);
    let shade = Shade::of(views.iter().map(|view| (&view.gas, &view.particles)));
    let values = views.iter().flat_map(|view| {
        let gas = shade.gas(&view.gas).iter().copied();
        gas.chain(shade.particles(&view.particles))
    });
    let both = |range: Range| wider(shade).map_or(range, |other| range.with(other));
    let range = Range::of(values).map(both);
    Ok(BedPicture {
        html: draw(&views, low, high, shade, range),
        shade: Some(shade),
        range,
    })
}

/// How many views fit side by side: narrow columns leave room for six.
fn frames(aspect: f64) -> usize {
    match aspect {
        a if a < 0.3 => 6,
        a if a < 0.6 => 4,
        a if a < 1.2 => 3,
        _ => 2,
    }
}

fn draw(views: &[View], low: Spot, high: Spot, shade: Shade, range: Option<Range>) -> String {
    let (wide, tall) = (high[0] - low[0], high[1] - low[1]);
    let gap = 34.0;
    let room = (WIDEST - BAR) / views.len() as f64 - gap;
    let scale = (HEIGHT / tall).min(room / wide);
    let (wide, tall) = (wide * scale, tall * scale);
    let column = wide.max(64.0) + gap;
    let (width, height) = (column * views.len() as f64 + BAR, tall + 72.0);
    let mut svg = format!(
        "<figure class=\"picture\"><svg viewBox=\"0 0 {width:.0} {height:.0}\" width=\"{width:.0}\" \
         role=\"img\" aria-label=\"Side views of bed and gas\">"
    );
    for (number, view) in views.iter().enumerate() {
        let left = column * number as f64 + (column - wide) / 2.0;
        let spot = |at: Spot| {
            [
                left + (at[0] - low[0]) * scale,
                TOP + (high[1] - at[1]) * scale,
            ]
        };
        let colour = |values: &[f64], place: usize| match (range, values.get(place)) {
            (Some(range), Some(&value)) => range.colour(value),
            _ => "var(--rule)".into(),
        };
        for polygon in &view.polygons {
            let fill = colour(shade.gas(&view.gas), polygon.cell);
            svg.push_str("<polygon points=\"");
            for corner in &polygon.corners {
                let [x, y] = spot(*corner);
                // Writing to a String cannot fail.
                let _ = write!(svg, "{x:.1},{y:.1} ");
            }
            let _ = write!(
                svg,
                "\" fill=\"{fill}\" stroke=\"{fill}\" stroke-width=\".6\"/>"
            );
        }
        let values = shade.particles(&view.particles);
        for circle in &view.circles {
            let [x, y] = spot(circle.centre);
            let _ = write!(
                svg,
                "<circle class=\"sphere\" cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"{:.2}\" fill=\"{}\"/>",
                circle.radius * scale,
                colour(&values, circle.particle)
            );
        }
        let _ = write!(
            svg,
            "<rect class=\"hull\" x=\"{left:.1}\" y=\"{TOP}\" width=\"{wide:.1}\" height=\"{tall:.1}\"/>\
             <text class=\"label\" text-anchor=\"middle\" x=\"{:.1}\" y=\"{:.1}\">{}</text>",
            left + wide / 2.0,
            tall + TOP + 24.0,
            span(view.time)
        );
    }
    if let Some(range) = range {
        let bar = tall.min(320.0);
        svg.push_str(&range.bar(
            "scale",
            width - BAR + 26.0,
            TOP + (tall - bar) / 2.0,
            bar,
            shade.label(),
        ));
    }
    svg.push_str("</svg></figure>");
    if let Some(view) = views.first() {
        svg.push_str(section::legend(&view.particles));
    }
    svg
}
