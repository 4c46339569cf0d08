//! Solids of a case: their size classes, compounds and attributes.

use calcine_flowsheet::distribution::normal_shares;
use calcine_flowsheet::{SizeGrid, StreamLayout};
use toml_edit::Value;

use super::layout::refused;
use crate::case::table::TableReader;
use crate::case::units::{Dimension, shown};

/// Most that mass fractions may differ from a sum of 1.
const SUM: f64 = 1e-9;

/// Pairs of a quantity and a number.
pub(super) fn pairs(
    reader: &TableReader<'_>,
    key: &str,
    first: Dimension,
) -> Option<Vec<(f64, f64)>> {
    let item = reader.raw(key)?;
    let rule = "needs pairs, each of a diameter and a number";
    let help = "for example [[\"1 mm\", 0.4], [\"2 mm\", 0.6]]";
    let Some(list) = item.as_array().filter(|list| !list.is_empty()) else {
        reader.fail(key, rule, help);
        return None;
    };
    let mut found: Vec<(f64, f64)> = Vec::new();
    for entry in list {
        let pair = entry.as_array().filter(|pair| pair.len() == 2);
        let Some((one, two)) = pair.and_then(|pair| Some((pair.get(0)?, pair.get(1)?))) else {
            reader.fail(key, rule, help);
            return None;
        };
        let d = reader.value(key, one, first)?;
        let number = reader.value(key, two, Dimension::NONE)?;
        if let Some((last, _)) = found.last().filter(|(last, _)| *last >= d) {
            let rule = format!("has {} m after {} m", shown(d), shown(*last));
            reader.fail(key, rule, "the diameters must rise");
            return None;
        }
        found.push((d, number));
    }
    Some(found)
}

/// Shares of mass by size class of the distribution that a table states.
pub(super) fn distribution(
    parent: &TableReader<'_>,
    key: &str,
    grid: &SizeGrid,
) -> Option<Vec<f64>> {
    let table = parent.table(key)?;
    let place = table.place_of("");
    let place = place.trim_end_matches('.');
    let made = match table.exactly_one() {
        Some("normal") => table.table("normal").and_then(|normal| {
            let (mean, deviation) = (normal.number("mean"), normal.number("deviation"));
            normal.finish();
            let shares = normal_shares(grid, mean?, deviation?, place);
            shares
                .map_err(|error| refused(&table, "normal", &error))
                .ok()
        }),
        Some("classes") => by_class(&table, grid),
        Some(_) => by_passing(&table, grid),
        None => None,
    };
    table.finish();
    made
}

/// What `sizes` would have to be for diameters in m.
fn holding(grid: &SizeGrid, smallest: f64, largest: f64) -> String {
    let (from, to) = grid.range();
    let begins = smallest < from;
    let begin = format!("begin at {} m or below", shown(smallest));
    let end = format!("end above {} m", shown(largest));
    match (begins, largest > to || !begins) {
        (true, true) => format!("let `sizes` {begin} and {end}"),
        (true, false) => format!("let `sizes` {begin}"),
        _ => format!("let `sizes` {end}"),
    }
}

/// Shares of diameters, each in the class that it falls into.
fn by_class(table: &TableReader<'_>, grid: &SizeGrid) -> Option<Vec<f64>> {
    let mut shares = vec![0.0; grid.classes()];
    let (from, to) = grid.range();
    for (d, share) in pairs(table, "classes", Dimension::LENGTH)? {
        if !(from..to).contains(&d) {
            let rule = format!(
                "has {} m, outside of the size classes from {} m to {} m",
                shown(d),
                shown(from),
                shown(to)
            );
            let help = match d >= 0.0 {
                true => format!("{}, or leave it out", holding(grid, d, d)),
                false => "diameters are zero or above".into(),
            };
            table.fail("classes", rule, help);
            return None;
        }
        if share < 0.0 {
            let rule = format!("has the share {}", shown(share));
            table.fail("classes", rule, "shares are zero or above");
            return None;
        }
        let class = grid.edges().partition_point(|edge| *edge <= d) - 1;
        shares[class] += share;
    }
    let sum: f64 = shares.iter().sum();
    if sum <= 0.0 {
        let help = "state one share above zero at least";
        table.fail("classes", "has shares that are all zero", help);
        return None;
    }
    Some(shares.iter().map(|share| share / sum).collect())
}

/// Shares of a sieve analysis: what is smaller than each diameter.
fn by_passing(table: &TableReader<'_>, grid: &SizeGrid) -> Option<Vec<f64>> {
    let points = pairs(table, "passing", Dimension::LENGTH)?;
    let (from, to) = grid.range();
    let falls = points.windows(2).any(|pair| pair[1].1 < pair[0].1);
    let (first, last) = (points.first()?, points.last()?);
    if falls || first.1 != 0.0 || (last.1 - 1.0).abs() > SUM {
        let rule = "does not rise from 0 to 1";
        let help = "begin with the largest diameter of which nothing is smaller, [\"1 mm\", 0], and end with 1";
        table.fail("passing", rule, help);
        return None;
    }
    if first.0 < from || last.0 > to {
        let rule = format!(
            "runs from {} m to {} m, beyond the size classes from {} m to {} m",
            shown(first.0),
            shown(last.0),
            shown(from),
            shown(to)
        );
        let help = match first.0 >= 0.0 {
            true => holding(grid, first.0, last.0),
            false => "diameters are zero or above".into(),
        };
        table.fail("passing", rule, help);
        return None;
    }
    let below = |d: f64| {
        let after = points.partition_point(|(at, _)| *at <= d);
        match (
            after.checked_sub(1).and_then(|k| points.get(k)),
            points.get(after),
        ) {
            (None, _) => 0.0,
            (_, None) => 1.0,
            (Some((d0, p0)), Some((d1, p1))) => p0 + (p1 - p0) * (d - d0) / (d1 - d0),
        }
    };
    let edges = grid.edges().windows(2);
    Some(edges.map(|edge| below(edge[1]) - below(edge[0])).collect())
}

