//! Divergence: numbers that are not finite, or that no gas of this model can have.

use calcine_coupler::physics::Vec3;

use super::failure::{GasFailure, Place};
use super::state::GasState;
use crate::numerics::parallel::largest;

/// Above this temperature in K neither the mixture's properties nor the low-Mach model mean
/// anything.
const HIGHEST_TEMPERATURE: f64 = 1e4;
/// Above this speed in m/s, some thirty times that of sound in cold air, neither does.
const HIGHEST_SPEED: f64 = 1e4;

/// Refuses an iterate's fields that are not finite, or a temperature that no property is defined for.
pub fn nonsense(now: &GasState, centre: &[Vec3]) -> Result<(), GasFailure> {
    let (cell, strangeness) = largest(centre.len(), |cell| {
        let sum = now.temperature[cell] + now.velocity[cell].sum() + now.pressure[cell];
        if now.temperature[cell] > 0.0 && (sum + now.mass[cell]).is_finite() {
            0.0
        } else {
            1.0
        }
    });
    if strangeness == 0.0 {
        return Ok(());
    }
    complaint(now, centre)?;
    Err(GasFailure::NotFinite {
        place: Place {
            cell,
            centre: centre[cell],
        },
    })
}

/// Refuses an attempt's fields that no gas of this model can have.
pub fn complaint(now: &GasState, centre: &[Vec3]) -> Result<(), GasFailure> {
    let cells = centre.len();
    let worst = |strangeness: &(dyn Fn(usize) -> f64 + Sync)| {
        let (cell, value) = largest(cells, strangeness);
        (value.is_nan() || value > 1.0).then_some(cell)
    };
    let say = |field, value, unit, cell: usize| {
        let place = Place {
            cell,
            centre: centre[cell],
        };
        Err(GasFailure::OutOfRange {
            field,
            value,
            unit,
            place,
        })
    };
    // Each measure is at most 1 where all is well, larger the worse it is, and NaN where it must be.
    let mass = |cell: usize| {
        if now.mass[cell] > 0.0 {
            0.0
        } else {
            2.0 - now.mass[cell]
        }
    };
    let temperature = |cell: usize| {
        let value = now.temperature[cell];
        if value > 0.0 {
            value / HIGHEST_TEMPERATURE
        } else {
            2.0 - value
        }
    };
    let speed = |cell: usize| now.velocity[cell].norm() / HIGHEST_SPEED;
    let pressure = |cell: usize| {
        if now.pressure[cell].is_finite() {
            0.0
        } else {
            f64::NAN
        }
    };
    if let Some(cell) = worst(&temperature) {
        return say("temperature", now.temperature[cell], "K", cell);
    }
    if let Some(cell) = worst(&speed) {
        return say("speed", now.velocity[cell].norm(), "m/s", cell);
    }
    if let Some(cell) = worst(&pressure) {
        return say("relative pressure", now.pressure[cell], "Pa", cell);
    }
    if let Some(cell) = worst(&mass) {
        return say("gas mass", now.mass[cell], "kg", cell);
    }
    Ok(())
}
