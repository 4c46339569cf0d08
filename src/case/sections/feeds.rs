//! `[[feeds]]` and `[[outlets]]`: particles that come and go.

use calcine_coupler::feeds::Outlet;
use calcine_coupler::mesh::zone::Zone;
use calcine_coupler::physics::Vec3;

use super::zone::zone;
use crate::case::model::{FeedSpec, MotionSpec, Population};
use crate::case::table::TableReader;

/// Refuses tables of one name.
fn names_differ(tables: &[TableReader<'_>], what: &str) {
    let mut seen = Vec::new();
    for table in tables {
        let Some(name) = table.text("name") else {
            continue;
        };
        if seen.contains(&name) {
            let help = format!("names of {what} must differ");
            table.fail("name", format!("is \"{name}\" a second time"), &help);
        }
        seen.push(name);
    }
}

fn region(table: &TableReader<'_>) -> Option<Zone> {
    let region = table.table("region")?;
    let zone = zone(&region);
    region.finish();
    zone
}

pub(super) fn feeds(root: &TableReader<'_>, particles: Option<&[Population]>) -> Vec<FeedSpec> {
    let tables = root.tables("feeds");
    names_differ(&tables, "feeds");
    tables
        .iter()
        .filter_map(|table| feed(table, particles))
        .collect()
}

fn feed(table: &TableReader<'_>, particles: Option<&[Population]>) -> Option<FeedSpec> {
    let name = table.text("name");
    let population = table.text("population");
    let region = region(table);
    let rate = table.number("mass_rate");
    let batch = table.number("batch");
    if !table.has("mass_rate") && !table.has("batch") {
        let help = "add mass_rate = \"1 kg/h\", or batch = \"20 g\" for what is there at the start";
        table.fail_whole("needs `mass_rate` or `batch`", help);
    }
    let period = period(table);
    let velocity = table.vector("velocity");
    let temperature = table.number("temperature");
    let seed = table.whole("seed");
    table.finish();
    let (particles, population) = (particles?, population?);
    let index = particles.iter().position(|one| one.name == population);
    let Some(index) = index else {
        let known: Vec<&str> = particles.iter().map(|one| one.name.as_str()).collect();
        let help = format!("the populations are {}", known.join(", "));
        table.fail("population", format!("is \"{population}\""), help);
        return None;
    };
    if particles[index].motion == MotionSpec::Frozen {
        let rule = format!("is \"{population}\", whose particles are frozen");
        table.fail("population", rule, "write motion = \"free\" for it");
    }
    if particles[index].prescribed_temperature.is_some() && table.has("temperature") {
        let rule = format!("has no effect: `{population}` has a prescribed temperature");
        table.fail("temperature", rule, "remove it");
    }
    Some(FeedSpec {
        name: name?.into(),
        population: index,
        zone: region?,
        rate: rate.unwrap_or(0.0),
        period: period?,
        batch: batch.unwrap_or(0.0),
        velocity: velocity.map_or(Vec3::zeros(), Vec3::from),
        temperature: temperature.unwrap_or(particles[index].temperature),
        seed: seed?,
    })
}

/// When the mass flow of a feed begins and ends, in s.
fn period(table: &TableReader<'_>) -> Option<[f64; 2]> {
    let ends = ["begin", "end"].map(|key| (table.has(key), table.number(key)));
    let alone = ["begin", "end"].into_iter().zip(ends);
    for (key, (given, _)) in alone {
        if given && !table.has("mass_rate") {
            let help = "add mass_rate, or remove it: a batch comes before the first window";
            table.fail(key, "stands without `mass_rate`, which it limits", help);
        }
    }
    let [begin, end] = ends;
    let begin = if begin.0 { begin.1? } else { 0.0 };
    let end = if end.0 { end.1? } else { f64::INFINITY };
    if end <= begin {
        let rule = format!("is {end} s, not after `begin`, {begin} s");
        table.fail("end", rule, "write a later time");
        return None;
    }
    Some([begin, end])
}

pub(super) fn outlets(root: &TableReader<'_>) -> Vec<Outlet> {
    let one = |table: &TableReader<'_>| {
        let name = table.text("name");
        let zone = region(table);
        let rate = table.number("mass_rate");
        table.finish();
        Some(Outlet {
            name: name?.into(),
            zone: zone?,
            rate,
        })
    };
    let tables = root.tables("outlets");
    names_differ(&tables, "outlets");
    tables.iter().filter_map(one).collect()
}
