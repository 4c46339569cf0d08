//! The flowsheet as a picture.

use std::fmt::Write as _;

use super::super::drawing::Places;
use super::super::files::TimeTable;
use super::super::summary::PlantSummary;
use super::labels::{Labelled, Rectangle, placed};
use crate::case::plant::PlantCase;
use crate::report::number::figure;
use crate::report::page::escape;

/// Size of a unit's box, and distance from one to the next: a flow and a size of three digits each fit between.
const BOX: (f64, f64) = (116.0, 46.0);
const STEP: (f64, f64) = (280.0, 122.0);
/// Distance between streams that flow back, below the units.
const LANE: f64 = 30.0;
const MARGIN: f64 = 30.0;
/// Share of its size at which a wide picture is scrolled rather than shrunk.
const SMALLEST: f64 = 0.7;
/// Points of a curve.
const POINTS: u32 = 40;

/// The path of a stream, points along it where its label may stand, and along the rest.
struct Drawn {
    path: String,
    line: Vec<(f64, f64)>,
    rest: Vec<(f64, f64)>,
}

/// A stream that flows on, as a cubic curve that is level at both ends.
fn curve((x0, y0): (f64, f64), (x1, y1): (f64, f64)) -> Drawn {
    let bend = 0.5 * (x1 - x0).min(STEP.0 - BOX.0);
    let at = |k: u32| {
        let t = f64::from(k) / f64::from(POINTS);
        let u = 1.0 - t;
        let mix = |a: f64, b: f64, c: f64, d: f64| {
            u * u * u * a + 3.0 * u * u * t * b + 3.0 * u * t * t * c + t * t * t * d
        };
        (mix(x0, x0 + bend, x1 - bend, x1), mix(y0, y0, y1, y1))
    };
    Drawn {
        path: format!(
            "M{x0:.1} {y0:.1} C{:.1} {y0:.1} {:.1} {y1:.1} {x1:.1} {y1:.1}",
            x0 + bend,
            x1 - bend
        ),
        line: (0..=POINTS).map(at).collect(),
        rest: Vec::new(),
    }
}

/// A stream that flows back, below the units.
fn way_back((x0, y0): (f64, f64), (x1, y1): (f64, f64), y: f64, lane: f64) -> Drawn {
    let (right, left) = (x0 + 14.0 + 6.0 * lane, x1 - 14.0 - 6.0 * lane);
    let at = |k: u32| (right + f64::from(k) / f64::from(POINTS) * (left - right), y);
    let upright = |x: f64, from: f64| {
        (0..=POINTS).map(move |k| (x, from + f64::from(k) / f64::from(POINTS) * (y - from)))
    };
    Drawn {
        rest: upright(right, y0).chain(upright(left, y1)).collect(),
        path: format!("M{x0:.1} {y0:.1} H{right:.1} V{y:.1} H{left:.1} V{y1:.1} H{x1:.1}"),
        line: (0..=POINTS).map(at).collect(),
    }
}

/// Where the streams of a unit stand at its side, as shares of its height: by the rows of what is at their other ends, those that flow
/// back below all others.
fn shares(streams: &[usize], row: impl Fn(usize) -> usize, places: &Places) -> Vec<(usize, f64)> {
    let mut order = streams.to_vec();
    order.sort_by_key(|stream| (places.back[*stream], row(*stream)));
    let count = order.len() as f64 + 1.0;
    let order = order.into_iter().enumerate();
    order
        .map(|(place, stream)| (stream, (place as f64 + 1.0) / count))
        .collect()
}

