//! Plots of the probes: each field along a probe's points at several times, or over time where the
//! probe is a single point.

use std::collections::BTreeMap;
use std::path::Path;

use super::colour;
use super::number::span;
use super::page::escape;
use super::plot::{Curve, Plot, Stroke, TIME};
use crate::results::read::collection;
use crate::results::{ResultsError, files, sheet};

/// Snapshots shown of a line at most.
const SHOWN: usize = 5;
/// Columns that say which particle it is, not how it is.
const OF_ITSELF: [&str; 3] = ["particle_id", "particle_population", "particle_radius"];

/// One probe in one snapshot: distances in m, and fields by `name [unit]`.
#[derive(Clone, Debug, Default, PartialEq)]
struct Sampled {
    distance: Vec<f64>,
    fields: BTreeMap<String, Vec<f64>>,
}

/// All plots; empty where the case has no probes.
pub(super) fn render(directory: &Path) -> Result<String, ResultsError> {
    if !directory.join("probes").is_dir() {
        return Ok(String::new());
    }
    let times: Vec<f64> = collection(directory, "gas.pvd")?
        .into_iter()
        .map(|(time, _)| time)
        .collect();
    let snapshots = (0..times.len())
        .map(|number| {
            let path = directory.join(format!("probes/probes_{number:04}.csv"));
            read(&path)
        })
        .collect::<Result<Vec<_>, _>>()?;
    let Some(first) = snapshots.first() else {
        return Ok(String::new());
    };
    let mut html = String::new();
    for (name, sampled) in first {
        for field in sampled.fields.keys() {
            let all: Vec<(&[f64], &[f64])> = snapshots
                .iter()
                .filter_map(|snapshot| {
                    let sampled = snapshot.get(name)?;
                    Some((&sampled.distance[..], &sampled.fields.get(field)?[..]))
                })
                .collect();
            if all.len() == times.len() {
                html.push_str(&plot(name, field, &times, &all));
            }
        }
    }
    if html.is_empty() {
        return Ok(html);
    }
    Ok(format!("<div class=\"plots\">{html}</div>"))
}

fn plot(probe: &str, field: &str, times: &[f64], snapshots: &[(&[f64], &[f64])]) -> String {
    let (name, unit) = field.split_once(" [").unwrap_or((field, "1]"));
    let name = name.replace("particle_", "particle ").replace('_', " ");
    let title = format!("{probe}: {name} in {}", unit.trim_end_matches(']'));
    let drawn = |x_label, curves: Vec<Curve<'_>>| {
        let plot = Plot {
            title: title.clone(),
            x_label,
            logarithmic: false,
            above: None,
            band: None,
            curves,
        };
        plot.render()
    };
    if snapshots.iter().all(|(distance, _)| distance.len() == 1) {
        let values: Vec<f64> = snapshots.iter().map(|(_, values)| values[0]).collect();
        let curve = Curve {
            label: String::new(),
            colour: colour::line(0),
            x: times,
            y: &values,
            stroke: Stroke::Solid,
        };
        return drawn(TIME, vec![curve]);
    }
    let last = snapshots.len() - 1;
    let shown = snapshots.len().min(SHOWN);
    let numbers = (0..shown).map(|i| {
        if shown == 1 {
            last
        } else {
            i * last / (shown - 1)
        }
    });
    let curves = numbers.enumerate().map(|(place, number)| Curve {
        label: escape(&span(times[number])),
        colour: colour::line(place),
        x: snapshots[number].0,
        y: snapshots[number].1,
        stroke: Stroke::Solid,
    });
    drawn("distance along the probe in m", curves.collect())
}

/// The probes of a snapshot by name, in the order of names.
fn read(path: &Path) -> Result<BTreeMap<String, Sampled>, ResultsError> {
    let mut rows = sheet::rows(path, &files::read(path)?)?.into_iter();
    let head = rows.next().unwrap_or_default();
    let mut probes: BTreeMap<String, Sampled> = BTreeMap::new();
    for row in rows {
        let name = row.get(0).unwrap_or("");
        let values: Vec<f64> = row
            .iter()
            .skip(1)
            .map(|word| word.parse().unwrap_or(f64::NAN))
            .collect();
        if row.len() != head.len() || values.len() < 4 {
            return Err(ResultsError::content(
                path,
                format!("a line is `{}`", sheet::words(&row)),
            ));
        }
        let probe = probes.entry(name.to_owned()).or_default();
        probe.distance.push(values[0]);
        for (field, &value) in head.iter().skip(5).zip(&values[4..]) {
            let bare = field.split(" [").next().unwrap_or(field);
            if !OF_ITSELF.contains(&bare) {
                let list = probe.fields.entry(field.to_owned()).or_default();
                list.push(value);
            }
        }
    }
    for probe in probes.values_mut() {
        probe
            .fields
            .retain(|_, values| values.iter().any(|value| value.is_finite()));
    }
    Ok(probes)
}
