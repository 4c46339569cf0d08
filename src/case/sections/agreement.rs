//! `[agreement]`.

use crate::case::model::{AgreementSpec, FieldBand, Output};
use crate::case::table::TableReader;
use crate::case::tolerance::band;
use crate::case::units::Dimension;

/// Words of `output` that stand for fields of other names.
const GROUPS: [&str; 4] = ["mass_fractions", "turbulence", "solids", "inside"];

pub(super) fn agreement(root: &TableReader<'_>, output: Option<&Output>) -> AgreementSpec {
    let Some(section) = root.table_or_empty("agreement") else {
        return AgreementSpec::default();
    };
    let mut fields: Vec<FieldBand> = Vec::new();
    for table in &section.tables("fields") {
        let Some(band) = field(table, output) else {
            continue;
        };
        if fields.iter().any(|other| other.field == band.field) {
            let rule = format!("is \"{}\" a second time", band.field);
            table.fail("field", rule, "state both bands in one entry");
        }
        fields.push(band);
    }
    let unconverged = section.number("unconverged");
    section.finish();
    AgreementSpec {
        unconverged: unconverged.unwrap_or(0.0),
        fields,
    }
}

fn field(table: &TableReader<'_>, output: Option<&Output>) -> Option<FieldBand> {
    let name = table.text("field");
    let dimension = name.map_or(Dimension::NONE, dimension);
    let largest = table.has("largest");
    let square = table.has("root_mean_square");
    let largest = largest.then(|| band(table, "largest", dimension));
    let square = square.then(|| band(table, "root_mean_square", dimension));
    table.finish();
    if largest.is_none() && square.is_none() {
        let help = "add largest = \"2 K\", or root_mean_square = \"1 %\"";
        table.fail_whole("states no band", help);
    }
    let name = name?;
    let written = output.map(|output| match name.split_once('.') {
        Some(("gas", field)) => is_written(&output.gas, field),
        Some(("particles", field)) => {
            field == "temperature" || is_written(&output.particles, field)
        }
        _ => false,
    });
    if written == Some(false) {
        table.fail(
            "field",
            format!("is \"{name}\", which `output` does not write"),
            "write gas. or particles. before a field that `output.gas` or `output.particles` lists, for example \"gas.temperature\"",
        );
    }
    Some(FieldBand {
        field: name.into(),
        largest: largest.flatten(),
        root_mean_square: square.flatten(),
    })
}

fn is_written(listed: &[String], field: &str) -> bool {
    let group = |word: &String| GROUPS.contains(&word.as_str());
    listed.iter().any(|word| word == field || group(word))
}

/// Dimension of a field of the results.
fn dimension(field: &str) -> Dimension {
    match field.split_once('.').map_or(field, |(_, field)| field) {
        "temperature" => Dimension::TEMPERATURE,
        "velocity" | "slip" => Dimension::VELOCITY,
        "pressure" => Dimension::PRESSURE,
        "density" => Dimension::DENSITY,
        "heat" => Dimension::POWER,
        "mass" => Dimension::MASS,
        _ => Dimension::NONE,
    }
}
