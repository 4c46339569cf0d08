//! `calcine sweep CASE --set key=a,b,c`.

use std::fs::File;
use std::path::{Path, PathBuf};

use clap::Args;

use super::console::{printed, say};
use super::failure::Failure;
use super::inputs::{own_or_new, read_case, results_folder};
use super::jobs::{Job, JobEnd, JobEvent, Jobs};
use super::sweep_axes::{axes, combine, jobs, keys, values};
use super::sweep_table::{SweepTable, TABLE};
use crate::assembly::{GasBackend, ParticleBackend};
use crate::compare::deviation::{Deviation, deviation};
use crate::exit;
use crate::report;
use crate::report::overview::{OVERVIEW, Overview, SweptEnd, SweptResult, SweptRun, own_overview};
use crate::results::files::{REPORT, directory};
use crate::results::read::Series;
use crate::results::{CaseIdentity, ResultsError, SUMMARY, Summary, same_case};
use crate::simulation::{self, OWN_LOG};
use crate::standard_error::{tell, tell_line};

/// Runs a case once for each combination of values and prints one table.
///
/// The same command again keeps the runs that have ended and goes on with those that have not.
///
/// `--reference KEY=VALUE` names the runs that the others are compared with: each run against the
/// one that differs from it in that key alone, particle by particle.
#[derive(Debug, Args)]
pub(super) struct Arguments {
    /// The case file.
    pub(super) case: PathBuf,
    /// Solver of the gas.
    #[arg(long, value_enum, default_value_t)]
    gas: GasBackend,
    /// Solver of the particles.
    #[arg(long, value_enum, default_value_t)]
    particles: ParticleBackend,
    /// Values of a key, separated by commas: `--set time.acceleration=1,50,200`.
    #[arg(long, value_name = "KEY=A,B,C", required = true)]
    pub(super) set: Vec<String>,
    /// Value of one swept key with which the others are compared.
    #[arg(long, value_name = "KEY=VALUE")]
    reference: Option<String>,
    /// What deviations are divided by, in K [default: the reference's own span of temperatures].
    #[arg(long, value_name = "KELVIN", requires = "reference", value_parser = above_zero)]
    span: Option<f64>,
    /// Folder of the sweep [default: results/NAME-sweep].
    #[arg(long, value_name = "DIR")]
    pub(super) out: Option<PathBuf>,
    /// Runs at once, each with its share of the cores.
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u16).range(1..))]
    jobs: u16,
    /// Runs the K-th combination alone, the first being 1, as one task of a queue's array. Values of the last `--set` change
    /// fastest.
    #[arg(long, value_name = "K", value_parser = clap::value_parser!(u32).range(1..))]
    only: Option<u32>,
    /// Runs nothing: makes the table and the page of the runs that have ended.
    #[arg(long, conflicts_with_all = ["only", "jobs"])]
    gather: bool,
    /// Also writes the table to this file, as Markdown.
    #[arg(long, value_name = "FILE")]
    pub(super) table: Option<PathBuf>,
    /// Shows no progress bar.
    #[arg(long)]
    pub(super) quiet: bool,
}

fn above_zero(text: &str) -> Result<f64, String> {
    let number = text.parse::<f64>().ok();
    number
        .filter(|number| number.is_finite() && *number > 0.0)
        .ok_or_else(|| "it needs a number above 0, in K".into())
}

impl Arguments {
    /// An option that is given and that only beds have.
    pub(super) fn of_beds(&self) -> Option<&'static str> {
        let own = [
            ("--gas", self.gas != GasBackend::Native),
            ("--particles", self.particles != ParticleBackend::Native),
            ("--reference", self.reference.is_some()),
        ];
        own.iter().find(|(_, given)| *given).map(|(name, _)| *name)
    }
}

