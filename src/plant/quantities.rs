//! Quantities of interest of a plant, and their verdicts.

use std::collections::BTreeMap;

use super::files::TimeTable;
use super::measure::Column;
use super::summary::{PlantContinuationSummary, PlantSteadySummary};
use crate::case::plant::{
    LimitField, OverTime, PlantCase, PlantMeasure, PlantQuantity, SteadyField,
};
use crate::results::Verdict;
use crate::results::quantities::allowance;
use crate::results::summary::QuantityResult;

/// What quantities are measured on.
pub(super) struct Measured<'a> {
    /// The series.
    pub series: &'a TimeTable,
    /// Its columns.
    pub columns: &'a [Column],
    /// The steady state.
    pub steady: Option<&'a PlantSteadySummary>,
    /// Steady states over a key.
    pub continuation: Option<&'a PlantContinuationSummary>,
}

/// All quantities by name, at the time `at` in s; `complete`: at the end of the run.
pub(super) fn results(
    case: &PlantCase,
    on: &Measured<'_>,
    at: f64,
    complete: bool,
) -> BTreeMap<String, QuantityResult> {
    let result = |quantity: &PlantQuantity| {
        let value = evaluate(&quantity.measure, on).filter(|value| value.is_finite());
        let band = quantity.expect.map(|(expected, band)| {
            let allowed = allowance(band, expected);
            (expected - allowed, expected + allowed)
        });
        let verdict = match (band, value) {
            (None, _) => Verdict::None,
            (Some(_), _) if !complete => Verdict::Running,
            (Some((low, high)), Some(value)) if (low..=high).contains(&value) => Verdict::Pass,
            _ => Verdict::Fail,
        };
        let result = QuantityResult {
            value,
            unit: quantity.unit.clone(),
            at_s: value.map(|_| at),
            band,
            expected_at_s: None,
            verdict,
        };
        (quantity.name.clone(), result)
    };
    case.quantities.iter().map(result).collect()
}

/// The verdict over all quantities of a complete run.
pub(super) fn verdict(quantities: &BTreeMap<String, QuantityResult>) -> Verdict {
    let has = |word| quantities.values().any(|one| one.verdict == word);
    match (has(Verdict::Fail), has(Verdict::Pass)) {
        (true, _) => Verdict::Fail,
        (false, true) => Verdict::Pass,
        (false, false) => Verdict::None,
    }
}

fn evaluate(measure: &PlantMeasure, on: &Measured<'_>) -> Option<f64> {
    match measure {
        PlantMeasure::OverTime {
            of,
            field,
            compound,
            over,
            from,
        } => {
            let own = |column: &&Column| {
                (column.of, column.field, column.compound) == (*of, *field, *compound)
            };
            let column = on.columns.iter().find(own)?;
            let times = on.series.times();
            let values = on.series.column(&column.name);
            let first = times.partition_point(|time| time < from);
            over_time(*over, times.get(first..)?, values.get(first..)?)
        }
        PlantMeasure::Steady(field) => {
            let steady = on.steady?;
            let mode = steady.modes.first();
            match field {
                SteadyField::Distance => Some(steady.distance),
                SteadyField::GrowthRate => mode.map(|mode| mode.growth_rate_per_s),
                SteadyField::Period => mode?.period_s,
            }
        }
        PlantMeasure::Limit(field) => {
            let limit = on.continuation?.limits.first()?;
            match field {
                LimitField::Value => Some(limit.value),
                LimitField::Period => limit.mode.period_s,
            }
        }
    }
}

/// What is taken of values over time.
fn over_time(over: OverTime, times: &[f64], values: &[f64]) -> Option<f64> {
    let last = values.last().copied()?;
    let least = values.iter().copied().fold(f64::INFINITY, f64::min);
    let most = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    Some(match over {
        OverTime::Last => last,
        OverTime::Min => least,
        OverTime::Max => most,
        OverTime::Span => most - least,
        OverTime::Mean => {
            // Over time, as rows may lie closer at the end.
            let spans = times.windows(2).zip(values.windows(2));
            let area: f64 = spans
                .map(|(t, v)| 0.5 * (t[1] - t[0]) * (v[0] + v[1]))
                .sum();
            match times.last()? - times.first()? {
                0.0 => last,
                span => area / span,
            }
        }
        OverTime::Period => return period(times, values, 0.5 * (least + most)),
    })
}

/// Mean time between upward crossings of a level, linear between rows; none of fewer than two.
fn period(times: &[f64], values: &[f64], level: f64) -> Option<f64> {
    let pairs = times.windows(2).zip(values.windows(2));
    let crossing = |(t, v): (&[f64], &[f64])| {
        let upward = v[0] < level && v[1] >= level;
        upward.then(|| t[0] + (level - v[0]) / (v[1] - v[0]) * (t[1] - t[0]))
    };
    let crossings: Vec<f64> = pairs.filter_map(crossing).collect();
    let (first, last) = (crossings.first()?, crossings.last()?);
    let count = crossings.len() - 1;
    (count > 0).then(|| (last - first) / count as f64)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_taken_of_a_sine_is_its_own() {
        let times: Vec<f64> = (0..=4000).map(f64::from).collect();
        let turn = 2.0 * std::f64::consts::PI / 321.7;
        let values: Vec<f64> = times.iter().map(|t| 3.0 + 0.4 * (turn * t).sin()).collect();
        let of = |over| over_time(over, &times, &values).unwrap();
        assert!((of(OverTime::Span) - 0.8).abs() < 1e-4);
        assert!((of(OverTime::Period) - 321.7).abs() < 1e-2);
        assert!((of(OverTime::Max) - 3.4).abs() < 1e-4);
        assert_eq!(of(OverTime::Last), values[4000]);
        assert!(over_time(OverTime::Period, &times[..100], &values[..100]).is_none());
        assert!(over_time(OverTime::Last, &[], &[]).is_none());
    }

    #[test]
    fn a_mean_is_over_time() {
        // 1 for 9 s, then a line to 3 within a second: (9 + 2)/10.
        let mean = over_time(OverTime::Mean, &[0.0, 9.0, 10.0], &[1.0, 1.0, 3.0]);
        assert!((mean.unwrap() - 1.1).abs() < 1e-15);
    }
}
