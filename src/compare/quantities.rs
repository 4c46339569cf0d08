//! Differences of the quantities of interest between runs.

use serde::Serialize;

use super::agreement::Agreement;
use super::source::Source;
use super::spread::Spread;
use crate::case::model::{Case, Quantity, ToleranceBand};
use crate::report::number::{figure, span, with_unit};
use crate::report::plot::between;
use crate::results::quantities::allowance;

/// A difference at its time.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Extreme {
    /// Largest minus smallest value over the runs, in the quantity's unit.
    pub difference: f64,
    /// Process time in s.
    pub at_s: f64,
}

/// How far the runs differ in one quantity.
#[derive(Clone, Debug, Serialize)]
pub struct QuantityDifference {
    /// Name of the quantity.
    pub name: String,
    /// Its unit.
    pub unit: String,
    /// Value at the end in each run, in the order of the runs.
    pub end_values: Vec<f64>,
    /// The largest difference over all times; the start counts not, nothing is computed yet.
    pub largest: Extreme,
    /// The difference at the end.
    pub end: Extreme,
    /// Largest minus smallest value over all runs and times, zero where that is round-off.
    pub span: f64,
    /// The allowed difference in words, if the case states one.
    pub band: Option<String>,
    /// The largest multiple of the allowed difference over the times that the band is for; 1 and below is
    /// inside.
    pub multiple: Option<f64>,
    /// Whether the band holds at all those times.
    pub verdict: Agreement,
}

/// Compares every quantity of the case at the times of the first run that all runs reached.
pub(super) fn differences(case: &Case, sources: &[Source]) -> Vec<QuantityDifference> {
    let compared = |quantity| difference(quantity, sources);
    case.quantities.iter().map(compared).collect()
}

fn difference(quantity: &Quantity, sources: &[Source]) -> QuantityDifference {
    let column = format!("quantities.{}", quantity.name);
    let mut all = Spread::NONE;
    let mut largest = Extreme {
        difference: 0.0,
        at_s: 0.0,
    };
    let mut end = largest;
    let mut end_values = Vec::new();
    let mut multiple = None;
    // Means over a time begin when it has passed; where a run is shorter, with its end.
    let times = common_times(sources);
    let first = quantity
        .agree_over
        .min(times.last().copied().unwrap_or(0.0));
    for time in times
        .into_iter()
        .filter(|time| *time >= first * (1.0 - 1e-9))
    {
        let values: Vec<f64> = sources
            .iter()
            .map(|source| {
                let series = &source.series;
                let columns = (series.column("process_time"), series.column(&column));
                value(columns, time, quantity.agree_over)
            })
            .collect();
        let (low, high) = extremes(&values);
        all.add(low);
        all.add(high);
        end = Extreme {
            difference: high - low,
            at_s: time,
        };
        if exceeds(end.difference, largest.difference) {
            largest = end;
        }
        let due = time >= quantity.agree_from;
        if let (true, Some(band)) = (due, quantity.agree) {
            let so_far = multiple.get_or_insert(0.0);
            let allowed = allowance(band, 0.5 * (low + high));
            let here = if end.difference == 0.0 {
                0.0
            } else {
                end.difference / allowed
            };
            if exceeds(here, *so_far) {
                *so_far = here;
            }
        }
        end_values = values;
    }
    QuantityDifference {
        name: quantity.name.clone(),
        unit: quantity.unit.into(),
        end_values,
        largest,
        end,
        span: all.span(),
        band: quantity.agree.map(|band| {
            let band = words(band, quantity.unit);
            match quantity.agree_from {
                0.0 => band,
                from => format!("{band} from {} on", span(from)),
            }
        }),
        multiple,
        verdict: Agreement::of(multiple),
    }
}

/// The value at a time, or the mean of all that were recorded in a time before it.
fn value((times, values): (&[f64], &[f64]), time: f64, over: f64) -> f64 {
    if over == 0.0 {
        return between(times, values, time);
    }
    let slack = 1e-9 * time;
    let within = |at: f64| at > time - over + slack && at <= time + slack;
    let all: Vec<f64> = times
        .iter()
        .zip(values)
        .filter(|(at, _)| within(**at))
        .map(|(_, value)| *value)
        .collect();
    all.iter().sum::<f64>() / all.len() as f64
}

/// True where a difference is larger than the largest so far; one that is not a number (a run has
/// no value) is larger than any.
pub(super) fn exceeds(difference: f64, largest: f64) -> bool {
    difference.is_nan() || difference > largest
}

/// The times of the first run after its start, as far as every run came.
pub(super) fn common_times(sources: &[Source]) -> Vec<f64> {
    let column = |source: &Source| source.series.column("process_time").to_vec();
    let ends = sources
        .iter()
        .map(|source| column(source).last().copied().unwrap_or(0.0));
    let end = ends.fold(f64::INFINITY, f64::min);
    let times = sources.first().map(column).unwrap_or_default();
    times
        .into_iter()
        .filter(|&time| time > 0.0 && time <= end)
        .collect()
}

/// Smallest and largest value; NaN if one is.
pub(super) fn extremes(values: &[f64]) -> (f64, f64) {
    if values.iter().any(|value| value.is_nan()) {
        return (f64::NAN, f64::NAN);
    }
    values
        .iter()
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), &value| {
            (low.min(value), high.max(value))
        })
}

/// A band in words.
pub(super) fn words(band: ToleranceBand, unit: &str) -> String {
    match band {
        ToleranceBand::Relative(share) => format!("{} %", figure(100.0 * share, 3)),
        ToleranceBand::Absolute(distance) => with_unit(distance, 3, unit),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bands_read_as_other_numbers_do() {
        assert_eq!(words(ToleranceBand::Relative(0.07), "K"), "7 %");
        assert_eq!(
            words(ToleranceBand::Absolute(1.5f64.to_radians()), "rad"),
            "0.0262 rad"
        );
        assert_eq!(words(ToleranceBand::Absolute(0.01), "1"), "0.01");
    }

    #[test]
    fn a_mean_is_over_what_was_recorded_in_the_time_before() {
        let columns = (&[0.0, 0.1, 0.2, 0.3][..], &[9.0, 1.0, 2.0, 4.0][..]);
        assert_eq!(value(columns, 0.3, 0.0), 4.0);
        assert_eq!(value(columns, 0.3, 0.2), 3.0);
        assert_eq!(value(columns, 0.2, 0.2), 1.5);
        assert!((value(columns, 0.3, 0.3) - 7.0 / 3.0).abs() < 1e-15);
    }
}
