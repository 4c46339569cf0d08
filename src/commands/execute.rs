//! One run from a prepared case to its results, used by `run`, `compare` and `sweep`.

use std::fmt::Write as _;
use std::fs::{self, File};
use std::io;
use std::path::Path;
use std::sync::Arc;
use std::time::Duration;

use calcine_coupler::coordinator::{Ending, RunError};
use calcine_coupler::ledger::STORAGE_CLOCK;
use calcine_coupler::observer::Observer;
use calcine_coupler::supervisor::{Interrupts, Supervisor};
use rustix::fs::{FlockOperation, flock};
use signal_hook::consts::{SIGINT, SIGTERM};
use signal_hook::iterator::Signals;
use tracing::{error, info, warn};

use super::failure::{Failure, chain, with_help};
use super::origin;
use super::parallel::{self, Transport};
use crate::assembly::{self, Pairing, PreparedCase, SolverStarts, assemble};
use crate::case::buoyancy;
use crate::case::model::Case;
use crate::exit;
use crate::progress::Progress;
use crate::results::inertial_number::InertialNumberStatistics;
use crate::results::{self, Recorder, ResultsError, RunInfo, Summary, Verdict};

/// A file that every run makes and holds locked while it lives.
const LOCK: &str = "lock";

/// How a case is run.
pub(super) struct Settings<'a> {
    /// Who computes what.
    pub(super) pairing: Pairing,
    /// How external solvers are started.
    pub(super) starts: &'a SolverStarts,
    /// What carries their messages.
    pub(super) transport: Transport,
    /// The results folder.
    pub(super) out: &'a Path,
    /// Goes on from the checkpoint in it, or starts again if there was none yet.
    pub(super) resume: bool,
    /// The results folder of another run to continue from.
    pub(super) from: Option<&'a Path>,
    /// Shows a progress bar.
    pub(super) progress: bool,
    /// Checkpoint and stop after this wall time.
    pub(super) stop_after: Option<Duration>,
}

/// How a run ended.
pub(super) struct Done {
    /// Exit code.
    pub(super) code: u8,
    /// What to tell the user.
    pub(super) text: String,
}

