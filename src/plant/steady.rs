//! Steady states of a plant's case: next to a run, and over a key.

use std::time::Instant;

use calcine_flowsheet::{Continuation, ContinuationPoint, Plant, PlantError};

use super::summary::{
    PlantContinuationPoint, PlantContinuationSummary, PlantMode, PlantSteadySummary,
};
use crate::case::plant::{ContinuationSpec, PlantCase, SteadyFrom, SteadySpec, parse_plant};

/// The steady state that a case asks for, next to the unknowns at the end of its run.
pub(super) fn steady(
    case: &PlantCase,
    spec: SteadySpec,
    end: &[f64],
) -> Result<PlantSteadySummary, PlantError> {
    let plant = &case.plant;
    let begun = Instant::now();
    let found = match spec.from {
        SteadyFrom::End => plant.steady(end, case.end)?,
        SteadyFrom::Start => plant.steady(&plant.start(), case.end)?,
    };
    let first = begun.elapsed().as_secs_f64();
    let begun = Instant::now();
    let stability = plant.stability(&found, case.end)?;
    let modes = stability.modes.iter().take(spec.modes);
    let modes = modes.map(|mode| {
        let period = 2.0 * std::f64::consts::PI / mode.frequency.abs();
        PlantMode::new(mode.rate, period)
    });
    Ok(PlantSteadySummary {
        iterations: found.iterations,
        residual_per_s: found.residual,
        distance: distance(plant, end, &found.unknowns),
        modes: modes.collect(),
        wall_time_s: [first, begun.elapsed().as_secs_f64()],
    })
}

/// Largest difference of a mass relative to what its unit holds, over all units.
fn distance(plant: &Plant, one: &[f64], other: &[f64]) -> f64 {
    let of = |unit: usize| {
        let (a, b) = (plant.held_by(unit, one), plant.held_by(unit, other));
        let masses = plant.layout().enthalpy();
        let size: f64 = b[..masses].iter().sum();
        let apart = a[..masses].iter().zip(&b).map(|(a, b)| (a - b).abs());
        let apart = apart.fold(0.0, f64::max);
        if apart == 0.0 { 0.0 } else { apart / size }
    };
    (0..plant.units().len()).map(of).fold(0.0, f64::max)
}

/// The plant of a case with other values of some keys, one of which an error names.
pub(super) fn plant_with(
    case: &PlantCase,
    settings: &[String],
    value: f64,
) -> Result<Plant, PlantError> {
    let read = parse_plant(&case.path, &case.effective, settings);
    read.map(|case| case.plant).map_err(|wrong| {
        let first = wrong.problems().first();
        PlantError::NoPlant {
            value,
            cause: first.map(|one| one.message.clone()).unwrap_or_default(),
        }
    })
}

/// Steady states over the values of a key, and the limits of stability between them.
pub(super) fn continuation(
    case: &PlantCase,
    spec: &ContinuationSpec,
) -> Result<PlantContinuationSummary, PlantError> {
    let make = |value: f64| plant_with(case, &spec.settings(value), value);
    let states = Continuation::new(make, case.end);
    let points = states.follow(&spec.values)?;
    let limits = states.limits(&points, spec.width)?;
    let told = |point: &ContinuationPoint| PlantContinuationPoint {
        value: point.value,
        mode: PlantMode::new(point.growth_rate, point.period),
    };
    Ok(PlantContinuationSummary {
        keys: spec.keys.clone(),
        unit: spec.unit.clone(),
        points: points.iter().map(told).collect(),
        limits: limits.iter().map(told).collect(),
    })
}
