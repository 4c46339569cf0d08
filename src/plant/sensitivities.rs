//! How what is measured depends on the keys that are tuned.

use std::path::Path;

use calcine_flowsheet::Derivatives;

use super::summary::PlantSensitivity;
use crate::case::plant::PlantTuningSpec;
use crate::results::ResultsError;
use crate::results::files::{self, SENSITIVITIES};
use crate::results::sheet::{line, number};

/// One number that is compared or told.
pub(super) struct Observed {
    /// Of what.
    pub place: String,
    /// Time in s.
    pub time: f64,
    /// Which number of it.
    pub what: String,
    /// Unit.
    pub unit: String,
    /// What was measured, and its standard deviation; none of a quantity of the case.
    pub measured: Option<[f64; 2]>,
    /// Place among the objectives.
    pub objective: Option<usize>,
}

/// Derivatives of the quantities of the case.
pub(super) fn sensitivities_of(
    observed: &[Observed],
    derivatives: &Derivatives,
) -> Vec<PlantSensitivity> {
    let quantities = observed.iter().enumerate();
    let quantities = quantities.filter(|(_, one)| one.measured.is_none());
    let of = |(row, one): (usize, &Observed)| PlantSensitivity {
        quantity: one.place.clone(),
        unit: one.unit.clone(),
        value: derivatives.values[row],
        by: derivatives
            .columns
            .iter()
            .map(|column| column[row])
            .collect(),
    };
    quantities.map(of).collect()
}

/// Writes what was measured, what the plant does, and its derivatives by the keys in their units.
pub(super) fn write_sensitivities(
    out: &Path,
    spec: &PlantTuningSpec,
    observed: &[Observed],
    derivatives: &Derivatives,
) -> Result<(), ResultsError> {
    files::directory(out)?;
    let path = out.join(SENSITIVITIES);
    let mut head: Vec<String> = [
        "place",
        "time_s",
        "what",
        "unit",
        "measured",
        "deviation",
        "model",
    ]
    .map(String::from)
    .to_vec();
    let keys = spec.parameters.iter();
    head.extend(keys.map(|key| match key.unit.as_str() {
        "" => format!("d/d {}", key.key),
        unit => format!("d/d {} per {unit}", key.key),
    }));
    let mut text = line(&path, &head)?;
    for (row, one) in observed.iter().enumerate() {
        let [measured, deviation] = one.measured.unwrap_or([f64::NAN; 2]);
        let mut words = vec![
            one.place.clone(),
            number(one.time),
            one.what.clone(),
            one.unit.clone(),
        ];
        words.extend([measured, deviation, derivatives.values[row]].map(number));
        words.extend(derivatives.columns.iter().map(|column| number(column[row])));
        text.extend(line(&path, &words)?);
    }
    files::replace(&path, &text)
}