pub(super) fn run(arguments: &Arguments) -> Result<u8, Failure> {
    let axes = axes(&arguments.set)?;
    let reference = arguments.reference.as_deref();
    if let Some(value) = reference
        && !axes.iter().flatten().any(|setting| setting == value)
    {
        let message = format!("`--reference {value}` is not among the values of `--set`");
        return Err(Failure::new(exit::CASE, message));
    }
    let base = read_case(&arguments.case, &[])?;
    let out = arguments.out.clone().unwrap_or_else(|| {
        let mut folder = results_folder(&base, None).into_os_string();
        folder.push("-sweep");
        folder.into()
    });
    let jobs = jobs(&out, combine(&axes));
    own_table(&out, keys(&axes))?;
    own_runs(&out, &jobs)?;
    // Every case and folder is checked before the first one runs, and that the table can be written after the last one.
    if let Some(path) = &arguments.table {
        table_is_free(path)?;
    }
    for job in arguments.chosen(&jobs)? {
        let case = read_case(&arguments.case, &job.settings)?;
        if job.folder.join(SUMMARY).exists() {
            let kept = Summary::read(&job.folder);
            let same = kept
                .and_then(|kept| same_case(&job.folder, &kept.case.hash, CaseIdentity::of(&case)));
            same.map_err(|error| Failure::told(exit::CASE, &error))?;
        }
    }
    let mut options = Vec::new();
    for (option, name) in [
        ("--gas", arguments.gas.name()),
        ("--particles", arguments.particles.name()),
    ] {
        options.extend([option.to_owned(), name.to_owned()]);
    }
    if arguments.jobs > 1 {
        let cores = std::thread::available_parallelism().map_or(1, usize::from);
        let threads = (cores / usize::from(arguments.jobs)).max(1);
        options.extend(["--threads".to_owned(), threads.to_string()]);
    }
    let kind = Kind {
        name: &base.name,
        title: &base.title,
        result: &|folder| simulation::finished(folder).map(|summary| result(&summary)),
        table: &|points| table(points, &axes, reference, arguments.span),
        report: report::write,
    };
    arguments.follow(&jobs, (&out, options), &kind)
}

/// What a sweep asks of the kind of its case.
pub(super) struct Kind<'a> {
    /// Name of the case.
    pub(super) name: &'a str,
    /// Its title.
    pub(super) title: &'a str,
    /// What came out of a run, where it is complete.
    pub(super) result: &'a dyn Fn(&Path) -> Option<SweptResult>,
    /// The table of the runs that have ended.
    pub(super) table: &'a dyn Fn(&[Point<'_>]) -> Result<SweepTable, Failure>,
    /// Writes the report of a run.
    pub(super) report: fn(&Path) -> Result<PathBuf, ResultsError>,
}

/// One run of the sweep that has ended.
pub(super) struct Point<'a> {
    /// Which one.
    pub(super) job: &'a Job,
    /// How.
    pub(super) end: &'a JobEnd,
}

impl Arguments {
    /// The runs that this command is to make.
    pub(super) fn chosen<'j>(&self, jobs: &'j [Job]) -> Result<&'j [Job], Failure> {
        let Some(number) = self.only else {
            return Ok(jobs);
        };
        let place = number as usize - 1;
        jobs.get(place..=place).ok_or_else(|| {
            let message = format!(
                "`--only {number}`: there are {} combinations, numbered from 1",
                jobs.len()
            );
            Failure::new(exit::CASE, message)
        })
    }

    /// Follows the runs, and keeps the table and the page of those that have ended in the folder of the sweep. Gives the exit code.
    pub(super) fn follow(
        &self,
        jobs: &[Job],
        (out, options): (&Path, Vec<String>),
        kind: &Kind<'_>,
    ) -> Result<u8, Failure> {
        let runs = Jobs {
            case: &self.case,
            options,
            at_once: self.jobs.into(),
            quiet: self.quiet,
        };
        let sweep = Sweep { jobs, out, kind };
        directory(out).map_err(|error| Failure::told(exit::OTHER, &error))?;
        let mut gathered = sweep.gather()?;
        let chosen = self.chosen(jobs)?;
        if !self.gather {
            if !self.quiet && self.only.is_none() {
                let ended = gathered.0.iter().flatten().count();
                tell_line(format_args!(
                    "{} runs, {} at once; {ended} have ended before",
                    jobs.len(),
                    self.jobs
                ));
            }
            let ends = runs.follow(chosen, |event| {
                match event {
                    JobEvent::Begins(_) | JobEvent::UnderWay(..) if self.quiet => {}
                    JobEvent::Begins(place) => {
                        let number = self.only.map_or(place + 1, |number| number as usize);
                        let kept = gathered.0[number - 1].as_ref();
                        if !kept.is_some_and(JobEnd::is_complete) {
                            let settings = chosen[place].settings.join("  ");
                            tell_line(format_args!("run {number} of {}: {settings}", jobs.len()));
                        }
                    }
                    JobEvent::UnderWay(ended, places) => {
                        let under_way = places.iter().map(|&place| &chosen[place]);
                        tell_line(progress(ended, chosen.len(), under_way));
                    }
                    JobEvent::Ended(place, end) => {
                        let settings = chosen[place].settings.join("  ");
                        say(format_args!("{settings}  {}", ending(end.code)))?;
                        tell_of(&settings, end);
                        gathered = sweep.gather()?;
                    }
                    JobEvent::Stopped(place, end) => {
                        tell_of(&chosen[place].settings.join("  "), end);
                    }
                }
                Ok(())
            })?;
            if self.only.is_some() {
                return Ok(exit_code(ends.iter()));
            }
        }
        let (ends, table) = gathered;
        // Written before anything is printed: standard output may be lost.
        let written = self.write_table(&table);
        say(table.markdown())?;
        written?;
        if ends.iter().any(Option::is_none) {
            let ended = ends.iter().flatten().count();
            let message = format!("{ended} of {} runs have ended", jobs.len());
            return Err(Failure::new(exit::CHECKPOINTED, message));
        }
        Ok(exit_code(ends.iter().flatten()))
    }

    /// Writes the table to the file that was asked for.
    pub(super) fn write_table(&self, table: &SweepTable) -> Result<(), Failure> {
        let Some(path) = &self.table else {
            return Ok(());
        };
        std::fs::write(path, table.markdown())
            .map_err(|cause| Failure::unwritable(path, "--table", &cause))
    }
}

