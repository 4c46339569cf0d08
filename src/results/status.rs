//! `status.json`: how far a run is, to be watched from outside; replaced atomically, at most once a
//! second.

use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use serde::Serialize;

use super::summary::Summary;
use super::{ResultsError, STATUS, files};

/// The shortest time between two replacements.
const PAUSE: Duration = Duration::from_secs(1);

/// What the file holds.
#[derive(Clone, Debug, Serialize)]
pub(super) struct Status {
    /// `running`, `stopped` before its end, or `complete`; the verdict is in the summary.
    pub state: String,
    /// Process time in s.
    pub process_time_s: f64,
    /// Process time at which the run ends, in s.
    pub process_end_s: f64,
    /// Motion time in s.
    pub motion_time_s: f64,
    /// Acceleration factor of the last window.
    pub acceleration: f64,
    /// Windows committed.
    pub windows: u64,
    /// Length of the last window in s of motion time; this and the next two `None` before there is one, and after the run.
    pub motion_window_s: Option<f64>,
    /// Largest estimated error of its step.
    pub step_error: Option<f64>,
    /// Courant number at its end, over its motion time.
    pub courant: Option<f64>,
    /// How often the window at hand was cut so far, because particles that react did not settle with their gas.
    pub cuts: u32,
    /// Length in s of process time that it was cut to; `None` where it was not.
    pub cut_to_s: Option<f64>,
    /// Share of the process time done.
    pub fraction_done: f64,
    /// Wall time left in s at the mean pace of this process; `None` before the first window.
    pub wall_time_left_s: Option<f64>,
}

/// Replaces the file, but not too often.
pub(super) struct Watch {
    path: PathBuf,
    last: Option<Instant>,
    begun: Instant,
    begun_at: f64,
}

impl Status {
    /// The status that a summary tells.
    pub fn of(summary: &Summary) -> Self {
        let begun = |step: &&(f64, f64)| step.0 <= summary.process_time_s;
        let factor = summary.acceleration.iter().rfind(begun);
        Self {
            state: summary.verdict.state().into(),
            process_time_s: summary.process_time_s,
            process_end_s: summary.process_end_s,
            motion_time_s: summary.motion_time_s,
            acceleration: factor.map_or(1.0, |step| step.1),
            windows: summary.windows,
            motion_window_s: None,
            step_error: None,
            courant: None,
            cuts: 0,
            cut_to_s: None,
            fraction_done: summary.process_time_s / summary.process_end_s,
            wall_time_left_s: None,
        }
    }
}

impl Watch {
    /// A watch over a run that stands at a process time in s.
    pub fn new(directory: &Path, process_time: f64) -> Self {
        Self {
            path: directory.join(STATUS),
            last: None,
            begun: Instant::now(),
            begun_at: process_time,
        }
    }

    /// True where the last replacement is long enough ago.
    pub fn is_due(&self) -> bool {
        self.last.is_none_or(|last| last.elapsed() >= PAUSE)
    }

    /// Wall time since this process began the run.
    pub fn elapsed(&self) -> Duration {
        self.begun.elapsed()
    }

    /// Replaces the file; fills in the time left.
    pub fn replace(&mut self, mut status: Status) -> Result<(), ResultsError> {
        let done = status.process_time_s - self.begun_at;
        let left = status.process_end_s - status.process_time_s;
        status.wall_time_left_s =
            (done > 0.0).then(|| left / done * self.begun.elapsed().as_secs_f64());
        files::replace_json(&self.path, &status)?;
        self.last = Some(Instant::now());
        Ok(())
    }

    /// Replaces the file for the last time, on a disk without room too.
    pub fn close(&mut self, status: Status) -> Result<(), ResultsError> {
        let text = files::json(&self.path, &status)?;
        self.replace(status)
            .or_else(|_| files::write_over(&self.path, text.as_bytes()))
    }
}
