//! Clocks: exact ticks, the two clocks, coupling windows and acceleration.

use std::fmt;

use thiserror::Error;

/// Time in ticks of one picosecond: exact sums, 106 days at most.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Ticks(i64);

/// A time that ticks cannot hold.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum TimeError {
    /// Not a number, or beyond the range of the clock.
    #[error("a time of {seconds:e} s does not fit the clock, which ends at 9.2e6 s (106 days)")]
    OutOfRange {
        /// The offending time in s.
        seconds: f64,
    },
    /// A window that is too short for the clock.
    #[error("a time span of {seconds} s is shorter than the clock's tick of 1e-12 s")]
    BelowTick {
        /// The offending span in s.
        seconds: f64,
    },
}

impl Ticks {
    /// The start of time.
    pub const ZERO: Ticks = Ticks(0);
    /// Ticks in one second.
    pub const PER_SECOND: f64 = 1e12;

    /// Ticks from a raw count of picoseconds.
    pub const fn new(picoseconds: i64) -> Self {
        Ticks(picoseconds)
    }

    /// The nearest tick to a time in s.
    pub fn from_seconds(seconds: f64) -> Result<Self, TimeError> {
        let ticks = (seconds * Self::PER_SECOND).round();
        // 2^63 is exactly representable; anything below it in magnitude converts without loss.
        if ticks.abs() < 9.223_372_036_854_775e18 {
            Ok(Ticks(ticks as i64))
        } else {
            Err(TimeError::OutOfRange { seconds })
        }
    }

    /// The raw count of picoseconds.
    pub const fn count(self) -> i64 {
        self.0
    }

    /// The time in s.
    pub fn seconds(self) -> f64 {
        self.0 as f64 / Self::PER_SECOND
    }

    /// The sum, or an error where the clock ends.
    pub fn checked_add(self, other: Ticks) -> Result<Ticks, TimeError> {
        self.0
            .checked_add(other.0)
            .map(Ticks)
            .ok_or(TimeError::OutOfRange {
                seconds: self.seconds() + other.seconds(),
            })
    }

    /// The difference `self − other`; saturates, which only a clock at its end can reach.
    pub const fn since(self, other: Ticks) -> Ticks {
        Ticks(self.0.saturating_sub(other.0))
    }
}

impl fmt::Display for Ticks {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} s", self.seconds())
    }
}

/// The two clocks: `motion` moves gas and particles, `process` what is inside particles.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Clocks {
    /// The motion clock t.
    pub motion: Ticks,
    /// The process clock tau, the time that users read; d tau = AF dt.
    pub process: Ticks,
}

impl Clocks {
    /// Both clocks advanced by a span.
    pub fn advanced(self, span: Clocks) -> Result<Clocks, TimeError> {
        Ok(Clocks {
            motion: self.motion.checked_add(span.motion)?,
            process: self.process.checked_add(span.process)?,
        })
    }
}

/// One coupling window. An attempt always starts from the last commit.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Window {
    /// Number of windows committed before this one.
    pub index: u64,
    /// Zero for the first attempt; repeats count up.
    pub attempt: u32,
    /// Both clocks at the start of the window.
    pub start: Clocks,
    /// How far each clock moves in the window.
    pub span: Clocks,
}

impl Window {
    /// Its span in s of process time, and the process time in s at its end.
    pub fn process_span(&self) -> [f64; 2] {
        let span = self.span.process.seconds();
        [span, self.start.process.seconds() + span]
    }

    /// The acceleration factor AF = d tau / dt of this window.
    pub fn acceleration(&self) -> f64 {
        self.span.process.seconds() / self.span.motion.seconds()
    }

    /// Both clocks at the end of the window.
    pub fn end(&self) -> Result<Clocks, TimeError> {
        self.start.advanced(self.span)
    }
}

/// Over which clock the gas stores mass, enthalpy and species (docs/theory.md, TSM-2, TSM-8).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum GasStorage {
    /// What the gas stores is stepped implicitly with the process span (AF dt).
    #[default]
    Process,
    /// The paper's form: what the gas stores is stepped with the motion span (dt), so that
    /// amounts exchanged over AF dt reach the gas divided by AF.
    Accelerated,
}

impl GasStorage {
    /// The span in s over which the gas stores in this window.
    pub fn span(self, window: &Window) -> f64 {
        match self {
            GasStorage::Process => window.span.process.seconds(),
            GasStorage::Accelerated => window.span.motion.seconds(),
        }
    }

    /// The name as users write it.
    pub fn name(self) -> &'static str {
        match self {
            GasStorage::Process => "process",
            GasStorage::Accelerated => "accelerated",
        }
    }
}

/// The acceleration factor as a step schedule over process time.
#[derive(Clone, Debug, PartialEq)]
pub struct Acceleration {
    steps: Vec<(Ticks, f64)>,
}

/// A schedule that cannot be used.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum AccelerationError {
    /// No entry at all.
    #[error("the acceleration schedule is empty")]
    Empty,
    /// The first entry does not start at zero.
    #[error("the acceleration schedule starts at {start}, not at 0 s")]
    LateStart {
        /// Time of the first entry.
        start: Ticks,
    },
    /// Times that do not increase.
    #[error("the acceleration schedule's times must increase, but {next} follows {previous}")]
    Unordered {
        /// The earlier entry.
        previous: Ticks,
        /// The entry after it.
        next: Ticks,
    },
    /// A factor below one.
    #[error("an acceleration factor of {factor} is below 1")]
    BelowOne {
        /// The offending factor.
        factor: f64,
    },
}

