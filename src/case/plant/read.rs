//! The file of a plant as a whole.

use std::path::Path;

use calcine_flowsheet::{Plant, TearAcceleration, WaveformSettings};
use sha2::{Digest, Sha256};

use super::bed::PlantBedSpec;
use super::layout::{layout, refused};
use super::model::{PlantCase, PlantMethod};
use super::quantities::{Measurable, continuation, quantities, steady};
use super::streams::streams;
use super::tuning::tuning;
use super::units::units;
use super::words::{PlantIntegrator, RecycleMethod, TearMethod};
use crate::case::keys::{KINDS, kind_named};
use crate::case::parse::{FORMAT, parse_as, text_of};
use crate::case::problem::CaseErrors;
use crate::case::table::TableReader;
use crate::case::units::short;
use crate::hex::hex;
use crate::laws::LawCatalogue;

/// Most rows that a series may have.
const MOST_ROWS: f64 = 1e7;

/// Reads and checks the case of a plant with `--set key=value` applied; all its errors at once.
pub fn read_plant(path: &Path, set: &[String]) -> Result<PlantCase, CaseErrors> {
    read_plant_with(path, set, &LawCatalogue::default())
}

/// Reads the case of a plant that may choose among these laws.
pub fn read_plant_with(
    path: &Path,
    set: &[String],
    laws: &LawCatalogue,
) -> Result<PlantCase, CaseErrors> {
    parse_plant_with(path, &text_of(path)?, set, laws)
}

/// Checks the text of a plant's case; `path` places messages.
pub fn parse_plant(path: &Path, text: &str, set: &[String]) -> Result<PlantCase, CaseErrors> {
    parse_plant_with(path, text, set, &LawCatalogue::default())
}

fn parse_plant_with(
    path: &Path,
    text: &str,
    set: &[String],
    laws: &LawCatalogue,
) -> Result<PlantCase, CaseErrors> {
    let kind = kind_named("flowsheet").unwrap_or(&KINDS[0]);
    let folder = path.parent().unwrap_or(Path::new("."));
    // The other way of closing recycles, chosen for one run, leaves the file's windows as they are.
    let chosen = |setting: &String| {
        let key = setting.split_once('=').map(|(key, _)| key.trim());
        key == Some("method.recycles")
    };
    let given = Given {
        beds_in: Some(folder),
        idle_windows: set.iter().any(chosen),
    };
    let (mut case, changes) = parse_as(path, text, set, kind, laws, |root, effective, hash| {
        plant(root, path, effective, hash, given)
    })?;
    case.changes = changes;
    case.hash = with_beds(&case);
    Ok(case)
}

/// Reads the case of a plant that has run: the cases of its beds, which may lie elsewhere by now, are left out.
pub fn read_plant_results(path: &Path) -> Result<PlantCase, CaseErrors> {
    let kind = kind_named("flowsheet").unwrap_or(&KINDS[0]);
    let laws = LawCatalogue::default();
    let text = text_of(path)?;
    let (case, _) = parse_as(path, &text, &[], kind, &laws, |root, effective, hash| {
        let given = Given {
            beds_in: None,
            idle_windows: true,
        };
        plant(root, path, effective, hash, given)
    })?;
    Ok(case)
}

/// The hash extended by those of its beds, so that a changed bed is not taken for the same case.
fn with_beds(case: &PlantCase) -> String {
    if case.beds.is_empty() {
        return case.hash.clone();
    }
    let mut digest = Sha256::new();
    digest.update(case.hash.as_bytes());
    for bed in &case.beds {
        digest.update(bed.hash.as_bytes());
    }
    hex(digest.finalize())
}

/// What a file is read with.
#[derive(Clone, Copy)]
pub(in crate::case) struct Given<'a> {
    /// Folder of the cases of beds, and of measurements; `None`: they are left out.
    pub beds_in: Option<&'a Path>,
    /// True where windows of waveform relaxation may stand in the file beside `recycles = "monolithic"`.
    pub idle_windows: bool,
}

