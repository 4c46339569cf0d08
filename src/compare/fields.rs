//! Differences of fields between runs: per particle over the time series, per cell over the
//! snapshots.

use serde::Serialize;

use super::agreement::Agreement;
use super::common;
use super::error::CompareError;
use super::quantities::{common_times, exceeds, words};
use super::source::Source;
use super::spread::Spread;
use crate::case::model::{Case, FieldBand, Measure, ToleranceBand};
use crate::report::plot::between;
use crate::results::lengths_of;
use crate::results::read::{self, Arrays};

/// The difference between two runs.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Norms {
    /// The two runs.
    pub runs: [String; 2],
    /// Root of the mean square over places and times, in the field's unit.
    pub l2: f64,
    /// Largest magnitude, in the field's unit.
    pub maximum: f64,
    /// Index of the cell, or id of the particle, of the largest.
    pub place: u64,
    /// Process time of the largest in s.
    pub at_s: f64,
}

/// How far the runs differ in one field.
#[derive(Clone, Debug, Serialize)]
pub struct FieldDifference {
    /// Name, for example `particles.temperature`.
    pub name: String,
    /// `particle` or `cell`.
    pub per: &'static str,
    /// Its unit.
    pub unit: String,
    /// Every pair of runs.
    pub pairs: Vec<Norms>,
    /// Largest minus smallest value over all runs, places and times, zero where that is round-off; vectors by components.
    pub span: f64,
    #[serde(skip)]
    pub(super) spread: Spread,
    /// The allowed maximum in words, if the case states one.
    pub band: Option<String>,
    /// Whether the largest of all pairs is allowed.
    pub verdict: Agreement,
}

impl FieldDifference {
    /// Where a difference is largest, in words; nowhere where there is none.
    pub(super) fn place(&self, norms: &Norms) -> String {
        match norms.maximum == 0.0 {
            true => "–".into(),
            false => format!("{} {}", self.per, norms.place),
        }
    }

    /// The pair that differs most.
    pub fn worst(&self) -> Option<&Norms> {
        let mut pairs = self.pairs.iter();
        let first = pairs.next()?;
        Some(pairs.fold(first, |worst, pair| {
            if exceeds(pair.maximum, worst.maximum) {
                pair
            } else {
                worst
            }
        }))
    }
}

/// Sums of a pair of runs in the making.
#[derive(Default)]
struct Sums {
    norms: Norms,
    squares: f64,
    count: f64,
}

impl Sums {
    fn add(&mut self, squared: f64, place: u64, time: f64) {
        self.squares += squared;
        self.count += 1.0;
        let distance = squared.sqrt();
        if exceeds(distance, self.norms.maximum) {
            self.norms.maximum = distance;
            self.norms.place = place;
            self.norms.at_s = time;
        }
    }

    /// Norms; of nothing that was compared they are no numbers.
    fn finish(mut self) -> Norms {
        self.norms.l2 = (self.squares / self.count).sqrt();
        if self.count == 0.0 {
            self.norms.maximum = f64::NAN;
        }
        self.norms
    }
}

/// Compares the particle temperatures, then every field of the snapshots.
pub(super) fn differences(
    case: &Case,
    sources: &[Source],
) -> Result<Vec<FieldDifference>, CompareError> {
    let mut list: Vec<_> = tracks(case, sources).into_iter().collect();
    list.extend(snapshots(sources, "gas.pvd", "gas", "cell")?);
    let particles = snapshots(sources, "particles.pvd", "particles", "particle")?;
    let known: Vec<String> = list.iter().map(|field| field.name.clone()).collect();
    list.extend(
        particles
            .into_iter()
            .filter(|field| !known.contains(&field.name)),
    );
    for band in &case.agreement.fields {
        match list.iter_mut().find(|field| field.name == band.field) {
            Some(field) => judge(field, band),
            None => list.push(FieldDifference {
                band: Some("not written".into()),
                verdict: Agreement::Outside,
                ..finish(&band.field, "cell", "1", Vec::new(), Spread::of([]))
            }),
        }
    }
    Ok(list)
}

