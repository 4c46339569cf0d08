//! The command line, one file per subcommand.

mod check;
mod compare;
pub mod doctor;
mod execute;
mod new;
mod origin;
mod parallel;
mod prepare;
mod report;
mod run;
mod schema;
mod sweep;

use std::fmt;
use std::io::Write;
use std::os::unix::process::CommandExt;
use std::path::{Path, PathBuf};
use std::process::{self, ExitCode};
use std::sync::Arc;

use calcine_adapters::launch::find_program;
use calcine_wire::SolverNetwork;
use clap::{Parser, Subcommand};

use crate::assembly::{AssemblyError, PreparedCase};
use crate::case::model::Case;
use crate::exit;

/// Reactive granular beds: gas and particles coupled, natively or with OpenFOAM and LIGGGHTS.
#[derive(Debug, Parser)]
#[command(name = "calcine", version, propagate_version = true)]
struct Arguments {
    #[command(subcommand)]
    command: Command,
}

#[derive(Debug, Subcommand)]
enum Command {
    Run(run::Arguments),
    Check(check::Arguments),
    Compare(compare::Arguments),
    Sweep(sweep::Arguments),
    Report(report::Arguments),
    Prepare(prepare::Arguments),
    New(new::Arguments),
    Schema(schema::Arguments),
    /// Shows which solvers, MPI and HDF5 are here, and what installs what is missing.
    Doctor,
}

/// Why a command failed: an exit code and what to tell the user.
#[derive(Debug)]
pub struct Failure {
    /// Exit code, see [`crate::exit`].
    pub code: u8,
    /// What to tell the user; ends up on standard error.
    pub message: String,
}

impl Failure {
    fn new(code: u8, message: impl fmt::Display) -> Self {
        Self {
            code,
            message: message.to_string(),
        }
    }
}

impl From<AssemblyError> for Failure {
    fn from(error: AssemblyError) -> Self {
        let code = match &error {
            AssemblyError::Run(error) => exit::of(error),
            AssemblyError::Part(_) => exit::PEER,
            _ => exit::CASE,
        };
        Failure::new(code, chain(&error))
    }
}

/// An error with its causes, one a line.
fn chain(error: &dyn std::error::Error) -> String {
    let mut text = error.to_string();
    let mut cause = error.source();
    while let Some(error) = cause {
        let line = error.to_string();
        if !text.contains(&line) {
            text.push_str("\n  because: ");
            text.push_str(&line);
        }
        cause = error.source();
    }
    text
}

/// An error with its causes and its remedy.
fn with_help<E: std::error::Error + miette::Diagnostic>(error: &E) -> String {
    let remedy = error
        .help()
        .map(|help| format!("\n  help: {help}"))
        .unwrap_or_default();
    chain(error) + &remedy
}

/// Reads a case with `--set` applied; all its errors at once.
fn read_case(path: &Path, set: &[String]) -> Result<Case, Failure> {
    crate::case::read(path, set).map_err(|errors| Failure::new(exit::CASE, errors.render()))
}

/// Reads a case and makes mesh and particles.
fn read_and_prepare(path: &Path, set: &[String]) -> Result<(Case, PreparedCase), Failure> {
    let mut case = read_case(path, set)?;
    let prepared = PreparedCase::new(&case)?;
    crate::case::settle(&mut case, &prepared.mesh);
    Ok((case, prepared))
}

/// The results folder: as asked for, or `results/NAME` below the working directory.
fn results_folder(case: &Case, out: Option<&PathBuf>) -> PathBuf {
    out.cloned()
        .unwrap_or_else(|| PathBuf::from("results").join(&case.name))
}

/// Prints a line for the user. One who reads no further, such as `head`, is no error.
fn say(text: impl fmt::Display) {
    let _ = writeln!(std::io::stdout().lock(), "{text}");
}

/// Runs the command line of this process.
pub fn main() -> ExitCode {
    ExitCode::from(run_line(None))
}

/// Runs the command line of this process, with what can spawn solvers by MPI; without that, a run that
/// needs it goes to the program `calcine-mpi`. Gives the exit code.
pub fn run_line(network: Option<&Arc<dyn SolverNetwork>>) -> u8 {
    let arguments = Arguments::parse();
    let outcome = match &arguments.command {
        Command::Run(arguments) if network.is_none() && arguments.needs_mpi() => Err(become_mpi()),
        Command::Run(arguments) => run::run(arguments, network),
        Command::Check(arguments) => check::run(arguments),
        Command::Compare(arguments) => compare::run(arguments),
        Command::Sweep(arguments) => sweep::run(arguments),
        Command::Report(arguments) => report::run(arguments),
        Command::Prepare(arguments) => prepare::run(arguments),
        Command::New(arguments) => new::run(arguments),
        Command::Schema(arguments) => schema::run(arguments),
        Command::Doctor => {
            say(doctor::run());
            Ok(exit::OK)
        }
    };
    match outcome {
        Ok(code) => code,
        Err(failure) => {
            eprintln!("{}", failure.message.trim_end());
            failure.code
        }
    }
}

/// Replaces this process by `calcine-mpi` with the same words; returns only where that fails.
fn become_mpi() -> Failure {
    let remedy = "`cargo xtask setup` installs what it needs and builds it";
    let program = match find_program("CALCINE_MPI", "calcine-mpi", remedy) {
        Ok(program) => program,
        Err(error) => return Failure::new(exit::PEER, chain(&error)),
    };
    let cause = process::Command::new(&program)
        .args(std::env::args_os().skip(1))
        .exec();
    let message = format!("{} cannot be started: {cause}", program.display());
    Failure::new(exit::PEER, message)
}
