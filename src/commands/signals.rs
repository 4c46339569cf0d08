//! Interrupts of a run from outside.

use std::time::Duration;

use calcine_coupler::supervisor::Interrupts;
use signal_hook::consts::{SIGINT, SIGTERM};
use signal_hook::iterator::Signals;

use super::failure::Failure;
use crate::exit;

/// Turns Ctrl-C, SIGTERM and `--stop-after` into interrupts.
pub(super) struct SignalThread(signal_hook::iterator::Handle);

impl SignalThread {
    /// Starts the threads; they end with what this gives.
    pub(super) fn start(
        interrupts: &Interrupts,
        stop_after: Option<Duration>,
    ) -> Result<Self, Failure> {
        let mut signals = Signals::new([SIGINT, SIGTERM]).map_err(|cause| {
            Failure::new(
                exit::OTHER,
                format_args!("signals cannot be caught: {cause}"),
            )
        })?;
        let handle = signals.handle();
        let on_signal = interrupts.clone();
        std::thread::spawn(move || signals.forever().for_each(|_| on_signal.raise()));
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

impl Drop for SignalThread {
    fn drop(&mut self) {
        self.0.close();
    }
}
