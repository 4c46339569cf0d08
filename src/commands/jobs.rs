//! Runs of one case with several settings, each a process of its own, so many at once.

use std::io::{ErrorKind, IsTerminal, Read, Write};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, ExitStatus, Stdio};
use std::thread::{self, JoinHandle};
use std::time::{Duration, Instant};

use calcine_coupler::supervisor::Interrupts;
use rustix::process::{Pid, Signal, kill_process};
use serde::{Deserialize, Serialize};

use super::failure::Failure;
use super::signals::SignalThread;
use crate::exit;
use crate::results::{ResultsError, STATUS, SUMMARY, files};
use crate::simulation::begun_before;
use crate::watch::Progress;

/// How often runs are looked at, and how often is told how far those are that go on side by side.
const LOOK: Duration = Duration::from_millis(20);
const TELL: Duration = Duration::from_secs(15);

/// One run.
#[derive(Clone, Debug)]
pub(super) struct Job {
    /// `key=value` of each key that is set.
    pub(super) settings: Vec<String>,
    /// Its results folder.
    pub(super) folder: PathBuf,
}

/// Folder of what runs that failed said, beside their folders.
const FAILED: &str = "failed";

impl Job {
    /// How far it is, as its results tell.
    pub(super) fn progress(&self) -> Progress {
        Progress::read(&self.folder.join(STATUS))
    }

    /// The file that says how it failed.
    fn record(&self) -> Option<PathBuf> {
        let name = self.folder.file_name()?.to_str()?;
        let folder = self.folder.parent()?.join(FAILED);
        Some(folder.join(format!("{name}.json")))
    }

    /// How it failed, as that was kept.
    pub(super) fn kept_failure(&self) -> Option<JobEnd> {
        let text = std::fs::read_to_string(self.record()?).ok()?;
        serde_json::from_str(&text).ok()
    }

    /// Keeps how it failed.
    fn keep(&self, end: &JobEnd) -> Result<(), ResultsError> {
        let Some(path) = self.record() else {
            return Ok(());
        };
        path.parent().map_or(Ok(()), files::directory)?;
        files::replace_json(&path, end)
    }

    /// Forgets how it failed before.
    fn forget(&self) {
        if let Some(path) = self.record() {
            // Of most there is none.
            let _ = std::fs::remove_file(path);
        }
    }
}

/// How a run ended.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(super) struct JobEnd {
    /// Exit code.
    pub(super) code: u8,
    /// What it wrote to standard error; nothing where that is a terminal with a progress bar.
    pub(super) told: String,
    /// True where that was shown at once.
    #[serde(skip)]
    pub(super) shown: bool,
}

impl JobEnd {
    /// Of a run whose results say that it came to its end.
    pub(super) fn complete(code: u8) -> Self {
        Self {
            code,
            told: String::new(),
            shown: true,
        }
    }

    /// True where it came to the end of its case.
    pub(super) fn is_complete(&self) -> bool {
        [exit::OK, exit::OUTSIDE_BANDS].contains(&self.code)
    }
}

