//! The motion span of a case that states `time.process_step`.
//!
//! Where no particle moves, the motion clock carries nothing but the gas' inertia, and its flow
//! follows its boundary where the run has motion time enough. Its span then is a matter of convergence alone (docs/theory.md, TSM-8).

use calcine_coupler::mesh::Mesh;
use calcine_coupler::setup::{GasPatch, InletFlow, Schedule};
use calcine_coupler::time::{Acceleration, Ticks};

use super::buoyancy;
use super::model::Case;

/// Cells of mean size that the gas crosses in a motion span at its largest speed: few enough for the
/// outer loop to converge in about as many iterations as with a window chosen by hand.
const CELLS_CROSSED: f64 = 1.0;
/// N √AF Δt is kept below half of its limit of 2 (docs/theory.md, TSM-8).
const BUOYANT_NUMBER: f64 = 1.0;

/// Chooses motion window and acceleration factor where the case states a process step: the shorter
/// of the time in which gas at the largest inlet superficial velocity, in the smallest void fraction
/// that the smoother allows, crosses a cell of mean size, and of what keeps N √AF Δt at 1.
/// Never longer than the process step itself. Where steps change, all windows are of the shortest motion time of any of them.
pub fn settle(case: &mut Case, mesh: &Mesh) {
    let Some(steps) = case.time.process_step.clone() else {
        return;
    };
    let spans = steps
        .iter()
        .map(|(_, step)| motion_span(case, mesh, step.seconds()));
    let span = spans.fold(f64::INFINITY, f64::min);
    // Shorter than a tick means a gas beyond any speed; one window a step is then as good.
    let chosen = Ticks::from_seconds(span)
        .ok()
        .filter(|&span| span > Ticks::ZERO);
    let shortest = steps.iter().map(|(_, step)| *step).min();
    let Some(motion) = chosen.or(shortest) else {
        return;
    };
    let factor = |step: Ticks| (step.seconds() / motion.seconds()).max(1.0);
    // What is not in a list holds from the start.
    let from = |time: Ticks| if steps.len() > 1 { time } else { Ticks::ZERO };
    let factors = steps
        .iter()
        .map(|(time, step)| (from(*time), factor(*step)));
    if let Ok(acceleration) = Acceleration::schedule(factors.collect()) {
        case.time.motion_window = motion;
        case.time.acceleration = acceleration;
    }
}

/// Motion span in s for a process step in s.
pub(super) fn motion_span(case: &Case, mesh: &Mesh, step: f64) -> f64 {
    let volume: f64 = mesh.cell_volume().iter().sum();
    let size = (volume / mesh.cells() as f64).cbrt();
    let pores = 1.0 - case.coupling.max_solid_fraction;
    let speed = fastest(case, mesh) / pores;
    let crossing = CELLS_CROSSED * size / speed;
    // N √(Δτ/Δt) Δt = 1
    let frequency = buoyancy::frequency(case, mesh);
    let buoyant = BUOYANT_NUMBER.powi(2) / (frequency.powi(2) * step);
    crossing.min(buoyant).min(step)
}

/// The largest superficial velocity in m/s of what flows in or stands in the gas at the start.
fn fastest(case: &Case, mesh: &Mesh) -> f64 {
    let patches = case.gas.patches.iter();
    let inlets = patches.map(|(name, patch)| fastest_in(case, mesh, name, patch));
    inlets
        .filter(|speed| speed.is_finite())
        .fold(case.gas.velocity.norm(), f64::max)
}

/// The largest superficial velocity in m/s at an inlet; zero at any other patch.
pub(super) fn fastest_in(case: &Case, mesh: &Mesh, name: &str, patch: &GasPatch) -> f64 {
    let gas = &case.gas;
    let largest = |schedule: &Schedule| schedule.0.iter().map(|entry| entry.1).fold(0.0, f64::max);
    let GasPatch::Inlet {
        flow, temperature, ..
    } = patch
    else {
        return 0.0;
    };
    match flow {
        InletFlow::SuperficialVelocity(velocity) => largest(velocity),
        InletFlow::MassFlow(flow) => {
            let (kelvin, composition) = (largest(temperature), &gas.composition);
            let density = gas.properties.density(gas.pressure, kelvin, composition);
            largest(flow) / (density * area(mesh, name))
        }
    }
}

/// Area of a patch in m².
pub(super) fn area(mesh: &Mesh, name: &str) -> f64 {
    let faces = mesh.patch(name).map(|patch| patch.faces());
    faces.map_or(0.0, |faces| {
        mesh.face_area()[faces].iter().map(|area| area.norm()).sum()
    })
}
