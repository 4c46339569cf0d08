//! Line plots as SVG.

use std::fmt::Write as _;

use super::colour::Range;
use super::number::figure;
use super::page::escape;
use super::ticks::{decades, digits, padded, ticks};

/// Points of a curve at most; more would not be seen.
const POINTS: usize = 600;
const WIDTH: f64 = 560.0;
const HEIGHT: f64 = 300.0;
const LEFT: f64 = 66.0;
const RIGHT: f64 = 14.0;
const TOP: f64 = 34.0;
const BOTTOM: f64 = 44.0;
/// Label of every time axis.
pub(crate) const TIME: &str = "process time in s";

/// One line of a plot.
pub(crate) struct Curve<'a> {
    /// Its name in the legend; empty: not in the legend.
    pub label: String,
    /// CSS colour.
    pub colour: String,
    /// Values along x.
    pub x: &'a [f64],
    /// Values along y.
    pub y: &'a [f64],
    /// How it is drawn.
    pub stroke: Stroke,
}

/// How a line is drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Stroke {
    /// In one piece.
    Solid,
    /// Broken, as the first of so many lines: where they cover each other, each shows in turn.
    Share(usize, usize),
    /// As points.
    Points,
}

impl Stroke {
    fn attributes(self) -> String {
        match self {
            Stroke::Solid => String::new(),
            Stroke::Points => {
                " style=\"stroke-width:4;stroke-linecap:round;stroke-opacity:0.55\"".into()
            }
            Stroke::Share(place, count) => format!(
                " stroke-dasharray=\"8 {}\" stroke-dashoffset=\"-{}\"",
                8 * (count.max(2) - 1),
                8 * place
            ),
        }
    }
}

/// A plot over time.
pub(crate) struct Plot<'a> {
    /// What is shown, with the unit.
    pub title: String,
    /// Label of the axis of x.
    pub x_label: &'a str,
    /// True: powers of ten along y.
    pub logarithmic: bool,
    /// A second scale above: label, and its values at the x of `over`.
    pub above: Option<(&'a str, &'a [f64], &'a [f64])>,
    /// What is expected.
    pub band: Option<ExpectedBand>,
    /// The lines.
    pub curves: Vec<Curve<'a>>,
}

/// Values of y that are expected at one x.
#[derive(Clone, Debug)]
pub(crate) struct ExpectedBand {
    /// Smallest and largest value.
    pub range: (f64, f64),
    /// The x at which they are expected; `None`: at the end of the curves.
    pub at: Option<f64>,
    /// What is expected, for the legend.
    pub label: String,
}

/// Between the labels of y and the axis.
const GAP: f64 = 8.0;
/// Half the width of the mark of what is expected.
const MARK: f64 = 6.0;

/// Width of a digit of the labels in wide fonts (0.64 em) at the largest size that the style sheet gives them, 13.5.
const LETTER: f64 = 8.6;

/// The middle of a label about a place along x, shifted so that none of its letters is cut off.
fn within_picture(at: f64, label: &str) -> f64 {
    let half = 0.5 * LETTER * label.chars().count() as f64;
    at.min(WIDTH - half).max(half)
}

/// Where values lie on the picture.
struct Frame {
    /// The left end of the axis of x, right of the labels of y.
    left: f64,
    x: Range,
    y: Range,
    logarithmic: bool,
}

impl Frame {
    fn across(&self, x: f64) -> f64 {
        let span = (self.x.high - self.x.low).max(f64::MIN_POSITIVE);
        self.left + (x - self.x.low) / span * (WIDTH - self.left - RIGHT)
    }

    /// Upwards; `y` already as logarithm where the scale is one.
    fn up(&self, y: f64) -> f64 {
        let span = (self.y.high - self.y.low).max(f64::MIN_POSITIVE);
        HEIGHT - BOTTOM - (y - self.y.low) / span * (HEIGHT - TOP - BOTTOM)
    }

