//! The progress bar of a plant, and its `status.json`.

use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use serde::Serialize;

use crate::results::{ResultsError, STATUS, files};

/// Ticks of the bar over the whole run.
const LENGTH: u64 = 10_000;
/// The shortest time between two replacements of the file.
const PAUSE: Duration = Duration::from_secs(1);

/// `status.json`.
#[derive(Clone, Debug, Serialize)]
struct PlantStatus<'a> {
    state: &'a str,
    time_s: f64,
    end_s: f64,
    fraction_done: f64,
    wall_time_left_s: Option<f64>,
}

/// Shows how far a run is: on standard error, where that is a terminal, and in `status.json`.
pub(super) struct PlantProgress {
    bar: ProgressBar,
    path: PathBuf,
    begun: Instant,
    begun_at: f64,
    end: f64,
    last: Option<Instant>,
}

impl PlantProgress {
    /// Of a run from a time to its end in s; `visible` false shows no bar.
    pub fn new(folder: &Path, at: f64, end: f64, visible: bool) -> Self {
        let target = match visible {
            true => ProgressDrawTarget::stderr(),
            false => ProgressDrawTarget::hidden(),
        };
        let bar = ProgressBar::with_draw_target(Some(LENGTH), target);
        let template = "{bar:40} {percent:>3} %  {msg}  left {eta}";
        if let Ok(style) = ProgressStyle::with_template(template) {
            bar.set_style(style);
        }
        Self {
            bar,
            path: folder.join(STATUS),
            begun: Instant::now(),
            begun_at: at,
            end,
            last: None,
        }
    }

    /// Shows a time in s; `state` is written where it is not `running`, or where a second has passed.
    pub fn show(&mut self, time: f64, state: &str) -> Result<(), ResultsError> {
        let done = time / self.end;
        self.bar.set_position((done * LENGTH as f64) as u64);
        self.bar.set_message(format!("{time:.1} s"));
        if state == "running" && self.last.is_some_and(|last| last.elapsed() < PAUSE) {
            return Ok(());
        }
        self.last = Some(Instant::now());
        let passed = time - self.begun_at;
        let left = (self.end - time) / passed * self.begun.elapsed().as_secs_f64();
        let status = PlantStatus {
            state,
            time_s: time,
            end_s: self.end,
            fraction_done: done,
            wall_time_left_s: (passed > 0.0).then_some(left),
        };
        files::replace_json(&self.path, &status)
    }
}

/// Takes the bar off the screen.
impl Drop for PlantProgress {
    fn drop(&mut self) {
        self.bar.finish_and_clear();
    }
}
