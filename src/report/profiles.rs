//! Profiles of gas and particles along the longest side of the gas, and histograms of the particles, at some times.

use std::collections::BTreeMap;
use std::path::Path;

use super::bed_columns::{BedColumn, columns};
use super::cells::{Point, all_points, cells};
use super::colour::{self, Range};
use super::number::{axis_label, span};
use super::plot::{Curve, Plot, Stroke};
use super::spread::spread;
use crate::results::ResultsError;
use crate::results::read::{self, Arrays};

/// Layers of cells that are told apart at most; more are put together.
const LAYERS: usize = 60;
/// Layers at least of a mesh that has so many.
const FEWEST: usize = 8;
/// Layers of particles, which lie at any height.
const PARTICLE_LAYERS: usize = 24;
/// Classes of a histogram.
const CLASSES: usize = 24;
/// Plots of the gas, and of the particles, at most.
const PLOTS: usize = 8;
/// Times at most.
const TIMES: usize = 3;
/// Columns of particles whose histograms are shown.
const HISTOGRAMS: [&str; 3] = ["diameter", "temperature", "conversion"];
/// Columns that are no state along an axis.
const NOT_ALONG: [&str; 5] = ["weight", "heat", "force", "slip", "first_mass"];

/// The plots of profiles and of histograms.
#[derive(Default)]
pub(super) struct Distributions {
    /// Profiles as HTML; empty where nothing differs along the axis.
    pub profiles: String,
    /// Histograms as HTML; empty where all particles are alike.
    pub histograms: String,
}

/// A snapshot, read.
struct Snapshot {
    time: f64,
    gas: Vec<BedColumn>,
    cells: Vec<(Point, f64)>,
    particles: Vec<BedColumn>,
    centres: Vec<Point>,
    weights: Vec<f64>,
}

/// Both of a results folder.
pub(super) fn render(directory: &Path) -> Result<Distributions, ResultsError> {
    let gas = read::collection(directory, "gas.pvd")?;
    let beds = read::collection(directory, "particles.pvd")?;
    let count = gas.len().min(beds.len());
    let units = read::units(directory);
    let mut snapshots = Vec::new();
    for number in spread(count, TIMES) {
        let (gas_file, bed_file) = (
            read::arrays(&gas[number].1)?,
            read::arrays(&beds[number].1)?,
        );
        snapshots.push(Snapshot::of(gas[number].0, &gas_file, &bed_file, &units));
    }
    let Some(axis) = snapshots.first().and_then(Snapshot::longest) else {
        return Ok(Distributions::default());
    };
    Ok(Distributions {
        profiles: wrapped(profiles(&snapshots, axis)),
        histograms: wrapped(histograms(&snapshots)),
    })
}

fn wrapped(plots: Vec<String>) -> String {
    match plots.is_empty() {
        true => String::new(),
        false => format!("<div class=\"plots\">{}</div>", plots.concat()),
    }
}

impl Snapshot {
    fn of(
        time: f64,
        gas: &Arrays,
        bed: &Arrays,
        [gas_units, units]: &[BTreeMap<String, String>; 2],
    ) -> Self {
        let cells: Vec<(Point, f64)> = cells(gas)
            .iter()
            .map(|cell| (cell.centre, cell.volume))
            .collect();
        let centres = all_points(bed);
        let weights = bed.get("weight").map(|array| array.values.clone());
        Self {
            time,
            gas: columns(gas, cells.len(), gas_units),
            cells,
            particles: columns(bed, centres.len(), units),
            weights: weights.unwrap_or_else(|| vec![1.0; centres.len()]),
            centres,
        }
    }

    /// The axis along which the gas is longest; upwards where sides are as long.
    fn longest(&self) -> Option<usize> {
        let length = |axis: usize| {
            let range = Range::of(self.cells.iter().map(|cell| cell.0[axis]))?;
            Some(range.high - range.low)
        };
        let lengths = [length(0)?, length(1)?, length(2)?];
        let most = lengths.iter().copied().fold(0.0, f64::max);
        (0..3).rev().find(|&axis| lengths[axis] >= 0.999 * most)
    }
}