    fn value(&self, y: f64) -> f64 {
        if self.logarithmic { y.log10() } else { y }
    }

    /// Ticks along y with their labels.
    fn ups(&self) -> Vec<(f64, String)> {
        let ups = match self.logarithmic {
            true => decades(self.y),
            false => ticks(self.y, 5),
        };
        let steps = ups.windows(2).map(|pair| pair[1] - pair[0]);
        let step = steps.fold(f64::INFINITY, f64::min);
        let label = |y: f64| match self.logarithmic {
            true => figure(10f64.powf(y), 1),
            false => figure(y, digits(self.y, step)),
        };
        ups.into_iter().map(|y| (y, label(y))).collect()
    }
}

impl Plot<'_> {
    /// The plot with its title and legend, as a figure of the page; empty where nothing is finite.
    pub fn render(&self) -> String {
        let Some(frame) = self.frame() else {
            return String::new();
        };
        // Without a scale above, its room is cut off.
        let cut = if self.above.is_some() { 0.0 } else { 24.0 };
        let mut svg = format!(
            "<figure><figcaption>{}</figcaption><svg viewBox=\"0 {cut} {WIDTH} {}\" \
             role=\"img\" aria-label=\"{0}\">",
            escape(&self.title),
            HEIGHT - cut
        );
        self.axes(&frame, &mut svg);
        if let Some(band) = self.shown_band(frame.x) {
            let (low, high) = band.range;
            let at = frame.across(band.at.unwrap_or(frame.x.high));
            let (low, high) = (frame.up(frame.value(low)), frame.up(frame.value(high)));
            let (left, right) = (at - MARK, at + MARK);
            let _ = write!(
                svg,
                "<path class=\"band\" d=\"M{left:.1} {low:.1}H{right:.1}M{at:.1} {low:.1}V{high:.1}M{left:.1} \
                 {high:.1}H{right:.1}\"/>"
            );
        }
        for curve in &self.curves {
            let _ = write!(
                svg,
                "<path class=\"curve\" stroke=\"{}\"{} d=\"{}\"/>",
                curve.colour,
                curve.stroke.attributes(),
                path(curve, &frame)
            );
        }
        svg.push_str("</svg>");
        svg.push_str(&self.legend());
        svg.push_str("</figure>");
        svg
    }

    /// What is expected, where the curves reach to where it is.
    fn shown_band(&self, x: Range) -> Option<&ExpectedBand> {
        let within = |at: f64| (x.low..=x.high).contains(&at);
        let band = self.band.as_ref();
        band.filter(|band| band.at.is_none_or(within))
    }

    fn frame(&self) -> Option<Frame> {
        let x = Range::of(self.curves.iter().flat_map(|curve| curve.x.iter().copied()))?;
        let expected = self.shown_band(x).map(|band| [band.range.0, band.range.1]);
        let values = self.curves.iter().flat_map(|curve| curve.y.iter().copied());
        let values = values.chain(expected.into_iter().flatten());
        let y = if self.logarithmic {
            let range = Range::of(values.filter(|&y| y > 0.0).map(f64::log10))?;
            Range {
                low: range.low.floor(),
                high: range.high.ceil().max(range.low.floor() + 1.0),
            }
        } else {
            padded(Range::of(values)?)
        };
        let mut frame = Frame {
            left: LEFT,
            x,
            y,
            logarithmic: self.logarithmic,
        };
        let letters = frame.ups().into_iter();
        let letters = letters.map(|(_, label)| label.chars().count()).max();
        frame.left = LEFT.max(LETTER * letters.unwrap_or(0) as f64 + GAP);
        Some(frame)
    }

    fn axes(&self, frame: &Frame, svg: &mut String) {
        let (left, right, floor) = (frame.left, WIDTH - RIGHT, HEIGHT - BOTTOM);
        for (y, text) in frame.ups() {
            let at = frame.up(y);
            let _ = write!(
                svg,
                "<line class=\"grid\" x1=\"{left}\" x2=\"{right}\" y1=\"{at:.1}\" y2=\"{at:.1}\"/>\
                 <text text-anchor=\"end\" x=\"{}\" y=\"{:.1}\">{text}</text>",
                left - GAP,
                at + 4.0
            );
        }
        for x in ticks(frame.x, 6) {
            let at = frame.across(x);
            let text = figure(x, 5);
            let _ = write!(
                svg,
                "<line class=\"tick\" x1=\"{at:.1}\" x2=\"{at:.1}\" y1=\"{floor}\" y2=\"{}\"/>\
                 <text text-anchor=\"middle\" x=\"{:.1}\" y=\"{}\">{text}</text>",
                floor + 5.0,
                within_picture(at, &text),
                floor + 19.0
            );
            if let Some((_, over, values)) = self.above {
                let text = figure(between(over, values, x), 4);
                let _ = write!(
                    svg,
                    "<line class=\"tick\" x1=\"{at:.1}\" x2=\"{at:.1}\" y1=\"{TOP}\" y2=\"{}\"/>\
                     <text class=\"faint\" text-anchor=\"middle\" x=\"{:.1}\" y=\"{}\">{text}</text>",
                    TOP - 4.0,
                    within_picture(at, &text),
                    TOP - 8.0
                );
            }
        }
        let _ = write!(
            svg,
            "<line class=\"axis\" x1=\"{left}\" x2=\"{right}\" y1=\"{floor}\" y2=\"{floor}\"/>\
             <text class=\"label\" text-anchor=\"middle\" x=\"{}\" y=\"{}\">{}</text>",
            (left + right) / 2.0,
            HEIGHT - 8.0,
            escape(self.x_label)
        );
        if let Some((label, _, _)) = self.above {
            let _ = write!(
                svg,
                "<line class=\"axis thin\" x1=\"{left}\" x2=\"{right}\" y1=\"{TOP}\" y2=\"{TOP}\"/>\
                 <text class=\"faint\" x=\"0\" y=\"{}\">{}</text>",
                TOP - 22.0,
                escape(label)
            );
        }
    }

    fn legend(&self) -> String {
        let named = self.curves.iter().filter(|curve| !curve.label.is_empty());
        let mut chips: String = named
            .map(|curve| {
                format!(
                    "<span><i style=\"background:{}\"></i>{}</span>",
                    curve.colour,
                    escape(&curve.label)
                )
            })
            .collect();
        let frame = self.frame();
        if let Some(band) = frame.as_ref().and_then(|frame| self.shown_band(frame.x)) {
            let _ = write!(
                chips,
                "<span><i class=\"expected\"></i>{}</span>",
                escape(&band.label)
            );
        }
        if chips.is_empty() {
            chips
        } else {
            format!("<div class=\"legend\">{chips}</div>")
        }
    }
}

