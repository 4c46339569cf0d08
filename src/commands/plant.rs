//! Commands with cases of plants.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use calcine_coupler::supervisor::Interrupts;
use calcine_wire::SolverNetwork;

use super::console::say;
use super::continuation::{Recorded, begin_again};
use super::failure::Failure;
use super::inputs::holds_files;
use super::shell::word;
use super::signals::SignalThread;
use super::sweep_table::SweepTable;
use super::tuning_line::Tuning;
use super::{check, compare, run, sweep, sweep_axes};
use crate::case::plant::{PlantCase, read_plant};
use crate::exit;
use crate::plant::{
    PlantEnding, PlantRunError, PlantStart, PlantSummary, plant_check, plant_closing, run_plant,
    write_plant_report,
};
use crate::report::overview::SweptResult;
use crate::results::Verdict;
use crate::results::summary::QuantityResult;

impl From<PlantRunError> for Failure {
    fn from(error: PlantRunError) -> Self {
        let help = error.help().map(|help| format!("\n  help: {help}"));
        let told = super::failure::chain(&error) + &help.unwrap_or_default();
        Failure::new(error.exit_code(), told)
    }
}

/// Reads the case of a plant; all its errors at once. Every value of a continuation is read too.
fn read(path: &Path, set: &[String]) -> Result<PlantCase, Failure> {
    let wrong = |errors: crate::case::CaseErrors| Failure::new(exit::CASE, errors.render());
    let case = read_plant(path, set).map_err(wrong)?;
    if let Some(spec) = &case.continuation {
        for value in &spec.values {
            let settings = [set, &spec.settings(*value)].concat();
            read_plant(path, &settings).map_err(wrong)?;
        }
    }
    Ok(case)
}

/// The results folder: that of `--out`, or results/NAME.
fn folder(case: &PlantCase, out: Option<&Path>) -> PathBuf {
    out.map_or_else(|| Path::new("results").join(&case.name), Path::to_owned)
}

fn refused<T>(message: impl std::fmt::Display) -> Result<T, Failure> {
    Err(Failure::new(exit::CASE, message))
}

fn code(summary: &PlantSummary) -> u8 {
    match summary.verdict {
        Verdict::Fail => exit::OUTSIDE_BANDS,
        _ => exit::OK,
    }
}

/// How a run begins, and whether it is to end early.
#[derive(Default)]
struct Begin<'a> {
    resume: bool,
    from: Option<&'a Path>,
    command: Option<String>,
    tuned: bool,
    stop_after: Option<std::time::Duration>,
}

impl Begin<'_> {
    /// The last of a tuning, at its start or with what is there.
    fn of_tuning(resume: bool) -> Self {
        Self {
            resume,
            tuned: true,
            ..Self::default()
        }
    }
}

/// Runs a case into a folder and tells how it ended.
fn into_folder(
    case: &PlantCase,
    out: &Path,
    begin: Begin<'_>,
    quiet: bool,
    go_on: &str,
) -> Result<(u8, Option<PlantSummary>), Failure> {
    let interrupts = Interrupts::default();
    let _signals = SignalThread::start(&interrupts, begin.stop_after)?;
    let start = PlantStart {
        out,
        resume: begin.resume,
        from: begin.from,
        command: begin.command,
        tuned: begin.tuned,
        progress: !quiet,
        interrupts,
    };
    match run_plant(case, &start)? {
        PlantEnding::Finished(summary) => Ok((code(&summary), Some(*summary))),
        PlantEnding::Complete(summary) => {
            say(format_args!(
                "the run in {} is already complete",
                out.display()
            ))?;
            Ok((code(&summary), None))
        }
        PlantEnding::Checkpointed(path) => {
            say(format_args!(
                "stopped with a checkpoint in {}; {go_on}",
                path.display()
            ))?;
            Ok((exit::CHECKPOINTED, None))
        }
    }
}

