//! `calcine run CASE`.

use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Duration;

use calcine_wire::SolverNetwork;
use clap::{Args, Parser};

use super::console::say;
use super::continuation::{Line, Recorded};
use super::execute::{self, Settings};
use super::failure::Failure;
use super::inputs::{read_and_prepare, results_folder};
use super::parallel::{Parallel, Transport, crowded};
use super::shell::word;
use super::told_as_json;
use crate::assembly::{GasBackend, Pairing, ParticleBackend, SolverStarts, pairing_cautions};
use crate::exit;

/// Runs a case, natively or with production solvers.
#[derive(Clone, Debug, Args)]
pub(super) struct Arguments {
    /// The case file; with `--resume DIR` that of the run in DIR, if none is named.
    #[arg(required_unless_present = "resume")]
    case: Option<PathBuf>,
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
    pub(super) out: Option<PathBuf>,
    /// Changes a key of the case, for example `--set time.acceleration=200`.
    #[arg(long, value_name = "KEY=VALUE")]
    pub(super) set: Vec<String>,
    /// Continues from the last checkpoint in the results folder; a run that was stopped before its first one starts again.
    /// `--resume DIR` alone takes case, `--set` and solvers from the run in DIR.
    #[arg(long, value_name = "DIR", num_args = 0..=1)]
    pub(super) resume: Option<Option<PathBuf>>,
    /// Starts from the last checkpoint of another run on the same mesh, with this
    /// case's settings and clocks at zero.
    #[arg(long, value_name = "DIR")]
    pub(super) from: Option<PathBuf>,
    /// Threads of Calcine's own solvers and of the coupling [default: one a core]. Results do not
    /// depend on their number.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..))]
    pub(super) threads: Option<u16>,
    /// Shows no progress bar.
    #[arg(long)]
    pub(super) quiet: bool,
    /// Writes a checkpoint and stops after this wall time, for example `23h30m`, `90 s`, or a plain number of seconds.
    #[arg(long, value_name = "TIME", value_parser = wall_time)]
    pub(super) stop_after: Option<Duration>,
    /// Stops with a checkpoint where the process that started it ends: of the runs of a sweep.
    #[arg(long, hide = true)]
    pub(super) with_parent: bool,
    /// Ends with exit code 6 where a complete run has warnings: of its case, as `check` tells them, or of what left the
    /// range of a law or did not converge.
    #[arg(long)]
    strict: bool,
    /// Prints one line of JSON at the end in place of text: `exit_code`, `out`, `report` of a complete run, `summary` with what
    /// `summary.json` has, and `error` of a run that failed; what has none is null. Shows no progress bar.
    #[arg(long)]
    json: bool,
}

impl Arguments {
    /// True where the solvers talk over MPI.
    fn needs_mpi(&self) -> bool {
        let external = self.gas != GasBackend::Native || self.particles != ParticleBackend::Native;
        external && self.parallel.transport() == Transport::Mpi
    }

    /// Prints the line of `--json` of a run that failed.
    pub(super) fn tell_failure(&self, failure: &Failure) -> Result<(), Failure> {
        if !self.json {
            return Ok(());
        }
        say(told_as_json::failed(failure)?)
    }

