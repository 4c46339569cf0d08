//! Time counters of the phases of a window.

use std::time::{Duration, Instant};

/// Gives the time since its last lap to a phase.
#[derive(Clone, Copy, Debug)]
pub struct Stopwatch {
    last: Instant,
}

impl Stopwatch {
    /// Starts now.
    pub fn new() -> Self {
        Self {
            last: Instant::now(),
        }
    }

    /// Adds the time since the last lap to a phase.
    pub fn lap(&mut self, phase: &mut Duration) {
        let now = Instant::now();
        *phase += now - self.last;
        self.last = now;
    }
}
