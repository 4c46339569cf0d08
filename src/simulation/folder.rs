//! The results folder of a run: its lock, its log, and what another run left in one.

use std::collections::BTreeSet;
use std::ffi::OsString;
use std::fs::{self, File};
use std::io;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use calcine_coupler::coordinator::{CheckpointPaths, Origin, RunError};
use rustix::fs::{FlockOperation, flock};
use rustix::io::Errno;
use tracing::dispatcher::Dispatch;
use tracing_subscriber::filter::{LevelFilter, Targets};
use tracing_subscriber::layer::SubscriberExt;

use super::error::SimulationError;
use crate::assembly::{GasBackend, Pairing};
use crate::results::files::{is_computed, is_written};
use crate::results::summary::{Provenance, Verdict};
use crate::results::{SUMMARY, Summary};

/// A file that every run makes and holds locked while it lives.
const LOCK: &str = "lock";

/// Name of the run's own log in `log/`.
pub(crate) const OWN_LOG: &str = "calcine.log";

fn io_error(path: &Path, cause: io::Error) -> SimulationError {
    SimulationError::Io {
        path: path.to_owned(),
        cause,
    }
}

/// The results folder of a run that is about to begin, kept from other runs. Unless it is kept, all that was put into
/// it is removed again: a run that is refused leaves the folder, or its absence, as it was.
pub(crate) struct ClaimedFolder {
    out: PathBuf,
    /// Names in the folder before; `None` where the folder is this run's own.
    before: Option<BTreeSet<OsString>>,
    /// Folders above that were made for it, the lowest first.
    above: Vec<PathBuf>,
    lock: Option<HeldFolder>,
}

/// The locks of a results folder, which hold while they live: that of the file, and of the folder itself, so that a run whose file
/// was removed is not joined by another one.
pub(crate) struct HeldFolder {
    _file: File,
    _folder: Option<File>,
}

/// Claims the results folder, makes it where it is absent, with its `log/`. Unless the run goes on, or there is a summary by which
/// it is refused or begins again, a folder that holds what it would write over is refused.
pub(crate) fn claim(out: &Path, resume: bool) -> Result<ClaimedFolder, SimulationError> {
    let unusable = |cause| SimulationError::UnusableFolder {
        folder: out.to_owned(),
        cause,
    };
    if out.exists() && !out.is_dir() {
        return Err(unusable(io::Error::from(io::ErrorKind::NotADirectory)));
    }
    let absent = |folder: &&Path| !folder.as_os_str().is_empty() && !folder.exists();
    let mut made = out.ancestors().take_while(absent).map(Path::to_owned);
    let own = made.next().is_some();
    let above: Vec<PathBuf> = made.collect();
    fs::create_dir_all(out).map_err(|cause| {
        remove_empty(&above);
        unusable(cause)
    })?;
    let mut claimed = ClaimedFolder {
        out: out.to_owned(),
        before: (!own).then(|| names(out)).transpose().map_err(unusable)?,
        above,
        lock: None,
    };
    // What is in a file of that name stays.
    let mut lock = File::options();
    let lock = lock.write(true).create(true).truncate(false);
    let file = lock.open(out.join(LOCK)).map_err(unusable)?;
    flock(&file, FlockOperation::NonBlockingLockExclusive).map_err(|_| {
        SimulationError::Occupied {
            folder: out.to_owned(),
        }
    })?;
    // Not every file system locks folders.
    let folder = File::open(out).ok();
    if let Some(folder) = &folder
        && flock(folder, FlockOperation::NonBlockingLockExclusive) == Err(Errno::WOULDBLOCK)
    {
        return Err(SimulationError::Occupied {
            folder: out.to_owned(),
        });
    }
    claimed.lock = Some(HeldFolder {
        _file: file,
        _folder: folder,
    });
    if !resume && !out.join(SUMMARY).exists() {
        claimed.refuse_others()?;
    }
    let log = out.join("log");
    fs::create_dir_all(&log).map_err(|cause| io_error(&log, cause))?;
    Ok(claimed)
}

impl ClaimedFolder {
    /// Refuses a folder that held, before it was claimed, what a run would write over.
    fn refuse_others(&self) -> Result<(), SimulationError> {
        let before = || {
            self.before
                .iter()
                .flatten()
                .filter_map(|name| name.to_str())
        };
        // A run's lock is empty; a file of that name with something in it is another's.
        let empty =
            |name: &str| fs::metadata(self.out.join(name)).is_ok_and(|data| data.len() == 0);
        let of_a_run = before().any(|name| name == LOCK && empty(name));
        let in_the_way = |name: &&str| is_computed(name) || !of_a_run && is_written(name);
        let found: Vec<String> = before()
            .filter(in_the_way)
            .map(|name| format!("`{name}`"))
            .collect();
        if found.is_empty() {
            return Ok(());
        }
        Err(SimulationError::NotResults {
            folder: self.out.clone(),
            names: found.join(", "),
        })
    }

    /// True where a solver has written a log of its own, which may say why a run ended before it began.
    pub(super) fn has_solver_log(&self) -> bool {
        let Ok(logs) = fs::read_dir(self.out.join("log")) else {
            return false;
        };
        let told = |entry: &fs::DirEntry| entry.metadata().is_ok_and(|data| data.len() > 0);
        let mut others = logs.flatten().filter(|entry| entry.file_name() != OWN_LOG);
        others.any(|entry| told(&entry))
    }

    /// Leaves what is in the folder, and gives the lock, which holds while it lives.
    pub(crate) fn keep(mut self) -> Option<HeldFolder> {
        self.lock.take()
    }
}

