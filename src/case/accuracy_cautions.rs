//! Tolerances, windows and meshes with which a case runs and its results are likely wrong.

use calcine_coupler::mesh::Mesh;
use calcine_coupler::setup::ParticleSetup;

use super::model::{Case, MeshSpec};
use super::units::{short, short3};

/// Scaled residual of the outer loop from which pressures are wrong: what continuity leaves then drives pressures of its own
/// (docs/theory.md, NUM-1).
const LOOSE_OUTER: f64 = 1e-3;
/// Tolerance from which linear solvers hardly do anything: a pressure correction by itself gains a factor of 100.
const LOOSE_LINEAR: f64 = 1e-2;
/// Largest Courant number at which the gases were tried (docs/verification.md, ducts that lean by 65°).
pub(super) const MOST_COURANT: f64 = 20.0;
/// Courant number up to which every mesh of docs/verification.md was tried.
const TRIED_COURANT: f64 = 5.0;
/// Extent in m from which a mesh of a file without a bed is likely one in mm.
const FAR: f64 = 20.0;
/// Fewest particles by whose size a mesh can be judged.
const FEWEST: usize = 10;

/// Tolerances that are no tolerances.
pub(super) fn tolerances(case: &Case) -> Vec<String> {
    if case.gas_held || case.gas.properties.is_vacuum() {
        return Vec::new();
    }
    let controls = &case.gas.controls;
    let mut all = Vec::new();
    if controls.outer_tolerance >= LOOSE_OUTER {
        all.push(format!(
            "`gas.controls.outer_tolerance` is {}: from {LOOSE_OUTER:e} on, what is left of continuity drives pressures that are not those of \
             the flow; write 1e-6, the default, or 1e-4 where pressures do not matter",
            short(controls.outer_tolerance)
        ));
    }
    let linear = controls.linear_tolerance;
    if let Some(tolerance) = linear.filter(|one| *one >= LOOSE_LINEAR) {
        all.push(format!(
            "`gas.controls.linear_tolerance` is {}: the linear solvers end with a residual of that share, so that the outer loop hardly \
             gains anything; leave it out, or write 1e-8 or less",
            short(tolerance)
        ));
    }
    all
}

/// Windows in which gas crosses more cells than was tried; by its number of cells at the fastest inlet.
pub(super) fn courant(case: &Case, courant: f64) -> Option<String> {
    let bound = case.time.window_bounds.and_then(|bounds| bounds.courant);
    let courant = bound.map_or(courant, |bound| courant.min(bound));
    (courant > MOST_COURANT).then(|| {
        let window = case.time.motion_window.seconds();
        format!(
            "gas crosses {} cells within a window (Courant number), above the {MOST_COURANT} at which the gases were tried: what changes within \
             a window is smeared, and the outer loop may end at its limit; shorten `time.motion_window` to {} s (Courant number \
             {TRIED_COURANT}), unless the steady state alone counts",
            short3(courant),
            short3(window * TRIED_COURANT / courant)
        )
    })
}

/// A mesh of a file that looks as if its lengths were mm.
pub(super) fn extents(case: &Case, mesh: &Mesh, setup: &ParticleSetup) -> Option<String> {
    if !matches!(case.mesh, MeshSpec::PolyMesh(_)) || setup.id.len() >= FEWEST {
        return None;
    }
    let [low, high] = mesh.bounds();
    let size = high - low;
    (size.max() > FAR).then(|| {
        format!(
            "the mesh measures {} x {} x {} m: lengths in the files of a polyMesh are m; if it was made in mm, scale it \
             (`transformPoints -scale '(0.001 0.001 0.001)'`)",
            short3(size.x),
            short3(size.y),
            short3(size.z)
        )
    })
}

#[cfg(test)]
mod tests {
    use crate::case::cautions::tests::{one, said};
    use crate::case::warnings::tests::warned;

    #[test]
    fn tolerances_that_leave_pressures_wrong_are_told() {
        let outer = |value: &str| format!("gas.controls.outer_tolerance={value}");
        let text = one("open-box", &[&outer("1e-3")]);
        assert!(text.contains("is 0.001: from 1e-3 on"), "{text}");
        assert!(said("open-box", &[&outer("5e-4")]).is_empty());
        let linear = |value: &str| format!("gas.controls.linear_tolerance={value}");
        let text = one("open-box", &[&linear("1")]);
        assert!(text.contains("linear_tolerance` is 1:"), "{text}");
        assert!(said("open-box", &[&linear("1e-4")]).is_empty());
    }

    #[test]
    fn windows_of_courant_numbers_beyond_those_tried_are_told() {
        let told = |window: &str| {
            let set = format!("time.motion_window={window}");
            let all = warned("turbulent-duct", &["time.end=10 s", &set]);
            all.into_iter()
                .find(|one| one.contains("cells within a window"))
        };
        // Courant number 0.8 with the window of the case.
        assert_eq!(told("20 ms"), None);
        let text = told("1 s").unwrap();
        assert!(text.contains("above the 20 at which"), "{text}");
    }
}
