//! What is inside of particles with shells, over their radius, at some times.

use std::path::Path;

use calcine_coupler::interior::radial::node_of_shell;

use super::cells::all_points;
use super::colour;
use super::number::{axis_label, span};
use super::plot::{Curve, Plot, Stroke};
use super::spread::spread;
use crate::results::ResultsError;
use crate::results::lengths_of;
use crate::results::read::{self, Arrays};

/// Times at most.
const TIMES: usize = 4;
/// Columns of shells that are drawn.
const SHOWN: [&str; 3] = ["shell_temperature", "shell_conversion", "shell_pressure"];
/// Outer faces of shells in m.
const FACES: &str = "shell_radius";

/// A curve: its name, radii over that of the particle, values.
type Profile = (String, Vec<f64>, Vec<f64>);

/// The plots as HTML; empty where no particle has shells.
pub(super) fn render(directory: &Path) -> Result<String, ResultsError> {
    let beds = read::collection(directory, "particles.pvd")?;
    let Some((end, file)) = beds.last() else {
        return Ok(String::new());
    };
    let at_end = read::arrays(file)?;
    if !at_end.contains_key(FACES) {
        return Ok(String::new());
    }
    let [_, units] = read::units(directory);
    let mut snapshots = Vec::new();
    for number in spread(beds.len(), TIMES) {
        if number + 1 < beds.len() {
            snapshots.push((beds[number].0, read::arrays(&beds[number].1)?));
        }
    }
    snapshots.push((*end, at_end));
    let mut plots = Vec::new();
    for name in SHOWN {
        let label = axis_label(name, units.get(name).map_or("", String::as_str));
        let means = snapshots.iter().filter_map(|(time, arrays)| {
            let (radii, values) = mean(&Shells::of(arrays, name)?)?;
            Some((span(*time), radii, values))
        });
        let means: Vec<Profile> = means.collect();
        plots.extend(drawn(&format!("Mean {label}"), &means));
        let single = snapshots.last();
        let single = single.map_or_else(Vec::new, |(_, last)| lowest_to_highest(last, name));
        plots.extend(drawn(&format!("At the end: {label}"), &single));
    }
    Ok(match plots.is_empty() {
        true => String::new(),
        false => format!("<div class=\"plots\">{}</div>", plots.concat()),
    })
}

/// A column of shells with their faces, particle by particle as many as the longest has.
struct Shells<'a> {
    width: usize,
    values: &'a [f64],
    faces: &'a [f64],
    lengths: &'a [f64],
}

impl<'a> Shells<'a> {
    fn of(arrays: &'a Arrays, name: &str) -> Option<Self> {
        let (column, faces) = (arrays.get(name)?, arrays.get(FACES)?);
        let lengths = arrays.get(&lengths_of(FACES))?;
        let width = column.components;
        let fits = width == faces.components
            && column.values.len() == faces.values.len()
            && column.values.len() == width * lengths.values.len();
        fits.then_some(Self {
            width,
            values: &column.values,
            faces: &faces.values,
            lengths: &lengths.values,
        })
    }

    /// Where the values of a particle with several shells stand, over its radius, and these values.
    fn profile(&self, particle: usize) -> Option<(Vec<f64>, &[f64])> {
        let count = self.lengths[particle] as usize;
        if count < 2 {
            return None;
        }
        let own = particle * self.width..particle * self.width + count;
        let faces = &self.faces[own.clone()];
        let surface = faces.last().copied()?;
        let mut inner = 0.0;
        let node = |outer: &f64| {
            let place = node_of_shell(inner, *outer) / surface;
            inner = *outer;
            place
        };
        Some((faces.iter().map(node).collect(), &self.values[own]))
    }

    fn particles(&self) -> std::ops::Range<usize> {
        0..self.lengths.len()
    }
}

