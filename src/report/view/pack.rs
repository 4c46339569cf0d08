//! The view's data: positions in 16 bits, radii and values in 8, as base64 beside a description in JSON.

use base64::prelude::{BASE64_STANDARD, Engine as _};
use serde::Serialize;

use super::cast::{Cast, Moment};
use super::surface::{Surface, on_grid};
use super::walls::Extent;
use crate::report::colour::{self, Range};
use crate::report::number::figure;
use crate::report::spread::spread;

/// The byte of a value that there is not.
const NONE: u8 = 255;
/// The largest byte of a value.
const TOP: f64 = 254.0;
/// Marks along a scale.
const TICKS: usize = 5;

/// Steps of what is given up where a page has little room: so many columns, and the fewest snapshots with them.
const CHOICES: [(usize, usize); 8] = [
    (usize::MAX, 12),
    (6, 8),
    (4, 4),
    (3, 2),
    (2, 2),
    (4, 1),
    (2, 1),
    (1, 1),
];

/// What the view reads.
#[derive(Serialize)]
pub(super) struct ViewData {
    low: [f64; 3],
    high: [f64; 3],
    radii: [f64; 2],
    stops: &'static [[u8; 3]],
    first: usize,
    columns: Vec<Scale>,
    frames: Vec<Frame>,
    #[serde(skip_serializing_if = "Option::is_none")]
    walls: Option<Walls>,
    bytes: String,
    /// Of so many particles one is there.
    #[serde(skip)]
    pub stride: usize,
}

impl ViewData {
    /// Snapshots in it.
    pub fn snapshots(&self) -> usize {
        self.frames.len()
    }
}

#[derive(Serialize)]
struct Scale {
    label: String,
    ticks: Vec<String>,
}

#[derive(Serialize)]
struct Frame {
    time: String,
    count: usize,
    positions: usize,
    radii: usize,
    values: Vec<usize>,
}

#[derive(Serialize)]
struct Walls {
    points: usize,
    triangles: usize,
    corners: usize,
    edges: usize,
    ends: usize,
}

/// Blocks of bytes, each at an offset of whole words; one that is there already is not stored again.
#[derive(Default)]
struct Blocks {
    bytes: Vec<u8>,
    ends: Vec<(usize, usize)>,
}

impl Blocks {
    fn put(&mut self, block: &[u8]) -> usize {
        let same = |&&(start, end): &&(usize, usize)| &self.bytes[start..end] == block;
        if let Some((start, _)) = self.ends.iter().rev().find(same) {
            return *start;
        }
        self.bytes.resize(self.bytes.len().next_multiple_of(4), 0);
        let start = self.bytes.len();
        self.bytes.extend(block);
        self.ends.push((start, self.bytes.len()));
        start
    }
}

/// The data in so many bytes of base64 at most: all snapshots and columns where they fit, else fewer of both, else a share
/// of the particles. `first`: the column that is shown first.
pub(super) fn pack(
    cast: &Cast,
    surface: &Surface,
    extent: Extent,
    first: &str,
    room: usize,
) -> ViewData {
    let mut stride = 1;
    loop {
        for (columns, fewest) in CHOICES {
            let mut snapshots = cast.moments.len();
            loop {
                let chosen = Chosen {
                    moments: spread(cast.moments.len(), snapshots),
                    columns: kept(cast, first, columns),
                    stride,
                };
                let data = chosen.pack(cast, surface, extent, room, first);
                // Nothing is left to give up where even the walls do not fit.
                if let Some(data) = data {
                    return data;
                }
                if snapshots <= fewest {
                    break;
                }
                snapshots = (snapshots * 4 / 5).max(fewest);
            }
        }
        stride = (stride * 3).div_ceil(2);
        if stride > 10_000 {
            let bare = Chosen {
                moments: Vec::new(),
                columns: Vec::new(),
                stride,
            };
            let nothing = Surface::default();
            if let Some(data) = bare.pack(cast, &nothing, extent, usize::MAX, first) {
                return data;
            }
        }
    }
}

/// The columns that are kept, by their places: the first one, then others in their order.
fn kept(cast: &Cast, first: &str, most: usize) -> Vec<usize> {
    let mut places: Vec<usize> = (0..cast.columns.len()).collect();
    places.sort_by_key(|&place| cast.columns[place].name != first);
    places.truncate(most);
    places.sort_unstable();
    places
}

/// What of a cast is packed.
struct Chosen {
    moments: Vec<usize>,
    columns: Vec<usize>,
    stride: usize,
}

