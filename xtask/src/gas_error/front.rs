//! The front of error and processor time of a solver, and its time at a given error.

/// One run: its relative error and its processor time in s.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Point {
    pub error: f64,
    pub time: f64,
}

/// A time at an error.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum TimeAt {
    /// In s, interpolated.
    Equal(f64),
    /// The cheapest run is more accurate than asked for: in s, at most.
    AtMost(f64),
}

/// The runs of a solver of which none is better in both, by increasing time and so by decreasing error.
#[derive(Clone, Debug, PartialEq)]
pub struct Front(Vec<Point>);

impl Front {
    /// The front of runs; those whose error or time is not a number above zero are left out.
    pub fn new(points: &[Point]) -> Self {
        let usable = |point: &&Point| {
            [point.error, point.time]
                .iter()
                .all(|value| value.is_finite() && *value > 0.0)
        };
        let mut sorted: Vec<Point> = points.iter().filter(usable).copied().collect();
        sorted.sort_by(|a, b| a.time.total_cmp(&b.time).then(a.error.total_cmp(&b.error)));
        let mut front: Vec<Point> = Vec::new();
        for point in sorted {
            if front.last().is_none_or(|last| point.error < last.error) {
                front.push(point);
            }
        }
        Self(front)
    }

    /// Smallest and largest error of the front.
    pub fn errors(&self) -> Option<(f64, f64)> {
        Some((self.0.last()?.error, self.0.first()?.error))
    }

    /// The time at an error, on straight lines between the logarithms of both; nothing below the smallest error.
    pub fn time(&self, error: f64) -> Option<TimeAt> {
        let (smallest, largest) = self.errors()?;
        if error >= largest {
            return Some(TimeAt::AtMost(self.0[0].time));
        }
        if error < smallest {
            return None;
        }
        let after = self.0.partition_point(|point| point.error > error);
        let (one, other) = (self.0[after - 1], self.0[after]);
        let share = (one.error / error).ln() / (one.error / other.error).ln();
        Some(TimeAt::Equal(
            one.time * (other.time / one.time).powf(share),
        ))
    }
}

/// Errors 1, 1.5, 2, 3, 5, 7, 10, … from the smallest to the largest.
pub fn levels(smallest: f64, largest: f64) -> Vec<f64> {
    let mut levels = Vec::new();
    let mut power = smallest.log10().floor() as i32;
    while 10f64.powi(power) <= largest {
        let decade = [1.0, 1.5, 2.0, 3.0, 5.0, 7.0].map(|digit| digit * 10f64.powi(power));
        // A level at an end of the range counts in spite of rounding.
        let inside =
            |level: &f64| *level >= smallest * (1.0 - 1e-12) && *level <= largest * (1.0 + 1e-12);
        levels.extend(decade.into_iter().filter(inside));
        power += 1;
    }
    levels
}

#[cfg(test)]
mod tests {
    use super::*;

    fn point(error: f64, time: f64) -> Point {
        Point { error, time }
    }

    fn front() -> Front {
        Front::new(&[
            point(1e-3, 16.0),
            point(1e-1, 1.0),
            // Dearer and less accurate than others.
            point(0.2, 3.0),
            point(1e-2, 20.0),
            point(f64::NAN, 0.1),
        ])
    }

    #[test]
    fn a_front_leaves_out_what_others_beat_and_what_diverged() {
        assert_eq!(front().0, [point(1e-1, 1.0), point(1e-3, 16.0)]);
        assert_eq!(front().errors(), Some((1e-3, 1e-1)));
        assert_eq!(Front::new(&[]).errors(), None);
        assert_eq!(Front::new(&[]).time(1.0), None);
    }

    #[test]
    fn time_at_an_error_is_interpolated_in_logarithms() {
        let Some(TimeAt::Equal(time)) = front().time(1e-2) else {
            panic!("no time");
        };
        assert!((time - 4.0).abs() < 1e-12);
        let Some(TimeAt::Equal(time)) = front().time(1e-3) else {
            panic!("no time");
        };
        assert!((time - 16.0).abs() < 1e-9);
    }

    #[test]
    fn beyond_the_front_a_time_is_a_bound_or_unknown() {
        assert_eq!(front().time(0.5), Some(TimeAt::AtMost(1.0)));
        assert_eq!(front().time(1e-4), None);
    }

    #[test]
    fn levels_are_round_and_within_the_range() {
        let near = |levels: Vec<f64>, wanted: &[f64]| {
            assert_eq!(levels.len(), wanted.len(), "{levels:?}");
            for (level, wanted) in levels.iter().zip(wanted) {
                assert!((level / wanted - 1.0).abs() < 1e-12, "{levels:?}");
            }
        };
        near(levels(2.5e-3, 0.015), &[3e-3, 5e-3, 7e-3, 1e-2, 1.5e-2]);
        near(levels(3.5e-3, 4e-3), &[]);
    }
}
