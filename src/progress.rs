//! What is shown while a case is made ready and while it runs: process time, acceleration factor, time left.

use std::path::Path;
use std::time::{Duration, Instant};

use calcine_coupler::observer::{CommittedState, Observer, ObserverError};
use calcine_coupler::time::Ticks;
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};

use crate::case::model::Case;

/// How often the bar is drawn.
const EVERY: Duration = Duration::from_millis(100);
/// Ticks of the bar over the whole run.
const LENGTH: u64 = 10_000;

/// Shows how far a run is, on standard error, where that is a terminal.
#[derive(Debug)]
pub struct Progress {
    bar: ProgressBar,
    end: Ticks,
    drawn: Instant,
}

impl Progress {
    /// A bar for a case; `visible` false shows nothing.
    pub fn new(case: &Case, visible: bool) -> Self {
        let target = if visible {
            ProgressDrawTarget::stderr()
        } else {
            ProgressDrawTarget::hidden()
        };
        let bar = ProgressBar::with_draw_target(Some(LENGTH), target);
        let template = "{bar:40} {percent:>3} %  {msg}  left {eta}";
        if let Ok(style) = ProgressStyle::with_template(template) {
            bar.set_style(style);
        }
        Self {
            bar,
            end: case.time.end,
            drawn: Instant::now(),
        }
    }

    fn draw(&mut self, moment: &CommittedState<'_>) {
        let done = moment.clocks.process.seconds() / self.end.seconds();
        self.bar.set_position((done * LENGTH as f64) as u64);
        let factor = moment.window.map_or(1.0, |window| window.acceleration());
        let now = moment.clocks.process.seconds();
        self.bar
            .set_message(format!("process time {now:.3} s  AF {factor:.0}"));
        self.drawn = Instant::now();
    }
}

/// Makes something of a case, and shows on standard error that it is read and its particles are placed, and for how long, where
/// that is a terminal.
pub fn preparing<T>(make: impl FnOnce() -> T) -> T {
    let bar = ProgressBar::new_spinner();
    if let Ok(style) = ProgressStyle::with_template("{spinner} {msg} {elapsed}") {
        bar.set_style(style);
    }
    bar.set_message("reading the case, placing its particles");
    bar.enable_steady_tick(EVERY);
    let made = make();
    bar.finish_and_clear();
    made
}

/// Takes the bar off the screen.
impl Drop for Progress {
    fn drop(&mut self) {
        self.bar.finish_and_clear();
    }
}

impl Observer for Progress {
    fn start(&mut self, moment: &CommittedState<'_>) -> Result<(), ObserverError> {
        self.draw(moment);
        self.bar.reset_eta();
        Ok(())
    }

    fn window(&mut self, moment: &CommittedState<'_>) -> Result<(), ObserverError> {
        if self.drawn.elapsed() >= EVERY {
            self.draw(moment);
        }
        Ok(())
    }

    fn checkpoint(&mut self, _: &CommittedState<'_>, _: &Path) -> Result<(), ObserverError> {
        Ok(())
    }

    fn finish(&mut self, moment: &CommittedState<'_>) -> Result<(), ObserverError> {
        self.draw(moment);
        Ok(())
    }
}
