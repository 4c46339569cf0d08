//! `calcine tune FILE`.

use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use calcine_tuning::search::SearchEvaluation;
use calcine_tuning::{TargetCurve, TuningError};
use clap::Args;
use signal_hook::consts::{SIGINT, SIGTERM};

use super::console::say;
use super::continuation::Recorded;
use super::failure::Failure;
use super::inputs::holds_files;
use super::shell::word;
use super::tuning_line::Tuning;
use crate::case::units::short;
use crate::case::{kind_of, read_tuning};
use crate::exit;
use crate::report::number::figure;
use crate::results::{ResultsError, files};
use crate::standard_error::tell_line;
use crate::tuning::case::TuningCase;
use crate::tuning::outcome::TuningOutcome;
use crate::tuning::page::write_page;
use crate::tuning::tune::{TuningObserver, tune_sample};
use crate::tuning::write::{EvaluationLog, state, write, write_state};

/// Tunes the parameters of a model to curves, with intervals, and compares kinetic laws.
#[derive(Clone, Debug, Args)]
pub(super) struct Arguments {
    /// The case file, of kind "tuning", or "flowsheet" with a table [tuning]; with `--resume DIR` that of the tuning in DIR, if none is named.
    #[arg(required_unless_present = "resume")]
    case: Option<PathBuf>,
    /// Results folder [default: results/NAME].
    #[arg(long, value_name = "DIR")]
    pub(super) out: Option<PathBuf>,
    /// Changes a key of the case, for example `--set method.seed=2`.
    #[arg(long, value_name = "KEY=VALUE")]
    pub(super) set: Vec<String>,
    /// Goes on with a tuning that was interrupted, in its results folder; the results have the same bits.
    #[arg(long, value_name = "DIR", num_args = 0..=1)]
    pub(super) resume: Option<Option<PathBuf>>,
    /// Threads [default: one a core]. Results do not depend on their number.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..))]
    pub(super) threads: Option<u16>,
    /// Tells nothing while it runs.
    #[arg(long)]
    pub(super) quiet: bool,
}

pub(super) fn run(arguments: &Arguments) -> Result<u8, Failure> {
    super::run::use_threads(arguments.threads.map(usize::from))?;
    let given = |case: &Path, set: &[String], out: Option<&Path>, resume| {
        let kind = kind_of(case, set);
        let kind = kind.map_err(|wrong| Failure::new(exit::CASE, wrong.render()))?;
        if kind.name == "flowsheet" {
            return super::plant::tune(&Tuning {
                case,
                set,
                out,
                resume,
                quiet: arguments.quiet,
            });
        }
        tune(&Tuning {
            case,
            set,
            out,
            resume,
            quiet: arguments.quiet,
        })
    };
    match (&arguments.case, &arguments.resume) {
        (Some(case), None) => given(case, &arguments.set, arguments.out.as_deref(), false),
        // The case, after an option that may have a value.
        (None, Some(Some(case))) if case.is_file() => {
            given(case, &arguments.set, arguments.out.as_deref(), true)
        }
        (Some(case), Some(folder)) => {
            let out = folder.as_deref().or(arguments.out.as_deref());
            given(case, &arguments.set, out, true)
        }
        (None, Some(Some(folder))) => {
            let before = Recorded::read(folder)?;
            given(Path::new(&before.case), &before.options, Some(folder), true)
        }
        (None, _) => {
            let message = "`--resume` needs the results folder of the tuning, or its case: calcine tune --resume DIR";
            Err(Failure::new(exit::CASE, message))
        }
    }
}

