//! How far each particle of one run is from the same particle of a reference run.

use crate::report::plot::between;
use crate::results::read::Series;

/// Largest deviations over all common times.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Deviation {
    /// Id of each particle, as named in the series.
    pub id: Vec<String>,
    /// Largest deviation of each particle's temperature in K.
    pub kelvin: Vec<f64>,
    /// The same in % of the reference's span (largest minus smallest temperature of any particle
    /// at any time, the gas' inlet aside).
    pub percent: Vec<f64>,
    /// The span in K.
    pub span: f64,
}

/// Compares `run` with `reference` at the times of `run`; the reference is interpolated linearly
/// between its rows, so it should be the denser of the two. `span` in K, where it is known.
pub fn deviation(reference: &Series, run: &Series, span: Option<f64>) -> Deviation {
    let (times, base_times) = (run.column("process_time"), reference.column("process_time"));
    let base = reference.particles();
    let all = || base.iter().flat_map(|(_, values)| values.iter().copied());
    let measured = all().fold(f64::MIN, f64::max) - all().fold(f64::MAX, f64::min);
    let span = span.unwrap_or(measured);
    let mut result = Deviation {
        span,
        ..Deviation::default()
    };
    for (id, values) in run.particles() {
        let Some((_, expected)) = base.iter().find(|(other, _)| *other == id) else {
            continue;
        };
        let largest = times
            .iter()
            .zip(values)
            .filter_map(|(&time, value)| {
                Some((value - interpolate(base_times, expected, time)?).abs())
            })
            .fold(0.0, f64::max);
        result.id.push(id.to_owned());
        result.kelvin.push(largest);
        result.percent.push(100.0 * largest / span);
    }
    result
}

/// The value at a time between two rows; `None` outside the rows.
fn interpolate(times: &[f64], values: &[f64], time: f64) -> Option<f64> {
    let within = *times.first()? <= time && time <= *times.last()?;
    within.then(|| between(times, values, time))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn series(rows: &[(f64, f64)]) -> Series {
        Series {
            names: vec!["process_time".into(), "particle_temperature.1".into()],
            units: vec!["s".into(), "K".into()],
            columns: vec![
                rows.iter().map(|row| row.0).collect(),
                rows.iter().map(|row| row.1).collect(),
            ],
        }
    }

    #[test]
    fn the_reference_is_interpolated_at_the_times_of_the_run() {
        let reference = series(&[(0.0, 300.0), (2.0, 320.0), (4.0, 400.0)]);
        let run = series(&[(0.0, 300.0), (1.0, 313.0), (3.0, 360.0), (9.0, 0.0)]);
        let found = deviation(&reference, &run, None);
        assert_eq!(found.span, 100.0);
        assert!((found.kelvin[0] - 3.0).abs() < 1e-12);
        assert!((found.percent[0] - 3.0).abs() < 1e-12);
    }
}
