//! `[[quantities]]`, `steady` and `continuation`.

use calcine_flowsheet::Plant;

use super::field::{MOST_CLASSES, class_name};
use super::model::{ContinuationSpec, PlantMeasure, PlantPlace, PlantQuantity, SteadySpec};
use super::words::{LimitField, OverTime, PlantField, SteadyField};
use crate::case::table::TableReader;
use crate::case::tolerance::{band, band_about};
use crate::case::units::Dimension;

/// What a measure may ask for.
pub(super) struct Measurable<'a> {
    /// The plant; `None` where it could not be read.
    pub plant: Option<&'a Plant>,
    /// Whether a steady state is looked for.
    pub steady: bool,
    /// Whether steady states are followed over a key, and the unit of its values.
    pub continuation: Option<&'a str>,
}

/// All quantities.
pub(super) fn quantities(root: &TableReader<'_>, known: &Measurable<'_>) -> Vec<PlantQuantity> {
    let mut made: Vec<PlantQuantity> = Vec::new();
    for table in &root.tables("quantities") {
        let name = table.text("name");
        let found = table.table("measure").and_then(|reader| {
            let found = measure(&reader, known);
            reader.finish();
            found
        });
        let (agree, expected) = (table.has("agree"), table.table("expect"));
        let Some((measure, dimension, unit)) = found else {
            table.finish();
            continue;
        };
        let agree = match agree {
            true => band(table, "agree", dimension),
            false => None,
        };
        let expect = expected.and_then(|reader| {
            let value = reader.number_as("value", dimension);
            let within = band_about(&reader, value, dimension);
            reader.finish();
            value.zip(within)
        });
        table.finish();
        let Some(name) = name else { continue };
        if made.iter().any(|other| other.name == name) {
            let rule = format!("is \"{name}\" a second time");
            table.fail("name", rule, "names must differ");
        }
        made.push(PlantQuantity {
            name: name.into(),
            measure,
            unit,
            expect,
            agree,
        });
    }
    made
}

/// The measure, its dimension and its unit.
fn measure(
    reader: &TableReader<'_>,
    known: &Measurable<'_>,
) -> Option<(PlantMeasure, Dimension, String)> {
    match reader.exactly_one()? {
        "steady" => {
            let field = reader.choice::<SteadyField>("steady")?;
            if !known.steady {
                let help = "add the table [steady]";
                reader.fail(
                    "steady",
                    "is measured, but no steady state is looked for",
                    help,
                );
            }
            let dimension = match field {
                SteadyField::GrowthRate => Dimension::ANGULAR_VELOCITY,
                SteadyField::Period => Dimension::TIME,
                SteadyField::Distance => Dimension::NONE,
            };
            let unit = match field {
                SteadyField::GrowthRate => "1/s".into(),
                _ => unit_of(dimension),
            };
            Some((PlantMeasure::Steady(field), dimension, unit))
        }
        "limit" => {
            let field = reader.choice::<LimitField>("limit")?;
            let Some(unit) = known.continuation else {
                let help = "add the table [continuation]";
                reader.fail("limit", "is measured, but no key is followed", help);
                return None;
            };
            Some(match field {
                LimitField::Period => (PlantMeasure::Limit(field), Dimension::TIME, "s".into()),
                LimitField::Value => {
                    let shown = if unit.is_empty() { "1" } else { unit };
                    let found = crate::case::units::quantities(&format!("1 {unit}")).ok()?.1;
                    (PlantMeasure::Limit(field), found, shown.to_owned())
                }
            })
        }
        kind => over_time(reader, kind, known),
    }
}

fn over_time(
    reader: &TableReader<'_>,
    kind: &'static str,
    known: &Measurable<'_>,
) -> Option<(PlantMeasure, Dimension, String)> {
    let place = place(reader, kind, known.plant);
    reader.need("field");
    let (over, from) = (reader.choice::<OverTime>("over"), reader.number("from"));
    let (field, compound) = field(reader, known.plant)?;
    if let Some(PlantPlace::Unit(unit)) = place
        && known.plant.is_some_and(|plant| plant.controls(unit)) != (field == PlantField::Output)
    {
        let help = "measure the field \"output\" of controllers, and others of other units";
        reader.fail("field", "does not go with this unit", help);
    }
    if let (Some(PlantPlace::Stream(_)), PlantField::Output) = (place, field) {
        let help = "measure it of a controller, with `unit`";
        reader.fail("field", "does not go with a stream", help);
    }
    let over = over?;
    if over == OverTime::Last && reader.has("from") {
        let help = "remove it, or add `over`";
        reader.fail("from", "has no effect on a last value", help);
    }
    let of = place?;
    let dimension = match over {
        OverTime::Period => Dimension::TIME,
        _ => dimension_of(field, of),
    };
    let measure = PlantMeasure::OverTime {
        of,
        field,
        compound,
        over,
        from: from?,
    };
    Some((measure, dimension, unit_of(dimension)))
}

/// The stream or unit that a key of this kind names.
pub(super) fn place(
    reader: &TableReader<'_>,
    kind: &'static str,
    plant: Option<&Plant>,
) -> Option<PlantPlace> {
    let name = reader.text(kind);
    let (name, plant) = (name?, plant?);
    let (place, all): (_, Vec<&str>) = match kind {
        "stream" => (
            plant.stream(name).map(PlantPlace::Stream),
            plant.streams().iter().map(String::as_str).collect(),
        ),
        _ => (
            plant.unit(name).map(PlantPlace::Unit),
            plant
                .units()
                .iter()
                .map(|unit| unit.name.as_str())
                .collect(),
        ),
    };
    if place.is_none() {
        let help = format!("the {kind}s are {}", all.join(", "));
        reader.fail(kind, format!("is \"{name}\", which is no {kind}"), help);
    }
    if let Some(PlantPlace::Unit(unit)) = place
        && !plant.holds(unit)
        && !plant.controls(unit)
    {
        let help = "measure a stream, or a granulator or bunker";
        reader.fail(kind, format!("is \"{name}\", which holds nothing"), help);
    }
    place
}

