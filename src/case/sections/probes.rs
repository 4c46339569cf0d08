//! `[[probes]]`.

use calcine_coupler::physics::Vec3;

use crate::case::model::Probe;
use crate::case::table::TableReader;
use crate::case::units::{Dimension, UnitError, quantities};

const LINE: &str = "line = { from = \"0 0 0 mm\", to = \"0 0 300 mm\", points = 100 }";

pub(super) fn probes(root: &TableReader<'_>) -> Vec<Probe> {
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
                if name.contains(['/', ',', '"']) {
                    let rule = format!("is \"{name}\"");
                    table.fail("name", rule, "leave out slashes, commas and quotes");
                }
                names.push(name);
            }
            let points = places(table);
            let of = table.texts("of").unwrap_or_else(|| vec!["gas".into()]);
            table.finish();
            let known = |phase: &String| ["gas", "particles"].contains(&phase.as_str());
            if of.is_empty() || !of.iter().all(known) {
                let rule = format!("is {of:?}");
                table.fail("of", rule, "it holds \"gas\", \"particles\" or both");
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
    let kinds = ["line", "point", "points"];
    let given: Vec<&str> = kinds.into_iter().filter(|kind| table.has(kind)).collect();
    match given[..] {
        ["line"] => line(&table.table("line")?),
        ["point"] => {
            let point = table.vector("point", Dimension::LENGTH)?;
            Some(vec![Vec3::from(point)])
        }
        ["points"] => points(table),
        _ => {
            let rule = "needs exactly one of line, point and points";
            table.fail_whole(rule, &format!("for example {LINE}"));
            None
        }
    }
}

fn line(line: &TableReader<'_>) -> Option<Vec<Vec3>> {
    let from = line.required_vector("from", Dimension::LENGTH);
    let to = line.required_vector("to", Dimension::LENGTH);
    if !line.has("points") {
        line.missing("points", "100");
    }
    let points = line.whole("points", 2..=1_000_000);
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