/// Means over layers: places along the axis, and weighted means; layers without anything are left out.
fn layered(
    items: impl Iterator<Item = (f64, f64, f64)>,
    range: Range,
    layers: usize,
) -> (Vec<f64>, Vec<f64>) {
    let mut sums = vec![[0.0; 3]; layers];
    let span = (range.high - range.low).max(f64::MIN_POSITIVE);
    for (place, value, weight) in items {
        if value.is_finite() {
            let layer = ((place - range.low) / span * layers as f64) as usize;
            let [place_sum, value_sum, all] = &mut sums[layer.min(layers - 1)];
            *place_sum += weight * place;
            *value_sum += weight * value;
            *all += weight;
        }
    }
    let taken = sums.iter().filter(|sum| sum[2] > 0.0);
    taken.map(|sum| (sum[0] / sum[2], sum[1] / sum[2])).unzip()
}

/// Layers of the cells along an axis, and the range that they take.
fn layers_of(cells: &[(Point, f64)], axis: usize) -> Option<(Range, usize)> {
    let range = Range::of(cells.iter().map(|cell| cell.0[axis]))?;
    let span = range.high - range.low;
    let mut places: Vec<f64> = cells.iter().map(|cell| cell.0[axis]).collect();
    places.sort_by(f64::total_cmp);
    let steps = places.windows(2).map(|pair| pair[1] - pair[0]);
    let steps: Vec<f64> = steps.filter(|step| *step > 1e-4 * span).collect();
    // Each layer of a regular mesh by itself; where cells are refined, as thick as the coarse ones, so that no layer is of
    // cells of one kind alone.
    let widest = steps.iter().copied().fold(0.0, f64::max);
    let coarse = 1 + (span / widest.max(f64::MIN_POSITIVE)).round() as usize;
    let layers = coarse.max((steps.len() + 1).min(FEWEST)).min(LAYERS);
    // Half a layer more at both ends.
    let half = 0.5 * span / (layers.max(2) - 1) as f64;
    let wide = Range {
        low: range.low - half,
        high: range.high + half,
    };
    Some((wide, layers))
}

