//! The command line, one file per subcommand.

mod able;
mod check;
mod compare;
mod conform;
mod console;
mod continuation;
pub mod doctor;
mod execute;
mod failure;
mod inputs;
mod jobs;
mod kinds;
mod new;
mod parallel;
mod plant;
mod prepare;
#[cfg(test)]
mod reference;
mod report;
mod run;
mod schema;
mod shell;
mod shell_files;
mod signals;
mod sweep;
mod sweep_axes;
mod sweep_table;
mod told_as_json;
mod tune;
mod tuning_line;
mod watch;

use std::os::unix::process::CommandExt;
use std::process::{self, ExitCode};
use std::sync::Arc;

use calcine_adapters::find::find_program;
use calcine_wire::SolverNetwork;
use clap::{CommandFactory, Parser, Subcommand};
use signal_hook::consts::SIGXFSZ;

use crate::exit;
use crate::standard_error::tell_line;
use console::say;
use doctor::{MPI_PROGRAM, MPI_VARIABLE};
pub use failure::Failure;
use failure::chain;

/// Computes reactive granular beds: gas and particles coupled, natively or with OpenFOAM and LIGGGHTS.
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
    Tune(tune::Arguments),
    Conform(conform::Arguments),
    Report(report::Arguments),
    Watch(watch::Arguments),
    Prepare(prepare::Arguments),
    New(new::Arguments),
    Schema(schema::Arguments),
    Completions(shell_files::Completions),
    Man(shell_files::Man),
    /// Lists the solvers, MPI and HDF5 of this machine and the command that installs what is missing.
    Doctor,
}

/// Runs the command line of this process.
pub fn main() -> ExitCode {
    ExitCode::from(run_line(None))
}

/// Runs the command line of this process, with what can spawn solvers by MPI; without that, a run that
/// needs it goes to the program `calcine-mpi`. Gives the exit code.
pub fn run_line(network: Option<&Arc<dyn SolverNetwork>>) -> u8 {
    let arguments = Arguments::parse();
    // A limit on the size of files is an error of the write that meets it, told with its file, and not the end of the process.
    let _ = signal_hook::flag::register(SIGXFSZ, Arc::default());
    let outcome = match &arguments.command {
        Command::Run(arguments) => kinds::run(arguments, network, become_mpi),
        Command::Check(arguments) => kinds::check(arguments),
        Command::Compare(arguments) => kinds::compare(arguments),
        Command::Sweep(arguments) => kinds::sweep(arguments),
        Command::Tune(arguments) => tune::run(arguments),
        Command::Conform(arguments) => conform::run(arguments),
        Command::Report(arguments) => kinds::report(arguments),
        Command::Watch(arguments) => watch::run(arguments, kinds::page),
        Command::Prepare(arguments) => prepare::run(arguments),
        Command::New(arguments) => new::run(arguments),
        Command::Schema(arguments) => schema::run(arguments),
        Command::Completions(arguments) => shell_files::complete(arguments, Arguments::command()),
        Command::Man(arguments) => shell_files::man(arguments, Arguments::command()),
        Command::Doctor => say(doctor::run()).map(|()| exit::OK),
    };
    match outcome {
        Ok(code) => code,
        Err(failure) => {
            tell_line(failure.message.trim_end());
            if let Command::Run(arguments) = &arguments.command
                && let Err(lost) = arguments.tell_failure(&failure)
            {
                tell_line(&lost.message);
            }
            failure.code
        }
    }
}

/// Replaces this process by `calcine-mpi` with the same words; returns only where that fails.
fn become_mpi() -> Failure {
    let program = match find_program(MPI_VARIABLE, MPI_PROGRAM) {
        Ok(program) => program,
        Err(error) => return Failure::new(exit::PEER, chain(&error)),
    };
    let cause = process::Command::new(&program)
        .args(std::env::args_os().skip(1))
        .exec();
    let message = format!("{} cannot be started: {cause}", program.display());
    Failure::new(exit::PEER, message)
}
