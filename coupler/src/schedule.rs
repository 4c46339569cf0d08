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
}
