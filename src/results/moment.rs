//! The moment of a snapshot.

use calcine_coupler::observer::CommittedState;
use serde::{Deserialize, Serialize};

/// When a snapshot was taken.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct SnapshotMoment {
    /// Process time in s.
    pub process_time: f64,
    /// Motion time in s.
    pub motion_time: f64,
    /// Windows committed.
    pub windows: u64,
}

impl SnapshotMoment {
    /// That of what was committed last.
    pub fn of(moment: &CommittedState<'_>) -> Self {
        Self {
            process_time: moment.clocks.process.seconds(),
            motion_time: moment.clocks.motion.seconds(),
            windows: moment.windows,
        }
    }
}
