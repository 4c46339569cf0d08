//! The film of a bed that moves: its cut at many times, one after the other in the same place, and the colours
//! that it shares with the side views.

use std::fmt::Write as _;
use std::path::Path;

use super::colour::Range;
use super::number::span;
use super::section::{self, Circle, Spot};
use crate::results::ResultsError;
use crate::results::read::{self, Array, Arrays};

const HEIGHT: f64 = 420.0;
const WIDEST: f64 = 760.0;
const BAR: f64 = 110.0;
/// Room above for the label of the colour bar.
const TOP: f64 = 26.0;
/// Circles of all frames together at most; a page stays within some 2 MB.
const CIRCLES: usize = 24_000;
/// Frames at most, and how long the film takes, in s.
const FRAMES: usize = 72;
const LENGTH: f64 = 6.0;

/// What colours particles.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Shade {
    /// Their temperature, with that of the gas.
    Temperature,
    /// Their speed, where all have one temperature and the snapshots hold velocities.
    Speed,
}

impl Shade {
    /// That of snapshots: the temperature, unless it is the same everywhere.
    pub fn of<'a>(all: impl Iterator<Item = (&'a Arrays, &'a Arrays)>) -> Self {
        let mut speeds = false;
        let mut values = Vec::new();
        for (gas, particles) in all {
            speeds |= particles.contains_key("velocity");
            for arrays in [gas, particles] {
                let range = Range::of(temperature(arrays).iter().copied());
                values.extend(range.into_iter().flat_map(|range| [range.low, range.high]));
            }
        }
        // Half a thousandth of a kelvin is what the gas solver's tolerance leaves.
        match Range::of(values.into_iter()) {
            Some(range) if range.high - range.low >= 5e-4 => Self::Temperature,
            _ if speeds => Self::Speed,
            _ => Self::Temperature,
        }
    }

    /// Values of particles.
    pub fn particles(self, arrays: &Arrays) -> Vec<f64> {
        match self {
            Self::Temperature => temperature(arrays).to_vec(),
            Self::Speed => arrays.get("velocity").map_or(Vec::new(), |velocity| {
                let vectors = velocity.values.chunks_exact(3);
                vectors
                    .map(|v| v.iter().map(|x| x * x).sum::<f64>().sqrt())
                    .collect()
            }),
        }
    }

    /// Values of gas cells; none where they are not shown.
    pub fn gas(self, arrays: &Arrays) -> &[f64] {
        match self {
            Self::Temperature => temperature(arrays),
            Self::Speed => &[],
        }
    }

    /// Label of the colour bar.
    pub fn label(self) -> &'static str {
        match self {
            Self::Temperature => "T in K",
            Self::Speed => "v in m/s",
        }
    }
}

fn temperature(arrays: &Arrays) -> &[f64] {
    match arrays.get("temperature") {
        Some(Array {
            components: 1,
            values,
        }) => values,
        _ => &[],
    }
}

/// One frame.
struct Frame {
    time: f64,
    circles: Vec<Circle>,
    values: Vec<f64>,
}

/// The film; empty where nothing moves or where there are too few snapshots.
pub(super) fn render(directory: &Path) -> Result<String, ResultsError> {
    let gas = read::collection(directory, "gas.pvd")?;
    let particles = read::collection(directory, "particles.pvd")?;
    let (Some((_, outline)), Some((_, first)), Some((_, last))) =
        (gas.first(), particles.first(), particles.last())
    else {
        return Ok(String::new());
    };
    let (outline, first, last) = (
        read::arrays(outline)?,
        read::arrays(first)?,
        read::arrays(last)?,
    );
    let points = |arrays: &Arrays| arrays.get("points").map(|array| array.values.clone());
    if particles.len() < 4 || points(&first) == points(&last) {
        return Ok(String::new());
    }
    let plane = section::plane(&outline);
    let cut = |arrays: &Arrays| section::circles(arrays, plane).len();
    let most = CIRCLES / cut(&first).max(cut(&last)).max(1);
    let count = particles.len().min(FRAMES).min(most.max(2));
    let shade = Shade::of([(&outline, &first), (&outline, &last)].into_iter());
    let frame = |number: usize| {
        let (time, file) = &particles[number * (particles.len() - 1) / (count - 1)];
        let bed = read::arrays(file)?;
        Ok(Frame {
            time: *time,
            circles: section::circles(&bed, plane),
            values: shade.particles(&bed),
        })
    };
    let frames = (0..count)
        .map(frame)
        .collect::<Result<Vec<_>, ResultsError>>()?;
    let corners = outline.get("points").map_or(&[][..], |array| &array.values);
    let range = |axis: usize| Range::of(corners.iter().skip(axis).step_by(3).copied());
    let (Some(x), Some(z)) = (range(0), range(2)) else {
        return Ok(String::new());
    };
    let film = draw(&frames, shade, [x.low, z.low], [x.high, z.high]);
    Ok(film + section::legend(&first))
}

