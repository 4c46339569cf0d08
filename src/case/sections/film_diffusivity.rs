//! `laws.mass_transfer.diffusivity`.

use calcine_coupler::physics::film::{FilmDiffusivity, ReferenceDiffusivity};

use crate::case::table::TableReader;
use crate::case::words::FilmDiffusivityName;

/// What is known of the gas.
#[derive(Clone, Copy)]
pub(super) struct FilmGas<'a> {
    pub species: &'a [String],
    pub schmidt: f64,
}

/// By which diffusivities gases pass films; `gas` is `None` where it could not be read.
pub(super) fn read(table: &TableReader<'_>, gas: Option<FilmGas<'_>>) -> Option<FilmDiffusivity> {
    if !table.is_table("diffusivity") {
        let chosen: FilmDiffusivityName = table.choice("diffusivity")?;
        return match chosen {
            FilmDiffusivityName::Fuller => Some(FilmDiffusivity::Fuller),
            FilmDiffusivityName::Schmidt => Some(FilmDiffusivity::Schmidt(gas?.schmidt)),
        };
    }
    let stated = table.table("diffusivity")?;
    let of_all = of_all(&stated);
    let species = gas.map(|gas| gas.species);
    let own = own(&stated, species);
    let keys = ["value", "species", "at", "pressure", "exponent"];
    if !keys.into_iter().any(|key| stated.has(key)) {
        stated.fail_whole(
            "states no value",
            "write for example { value = \"2.1e-5 m^2/s\", at = \"300 K\" }, or \"fuller\" or \"schmidt\"",
        );
    }
    stated.finish();
    let (of_all, own) = (of_all?, own?);
    let value = |name: &String| {
        let own = own.iter().find(|(one, _)| one == name);
        own.map(|(_, value)| *value).or(of_all)
    };
    Some(FilmDiffusivity::Stated(
        species?.iter().map(value).collect(),
    ))
}

/// The value of all species that have none of their own.
fn of_all(table: &TableReader<'_>) -> Option<Option<ReferenceDiffusivity>> {
    if table.has("value") {
        table.need("at");
        return reference(table).map(Some);
    }
    for key in ["at", "pressure", "exponent"] {
        if table.has(key) {
            let help = "add value = \"2.1e-5 m^2/s\", or remove it";
            table.fail(key, "stands without `value`", help);
        }
    }
    Some(None)
}

/// Species with values of their own.
fn own(
    table: &TableReader<'_>,
    species: Option<&[String]>,
) -> Option<Vec<(String, ReferenceDiffusivity)>> {
    if !table.has("species") {
        return Some(Vec::new());
    }
    let named = table.table("species")?;
    let each = named.named().into_iter().map(|(name, own)| {
        if species.is_some_and(|species| !species.contains(&name)) {
            let help = "remove it, or add the species to `gas.species`";
            named.fail(&name, "is no species of the gas", help);
        }
        let value = reference(&own);
        own.finish();
        Some((name, value?))
    });
    each.collect::<Vec<_>>().into_iter().collect()
}

fn reference(table: &TableReader<'_>) -> Option<ReferenceDiffusivity> {
    let value = table.number("value");
    let at = table.number("at");
    let pressure = table.number("pressure");
    let exponent = table.number("exponent");
    Some(ReferenceDiffusivity {
        value: value?,
        at: at?,
        pressure: pressure?,
        exponent: exponent?,
    })
}
