//! `[output]`, `[[probes]]`, `[[quantities]]`.

use calcine_coupler::physics::Vec3;

use super::patches;
use super::time::ticks;
use crate::case::model::{
    Band, Expect, Measure, MeshSpec, Output, Place, Population, Probe, Quantity, Statistic,
};
use crate::case::table::Reader;
use crate::case::units::{Dimension, difference};

/// Gas fields of the snapshots.
const GAS: [&str; 5] = [
    "temperature",
    "velocity",
    "pressure",
    "density",
    "void_fraction",
];
/// Particle fields of the snapshots.
const PARTICLES: [&str; 3] = ["temperature", "velocity", "heat"];

pub(super) fn output(root: &Reader<'_>) -> Option<Output> {
    let section = root.required_table("output", "[output] with every = \"30 s\"")?;
    let every = ticks(&section, "every", true);
    let series_every = ticks(&section, "series_every", false);
    let fields = |key: &str, known: &[&str]| {
        let names = section
            .texts(key)
            .unwrap_or_else(|| vec!["temperature".into()]);
        for name in &names {
            if !known.contains(&name.as_str()) {
                section.fail(
                    key,
                    format!("names \"{name}\""),
                    format!("known are {}", known.join(", ")),
                );
            }
        }
        names
    };
    let (gas, particles) = (fields("gas", &GAS), fields("particles", &PARTICLES));
    section.finish();
    Some(Output {
        every: every?,
        series_every,
        gas,
        particles,
    })
}

pub(super) fn probes(root: &Reader<'_>) -> Vec<Probe> {
    let mut names = Vec::new();
    root.tables("probes")
        .iter()
        .filter_map(|table| {
            let name = table.required_text("name", "\"axis\"");
            if let Some(name) = name {
                if names.contains(&name) {
                    let rule = format!("is \"{name}\" a second time");
                    table.fail("name", rule, "names of probes must differ");
                }
                names.push(name);
            }
            let line = table.required_table(
                "line",
                "line = { from = \"0 0 0 mm\", to = \"0 0 300 mm\", points = 100 }",
            );
            table.finish();
            let line = line?;
            let from = line.required_vector("from", Dimension::LENGTH);
            let to = line.required_vector("to", Dimension::LENGTH);
            if !line.has("points") {
                line.missing("points", "100");
            }
            let points = line.whole("points", 2..=1_000_000);
            line.finish();
            Some(Probe {
                name: name?.into(),
                from: Vec3::from(from?),
                to: Vec3::from(to?),
                points: usize::try_from(points?).ok()?,
            })
        })
        .collect()
}

pub(super) fn quantities(
    root: &Reader<'_>,
    mesh: Option<&MeshSpec>,
    populations: Option<&[Population]>,
) -> Vec<Quantity> {
    let mut made: Vec<Quantity> = Vec::new();
    for table in &root.tables("quantities") {
        let Some(quantity) = quantity(table, mesh, populations) else {
            continue;
        };
        if made.iter().any(|other| other.name == quantity.name) {
            table.fail(
                "name",
                format!("is \"{}\" a second time", quantity.name),
                "names must differ",
            );
        }
        made.push(quantity);
    }
    made
}

fn quantity(
    table: &Reader<'_>,
    mesh: Option<&MeshSpec>,
    populations: Option<&[Population]>,
) -> Option<Quantity> {
    let name = table.required_text("name", "\"pressure_drop\"");
    let example = "measure = { difference = \"pressure\", patches = [\"bottom\", \"top\"] }";
    let measure = table.required_table("measure", example).and_then(|reader| {
        let measure = measure(&reader, mesh, populations);
        reader.finish();
        measure
    });
    // Keys are read even where the measure could not be, so that they are not called unknown.
    let (agree, expected) = (table.has("agree"), table.table("expect"));
    let Some((measure, field)) = measure else {
        table.finish();
        return None;
    };
    let (dimension, unit) = if field == "pressure" {
        (Dimension::PRESSURE, "Pa")
    } else {
        (Dimension::TEMPERATURE, "K")
    };
    let agree = if agree {
        band(table, "agree", dimension)
    } else {
        None
    };
    let expect = expected.and_then(|reader| {
        let at = reader.quantity("at", Dimension::TIME);
        let value = reader.required_quantity("value", dimension);
        if !reader.has("within") {
            reader.missing("within", "\"5 %\"");
        }
        let within = band(&reader, "within", dimension);
        reader.finish();
        Some(Expect {
            at,
            value: value?,
            within: within?,
        })
    });
    table.finish();
    Some(Quantity {
        name: name?.into(),
        measure,
        unit,
        agree,
        expect,
    })
}

