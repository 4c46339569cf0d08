//! Fields of streams, and of what units hold.

use calcine_flowsheet::StreamLayout;
use calcine_flowsheet::distribution::{mean_diameter, quantile};

use super::words::PlantField;

/// Most attribute classes that series have columns of.
pub const MOST_CLASSES: usize = 40;

/// Name of an attribute class by its place among all: `colour 1`; classes count from 1.
pub fn class_name(layout: &StreamLayout, index: usize) -> String {
    let (attribute, class) = layout.attribute_classes()[index];
    format!("{} {}", layout.attributes()[attribute].name, class + 1)
}

/// A field of a state in SI units; NaN where there is nothing to measure. `part` is the compound, or the attribute class by its
/// place among all.
pub fn field(layout: &StreamLayout, state: &[f64], field: PlantField, part: Option<usize>) -> f64 {
    let of_sizes = |measure: &dyn Fn(&[f64]) -> Option<f64>| measure(&layout.by_size(state));
    match field {
        PlantField::Output => f64::NAN,
        PlantField::Mass => layout.mass_flow(state),
        PlantField::Solids => layout.solid_flow(state),
        PlantField::Compound => part.map_or(f64::NAN, |k| layout.compound_flow(state, k)),
        PlantField::Class => of_class(layout, state, part).iter().sum(),
        PlantField::ClassMeanDiameter => {
            let sizes = of_class(layout, state, part);
            mean_diameter(layout.grid(), &sizes).unwrap_or(f64::NAN)
        }
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

/// Mass by size class of the particles of an attribute class.
fn of_class(layout: &StreamLayout, state: &[f64], index: Option<usize>) -> Vec<f64> {
    let wanted = index.and_then(|index| layout.attribute_classes().get(index).copied());
    layout.by_size_where(state, |own| {
        wanted.is_some_and(|(attribute, class)| own[attribute] == class)
    })
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