/// Tunes a case into its results folder.
pub(super) fn tune(line: &Tuning<'_>) -> Result<u8, Failure> {
    let case = read_tuning(line.case, line.set)
        .map_err(|errors| Failure::new(exit::CASE, errors.render()))?;
    for change in &case.changes {
        say(format_args!("set {change}"))?;
    }
    let out = match line.out {
        Some(out) => out.to_owned(),
        None => PathBuf::from("results").join(&case.name),
    };
    if let Some(done) = before(&case, &out, line.resume)? {
        return Ok(done);
    }
    let failed = |error: ResultsError| Failure::told(exit::OTHER, &error);
    files::directory(&out).map_err(failed)?;
    write_state(&out, &case, "running").map_err(failed)?;
    let recorded = Recorded {
        case: std::path::absolute(line.case)
            .unwrap_or_else(|_| line.case.to_owned())
            .to_string_lossy()
            .into_owned(),
        options: line.set.to_vec(),
    };
    recorded.write(&out)?;
    let stop = Arc::new(AtomicBool::new(false));
    for signal in [SIGINT, SIGTERM] {
        // The second one ends the process.
        let exit = signal_hook::flag::register_conditional_default(signal, Arc::clone(&stop));
        let noted = exit.and_then(|_| signal_hook::flag::register(signal, Arc::clone(&stop)));
        noted.map_err(|cause| {
            Failure::new(exit::OTHER, format!("signals cannot be caught: {cause}"))
        })?;
    }
    let mut watcher = Watcher {
        log: EvaluationLog::open(&out, line.resume),
        quiet: line.quiet,
        generations: case.method.generations,
        wrong: None,
    };
    let names = case.parameters.iter().map(|one| one.name.clone());
    watcher
        .log
        .name(names.collect(), vec!["the compared quantities".into()]);
    let found = tune_sample(&case, &stop, &mut watcher);
    if let Some(error) = watcher.wrong {
        return Err(failed(error));
    }
    let found = match found {
        Ok(found) => found,
        Err(TuningError::Interrupted) if stop.load(Ordering::Relaxed) => {
            write_state(&out, &case, "stopped").map_err(failed)?;
            say(format_args!(
                "stopped; `calcine tune --resume {}` goes on",
                word(out.as_os_str())
            ))?;
            return Ok(exit::CHECKPOINTED);
        }
        Err(error) => {
            write_state(&out, &case, "failed").map_err(failed)?;
            return Err(Failure::new(exit::DIVERGED, error));
        }
    };
    write(&out, &case, &found).map_err(failed)?;
    let page = write_page(&out, &case, &found).map_err(failed)?;
    say(closing(&case, &found))?;
    for warning in &found.warnings {
        tell_line(format_args!("warning: {warning}"));
    }
    say(format_args!("report: {}", page.display()))?;
    Ok(exit::OK)
}

/// What the results folder holds already: nothing to do, an error, or nothing.
fn before(case: &TuningCase, out: &Path, resume: bool) -> Result<Option<u8>, Failure> {
    let place = out.display();
    let refused = |message: String| Err(Failure::new(exit::CASE, message));
    let Some((hash, verdict)) = state(out) else {
        return match (resume, holds_files(out)) {
            (true, _) => refused(format!(
                "{place} holds no tuning that could go on: leave `--resume` out"
            )),
            (false, true) => refused(format!(
                "{place} is not empty and holds no tuning: name another folder with `--out`"
            )),
            (false, false) => Ok(None),
        };
    };
    if !resume {
        return refused(format!(
            "{place} holds the results of another tuning ({verdict}): write elsewhere with `--out DIR`, go on with it by `--resume`, or remove the folder"
        ));
    }
    if hash != case.hash {
        return refused(format!(
            "{place} is of a case with the hash {hash}, this one has {}: resume with the file, the curves and the `--set` values that the tuning began with",
            case.hash
        ));
    }
    if verdict == "finished" {
        say(format_args!("the tuning in {place} is complete"))?;
        return Ok(Some(exit::OK));
    }
    Ok(None)
}

/// Tells how a tuning goes on, and keeps its evaluations.
struct Watcher {
    log: EvaluationLog,
    quiet: bool,
    generations: usize,
    /// The first file that could not be written.
    wrong: Option<ResultsError>,
}

impl TuningObserver for Watcher {
    fn stage(&mut self, name: &str) {
        if !self.quiet {
            tell_line(name);
        }
    }

    fn generation(&mut self, stage: &str, generation: usize, new: &[SearchEvaluation]) {
        if let Err(error) = self.log.add(stage, new) {
            self.wrong.get_or_insert(error);
        }
        let tell = (generation + 1).is_multiple_of(20) || generation + 1 == self.generations;
        if tell && !self.quiet {
            tell_line(format_args!(
                "generation {} of {}",
                generation + 1,
                self.generations
            ));
        }
    }

    fn known(&mut self, stage: &str) -> Vec<SearchEvaluation> {
        self.log.known(stage)
    }
}

