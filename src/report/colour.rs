//! Colours: a scale from cold to hot, and the lines of plots.

use std::fmt::Write as _;

use super::number::figure;

/// Stops of the scale, evenly spaced, as red, green, blue; lightness rises all the way.
pub(crate) const STOPS: [[u8; 3]; 6] = [
    [28, 30, 92],
    [84, 39, 143],
    [163, 52, 130],
    [224, 92, 84],
    [247, 155, 60],
    [252, 230, 140],
];

/// The colour of a share between 0 (cold) and 1 (hot), as `#rrggbb`.
pub(crate) fn scale(share: f64) -> String {
    let place = share.clamp(0.0, 1.0) * (STOPS.len() - 1) as f64;
    let lower = (place.floor() as usize).min(STOPS.len() - 2);
    let part = place - lower as f64;
    let mut text = String::from("#");
    for (&low, &high) in STOPS[lower].iter().zip(&STOPS[lower + 1]) {
        let (low, high) = (f64::from(low), f64::from(high));
        let value = (low + part * (high - low)).round() as u8;
        // Writing to a String cannot fail.
        let _ = write!(text, "{value:02x}");
    }
    text
}

/// The colour of a line among few; the page defines these for light and dark.
pub(crate) fn line(number: usize) -> String {
    format!("var(--line{})", number % 6 + 1)
}

/// A range of values that the scale spans.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Range {
    /// The coldest value.
    pub low: f64,
    /// The hottest value.
    pub high: f64,
}

impl Range {
    /// The range of all finite values; `None` where there are none.
    pub fn of(values: impl Iterator<Item = f64>) -> Option<Self> {
        let start = (f64::INFINITY, f64::NEG_INFINITY);
        let (low, high) = values
            .filter(|value| value.is_finite())
            .fold(start, |(low, high), value| {
                (low.min(value), high.max(value))
            });
        (low <= high).then_some(Self { low, high })
    }

    /// The range of both.
    pub fn with(self, other: Self) -> Self {
        Self {
            low: self.low.min(other.low),
            high: self.high.max(other.high),
        }
    }

    /// The colour of a value.
    pub fn colour(&self, value: f64) -> String {
        let span = self.high - self.low;
        scale(if span > 0.0 {
            (value - self.low) / span
        } else {
            0.5
        })
    }

    /// An upright colour bar of a height in px with its values, at (x, y); its name is unique on the page.
    pub fn bar(&self, name: &str, x: f64, y: f64, height: f64, label: &str) -> String {
        let mut svg =
            format!("<g><defs><linearGradient id=\"{name}\" x1=\"0\" y1=\"1\" x2=\"0\" y2=\"0\">");
        for step in 0..=10 {
            let share = f64::from(step) / 10.0;
            let _ = write!(
                svg,
                "<stop offset=\"{share}\" stop-color=\"{}\"/>",
                scale(share)
            );
        }
        let _ = write!(
            svg,
            "</linearGradient></defs><rect x=\"{x}\" y=\"{y}\" width=\"14\" height=\"{height}\" \
             rx=\"2\" fill=\"url(#{name})\"/>"
        );
        for step in 0..=4 {
            let share = f64::from(step) / 4.0;
            let at = y + height * (1.0 - share);
            let value = figure(self.low + share * (self.high - self.low), 4);
            let _ = write!(
                svg,
                "<line class=\"tick\" x1=\"{}\" x2=\"{}\" y1=\"{at}\" y2=\"{at}\"/>\
                 <text x=\"{}\" y=\"{}\">{value}</text>",
                x + 14.0,
                x + 18.0,
                x + 22.0,
                at + 4.0
            );
        }
        let _ = write!(
            svg,
            "<text class=\"label\" x=\"{x}\" y=\"{}\">{label}</text></g>",
            y - 16.0
        );
        svg
    }
}
