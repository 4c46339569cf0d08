//! `calcine sweep CASE --set key=a,b,c`.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use clap::Args;

use super::console::{printed, say};
use super::continuation::begin_again;
use super::execute::{self, Settings};
use super::failure::Failure;
use super::inputs::{own_or_new, read_and_prepare, read_case, results_folder};
use super::parallel::Transport;
use crate::assembly::{GasBackend, Pairing, ParticleBackend, SolverStarts};
use crate::compare::deviation::{Deviation, deviation};
use crate::exit;
use crate::results::read::Series;
use crate::results::{ResultsError, Summary, Verdict, unoccupied};

/// Runs a case once for each combination of values and prints one table.
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
    #[arg(long, value_name = "KELVIN", requires = "reference")]
    span: Option<f64>,
    /// Folder of the sweep [default: results/NAME-sweep].
    #[arg(long, value_name = "DIR")]
    pub(super) out: Option<PathBuf>,
    /// Also writes the table to this file, as Markdown.
    #[arg(long, value_name = "FILE")]
    pub(super) table: Option<PathBuf>,
    /// Shows no progress bar.
    #[arg(long)]
    pub(super) quiet: bool,
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
    let axes: Vec<Vec<String>> = set
        .iter()
        .map(|text| axis(text))
        .collect::<Result<_, _>>()?;
    let keys = axes.iter();
    let keys = keys.filter_map(|axis| Some(axis.first()?.split_once('=')?.0.to_owned()));
    Ok((keys.collect(), combine(&axes)))
}

/// One run of the sweep.
struct Point {
    /// `key=value`, in the order of `--set`.
    settings: Vec<String>,
    folder: PathBuf,
    /// The exit code of its run.
    code: u8,
}