/// Runs a case into its results folder.
pub(super) fn execute(
    case: &Case,
    prepared: &PreparedCase,
    settings: &Settings<'_>,
) -> Result<Done, Failure> {
    let out = settings.out;
    let started_before = out.join(LOCK).is_file();
    fs::create_dir_all(out.join("log")).map_err(|cause| io_failure(out, &cause))?;
    let _lock = lock(out)?;
    let checkpoint = out.join("checkpoint");
    let resume = settings.resume && checkpoint.join("coordinator.state").is_file();
    if settings.resume
        && let Some(summary) = origin::finished(out)
    {
        return over(case, out, &summary);
    }
    let begun_from = origin::folder(settings.from, settings.resume && !resume, out);
    if settings.resume && !resume {
        // A run that ended before its first checkpoint is resumed by starting it again.
        let again = started_before && results::clear_start(out, &case.hash).map_err(refused)?;
        if !again {
            let message = format!(
                "there is no checkpoint in {}: run without `--resume`, or name the folder with \
                 `--out`",
                out.display()
            );
            return Err(Failure::new(exit::CASE, message));
        }
    }
    let begun_from = begun_from.filter(|_| !resume);
    let continued = begun_from.map(|folder| origin::read(&folder, settings.pairing));
    let (origin, provenance) = continued.transpose()?.unzip();
    let from = resume.then_some(checkpoint.as_path());
    let info = RunInfo {
        gas: settings.pairing.gas.name().into(),
        particles: settings.pairing.particles.name().into(),
        transport: if settings.pairing.is_native() {
            "none"
        } else {
            settings.transport.name()
        }
        .into(),
        from: provenance,
    };
    let mut recorder = Recorder::create(case, info, out, from).map_err(refused)?;
    let _log = log_to(out)?;

    let interrupts = Interrupts::default();
    let _signals = SignalThread::start(&interrupts, settings.stop_after)?;
    let mut supervisor = Supervisor::new(case.coupling.deadline, interrupts);
    info!(case = %case.name, pairing = %settings.pairing.name(), resume, "start");
    let assembly = assembly::RunSettings {
        pairing: settings.pairing,
        starts: settings.starts,
        results: out,
        resume,
        from: origin.as_ref(),
    };
    let mut run = assemble(case, prepared, &assembly, &mut supervisor)?;
    let number = buoyancy::number(case, &prepared.mesh);
    info!("N sqrt(AF) dt is {number:.2e}");
    if settings.progress && number > 0.0 {
        let limit = buoyancy::LIMIT;
        eprintln!("buoyancy: N sqrt(AF) dt is {number:.2e} (resolved below {limit})");
    }
    if let Some(warning) = buoyancy::warning(number) {
        warn!("{warning}");
        eprintln!("warning: {warning}");
    }
    let mut progress = Progress::new(case, settings.progress);
    let mut observers: [&mut dyn Observer; 2] = [&mut recorder, &mut progress];
    let ending = run.run(&supervisor, &mut observers);
    progress.clear();
    match ending {
        Ok(Ending::Finished) => {
            let summary = recorder.summary();
            let outside = summary.is_some_and(|summary| {
                summary
                    .quantities
                    .values()
                    .any(|quantity| quantity.verdict == Verdict::Fail)
            });
            info!(outside, "finished");
            let code = if outside {
                exit::OUTSIDE_BANDS
            } else {
                exit::OK
            };
            Ok(Done {
                code,
                text: summary.map(closing).unwrap_or_default(),
            })
        }
        Ok(Ending::Checkpointed(path)) => {
            stopped(&mut recorder);
            info!(path = %path.display(), "checkpointed");
            let text = format!(
                "stopped with a checkpoint in {}; go on with\n  calcine run {} --out {} --resume{}{}",
                path.display(),
                case.path.display(),
                out.display(),
                backend_flags(settings.pairing),
                parallel::flags(settings.starts),
            );
            Ok(Done {
                code: exit::CHECKPOINTED,
                text,
            })
        }
        Err(failure) => {
            stopped(&mut recorder);
            Err(failed(out, &failure))
        }
    }
}

/// `--resume` of a run that came to its end: there is nothing to do.
fn over(case: &Case, out: &Path, summary: &Summary) -> Result<Done, Failure> {
    if summary.case.hash != case.hash {
        let message = format!(
            "the run in {} came to its end, and its case differs from this one (hash {} there, {} \
             here): `--from {0}` continues from it, into another folder",
            out.display(),
            summary.case.hash,
            case.hash
        );
        return Err(Failure::new(exit::CASE, message));
    }
    let code = match summary.verdict {
        Verdict::Fail => exit::OUTSIDE_BANDS,
        _ => exit::OK,
    };
    let text = format!("the run in {} had come to its end already", out.display());
    Ok(Done { code, text })
}

/// Says in the results that the run ended early; a failure of that is only logged.
fn stopped(recorder: &mut Recorder) {
    if let Err(failure) = recorder.stopped() {
        error!("{}", chain(&failure));
    }
}

