//! Interrupts of a run from outside.

use std::time::Duration;

use calcine_coupler::supervisor::Interrupts;
use signal_hook::consts::{SIGHUP, SIGINT, SIGTERM};
use signal_hook::iterator::Signals;

use super::failure::Failure;
use crate::exit;
use crate::standard_error::tell_line;

/// Turns Ctrl-C, SIGTERM, SIGHUP (a terminal that closes) and `--stop-after` into interrupts. Where SIGHUP is ignored, as under
/// `nohup`, it stays so.
pub(super) struct SignalThread(signal_hook::iterator::Handle);

impl SignalThread {
    /// Starts the threads; they end with what this gives.
    pub(super) fn start(
        interrupts: &Interrupts,
        stop_after: Option<Duration>,
    ) -> Result<Self, Failure> {
        let EndSignals(mut signals) = EndSignals::catch()?;
        let handle = signals.handle();
        let on_signal = interrupts.clone();
        std::thread::spawn(move || {
            signals.forever().for_each(|_| {
                on_signal.raise();
                if on_signal.count() == 2 {
                    std::thread::spawn(end_at_once);
                }
            });
        });
        if let Some(limit) = stop_after {
            let on_time = interrupts.clone();
            std::thread::spawn(move || {
                std::thread::sleep(limit);
                if on_time.count() == 0 {
                    on_time.raise();
                }
            });
        }
        Ok(Self(handle))
    }
}

/// Ctrl-C, SIGTERM and SIGHUP, where it is not ignored.
pub(super) struct EndSignals(Signals);

impl EndSignals {
    /// Catches them from here on.
    pub(super) fn catch() -> Result<Self, Failure> {
        let mut caught = vec![SIGINT, SIGTERM];
        if !is_ignored(SIGHUP) {
            caught.push(SIGHUP);
        }
        let signals = Signals::new(caught).map_err(|cause| {
            Failure::new(
                exit::OTHER,
                format_args!("signals cannot be caught: {cause}"),
            )
        })?;
        Ok(Self(signals))
    }

    /// Returns with the first of them.
    pub(super) fn wait(mut self) {
        let _ = self.0.forever().next();
    }
}

/// How long a run that was interrupted twice may take to end by itself, its solvers with it.
const PATIENCE: Duration = Duration::from_secs(5);

/// Ends the process where the run does not.
fn end_at_once() {
    std::thread::sleep(PATIENCE);
    tell_line(
        "interrupted twice, and the run did not come to a place where it can stop: ended; `--resume` goes on from its last checkpoint",
    );
    std::process::exit(exit::INTERRUPTED.into());
}

/// True of a signal that this process was started to ignore, as Linux tells.
fn is_ignored(signal: i32) -> bool {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let mask = status.lines().find_map(|line| line.strip_prefix("SigIgn:"));
    let mask = mask.and_then(|mask| u64::from_str_radix(mask.trim(), 16).ok());
    mask.is_some_and(|mask| mask >> (signal - 1) & 1 == 1)
}

impl Drop for SignalThread {
    fn drop(&mut self) {
        self.0.close();
    }
}