impl Drop for ClaimedFolder {
    /// Without the lock another run may be at work in the folder: nothing is removed then. What cannot be removed
    /// stays; the error that the run is refused with is the one to tell.
    fn drop(&mut self) {
        let Some(before) = &self.before else {
            let _ = match self.lock {
                Some(_) => fs::remove_dir_all(&self.out),
                None => fs::remove_dir(&self.out),
            };
            return remove_empty(&self.above);
        };
        if self.lock.is_none() {
            return;
        }
        for name in names(&self.out).unwrap_or_default().difference(before) {
            let path = self.out.join(name);
            let _ = match path.is_dir() {
                true => fs::remove_dir_all(&path),
                false => fs::remove_file(&path),
            };
        }
    }
}

/// Names of what is in a folder.
fn names(folder: &Path) -> io::Result<BTreeSet<OsString>> {
    let entries = fs::read_dir(folder)?;
    entries.map(|entry| Ok(entry?.file_name())).collect()
}

/// Removes folders, the lowest first, that hold nothing.
fn remove_empty(folders: &[PathBuf]) {
    for folder in folders {
        let _ = fs::remove_dir(folder);
    }
}

/// True where a run was begun in a folder before.
pub(crate) fn begun_before(out: &Path) -> bool {
    out.join(LOCK).is_file()
}

/// Structured log of this run: DIR/log/calcine.log. CALCINE_LOG sets the level (default info), of all or of modules:
/// `warn,calcine_coupler=debug`.
pub(super) fn log(out: &Path) -> Result<Dispatch, SimulationError> {
    let path = out.join("log").join(OWN_LOG);
    let file = File::options()
        .create(true)
        .append(true)
        .open(&path)
        .map_err(|cause| io_error(&path, cause))?;
    let told = std::env::var("CALCINE_LOG").ok();
    let levels = told.and_then(|text| text.parse::<Targets>().ok());
    let levels = levels.unwrap_or_else(|| Targets::new().with_default(LevelFilter::INFO));
    let lines = tracing_subscriber::fmt::layer()
        .with_ansi(false)
        .with_writer(Arc::new(file));
    let subscriber = tracing_subscriber::registry().with(levels).with(lines);
    Ok(Dispatch::new(subscriber))
}

/// True where a run left a checkpoint.
pub(crate) fn has_checkpoint(folder: &Path) -> bool {
    CheckpointPaths::new(folder).exists()
}

/// Makes the newest whole checkpoint of a folder the one that a run goes on from: what to tell where it is not the last.
pub(super) fn recover(folder: &Path) -> Result<Option<String>, RunError> {
    let paths = CheckpointPaths::new(folder);
    let Some(damage) = paths.recover()? else {
        return Ok(None);
    };
    let from = Origin::read(folder)?.clocks.process;
    Ok(Some(format!(
        "{damage}; the run goes on from the checkpoint before it, of {from} of process time, and the damaged one is kept as {}",
        paths.damaged().display()
    )))
}

/// The summary of the run in a folder, if that came to its end.
pub fn finished(folder: &Path) -> Option<Summary> {
    let there = folder.join(SUMMARY).is_file();
    let summary = there.then(|| Summary::read(folder).ok()).flatten()?;
    let ended_early = matches!(summary.verdict, Verdict::Running | Verdict::Stopped);
    (!ended_early).then_some(summary)
}

/// Refuses to resume a run by other solvers than it had.
pub(super) fn same_solvers(out: &Path, pairing: Pairing) -> Result<(), SimulationError> {
    // Where there is no summary to ask, the solvers refuse what they cannot read.
    let Ok(Summary { backend, .. }) = Summary::read(out) else {
        return Ok(());
    };
    let asked = (pairing.gas.name(), pairing.particles.name());
    if (backend.gas.as_str(), backend.particles.as_str()) == asked {
        return Ok(());
    }
    let solvers = |gas: &str, particles: &str| format!("{gas} gas and {particles} particles");
    Err(SimulationError::OtherSolvers {
        folder: out.to_owned(),
        found: solvers(&backend.gas, &backend.particles),
        asked: solvers(asked.0, asked.1),
        words: format!("--gas {} --particles {}", backend.gas, backend.particles),
    })
}

/// The folder that a run continues from: the one that the user names, or where a run is to begin
/// again the one that it began from.
pub(super) fn begun_from(asked: Option<&Path>, again: bool, out: &Path) -> Option<PathBuf> {
    let before = || Summary::read(out).ok()?.from.map(|from| from.path);
    let begun = if again { before() } else { None };
    begun.or_else(|| asked.map(Path::to_owned))
}

/// What a run left in a folder, and how this one names it.
pub(super) fn origin(
    folder: &Path,
    pairing: Pairing,
) -> Result<(Origin, Provenance), SimulationError> {
    let summary = Summary::read(folder)?;
    let (found, asked) = (summary.backend.gas.as_str(), pairing.gas.name());
    // Native gas and OpenFOAM take each other's fields; a gas of the user's own goes on from its own state only.
    let own = GasBackend::External.name();
    if found != asked && [found, asked].contains(&own) {
        return Err(SimulationError::OtherGas {
            folder: folder.to_owned(),
            found: found.to_owned(),
            asked: asked.to_owned(),
        });
    }
    if !has_checkpoint(folder) {
        return Err(SimulationError::NoOrigin {
            folder: folder.to_owned(),
        });
    }
    let origin = Origin::read(folder).map_err(|cause| SimulationError::Origin {
        folder: folder.to_owned(),
        cause,
    })?;
    let path = std::path::absolute(folder).unwrap_or_else(|_| folder.to_owned());
    let provenance = Provenance {
        path,
        case: summary.case.name,
        hash: origin.case_hash.clone(),
        process_time_s: origin.clocks.process.seconds(),
        windows: origin.windows,
        from: summary.from.map(Box::new),
    };
    Ok((origin, provenance))
}