    /// An option that is given and that only beds have.
    pub(super) fn of_beds(&self) -> Option<&'static str> {
        let own = [
            ("--gas", self.gas != GasBackend::Native),
            ("--particles", self.particles != ParticleBackend::Native),
            ("--threads", self.threads.is_some()),
            ("--strict", self.strict),
            ("--json", self.json),
        ];
        let given = own.iter().find(|(_, given)| *given).map(|(name, _)| *name);
        given.or_else(|| self.parallel.given())
    }

    /// The arguments with what `--resume DIR` stands for, and the case.
    pub(super) fn completed(&self) -> Result<(Self, PathBuf), Failure> {
        let refused = |message: String| Err(Failure::new(exit::CASE, message));
        match (&self.case, &self.resume) {
            (Some(case), Some(Some(folder))) => {
                if let Some(out) = self.out.as_ref().filter(|out| *out != folder) {
                    return refused(format!(
                        "`--resume {}` and `--out {}` name two results folders; name one",
                        folder.display(),
                        out.display()
                    ));
                }
                let out = Some(folder.clone());
                Ok((Self { out, ..self.clone() }, case.clone()))
            }
            (Some(case), _) => Ok((self.clone(), case.clone())),
            // The case, after an option that may have a value.
            (None, Some(Some(case))) if case.is_file() => Ok((self.clone(), case.clone())),
            (None, Some(Some(folder))) => self.of_folder(folder),
            (None, _) => refused(
                "`--resume` needs the results folder of the run, or its case: calcine run --resume DIR".into(),
            ),
        }
    }

    /// The arguments of the run in a results folder, with what limits or shows this stretch of it.
    fn of_folder(&self, folder: &Path) -> Result<(Self, PathBuf), Failure> {
        let own = [
            ("--set", !self.set.is_empty()),
            ("--gas", self.gas != GasBackend::Native),
            ("--particles", self.particles != ParticleBackend::Native),
            ("--from", self.from.is_some()),
            ("--out", self.out.is_some()),
        ];
        let given = own.iter().find(|(_, given)| *given).map(|(name, _)| *name);
        if let Some(option) = given.or_else(|| self.parallel.given()) {
            let message = format!(
                "`{option}` beside `--resume {0}`, which takes it from the run in {0}: leave it out, or name the case as well",
                folder.display()
            );
            return Err(Failure::new(exit::CASE, message));
        }
        let recorded = Recorded::read(folder)?;
        let words = ["calcine", "--resume"].into_iter();
        let words = words.chain(recorded.options.iter().map(String::as_str));
        let before = RecordedLine::try_parse_from(words).map_err(|error| {
            Failure::new(
                exit::CASE,
                format!("the command that is kept in {}: {error}", folder.display()),
            )
        })?;
        let before = before.arguments;
        recorded.needs_case(folder)?;
        let arguments = Self {
            out: Some(folder.to_owned()),
            threads: self.threads.or(before.threads),
            quiet: self.quiet || before.quiet,
            strict: self.strict || before.strict,
            stop_after: self.stop_after,
            json: self.json,
            ..before
        };
        Ok((arguments, recorded.case.into()))
    }
}

/// The options of a run as its results folder keeps them.
#[derive(Debug, Parser)]
struct RecordedLine {
    #[command(flatten)]
    arguments: Arguments,
}

/// Runs the case of a bed, with [`Arguments::completed`] arguments. Without a network, one whose solvers talk over MPI is
/// handed over.
pub(super) fn run(
    arguments: &Arguments,
    case_file: &Path,
    network: Option<&Arc<dyn SolverNetwork>>,
    hand_over: fn() -> Failure,
) -> Result<u8, Failure> {
    if network.is_none() && arguments.needs_mpi() {
        return Err(hand_over());
    }
    use_threads(arguments.threads.map(usize::from))?;
    let (mut case, prepared) = read_and_prepare(case_file, &arguments.set)?;
    for change in case.changes.iter().filter(|_| !arguments.json) {
        say(format_args!("set {change}"))?;
    }
    let out = results_folder(&case, arguments.out.as_deref());
    let pairing = Pairing {
        gas: arguments.gas,
        particles: arguments.particles,
    };
    let of_case = SolverStarts::of(&case, pairing);
    let starts = arguments.parallel.starts(pairing, &of_case, network)?;
    let of_solvers = pairing_cautions(&case, &prepared, pairing);
    case.warnings.extend(of_solvers);
    case.warnings.extend(crowded(&starts, pairing));
    let line = Line {
        case: case_file,
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
        resume: arguments.resume.is_some(),
        from: arguments.from.as_deref(),
        progress: !arguments.quiet && !arguments.json,
        stop_after: arguments.stop_after,
        strict: arguments.strict,
        recorded: line.recorded(),
        go_on: &format!(
            "`calcine run --resume {}` goes on, as does\n  {}",
            word(out.as_os_str()),
            line.resume()
        ),
    };
    let done = execute::execute(&case, &prepared, &settings);
    let done = done.map_err(|failure| failure.of_run(&out))?;
    // Written before anything is printed: standard output may be lost.
    let complete = [exit::OK, exit::OUTSIDE_BANDS, exit::WARNINGS].contains(&done.code);
    let page = complete.then(|| crate::report::write(&out));
    if arguments.json {
        let page = page.transpose();
        let page = page.map_err(|error| Failure::told(exit::OTHER, &error))?;
        say(told_as_json::line(done.code, &out, page.as_deref())?)?;
        return Ok(done.code);
    }
    say(&done.text)?;
    if let Some(page) = page {
        let page = page.map_err(|error| Failure::told(exit::OTHER, &error))?;
        say(format_args!("report: {}", page.display()))?;
    }
    Ok(done.code)
}

/// Starts the threads; this one is one of them, so that no loop is handed over from thread to thread.
pub(super) fn use_threads(threads: Option<usize>) -> Result<(), Failure> {
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