impl Chosen {
    /// `None` where it takes more room.
    fn pack(
        &self,
        cast: &Cast,
        surface: &Surface,
        extent: Extent,
        room: usize,
        first: &str,
    ) -> Option<ViewData> {
        let all = cast
            .moments
            .iter()
            .flat_map(|moment| moment.radii.iter().copied());
        let radii = Range::of(all).unwrap_or(Range {
            low: 0.0,
            high: 0.0,
        });
        let mut blocks = Blocks::default();
        let walls = (!surface.points.is_empty()).then(|| Walls {
            points: blocks.put(&words(surface.points.iter().flatten())),
            triangles: blocks.put(&words(surface.triangles.iter())),
            corners: surface.triangles.len(),
            edges: blocks.put(&words(surface.edges.iter())),
            ends: surface.edges.len(),
        });
        let mut frames = Vec::new();
        for &number in &self.moments {
            frames.push(self.frame(cast, &cast.moments[number], extent, radii, &mut blocks));
            if blocks.bytes.len().div_ceil(3) * 4 > room {
                return None;
            }
        }
        let columns: Vec<_> = self
            .columns
            .iter()
            .map(|&place| &cast.columns[place])
            .collect();
        let scale = |range: Range| -> Vec<String> {
            let tick = |step: usize| {
                let share = step as f64 / (TICKS - 1) as f64;
                figure(range.low + share * (range.high - range.low), 4)
            };
            (0..TICKS).map(tick).collect()
        };
        Some(ViewData {
            low: extent[0].into(),
            high: extent[1].into(),
            radii: [radii.low, radii.high],
            stops: &colour::STOPS,
            first: columns
                .iter()
                .position(|one| one.name == first)
                .unwrap_or(0),
            columns: columns
                .iter()
                .map(|column| Scale {
                    label: column.label.clone(),
                    ticks: scale(column.range),
                })
                .collect(),
            frames,
            walls,
            bytes: BASE64_STANDARD.encode(&blocks.bytes),
            stride: self.stride,
        })
    }

    fn frame(
        &self,
        cast: &Cast,
        moment: &Moment,
        extent: Extent,
        radii: Range,
        blocks: &mut Blocks,
    ) -> Frame {
        let centres: Vec<[u16; 3]> = moment
            .centres
            .iter()
            .step_by(self.stride)
            .map(|centre| on_grid(extent, *centre))
            .collect();
        let bytes = |values: &[f64], range: Range, top: f64| -> Vec<u8> {
            let values = values.iter().step_by(self.stride);
            values.map(|&value| byte(value, range, top)).collect()
        };
        Frame {
            time: moment.time.clone(),
            count: centres.len(),
            positions: blocks.put(&words(centres.iter().flatten())),
            radii: blocks.put(&bytes(&moment.radii, radii, 255.0)),
            values: self
                .columns
                .iter()
                .map(|&place| {
                    let range = cast.columns[place].range;
                    blocks.put(&bytes(&moment.values[place], range, TOP))
                })
                .collect(),
        }
    }
}

/// The place of a value in a range, from 0 to `top`.
fn byte(value: f64, range: Range, top: f64) -> u8 {
    if !value.is_finite() {
        return NONE;
    }
    let span = range.high - range.low;
    let share = if span > 0.0 {
        (value - range.low) / span
    } else {
        0.5
    };
    (share.clamp(0.0, 1.0) * top).round() as u8
}