/// `calcine run` of a plant.
pub(super) fn run(
    arguments: &run::Arguments,
    case_file: &Path,
    _network: Option<&Arc<dyn SolverNetwork>>,
    _hand_over: fn() -> Failure,
) -> Result<u8, Failure> {
    if let Some(option) = arguments.of_beds() {
        return refused(format_args!(
            "`{option}` goes with beds: a plant has no solvers to choose; leave it out"
        ));
    }
    let case = read(case_file, &arguments.set)?;
    for change in &case.changes {
        say(format_args!("set {change}"))?;
    }
    let out = folder(&case, arguments.out.as_deref());
    let mut options: Vec<String> = Vec::new();
    for setting in &arguments.set {
        options.extend(["--set".to_owned(), setting.clone()]);
    }
    if arguments.quiet {
        options.push("--quiet".into());
    }
    let path = std::path::absolute(case_file).unwrap_or_else(|_| case_file.to_owned());
    let recorded = path.to_str().map(|case| Recorded {
        case: case.to_owned(),
        options,
    });
    let go_on = format!("`calcine run --resume {}` goes on", word(out.as_os_str()));
    let begin = Begin {
        command: recorded.as_ref().and_then(Recorded::json),
        resume: arguments.resume.is_some(),
        from: arguments.from.as_deref(),
        stop_after: arguments.stop_after,
        tuned: false,
    };
    let (code, summary) = into_folder(&case, &out, begin, arguments.quiet, &go_on)?;
    if let Some(summary) = summary {
        let page = write_plant_report(&out);
        say(plant_closing(&summary))?;
        let page = page.map_err(|error| Failure::told(exit::OTHER, &error))?;
        say(format_args!("report: {}", page.display()))?;
    }
    Ok(code)
}

/// `calcine tune` of a plant: fits its keys, then runs it with what was found.
pub(super) fn tune(line: &Tuning<'_>) -> Result<u8, Failure> {
    let (case_file, set, quiet) = (line.case, line.set, line.quiet);
    let case = read(case_file, set)?;
    let Some(spec) = &case.tuning else {
        return refused(format_args!(
            "{} has no table [tuning]: add one with the keys and the measurements (docs/how-to/plant-with-a-recycle.md)",
            case_file.display()
        ));
    };
    if let Some(bed) = case.beds.first() {
        return refused(format_args!(
            "a plant with a bed (\"{}\") is not tuned: put a granulator with its kernel in the bed's place",
            bed.unit
        ));
    }
    for change in &case.changes {
        say(format_args!("set {change}"))?;
    }
    // Every key is tried at its bounds before the first run.
    for key in &spec.parameters {
        for bound in key.bounds {
            read(case_file, &[set, &[key.setting(bound)]].concat())?;
        }
    }
    let out = folder(&case, line.out);
    let hash = crate::plant::trials::hash_of(&case, spec);
    if let Some(code) = tuned_before(&hash, &out, line.resume)? {
        return Ok(code);
    }
    std::fs::create_dir_all(&out).map_err(|cause| Failure::unwritable(&out, "--out", &cause))?;
    let path = std::path::absolute(case_file).unwrap_or_else(|_| case_file.to_owned());
    let recorded = Recorded {
        case: path.to_string_lossy().into_owned(),
        options: set.to_vec(),
    };
    recorded.write(&out)?;
    let interrupts = Interrupts::default();
    let signals = SignalThread::start(&interrupts, None)?;
    let found = crate::plant::tune::tune_plant(&case, spec, &out, line.resume, &interrupts);
    drop(signals);
    let go_on = format!("`calcine tune --resume {}` goes on", word(out.as_os_str()));
    let found = match found {
        Ok(found) => found,
        Err(calcine_tuning::TuningError::Interrupted) => {
            say(format_args!("stopped; {go_on}"))?;
            return Ok(exit::CHECKPOINTED);
        }
        Err(error) => return Err(Failure::new(exit::DIVERGED, error)),
    };
    let best = found.parameters.iter().zip(&spec.parameters);
    let best: Vec<String> = best.map(|(one, key)| key.setting(one.value)).collect();
    let tuned = read(case_file, &[set, &best].concat())?;
    // The run with what was found may have begun before.
    let begun = out.join(crate::results::SUMMARY).exists();
    let (code, summary) = into_folder(&tuned, &out, Begin::of_tuning(begun), quiet, &go_on)?;
    if code == exit::CHECKPOINTED {
        return Ok(code);
    }
    let failed = |error: crate::results::ResultsError| Failure::told(exit::OTHER, &error);
    let mut summary = match summary {
        Some(summary) => summary,
        None => PlantSummary::read(&out).map_err(failed)?,
    };
    summary.tuning = Some(found);
    summary.replace(&out).map_err(failed)?;
    let page = write_plant_report(&out);
    say(plant_closing(&summary))?;
    say(format_args!("report: {}", page.map_err(failed)?.display()))?;
    Ok(code)
}

