//! `calcine new NAME`.

use std::path::PathBuf;

use clap::{Args, ValueEnum};

use super::console::say;
use super::failure::Failure;
use super::schema;
use super::shell::word;
use crate::exit;
use crate::laws::LawCatalogue;

/// Name of the schema beside a new case.
const SCHEMA: &str = "case.schema.json";

/// Creates a new case from a shipped one, in a folder of its own.
#[derive(Debug, Args)]
pub(super) struct Arguments {
    /// Name of the new case; the folder of this name must not exist.
    #[arg(required_unless_present = "list")]
    name: Option<PathBuf>,
    /// Shipped case to start from.
    #[arg(long, value_enum, default_value_t = Shipped::HeatedColumn)]
    like: Shipped,
    /// Lists the shipped cases, one a line.
    #[arg(long, conflicts_with = "name")]
    list: bool,
}

/// The shipped cases, each by its name, what it is, and the file that it names.
macro_rules! shipped {
    ($($variant:ident $name:literal $about:literal $($file:literal)?;)*) => {
        /// Shipped cases.
        #[derive(Clone, Copy, Debug, ValueEnum)]
        enum Shipped {
            $(#[doc = $about] #[value(name = $name)] $variant,)*
        }

        impl Shipped {
            fn text(self) -> &'static str {
                match self {
                    $(Self::$variant => include_str!(concat!("../../cases/", $name, ".toml")),)*
                }
            }

            /// The file that the case names, with its text.
            fn file(self) -> Option<(&'static str, &'static str)> {
                match self {
                    $(Self::$variant => shipped!(@file $($file)?),)*
                }
            }
        }
    };
    (@file) => {
        None
    };
    (@file $file:literal) => {
        Some(($file, include_str!(concat!("../../cases/", $file))))
    };
}

shipped! {
    HeatedColumn "heated-column" "Column of ten spheres heated by hot air.";
    Pipe "pipe" "The gas alone: air that is heated in a pipe, laminar.";
    HeatedBed "heated-bed" "Random packing in a tube heated by hot air.";
    PackedColumn "packed-column" "Pressure drop of air through a tube of 14 mm spheres.";
    PurgedBed "purged-bed" "Carbon dioxide purged from a warm bed by nitrogen.";
    BedConductivity "bed-conductivity" "Effective conductivity of a random bed.";
    SettlingSphere "settling-sphere" "A glass bead that settles in air at rest.";
    SettledBed "settled-bed" "Glass beads that settle to a bed.";
    FluidisedBed "fluidised-bed" "Glass beads in water, from a fluidised to a packed bed as the flow slows down.";
    ParcelBed "parcel-bed" "A bubbling bed of parcels that stand for many particles.";
    RotatingDrum "rotating-drum" "A drum that carries its bed up to its angle of repose.";
    Hopper "hopper" "Beads that run out of a hole in a flat floor.";
    Chute "chute" "Beads that flow down a rough chute which repeats itself.";
    MovingBed "moving-bed" "Cold beads that sink through a shaft against hot air.";
    WetDrum "wet-drum" "Wet wood chips that dry and char in a turning drum.";
    WoodDrying "wood-drying" "Wet wood chips that dry in hot air.";
    CalciningStone "calcining-stone" "A limestone resolved along its radius.";
    OrePellet "ore-pellet" "An ore pellet reduced by hydrogen, resolved along its radius.";
    CharParticle "char-particle" "A char gasified by carbon dioxide, resolved along its radius.";
    CatalystPellet "catalyst-pellet" "The water-gas shift in a catalyst pellet.";
    LimeBurning "lime-burning" "Limestone that is burnt to lime by hot gas.";
    OreReduction "ore-reduction" "Iron-ore pellets reduced to iron by carbon monoxide and hydrogen.";
    IronStack "iron-stack" "Conduction and radiation in a stack of iron spheres.";
    DriSelfHeating "dri-self-heating" "Direct-reduced iron that heats itself in a container.";
    ShaftFurnace "shaft-furnace" "A counter-current shaft furnace with burners.";
    TgFurnace "tg-furnace" "Calcium carbonate in the crucible of a thermogravimetric furnace." "tg-heap.csv";
    TgHeap "tg-heap" "Grains of calcium carbonate poured into that crucible.";
    TgLaws "tg-laws" "Tuning: kinetic laws compared on thermogravimetry at several heating rates." "tg-laws.csv";
    TgTuning "tg-tuning" "Tuning: a lumped model of a sample in a crucible." "tg-tuning.csv";
    GranulationPlant "granulation-plant" "Plant: spray granulation with two screens, a mill and a recycle.";
    GranulationOscillation "granulation-oscillation" "Plant: a granulator and a mill that oscillate.";
    GranulationTuning "granulation-tuning" "Plant: growth and aggregation found from sieve analyses." "granulation-tuning.csv";
    HeatedShaft "heated-shaft" "Plant: beads heated in a shaft that is computed particle by particle." "heated-shaft-bed.toml";
    HeatedShaftBed "heated-shaft-bed" "The shaft of that plant by itself.";
}