fn words<'a>(values: impl Iterator<Item = &'a u16>) -> Vec<u8> {
    values.flat_map(|value| value.to_le_bytes()).collect()
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeMap;

    use super::*;
    use crate::report::cells::Point;
    use crate::results::read::{Array, Arrays};

    /// Particles that rise, with a temperature by their height and a speed by their number.
    fn cast(count: usize, snapshots: usize) -> Cast {
        let array = |components: usize, values: Vec<f64>| Array { components, values };
        let mut noise = 1_u64;
        let mut random = move || {
            noise = noise
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1_442_695_040_888_963_407);
            (noise >> 11) as f64 / (1_u64 << 53) as f64
        };
        let base: Vec<f64> = (0..3 * count).map(|_| random()).collect();
        let radii: Vec<f64> = (0..count).map(|_| 0.002 + 0.001 * random()).collect();
        let snapshot = |number: usize| {
            let up = 0.01 * number as f64;
            let points: Vec<f64> = base
                .iter()
                .enumerate()
                .map(|(k, x)| x + if k % 3 == 2 { up } else { 0.0 })
                .collect();
            let hot = points
                .iter()
                .skip(2)
                .step_by(3)
                .map(|z| 300.0 + 100.0 * z)
                .collect();
            let speed = (0..3 * count).map(|k| (k % 7) as f64).collect();
            let bed = Arrays::from([
                ("points".to_owned(), array(3, points)),
                ("radius".to_owned(), array(1, radii.clone())),
                ("temperature".to_owned(), array(1, hot)),
                ("velocity".to_owned(), array(3, speed)),
            ]);
            (number as f64, bed)
        };
        let units = BTreeMap::from([("temperature".to_owned(), "K".to_owned())]);
        Cast::of(&(0..snapshots).map(snapshot).collect::<Vec<_>>(), &units)
    }

    const EXTENT: Extent = [Point::new(0.0, 0.0, 0.0), Point::new(1.0, 1.0, 2.0)];

    #[test]
    fn what_is_packed_decodes_to_the_particles_within_the_steps_of_its_grid() {
        let cast = cast(500, 6);
        let data = pack(&cast, &Surface::default(), EXTENT, "temperature", 1_000_000);
        assert_eq!((data.frames.len(), data.stride), (6, 1));
        let labels: Vec<&str> = data.columns.iter().map(|one| one.label.as_str()).collect();
        assert_eq!(
            labels,
            ["temperature in K", "speed in m/s", "diameter in mm"]
        );
        let bytes = BASE64_STANDARD.decode(&data.bytes).unwrap();
        for (frame, moment) in data.frames.iter().zip(&cast.moments) {
            assert_eq!((frame.count, frame.positions % 2), (500, 0));
            for row in 0..500 {
                for (axis, (low, high)) in EXTENT[0].iter().zip(&EXTENT[1]).enumerate() {
                    let at = frame.positions + 6 * row + 2 * axis;
                    let share =
                        f64::from(u16::from_le_bytes([bytes[at], bytes[at + 1]])) / 65_535.0;
                    let span = high - low;
                    let error = low + share * span - moment.centres[row][axis];
                    assert!(error.abs() <= 0.5001 * span / 65_535.0, "{error}");
                }
                let share = f64::from(bytes[frame.radii + row]) / 255.0;
                let span = data.radii[1] - data.radii[0];
                let error = data.radii[0] + share * span - moment.radii[row];
                assert!(error.abs() <= 0.5001 * span / 255.0, "{error}");
                for (column, place) in frame.values.iter().enumerate() {
                    let range = cast.columns[column].range;
                    let share = f64::from(bytes[place + row]) / TOP;
                    let span = range.high - range.low;
                    let error = range.low + share * span - moment.values[column][row];
                    assert!(error.abs() <= 0.5001 * span / TOP, "{error}");
                }
            }
        }
        // Radii and speeds do not change: they are there once.
        assert!(
            data.frames
                .iter()
                .all(|frame| frame.radii == data.frames[0].radii)
        );
    }

    #[test]
    fn a_hundred_thousand_particles_fit_a_page_with_two_times_and_two_columns() {
        let cast = cast(100_000, 4);
        let room = 2_300_000;
        let data = pack(&cast, &Surface::default(), EXTENT, "speed", room);
        assert!(data.bytes.len() <= room, "{}", data.bytes.len());
        assert_eq!((data.frames.len(), data.stride), (2, 1));
        assert!(data.columns.len() >= 2);
        assert_eq!(data.columns[data.first].label, "speed in m/s");
        // Less room: fewer times, then fewer particles.
        let data = pack(&cast, &Surface::default(), EXTENT, "speed", 1_100_000);
        assert_eq!((data.frames.len(), data.stride), (1, 1));
        let data = pack(&cast, &Surface::default(), EXTENT, "speed", 400_000);
        assert!(data.stride > 1 && data.bytes.len() <= 400_000);
    }

    #[test]
    fn a_value_that_there_is_not_has_a_byte_of_its_own() {
        let range = Range {
            low: 0.0,
            high: 1.0,
        };
        assert_eq!(
            [f64::NAN, 0.0, 1.0, 2.0].map(|x| byte(x, range, TOP)),
            [NONE, 0, 254, 254]
        );
        let flat = Range {
            low: 3.0,
            high: 3.0,
        };
        assert_eq!(byte(3.0, flat, TOP), 127);
    }
}
