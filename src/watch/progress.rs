//! How far a run is, in words, and the end of its log.

use std::fs::{self, File};
use std::io::{Read, Seek, SeekFrom};
use std::path::Path;
use std::time::Duration;

use serde::Serialize;
use serde_json::Value;

use crate::report::number::{figure, span};
use crate::simulation::OWN_LOG;

/// Bytes and lines of the log that are shown.
const BYTES: u64 = 20_000;
const LINES: usize = 40;
/// A file that has not changed for so long is told of.
const QUIET: Duration = Duration::from_secs(15);

/// How far a run is.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub(crate) struct Progress {
    /// `running`, `stopped`, `complete`, or `unknown` while there is no status yet.
    pub state: String,
    /// The share that is done.
    pub done: f64,
    /// Times, windows and what is left.
    pub words: String,
}

impl Progress {
    /// That of `status.json`.
    pub fn read(path: &Path) -> Self {
        let text = fs::read_to_string(path).unwrap_or_default();
        let age = fs::metadata(path).and_then(|about| about.modified());
        let age = age.ok().and_then(|at| at.elapsed().ok());
        Self::of(&serde_json::from_str(&text).unwrap_or_default(), age)
    }

    fn of(status: &Value, age: Option<Duration>) -> Self {
        let number = |names: [&str; 2]| names.iter().find_map(|name| status[*name].as_f64());
        let state = status["state"].as_str().unwrap_or("unknown").to_owned();
        let mut words = Vec::new();
        if let (Some(now), Some(end)) = (
            number(["process_time_s", "time_s"]),
            number(["process_end_s", "end_s"]),
        ) {
            words.push(format!("{} of {}", span(now), span(end)));
        }
        if let Some(windows) = status["windows"].as_u64() {
            words.push(format!("{windows} windows"));
        }
        let factor = status["acceleration"].as_f64();
        if let Some(factor) = factor.filter(|factor| *factor != 1.0) {
            words.push(format!("acceleration {}", figure(factor, 4)));
        }
        if state == "running" {
            if let Some(left) = status["wall_time_left_s"].as_f64() {
                words.push(format!("{} left", span(left)));
            }
            if let Some(cuts) = status["cuts"].as_u64().filter(|cuts| *cuts > 0) {
                let to = status["cut_to_s"].as_f64().map_or("–".into(), span);
                words.push(format!("window cut {cuts} times, to {to}"));
            }
            if let Some(age) = age.filter(|age| *age > QUIET) {
                words.push(format!("last word {} ago", span(age.as_secs() as f64)));
            }
        }
        Self {
            done: number(["fraction_done"; 2]).unwrap_or(0.0).clamp(0.0, 1.0),
            words: words.join(" · "),
            state,
        }
    }
}

/// The last lines of the log.
pub(super) fn end_of_log(directory: &Path) -> String {
    let read = || -> std::io::Result<String> {
        let mut file = File::open(directory.join("log").join(OWN_LOG))?;
        let length = file.metadata()?.len();
        file.seek(SeekFrom::Start(length.saturating_sub(BYTES)))?;
        let mut bytes = Vec::new();
        file.take(BYTES).read_to_end(&mut bytes)?;
        Ok(String::from_utf8_lossy(&bytes).into_owned())
    };
    let text = read().unwrap_or_default();
    let lines: Vec<&str> = text.lines().collect();
    lines[lines.len().saturating_sub(LINES)..].join("\n")
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::*;

    #[test]
    fn the_status_of_a_bed_and_of_a_plant_is_told_in_words() {
        let bed = json!({"state": "running", "process_time_s": 3.0, "process_end_s": 12.0, "fraction_done": 0.25,
            "windows": 30, "acceleration": 50.0, "wall_time_left_s": 90.0, "cuts": 0});
        let told = Progress::of(&bed, Some(Duration::from_secs(1)));
        assert_eq!(
            told.words,
            "3 s of 12 s · 30 windows · acceleration 50 · 90 s left"
        );
        assert_eq!((told.state.as_str(), told.done), ("running", 0.25));
        let plant =
            json!({"state": "complete", "time_s": 7200.0, "end_s": 7200.0, "fraction_done": 1.0});
        assert_eq!(Progress::of(&plant, None).words, "2 h of 2 h");
        let quiet = Progress::of(&bed, Some(Duration::from_secs(30)));
        assert!(quiet.words.ends_with("last word 30 s ago"));
        assert_eq!(Progress::of(&Value::Null, None).state, "unknown");
    }

    #[test]
    fn the_end_of_a_log_has_its_last_lines() {
        let folder = tempfile::tempdir().unwrap();
        assert_eq!(end_of_log(folder.path()), "");
        fs::create_dir(folder.path().join("log")).unwrap();
        let text: String = (0..5000).map(|line| format!("line {line}\n")).collect();
        fs::write(folder.path().join("log").join(OWN_LOG), text).unwrap();
        let end = end_of_log(folder.path());
        assert_eq!(end.lines().count(), LINES);
        assert!(end.starts_with("line 4960\n") && end.ends_with("line 4999"));
    }
}