/// The runs of a sweep and where they are.
struct Sweep<'a> {
    jobs: &'a [Job],
    out: &'a Path,
    kind: &'a Kind<'a>,
}

/// Name of the file that is locked while table and page are made, which tasks of a queue may do at once.
const LOCK: &str = "sweep.lock";

impl Sweep<'_> {
    /// Makes the table and the page from the runs that have ended, by whichever command.
    fn gather(&self) -> Result<(Vec<Option<JobEnd>>, SweepTable), Failure> {
        let path = self.out.join(LOCK);
        let lock = File::create(&path).and_then(|file| file.lock().map(|()| file));
        let _lock = lock.map_err(|cause| Failure::unwritable(&path, "--out", &cause))?;
        let found = self.jobs.iter().map(|job| self.found(job));
        let (ends, results): (Vec<Option<JobEnd>>, Vec<_>) = found.unzip();
        let pairs = self.jobs.iter().zip(&ends);
        let points = pairs.clone().filter_map(|(job, end)| {
            Some(Point {
                job,
                end: end.as_ref()?,
            })
        });
        let table = (self.kind.table)(&points.collect::<Vec<_>>())?;
        table.write(self.out)?;
        let overview = Overview {
            name: self.kind.name,
            title: self.kind.title,
            runs: pairs
                .zip(results)
                .map(|((job, end), result)| self.run(job, end.as_ref(), result))
                .collect(),
        };
        let written = overview.write(self.out);
        written.map_err(|error| Failure::told(exit::OTHER, &error))?;
        Ok((ends, table))
    }

    /// How a run ended: with an error that was kept, or as its results say, and these.
    fn found(&self, job: &Job) -> (Option<JobEnd>, Option<SweptResult>) {
        if let Some(end) = job.kept_failure() {
            return (Some(end), None);
        }
        let result = (self.kind.result)(&job.folder);
        let end = result.as_ref().map(|one| JobEnd::complete(one.exit_code()));
        (end, result)
    }

    /// A run as the page shows it, with a report wherever there can be one.
    fn run(&self, job: &Job, end: Option<&JobEnd>, result: Option<SweptResult>) -> SweptRun {
        let folder = &job.folder;
        if end.is_some() && !folder.join(REPORT).is_file() && folder.join(SUMMARY).is_file() {
            // Of a run that failed there may be too little for one; the page then links its log.
            let _ = (self.kind.report)(folder);
        }
        let name = folder.file_name().unwrap_or_default().to_string_lossy();
        let log = format!("log/{OWN_LOG}");
        let pages = [(REPORT, "report"), (&log, "log"), ("", "folder")];
        let link = pages
            .into_iter()
            .find(|(file, _)| folder.join(file).exists());
        let end = match (result, end) {
            (Some(result), _) => SweptEnd::Complete(result),
            (None, None) => SweptEnd::Open,
            (None, Some(end)) => SweptEnd::Failed {
                how: ending(end.code),
                told: end.told.trim().to_owned(),
            },
        };
        SweptRun {
            settings: job.settings.clone(),
            link: link.map(|(file, word)| (format!("{name}/{file}"), word)),
            end,
        }
    }
}

