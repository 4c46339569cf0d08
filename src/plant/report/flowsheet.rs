//! The flowsheet as a picture.

use std::fmt::Write as _;

use super::super::drawing::Places;
use super::super::files::TimeTable;
use super::super::summary::PlantSummary;
use crate::case::plant::PlantCase;
use crate::report::number::figure;
use crate::report::page::escape;

/// Size of a unit's box, and of the space about it.
const BOX: (f64, f64) = (132.0, 48.0);
const STEP: (f64, f64) = (276.0, 122.0);
/// Distance between streams that flow back, below or above the units.
const LANE: f64 = 30.0;
const MARGIN: f64 = 24.0;

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
        "<figure class=\"wide\"><svg viewBox=\"0 0 {width:.0} {height:.0}\" role=\"img\" aria-label=\"Flowsheet\" \
         style=\"max-width:{width:.0}px;width:100%;font-size:11px\">\
         <defs><marker id=\"head\" viewBox=\"0 0 8 8\" refX=\"7\" refY=\"4\" markerWidth=\"9\" markerHeight=\"9\" \
         markerUnits=\"userSpaceOnUse\" orient=\"auto\"><path d=\"M0 0 L8 4 L0 8 z\" fill=\"var(--line1)\"/></marker></defs>"
    );
    let mut labels = String::new();
    let mut lane = 0;
    for (stream, name) in plant.streams().iter().enumerate() {
        let (from, to) = plant.ends_of(stream);
        let share = |ports: usize, place: usize| (place as f64 + 1.0) / (ports as f64 + 1.0);
        let leaving = plant.units()[from].leaving();
        let out = share(leaving.len(), stream - leaving.start);
        let entering = plant.units()[to].entering();
        let own = entering.iter().position(|own| *own == stream);
        let into = share(entering.len(), own.unwrap_or(0));
        let ((x0, y0), (x1, y1)) = (corner(from), corner(to));
        let (x0, y0) = (x0 + BOX.0, y0 + out * BOX.1);
        let (x1, y1) = (x1, y1 + into * BOX.1);
        let (path, at) = if places.back[stream] {
            lane += 1;
            let y = units + 24.0 + LANE * f64::from(lane);
            let right = x0 + 14.0 + 6.0 * f64::from(lane);
            let left = x1 - 14.0 - 6.0 * f64::from(lane);
            (
                format!("M{x0:.1} {y0:.1} H{right:.1} V{y:.1} H{left:.1} V{y1:.1} H{x1:.1}"),
                (0.5 * (left + right), y - 5.0),
            )
        } else {
            let bend = 0.5 * (x1 - x0).min(STEP.0 - BOX.0);
            (
                format!(
                    "M{x0:.1} {y0:.1} C{:.1} {y0:.1} {:.1} {y1:.1} {x1:.1} {y1:.1}",
                    x0 + bend,
                    x1 - bend
                ),
                // Where streams of one unit have parted, before those of others come in.
                (x0 + 0.48 * (STEP.0 - BOX.0), y0 + 0.42 * (y1 - y0) - 6.0),
            )
        };
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
        let (x, y) = at;
        let (first, second) = match places.back[stream] {
            true => (y, None),
            false => (y - 11.0, Some(y + 1.0)),
        };
        let halo = "paint-order=\"stroke\" stroke=\"var(--card, #fff)\" stroke-width=\"4\"";
        let text = |y: f64, text: &str| {
            format!(
                "<text x=\"{x:.1}\" y=\"{y:.1}\" text-anchor=\"middle\" fill=\"currentColor\" {halo}>{}</text>",
                escape(text)
            )
        };
        match second {
            Some(second) => {
                labels.push_str(&text(first, name));
                labels.push_str(&text(second, &flow));
            }
            None => labels.push_str(&text(first, &format!("{name}: {flow}"))),
        }
    }
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
    svg.push_str(&labels);
    svg.push_str("</svg></figure>");
    svg
}
