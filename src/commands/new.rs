//! `calcine new NAME`.

use std::path::PathBuf;

use clap::{Args, ValueEnum};

use super::console::say;
use super::failure::Failure;
use super::schema;
use crate::exit;
use crate::laws::LawCatalogue;

/// Name of the schema beside a new case.
const SCHEMA: &str = "case.schema.json";

/// Creates a new case from a shipped one, in a folder of its own.
#[derive(Debug, Args)]
pub(super) struct Arguments {
    /// Name of the new case; the folder of this name must not exist.
    name: PathBuf,
    /// Shipped case to start from.
    #[arg(long, value_enum, default_value_t = Shipped::HeatedColumn)]
    like: Shipped,
}

/// Shipped cases.
#[derive(Clone, Copy, Debug, ValueEnum)]
enum Shipped {
    /// Column of ten spheres heated by hot air.
    HeatedColumn,
    /// Random packing in a tube heated by hot air.
    HeatedBed,
    /// Pressure drop of air through a tube of 14 mm spheres.
    PackedColumn,
    /// Carbon dioxide purged from a warm bed by nitrogen.
    PurgedBed,
    /// Tuning: kinetic laws compared on thermogravimetry at several heating rates.
    TgLaws,
    /// Tuning: a lumped model of a sample in a crucible.
    TgTuning,
    /// Plant: spray granulation with two screens, a mill and a recycle.
    GranulationPlant,
    /// Plant: a granulator and a mill that oscillate.
    GranulationOscillation,
    /// Plant: growth and aggregation found from sieve analyses.
    GranulationTuning,
    /// Plant: beads heated in a shaft that is computed particle by particle.
    HeatedShaft,
}

impl Shipped {
    fn text(self) -> &'static str {
        match self {
            Shipped::HeatedColumn => include_str!("../../cases/heated-column.toml"),
            Shipped::HeatedBed => include_str!("../../cases/heated-bed.toml"),
            Shipped::PackedColumn => include_str!("../../cases/packed-column.toml"),
            Shipped::PurgedBed => include_str!("../../cases/purged-bed.toml"),
            Shipped::TgLaws => include_str!("../../cases/tg-laws.toml"),
            Shipped::TgTuning => include_str!("../../cases/tg-tuning.toml"),
            Shipped::GranulationPlant => include_str!("../../cases/granulation-plant.toml"),
            Shipped::GranulationOscillation => {
                include_str!("../../cases/granulation-oscillation.toml")
            }
            Shipped::GranulationTuning => include_str!("../../cases/granulation-tuning.toml"),
            Shipped::HeatedShaft => include_str!("../../cases/heated-shaft.toml"),
        }
    }

    /// The file that the case names, with its text.
    fn file(self) -> Option<(&'static str, &'static str)> {
        match self {
            Shipped::TgLaws => Some(("tg-laws.csv", include_str!("../../cases/tg-laws.csv"))),
            Shipped::TgTuning => Some(("tg-tuning.csv", include_str!("../../cases/tg-tuning.csv"))),
            Shipped::GranulationTuning => Some((
                "granulation-tuning.csv",
                include_str!("../../cases/granulation-tuning.csv"),
            )),
            Shipped::HeatedShaft => Some((
                "heated-shaft-bed.toml",
                include_str!("../../cases/heated-shaft-bed.toml"),
            )),
            _ => None,
        }
    }

    /// Kind of the case, and the command that runs it.
    fn kind(self) -> (&'static str, &'static str) {
        match self {
            Shipped::TgLaws | Shipped::TgTuning => ("tuning", "tune"),
            Shipped::GranulationTuning => ("flowsheet", "tune"),
            Shipped::GranulationPlant | Shipped::GranulationOscillation | Shipped::HeatedShaft => {
                ("flowsheet", "run")
            }
            _ => ("bed", "run"),
        }
    }
}

pub(super) fn run(arguments: &Arguments) -> Result<u8, Failure> {
    let folder = &arguments.name;
    let Some(stem) = folder.file_name() else {
        let message = format!("`{}` is not a valid case name", folder.display());
        return Err(Failure::new(exit::CASE, message));
    };
    if folder.exists() {
        let message = format!("{} exists already: choose another name", folder.display());
        return Err(Failure::new(exit::CASE, message));
    }
    let file = folder.join(stem).with_extension("toml");
    let failed = |cause: std::io::Error| Failure::unwritable(&file, "NAME", &cause);
    std::fs::create_dir_all(folder).map_err(failed)?;
    let (kind, command) = arguments.like.kind();
    let text = match kind {
        "bed" => with_laws(arguments.like.text()),
        _ => arguments.like.text().to_owned(),
    };
    if let Some((name, content)) = arguments.like.file() {
        std::fs::write(folder.join(name), content).map_err(failed)?;
    }
    let text = format!("#:schema {SCHEMA}\n{text}");
    std::fs::write(&file, text).map_err(failed)?;
    std::fs::write(folder.join(SCHEMA), schema::text(kind)).map_err(failed)?;
    say(format_args!(
        "{}: change it, then\n  calcine check {0}\n  calcine {command} {0}",
        file.display()
    ))?;
    Ok(exit::OK)
}

/// The text of a case with the laws that it may choose above its section `[laws]`.
fn with_laws(text: &str) -> String {
    let catalogue = LawCatalogue::default();
    let mut comment =
        String::from("# To choose from (docs/reference/case-file.md says what each is):\n");
    for (family, laws) in catalogue.families() {
        if let Some(key) = family.strip_prefix("laws.") {
            let names: Vec<&str> = laws.iter().map(|law| law.name).collect();
            comment.push_str(&format!("#   {key}: {}\n", names.join(", ")));
        }
    }
    match text.find("[laws]") {
        Some(at) => format!("{}{comment}{}", &text[..at], &text[at..]),
        None => text.to_owned(),
    }
}
