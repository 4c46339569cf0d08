//! A run in progress as a page in the browser: its report, with progress and the end of its log, served on this machine
//! only.

mod http;
mod progress;

use std::collections::hash_map::DefaultHasher;
use std::fs;
use std::hash::{Hash, Hasher};
use std::io;
use std::net::{Ipv4Addr, SocketAddr, TcpListener};
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};

use serde::Serialize;

use self::http::{Answer, Body, answer};
pub(crate) use self::progress::Progress;
use self::progress::end_of_log;
use crate::report::links::LINKED;
use crate::report::page::escape;
use crate::results::{ResultsError, SERIES, STATUS, SUMMARY};

const SCRIPT: &str = include_str!("live.js");
const STYLE: &str = include_str!("live.css");
const SECTION: &str = include_str!("live.html");
/// The shortest time between two makings of the page, and how much longer than one takes.
const PAUSE: Duration = Duration::from_secs(4);
const PATIENCE: u32 = 10;

/// Writes the report of a results folder; gives its path.
pub type ReportWriter = fn(&Path) -> Result<PathBuf, ResultsError>;

/// A page that was made.
struct Made {
    stamp: u64,
    took: Duration,
    at: Instant,
    text: String,
}

/// A results folder that is watched.
pub struct WatchedRun {
    directory: PathBuf,
    report: ReportWriter,
    made: Mutex<Option<Made>>,
}

/// What the page asks for every other second.
#[derive(Debug, Serialize)]
struct Live {
    #[serde(flatten)]
    progress: Progress,
    log: String,
    /// Changes with the results.
    stamp: String,
    /// So many s to wait before the page is asked for again.
    pause: f64,
}

impl WatchedRun {
    /// A folder that holds the results of a run; `report` writes its page.
    pub fn new(directory: &Path, report: ReportWriter) -> Result<Self, ResultsError> {
        crate::results::must_hold_run(directory)?;
        Ok(Self {
            directory: directory.to_owned(),
            report,
            made: Mutex::new(None),
        })
    }

    /// Serves the page on 127.0.0.1 from a thread of its own until the process ends; port 0 takes a free one. Gives the
    /// address.
    pub fn serve(self, port: u16) -> io::Result<SocketAddr> {
        let listener = TcpListener::bind((Ipv4Addr::LOCALHOST, port))?;
        let address = listener.local_addr()?;
        let watched = Arc::new(self);
        std::thread::spawn(move || {
            for stream in listener.incoming().flatten() {
                let watched = Arc::clone(&watched);
                std::thread::spawn(move || {
                    // One who goes away before the end is no error.
                    let _ = answer(stream, address.port(), |path| watched.find(path));
                });
            }
        });
        Ok(address)
    }

    fn find(&self, path: &str) -> Answer {
        match path {
            "/" | "/index.html" => Answer::ok("text/html; charset=utf-8", Body::Text(self.page())),
            "/live.json" => {
                let live = serde_json::to_string(&self.live()).unwrap_or_default();
                Answer::ok("application/json", Body::Text(live))
            }
            _ => {
                let linked = LINKED.iter().map(|(file, _)| *file);
                let mut linked = linked.filter(|file| path.strip_prefix('/') == Some(file));
                match linked.next().map(|file| self.directory.join(file)) {
                    Some(file) if file.is_file() => {
                        Answer::ok(http::kind_of(&file), Body::File(file))
                    }
                    _ => Answer::missing(),
                }
            }
        }
    }

    /// Changes with the files that the page is made of.
    fn stamp(&self) -> u64 {
        let mut hasher = DefaultHasher::new();
        for name in [SERIES, SUMMARY, "particles.pvd"] {
            if let Ok(about) = fs::metadata(self.directory.join(name)) {
                about.len().hash(&mut hasher);
                about.modified().ok().hash(&mut hasher);
            }
        }
        hasher.finish()
    }

    fn live(&self) -> Live {
        let made = self.made.lock().unwrap_or_else(PoisonError::into_inner);
        let took = made.as_ref().map_or(Duration::ZERO, |made| made.took);
        Live {
            progress: Progress::read(&self.directory.join(STATUS)),
            log: end_of_log(&self.directory),
            stamp: format!("{:x}", self.stamp()),
            pause: (took * PATIENCE).max(PAUSE).as_secs_f64(),
        }
    }

    /// The page as it was made last, where nothing has changed since or that was a moment ago; else anew.
    fn page(&self) -> String {
        let stamp = self.stamp();
        let mut made = self.made.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(made) = &*made {
            let fresh = made.at.elapsed() < PAUSE.max(made.took * PATIENCE);
            if made.stamp == stamp || fresh {
                return made.text.clone();
            }
        }
        let begun = Instant::now();
        let written = (self.report)(&self.directory);
        let text = written.and_then(|path| crate::results::files::read(&path));
        let text = match (text, &*made) {
            (Ok(text), _) => alive(&text, stamp),
            // A file that is being replaced is there a moment later.
            (Err(_), Some(made)) => return made.text.clone(),
            (Err(error), None) => alive(&bare(&error), stamp),
        };
        let page = text.clone();
        *made = Some(Made {
            stamp,
            took: begun.elapsed(),
            at: Instant::now(),
            text,
        });
        page
    }
}

/// A page that says why there is no report yet.
fn bare(error: &ResultsError) -> String {
    let text = escape(&error.to_string());
    format!(
        "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><title>calcine watch</title></head>\
         <body><main><header></header><section><h2>No report yet</h2><p>{text}</p></section></main></body></html>\n"
    )
}

/// A report with what makes it live.
fn alive(report: &str, stamp: u64) -> String {
    let section = SECTION.trim_end().replace("STAMP", &format!("{stamp:x}"));
    report
        .replacen("</head>", &format!("<style>{STYLE}</style></head>"), 1)
        .replacen("</header>", &format!("</header>{section}"), 1)
        .replacen("</body>", &format!("<script>{SCRIPT}</script></body>"), 1)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_folder_without_a_run_is_refused_with_what_to_do() {
        let folder = tempfile::tempdir().unwrap();
        let refused = WatchedRun::new(folder.path(), |path| Ok(path.to_owned()));
        let error = refused.err().unwrap();
        assert!(
            error.to_string().contains("it holds no summary.json"),
            "{error}"
        );
        let absent = WatchedRun::new(&folder.path().join("no"), |path| Ok(path.to_owned()));
        let error = absent.err().unwrap().to_string();
        assert!(error.contains("there is no such folder"), "{error}");
    }

    #[test]
    fn a_report_is_made_live_once() {
        let report = "<html><head></head><body><main><header></header><p></p></main></body></html>";
        let page = alive(report, 255);
        for part in [
            "<section id=\"live\" data-stamp=\"ff\">",
            "<style>",
            "<script>",
        ] {
            assert_eq!(page.matches(part).count(), 1, "{part}");
        }
    }
}
