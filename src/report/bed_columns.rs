//! The fields of a snapshot as numbers, one a particle or cell, by names that people read.

use std::collections::BTreeMap;

use super::number::axis_label;
use crate::results::lengths_of;
use crate::results::read::{Array, Arrays, is_field};

/// A field.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct BedColumn {
    /// Its name: that of the case, `speed` of a velocity, `diameter`.
    pub name: String,
    /// Name with unit, for an axis.
    pub label: String,
    /// Values.
    pub values: Vec<f64>,
}

/// All that has one number, or one vector, for each of `count`; of vectors the magnitude. A number that only some have, as those with
/// shells beside those without, is NaN for the others.
pub(super) fn columns(
    arrays: &Arrays,
    count: usize,
    units: &BTreeMap<String, String>,
) -> Vec<BedColumn> {
    let column = |(name, array): (&String, &Array)| {
        let lengths = arrays.get(&lengths_of(name));
        let ragged = lengths.is_some_and(|own| array.components > 1 || !own.values.contains(&0.0));
        let fits = array.values.len() == count * array.components;
        if !is_field(name) || ragged || !fits {
            return None;
        }
        let unit = units.get(name).map_or("", String::as_str);
        let (name, unit, values) = match (name.as_str(), array.components) {
            ("radius", 1) => {
                let values = array.values.iter().map(|radius| 2e3 * radius).collect();
                ("diameter", "mm", values)
            }
            (_, 1) => (name.as_str(), unit, array.values.clone()),
            (_, 3) => {
                let vectors = array.values.chunks_exact(3);
                let length = |v: &[f64]| v.iter().map(|x| x * x).sum::<f64>().sqrt();
                let values = vectors.map(length).collect();
                match name.as_str() {
                    "velocity" => ("speed", "m/s", values),
                    other => (other, unit, values),
                }
            }
            _ => return None,
        };
        Some(BedColumn {
            name: name.to_owned(),
            label: axis_label(name, unit),
            values,
        })
    };
    arrays.iter().filter_map(column).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn vectors_have_their_magnitude_and_ragged_columns_are_left_out() {
        let array = |components: usize, values: &[f64]| Array {
            components,
            values: values.to_vec(),
        };
        let arrays = Arrays::from([
            ("points".to_owned(), array(3, &[0.0; 6])),
            ("id".to_owned(), array(1, &[1.0, 2.0])),
            ("radius".to_owned(), array(1, &[0.001, 0.002])),
            (
                "velocity".to_owned(),
                array(3, &[3.0, 4.0, 0.0, 0.0, 0.0, 2.0]),
            ),
            ("shell".to_owned(), array(3, &[0.0; 6])),
            ("shell.lengths".to_owned(), array(1, &[3.0, 0.0])),
            (
                "centre_temperature".to_owned(),
                array(1, &[300.0, f64::NAN]),
            ),
            (
                "centre_temperature.lengths".to_owned(),
                array(1, &[1.0, 0.0]),
            ),
            ("mean_density".to_owned(), array(1, &[7.0, 8.0])),
        ]);
        let units = BTreeMap::from([("mean_density".to_owned(), "kg/m^3".to_owned())]);
        let found = columns(&arrays, 2, &units);
        let labels: Vec<&str> = found.iter().map(|one| one.label.as_str()).collect();
        assert_eq!(
            labels,
            [
                "centre temperature",
                "mean density in kg/m³",
                "diameter in mm",
                "speed in m/s"
            ]
        );
        assert!(found[0].values[0] == 300.0 && found[0].values[1].is_nan());
        assert_eq!(found[2].values, [2.0, 4.0]);
        assert_eq!(found[3].values, [5.0, 2.0]);
    }
}