/// The exit code of a sweep: that of the first run that failed, else whether all are within their bands.
fn exit_code<'e>(mut ends: impl Iterator<Item = &'e JobEnd> + Clone) -> u8 {
    let failed = ends.clone().find(|end| !end.is_complete());
    let outside = ends.any(|end| end.code == exit::OUTSIDE_BANDS);
    match failed {
        Some(end) => end.code,
        None if outside => exit::OUTSIDE_BANDS,
        None => exit::OK,
    }
}

/// Tells what a run of these settings said, where that was not shown at once.
fn tell_of(settings: &str, end: &JobEnd) {
    if !end.shown && !end.told.trim().is_empty() {
        tell_line(format_args!("{settings} says:"));
        tell(&end.told);
    }
}

/// How far runs are that go on side by side.
fn progress<'j>(ended: usize, all: usize, under_way: impl Iterator<Item = &'j Job>) -> String {
    let each = under_way.map(|job| {
        let (settings, progress) = (job.settings.join("  "), job.progress());
        match progress.words.is_empty() {
            true => format!("{settings}: begins"),
            false => format!("{settings}: {:.0} %", 100.0 * progress.done),
        }
    });
    let each: Vec<String> = each.collect();
    format!(
        "{ended} of {all} have ended; under way: {}",
        each.join("; ")
    )
}

/// How a run ended, in words.
pub(super) fn ending(code: u8) -> String {
    match code {
        exit::OK => "complete".into(),
        exit::OUTSIDE_BANDS => "complete, outside its bands".into(),
        code => format!("failed, exit code {code}"),
    }
}

/// Refuses a folder with runs of other values, which would no longer be in its table and page.
pub(super) fn own_runs(out: &Path, jobs: &[Job]) -> Result<(), Failure> {
    let entries = std::fs::read_dir(out).into_iter().flatten().flatten();
    let runs = entries.map(|entry| entry.path());
    let runs = runs.filter(|path| path.join(SUMMARY).is_file());
    let mut others: Vec<PathBuf> = runs
        .filter(|path| jobs.iter().all(|job| job.folder != *path))
        .collect();
    others.sort();
    let Some(first) = others.first() else {
        return Ok(());
    };
    let message = format!(
        "{} has a run that is not of this sweep, which its table and page would leave out ({} in all)\n  help: name another folder with `--out`, \
         or add its values to `--set`: what is complete is not run again",
        first.display(),
        others.len()
    );
    Err(Failure::new(exit::CASE, message))
}

/// Refuses a folder whose `sweep.csv` is no table of a sweep of some key, or whose page is none of a sweep.
pub(super) fn own_table<'k>(
    out: &Path,
    keys: impl Iterator<Item = &'k str>,
) -> Result<(), Failure> {
    if !own_overview(out) {
        let message = format!(
            "{} is there, and is no page of a sweep: name another folder with `--out`, or move it",
            out.join(OVERVIEW).display()
        );
        return Err(Failure::new(exit::CASE, message));
    }
    let path = out.join(TABLE);
    let Ok(text) = std::fs::read_to_string(&path) else {
        return Ok(());
    };
    let head = text.lines().next().unwrap_or_default();
    let ends = ["verdict", "\"verdict\""];
    let own = keys.into_iter().any(|key| head.contains(key))
        || ends
            .iter()
            .any(|end| head.split(',').next_back() == Some(end));
    if text.is_empty() || own {
        return Ok(());
    }
    let message = format!(
        "{} is there, and is no table of a sweep: name another folder with `--out`, or move it",
        path.display()
    );
    Err(Failure::new(exit::CASE, message))
}

/// Refuses a file for the table that cannot be written, or that holds something else; it stays as it is, or absent.
pub(super) fn table_is_free(path: &Path) -> Result<(), Failure> {
    own_or_new(path, '|', "--table")?;
    let absent = !path.exists();
    let opened = std::fs::File::options()
        .append(true)
        .create(true)
        .open(path);
    let tried = opened.and_then(|_| match absent {
        true => std::fs::remove_file(path),
        false => Ok(()),
    });
    tried.map_err(|cause| Failure::unwritable(path, "--table", &cause))
}

