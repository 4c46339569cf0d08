//! `calcine compare CASE --pairings …`.

use std::path::PathBuf;

use clap::Args;

use super::console::say;
use super::execute::{self, Settings};
use super::failure::{Failure, chain};
use super::inputs::{read_and_prepare, results_folder};
use super::parallel::Transport;
use crate::assembly::{Pairing, SolverStarts};
use crate::exit;

/// Runs several pairings of one case and reports how far they differ against the case's bands.
#[derive(Debug, Args)]
pub(super) struct Arguments {
    /// The case file.
    case: PathBuf,
    /// Pairings of gas and particles such as `native+native,openfoam+liggghts`, or `all`.
    #[arg(long, default_value = "all", value_parser = pairings)]
    pairings: Chosen,
    /// Folder of the comparison [default: results/NAME-compare].
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Changes a key of the case, for example `--set time.acceleration=200`.
    #[arg(long, value_name = "KEY=VALUE")]
    set: Vec<String>,
    /// Shows no progress bar.
    #[arg(long)]
    quiet: bool,
}

/// The pairings asked for.
#[derive(Clone, Debug)]
struct Chosen(Vec<Pairing>);

fn pairings(text: &str) -> Result<Chosen, String> {
    if text == "all" {
        return Ok(Chosen(Pairing::ALL.to_vec()));
    }
    let known = Pairing::ALL.map(Pairing::name).join(", ");
    let chosen: Vec<Pairing> = text
        .split(',')
        .map(|name| {
            Pairing::parse(name.trim())
                .ok_or_else(|| format!("`{name}` is not a pairing: choose of {known}, or all"))
        })
        .collect::<Result<_, _>>()?;
    if chosen.len() < 2 {
        return Err(format!(
            "a comparison needs at least two pairings of {known}"
        ));
    }
    Ok(Chosen(chosen))
}

pub(super) fn run(arguments: &Arguments) -> Result<u8, Failure> {
    let (case, prepared) = read_and_prepare(&arguments.case, &arguments.set)?;
    let out = arguments.out.clone().unwrap_or_else(|| {
        let mut folder = results_folder(&case, None).into_os_string();
        folder.push("-compare");
        folder.into()
    });
    let mut runs = Vec::new();
    for &pairing in &arguments.pairings.0 {
        let folder = out.join(pairing.name());
        say(format_args!("{}:", pairing.name()));
        let settings = Settings {
            pairing,
            starts: &SolverStarts::of(&case, pairing),
            transport: Transport::default(),
            out: &folder,
            resume: false,
            from: None,
            progress: !arguments.quiet,
            stop_after: None,
            strict: false,
        };
        let done = execute::execute(&case, &prepared, &settings)?;
        say(&done.text);
        if done.code == exit::CHECKPOINTED {
            return Ok(done.code);
        }
        runs.push((pairing.name(), folder));
    }
    let comparison = crate::compare::compare(&case, &runs)
        .map_err(|error| Failure::new(exit::OTHER, chain(&error)))?;
    let page = comparison
        .write(&out)
        .map_err(|error| Failure::new(exit::OTHER, chain(&error)))?;
    say(comparison.table());
    say(format_args!("page: {}", page.display()));
    Ok(if comparison.agrees {
        exit::OK
    } else {
        exit::OUTSIDE_BANDS
    })
}