/// Judges a field by a band that the case states; a band that holds already stays.
fn judge(field: &mut FieldDifference, band: &FieldBand) {
    let norms = |of: fn(&Norms) -> f64| {
        let values = field.pairs.iter().map(of);
        values.fold(
            0.0,
            |worst, one| if exceeds(one, worst) { one } else { worst },
        )
    };
    let bands = [
        ("at most", band.largest, norms(|pair| pair.maximum)),
        (
            "root mean square",
            band.root_mean_square,
            norms(|pair| pair.l2),
        ),
    ];
    let mut told: Vec<String> = field.band.take().into_iter().collect();
    let stated = bands
        .into_iter()
        .filter_map(|(what, band, found)| Some((what, band?, found)));
    for (what, band, found) in stated {
        let allowed = match band {
            ToleranceBand::Relative(share) => field.spread.allowance(share),
            ToleranceBand::Absolute(distance) => distance,
        };
        told.push(format!("{} {what}", words(band, &field.unit)));
        let multiple = if found == 0.0 { 0.0 } else { found / allowed };
        if field.verdict != Agreement::Outside {
            field.verdict = Agreement::of(Some(multiple));
        }
    }
    field.band = Some(told.join(", "));
}

/// Columns of the series over all particles: their mean is NaN where one of them has no temperature.
const MEAN: &str = "particles.temperature_mean";
const LARGEST: &str = "particles.temperature_max";

/// The temperature of each particle at all times of the series; `None` where the runs have none.
///
/// The band is the tightest that the case states for the temperature of a single particle: what it
/// allows one particle it allows each.
fn tracks(case: &Case, sources: &[Source]) -> Option<FieldDifference> {
    let runs: Vec<_> = sources
        .iter()
        .map(|source| source.series.particles())
        .collect();
    if runs.iter().any(Vec::is_empty) {
        return None;
    }
    let mut spread = Spread::NONE;
    let mut sums = pairs(sources);
    for time in common_times(sources) {
        let sound = |source: &Source| {
            // Over no particles mean and largest are NaN.
            !at(source, MEAN, time).is_nan() || at(source, LARGEST, time).is_nan()
        };
        let sound: Vec<bool> = sources.iter().map(sound).collect();
        for (place, (id, _)) in runs[0].iter().enumerate() {
            let values: Vec<f64> = sources
                .iter()
                .zip(&runs)
                .map(|(source, tracks)| {
                    let track = tracks.get(place).filter(|(other, _)| other == id);
                    let over = source.series.column("process_time");
                    track.map_or(f64::NAN, |(_, values)| between(over, values, time))
                })
                .collect();
            for &value in &values {
                spread.add(value);
            }
            let gone: Vec<bool> = values
                .iter()
                .zip(&sound)
                .map(|(value, sound)| value.is_nan() && *sound)
                .collect();
            let id = id.parse().unwrap_or(place as u64);
            add_track(&values, &gone, id, time, &mut sums);
        }
    }
    let field = finish("particles.temperature", "particle", "K", sums, spread);
    Some(judged(field, single_particle_band(case)))
}

/// A column of a run at a time; NaN where it has none.
fn at(source: &Source, column: &str, time: f64) -> f64 {
    match source.series.column(column) {
        [] => f64::NAN,
        values => between(source.series.column("process_time"), values, time),
    }
}

/// Adds the temperatures that the runs give one particle at one time, but for runs that no longer have it.
fn add_track(values: &[f64], gone: &[bool], id: u64, time: f64, sums: &mut [(usize, usize, Sums)]) {
    for (first, second, sum) in sums {
        if !(gone[*first] || gone[*second]) {
            sum.add((values[*first] - values[*second]).powi(2), id, time);
        }
    }
}

fn single_particle_band(case: &Case) -> Option<f64> {
    let bands =
        case.quantities
            .iter()
            .filter_map(|quantity| match (&quantity.measure, quantity.agree) {
                (Measure::Particle { .. }, Some(ToleranceBand::Absolute(distance))) => {
                    Some(distance)
                }
                _ => None,
            });
    bands.reduce(f64::min)
}