/// What the folder of a tuning holds already: an end, an error, or nothing that is in the way.
fn tuned_before(own: &str, out: &Path, resume: bool) -> Result<Option<u8>, Failure> {
    let place = out.display();
    let is_run = out.join(crate::results::SUMMARY).exists();
    match (resume, crate::plant::trials::trials_of(out)) {
        (false, None) if is_run => refused(format_args!(
            "{place} holds results: name another folder with `--out`"
        )),
        (false, None) if holds_files(out) => refused(format_args!(
            "{place} is not empty and holds no tuning: name another folder with `--out`"
        )),
        (false, None) => Ok(None),
        (false, Some(_)) => refused(format_args!(
            "{place} holds another tuning: write elsewhere with `--out DIR`, go on with it by `--resume`, or remove the folder"
        )),
        (true, None) => refused(format_args!(
            "{place} holds no tuning that could go on: leave `--resume` out"
        )),
        (true, Some(hash)) if hash != own => refused(format_args!(
            "{place} is of a case with the hash {hash}, this one has {own}: resume with the file, the measurements and the `--set` values that the tuning began with"
        )),
        (true, Some(_)) if is_run => {
            let summary =
                PlantSummary::read(out).map_err(|error| Failure::told(exit::OTHER, &error))?;
            if summary.tuning.is_none() {
                return Ok(None);
            }
            say(format_args!("the tuning in {place} is complete"))?;
            Ok(Some(code(&summary)))
        }
        (true, Some(_)) => Ok(None),
    }
}

/// `calcine check` of a plant.
pub(super) fn check(arguments: &check::Arguments) -> Result<u8, Failure> {
    let case = read(&arguments.case, &arguments.set)?;
    say(plant_check(&case)?.trim_end())?;
    Ok(exit::OK)
}

/// `calcine compare` of a plant: recycles closed at every evaluation against waveform relaxation, or two results.
pub(super) fn compare(arguments: &compare::Arguments) -> Result<u8, Failure> {
    let case = read(&arguments.case, &arguments.set)?;
    let told = |error: &crate::results::ResultsError| Failure::told(exit::OTHER, error);
    if let [one, other] = &arguments.results[..] {
        let names = [one, other].map(|path| path.display().to_string());
        let names = [names[0].as_str(), names[1].as_str()];
        let found = crate::plant::compare::compare(&case, names, [one, other]);
        let found = found.map_err(|error| told(&error))?;
        say(found.text.trim_end())?;
        return Ok(match found.agrees {
            true => exit::OK,
            false => exit::OUTSIDE_BANDS,
        });
    }
    if !arguments.results.is_empty() {
        return refused("`--results` takes two folders: --results DIR,DIR");
    }
    let out = arguments.out.clone().unwrap_or_else(|| {
        let mut folder = folder(&case, None).into_os_string();
        folder.push("-compare");
        folder.into()
    });
    let go_on = begin_again("comparison", &out);
    let methods = ["monolithic", "waveform"];
    for method in methods {
        let mut set = arguments.set.clone();
        set.push(format!("method.recycles={method}"));
        let case = read(&arguments.case, &set)?;
        say(format_args!("{method}:"))?;
        let (code, summary) = into_folder(
            &case,
            &out.join(method),
            Begin::default(),
            arguments.quiet,
            &go_on,
        )?;
        match summary {
            Some(summary) => say(plant_closing(&summary))?,
            None => return Ok(code),
        }
    }
    let folders = methods.map(|method| out.join(method));
    let found = crate::plant::compare::compare(&case, methods, [&folders[0], &folders[1]]);
    let found = found.map_err(|error| told(&error))?;
    say(found.text.trim_end())?;
    Ok(match found.agrees {
        true => exit::OK,
        false => exit::OUTSIDE_BANDS,
    })
}