/// The field that is measured, with the compound that it is of.
pub(super) fn field(
    reader: &TableReader<'_>,
    plant: Option<&Plant>,
) -> Option<(PlantField, Option<usize>)> {
    let field = reader.choice::<PlantField>("field");
    let compound = reader.text("of");
    let (field, plant) = (field?, plant?);
    let layout = plant.layout();
    let compounds = layout.compounds().iter().map(|one| one.name.clone());
    let classes = layout.attribute_classes().len();
    let of_class = matches!(field, PlantField::Class | PlantField::ClassMeanDiameter);
    if of_class && classes > MOST_CLASSES {
        let rule = format!("is of attribute classes, of which the plant has {classes}");
        let help =
            format!("measure a plant with up to {MOST_CLASSES}: series have no columns of more");
        reader.fail("field", rule, help);
        return None;
    }
    let (what, names): (_, Vec<String>) = match of_class {
        true => (
            "attribute class",
            (0..classes)
                .map(|index| class_name(layout, index))
                .collect(),
        ),
        false => ("compound", compounds.collect()),
    };
    let found = compound.and_then(|name| names.iter().position(|own| *own == name));
    match (field == PlantField::Compound || of_class, compound) {
        (true, None) => {
            reader.missing("of");
            return None;
        }
        (true, Some(name)) if found.is_none() => {
            let help = match names[..] {
                [] => "the plant has no [[attributes]]".into(),
                _ if of_class => format!("the attribute classes are {}", names.join(", ")),
                _ => format!("the compounds are {}", names.join(", ")),
            };
            reader.fail("of", format!("is \"{name}\", which is no {what}"), help);
            return None;
        }
        (true, Some(_)) | (_, None) => {}
        (_, Some(_)) => {
            let help = "remove it, or measure the field \"compound\" or \"class\"";
            reader.fail("of", "does not go with this field", help);
        }
    }
    Some((field, found))
}

/// The dimension of a field of a stream or a unit.
pub(super) fn dimension_of(field: PlantField, of: PlantPlace) -> Dimension {
    let amount = match of {
        PlantPlace::Stream(_) => Dimension::MASS_FLOW,
        PlantPlace::Unit(_) => Dimension::MASS,
    };
    match field {
        PlantField::Mass | PlantField::Solids | PlantField::Compound | PlantField::Class => amount,
        PlantField::Moisture | PlantField::Output => Dimension::NONE,
        PlantField::Temperature => Dimension::TEMPERATURE,
        PlantField::MeanDiameter | PlantField::ClassMeanDiameter | PlantField::Quantile(_) => {
            Dimension::LENGTH
        }
    }
}

/// A text of a number and a unit, which may be empty.
pub(super) fn number_and_unit(text: &str) -> Option<(f64, &str)> {
    let text = text.trim();
    let end = text.find(|c: char| c.is_alphabetic() || c.is_whitespace() || c == '%');
    // "1e3": the letter belongs to the number; so does the one of "1e-9 1/s".
    let mut split = match text.parse::<f64>() {
        Ok(_) => text.len(),
        Err(_) => end.unwrap_or(text.len()),
    };
    if let Some((number, _)) = text.split_once(char::is_whitespace)
        && number.parse::<f64>().is_ok()
    {
        split = number.len();
    }
    let (number, rest) = text.split_at(split);
    Some((number.parse::<f64>().ok()?, rest.trim()))
}

pub(super) fn unit_of(dimension: Dimension) -> String {
    match dimension {
        Dimension::NONE => "1".into(),
        other => other.unit(),
    }
}

/// `steady`.
pub(super) fn steady(root: &TableReader<'_>) -> Option<SteadySpec> {
    if !root.has("steady") {
        return None;
    }
    let table = root.table("steady")?;
    let (from, modes) = (table.choice("from"), table.whole("modes"));
    table.finish();
    Some(SteadySpec {
        from: from?,
        modes: usize::try_from(modes?).ok()?,
    })
}

/// `continuation`.
pub(super) fn continuation(root: &TableReader<'_>) -> Option<ContinuationSpec> {
    if !root.has("continuation") {
        return None;
    }
    let table = root.table("continuation")?;
    let (keys, texts) = (table.texts("keys"), table.texts("values"));
    let width = table.number("width");
    table.finish();
    let (keys, texts) = (keys?, texts?);
    if keys.is_empty() {
        table.fail("keys", "names no key", "name one, as `--set` does");
    }
    let mut values: Vec<f64> = Vec::new();
    let mut unit: Option<String> = None;
    for text in &texts {
        let Some((number, rest)) = number_and_unit(text) else {
            let rule = format!("has \"{text}\", which is no number with a unit");
            table.fail("values", rule, "for example \"4\" or \"2.2 mm\"");
            return None;
        };
        if unit.get_or_insert_with(|| rest.to_owned()) != rest {
            let rule = format!("has \"{text}\", whose unit is not that of the first");
            table.fail("values", rule, "write all values in one unit");
            return None;
        }
        values.push(number);
    }
    if values.len() < 2 {
        let rule = format!("has {} values", values.len());
        table.fail("values", rule, "write two at least");
        return None;
    }
    Some(ContinuationSpec {
        keys,
        values,
        unit: unit.unwrap_or_default(),
        width: width?,
    })
}