/// What is told of runs as they go on; runs by their places in the list.
pub(super) enum JobEvent<'a> {
    /// One begins or goes on.
    Begins(usize),
    /// So many have ended, and these are under way side by side.
    UnderWay(usize, &'a [usize]),
    /// One has ended.
    Ended(usize, &'a JobEnd),
    /// One was interrupted.
    Stopped(usize, &'a JobEnd),
}

/// How runs are made.
#[derive(Debug)]
pub(super) struct Jobs<'a> {
    /// The case file.
    pub(super) case: &'a Path,
    /// Options that all have.
    pub(super) options: Vec<String>,
    /// Most of them at once.
    pub(super) at_once: usize,
    /// Shows no progress bar; of several at once none is shown.
    pub(super) quiet: bool,
}

/// A run under way.
struct Running {
    place: usize,
    child: Child,
    told: Option<JoinHandle<String>>,
    shown: bool,
}

impl Jobs<'_> {
    /// Follows all runs to their ends, and tells of them. One that came to its end before is kept, one that was begun goes on,
    /// and one that fails ends no other. An interrupt has each leave a checkpoint, and is an error.
    pub(super) fn follow(
        &self,
        jobs: &[Job],
        mut told: impl FnMut(JobEvent<'_>) -> Result<(), Failure>,
    ) -> Result<Vec<JobEnd>, Failure> {
        let interrupts = Interrupts::default();
        let _signals = SignalThread::start(&interrupts, None)?;
        let mut ends: Vec<Option<JobEnd>> = vec![None; jobs.len()];
        let mut running: Vec<Running> = Vec::new();
        let (mut next, mut passed_on) = (0, 0);
        let mut last_told = Instant::now();
        while next < jobs.len() || !running.is_empty() {
            let count = interrupts.count();
            if count > passed_on {
                passed_on = count;
                running.iter().for_each(|one| stop(&one.child));
            }
            if count > 0 && running.is_empty() {
                break;
            }
            while count == 0 && running.len() < self.at_once && next < jobs.len() {
                told(JobEvent::Begins(next))?;
                running.push(self.start(next, &jobs[next])?);
                next += 1;
            }
            let mut going = Vec::new();
            for mut one in running {
                let Some(status) = one.child.try_wait().map_err(|cause| unheard(&cause))? else {
                    going.push(one);
                    continue;
                };
                let end = JobEnd {
                    code: code_of(status),
                    told: one
                        .told
                        .map_or(String::new(), |told| told.join().unwrap_or_default()),
                    shown: one.shown,
                };
                if end.code != exit::CHECKPOINTED {
                    if !end.is_complete() {
                        let kept = jobs[one.place].keep(&end);
                        kept.map_err(|error| Failure::told(exit::OTHER, &error))?;
                    }
                    told(JobEvent::Ended(one.place, &end))?;
                } else {
                    told(JobEvent::Stopped(one.place, &end))?;
                }
                ends[one.place] = Some(end);
            }
            running = going;
            if self.at_once > 1 && !running.is_empty() && last_told.elapsed() >= TELL {
                last_told = Instant::now();
                let places: Vec<usize> = running.iter().map(|one| one.place).collect();
                told(JobEvent::UnderWay(ended(&ends), &places))?;
            }
            thread::sleep(LOOK);
        }
        let whole = ended(&ends);
        if whole < jobs.len() {
            let message = format!(
                "stopped: {whole} of {} runs have ended; the same command keeps them and goes on with the others",
                jobs.len()
            );
            return Err(Failure::new(exit::CHECKPOINTED, message));
        }
        Ok(ends.into_iter().flatten().collect())
    }

    fn start(&self, place: usize, job: &Job) -> Result<Running, Failure> {
        let program = std::env::current_exe().map_err(|cause| unheard(&cause))?;
        let alone = self.at_once == 1;
        let mut command = Command::new(program);
        command.arg("run").arg(self.case).arg("--with-parent");
        command.args(&self.options).arg("--out").arg(&job.folder);
        for setting in &job.settings {
            command.args(["--set", setting]);
        }
        if self.quiet || !alone {
            command.arg("--quiet");
        }
        // A run that came to its end says so and ends.
        if begun_before(&job.folder) || job.folder.join(SUMMARY).exists() {
            command.arg("--resume");
        }
        job.forget();
        command.stdin(Stdio::null()).stdout(Stdio::null());
        // A progress bar is drawn on a terminal only.
        let bar = alone && !self.quiet && std::io::stderr().is_terminal();
        command.stderr(if bar {
            Stdio::inherit()
        } else {
            Stdio::piped()
        });
        // In a group of its own: Ctrl-C comes to it by way of this process, once.
        std::os::unix::process::CommandExt::process_group(&mut command, 0);
        let mut child = command.spawn().map_err(|cause| unheard(&cause))?;
        let stderr = child.stderr.take();
        // Of which run it speaks is told where it begins, or before it is shown.
        let shown = alone && !self.quiet;
        let told = stderr.map(|stderr| thread::spawn(move || listen(stderr, shown)));
        Ok(Running {
            place,
            child,
            told,
            shown: shown || bar,
        })
    }
}

/// How many have ended, interrupted ones not counted.
fn ended(ends: &[Option<JobEnd>]) -> usize {
    let ends = ends.iter().flatten();
    ends.filter(|end| end.code != exit::CHECKPOINTED).count()
}

/// All that a run says; shown at once where it is the only one.
fn listen(mut from: impl Read, show: bool) -> String {
    let (mut text, mut part) = (Vec::new(), [0; 4096]);
    // What could be read is what there is to tell.
    loop {
        let count = match from.read(&mut part) {
            Ok(0) => break,
            Ok(count) => count,
            Err(error) if error.kind() == ErrorKind::Interrupted => continue,
            Err(_) => break,
        };
        text.extend_from_slice(&part[..count]);
        if show {
            // Standard error may be lost.
            let _ = std::io::stderr().write_all(&part[..count]);
        }
    }
    String::from_utf8_lossy(&text).into_owned()
}

/// Has a run leave a checkpoint.
fn stop(child: &Child) {
    let id = i32::try_from(child.id()).ok().and_then(Pid::from_raw);
    if let Some(id) = id {
        // One that has ended meanwhile needs none.
        let _ = kill_process(id, Signal::TERM);
    }
}

fn code_of(status: ExitStatus) -> u8 {
    let code = status.code().and_then(|code| u8::try_from(code).ok());
    code.unwrap_or(exit::OTHER)
}

fn unheard(cause: &std::io::Error) -> Failure {
    Failure::new(
        exit::OTHER,
        format!("a run cannot be started or followed: {cause}"),
    )
}