/// The table: the settings, the wall time, the quantities' last values, and with a
/// reference the largest deviation of each particle's temperature in % of the reference's span.
fn table(
    points: &[Point<'_>],
    axes: &[Vec<String>],
    reference: Option<&str>,
    span: Option<f64>,
) -> Result<SweepTable, Failure> {
    let failed = |error: &ResultsError| Failure::told(exit::OTHER, error);
    let mut table = SweepTable {
        header: keys(axes).map(str::to_owned).collect(),
        rows: Vec::new(),
    };
    table.header.push("loop s".into());
    let mut verdicts = Vec::new();
    for point in points {
        let mut row = values(&point.job.settings);
        if !point.end.is_complete() {
            verdicts.push(ending(point.end.code));
            table.rows.push(row);
            continue;
        }
        let folder = &point.job.folder;
        let summary = Summary::read(folder).map_err(|error| failed(&error))?;
        let wall = &summary.wall_time_s;
        row.push(format!("{:.3}", wall.total - wall.output));
        let against = reference.and_then(|value| partner(points, point, value));
        match against {
            Some(partner) => {
                let read = |folder: &Path| Series::read(folder).map_err(|error| failed(&error));
                let (base, series) = (read(&partner.job.folder)?, read(folder)?);
                let Deviation { percent, .. } = deviation(&base, &series, span);
                // Of more than 1000 particles no temperatures are recorded one by one.
                let largest = percent.iter().copied().reduce(f64::max).unwrap_or(f64::NAN);
                for (number, value) in percent.iter().enumerate() {
                    table.put(
                        &mut row,
                        &format!("p{} %", number + 1),
                        format!("{value:.3}"),
                    );
                }
                table.put(&mut row, "largest %", format!("{largest:.3}"));
            }
            None => {
                for (name, quantity) in &summary.quantities {
                    let value = printed(quantity.value.unwrap_or(f64::NAN));
                    table.put(&mut row, &format!("{name} {}", quantity.unit), value);
                }
            }
        }
        verdicts.push(verdict(&summary));
        table.rows.push(row);
    }
    table.close("verdict", verdicts);
    Ok(table)
}

/// What came out of a run.
fn result(summary: &Summary) -> SweptResult {
    SweptResult {
        verdict: summary.verdict,
        warnings: summary.warnings.len() + summary.case_warnings.len(),
        quantities: summary.quantities.clone(),
        wall_time_s: summary.wall_time_s.total,
    }
}

/// How a run stands: which quantities are outside their bands, and how many kinds of warning it has.
fn verdict(summary: &Summary) -> String {
    let result = result(summary);
    match result.warnings {
        0 => result.verdict(),
        1 => format!("{}; 1 warning", result.verdict()),
        count => format!("{}; {count} warnings", result.verdict()),
    }
}

/// The run that differs from `point` only in having the reference's value, where that is complete.
fn partner<'a>(
    points: &'a [Point<'a>],
    point: &Point<'_>,
    reference: &str,
) -> Option<&'a Point<'a>> {
    let key = reference.split_once('=').map(|(key, _)| key)?;
    let wanted: Vec<&str> = point
        .job
        .settings
        .iter()
        .map(|setting| {
            let same = setting.split_once('=').is_some_and(|(name, _)| name == key);
            if same { reference } else { setting.as_str() }
        })
        .collect();
    let mut complete = points.iter().filter(|other| other.end.is_complete());
    complete.find(|other| {
        let settings = other.job.settings.iter().map(String::as_str);
        settings.eq(wanted.iter().copied())
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn progress_of_runs_side_by_side_is_told_by_their_settings() {
        let folder = std::env::temp_dir().join(format!("calcine sweep {}", std::process::id()));
        let job = |name: &str| Job {
            settings: vec![format!("time.acceleration={name}")],
            folder: folder.join(name),
        };
        let jobs = [job("50"), job("200")];
        std::fs::create_dir_all(&jobs[0].folder).unwrap();
        let status = jobs[0].folder.join("status.json");
        std::fs::write(
            status,
            r#"{"state": "running", "windows": 3, "fraction_done": 0.426}"#,
        )
        .unwrap();
        let text = progress(1, 8, jobs.iter());
        std::fs::remove_dir_all(&folder).unwrap();
        let wanted = "1 of 8 have ended; under way: time.acceleration=50: 43 %; time.acceleration=200: begins";
        assert_eq!(text, wanted);
    }
}
