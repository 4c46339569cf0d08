//! `calcine run CASE`.

use std::path::PathBuf;
use std::sync::Arc;
use std::time::Duration;

use calcine_wire::SolverNetwork;
use clap::Args;

use super::console::say;
use super::continuation::Line;
use super::execute::{self, Settings};
use super::failure::Failure;
use super::inputs::{read_and_prepare, results_folder};
use super::parallel::{Parallel, Transport};
use crate::assembly::{GasBackend, Pairing, ParticleBackend, SolverStarts};
use crate::exit;

/// Runs a case, natively or with production solvers.
#[derive(Debug, Args)]
pub(super) struct Arguments {
    /// The case file.
    case: PathBuf,
    /// Solver of the gas.
    #[arg(long, value_enum, default_value_t)]
    gas: GasBackend,
    /// Solver of the particles.
    #[arg(long, value_enum, default_value_t)]
    particles: ParticleBackend,
    #[command(flatten)]
    parallel: Parallel,
    /// Results folder [default: results/NAME].
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Changes a key of the case, for example `--set time.acceleration=200`.
    #[arg(long, value_name = "KEY=VALUE")]
    set: Vec<String>,
    /// Continues from the last checkpoint in the results folder; a run that was stopped before its first one starts again.
    #[arg(long)]
    resume: bool,
    /// Starts from the last checkpoint of another run on the same mesh, with this
    /// case's settings and clocks at zero.
    #[arg(long, value_name = "DIR")]
    from: Option<PathBuf>,
    /// Threads of Calcine's own solvers and of the coupling [default: one a core]. Results do not
    /// depend on their number.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..))]
    threads: Option<u16>,
    /// Shows no progress bar.
    #[arg(long)]
    quiet: bool,
    /// Writes a checkpoint and stops after this wall time, for example `23h30m`, `90 s`, or a plain number of seconds.
    #[arg(long, value_name = "TIME", value_parser = wall_time)]
    stop_after: Option<Duration>,
    /// Ends with exit code 6 where a complete run has warnings: of its case, as `check` tells them, or of what left the
    /// range of a law or did not converge.
    #[arg(long)]
    strict: bool,
}

impl Arguments {
    /// True where the solvers talk over MPI.
    pub(super) fn needs_mpi(&self) -> bool {
        let external = self.gas != GasBackend::Native || self.particles != ParticleBackend::Native;
        external && self.parallel.transport() == Transport::Mpi
    }
}

pub(super) fn run(
    arguments: &Arguments,
    network: Option<&Arc<dyn SolverNetwork>>,
) -> Result<u8, Failure> {
    use_threads(arguments.threads.map(usize::from))?;
    let (case, prepared) = read_and_prepare(&arguments.case, &arguments.set)?;
    for change in &case.changes {
        say(format_args!("set {change}"))?;
    }
    let out = results_folder(&case, arguments.out.as_deref());
    let pairing = Pairing {
        gas: arguments.gas,
        particles: arguments.particles,
    };
    let of_case = SolverStarts::of(&case, pairing);
    let starts = arguments.parallel.starts(pairing, &of_case, network)?;
    let line = Line {
        case: &arguments.case,
        out: &out,
        pairing,
        starts: &starts,
        set: &arguments.set,
        threads: arguments.threads,
        strict: arguments.strict,
        quiet: arguments.quiet,
    };
    let settings = Settings {
        pairing,
        starts: &starts,
        transport: arguments.parallel.transport(),
        out: &out,
        resume: arguments.resume,
        from: arguments.from.as_deref(),
        progress: !arguments.quiet,
        stop_after: arguments.stop_after,
        strict: arguments.strict,
        go_on: &format!("continue with\n  {}", line.resume()),
    };
    let done = execute::execute(&case, &prepared, &settings)?;
    // Written before anything is printed: standard output may be lost.
    let complete = [exit::OK, exit::OUTSIDE_BANDS, exit::WARNINGS].contains(&done.code);
    let page = complete.then(|| crate::report::write(&out));
    say(&done.text)?;
    if let Some(page) = page {
        let page = page.map_err(|error| Failure::told(exit::OTHER, &error))?;
        say(format_args!("report: {}", page.display()))?;
    }
    Ok(done.code)
}

/// Starts the threads; this one is one of them, so that no loop is handed over from thread to thread.
fn use_threads(threads: Option<usize>) -> Result<(), Failure> {
    let threads =
        threads.unwrap_or_else(|| std::thread::available_parallelism().map_or(1, usize::from));
    let pool = rayon::ThreadPoolBuilder::new();
    let pool = pool.num_threads(threads).use_current_thread();
    pool.build_global().map_err(|cause| {
        let message = format!("{threads} threads cannot be started: {cause}");
        Failure::new(exit::OTHER, message)
    })
}

/// A wall time such as `90`, `45m`, `23h30m`, `1d`; a bare number is seconds.
fn wall_time(text: &str) -> Result<Duration, String> {
    let wrong = || format!("`{text}` is not a wall time such as 23h30m, 45m or 90s");
    let (mut seconds, mut number) = (0.0, String::new());
    for letter in text.chars() {
        let factor = match letter {
            '0'..='9' | '.' => {
                number.push(letter);
                continue;
            }
            ' ' => continue,
            's' => 1.0,
            'm' => 60.0,
            'h' => 3600.0,
            'd' => 86400.0,
            _ => return Err(wrong()),
        };
        seconds += factor * number.parse::<f64>().map_err(|_| wrong())?;
        number.clear();
    }
    if !number.is_empty() {
        seconds += number.parse::<f64>().map_err(|_| wrong())?;
    }
    if seconds > 0.0 {
        Duration::try_from_secs_f64(seconds).map_err(|_| wrong())
    } else {
        Err(wrong())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_wall_time_is_read_in_days_hours_minutes_and_seconds() {
        assert_eq!(wall_time("23h30m"), Ok(Duration::from_secs(84_600)));
        assert_eq!(wall_time("90"), Ok(Duration::from_secs(90)));
        assert_eq!(wall_time("1 s"), Ok(Duration::from_secs(1)));
        assert_eq!(wall_time("2 h 30 m"), Ok(Duration::from_secs(9000)));
        assert!(wall_time(" ").is_err());
        assert_eq!(wall_time("1d"), Ok(Duration::from_secs(86_400)));
        assert!(wall_time("soon").is_err());
        assert!(wall_time("0s").is_err());
        assert!(wall_time("h").is_err());
    }
}
