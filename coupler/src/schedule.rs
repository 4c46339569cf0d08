//! Values over process time.

use calcine_physics::points::linear;

/// A value over process time: (time in s, value) entries with increasing times,
/// at least one; linear in between, constant before the first and after the last.
#[derive(Clone, Debug, PartialEq)]
pub struct Schedule(pub Vec<(f64, f64)>);

impl Schedule {
    /// A constant.
    pub fn constant(value: f64) -> Self {
        Self(vec![(0.0, value)])
    }

    /// The value at a process time in s: linear between entries, constant outside them.
    pub fn at(&self, time: f64) -> f64 {
        linear(&self.0, time)
    }

    /// The mean between two process times in s, the first below the second; the value there where both are one.
    pub fn mean(&self, from: f64, to: f64) -> f64 {
        let within = |time: &f64| *time > from && *time < to;
        let times = self.0.iter().map(|entry| entry.0).filter(within);
        let (mut sum, mut last) = (0.0, (from, self.at(from)));
        for time in times.chain([to]) {
            let value = self.at(time);
            sum += 0.5 * (time - last.0) * (value + last.1);
            last = (time, value);
        }
        if to > from { sum / (to - from) } else { last.1 }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn means_follow_each_piece() {
        // 300 K to 10 s, then 10 K/s to 500 K.
        let ramp = Schedule(vec![(10.0, 300.0), (30.0, 500.0)]);
        assert_eq!(ramp.mean(0.0, 10.0), 300.0);
        assert_eq!(ramp.mean(10.0, 20.0), 350.0);
        assert_eq!(
            ramp.mean(0.0, 40.0),
            (10.0 * 300.0 + 20.0 * 400.0 + 10.0 * 500.0) / 40.0
        );
        assert_eq!(ramp.mean(20.0, 20.0), 400.0);
    }
}