fn draw(frames: &[Frame], shade: Shade, low: Spot, high: Spot) -> String {
    let values = frames.iter().flat_map(|frame| {
        let shown = frame.circles.iter();
        shown.filter_map(|circle| frame.values.get(circle.particle).copied())
    });
    let range = Range::of(values);
    let (wide, tall) = (high[0] - low[0], high[1] - low[1]);
    let scale = (HEIGHT / tall).min((WIDEST - BAR) / wide);
    let (wide, tall) = (wide * scale, tall * scale);
    let (width, height) = (wide + BAR + 4.0, tall + 60.0);
    let mut svg = format!(
        "<figure class=\"picture\"><svg viewBox=\"0 0 {width:.0} {height:.0}\" width=\"{width:.0}\" \
         role=\"img\" aria-label=\"Film of the bed\">"
    );
    for (number, frame) in frames.iter().enumerate() {
        svg.push_str(&turn(number, frames.len()));
        for circle in &frame.circles {
            let fill = match (range, frame.values.get(circle.particle)) {
                (Some(range), Some(&value)) => range.colour(value),
                _ => "var(--rule)".into(),
            };
            // Writing to a String cannot fail.
            let _ = write!(
                svg,
                "<circle cx=\"{:.1}\" cy=\"{:.1}\" r=\"{:.1}\" fill=\"{fill}\"/>",
                2.0 + (circle.centre[0] - low[0]) * scale,
                TOP + (high[1] - circle.centre[1]) * scale,
                circle.radius * scale
            );
        }
        let _ = write!(
            svg,
            "<text class=\"label\" text-anchor=\"middle\" x=\"{:.1}\" y=\"{:.1}\">{}</text></g>",
            2.0 + wide / 2.0,
            tall + TOP + 22.0,
            span(frame.time)
        );
    }
    let _ = write!(
        svg,
        "<rect class=\"hull\" x=\"2\" y=\"{TOP}\" width=\"{wide:.1}\" height=\"{tall:.1}\"/>"
    );
    if let Some(range) = range {
        let bar = tall.min(320.0);
        let (x, y) = (width - BAR + 26.0, TOP + (tall - bar) / 2.0);
        svg.push_str(&range.bar("film-scale", x, y, bar, shade.label()));
    }
    svg.push_str("</svg></figure>");
    svg
}

/// The beginning of a frame's group, which shows itself in its turn. What cannot animate shows the last frame.
fn turn(number: usize, count: usize) -> String {
    let [from, to] = [number, number + 1].map(|place| place as f64 / count as f64);
    let last = number + 1 == count;
    let rest = if last { "inline" } else { "none" };
    let (values, times) = match (number, last) {
        (0, _) => ("inline;none".to_owned(), format!("0;{to:.5}")),
        (_, true) => ("none;inline".to_owned(), format!("0;{from:.5}")),
        _ => (
            "none;inline;none".to_owned(),
            format!("0;{from:.5};{to:.5}"),
        ),
    };
    format!(
        "<g display=\"{rest}\"><animate attributeName=\"display\" values=\"{values}\" keyTimes=\"{times}\" \
         calcMode=\"discrete\" dur=\"{LENGTH}s\" repeatCount=\"indefinite\"/>"
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    fn arrays(entries: &[(&str, usize, &[f64])]) -> Arrays {
        let entry = |&(name, components, values): &(&str, usize, &[f64])| {
            let values = values.to_vec();
            (name.to_owned(), Array { components, values })
        };
        entries.iter().map(entry).collect()
    }

    #[test]
    fn particles_of_one_temperature_are_coloured_by_their_speed() {
        let cold = arrays(&[("temperature", 1, &[300.0, 300.0])]);
        let bed = arrays(&[
            ("temperature", 1, &[300.0, 300.0]),
            ("velocity", 3, &[0.0, 3.0, 4.0, 0.0, 0.0, 1.0]),
        ]);
        let shade = Shade::of([(&cold, &bed)].into_iter());
        assert_eq!(shade, Shade::Speed);
        assert_eq!(shade.particles(&bed), [5.0, 1.0]);
        let bare = arrays(&[("velocity", 3, &[1.0, 0.0, 0.0])]);
        assert_eq!(Shade::of([(&bare, &bare)].into_iter()), Shade::Speed);
        assert!(shade.gas(&cold).is_empty());
        let warm = arrays(&[("temperature", 1, &[300.0, 301.0])]);
        assert_eq!(Shade::of([(&warm, &bed)].into_iter()), Shade::Temperature);
        // Without velocities there is nothing else to show.
        assert_eq!(Shade::of([(&cold, &cold)].into_iter()), Shade::Temperature);
    }

    #[test]
    fn frames_take_turns_and_the_last_is_there_without_animation() {
        assert!(turn(0, 4).starts_with("<g display=\"none\">"));
        assert!(turn(0, 4).contains("values=\"inline;none\" keyTimes=\"0;0.25000\""));
        assert!(turn(1, 4).contains("values=\"none;inline;none\" keyTimes=\"0;0.25000;0.50000\""));
        assert!(turn(3, 4).starts_with("<g display=\"inline\">"));
        assert!(turn(3, 4).contains("values=\"none;inline\" keyTimes=\"0;0.75000\""));
    }
}
