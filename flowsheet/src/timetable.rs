//! Numbers that change with time.

use crate::PlantError;

/// A number over time in s: constant, in steps, or linear between points. Before the first point it has the first value,
/// after the last the last.
#[derive(Clone, Debug, PartialEq)]
pub struct Timetable {
    points: Vec<(f64, f64)>,
    linear: bool,
}

impl Timetable {
    /// One value at all times.
    pub fn constant(value: f64) -> Self {
        Self {
            points: vec![(0.0, value)],
            linear: false,
        }
    }

    /// A value from each time on, or straight lines between the points where `linear`.
    pub fn new(points: Vec<(f64, f64)>, linear: bool, place: &str) -> Result<Self, PlantError> {
        let refuse = |quantity, value, allowed| PlantError::Value {
            place: place.to_owned(),
            quantity,
            value,
            allowed,
        };
        if points.is_empty() {
            return Err(refuse(
                "number of points of the schedule",
                0.0,
                "give one at least",
            ));
        }
        for (time, value) in &points {
            if !time.is_finite() {
                return Err(refuse("time of the schedule", *time, "it is finite"));
            }
            if !value.is_finite() {
                return Err(refuse("value of the schedule", *value, "it is finite"));
            }
        }
        if let Some(pair) = points.windows(2).find(|pair| pair[1].0 <= pair[0].0) {
            return Err(refuse("time of the schedule", pair[1].0, "times rise"));
        }
        Ok(Self { points, linear })
    }

    /// The value at a time in s. At a step it is that after the step.
    pub fn at(&self, time: f64) -> f64 {
        let after = self.points.partition_point(|(t, _)| *t <= time);
        if after == 0 {
            return self.points[0].1;
        }
        let (t0, v0) = self.points[after - 1];
        match self.points.get(after) {
            Some((t1, v1)) if self.linear => v0 + (v1 - v0) * (time - t0) / (t1 - t0),
            _ => v0,
        }
    }

    /// The value where a span that ends at `end` and holds `time` is integrated: at a step at `end` itself, that before.
    pub fn within(&self, time: f64, end: f64) -> f64 {
        if time < end || self.linear {
            return self.at(time);
        }
        let after = self.points.partition_point(|(t, _)| *t < end);
        self.points[after.saturating_sub(1)].1
    }

    /// The first time after `time` at which the value or its slope jumps.
    pub fn next_break(&self, time: f64) -> Option<f64> {
        self.points.iter().map(|(t, _)| *t).find(|t| *t > time)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn steps_hold_and_lines_rise() {
        let points = vec![(10.0, 1.0), (20.0, 3.0)];
        let steps = Timetable::new(points.clone(), false, "test").unwrap();
        let lines = Timetable::new(points, true, "test").unwrap();
        assert_eq!([0.0, 15.0, 20.0].map(|t| steps.at(t)), [1.0, 1.0, 3.0]);
        assert_eq!([0.0, 15.0, 30.0].map(|t| lines.at(t)), [1.0, 2.0, 3.0]);
        assert_eq!(steps.within(20.0, 20.0), 1.0);
        assert_eq!(steps.next_break(10.0), Some(20.0));
        assert_eq!(steps.next_break(20.0), None);
    }

    #[test]
    fn times_that_fall_and_values_that_are_not_finite_are_refused() {
        assert!(Timetable::new(vec![(1.0, 0.0), (1.0, 2.0)], true, "test").is_err());
        assert!(Timetable::new(vec![(1.0, f64::NAN)], true, "test").is_err());
        assert!(Timetable::new(vec![], true, "test").is_err());
    }
}
