//! `--from DIR`: the results of another run, from which this one continues.

use std::path::{Path, PathBuf};

use calcine_coupler::coordinator::Origin;

use super::failure::{Failure, chain, with_help};
use crate::assembly::Pairing;
use crate::exit;
use crate::results::summary::{Provenance, Verdict};
use crate::results::{SUMMARY, Summary};

/// The folder that a run continues from: the one that the user names, or where a run is to begin
/// again the one that it began from.
pub(super) fn folder(asked: Option<&Path>, again: bool, out: &Path) -> Option<PathBuf> {
    let before = || Summary::read(out).ok()?.from.map(|from| from.path);
    let begun = if again { before() } else { None };
    begun.or_else(|| asked.map(Path::to_owned))
}

/// What a run left in a folder, and how this one names it.
pub(super) fn read(folder: &Path, pairing: Pairing) -> Result<(Origin, Provenance), Failure> {
    let refused = |message: String| Failure::new(exit::CASE, message);
    let summary = Summary::read(folder).map_err(|error| refused(with_help(&error)))?;
    let (found, asked) = (summary.backend.gas.as_str(), pairing.gas.name());
    if found != asked {
        return Err(refused(format!(
            "--from {}: the results are of the gas backend `{found}`, this run has `{asked}`, and the \
             state of one is no start of the other: run both with `--gas {found}`",
            folder.display()
        )));
    }
    let state = folder.join("checkpoint").join("coordinator.state");
    if !state.is_file() {
        return Err(refused(format!(
            "--from {}: there is no checkpoint in it; a run leaves one at its end, on Ctrl-C and \
             as often as `time.checkpoint` says",
            folder.display()
        )));
    }
    let origin = Origin::read(folder)
        .map_err(|error| refused(format!("--from {}: {}", folder.display(), chain(&error))))?;
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

/// The summary of the run in a folder, if that came to its end.
pub(super) fn finished(folder: &Path) -> Option<Summary> {
    let there = folder.join(SUMMARY).is_file();
    let summary = there.then(|| Summary::read(folder).ok()).flatten()?;
    let ended_early = matches!(summary.verdict, Verdict::Running | Verdict::Stopped);
    (!ended_early).then_some(summary)
}
