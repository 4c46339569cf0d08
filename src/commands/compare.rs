//! `calcine compare CASE --pairings …`.

use std::path::PathBuf;

use clap::Args;

use super::able::able;
use super::console::say;
use super::continuation::begin_again;
use super::execute::{self, Settings};
use super::failure::Failure;
use super::inputs::results_folder;
use super::parallel::Transport;
use crate::assembly::{Pairing, SolverStarts, pairing_cautions};
use crate::exit;
use crate::progress::preparing;
use crate::results::unoccupied;
use crate::standard_error::tell_line;
use crate::valid::ValidCase;

/// Runs several pairings of one case and reports how far they differ against the case's bands.
#[derive(Debug, Args)]
pub(super) struct Arguments {
    /// The case file.
    pub(super) case: PathBuf,
    /// Pairings of gas and particles such as `native+native,openfoam+liggghts`, or `all`: those that can run here.
    #[arg(long, default_value = "all", value_parser = pairings)]
    pairings: Chosen,
    /// Of a plant: compares these two results folders in place of two runs.
    #[arg(long, value_name = "DIR,DIR", value_delimiter = ',')]
    pub(super) results: Vec<PathBuf>,
    /// Folder of the comparison [default: results/NAME-compare].
    #[arg(long, value_name = "DIR")]
    pub(super) out: Option<PathBuf>,
    /// Changes a key of the case, for example `--set time.acceleration=200`.
    #[arg(long, value_name = "KEY=VALUE")]
    pub(super) set: Vec<String>,
    /// Shows no progress bar.
    #[arg(long)]
    pub(super) quiet: bool,
}

/// The pairings asked for.
#[derive(Clone, Debug)]
struct Chosen {
    pairings: Vec<Pairing>,
    /// True where they are named; without names, those that cannot run are left out.
    named: bool,
}

fn pairings(text: &str) -> Result<Chosen, String> {
    if text == "all" {
        return Ok(Chosen {
            pairings: Pairing::ALL.to_vec(),
            named: false,
        });
    }
    let known = Pairing::ALL.map(Pairing::name).join(", ");
    let chosen: Vec<Pairing> = text
        .split(',')
        .map(|name| {
            Pairing::parse(name.trim())
                .ok_or_else(|| format!("`{name}` is not a pairing: choose of {known}, or all"))
        })
        .collect::<Result<_, _>>()?;
    let twice = (1..chosen.len()).find(|&k| chosen[..k].contains(&chosen[k]));
    if let Some(k) = twice {
        return Err(format!(
            "`{}` stands there twice: a comparison is of different pairings, each once",
            chosen[k].name()
        ));
    }
    if chosen.len() < 2 {
        return Err(format!(
            "a comparison needs at least two pairings of {known}"
        ));
    }
    Ok(Chosen {
        pairings: chosen,
        named: true,
    })
}

/// Those of the chosen pairings that can run the case here. One that is named must; of `all`, the others are left out
/// with the reason.
fn able_ones(valid: &ValidCase, chosen: &Chosen) -> Result<Vec<Pairing>, Failure> {
    let (mut kept, mut code, mut reasons) = (Vec::new(), exit::CASE, String::new());
    // Without particles pairings of one gas are one run.
    let same = |pairing: &Pairing| pairing.particles != pairing.particles_of(&valid.case);
    let meant = chosen
        .pairings
        .iter()
        .filter(|one| chosen.named || !same(one));
    for &pairing in meant {
        match able(valid, pairing) {
            Ok(()) => kept.push(pairing),
            Err(failure) => {
                code = failure.code;
                let why = failure.message.trim_end();
                reasons += &format!("\n{} cannot run: {why}", pairing.name());
            }
        }
    }
    if !reasons.is_empty() && (chosen.named || kept.len() < 2) {
        let message = format!(
            "nothing was run: a comparison needs {}{reasons}",
            match chosen.named {
                true => "all the pairings that are named",
                false => "two pairings at least",
            }
        );
        return Err(Failure::new(code, message));
    }
    if !reasons.is_empty() {
        tell_line(reasons.trim_start());
    }
    Ok(kept)
}

pub(super) fn run(arguments: &Arguments) -> Result<u8, Failure> {
    if !arguments.results.is_empty() {
        let message = "`--results` goes with plants; name the pairings of a bed with `--pairings`";
        return Err(Failure::new(exit::CASE, message));
    }
    let valid = preparing(|| ValidCase::open(&arguments.case, &arguments.set))?;
    let pairings = able_ones(&valid, &arguments.pairings)?;
    let ValidCase { case, prepared, .. } = valid;
    let out = arguments.out.clone().unwrap_or_else(|| {
        let mut folder = results_folder(&case, None).into_os_string();
        folder.push("-compare");
        folder.into()
    });
    for pairing in &pairings {
        let free = unoccupied(&out.join(pairing.name()));
        free.map_err(|error| Failure::told(exit::CASE, &error))?;
    }
    let go_on = begin_again("comparison", &out);
    let mut runs = Vec::new();
    for pairing in pairings {
        let mut of_pairing = case.clone();
        let more = pairing_cautions(&case, &prepared, pairing);
        of_pairing.warnings.extend(more);
        let folder = out.join(pairing.name());
        say(format_args!("{}:", pairing.name()))?;
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
            recorded: None,
            go_on: &go_on,
        };
        let done = execute::execute(&of_pairing, &prepared, &settings)?;
        say(&done.text)?;
        if done.code == exit::CHECKPOINTED {
            return Ok(done.code);
        }
        runs.push((pairing.name(), folder));
    }
    let comparison = crate::compare::compare(&case, &runs)
        .map_err(|error| Failure::told(exit::OTHER, &error))?;
    let page = comparison
        .write(&out)
        .map_err(|error| Failure::told(exit::OTHER, &error))?;
    say(comparison.table())?;
    say(format_args!("page: {}", page.display()))?;
    Ok(if comparison.agrees {
        exit::OK
    } else {
        exit::OUTSIDE_BANDS
    })
}