/// The numbers of a tuning in a few lines.
fn closing(case: &TuningCase, found: &TuningOutcome) -> String {
    let mut text = String::new();
    if let Some(law) = found.laws.get(found.chosen)
        && found.laws.len() > 1
    {
        text += &format!(
            "law {} of {} compared (Akaike's criterion {:.1})",
            law.law,
            found.laws.len(),
            law.criterion
        );
        let better = found
            .laws
            .iter()
            .filter(|one| one.criterion < law.criterion);
        if let Some(best) = better.min_by(|a, b| a.criterion.total_cmp(&b.criterion)) {
            text += &format!(
                ": {} fits hardly better and has more parameters (Akaike's criterion lower by {:.1})",
                best.law,
                law.criterion - best.criterion
            );
        }
        text.push('\n');
    }
    for one in &found.parameters {
        let space = if one.unit.is_empty() { "" } else { " " };
        text += &format!("{} = {}{space}{}", one.name, number(one.value), one.unit);
        if let Some([low, high]) = one.interval.or(one.bootstrap) {
            let level = figure(100.0 * case.intervals.level, 3);
            text += &format!("  ({level} %: {} to {})", number(low), number(high));
        }
        text.push('\n');
    }
    for ((name, sum), count) in found.objectives.iter().zip(&found.sums).zip(&found.counts) {
        let rms = (sum / (*count).max(1) as f64).sqrt();
        text += &format!(
            "{name}: root mean square of {count} differences {}\n",
            short(rms)
        );
    }
    text.trim_end().to_owned()
}

/// A number as the end of a tuning shows it: six digits, with an exponent from ten millions on.
fn number(value: f64) -> String {
    let text = short(value);
    match text.parse::<f64>() {
        Ok(rounded) if rounded.abs() >= 1e7 => format!("{rounded:e}"),
        _ => text,
    }
}

/// The rate of a target's ramp, or where it holds longer than it heats, its mean one.
fn rate(target: &TargetCurve) -> String {
    let programme = &target.run.programme;
    match programme.ramp_rate() {
        Some(rate) => format!("{} K/min", figure(60.0 * rate, 3)),
        None => format!(
            "{} K/min in the mean, with holds",
            figure(60.0 * programme.heating_rate(), 3)
        ),
    }
}

/// `calcine check` of a tuning.
pub(super) fn check(path: &Path, set: &[String]) -> Result<u8, Failure> {
    let case =
        read_tuning(path, set).map_err(|errors| Failure::new(exit::CASE, errors.render()))?;
    let mut text = format!("{}: {}\n", path.display(), case.title);
    for one in &case.parameters {
        let scale = if one.logarithmic {
            ", by its logarithm"
        } else {
            ""
        };
        let unit = crate::tuning::write::unit_name(one.dimension);
        text += &format!(
            "    parameter {}: {} to {} {unit}{scale}\n",
            one.name,
            short(one.low),
            short(one.high)
        );
    }
    for (target, start) in case.targets.iter().zip(&case.starts) {
        let names: Vec<&str> = target
            .values
            .iter()
            .map(|(quantity, _)| quantity.name())
            .collect();
        let (from, to) = (
            target.run.times[0],
            target.run.times.last().copied().unwrap_or(0.0),
        );
        let temperature = |time: f64| target.run.programme.at(time).0 - 273.15;
        text += &format!(
            "    target {}: {} over {} times, {:.1} to {:.1} °C at {}\n",
            target.name,
            names.join(", "),
            target.run.times.len(),
            temperature(from),
            temperature(to),
            rate(target)
        );
        if let Some(start) = start {
            let from = match start.rows {
                None => "as stated".into(),
                Some(1) => "the first value".into(),
                Some(rows) => format!("the mean of the first {rows}"),
            };
            text += &format!(
                "        masses relative to {} {}, {from}\n",
                figure(start.written, 6),
                start.unit
            );
        }
    }
    for target in &case.kept_back {
        text += &format!(
            "    target {}: kept back, {} times at {}\n",
            target.name,
            target.run.times.len(),
            rate(target)
        );
    }
    let laws = case.model.laws.iter().map(|one| one.law.name);
    text += &format!("    laws: {}\n", laws.collect::<Vec<_>>().join(", "));
    if let [only] = &case.model.reactions[..] {
        text += &format!("    mass loss of the reactant: {:.4}\n", only.mass_loss);
    }
    for warning in &case.warnings {
        text += &format!("    warning: {warning}\n");
    }
    say(text.trim_end())?;
    Ok(exit::OK)
}

/// `calcine report` of a tuning: the page was written with the results.
pub(super) fn page(folder: &Path) -> Result<PathBuf, ResultsError> {
    let path = folder.join(crate::report::REPORT);
    match path.is_file() {
        true => Ok(path),
        false => Err(ResultsError::NoResults {
            path: folder.to_owned(),
            fact: "its tuning has not come to its end",
        }),
    }
}