pub(super) fn run(arguments: &Arguments) -> Result<u8, Failure> {
    let axes = arguments
        .set
        .iter()
        .map(|text| axis(text))
        .collect::<Result<Vec<_>, _>>()?;
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
    let combinations = combine(&axes);
    // Every case and folder is checked before the first one runs, and that the table can be written after the last one.
    if let Some(path) = &arguments.table {
        table_is_free(path)?;
    }
    for settings in &combinations {
        read_case(&arguments.case, settings)?;
    }
    for settings in &combinations {
        let free = unoccupied(&out.join(folder_name(settings)));
        free.map_err(|error| Failure::told(exit::CASE, &error))?;
    }
    let go_on = begin_again("sweep", &out);
    let mut points = Vec::new();
    for settings in combinations {
        let folder = out.join(folder_name(&settings));
        say(settings.join("  "))?;
        let code = one(arguments, &settings, &folder, &go_on)?;
        points.push(Point {
            settings,
            folder,
            code,
        });
    }
    let table = table(&points, &axes, reference, arguments.span)?;
    // Written before anything is printed: standard output may be lost.
    let written = arguments.table.as_ref().map(|path| {
        std::fs::write(path, &table).map_err(|cause| Failure::unwritable(path, "--table", &cause))
    });
    say(&table)?;
    written.transpose()?;
    Ok(match points.iter().any(|point| point.code != exit::OK) {
        true => exit::OUTSIDE_BANDS,
        false => exit::OK,
    })
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

fn one(
    arguments: &Arguments,
    settings: &[String],
    folder: &Path,
    go_on: &str,
) -> Result<u8, Failure> {
    let (case, prepared) = read_and_prepare(&arguments.case, settings)?;
    let pairing = Pairing {
        gas: arguments.gas,
        particles: arguments.particles,
    };
    let settings = Settings {
        starts: &SolverStarts::of(&case, pairing),
        transport: Transport::default(),
        pairing,
        out: folder,
        resume: false,
        from: None,
        progress: !arguments.quiet,
        stop_after: None,
        strict: false,
        recorded: None,
        go_on,
    };
    let done = execute::execute(&case, &prepared, &settings)?;
    if done.code == exit::CHECKPOINTED {
        return Err(Failure::new(done.code, done.text));
    }
    Ok(done.code)
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

/// A folder name made of the values.
pub(super) fn folder_name(settings: &[String]) -> String {
    let values = settings.iter().map(|setting| {
        let value = setting
            .split_once('=')
            .map_or(setting.as_str(), |(_, value)| value);
        value
            .chars()
            .map(|c| {
                if c.is_alphanumeric() || c == '.' {
                    c
                } else {
                    '-'
                }
            })
            .collect()
    });
    values.collect::<Vec<String>>().join("_")
}

/// The table as Markdown: the settings, the wall time, the quantities' last values, and with a
/// reference the largest deviation of each particle's temperature in % of the reference's span.
fn table(
    points: &[Point],
    axes: &[Vec<String>],
    reference: Option<&str>,
    span: Option<f64>,
) -> Result<String, Failure> {
    let failed = |error: &ResultsError| Failure::told(exit::OTHER, error);
    let (mut rows, mut verdicts): (Vec<Vec<String>>, Vec<String>) = Default::default();
    let mut header: Vec<String> = axes
        .iter()
        .filter_map(|axis| axis.first()?.split_once('=').map(|(key, _)| key.to_owned()))
        .collect();
    header.push("loop s".into());
    for point in points {
        let series = Series::read(&point.folder).map_err(|error| failed(&error))?;
        let summary = Summary::read(&point.folder).map_err(|error| failed(&error))?;
        let mut row: Vec<String> = point
            .settings
            .iter()
            .filter_map(|setting| setting.split_once('=').map(|(_, value)| value.to_owned()))
            .collect();
        let wall = &summary.wall_time_s;
        row.push(format!("{:.3}", wall.total - wall.output));
        let against = reference.map(|value| partner(points, point, value));
        match against {
            Some(Some(partner)) => {
                let base = Series::read(&partner.folder).map_err(|error| failed(&error))?;
                let Deviation { percent, .. } = deviation(&base, &series, span);
                // Of more than 1000 particles no temperatures are recorded one by one.
                let largest = percent.iter().copied().reduce(f64::max).unwrap_or(f64::NAN);
                if header.len() < row.len() + percent.len() + 1 {
                    header.truncate(row.len());
                    header.extend((1..=percent.len()).map(|p| format!("p{p} %")));
                    header.push("largest %".into());
                }
                row.extend(percent.iter().map(|value| format!("{value:.3}")));
                row.push(format!("{largest:.3}"));
            }
            _ => {
                for (name, quantity) in &summary.quantities {
                    let column = format!("{name} {}", quantity.unit);
                    // Runs of other quantities have other columns.
                    let place = header.iter().position(|one| *one == column);
                    let place = place.unwrap_or_else(|| {
                        header.push(column);
                        header.len() - 1
                    });
                    row.resize(row.len().max(place + 1), String::new());
                    row[place] = printed(quantity.value.unwrap_or(f64::NAN));
                }
            }
        }
        verdicts.push(verdict(&summary));
        rows.push(row);
    }
    let columns = rows.iter().map(Vec::len).fold(header.len(), usize::max);
    header.resize(columns, String::new());
    header.push("verdict".into());
    for (row, verdict) in rows.iter_mut().zip(verdicts) {
        row.resize(columns, String::new());
        row.push(verdict);
    }
    let mut text = format!(
        "| {} |\n|{}\n",
        header.join(" | "),
        "---|".repeat(header.len())
    );
    for row in rows {
        let _ = writeln!(text, "| {} |", row.join(" | "));
    }
    Ok(text)
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

/// The point that differs from `point` only in having the reference's value.
fn partner<'a>(points: &'a [Point], point: &Point, reference: &str) -> Option<&'a Point> {
    let key = reference.split_once('=').map(|(key, _)| key)?;
    let wanted: Vec<&str> = point
        .settings
        .iter()
        .map(|setting| {
            let same = setting.split_once('=').is_some_and(|(name, _)| name == key);
            if same { reference } else { setting.as_str() }
        })
        .collect();
    points.iter().find(|other| {
        other
            .settings
            .iter()
            .map(String::as_str)
            .eq(wanted.iter().copied())
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