fn judged(mut field: FieldDifference, band: Option<f64>) -> FieldDifference {
    let worst = field.worst().map_or(0.0, |pair| pair.maximum);
    field.verdict =
        Agreement::of(band.map(|allowed| if worst == 0.0 { 0.0 } else { worst / allowed }));
    field.band = band.map(|allowed| words(ToleranceBand::Absolute(allowed), &field.unit));
    field
}

/// Every pair of runs by its two indices.
fn pairs(sources: &[Source]) -> Vec<(usize, usize, Sums)> {
    let mut list = Vec::new();
    for second in 1..sources.len() {
        for first in 0..second {
            let runs = [first, second].map(|place| sources[place].name.clone());
            let norms = Norms {
                runs,
                ..Norms::default()
            };
            list.push((
                first,
                second,
                Sums {
                    norms,
                    ..Sums::default()
                },
            ));
        }
    }
    list
}

fn finish(
    name: &str,
    per: &'static str,
    unit: &str,
    sums: Vec<(usize, usize, Sums)>,
    spread: Spread,
) -> FieldDifference {
    FieldDifference {
        name: name.into(),
        per,
        unit: unit.into(),
        pairs: sums.into_iter().map(|(_, _, sum)| sum.finish()).collect(),
        span: spread.span(),
        spread,
        band: None,
        verdict: Agreement::None,
    }
}

/// Every field of the snapshots of a collection that all runs hold, the start left out.
fn snapshots(
    sources: &[Source],
    collection: &str,
    group: &str,
    per: &'static str,
) -> Result<Vec<FieldDifference>, CompareError> {
    let lists = sources
        .iter()
        .map(|source| read::collection(&source.directory, collection))
        .collect::<Result<Vec<_>, _>>()?;
    let mut found: Vec<Found> = Vec::new();
    let count = lists.iter().map(Vec::len).min().unwrap_or(0);
    for number in 1..count {
        let time = lists[0][number].0;
        if lists.iter().any(|list| list[number].0 != time) {
            break;
        }
        let arrays = lists
            .iter()
            .map(|list| read::arrays(&list[number].1))
            .collect::<Result<Vec<_>, _>>()?;
        let arrays = match per {
            "particle" => common::rows_alike(common::particles(arrays)),
            _ => arrays,
        };
        let held_by_all = |name: &&String| arrays.iter().all(|own| own.contains_key(*name));
        let fields = arrays[0].keys().filter(held_by_all);
        for name in fields.filter(|name| read::is_field(name) && *name != "radius") {
            let place = match found.iter().position(|field| field.name == *name) {
                Some(place) => place,
                None => {
                    found.push(Found {
                        name: name.clone(),
                        sums: pairs(sources),
                        spread: Spread::NONE,
                    });
                    found.len() - 1
                }
            };
            add(sources, &arrays, time, &mut found[place])?;
        }
    }
    let named = |field: Found| {
        let name = format!("{group}.{}", field.name);
        finish(&name, per, unit(&field.name), field.sums, field.spread)
    };
    // Of rows whose lengths differ in all places nothing is compared.
    let compared = |field: &Found| field.sums.iter().all(|one| one.2.count > 0.0);
    Ok(found.into_iter().filter(compared).map(named).collect())
}

/// A field of the snapshots in the making.
struct Found {
    name: String,
    sums: Vec<(usize, usize, Sums)>,
    /// Of the values so far.
    spread: Spread,
}

