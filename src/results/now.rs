//! What a run in progress has come to since it wrote its summary.

use std::path::Path;

use super::read::Series;
use super::summary::{Summary, Verdict};
use super::{ResultsError, STATUS};

impl Summary {
    /// That of a results folder, with the times, windows and quantities that a run in progress has come to since it wrote it. Wall time and ledger, which
    /// checkpoints tell, have no figures before the first.
    pub fn now(directory: &Path) -> Result<Self, ResultsError> {
        let mut summary = Self::read(directory)?;
        if summary.verdict == Verdict::Running {
            // A status that is not there yet, or is no longer, says nothing new.
            let text = std::fs::read_to_string(directory.join(STATUS)).unwrap_or_default();
            let status: serde_json::Value = serde_json::from_str(&text).unwrap_or_default();
            let time = |name: &str, before: f64| status[name].as_f64().unwrap_or(before);
            if summary.windows == 0 {
                summary.wall_time_s.total = f64::NAN;
                summary.ledger.lines.clear();
                summary.ledger.elements.clear();
            }
            summary.process_time_s = time("process_time_s", summary.process_time_s);
            summary.motion_time_s = time("motion_time_s", summary.motion_time_s);
            summary.windows = status["windows"].as_u64().unwrap_or(summary.windows);
            summary.take_quantities(directory);
        }
        Ok(summary)
    }

    /// Takes the quantities of a run in progress from the last row of its series.
    fn take_quantities(&mut self, directory: &Path) {
        let Ok(series) = Series::read(directory) else {
            return;
        };
        let at_s = series.column("process_time").last().copied();
        let latest = self.quantities.iter_mut();
        // One whose time has come keeps the value of that time.
        let open =
            latest.filter(|(_, result)| result.expected_at_s.is_none() || result.value.is_none());
        for (name, result) in open {
            let column = series.column(&format!("quantities.{name}"));
            if let Some(value) = column.last().copied().filter(|value| value.is_finite()) {
                (result.value, result.at_s) = (Some(value), at_s);
            }
        }
    }
}
