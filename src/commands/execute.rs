//! One run from a prepared case to its results, used by `run`, `compare` and `sweep`.

use std::fmt::Write as _;
use std::path::Path;
use std::time::Duration;

use calcine_coupler::ledger::{DRAG_CARRY, PRESCRIBED_HEAT, STORAGE_CLOCK};
use calcine_coupler::supervisor::Interrupts;

use super::console::printed;
use super::continuation::Recorded;
use super::failure::{Failure, chain};
use super::parallel::Transport;
use super::signals::SignalThread;
use crate::assembly::{Pairing, PreparedCase, SolverStarts};
use crate::case::buoyancy;
use crate::case::model::Case;
use crate::exit;
use crate::progress::Progress;
use crate::results::inertial_number::InertialNumberStatistics;
use crate::results::{CaseIdentity, Summary, as_finished, same_case};
use crate::simulation::{self, Ending, Simulation, SimulationError};
use crate::standard_error::tell_line;

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
    /// Continues from the checkpoint in it; starts again if there is none yet.
    pub(super) resume: bool,
    /// The results folder of another run to continue from.
    pub(super) from: Option<&'a Path>,
    /// Shows a progress bar.
    pub(super) progress: bool,
    /// Checkpoint and stop after this wall time.
    pub(super) stop_after: Option<Duration>,
    /// Ends with an exit code of its own where a complete run has warnings.
    pub(super) strict: bool,
    /// The command that `--resume DIR` goes on with, where it can.
    pub(super) recorded: Option<Recorded>,
    /// How to go on after an interrupt, in words.
    pub(super) go_on: &'a str,
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
    if settings.resume
        && let Some(summary) = simulation::finished(out)
    {
        return over(case, out, &summary, settings.strict);
    }
    let interrupts = Interrupts::default();
    let _signals = SignalThread::start(&interrupts, settings.stop_after)?;
    tell_buoyancy(case, prepared, settings.progress);
    for warning in &case.warnings {
        tell_line(format_args!("warning: {warning}"));
    }
    let mut builder = Simulation::open(&case.path)
        .gas(settings.pairing.gas)
        .particles(settings.pairing.particles)
        .starts(settings.starts.clone(), settings.transport.name())
        .out(out)
        .resume(settings.resume)
        .command(settings.recorded.as_ref().and_then(Recorded::json))
        .interrupts(interrupts);
    if let Some(from) = settings.from {
        builder = builder.from(from);
    }
    let progress = Box::new(Progress::new(case, settings.progress));
    let mut simulation = builder.start_prepared(case, prepared, vec![progress])?;
    // A run that begins has it from its first moment on; one that is refused a resume keeps what it had.
    if let Some(recorded) = settings.recorded.as_ref().filter(|_| settings.resume) {
        recorded.write(out)?;
    }
    for note in simulation.notes() {
        tell_line(format_args!("warning: {note}"));
    }
    let ending = simulation.finish();
    let summary = simulation.summary().cloned();
    // Takes the progress bar off the screen before anything is printed.
    drop(simulation);
    match ending {
        Ok(Ending::Finished) => {
            let code = summary
                .as_ref()
                .map_or(exit::OK, |summary| exit::complete(summary, settings.strict));
            let summary = summary.as_ref();
            Ok(Done {
                code,
                text: summary.map(closing).unwrap_or_default() + alone(case),
            })
        }
        Ok(Ending::Checkpointed(path)) => {
            let text = format!(
                "stopped with a checkpoint in {}; {}",
                path.display(),
                settings.go_on,
            );
            Ok(Done {
                code: exit::CHECKPOINTED,
                text,
            })
        }
        Err(failure) => Err(failed(out, &failure)),
    }
}

/// The line of a run without particles.
fn alone(case: &Case) -> &'static str {
    match case.particles.is_empty() {
        true => "\n  no particles: the gas was computed alone",
        false => "",
    }
}

