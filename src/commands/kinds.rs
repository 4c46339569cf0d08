//! What commands do with a case, by its kind.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use calcine_wire::SolverNetwork;
use rustix::process::{Signal, set_parent_process_death_signal};

use super::failure::Failure;
use super::tuning_line::Tuning;
use super::{check, compare, plant, report, run, sweep, tune};
use crate::case::kind_of;
use crate::exit;
use crate::results::ResultsError;

/// A command with its arguments; gives the exit code.
type Command<A> = fn(&A) -> Result<u8, Failure>;

/// `run` with its arguments, the case, what can spawn solvers by MPI, and what hands over to the program that can.
type RunCommand = fn(
    &run::Arguments,
    &Path,
    Option<&Arc<dyn SolverNetwork>>,
    fn() -> Failure,
) -> Result<u8, Failure>;

/// The commands of a kind of case. A new kind is an entry of [`COMMANDS`], and its keys are one of
/// [`KINDS`](crate::case::keys::KINDS).
struct KindCommands {
    /// Word of the key `kind`.
    kind: &'static str,
    /// `run`, with the arguments that `--resume DIR` stands for, and the case.
    run: RunCommand,
    /// `check`.
    check: Command<check::Arguments>,
    /// `compare`, where the kind has it.
    compare: Option<Command<compare::Arguments>>,
    /// `sweep`, where the kind has it.
    sweep: Option<Command<sweep::Arguments>>,
    /// `report`: writes the page of a results folder.
    report: fn(&Path) -> Result<PathBuf, ResultsError>,
}

/// All kinds; the first is that of cases and results that state none.
static COMMANDS: &[KindCommands] = &[
    KindCommands {
        kind: "bed",
        run: run::run,
        check: check::run,
        compare: Some(compare::run),
        sweep: Some(sweep::run),
        report: crate::report::write,
    },
    KindCommands {
        kind: "flowsheet",
        run: plant::run,
        check: plant::check,
        compare: Some(plant::compare),
        sweep: Some(plant::sweep),
        report: crate::plant::write_plant_report,
    },
    KindCommands {
        kind: "tuning",
        run: |arguments, case, _, _| {
            run::use_threads(arguments.threads.map(usize::from))?;
            tune::tune(&Tuning {
                case,
                set: &arguments.set,
                out: arguments.out.as_deref(),
                resume: arguments.resume.is_some(),
                quiet: arguments.quiet,
            })
        },
        check: |arguments| tune::check(&arguments.case, &arguments.set),
        compare: None,
        sweep: None,
        report: tune::page,
    },
];

/// The commands of a case's kind.
fn commands(case: &Path, set: &[String]) -> Result<&'static KindCommands, Failure> {
    let kind = kind_of(case, set).map_err(|wrong| Failure::new(exit::CASE, wrong.render()))?;
    Ok(named(kind.name))
}

fn named(kind: &str) -> &'static KindCommands {
    let found = COMMANDS.iter().find(|one| one.kind == kind);
    found.unwrap_or(&COMMANDS[0])
}

/// A command that a kind has, or which kinds have it.
fn has<T>(
    kind: &KindCommands,
    command: &str,
    of: fn(&KindCommands) -> Option<T>,
) -> Result<T, Failure> {
    let having = COMMANDS.iter().filter(|one| of(one).is_some());
    let having: Vec<&str> = having.map(|one| one.kind).collect();
    of(kind).ok_or_else(|| {
        let message = format!(
            "`calcine {command}` does not take a case of kind \"{}\"; it takes {}",
            kind.kind,
            having.join(", ")
        );
        Failure::new(exit::CASE, message)
    })
}

/// `calcine run`.
pub(super) fn run(
    arguments: &run::Arguments,
    network: Option<&Arc<dyn SolverNetwork>>,
    hand_over: fn() -> Failure,
) -> Result<u8, Failure> {
    let (arguments, case) = arguments.completed()?;
    if arguments.with_parent {
        // Where the system has no such thing the run goes on by itself.
        let _ = set_parent_process_death_signal(Some(Signal::TERM));
    }
    (commands(&case, &arguments.set)?.run)(&arguments, &case, network, hand_over)
}

/// `calcine check`.
pub(super) fn check(arguments: &check::Arguments) -> Result<u8, Failure> {
    (commands(&arguments.case, &arguments.set)?.check)(arguments)
}

/// `calcine compare`.
pub(super) fn compare(arguments: &compare::Arguments) -> Result<u8, Failure> {
    let kind = commands(&arguments.case, &arguments.set)?;
    has(kind, "compare", |one| one.compare)?(arguments)
}

/// `calcine sweep`.
pub(super) fn sweep(arguments: &sweep::Arguments) -> Result<u8, Failure> {
    let kind = commands(&arguments.case, &[])?;
    has(kind, "sweep", |one| one.sweep)?(arguments)
}

/// `calcine report`.
pub(super) fn report(arguments: &report::Arguments) -> Result<u8, Failure> {
    report::run(arguments, page)
}

/// Writes the page of a results folder, of whichever kind its case is.
pub(super) fn page(folder: &Path) -> Result<PathBuf, ResultsError> {
    (named(&crate::results::kind(folder)).report)(folder)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_kind_of_case_has_its_commands() {
        let known: Vec<&str> = COMMANDS.iter().map(|one| one.kind).collect();
        assert_eq!(known, crate::case::keys::kind_names());
    }
}
