//! `calcine sweep CASE --set key=a,b,c`.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use clap::Args;

use super::console::{printed, say};
use super::failure::Failure;
use super::inputs::{own_or_new, read_case, results_folder};
use super::jobs::{Job, JobEnd, Jobs};
use super::sweep_table::{SweepTable, TABLE};
use crate::assembly::{GasBackend, ParticleBackend};
use crate::compare::deviation::{Deviation, deviation};
use crate::exit;
use crate::results::read::Series;
use crate::results::{CaseIdentity, ResultsError, SUMMARY, Summary, Verdict, same_case};

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

/// The keys that `--set KEY=A,B,C` names, and every combination of their values as settings.
pub(super) fn combinations(set: &[String]) -> Result<(Vec<String>, Vec<Vec<String>>), Failure> {
    let axes = axes(set)?;
    Ok((keys(&axes).map(str::to_owned).collect(), combine(&axes)))
}

/// The values of each key that is swept, as settings.
fn axes(set: &[String]) -> Result<Vec<Vec<String>>, Failure> {
    let axes: Vec<Vec<String>> = set
        .iter()
        .map(|text| axis(text))
        .collect::<Result<_, _>>()?;
    let mut seen = BTreeSet::new();
    let twice = keys(&axes).find(|key| !seen.insert(*key));
    match twice.map(str::to_owned) {
        None => Ok(axes),
        Some(key) => {
            let message = format!(
                "`{key}` stands in two `--set`: write all of its values in one, separated by commas"
            );
            Err(Failure::new(exit::CASE, message))
        }
    }
}

/// The keys that are swept.
fn keys(axes: &[Vec<String>]) -> impl Iterator<Item = &str> {
    axes.iter()
        .filter_map(|axis| axis.first()?.split_once('=').map(|(key, _)| key))
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
    // Every case and folder is checked before the first one runs, and that the table can be written after the last one.
    if let Some(path) = &arguments.table {
        table_is_free(path)?;
    }
    for job in &jobs {
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
    let table = |points: &[Point]| table(points, &axes, reference, arguments.span);
    let (ends, table) = arguments.follow(&jobs, (&out, options), table)?;
    // Written before anything is printed: standard output may be lost.
    let written = arguments.write_table(&table);
    say(table.markdown())?;
    written?;
    Ok(exit_code(&ends))
}

/// One run of the sweep that has ended.
pub(super) struct Point<'a> {
    /// Which one.
    pub(super) job: &'a Job,
    /// How.
    pub(super) end: &'a JobEnd,
}