/// A band such as "5 %" or "0.5 K".
fn band(table: &Reader<'_>, key: &str, dimension: Dimension) -> Option<Band> {
    let text = table.text(key)?;
    let made = match difference(text) {
        Ok((number, _)) if number >= 0.0 && text.trim_end().ends_with('%') => {
            Some(Band::Relative(number))
        }
        Ok((number, found)) if number >= 0.0 && found == dimension => Some(Band::Absolute(number)),
        _ => None,
    };
    if made.is_none() {
        let help = format!(
            "write a share such as \"5 %\", or {} such as \"{}\"",
            dimension.words(),
            dimension.example()
        );
        table.fail(key, format!("is \"{text}\", which is no band"), help);
    }
    made
}

/// The measure and the field that it is of.
fn measure(
    reader: &Reader<'_>,
    mesh: Option<&MeshSpec>,
    populations: Option<&[Population]>,
) -> Option<(Measure, &'static str)> {
    let fields = [("pressure", "pressure"), ("temperature", "temperature")];
    let thermal = [("temperature", "temperature")];
    let kinds = ["difference", "particles", "particle"];
    let given: Vec<&str> = kinds.into_iter().filter(|kind| reader.has(kind)).collect();
    match given[..] {
        ["difference"] => {
            let field = reader.choice("difference", &fields);
            let names = reader
                .texts("patches")
                .and_then(|names| <[String; 2]>::try_from(names).ok());
            let Some(names) = names else {
                reader.fail(
                    "patches",
                    "needs two patches",
                    "for example patches = [\"bottom\", \"top\"]",
                );
                return None;
            };
            if let Some(known) = patches(mesh) {
                for name in names.iter().filter(|name| !known.contains(&name.as_str())) {
                    let rule = format!("names \"{name}\", which is not a patch of the mesh");
                    reader.fail(
                        "patches",
                        rule,
                        format!("the patches are {}", known.join(", ")),
                    );
                }
            }
            let field = field?;
            Some((
                Measure::Difference {
                    field: field.into(),
                    patches: names,
                },
                field,
            ))
        }
        ["particles"] => {
            let field = reader.choice("particles", &thermal);
            let statistics = [
                ("mean", Statistic::Mean),
                ("min", Statistic::Min),
                ("max", Statistic::Max),
            ];
            let statistic = reader.required_choice("statistic", &statistics);
            let field = field?;
            Some((
                Measure::Particles {
                    field: field.into(),
                    statistic: statistic?,
                },
                field,
            ))
        }
        ["particle"] => {
            let field = reader.choice("particle", &thermal);
            if !reader.has("number") {
                reader.missing("number", "1");
            }
            let number = usize::try_from(reader.whole("number", 1..=i64::MAX)?).ok()?;
            if let Some(count) = populations.and_then(count)
                && number > count
            {
                reader.fail(
                    "number",
                    format!("is {number}, but the bed has {count} particles"),
                    "particles count from 1",
                );
            }
            let field = field?;
            Some((
                Measure::Particle {
                    field: field.into(),
                    number,
                },
                field,
            ))
        }
        _ => {
            reader.fail_whole(
                "needs exactly one of difference, particles and particle",
                "for example { particles = \"temperature\", statistic = \"mean\" }",
            );
            None
        }
    }
}

/// Number of particles, where the case alone knows it.
fn count(populations: &[Population]) -> Option<usize> {
    populations
        .iter()
        .try_fold(0usize, |sum, population| match &population.place {
            Place::Grid { counts, .. } => sum.checked_add(counts.iter().product()),
            _ => None,
        })
}
