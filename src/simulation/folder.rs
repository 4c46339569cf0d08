//! The results folder of a run: its lock, its log, and what another run left in one.

use std::fs::{self, File};
use std::io;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use calcine_coupler::coordinator::Origin;
use rustix::fs::{FlockOperation, flock};
use tracing::dispatcher::Dispatch;
use tracing_subscriber::filter::{LevelFilter, Targets};
use tracing_subscriber::layer::SubscriberExt;

use super::error::SimulationError;
use crate::assembly::Pairing;
use crate::results::summary::{Provenance, Verdict};
use crate::results::{SUMMARY, Summary};

/// A file that every run makes and holds locked while it lives.
const LOCK: &str = "lock";

fn io_error(path: &Path, cause: io::Error) -> SimulationError {
    SimulationError::Io {
        path: path.to_owned(),
        cause,
    }
}

/// Makes the folder with its `log/`; true where a run was begun in it before.
pub(super) fn create(out: &Path) -> Result<bool, SimulationError> {
    let started = out.join(LOCK).is_file();
    fs::create_dir_all(out.join("log")).map_err(|cause| io_error(out, cause))?;
    Ok(started)
}

/// Keeps a second run out of the results folder while the file is held.
pub(super) fn lock(out: &Path) -> Result<File, SimulationError> {
    let path = out.join(LOCK);
    let file = File::create(&path).map_err(|cause| io_error(&path, cause))?;
    flock(&file, FlockOperation::NonBlockingLockExclusive).map_err(|_| {
        SimulationError::Occupied {
            folder: out.to_owned(),
        }
    })?;
    Ok(file)
}

/// Structured log of this run: DIR/log/calcine.log. CALCINE_LOG sets the level (default info), of all or of modules:
/// `warn,calcine_coupler=debug`.
pub(super) fn log(out: &Path) -> Result<Dispatch, SimulationError> {
    let path = out.join("log").join("calcine.log");
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

/// True where a complete checkpoint of the coordinator is there.
pub(crate) fn has_checkpoint(folder: &Path) -> bool {
    let state = folder.join("checkpoint").join("coordinator.state");
    state.is_file()
}

/// The summary of the run in a folder, if that came to its end.
pub fn finished(folder: &Path) -> Option<Summary> {
    let there = folder.join(SUMMARY).is_file();
    let summary = there.then(|| Summary::read(folder).ok()).flatten()?;
    let ended_early = matches!(summary.verdict, Verdict::Running | Verdict::Stopped);
    (!ended_early).then_some(summary)
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
    if found != asked {
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