/// Tells how well the window resolves buoyancy.
fn tell_buoyancy(case: &Case, prepared: &PreparedCase, shown: bool) {
    let number = buoyancy::number(case, &prepared.mesh);
    if shown && number > 0.0 {
        let limit = buoyancy::LIMIT;
        tell_line(format_args!(
            "buoyancy: N sqrt(AF) dt is {number:.2e} (resolved below {limit})"
        ));
    }
}

/// `--resume` of a run that is complete: there is nothing to do.
fn over(case: &Case, out: &Path, summary: &Summary, strict: bool) -> Result<Done, Failure> {
    same_case(out, &summary.case.hash, CaseIdentity::of(case))
        .map_err(|error| Failure::told(exit::CASE, &error))?;
    as_finished(out, summary).map_err(|error| Failure::told(exit::OTHER, &error))?;
    let code = exit::complete(summary, strict);
    let text = format!("the run in {} is already complete", out.display());
    Ok(Done { code, text })
}

/// The closing lines of a run: what was run, the quantities, the ledger, the time.
fn closing(summary: &Summary) -> String {
    let mut text = format!(
        "{}: {} windows to {} s of process time in {:.2} s\n",
        summary.case.name, summary.windows, summary.process_time_s, summary.wall_time_s.total
    );
    for (name, quantity) in &summary.quantities {
        let late = quantity
            .expected_at_s
            .is_some_and(|time| time > summary.process_time_s);
        let (value, unit) = match quantity.value {
            Some(value) if quantity.unit == "1" => (printed(value), ""),
            Some(value) => (printed(value), quantity.unit.as_str()),
            None if late => ("unknown".to_owned(), ""),
            // There is nothing to measure, as for the mean of no particles.
            None => ("none".to_owned(), ""),
        };
        let reason = quantity.reason(summary.process_time_s);
        let _ = writeln!(
            text,
            "  {name:24} {value:>16} {:8} {}{}",
            unit,
            quantity.verdict.word(),
            reason.map(|words| format!(": {words}")).unwrap_or_default()
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
            STORAGE_CLOCK => "of all that moved (time splitting; not an error)",
            PRESCRIBED_HEAT => "of all energy that moved (from outside; not an error)",
            DRAG_CARRY => "of all that moved (a window late; not an error)",
            _ => "relative error",
        };
        let _ = writeln!(
            text,
            "  ledger {name:17} {:>16.3e} {what}",
            line.relative_error
        );
    }
    let cuts = summary.convergence.cuts;
    if cuts > 0 {
        let _ = writeln!(
            text,
            "  windows were cut {cuts} times (coupling.exchange.cuts)"
        );
    }
    let used_up = summary.passed.used_up;
    if used_up.rows > 0 {
        let _ = writeln!(
            text,
            "  used up (burnt out) and taken out: {} particles, with {} kg left of them",
            used_up.rows,
            printed(used_up.mass_kg)
        );
    }
    let lost = summary.passed.lost;
    if lost.rows > 0 {
        let _ = writeln!(
            text,
            "  left the gas mesh and taken out: {} particles of {} kg",
            lost.rows,
            printed(lost.mass_kg)
        );
    }
    let of_case = summary.case_warnings.len();
    if of_case > 0 {
        let _ = writeln!(
            text,
            "  warnings of the case: {of_case}, told at the start, in log/calcine.log and in report.html"
        );
    }
    for (name, warning) in &summary.warnings {
        let _ = writeln!(
            text,
            "  warning: {name} in {} of {} windows; {}",
            warning.windows,
            summary.windows,
            warning.sentence()
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

/// A run that failed, with the checkpoint that it can go on from.
fn failed(out: &Path, failure: &SimulationError) -> Failure {
    let mut message = chain(failure);
    if simulation::has_checkpoint(out) {
        message.push_str(&format!(
            "\nthe last checkpoint is in {}: `--resume` continues from it",
            out.join("checkpoint").display()
        ));
    }
    Failure::new(failure.exit_code(), message)
}