fn path(curve: &Curve<'_>, frame: &Frame) -> String {
    let count = curve.x.len().min(curve.y.len());
    let stride = count.div_ceil(POINTS).max(1);
    let mut places: Vec<usize> = (0..count).step_by(stride).collect();
    if count > 0 && !(count - 1).is_multiple_of(stride) {
        places.push(count - 1);
    }
    let (mut text, mut pen_down) = (String::new(), false);
    for place in places {
        let (x, y) = (curve.x[place], frame.value(curve.y[place]));
        if !y.is_finite() {
            pen_down = false;
            continue;
        }
        if curve.stroke == Stroke::Points {
            let _ = write!(text, "M{:.1} {:.1}h0", frame.across(x), frame.up(y));
            continue;
        }
        let verb = if pen_down { 'L' } else { 'M' };
        let _ = write!(text, "{verb}{:.1} {:.1}", frame.across(x), frame.up(y));
        pen_down = true;
    }
    text
}

/// The value at `x` of a line through points with ascending `over`.
pub(crate) fn between(over: &[f64], values: &[f64], x: f64) -> f64 {
    let count = over.len().min(values.len());
    let next = over[..count].partition_point(|&at| at < x);
    if next < count && over[next] == x {
        return values[next];
    }
    if next == 0 || next == count {
        let edge = if next == 0 {
            values.first()
        } else {
            values[..count].last()
        };
        return edge.copied().unwrap_or(f64::NAN);
    }
    let share = (x - over[next - 1]) / (over[next] - over[next - 1]);
    values[next - 1] + share * (values[next] - values[next - 1])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_value_between_two_points_lies_on_the_line() {
        assert_eq!(between(&[0.0, 2.0], &[10.0, 20.0], 1.0), 15.0);
        assert_eq!(between(&[0.0, 2.0], &[10.0, 20.0], 2.0), 20.0);
        assert_eq!(between(&[0.0, 2.0], &[10.0, 20.0], 9.0), 20.0);
        assert!(between(&[], &[], 1.0).is_nan());
    }

    #[test]
    fn what_is_expected_is_marked_where_it_holds_and_nowhere_else() {
        let render = |at: Option<f64>| {
            let plot = Plot {
                title: "outlet".into(),
                x_label: TIME,
                logarithmic: false,
                above: None,
                band: Some(ExpectedBand {
                    range: (10.0, 12.0),
                    at,
                    label: "expected: 10 to 12 K".into(),
                }),
                curves: vec![Curve {
                    label: String::new(),
                    colour: "red".into(),
                    x: &[0.0, 100.0],
                    y: &[0.0, 5.0],
                    stroke: Stroke::Solid,
                }],
            };
            plot.render()
        };
        let middle = LEFT + 0.5 * (WIDTH - LEFT - RIGHT);
        assert!(render(Some(50.0)).contains(&format!("M{middle:.1} ")));
        // The end of the curve, where the case states no time.
        assert!(render(None).contains(&format!("M{:.1} ", WIDTH - RIGHT)));
        // A run that ended before.
        assert!(!render(Some(200.0)).contains("expected"));
    }

    #[test]
    fn no_label_is_cut_off_at_an_edge_of_the_picture() {
        let (x, y) = ([0.0, 3e5], [101_325.123, 101_325.125]);
        let plot = Plot {
            title: "pressure".into(),
            x_label: TIME,
            logarithmic: false,
            above: Some(("motion time in s", &x, &[0.0, 1.187_333])),
            band: None,
            curves: vec![Curve {
                label: String::new(),
                colour: "red".into(),
                x: &x,
                y: &y,
                stroke: Stroke::Solid,
            }],
        };
        let svg = plot.render();
        let mut labels = 0;
        for part in svg.split("<text ").skip(1) {
            let (head, rest) = part.split_once('>').unwrap();
            let text = rest.split('<').next().unwrap();
            let width = LETTER * text.chars().count() as f64;
            let at = head.split(" x=\"").nth(1).or(head.strip_prefix("x=\""));
            let at: f64 = at.unwrap().split('"').next().unwrap().parse().unwrap();
            let left = match head {
                _ if head.contains("middle") => at - 0.5 * width,
                _ if head.contains("end") => at - width,
                _ => at,
            };
            assert!(
                left >= -0.1 && left + width <= WIDTH + 0.1,
                "{text}: {left}"
            );
            labels += 1;
        }
        assert!(labels > 10, "{labels}");
    }

    #[test]
    fn a_curve_without_finite_values_leaves_no_plot() {
        let plot = Plot {
            title: "nothing".into(),
            x_label: "x",
            logarithmic: false,
            above: None,
            band: None,
            curves: vec![Curve {
                label: String::new(),
                colour: "red".into(),
                x: &[0.0, 1.0],
                y: &[f64::NAN, f64::NAN],
                stroke: Stroke::Solid,
            }],
        };
        assert_eq!(plot.render(), "");
    }
}
