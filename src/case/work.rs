//! How long a case may take, estimated before it runs.

use calcine_coupler::motion::Motion;
use calcine_coupler::setup::ParticleSetup;
use calcine_coupler::view_factors::ViewFactors;

use super::model::{Case, MotionSpec};
use super::span;

/// Wall time in s of native gas and coupling in a cell and window, about, on two cores: shipped cases take 8 to 20 µs.
const CELL: f64 = 15e-6;
/// Of a free particle in a step of its motion: 0.15 to 0.2 µs.
const STEP: f64 = 0.2e-6;
/// Of a particle in a window: mapping, laws, heat.
const PARTICLE: f64 = 2e-6;
/// Of a parcel in a window, with one step of its motion: 2 to 5 µs.
const PARCEL: f64 = 4e-6;
/// Of a particle that reacts in a window, over its attempts.
const REACTING: f64 = 80e-6;
/// Of a ray by which a particle's view factors are found: 1 to 2.5 µs.
const RAY: f64 = 2e-6;

/// Estimated wall time in s of a native run. What feeds bring is not in it.
pub(super) fn seconds(case: &Case, cells: usize, setup: &ParticleSetup) -> f64 {
    let windows = span::windows(&case.time) as f64;
    let gas = match case.gas_held {
        true => 0.0,
        false => cells as f64 * CELL,
    };
    let steps = match &setup.motion {
        Motion::Free(contacts) => case.time.motion_window.seconds() / contacts.step,
        Motion::Frozen | Motion::Parcels(_) => 0.0,
    };
    let reacts = |population: &usize| {
        let material = case.particles[*population].material;
        !case.chemistry.reactions.is_empty() && case.materials[material].composition.is_some()
    };
    let populations = setup.population.iter().map(|one| *one as usize);
    let of_particles: f64 = populations
        .map(|population| {
            let motion = match case.particles[population].motion {
                MotionSpec::Free => STEP * steps,
                MotionSpec::Parcels => PARCEL,
                _ => 0.0,
            };
            let chemistry = if reacts(&population) { REACTING } else { 0.0 };
            PARTICLE + motion + chemistry
        })
        .sum();
    windows * (gas + of_particles) + views(case, setup, windows) * RAY
}

/// Rays that are followed in a run.
fn views(case: &Case, setup: &ParticleSetup, windows: f64) -> f64 {
    let Some(radiation) = &case.laws.radiation else {
        return 0.0;
    };
    let ViewFactors::Rays { rays, .. } = radiation.view_factors else {
        return 0.0;
    };
    let times = match setup.motion {
        Motion::Frozen => 1.0,
        _ => windows.min((case.time.end.seconds() / radiation.refresh).ceil()),
    };
    times * rays as f64 * setup.radius.len() as f64
}

/// A wall time in a unit that suits it, to one or two digits.
pub(super) fn shown(seconds: f64) -> String {
    let units = [
        (86400.0 * 365.25, "years"),
        (86400.0, "days"),
        (3600.0, "h"),
        (60.0, "min"),
    ];
    let unit = units.iter().find(|(size, _)| seconds >= 2.0 * size);
    let (size, name) = unit.copied().unwrap_or((1.0, "s"));
    match seconds / size {
        less if less < 1.0 => "1 s or less".into(),
        value if value < 1e4 => format!("about {value:.0} {name}"),
        value => format!("about {value:.1e} {name}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::valid::ValidCase;

    #[test]
    fn times_are_shown_in_a_unit_that_suits_them() {
        let told = [0.2, 90.0, 600.0, 9000.0, 4e5, 1e9].map(shown);
        assert_eq!(
            told,
            [
                "1 s or less",
                "about 90 s",
                "about 10 min",
                "about 2 h",
                "about 5 days",
                "about 32 years"
            ]
        );
    }

    #[test]
    fn an_estimate_is_that_of_a_measured_run_within_a_factor_of_three() {
        // Wall times in s on two cores.
        let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR"));
        for (name, measured) in [
            ("fluidised-bed", 82.0),
            ("settled-bed", 5.6),
            ("purged-bed", 12.6),
            ("bed-conductivity", 3.5),
        ] {
            let path = folder.join(format!("cases/{name}.toml"));
            let valid = ValidCase::open(&path, &[]).unwrap();
            let estimated = seconds(
                &valid.case,
                valid.prepared.mesh.cells(),
                &valid.prepared.particles,
            );
            let ratio = estimated / measured;
            assert!((1.0 / 3.0..3.0).contains(&ratio), "{name}: {estimated} s");
        }
    }
}