impl Arguments {
    /// Follows all runs, and keeps the table of those that have ended in the folder of the sweep.
    pub(super) fn follow(
        &self,
        jobs: &[Job],
        (out, options): (&Path, Vec<String>),
        table: impl Fn(&[Point<'_>]) -> Result<SweepTable, Failure>,
    ) -> Result<(Vec<JobEnd>, SweepTable), Failure> {
        let runs = Jobs {
            case: &self.case,
            options,
            at_once: self.jobs.into(),
            quiet: self.quiet,
        };
        let mut ended: Vec<Option<JobEnd>> = vec![None; jobs.len()];
        let so_far = |ended: &[Option<JobEnd>]| {
            let pairs = jobs.iter().zip(ended);
            let points = pairs.filter_map(|(job, end)| {
                Some(Point {
                    job,
                    end: end.as_ref()?,
                })
            });
            table(&points.collect::<Vec<_>>())
        };
        let ends = runs.follow(jobs, |place, end| {
            let settings = jobs[place].settings.join("  ");
            say(format_args!("{settings}  {}", ending(end.code)))?;
            eprint!("{}", end.told);
            ended[place] = Some(end.clone());
            so_far(&ended)?.write(out)
        })?;
        Ok((ends, so_far(&ended)?))
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

/// The exit code of a sweep: that of the first run that failed, else whether all are within their bands.
pub(super) fn exit_code(ends: &[JobEnd]) -> u8 {
    let failed = ends.iter().find(|end| !end.is_complete());
    let outside = ends.iter().any(|end| end.code == exit::OUTSIDE_BANDS);
    match failed {
        Some(end) => end.code,
        None if outside => exit::OUTSIDE_BANDS,
        None => exit::OK,
    }
}

/// How a run ended, in words.
pub(super) fn ending(code: u8) -> String {
    match code {
        exit::OK => "complete".into(),
        exit::OUTSIDE_BANDS => "complete, outside its bands".into(),
        code => format!("failed, exit code {code}"),
    }
}

/// Refuses a folder whose `sweep.csv` is no table of a sweep of some key.
pub(super) fn own_table<'k>(
    out: &Path,
    keys: impl Iterator<Item = &'k str>,
) -> Result<(), Failure> {
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

/// `key=a,b,c` as `key=a`, `key=b`, `key=c`; commas inside brackets or quotes do not separate.
fn axis(text: &str) -> Result<Vec<String>, Failure> {
    let Some((key, values)) = text.split_once('=') else {
        let message = format!("`--set {text}`: expected KEY=A,B,C");
        return Err(Failure::new(exit::CASE, message));
    };
    let (mut depth, mut quoted, mut parts) = (0u32, false, vec![String::new()]);
    for letter in values.chars() {
        match letter {
            '"' => quoted = !quoted,
            '[' | '{' if !quoted => depth += 1,
            ']' | '}' if !quoted => depth = depth.saturating_sub(1),
            ',' if !quoted && depth == 0 => {
                parts.push(String::new());
                continue;
            }
            _ => {}
        }
        if let Some(part) = parts.last_mut() {
            part.push(letter);
        }
    }
    let settings = parts.into_iter();
    let settings = settings.map(|value| format!("{}={}", key.trim(), value.trim()));
    let settings: Vec<String> = settings.collect();
    let twice = |(place, setting): (usize, &String)| settings[..place].contains(setting);
    if let Some((place, _)) = settings.iter().enumerate().find(|one| twice(*one)) {
        let message = format!(
            "`--set {text}` names `{}` twice: each value is a run and a folder of its own",
            settings[place]
        );
        return Err(Failure::new(exit::CASE, message));
    }
    Ok(settings)
}

/// Every combination of one value from each axis, the last axis changing fastest.
fn combine(axes: &[Vec<String>]) -> Vec<Vec<String>> {
    axes.iter().fold(vec![Vec::new()], |rows, axis| {
        rows.iter()
            .flat_map(|row| {
                axis.iter().map(move |setting| {
                    let mut next = row.clone();
                    next.push(setting.clone());
                    next
                })
            })
            .collect()
    })
}

/// Longest name of a folder in characters.
const LONGEST: usize = 120;

/// The runs of all combinations, each in a folder of its own.
pub(super) fn jobs(out: &Path, combinations: Vec<Vec<String>>) -> Vec<Job> {
    let mut taken = BTreeSet::new();
    let numbered = combinations.into_iter().enumerate();
    let job = |(place, settings): (usize, Vec<String>)| {
        let mut name = folder_name(&settings);
        if !taken.insert(name.clone()) {
            name = format!("{name},{}", place + 1);
            taken.insert(name.clone());
        }
        let folder = out.join(name);
        Job { settings, folder }
    };
    numbered.map(job).collect()
}

/// A folder name made of the last words of the keys and the values: `diameter=4mm,velocity=1.5mps`.
fn folder_name(settings: &[String]) -> String {
    let part = |setting: &String| {
        let (key, value) = setting.split_once('=').unwrap_or(("", setting));
        let key = key.rsplit('.').next().unwrap_or(key);
        let plain = |letter: char| match letter {
            '/' => Some('p'),
            '"' | '^' | '\'' => None,
            letter if letter.is_alphanumeric() || "._+-".contains(letter) => Some(letter),
            _ => Some('-'),
        };
        let words = [key, value].map(|text| {
            // Blanks between numbers tell one list from another.
            let parts: Vec<String> = text
                .split_whitespace()
                .map(|part| part.chars().filter_map(plain).collect())
                .collect();
            let is_number =
                |part: &str| part.starts_with(|c: char| c.is_ascii_digit() || "+-.".contains(c));
            parts.iter().fold(String::new(), |text, part| {
                match text.is_empty() || !is_number(part) {
                    true => text + part,
                    false => text + "_" + part,
                }
            })
        });
        words.join("=")
    };
    let name = settings.iter().map(part).collect::<Vec<String>>().join(",");
    name.chars().take(LONGEST).collect()
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

/// The values of settings.
pub(super) fn values(settings: &[String]) -> Vec<String> {
    let values = settings.iter();
    let values = values.filter_map(|setting| Some(setting.split_once('=')?.1.to_owned()));
    values.collect()
}

/// How a run stands: which quantities are outside their bands, and how many kinds of warning it has.
fn verdict(summary: &Summary) -> String {
    let quantities = summary.quantities.iter();
    let outside: Vec<&str> = quantities
        .filter(|(_, quantity)| quantity.verdict == Verdict::Fail)
        .map(|(name, _)| name.as_str())
        .collect();
    let mut text = match outside[..] {
        [] if summary.verdict == Verdict::None => "no bands stated".to_owned(),
        [] => summary.verdict.word().to_owned(),
        _ => format!("outside: {}", outside.join(", ")),
    };
    match summary.warnings.len() + summary.case_warnings.len() {
        0 => {}
        1 => text += "; 1 warning",
        count => text += &format!("; {count} warnings"),
    }
    text
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
    fn commas_separate_values_except_inside_brackets_and_quotes() {
        let split = |text| axis(text).unwrap();
        assert_eq!(split("a.b=1,2"), ["a.b=1", "a.b=2"]);
        assert_eq!(split("a=[1,2],[3]"), ["a=[1,2]", "a=[3]"]);
        assert_eq!(split("a=\"x,y\""), ["a=\"x,y\""]);
        assert!(axis("nothing").is_err());
        assert!(axis("a=1,2,1").is_err());
    }

    #[test]
    fn folders_are_named_by_keys_and_values_and_none_twice() {
        let settings = |one: &str, two: &str| vec![one.to_owned(), two.to_owned()];
        let named = jobs(
            Path::new("out"),
            vec![
                settings("particles.beads.diameter=4 mm", "gas.velocity=\"1.5 m/s\""),
                settings("a.x=[1]", "b.x=2"),
                settings("a.x=(1)", "c.x=2"),
            ],
        );
        let names = named.iter().map(|job| job.folder.to_str().unwrap());
        assert_eq!(
            names.collect::<Vec<_>>(),
            [
                "out/diameter=4mm,velocity=1.5mps",
                "out/x=-1-,x=2",
                "out/x=-1-,x=2,3"
            ]
        );
    }

    #[test]
    fn combinations_run_the_last_axis_fastest() {
        let axes = [
            vec!["a=1".to_owned(), "a=2".to_owned()],
            vec!["b=x".to_owned(), "b=y".to_owned()],
        ];
        let rows = combine(&axes);
        assert_eq!(rows.len(), 4);
        assert_eq!(rows[1], ["a=1", "b=y"]);
    }
}