impl Acceleration {
    /// The same factor for the whole run.
    pub fn constant(factor: f64) -> Result<Self, AccelerationError> {
        Self::schedule(vec![(Ticks::ZERO, factor)])
    }

    /// Factors that hold from their (process) times on.
    pub fn schedule(steps: Vec<(Ticks, f64)>) -> Result<Self, AccelerationError> {
        let first = steps.first().ok_or(AccelerationError::Empty)?;
        if first.0 != Ticks::ZERO {
            return Err(AccelerationError::LateStart { start: first.0 });
        }
        for pair in steps.windows(2) {
            if pair[1].0 <= pair[0].0 {
                return Err(AccelerationError::Unordered {
                    previous: pair[0].0,
                    next: pair[1].0,
                });
            }
        }
        if let Some(&(_, factor)) = steps.iter().find(|(_, f)| !(f.is_finite() && *f >= 1.0)) {
            return Err(AccelerationError::BelowOne { factor });
        }
        Ok(Self { steps })
    }

    /// The entries: process time from which a factor holds, and the factor.
    pub fn steps(&self) -> &[(Ticks, f64)] {
        &self.steps
    }

    /// The largest factor.
    pub fn largest(&self) -> f64 {
        self.steps
            .iter()
            .map(|&(_, factor)| factor)
            .fold(1.0, f64::max)
    }

    /// The factor at a process time and the time at which it next changes.
    pub fn at(&self, process: Ticks) -> (f64, Option<Ticks>) {
        let next = self.steps.partition_point(|&(from, _)| from <= process);
        (
            self.steps[next.saturating_sub(1)].1,
            self.steps.get(next).map(|step| step.0),
        )
    }

    /// The span of the window that starts at `clocks`: `motion_window` long on the motion clock,
    /// shortened where the schedule changes or the run ends (`end`, process time).
    pub fn span(
        &self,
        clocks: Clocks,
        motion_window: Ticks,
        end: Ticks,
    ) -> Result<Clocks, TimeError> {
        let (factor, change) = self.at(clocks.process);
        let full = Ticks::from_seconds(motion_window.seconds() * factor)?;
        let limit = change
            .map_or(end, |time| time.min(end))
            .since(clocks.process);
        if full <= limit {
            return Ok(Clocks {
                motion: motion_window,
                process: full,
            });
        }
        let motion = Ticks::from_seconds(limit.seconds() / factor)?;
        if motion == Ticks::ZERO {
            return Err(TimeError::BelowTick {
                seconds: limit.seconds() / factor,
            });
        }
        Ok(Clocks {
            motion,
            process: limit,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn seconds(value: f64) -> Ticks {
        Ticks::from_seconds(value).unwrap()
    }

    #[test]
    fn a_million_windows_of_a_tenth_of_a_millisecond_sum_to_exactly_a_hundred_seconds() {
        let mut time = Ticks::ZERO;
        for _ in 0..1_000_000 {
            time = time.checked_add(seconds(1e-4)).unwrap();
        }
        assert_eq!(time, seconds(100.0));
    }

    #[test]
    fn a_time_beyond_the_clock_is_an_error() {
        assert!(matches!(
            Ticks::from_seconds(1e7),
            Err(TimeError::OutOfRange { .. })
        ));
        assert!(matches!(
            Ticks::from_seconds(f64::NAN),
            Err(TimeError::OutOfRange { .. })
        ));
        assert!(Ticks::new(i64::MAX).checked_add(Ticks::new(1)).is_err());
    }

    #[test]
    fn a_window_ends_where_the_schedule_changes_and_where_the_run_ends() {
        let schedule =
            Acceleration::schedule(vec![(Ticks::ZERO, 1.0), (seconds(0.0105), 50.0)]).unwrap();
        let mut clocks = Clocks::default();
        let end = seconds(1.0);
        let mut spans = Vec::new();
        while clocks.process < end {
            let span = schedule.span(clocks, seconds(0.001), end).unwrap();
            clocks = clocks.advanced(span).unwrap();
            spans.push(span);
        }
        assert_eq!(clocks.process, end);
        assert_eq!(spans[10].motion, seconds(0.0005));
        assert_eq!(spans[11].process, seconds(0.05));
        assert_eq!(spans.len(), 11 + 20);
        let window = Window {
            span: spans[11],
            ..Window::default()
        };
        assert_eq!(window.acceleration(), 50.0);
        assert_eq!(GasStorage::Process.span(&window), 0.05);
        assert_eq!(GasStorage::Accelerated.span(&window), 0.001);
    }

    #[test]
    fn a_schedule_that_cannot_hold_is_refused() {
        assert_eq!(
            Acceleration::schedule(vec![]),
            Err(AccelerationError::Empty)
        );
        assert!(Acceleration::constant(0.5).is_err());
        assert!(Acceleration::constant(f64::NAN).is_err());
        assert!(Acceleration::schedule(vec![(seconds(1.0), 1.0)]).is_err());
        assert!(Acceleration::schedule(vec![(Ticks::ZERO, 1.0), (Ticks::ZERO, 2.0)]).is_err());
    }
}