impl Shipped {
    /// Kind of the case, and the command that runs it.
    fn kind(self) -> (&'static str, &'static str) {
        let mut lines = self.text().lines();
        let stated = lines.find_map(|line| line.strip_prefix("kind = \"")?.split('"').next());
        let kind = stated.unwrap_or("bed");
        let tunes = kind == "tuning" || self.text().contains("\n[tuning]");
        (kind, if tunes { "tune" } else { "run" })
    }
}

/// One line for each shipped case.
fn list() -> Result<u8, Failure> {
    for case in Shipped::value_variants() {
        if let Some(value) = case.to_possible_value() {
            let about = value
                .get_help()
                .map(ToString::to_string)
                .unwrap_or_default();
            say(format_args!("{:24} {}", value.get_name(), about))?;
        }
    }
    Ok(exit::OK)
}

pub(super) fn run(arguments: &Arguments) -> Result<u8, Failure> {
    let Some(folder) = &arguments.name else {
        return list();
    };
    let Some(stem) = folder.file_name() else {
        let message = format!("`{}` is not a valid case name", folder.display());
        return Err(Failure::new(exit::CASE, message));
    };
    if folder.exists() {
        let message = format!("{} exists already: choose another name", folder.display());
        return Err(Failure::new(exit::CASE, message));
    }
    let file = folder.join(stem).with_extension("toml");
    let failed = |cause: std::io::Error| {
        let path = file.display();
        let message = format!(
            "{path} cannot be written ({cause}): name another with `NAME`, in a folder that you can write"
        );
        Failure::new(exit::CASE, message)
    };
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
        "{}: change it, then\n  calcine check {1}\n  calcine {command} {1}",
        file.display(),
        word(file.as_os_str())
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

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;
    use std::path::Path;

    use super::*;

    #[test]
    fn every_case_of_the_folder_can_be_started_from() {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("cases");
        let files = std::fs::read_dir(folder).into_iter().flatten().flatten();
        let cases = files.map(|entry| entry.path());
        let cases = cases.filter(|path| path.extension().is_some_and(|end| end == "toml"));
        let stems = cases.filter_map(|path| Some(path.file_stem()?.to_str()?.to_owned()));
        let listed = Shipped::value_variants().iter();
        let listed =
            listed.filter_map(|case| Some(case.to_possible_value()?.get_name().to_owned()));
        assert_eq!(
            stems.collect::<BTreeSet<_>>(),
            listed.collect::<BTreeSet<_>>()
        );
    }

    #[test]
    fn plants_and_tunings_are_known_as_such() {
        assert_eq!(Shipped::HeatedBed.kind(), ("bed", "run"));
        assert_eq!(Shipped::GranulationPlant.kind(), ("flowsheet", "run"));
        assert_eq!(Shipped::GranulationTuning.kind(), ("flowsheet", "tune"));
        assert_eq!(Shipped::TgLaws.kind(), ("tuning", "tune"));
    }
}