fn profiles(snapshots: &[Snapshot], axis: usize) -> Vec<String> {
    let Some((range, layers)) = layers_of(&snapshots[0].cells, axis) else {
        return Vec::new();
    };
    if layers < 3 {
        return Vec::new();
    }
    let x_label = axis_label(["x", "y", "z"][axis], "m");
    let of_gas = |snapshot: &Snapshot, values: &[f64]| {
        let items = snapshot.cells.iter().zip(values);
        layered(
            items.map(|((centre, volume), value)| (centre[axis], *value, *volume)),
            range,
            layers,
        )
    };
    let of_particles = |snapshot: &Snapshot, values: &[f64]| {
        let rows = snapshot.centres.iter().zip(&snapshot.weights).zip(values);
        let items = rows.map(|((centre, weight), value)| (centre[axis], *value, *weight));
        let own = Range::of(snapshot.centres.iter().map(|centre| centre[axis]));
        layered(items, own.unwrap_or(range), PARTICLE_LAYERS)
    };
    let mut plots = Vec::new();
    type Means<'a> = &'a dyn Fn(&Snapshot, &[f64]) -> (Vec<f64>, Vec<f64>);
    type Columns = fn(&Snapshot) -> &[BedColumn];
    let parts: [(&str, Columns, Means<'_>); 2] = [
        ("Gas: ", |one| &one.gas, &of_gas),
        ("Particles: ", |one| &one.particles, &of_particles),
    ];
    for (part, own, means) in parts {
        let last = snapshots.last().map_or(&[][..], own);
        let shown = last
            .iter()
            .filter(|column| !NOT_ALONG.contains(&column.name.as_str()));
        let of_part = shown.filter_map(|column| {
            let curves: Vec<(f64, Vec<f64>, Vec<f64>)> = snapshots
                .iter()
                .filter_map(|snapshot| {
                    let same = own(snapshot).iter().find(|one| one.name == column.name)?;
                    let (places, values) = means(snapshot, &same.values);
                    Some((snapshot.time, places, values))
                })
                .collect();
            let all = curves.iter().flat_map(|curve| curve.2.iter().copied());
            let range = Range::of(all)?;
            // Round-off along the axis is no profile.
            let flat = range.high - range.low <= 1e-9 * range.high.abs().max(range.low.abs());
            (!flat).then(|| drawn(&format!("{part}{}", column.label), &x_label, &curves))
        });
        plots.extend(of_part.take(PLOTS));
    }
    plots
}

fn histograms(snapshots: &[Snapshot]) -> Vec<String> {
    let ends = match snapshots {
        [] => return Vec::new(),
        [only] => vec![only],
        [first, .., last] => vec![first, last],
    };
    let mut plots = Vec::new();
    for name in HISTOGRAMS {
        let found: Vec<(&Snapshot, &BedColumn)> = ends
            .iter()
            .filter_map(|snapshot| {
                let column = snapshot.particles.iter().find(|one| one.name == name)?;
                Some((*snapshot, column))
            })
            .collect();
        let values = found
            .iter()
            .flat_map(|(_, column)| column.values.iter().copied());
        let (Some(range), Some((_, column))) = (Range::of(values), found.last()) else {
            continue;
        };
        if range.high - range.low <= 1e-9 * range.high.abs() {
            continue;
        }
        let curves: Vec<(f64, Vec<f64>, Vec<f64>)> = found
            .iter()
            .map(|(snapshot, column)| {
                let (places, shares) = shares(&column.values, &snapshot.weights, range);
                (snapshot.time, places, shares)
            })
            .collect();
        plots.push(drawn("Share of the particles in %", &column.label, &curves));
    }
    plots
}

/// The outline of a histogram: corners of its steps, and shares of the number of particles in %.
fn shares(values: &[f64], weights: &[f64], range: Range) -> (Vec<f64>, Vec<f64>) {
    let mut sums = [0.0; CLASSES];
    let width = (range.high - range.low) / CLASSES as f64;
    for (value, weight) in values.iter().zip(weights) {
        if value.is_finite() {
            let class = ((value - range.low) / width) as usize;
            sums[class.min(CLASSES - 1)] += weight;
        }
    }
    let all = sums.iter().sum::<f64>().max(f64::MIN_POSITIVE);
    let (mut places, mut shares) = (vec![range.low], vec![0.0]);
    for (class, sum) in sums.iter().enumerate() {
        for edge in [class, class + 1] {
            places.push(range.low + width * edge as f64);
            shares.push(100.0 * sum / all);
        }
    }
    places.push(range.high);
    shares.push(0.0);
    (places, shares)
}

fn drawn(title: &str, x_label: &str, curves: &[(f64, Vec<f64>, Vec<f64>)]) -> String {
    let curves = curves
        .iter()
        .enumerate()
        .map(|(place, (time, x, y))| Curve {
            label: span(*time),
            colour: colour::line(place),
            x,
            y,
            stroke: Stroke::Solid,
        });
    let plot = Plot {
        title: title.into(),
        x_label,
        logarithmic: false,
        above: None,
        band: None,
        curves: curves.collect(),
    };
    plot.render()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_mean_over_a_layer_counts_volumes() {
        let range = Range {
            low: 0.0,
            high: 2.0,
        };
        let items = [
            (0.5, 10.0, 1.0),
            (0.5, 20.0, 3.0),
            (1.5, 5.0, 2.0),
            (1.5, f64::NAN, 2.0),
        ];
        let (places, means) = layered(items.into_iter(), range, 2);
        assert_eq!((places, means), (vec![0.5, 1.5], vec![17.5, 5.0]));
    }

    #[test]
    fn each_layer_of_a_regular_mesh_stands_by_itself() {
        let cells: Vec<(Point, f64)> = (0..11)
            .map(|k| (Point::new(0.0, 0.0, 0.01 * f64::from(k)), 1.0))
            .collect();
        let (range, layers) = layers_of(&cells, 2).unwrap();
        assert_eq!(layers, 11);
        let items = cells.iter().map(|cell| (cell.0[2], cell.0[2], 1.0));
        let (places, _) = layered(items, range, layers);
        assert_eq!(places.len(), 11);
        // Halved cells in the middle do not split their neighbours' layers.
        let halves = [0.0475, 0.0525].map(|z| (Point::new(0.0, 0.0, z), 0.5));
        let refined: Vec<(Point, f64)> = cells.into_iter().chain(halves).collect();
        assert_eq!(layers_of(&refined, 2).unwrap().1, 11);
    }

    #[test]
    fn the_shares_of_a_histogram_add_up_to_all() {
        let range = Range {
            low: 0.0,
            high: 24.0,
        };
        let (places, shares) = shares(&[0.0, 1.5, 1.6, 24.0], &[1.0, 1.0, 2.0, 4.0], range);
        assert_eq!((places.len(), shares.len()), (50, 50));
        // Each class has two corners.
        assert!((shares.iter().sum::<f64>() - 200.0).abs() < 1e-12);
        assert_eq!(shares[3], 37.5);
        assert_eq!(shares[48], 50.0);
    }
}