/// Units as boxes in columns; streams from left to right, those that flow back below the units.
pub(super) fn draw(case: &PlantCase, series: &TimeTable, summary: &PlantSummary) -> String {
    let plant = &case.plant;
    let places = Places::of(plant);
    let lanes = places.back.iter().filter(|back| **back).count();
    let width = 2.0 * MARGIN + (places.size.0 as f64 - 1.0) * STEP.0 + BOX.0;
    let units = MARGIN + (places.size.1 as f64 - 1.0) * STEP.1 + BOX.1;
    let height = units + 40.0 + LANE * lanes as f64 + MARGIN;
    let last = |name: &str, field: &str| {
        let values = series.column(&format!("streams.{name}.{field}"));
        values.last().copied().unwrap_or(f64::NAN)
    };
    let flows = plant.streams().iter().map(|name| last(name, "mass_flow"));
    let flows: Vec<f64> = flows.collect();
    let most = flows.iter().copied().fold(0.0, f64::max);
    let corner = |unit: usize| {
        let (column, row) = places.at[unit];
        (
            MARGIN + column as f64 * STEP.0,
            MARGIN + row as f64 * STEP.1,
        )
    };
    let mut svg = format!(
        "<figure class=\"wide\" style=\"overflow-x:auto\"><svg viewBox=\"0 0 {width:.0} {height:.0}\" role=\"img\" aria-label=\"Flowsheet\" \
         style=\"max-width:{width:.0}px;min-width:{:.0}px;width:100%;font-size:11px\">\
         <defs><marker id=\"head\" viewBox=\"0 0 8 8\" refX=\"7\" refY=\"4\" markerWidth=\"9\" markerHeight=\"9\" \
         markerUnits=\"userSpaceOnUse\" orient=\"auto\"><path d=\"M0 0 L8 4 L0 8 z\" fill=\"var(--line1)\"/></marker></defs>",
        SMALLEST * width
    );
    let (count, ends) = (flows.len(), |stream: usize| plant.ends_of(stream));
    let (mut out, mut into) = (vec![0.5; count], vec![0.5; count]);
    for unit in plant.units() {
        let leaving: Vec<usize> = unit.leaving().collect();
        for (stream, share) in shares(&leaving, |own| places.at[ends(own).1].1, &places) {
            out[stream] = share;
        }
        for (stream, share) in shares(unit.entering(), |own| places.at[ends(own).0].1, &places) {
            into[stream] = share;
        }
    }
    let mut labels = Vec::new();
    let mut lane = 0.0;
    for (stream, name) in plant.streams().iter().enumerate() {
        let (from, to) = ends(stream);
        let ((x0, y0), (x1, y1)) = (corner(from), corner(to));
        let start = (x0 + BOX.0, y0 + out[stream] * BOX.1);
        let end = (x1, y1 + into[stream] * BOX.1);
        let drawn = match places.back[stream] {
            true => {
                lane += 1.0;
                way_back(start, end, units + 24.0 + LANE * lane, lane)
            }
            false => curve(start, end),
        };
        let path = drawn.path;
        let thickness = match most > 0.0 {
            true => 1.0 + 4.0 * (flows[stream] / most).max(0.0).sqrt(),
            false => 1.0,
        };
        let dash = match summary.tears.contains(name) {
            true => " stroke-dasharray=\"7 4\"",
            false => "",
        };
        let _ = write!(
            svg,
            "<path d=\"{path}\" fill=\"none\" stroke=\"var(--line1)\" stroke-opacity=\"0.75\" stroke-width=\"{thickness:.2}\"{dash} marker-end=\"url(#head)\"/>"
        );
        let d50 = last(name, "d50");
        let sizes = match d50.is_finite() {
            true => format!(", {} mm", figure(1e3 * d50, 3)),
            false => String::new(),
        };
        let flow = format!("{} kg/s{sizes}", figure(flows[stream], 3));
        labels.push(Labelled {
            line: drawn.line,
            rest: drawn.rest,
            text: match places.back[stream] {
                true => vec![format!("{name}: {flow}")],
                false => vec![name.clone(), flow],
            },
        });
    }
    let boxes: Vec<Rectangle> = (0..plant.units().len())
        .map(corner)
        .map(|(x, y)| [x - 6.0, y - 3.0, x + BOX.0 + 6.0, y + BOX.1 + 3.0])
        .collect();
    for (unit, own) in plant.units().iter().enumerate() {
        let (x, y) = corner(unit);
        let (middle, centre) = (x + 0.5 * BOX.0, y + 0.5 * BOX.1);
        let _ = write!(
            svg,
            "<rect x=\"{x:.1}\" y=\"{y:.1}\" width=\"{}\" height=\"{}\" rx=\"7\" fill=\"var(--card, #fff)\" stroke=\"currentColor\" stroke-width=\"1.3\"/>\
             <text x=\"{middle:.1}\" y=\"{:.1}\" text-anchor=\"middle\" font-weight=\"600\" fill=\"currentColor\">{}</text>\
             <text x=\"{middle:.1}\" y=\"{:.1}\" text-anchor=\"middle\" fill=\"currentColor\" opacity=\"0.7\">{}</text>",
            BOX.0,
            BOX.1,
            centre - 3.0,
            escape(&own.name),
            centre + 13.0,
            case.kinds[unit]
        );
    }
    for (label, [left, top, right, _]) in labels.iter().zip(placed(&labels, &boxes)) {
        for (row, text) in labels_of(label) {
            let _ = write!(
                svg,
                "<text x=\"{:.1}\" y=\"{:.1}\" text-anchor=\"middle\" fill=\"currentColor\" paint-order=\"stroke\" \
                 stroke=\"var(--card, #fff)\" stroke-width=\"3\">{}</text>",
                0.5 * (left + right),
                top + 10.0 + 12.0 * row,
                escape(text)
            );
        }
    }
    svg.push_str("</svg></figure>");
    svg
}

fn labels_of(label: &Labelled) -> impl Iterator<Item = (f64, &String)> {
    (0u32..).map(f64::from).zip(&label.text)
}