/// `calcine sweep` of a plant.
pub(super) fn sweep(arguments: &sweep::Arguments) -> Result<u8, Failure> {
    if let Some(option) = arguments.of_beds() {
        return refused(format_args!("`{option}` goes with beds; leave it out"));
    }
    let base = read(&arguments.case, &[])?;
    let out = arguments.out.clone().unwrap_or_else(|| {
        let mut folder = folder(&base, None).into_os_string();
        folder.push("-sweep");
        folder.into()
    });
    let (names, combinations) = sweep_axes::combinations(&arguments.set)?;
    let jobs = sweep_axes::jobs(&out, combinations);
    // Every case is read before the first one runs.
    for job in arguments.chosen(&jobs)? {
        read(&arguments.case, &job.settings)?;
    }
    if let Some(path) = &arguments.table {
        sweep::table_is_free(path)?;
    }
    sweep::own_table(&out, names.iter().map(String::as_str))?;
    sweep::own_runs(&out, &jobs)?;
    let kind = sweep::Kind {
        name: &base.name,
        title: &base.title,
        result: &|folder| {
            let summary = PlantSummary::read(folder).ok();
            summary.filter(PlantSummary::is_complete).map(swept)
        },
        table: &|points| sweep_table(&names, points),
        report: write_plant_report,
    };
    arguments.follow(&jobs, (&out, Vec::new()), &kind)
}

/// What came out of a run of a sweep.
fn swept(summary: PlantSummary) -> SweptResult {
    let mut quantities = summary.quantities;
    if let Some(mode) = &summary.stability {
        let of = |value: Option<f64>, unit: &str| QuantityResult {
            value,
            unit: unit.into(),
            at_s: None,
            band: None,
            expected_at_s: None,
            verdict: Verdict::None,
        };
        quantities.insert(
            "growth_rate".into(),
            of(Some(mode.growth_rate_per_s), "1/s"),
        );
        quantities.insert("period".into(), of(mode.period_s, "s"));
    }
    SweptResult {
        verdict: summary.verdict,
        warnings: 0,
        quantities,
        wall_time_s: summary.wall_time_s,
    }
}

/// The table of a sweep: the settings, the wall time, the quantities, and what the plant does.
fn sweep_table(names: &[String], points: &[sweep::Point<'_>]) -> Result<SweepTable, Failure> {
    let mut table = SweepTable {
        header: names.to_vec(),
        rows: Vec::new(),
    };
    let mut verdicts = Vec::new();
    for point in points {
        let mut row = sweep_axes::values(&point.job.settings);
        if point.end.is_complete() {
            let summary = PlantSummary::read(&point.job.folder);
            let summary = summary.map_err(|error| Failure::told(exit::OTHER, &error))?;
            table.put(&mut row, "s", format!("{:.2}", summary.wall_time_s));
            for (name, quantity) in &summary.quantities {
                let value = quantity.value;
                let value = value.map_or("none".into(), |value| format!("{value:.7}"));
                table.put(&mut row, &format!("{name} {}", quantity.unit), value);
            }
            if let Some(mode) = &summary.stability {
                let rate = format!("{:.5e}", mode.growth_rate_per_s);
                table.put(&mut row, "growth rate 1/s", rate);
                let period = mode.period_s;
                let period = period.map_or("none".into(), |period| format!("{period:.2}"));
                table.put(&mut row, "period s", period);
            }
        }
        verdicts.push(sweep::ending(point.end.code));
        table.rows.push(row);
    }
    table.close("ended", verdicts);
    Ok(table)
}