/// The closing lines of a run: what was run, the quantities, the ledger, the time.
fn closing(summary: &Summary) -> String {
    let mut text = format!(
        "{}: {} windows to {} s of process time in {:.2} s\n",
        summary.case.name, summary.windows, summary.process_time_s, summary.wall_time_s.total
    );
    for (name, quantity) in &summary.quantities {
        let value = quantity
            .value
            .map_or("unknown".into(), |value| format!("{value:.6}"));
        let _ = writeln!(
            text,
            "  {name:24} {value:>16} {:8} {}",
            quantity.unit,
            quantity.verdict.word()
        );
    }
    let elements = summary.ledger.elements.iter();
    let elements = elements.map(|(name, line)| (format!("element {name}"), line));
    let lines = summary.ledger.lines.iter();
    for (name, line) in lines
        .map(|(name, line)| (name.clone(), line))
        .chain(elements)
    {
        let what = match name.as_str() {
            STORAGE_CLOCK => "of what moved, by two clocks; no error",
            _ => "relative error",
        };
        let _ = writeln!(
            text,
            "  ledger {name:17} {:>16.3e} {what}",
            line.relative_error
        );
    }
    if summary.convergence.unsettled_windows > 0 {
        let _ = writeln!(
            text,
            "  warning: in {} of {} windows the exchange was not settled after all attempts \
             (coupling.exchange.attempts); at most a share of {:.1e} was in the wrong cells",
            summary.convergence.unsettled_windows,
            summary.windows,
            summary.convergence.largest_misplaced
        );
    }
    if summary.convergence.unconverged_windows > 0 {
        let _ = writeln!(
            text,
            "  warning: in {} of {} windows the gas' outer loop ended at its limit \
             (gas.controls.outer_iterations); largest residual {:.1e}",
            summary.convergence.unconverged_windows,
            summary.windows,
            summary.convergence.largest_residual
        );
    }
    if let Some(words) = summary
        .pace
        .as_ref()
        .and_then(InertialNumberStatistics::warning)
    {
        let _ = writeln!(text, "  warning: {words}");
    }
    text.trim_end().to_owned()
}

fn failed(out: &Path, failure: &RunError) -> Failure {
    let mut message = chain(failure);
    error!("{message}");
    if out.join("checkpoint").join("coordinator.state").is_file() {
        message.push_str(&format!(
            "\nthe last checkpoint is in {}: `--resume` goes on from it",
            out.join("checkpoint").display()
        ));
    }
    Failure::new(exit::of(failure), message)
}

fn backend_flags(pairing: Pairing) -> String {
    if pairing.is_native() {
        String::new()
    } else {
        format!(
            " --gas {} --particles {}",
            pairing.gas.name(),
            pairing.particles.name()
        )
    }
}

fn io_failure(path: &Path, cause: &io::Error) -> Failure {
    Failure::new(exit::OTHER, format_args!("{}: {cause}", path.display()))
}

fn refused(cause: ResultsError) -> Failure {
    Failure::new(exit::CASE, with_help(&cause))
}

/// Keeps a second run out of the results folder while this one lives.
fn lock(out: &Path) -> Result<File, Failure> {
    let path = out.join(LOCK);
    let file = File::create(&path).map_err(|cause| io_failure(&path, &cause))?;
    flock(&file, FlockOperation::NonBlockingLockExclusive).map_err(|_| {
        let message = format!(
            "another run is writing into {}: name another folder with `--out`",
            out.display()
        );
        Failure::new(exit::CASE, message)
    })?;
    Ok(file)
}

/// Structured log of this run: DIR/log/calcine.log (CALCINE_LOG sets the level, default info).
fn log_to(out: &Path) -> Result<tracing::subscriber::DefaultGuard, Failure> {
    let path = out.join("log").join("calcine.log");
    let file = File::options()
        .create(true)
        .append(true)
        .open(&path)
        .map_err(|cause| io_failure(&path, &cause))?;
    let filter = tracing_subscriber::EnvFilter::try_from_env("CALCINE_LOG")
        .unwrap_or_else(|_| tracing_subscriber::EnvFilter::new("info"));
    let subscriber = tracing_subscriber::fmt()
        .with_env_filter(filter)
        .with_ansi(false)
        .with_writer(Arc::new(file))
        .finish();
    Ok(tracing::subscriber::set_default(subscriber))
}

/// Turns Ctrl-C, SIGTERM and `--stop-after` into interrupts.
struct SignalThread(signal_hook::iterator::Handle);

impl SignalThread {
    fn start(interrupts: &Interrupts, stop_after: Option<Duration>) -> Result<Self, Failure> {
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
