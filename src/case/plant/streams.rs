//! `[[streams]]`.

use calcine_flowsheet::Connection;

use super::units::ReadUnit;
use crate::case::table::{TableReader, nearest};

/// A port that a stream may take: of which unit, and whether material leaves by it.
type Port = (usize, usize, bool);

/// The streams between units; errors of ports and units stand at the streams, those of ports without a stream at the units.
pub(super) fn streams(root: &TableReader<'_>, units: &[ReadUnit<'_>]) -> Option<Vec<Connection>> {
    let mut all: Vec<Connection> = Vec::new();
    let mut taken: Vec<Port> = Vec::new();
    let mut good = true;
    for table in root.tables("streams") {
        let name = table.text("name");
        let ends = [
            (table.text("from"), "from", true),
            (table.text("to"), "to", false),
        ];
        table.finish();
        if let Some(name) = name.filter(|name| all.iter().any(|one| one.name == *name)) {
            let rule = format!("is \"{name}\" a second time");
            table.fail("name", rule, "names of streams must differ");
        }
        let mut found = Vec::new();
        for (text, key, leaves) in ends {
            let port = text.and_then(|text| port(&table, key, text, leaves, units));
            let Some((unit, place)) = port else {
                continue;
            };
            let names = ports(&units[unit], leaves);
            let own = (unit, place, leaves);
            if taken.contains(&own) {
                let rule = format!(
                    "takes port \"{}\" of \"{}\", which has a stream",
                    names[place], units[unit].name
                );
                let help = match leaves {
                    true => "put a splitter there, and let this stream leave it",
                    false => "put a mixer there, and let this stream enter it",
                };
                table.fail(key, rule, help);
                good = false;
            }
            taken.push(own);
            found.push((units[unit].name.clone(), names[place].clone()));
        }
        match (name, <[(String, String); 2]>::try_from(found)) {
            (Some(name), Ok([from, to])) => all.push(Connection {
                name: name.to_owned(),
                from,
                to,
            }),
            _ => good = false,
        }
    }
    if !good {
        return None;
    }
    for (index, unit) in units.iter().enumerate() {
        for leaves in [false, true] {
            for (place, port) in ports(unit, leaves).iter().enumerate() {
                if !taken.contains(&(index, place, leaves)) {
                    let (rule, help) = match leaves {
                        true => (
                            format!("has no stream from its port \"{port}\""),
                            format!("add a stream with from = \"{}.{port}\"", unit.name),
                        ),
                        false => (
                            format!("has no stream to its port \"{port}\""),
                            format!("add a stream with to = \"{}.{port}\"", unit.name),
                        ),
                    };
                    unit.table.fail(unit.kind, rule, help);
                    good = false;
                }
            }
        }
    }
    good.then_some(all)
}

/// Names of a unit's ports; none where it could not be read.
fn ports(unit: &ReadUnit<'_>, leaves: bool) -> Vec<String> {
    match (&unit.unit, leaves) {
        (Some(unit), true) => unit.outlets(),
        (Some(unit), false) => unit.inlets(),
        (None, _) => Vec::new(),
    }
}

/// The kind with its article.
fn a(kind: &str) -> String {
    match kind.starts_with(['a', 'e', 'i', 'o', 'u']) {
        true => format!("an {kind}"),
        false => format!("a {kind}"),
    }
}

/// The unit and the port that an end of a stream names.
fn port(
    table: &TableReader<'_>,
    key: &str,
    text: &str,
    leaves: bool,
    units: &[ReadUnit<'_>],
) -> Option<(usize, usize)> {
    let (name, port) = match text.split_once('.') {
        Some((name, port)) => (name, Some(port)),
        None => (text, None),
    };
    let Some(index) = units.iter().position(|unit| unit.name == name) else {
        let names: Vec<&str> = units.iter().map(|unit| unit.name.as_str()).collect();
        let near = nearest(name, names.iter().copied());
        let hint = near.map(|near| format!("; did you mean \"{near}\"?"));
        let help = format!(
            "the units are {}{}",
            names.join(", "),
            hint.unwrap_or_default()
        );
        table.fail(key, format!("names \"{name}\", which is no unit"), help);
        return None;
    };
    let unit = &units[index];
    // Of a unit that could not be read the ports are not known.
    unit.unit.as_ref()?;
    let known = ports(unit, leaves);
    let place = match port {
        Some(port) => known.iter().position(|own| own == port),
        None if known.len() == 1 => Some(0),
        None => None,
    };
    if place.is_none() {
        let kind = a(unit.kind);
        let way = if leaves { "out" } else { "in" };
        let list: Vec<String> = known
            .iter()
            .map(|own| format!("\"{name}.{own}\""))
            .collect();
        let (rule, help) = match (port, &list[..]) {
            (_, []) => {
                let other = if leaves { "to" } else { "from" };
                (
                    format!("names \"{name}\", {kind} without a port {way}"),
                    format!("it can stand at `{other}` alone"),
                )
            }
            (Some(port), _) => (
                format!("names the port \"{port}\", which \"{name}\", {kind}, does not have"),
                format!("its ports {way} are {}", list.join(", ")),
            ),
            (None, _) => (
                format!("names \"{name}\", {kind} of several ports {way}"),
                format!("name the port: {}", list.join(", ")),
            ),
        };
        table.fail(key, rule, help);
    }
    Some((index, place?))
}
