//! Fields of streams, and of what units hold.

use calcine_flowsheet::{Plant, PlantRun};

pub(super) use crate::case::plant::field;
use crate::case::plant::{MOST_CLASSES, class_name};
use crate::case::plant::{PlantField, PlantPlace};

/// A column of the series.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Column {
    /// Name in the files.
    pub name: String,
    /// Unit.
    pub unit: &'static str,
    /// Of what.
    pub of: PlantPlace,
    /// Which field.
    pub field: PlantField,
    /// Compound of the field `compound`, attribute class of the field `class`.
    pub compound: Option<usize>,
}

/// All places of a plant whose state is written: streams, then the units that hold something.
pub(super) fn places(plant: &Plant) -> Vec<(PlantPlace, String)> {
    let streams = plant.streams().iter().enumerate();
    let streams = streams.map(|(k, name)| (PlantPlace::Stream(k), format!("streams.{name}")));
    let units = plant.units().iter().enumerate();
    let units = units.filter(|(k, _)| plant.holds(*k));
    let units = units.map(|(k, unit)| (PlantPlace::Unit(k), format!("units.{}", unit.name)));
    streams.chain(units).collect()
}

/// The columns of the series.
pub(super) fn columns(plant: &Plant) -> Vec<Column> {
    let mut all = Vec::new();
    for (of, place) in places(plant) {
        let (flow, unit) = match of {
            PlantPlace::Stream(_) => ("flow", "kg/s"),
            PlantPlace::Unit(_) => ("mass", "kg"),
        };
        let mut add = |word: String, unit, field, compound| {
            all.push(Column {
                name: format!("{place}.{word}"),
                unit,
                of,
                field,
                compound,
            });
        };
        let (all_mass, solids) = match of {
            PlantPlace::Stream(_) => ("mass_flow".into(), "solid_flow".into()),
            PlantPlace::Unit(_) => ("mass".into(), "solid_mass".into()),
        };
        add(all_mass, unit, PlantField::Mass, None);
        add(solids, unit, PlantField::Solids, None);
        for (k, compound) in plant.layout().compounds().iter().enumerate() {
            let word = format!("{flow}_of_{}", compound.name);
            add(word, unit, PlantField::Compound, Some(k));
        }
        let classes = plant.layout().attribute_classes().len();
        for k in (0..classes).filter(|_| classes <= MOST_CLASSES) {
            let class = class_name(plant.layout(), k).replace(' ', "_");
            let word = format!("solid_{flow}_of_{class}");
            add(word, unit, PlantField::Class, Some(k));
            let word = format!("mean_diameter_of_{class}");
            add(word, "m", PlantField::ClassMeanDiameter, Some(k));
        }
        add("moisture".into(), "1", PlantField::Moisture, None);
        add("temperature".into(), "K", PlantField::Temperature, None);
        add("mean_diameter".into(), "m", PlantField::MeanDiameter, None);
        for share in [10, 50, 90] {
            add(format!("d{share}"), "m", PlantField::Quantile(share), None);
        }
    }
    let units = plant.units().iter().enumerate();
    for (k, unit) in units.filter(|(k, _)| plant.controls(*k)) {
        all.push(Column {
            name: format!("units.{}.output", unit.name),
            unit: "1",
            of: PlantPlace::Unit(k),
            field: PlantField::Output,
            compound: None,
        });
    }
    all
}

/// The state of a place, by the places of a stream: kg/s and W, or kg and J.
pub(super) fn state(run: &PlantRun<'_>, of: PlantPlace) -> Vec<f64> {
    match of {
        PlantPlace::Stream(index) => run.stream(index).to_vec(),
        PlantPlace::Unit(index) => run.held_by(index),
    }
}

/// A row of the series: the time and each column.
pub(super) fn row(run: &PlantRun<'_>, plant: &Plant, columns: &[Column]) -> Vec<f64> {
    let mut row = vec![run.time()];
    let mut last: Option<(PlantPlace, Vec<f64>)> = None;
    for column in columns {
        if let (PlantField::Output, PlantPlace::Unit(unit)) = (column.field, column.of) {
            row.push(run.setting(unit));
            continue;
        }
        let own = match last.take().filter(|(of, _)| *of == column.of) {
            Some(own) => own,
            None => (column.of, state(run, column.of)),
        };
        row.push(field(plant.layout(), &own.1, column.field, column.compound));
        last = Some(own);
    }
    row
}