/// Means over all particles that have their shells, shell by shell.
fn mean(shells: &Shells<'_>) -> Option<(Vec<f64>, Vec<f64>)> {
    let (mut radii, mut values, mut count) = (Vec::new(), Vec::new(), 0.0);
    for (own, inside) in shells.particles().filter_map(|p| shells.profile(p)) {
        if radii.is_empty() {
            (radii, values) = (vec![0.0; own.len()], vec![0.0; own.len()]);
        }
        // Of a run with materials of several numbers of shells those of the first.
        if own.len() != radii.len() {
            continue;
        }
        for (sum, own) in radii.iter_mut().zip(&own) {
            *sum += own;
        }
        for (sum, own) in values.iter_mut().zip(inside) {
            *sum += own;
        }
        count += 1.0;
    }
    for sum in radii.iter_mut().chain(&mut values) {
        *sum /= count;
    }
    (count > 0.0).then_some((radii, values))
}

/// The lowest particle with shells, that in the middle, and the highest; none where there is one alone.
fn lowest_to_highest(arrays: &Arrays, name: &str) -> Vec<Profile> {
    let Some(shells) = Shells::of(arrays, name) else {
        return Vec::new();
    };
    let centres = all_points(arrays);
    let with_shells = shells.particles().filter(|p| shells.profile(*p).is_some());
    let mut order: Vec<usize> = with_shells.collect();
    order.sort_by(|one, other| centres[*one][2].total_cmp(&centres[*other][2]));
    let [Some(lowest), Some(highest)] = [order.first(), order.last()] else {
        return Vec::new();
    };
    if lowest == highest {
        return Vec::new();
    }
    let middle = order[order.len() / 2];
    let named = [
        ("lowest", *lowest),
        ("in the middle", middle),
        ("highest", *highest),
    ];
    let profiles = named.into_iter().filter_map(|(name, particle)| {
        let (radii, values) = shells.profile(particle)?;
        Some((name.to_owned(), radii, values.to_vec()))
    });
    profiles.collect()
}

/// A plot, where there is a curve.
fn drawn(title: &str, profiles: &[Profile]) -> Option<String> {
    if profiles.is_empty() {
        return None;
    }
    let curves = profiles.iter().enumerate();
    let curves = curves.map(|(place, (label, x, y))| Curve {
        label: label.clone(),
        colour: colour::line(place),
        x,
        y,
        stroke: Stroke::Solid,
    });
    let plot = Plot {
        title: title.into(),
        x_label: "radius over that of the particle",
        logarithmic: false,
        above: None,
        band: None,
        curves: curves.collect(),
    };
    Some(plot.render())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::results::read::Array;

    #[test]
    fn shells_stand_at_their_mean_square_and_particles_of_one_shell_are_left_out() {
        let array = |components: usize, values: &[f64]| Array {
            components,
            values: values.to_vec(),
        };
        let arrays = Arrays::from([
            (
                "points".to_owned(),
                array(3, &[0.0, 0.0, 2.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0]),
            ),
            (
                "shell_temperature".to_owned(),
                array(2, &[300.0, 400.0, 500.0, 600.0, 700.0, f64::NAN]),
            ),
            (
                FACES.to_owned(),
                array(2, &[1.0, 2.0, 1.0, 2.0, 2.0, f64::NAN]),
            ),
            (lengths_of(FACES), array(1, &[2.0, 2.0, 1.0])),
        ]);
        let shells = Shells::of(&arrays, "shell_temperature").unwrap();
        let (radii, values) = mean(&shells).unwrap();
        assert_eq!(values, [400.0, 500.0]);
        // √(3/5)/2, and √(3/5 · 31/7)/2.
        assert!((radii[0] - 0.6_f64.sqrt() / 2.0).abs() < 1e-15);
        assert!((radii[1] - (0.6_f64 * 31.0 / 7.0).sqrt() / 2.0).abs() < 1e-15);
        let three = lowest_to_highest(&arrays, "shell_temperature");
        assert_eq!(three[0].2, [500.0, 600.0]);
        assert_eq!(three[2].2, [300.0, 400.0]);
    }
}