/// Adds one snapshot of all runs to a field.
fn add(
    sources: &[Source],
    arrays: &[Arrays],
    time: f64,
    field: &mut Found,
) -> Result<(), CompareError> {
    let Found { name, sums, spread } = field;
    let reference = &arrays[0][name.as_str()];
    let ids = arrays[0].get("id").map(|array| &array.values);
    let mut lists = Vec::new();
    for (source, other) in sources.iter().zip(arrays) {
        let values = other
            .get(name.as_str())
            .map_or(&[][..], |array| &array.values);
        if values.len() != reference.values.len() {
            return Err(CompareError::Shape {
                field: name.clone(),
                run: source.name.clone(),
                found: values.len(),
                reference: sources[0].name.clone(),
                expected: reference.values.len(),
            });
        }
        for &value in values {
            spread.add(value);
        }
        lists.push(values);
    }
    let width = reference.components.max(1);
    // Of rows of any length what neither has is no number in both.
    let ragged = arrays[0].contains_key(&lengths_of(name));
    let neither = |(a, b): &(&f64, &f64)| ragged && a.is_nan() && b.is_nan();
    for (first, second, sum) in sums {
        let rows = lists[*first]
            .chunks(width)
            .zip(lists[*second].chunks(width));
        for (place, (a, b)) in rows.enumerate() {
            let held = a.iter().zip(b).filter(|pair| !neither(pair));
            let squares: Vec<f64> = held.map(|(a, b)| (a - b).powi(2)).collect();
            if ragged && squares.is_empty() {
                continue;
            }
            let squared = squares.iter().sum();
            let id = ids
                .and_then(|ids| ids.get(place))
                .map_or(place as u64, |&id| id as u64);
            sum.add(squared, id, time);
        }
    }
    Ok(())
}

fn unit(field: &str) -> &'static str {
    match field {
        "temperature" => "K",
        "velocity" | "slip" => "m/s",
        "pressure" => "Pa",
        "density" => "kg/m^3",
        "heat" => "W",
        "force" => "N",
        "turbulent_energy" => "m^2/s^2",
        "dissipation" => "m^2/s^3",
        "eddy_viscosity" => "Pa s",
        _ => "1",
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_field_is_judged_by_its_largest_difference_and_by_its_mean_square() {
        let norms = |maximum: f64, l2: f64| Norms {
            maximum,
            l2,
            ..Norms::default()
        };
        let judged = |largest, root_mean_square| {
            let mut field = finish(
                "gas.temperature",
                "cell",
                "K",
                Vec::new(),
                Spread::of([300.0, 400.0]),
            );
            field.pairs = vec![norms(1.0, 0.5), norms(4.0, 0.1)];
            let band = FieldBand {
                field: field.name.clone(),
                largest,
                root_mean_square,
            };
            judge(&mut field, &band);
            (field.verdict, field.band.unwrap())
        };
        let (relative, absolute) = (ToleranceBand::Relative, ToleranceBand::Absolute);
        assert_eq!(
            judged(Some(absolute(4.0)), Some(relative(0.005))),
            (
                Agreement::Inside,
                "4 K at most, 0.5 % root mean square".into()
            )
        );
        assert_eq!(judged(Some(relative(0.03)), None).0, Agreement::Outside);
        assert_eq!(
            judged(Some(absolute(5.0)), Some(absolute(0.4))).0,
            Agreement::Outside
        );
    }

    #[test]
    fn a_particle_that_one_run_no_longer_has_is_not_compared_there() {
        let there = [false; 3];
        let mut sums = vec![(0, 1, Sums::default()), (0, 2, Sums::default())];
        add_track(&[300.0, 303.0, 300.5], &there, 7, 1.0, &mut sums);
        let gone = [false, true, false];
        add_track(&[400.0, f64::NAN, 401.0], &gone, 7, 2.0, &mut sums);
        let norms: Vec<Norms> = sums.into_iter().map(|(_, _, sum)| sum.finish()).collect();
        assert_eq!((norms[0].maximum, norms[0].at_s), (3.0, 1.0));
        assert_eq!(norms[0].l2, 3.0);
        assert_eq!((norms[1].maximum, norms[1].at_s), (1.0, 2.0));
        // One that is there without a temperature agrees with nothing.
        let mut sums = vec![(0, 1, Sums::default())];
        add_track(&[300.0, f64::NAN], &there[..2], 7, 1.0, &mut sums);
        assert!(sums.remove(0).2.finish().maximum.is_nan());
        let nothing = Sums::default().finish();
        assert!(nothing.maximum.is_nan() && nothing.l2.is_nan());
    }
}
