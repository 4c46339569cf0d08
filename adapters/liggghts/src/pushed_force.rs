//! Forces of the gas that are constant over a window.
//!
//! LIGGGHTS' own way, `fix addforce` by variables of each particle, evaluates an expression a component, particle and step: a fifth as
//! much again as all else takes. Here they are added to the forces at each step behind the script's own, in the order of its sums.

use std::ffi::c_int;
use std::sync::atomic::{AtomicBool, Ordering};

use crate::library::{Liggghts, StepHook};

/// The fix that holds the forces in N; the script of a moving bed makes it.
pub const PUSH: &str = "calcine_push";

/// The fix by which LIGGGHTS calls the host at each step.
pub const EACH_STEP: &str = "calcine_each_step";

/// True once LIGGGHTS has called.
static CALLED: AtomicBool = AtomicBool::new(false);

/// Whether LIGGGHTS has called, as it does in its setup: otherwise forces of the gas would not act.
pub fn acts() -> bool {
    CALLED.load(Ordering::Relaxed)
}

/// Has them act on all but the populations that are held, from now on, for as long as what is given back lives.
pub fn act(liggghts: &mut Liggghts, held: &[u64]) -> StepHook {
    let held: Vec<c_int> = held.iter().map(|kind| *kind as c_int + 1).collect();
    let mut kinds: Vec<c_int> = Vec::new();
    let work = move |liggghts: &mut Liggghts| {
        CALLED.store(true, Ordering::Relaxed);
        kinds.clear();
        if !held.is_empty() {
            kinds.extend_from_slice(liggghts.integers("type").unwrap_or_default());
        }
        let Some(rows) = liggghts.forces_with(PUSH, 3) else {
            return;
        };
        let is_held = |place: usize| kinds.get(place).is_some_and(|kind| held.contains(kind));
        let pushed = rows.fix.as_chunks::<3>().0;
        let forces = rows.force.as_chunks_mut::<3>().0;
        for (place, (force, push)) in forces.iter_mut().zip(pushed).enumerate() {
            if is_held(place) {
                continue;
            }
            for (force, push) in force.iter_mut().zip(push) {
                *force += push;
            }
        }
    };
    liggghts.at_each_step(Box::new(work))
}