/// Reads all sections; `None` where one could not be read (its problems are recorded).
pub(in crate::case) fn plant(
    root: &TableReader<'_>,
    path: &Path,
    effective: &str,
    hash: String,
    given: Given<'_>,
) -> Option<PlantCase> {
    let beds_in = given.beds_in;
    if root.whole("format").is_some_and(|format| format != FORMAT) {
        let rule = "is not 1, the only one there is";
        root.fail("format", rule, "write format = 1");
    }
    let title = root.text("title");
    let time = root.table("time").map(|table| {
        let end = table.number("end");
        let (mut every, mut wall) = (None, None);
        if let Some(checkpoint) = table.table("checkpoint") {
            every = checkpoint.number("every");
            wall = checkpoint.wall_time("wall");
            checkpoint.finish();
        }
        table.finish();
        (end, every, wall)
    });
    let (method, tears) = method(root, given.idle_windows).unzip();
    let tears = tears.flatten();
    let layout = layout(root);
    let read = layout
        .as_ref()
        .map(|(layout, _)| units(root, layout, beds_in));
    let connections = streams(root, read.as_deref().unwrap_or_default());
    let steady = steady(root);
    let continuation = continuation(root);
    let kinds: Vec<&'static str> = read.iter().flatten().map(|unit| unit.kind).collect();
    let beds = read.iter().flatten().filter_map(|unit| unit.bed.clone());
    let beds: Vec<PlantBedSpec> = beds.collect();
    if let Some(bed) = beds.first() {
        for (section, is_there) in [
            ("steady", steady.is_some()),
            ("continuation", continuation.is_some()),
        ] {
            if is_there {
                let rule = format!(
                    "cannot be with the bed \"{}\", which exchanges with the plant at intervals",
                    bed.unit
                );
                root.fail(
                    section,
                    rule,
                    "remove it, or put a granulator or a bunker in the bed's place",
                );
            }
        }
    }
    let units = read.and_then(|read| {
        let made = read.into_iter().map(|one| Some((one.name, one.unit?)));
        made.collect::<Option<Vec<_>>>()
    });
    let layout = layout.and_then(|(layout, own)| own.then_some(layout));
    let plant = match (layout, units, connections) {
        (Some(layout), Some(units), Some(connections)) => {
            let made = Plant::new(layout, units, &connections);
            let told = made.map_err(|wrong| {
                for error in &wrong {
                    refused(root, "units", error);
                }
            });
            told.ok().and_then(|plant| match &tears {
                None => Some(plant),
                Some(names) => {
                    let names: Vec<&str> = names.iter().map(String::as_str).collect();
                    let torn = plant.torn_at(&names);
                    torn.map_err(|error| refused(root, "method", &error)).ok()
                }
            })
        }
        _ => None,
    };
    let output = root.table("output").map(|table| {
        let (every, distributions) = (table.number("every"), table.number("distributions"));
        table.finish();
        (every, distributions)
    });
    if let (Some(Some(end)), Some((Some(every), _))) = (time.as_ref().map(|one| one.0), &output)
        && end / every > MOST_ROWS
    {
        let rule = format!("makes {} rows of the series", short(end / every));
        if let Some(table) = root.table("output") {
            table.fail(
                "every",
                rule,
                format!("write one that makes up to {}", short(MOST_ROWS)),
            );
        }
    }
    let known = Measurable {
        plant: plant.as_ref(),
        steady: steady.is_some(),
        continuation: continuation.as_ref().map(|one| one.unit.as_str()),
    };
    let quantities = quantities(root, &known);
    let tuning = match beds_in {
        Some(folder) => tuning(root, plant.as_ref(), folder, time.and_then(|time| time.0)),
        None => {
            root.raw("tuning");
            Some(None)
        }
    };
    let (end, checkpoint_every, checkpoint_wall) = time?;
    let (every, distributions_every) = output?;
    Some(PlantCase {
        name: path
            .file_stem()
            .map(|name| name.to_string_lossy().into_owned())?,
        title: title?.into(),
        path: path.to_owned(),
        hash,
        changes: Vec::new(),
        effective: effective.into(),
        end: end?,
        checkpoint_every,
        checkpoint_wall,
        method: method?,
        plant: plant?,
        kinds,
        beds,
        row_every: every?,
        distributions_every,
        quantities,
        steady,
        continuation,
        tuning: tuning?,
    })
}

fn method(
    root: &TableReader<'_>,
    idle_windows: bool,
) -> Option<(PlantMethod, Option<Vec<String>>)> {
    let table = root.table_or_empty("method")?;
    let recycles = table.choice::<RecycleMethod>("recycles");
    let integrator = table.choice::<PlantIntegrator>("integrator");
    let tolerance = table.number("tolerance");
    let windows = match recycles {
        Some(RecycleMethod::Waveform) => waveform(&table).map(Some),
        _ if idle_windows => waveform(&table).map(|_| None),
        _ => Some(None),
    };
    let tears = match table.has("tears") {
        true => Some(table.texts("tears")?),
        false => None,
    };
    table.finish();
    let method = Some(PlantMethod {
        integrator: integrator?.0,
        tolerance: tolerance?,
        waveform: windows?.filter(|_| recycles == Some(RecycleMethod::Waveform)),
    })
    .filter(|_| recycles.is_some());
    Some((method?, tears))
}

fn waveform(method: &TableReader<'_>) -> Option<WaveformSettings> {
    let table = method.table_or_empty("waveform")?;
    let [first, shortest, longest, change] =
        ["first", "shortest", "longest", "change"].map(|name| table.number(name));
    let [few, many, most] = ["few", "many", "most"].map(|name| table.whole(name));
    let acceleration = table.choice::<TearMethod>("acceleration");
    let limit = match acceleration {
        Some(TearMethod::Anderson) => Some(0.0),
        _ => table.number("wegstein_limit"),
    };
    table.finish();
    let whole = |number: Option<u64>| usize::try_from(number?).ok();
    let limit = limit?;
    let settings = WaveformSettings {
        first: first?,
        shortest: shortest?,
        longest: longest?,
        change: change?,
        few: whole(few)?,
        many: whole(many)?,
        most: whole(most)?,
        acceleration: match acceleration? {
            TearMethod::Anderson => TearAcceleration::Anderson,
            TearMethod::Wegstein => TearAcceleration::Wegstein(limit),
        },
    };
    if settings.shortest > settings.longest || settings.few >= settings.many {
        let rule = "has limits that are the wrong way round";
        let help = "`shortest` is at most `longest`, and `few` is below `many`";
        method.fail("waveform", rule, help);
    }
    Some(settings)
}
