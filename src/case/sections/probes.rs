//! `[[probes]]`.

use calcine_coupler::physics::Vec3;

use super::common::name_in_results;
use crate::case::model::Probe;
use crate::case::table::TableReader;
use crate::case::units::{Dimension, UnitError, quantities};

pub(super) fn probes(root: &TableReader<'_>) -> Vec<Probe> {
    let mut names = Vec::new();
    root.tables("probes")
        .iter()
        .filter_map(|table| {
            let name = name_in_results(table);
            if let Some(name) = name {
                if names.contains(&name) {
                    let rule = format!("is \"{name}\" a second time");
                    table.fail("name", rule, "names of probes must differ");
                }
                names.push(name);
            }
            let points = places(table);
            let of = table.choices("of").unwrap_or_default();
            table.finish();
            if of.is_empty() {
                let help = "it holds \"gas\", \"particles\" or both";
                table.fail("of", "is empty", help);
            }
            let holds = |phase: &str| of.iter().any(|name| name == phase);
            Some(Probe {
                name: name?.into(),
                points: points?,
                gas: holds("gas"),
                particles: holds("particles"),
            })
        })
        .collect()
}

fn places(table: &TableReader<'_>) -> Option<Vec<Vec3>> {
    match table.exactly_one()? {
        "line" => line(&table.table("line")?),
        "point" => {
            let point = table.vector("point")?;
            Some(vec![Vec3::from(point)])
        }
        _ => points(table),
    }
}

fn line(line: &TableReader<'_>) -> Option<Vec<Vec3>> {
    let from = line.vector("from");
    let to = line.vector("to");
    let points = line.whole("points");
    line.finish();
    let (from, to) = (Vec3::from(from?), Vec3::from(to?));
    let last = points? - 1;
    let at = |i: u64| from + (to - from) * (i as f64 / last as f64);
    Some((0..=last).map(at).collect())
}

fn points(table: &TableReader<'_>) -> Option<Vec<Vec3>> {
    let texts = table.texts("points")?;
    let mut all = Vec::new();
    for text in &texts {
        let parsed = match quantities(text) {
            Ok((numbers, Dimension::LENGTH)) => <[f64; 3]>::try_from(numbers).ok(),
            Ok(_) | Err(UnitError::Number(_) | UnitError::Unknown(_)) => None,
        };
        let Some(point) = parsed else {
            let rule = format!("holds \"{text}\", which is not three lengths");
            table.fail("points", rule, "write them as \"0 0 10 mm\"");
            return None;
        };
        all.push(Vec3::from(point));
    }
    if all.is_empty() {
        table.fail("points", "is empty", "write at least one point");
        return None;
    }
    Some(all)
}
