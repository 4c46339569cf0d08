//! Size classes, compounds and attributes: what streams are made of.

use calcine_flowsheet::{Attribute, Compound, PlantError, SizeGrid, StreamLayout};

use crate::case::table::TableReader;
use crate::case::units::{Dimension, shown};

/// Records at a key what the plant's own checks refuse; what follows the last semicolon is the remedy.
pub(super) fn refused(table: &TableReader<'_>, key: &str, error: &PlantError) {
    let told = error.to_string();
    // The place stands before the message.
    let own = table.place_of("");
    let place = format!("{}: ", own.trim_end_matches('.'));
    let at = format!("{}: ", table.place_of(key));
    let bare = told.strip_prefix(&at).or(told.strip_prefix(&place));
    let told = bare.unwrap_or(&told);
    let (fact, help) = told
        .rsplit_once("; ")
        .unwrap_or((told, "correct what is stated here"));
    table.fail(key, format!("is refused: {fact}"), help);
}

/// The layout of all streams; true where it is the case's. Where that could not be read, one that stands for it, so that
/// what else is wrong is told too; checks that use it are left out.
pub(super) fn layout(root: &TableReader<'_>) -> Option<(StreamLayout, bool)> {
    let grid = root.table("sizes").and_then(|table| {
        let grid = grid(&table);
        table.finish();
        grid
    });
    let compounds = compounds(root);
    let attributes = attributes(root);
    for (section, is_read) in [
        ("sizes", grid.is_some()),
        ("compounds", compounds.is_some()),
        ("attributes", attributes.is_some()),
    ] {
        if !is_read {
            root.unusable(section);
        }
    }
    let own = grid.is_some() && compounds.is_some() && attributes.is_some();
    let stands = || SizeGrid::uniform(2, 0.0, 1e3).ok();
    let compounds = compounds.filter(|all| !all.is_empty());
    let made = StreamLayout::new(
        grid.or_else(stands)?,
        attributes.unwrap_or_default(),
        compounds.unwrap_or_else(|| vec![nothing()]),
    );
    let made = made.map_err(|error| refused(root, "compounds", &error));
    Some((made.ok()?, own))
}

/// A compound that stands for those that could not be read.
fn nothing() -> Compound {
    Compound {
        name: String::new(),
        volatile: false,
        solid_heat_capacity: 0.0,
        liquid_heat_capacity: 0.0,
        vapour_heat_capacity: 0.0,
        evaporation_heat: 0.0,
    }
}

fn grid(table: &TableReader<'_>) -> Option<SizeGrid> {
    let key = table.exactly_one()?;
    let made = match key {
        "edges" => {
            let mut edges = Vec::new();
            for text in table.texts("edges")? {
                let value = toml_edit::Value::from(text);
                edges.push(table.value("edges", &value, Dimension::LENGTH)?);
            }
            SizeGrid::from_edges(edges)
        }
        _ => {
            let classes = table.table(key)?;
            let count = classes.whole("classes");
            let (from, to) = (classes.number("from"), classes.number("to"));
            classes.finish();
            let count = usize::try_from(count?).ok()?;
            let (from, to) = (from?, to?);
            if from >= to {
                let rule = format!("is {} m, not below `to` of {} m", shown(from), shown(to));
                classes.fail("from", rule, "exchange them, or lower it");
                return None;
            }
            if key == "geometric" && from == 0.0 {
                let help = "raise it: no ratio leads from zero to another diameter";
                classes.fail("from", "is 0 m", help);
                return None;
            }
            match key {
                "uniform" => SizeGrid::uniform(count, from, to),
                _ => SizeGrid::geometric(count, from, to),
            }
        }
    };
    made.map_err(|error| refused(table, key, &error)).ok()
}

fn compounds(root: &TableReader<'_>) -> Option<Vec<Compound>> {
    let section = root.table("compounds")?;
    let mut all = Some(Vec::new());
    for (name, table) in section.named() {
        let volatile = table.truth("volatile");
        let solid = table.number("solid_heat_capacity");
        let liquid = table.number("liquid_heat_capacity");
        let vapour = table.number("vapour_heat_capacity");
        let evaporation = table.number("evaporation_heat");
        table.finish();
        let compound = || {
            Some(Compound {
                name,
                volatile: volatile?,
                solid_heat_capacity: solid?,
                liquid_heat_capacity: liquid?,
                vapour_heat_capacity: vapour?,
                evaporation_heat: evaporation?,
            })
        };
        match (compound(), &mut all) {
            (Some(one), Some(all)) => all.push(one),
            _ => all = None,
        }
    }
    all
}

fn attributes(root: &TableReader<'_>) -> Option<Vec<Attribute>> {
    let mut all: Option<Vec<Attribute>> = Some(Vec::new());
    for table in root.tables("attributes") {
        let (name, classes) = (table.text("name"), table.whole("classes"));
        table.finish();
        let made = name
            .zip(classes)
            .and_then(|(name, classes)| Some((name, usize::try_from(classes).ok()?)));
        let (Some((name, classes)), Some(list)) = (made, &mut all) else {
            all = None;
            continue;
        };
        if list.iter().any(|one| one.name == name) {
            let rule = format!("is \"{name}\" a second time");
            table.fail("name", rule, "names must differ");
        }
        list.push(Attribute {
            name: name.to_owned(),
            classes,
        });
    }
    all
}
