//! Buoyant waves on the motion clock (docs/theory.md, TSM-8).
//!
//! With what the gas stores on the process clock, buoyant waves run √AF times faster on the motion
//! clock: a motion span Δt resolves them where N √AF Δt < 2, N the buoyancy frequency.

use calcine_coupler::mesh::Mesh;
use calcine_coupler::setup::{GasPatch, Schedule, WallHeat};

use super::model::Case;

/// The limit of N √AF Δt.
pub const LIMIT: f64 = 2.0;

/// N √AF Δt at the largest acceleration factor; zero without gravity or where nothing is warmer
/// than anything else.
pub fn number(case: &Case, mesh: &Mesh) -> f64 {
    let time = &case.time;
    frequency(case, mesh) * time.acceleration.largest().sqrt() * time.motion_window.seconds()
}

/// What is to be said of a number above the limit.
pub fn warning(number: f64) -> Option<String> {
    (number > LIMIT).then(|| {
        format!(
            "N sqrt(AF) dt is {number:.3}, above {LIMIT}: buoyant waves are not resolved on the \
             motion clock and may grow; shorten `time.motion_window` (or `time.process_step`)"
        )
    })
}

/// Largest buoyancy frequency N in 1/s: N² = g Δρ/(ρ H) with the densities of the coldest and the
/// hottest gas that the case names and the height H of the mesh along gravity. What a heat flux
/// or a reaction adds, and differences of composition, are not known beforehand.
pub fn frequency(case: &Case, mesh: &Mesh) -> f64 {
    let gas = &case.gas;
    let gravity = gas.gravity.norm();
    if gravity == 0.0 || gas.properties.is_vacuum() {
        return 0.0;
    }
    let (coldest, hottest) = temperatures(case);
    let density = |kelvin: f64| {
        gas.properties
            .density(gas.pressure, kelvin, &gas.composition)
    };
    let (heavy, light) = (density(coldest), density(hottest));
    (gravity * (heavy - light) / (0.5 * (heavy + light) * height(case, mesh))).sqrt()
}

/// Height in m of the mesh along gravity; zero where there is none.
pub(super) fn height(case: &Case, mesh: &Mesh) -> f64 {
    let gravity = case.gas.gravity;
    if gravity.norm() == 0.0 {
        return 0.0;
    }
    let up = gravity / -gravity.norm();
    let heights = mesh.topology().points.iter().map(|point| point.dot(&up));
    let (low, high) = heights.fold((f64::MAX, f64::MIN), |(low, high), z| {
        (low.min(z), high.max(z))
    });
    high - low
}

/// Lowest and highest temperature in K that the case states for gas, boundaries and particles.
pub(super) fn temperatures(case: &Case) -> (f64, f64) {
    let mut all = vec![case.gas.temperature];
    for population in &case.particles {
        all.push(population.temperature);
        let prescribed = population.prescribed_temperature.iter();
        all.extend(prescribed.flat_map(|over_time| over_time.0.iter().map(|entry| entry.1)));
    }
    let mut add = |schedule: &Schedule| all.extend(schedule.0.iter().map(|entry| entry.1));
    for (_, patch) in &case.gas.patches {
        if let Some((temperature, _)) = patch.entering() {
            add(temperature);
        }
        if let GasPatch::Wall { heat, .. } = patch {
            match heat {
                WallHeat::Temperature(temperature) => add(temperature),
                WallHeat::Along(along) => along.stations.iter().for_each(|one| add(&one.1)),
                WallHeat::Convective { ambient, .. } => add(ambient),
                WallHeat::Adiabatic | WallHeat::Flux(_) => {}
            }
        }
    }
    let low = all.iter().copied().fold(f64::MAX, f64::min);
    (low, all.iter().copied().fold(f64::MIN, f64::max))
}
