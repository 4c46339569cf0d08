//! Gas that no mixture can be: fractions below zero, temperatures at or below zero.

use std::fmt;

use crate::part::GasFields;

/// A value of a gas that no gas can have.
#[derive(Clone, Debug, PartialEq)]
pub struct UnphysicalGas {
    /// What it is a value of.
    pub quantity: String,
    /// The cell.
    pub cell: usize,
    /// The value.
    pub value: f64,
    /// Its unit, with a space before it; empty for a fraction.
    pub unit: &'static str,
}

impl fmt::Display for UnphysicalGas {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self {
            quantity,
            cell,
            value,
            unit,
        } = self;
        write!(f, "{quantity} in cell {cell} is {value:.4e}{unit}")
    }
}

impl UnphysicalGas {
    /// The value that is farthest from what a gas can have: a temperature at or below zero first, then a mass fraction that is
    /// below zero by more than `tolerance`. What is NaN is farther than all.
    pub fn find(gas: &GasFields<'_>, species: &[String], tolerance: f64) -> Option<Self> {
        // A vacuum has no temperature.
        let is_vacuum =
            gas.density.iter().all(|density| *density == 0.0) && !gas.density.is_empty();
        if is_vacuum {
            return None;
        }
        let least = |values: &[f64], bound: f64| {
            let mut found: Option<(usize, f64)> = None;
            for (place, value) in values.iter().enumerate() {
                let outside = value.is_nan() || *value < bound;
                if outside && found.is_none_or(|(_, worst)| value.is_nan() || *value < worst) {
                    found = Some((place, *value));
                }
            }
            found
        };
        if let Some((cell, value)) = least(gas.temperature, f64::MIN_POSITIVE) {
            return Some(Self {
                quantity: "the temperature of the gas".to_owned(),
                cell,
                value,
                unit: " K",
            });
        }
        let (place, value) = least(gas.composition, -tolerance)?;
        let each = species.len().max(1);
        let name = species.get(place % each).map_or("", |name| name);
        Some(Self {
            quantity: format!("the mass fraction of {name}"),
            cell: place / each,
            value,
            unit: "",
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gas_columns::GasColumns;

    #[test]
    fn what_no_gas_can_have_is_found_with_its_cell_and_its_species() {
        let species = ["CO".to_owned(), "CO2".to_owned()];
        let mut temperature = [300.0, 400.0];
        let mut composition = [0.2, 0.8, -1e-4, 1.0001];
        let empty = GasColumns::default();
        let find = |temperature: &[f64], composition: &[f64], tolerance| {
            let gas = GasFields {
                temperature,
                composition,
                ..empty.fields()
            };
            UnphysicalGas::find(&gas, &species, tolerance)
        };
        assert_eq!(find(&temperature, &composition, 1e-3), None);
        let found = find(&temperature, &composition, 1e-6).unwrap();
        assert_eq!(
            found.to_string(),
            "the mass fraction of CO in cell 1 is -1.0000e-4"
        );
        composition[1] = f64::NAN;
        let found = find(&temperature, &composition, 1e-3).unwrap();
        assert!(found.cell == 0 && found.value.is_nan(), "{found}");
        temperature[1] = -47.7;
        let found = find(&temperature, &composition, 1e-3).unwrap();
        assert_eq!(
            found.to_string(),
            "the temperature of the gas in cell 1 is -4.7700e1 K"
        );
    }
}