/// Adds the solids of a list of tables to a row of the layout; `amount` is the key of their mass or flow.
pub(super) fn add_solids(
    parent: &TableReader<'_>,
    key: &str,
    amount: &str,
    layout: &StreamLayout,
    to: &mut [f64],
) -> Option<()> {
    let mut good = Some(());
    for table in parent.tables(key) {
        let one = one_kind(&table, amount, layout);
        table.finish();
        match one {
            Some(row) => to.iter_mut().zip(&row).for_each(|(t, r)| *t += r),
            None => good = None,
        }
    }
    good
}

/// The solids of one table.
fn one_kind(table: &TableReader<'_>, amount: &str, layout: &StreamLayout) -> Option<Vec<f64>> {
    let mass = table.number(amount);
    let shares = distribution(table, "sizes", layout.grid());
    let composition = composition(table, layout);
    let cell = cell(table, layout);
    let (mass, shares, composition, cell) = (mass?, shares?, composition?, cell?);
    let count = layout.compounds().len();
    let mut row = vec![0.0; layout.solids()];
    for (class, share) in shares.iter().enumerate() {
        let start = class * layout.inner() + cell * count;
        for (k, fraction) in composition.iter().enumerate() {
            row[start + k] = mass * share * fraction;
        }
    }
    Some(row)
}

/// Mass fractions by compound.
fn composition(table: &TableReader<'_>, layout: &StreamLayout) -> Option<Vec<f64>> {
    let count = layout.compounds().len();
    if !table.has("composition") {
        if count == 1 {
            return Some(vec![1.0]);
        }
        table.missing("composition");
        return None;
    }
    let row = by_compound(table, "composition", layout)?;
    let sum: f64 = row.iter().sum();
    if (sum - 1.0).abs() > SUM || row.iter().any(|share| *share < 0.0) {
        let rule = format!("has mass fractions that sum to {}", shown(sum));
        table.fail("composition", rule, "they are zero or above and sum to 1");
        return None;
    }
    Some(row)
}

/// Numbers by the names of compounds.
pub(super) fn by_compound(
    parent: &TableReader<'_>,
    key: &str,
    layout: &StreamLayout,
) -> Option<Vec<f64>> {
    let compounds = layout.compounds();
    let mut row = vec![0.0; compounds.len()];
    if !parent.has(key) {
        return Some(row);
    }
    let (table, numbers) = parent.by_name(key)?;
    let mut good = true;
    for (name, number) in numbers? {
        match compounds.iter().position(|one| one.name == name) {
            Some(k) => row[k] = number,
            None => {
                let names: Vec<&str> = compounds.iter().map(|one| one.name.as_str()).collect();
                let help = format!("the compounds are {}", names.join(", "));
                table.fail(&name, "is no compound of the plant", help);
                good = false;
            }
        }
        if number < 0.0 {
            table.fail(
                &name,
                format!("is {}", shown(number)),
                "it is zero or above",
            );
            good = false;
        }
    }
    good.then_some(row)
}

/// Place among the classes of all attributes, the last attribute running fastest.
fn cell(table: &TableReader<'_>, layout: &StreamLayout) -> Option<usize> {
    let attributes = layout.attributes();
    let mut classes = vec![0; attributes.len()];
    if table.has("attributes") {
        let (below, numbers) = table.by_name("attributes")?;
        for (name, number) in numbers? {
            let Some(place) = attributes.iter().position(|one| one.name == name) else {
                let names: Vec<&str> = attributes.iter().map(|one| one.name.as_str()).collect();
                let help = match names[..] {
                    [] => "the plant has no [[attributes]]".into(),
                    _ => format!("the attributes are {}", names.join(", ")),
                };
                below.fail(&name, "is no attribute of the plant", help);
                return None;
            };
            let most = attributes[place].classes;
            let class = (1..=most).find(|class| *class as f64 == number);
            let Some(class) = class else {
                let help = format!("its classes count from 1 to {most}");
                below.fail(&name, format!("is {}", shown(number)), help);
                return None;
            };
            classes[place] = class - 1;
        }
    }
    let pairs = classes.iter().zip(attributes);
    Some(pairs.fold(0, |cell, (class, attribute)| {
        cell * attribute.classes + class
    }))
}

/// A list of plain numbers of any length.
pub(super) fn numbers(reader: &TableReader<'_>, key: &str) -> Option<Vec<f64>> {
    let item = reader.raw(key)?;
    let number = |value: &Value| {
        let whole = value.as_integer().map(|number| number as f64);
        value.as_float().or(whole)
    };
    let list = item.as_array().map(|list| list.iter().map(number));
    let list: Option<Vec<f64>> = list.and_then(Iterator::collect);
    if list.is_none() {
        reader.fail(key, "needs a list of numbers", "for example [0.9, 0.1]");
    }
    list
}
