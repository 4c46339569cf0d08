//! Time counters of the phases of a window.

use std::time::{Duration, Instant};

/// Up to so many cells looking at the clock takes a part of a window that counts: one window of so many is timed, for all of them.
const FEW: usize = 1000;
const SAMPLED: u32 = 8;

/// Gives the time since its last lap to a phase.
#[derive(Clone, Copy, Debug)]
pub struct Stopwatch {
    last: Option<Instant>,
    /// For how many windows a lap counts.
    windows: u32,
}

impl Stopwatch {
    /// Starts now.
    pub fn new() -> Self {
        Self {
            last: Some(Instant::now()),
            windows: 1,
        }
    }

    /// Starts now where the window of this number is timed, of a gas of so many cells.
    pub fn of_window(number: u32, cells: usize) -> Self {
        if cells > FEW {
            return Self::new();
        }
        Self {
            last: number.is_multiple_of(SAMPLED).then(Instant::now),
            windows: SAMPLED,
        }
    }

    /// Adds the time since the last lap to a phase.
    #[inline]
    pub fn lap(&mut self, phase: &mut Duration) {
        if let Some(last) = self.last {
            let now = Instant::now();
            *phase += (now - last) * self.windows;
            self.last = Some(now);
        }
    }
}
