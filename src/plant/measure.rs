//! Fields of streams, and of what units hold.

use calcine_flowsheet::distribution::{mean_diameter, quantile};
use calcine_flowsheet::{Plant, PlantRun, StreamLayout};

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
    /// Compound of the field `compound`.
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
        add("moisture".into(), "1", PlantField::Moisture, None);
        add("temperature".into(), "K", PlantField::Temperature, None);
        add("mean_diameter".into(), "m", PlantField::MeanDiameter, None);
        for share in [10, 50, 90] {
            add(format!("d{share}"), "m", PlantField::Quantile(share), None);
        }
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

/// A field of a state in SI units; NaN where there is nothing to measure.
pub(super) fn field(
    layout: &StreamLayout,
    state: &[f64],
    field: PlantField,
    compound: Option<usize>,
) -> f64 {
    let of_sizes = |measure: &dyn Fn(&[f64]) -> Option<f64>| measure(&layout.by_size(state));
    match field {
        PlantField::Mass => layout.mass_flow(state),
        PlantField::Solids => layout.solid_flow(state),
        PlantField::Compound => compound.map_or(f64::NAN, |k| layout.compound_flow(state, k)),
        PlantField::Moisture => {
            let liquids = 0..layout.compounds().len();
            let liquids: f64 = liquids.map(|k| state[layout.liquid(k)]).sum();
            let solids = layout.solid_flow(state);
            if solids > 0.0 {
                liquids / solids
            } else {
                f64::NAN
            }
        }
        PlantField::Temperature => layout.temperature(state).unwrap_or(f64::NAN),
        PlantField::MeanDiameter => {
            of_sizes(&|sizes| mean_diameter(layout.grid(), sizes)).unwrap_or(f64::NAN)
        }
        PlantField::Quantile(percent) => {
            let share = f64::from(percent) / 100.0;
            of_sizes(&|sizes| quantile(layout.grid(), sizes, share)).unwrap_or(f64::NAN)
        }
    }
}

/// A row of the series: the time and each column.
pub(super) fn row(run: &PlantRun<'_>, plant: &Plant, columns: &[Column]) -> Vec<f64> {
    let mut row = vec![run.time()];
    let mut last: Option<(PlantPlace, Vec<f64>)> = None;
    for column in columns {
        let own = match last.take().filter(|(of, _)| *of == column.of) {
            Some(own) => own,
            None => (column.of, state(run, column.of)),
        };
        row.push(field(plant.layout(), &own.1, column.field, column.compound));
        last = Some(own);
    }
    row
}

#[cfg(test)]
mod tests {
    use super::*;
    use calcine_flowsheet::{Compound, SizeGrid};

    #[test]
    fn fields_of_a_stream_are_those_of_its_numbers() {
        let grid = SizeGrid::uniform(4, 0.0, 4e-3).unwrap();
        let compound = |name: &str| Compound {
            name: name.into(),
            volatile: false,
            solid_heat_capacity: 1000.0,
            liquid_heat_capacity: 4000.0,
            vapour_heat_capacity: 1000.0,
            evaporation_heat: 0.0,
        };
        let layout = StreamLayout::new(grid, Vec::new(), vec![compound("a"), compound("b")]);
        let layout = layout.unwrap();
        let mut stream = vec![0.0; layout.width()];
        // 1 kg/s of a in the second class, 3 kg/s of b in the third, 0.2 kg/s of liquid b.
        stream[2] = 1.0;
        stream[5] = 3.0;
        stream[layout.liquid(1)] = 0.2;
        layout.set_temperature(&mut stream, 310.0);
        let of = |which, compound| field(&layout, &stream, which, compound);
        assert_eq!(of(PlantField::Mass, None), 4.2);
        assert_eq!(of(PlantField::Solids, None), 4.0);
        assert_eq!(of(PlantField::Compound, Some(1)), 3.2);
        assert_eq!(of(PlantField::Moisture, None), 0.05);
        assert!((of(PlantField::Temperature, None) - 310.0).abs() < 1e-9);
        // (1 · 1.5 + 3 · 2.5)/4 mm, and linear within the third class: 1 + 3 x = 2.
        assert!((of(PlantField::MeanDiameter, None) - 2.25e-3).abs() < 1e-15);
        assert!((of(PlantField::Quantile(50), None) - (2e-3 + 1e-3 / 3.0)).abs() < 1e-15);
        let nothing = vec![0.0; layout.width()];
        assert!(field(&layout, &nothing, PlantField::Temperature, None).is_nan());
    }
}
