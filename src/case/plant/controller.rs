//! `units.controller`.

use std::sync::Arc;

use calcine_flowsheet::units::Controller;
use calcine_flowsheet::{MeasuredPlace, ProcessUnit, StreamLayout};

use super::field::field;
use super::model::PlantPlace;
use super::quantities::dimension_of;
use super::words::PlantField;
use crate::case::table::TableReader;

pub(super) fn controller(
    own: &TableReader<'_>,
    layout: &StreamLayout,
) -> Option<Box<dyn ProcessUnit>> {
    let kind = own.exactly_one();
    let name = kind.and_then(|kind| own.text(kind));
    let what = own.choice::<PlantField>("field");
    let compound = own.text("of");
    let numbers = ["gain", "filter", "start", "low", "high"].map(|key| own.number(key));
    let time = own.number("time");
    let names: Vec<&str> = layout
        .compounds()
        .iter()
        .map(|one| one.name.as_str())
        .collect();
    let found = compound.and_then(|name| names.iter().position(|own| *own == name));
    let what = what?;
    match (what, compound) {
        (PlantField::Output, _) => {
            let help = "measure a field of a stream, or of what a unit holds";
            own.fail("field", "is of a controller", help);
            return None;
        }
        (PlantField::Class | PlantField::ClassMeanDiameter, _) => {
            let help = "control by a field of all particles";
            own.fail("field", "is of an attribute class", help);
            return None;
        }
        (PlantField::Compound, None) => {
            own.missing("of");
            return None;
        }
        (PlantField::Compound, Some(name)) if found.is_none() => {
            let help = format!("the compounds are {}", names.join(", "));
            own.fail("of", format!("is \"{name}\", which is no compound"), help);
            return None;
        }
        (PlantField::Compound, Some(_)) | (_, None) => {}
        (_, Some(_)) => {
            let help = "remove it, or measure the field \"compound\"";
            own.fail("of", "does not go with this field", help);
        }
    }
    let (place, dimension) = match kind? {
        "stream" => (
            MeasuredPlace::Stream(name?.to_owned()),
            dimension_of(what, PlantPlace::Stream(0)),
        ),
        _ => (
            MeasuredPlace::Unit(name?.to_owned()),
            dimension_of(what, PlantPlace::Unit(0)),
        ),
    };
    let set_point = own.number_as("set_point", dimension);
    let [gain, filter_time, start, low, high] = numbers;
    Some(Box::new(Controller {
        place,
        field: Arc::new(move |layout: &StreamLayout, row: &[f64]| field(layout, row, what, found)),
        set_point: set_point?,
        gain: gain?,
        integral_time: time.unwrap_or(f64::INFINITY),
        filter_time: filter_time?,
        start: start?,
        bounds: [low?, high?],
    }))
}
