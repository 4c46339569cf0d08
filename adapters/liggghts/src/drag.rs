//! Drag by coefficient K and gas velocity u, which follows each particle's own velocity from step to step (docs/theory.md,
//! DRG-3).
//!
//! LIGGGHTS kicks a particle by half a step, moves it, finds its forces and kicks it by another half with them; the first
//! half of the next step has the same forces. Both halves together are one kick, from velocities that are known when the
//! forces are found: with the other forces F constant over it, the exact solution of m dv/dt = K (u − v) + F over the
//! kick's span Δt gains φ(a) (F + K (u − v)) Δt/m, a = K Δt/m, φ(a) = (1 − e^−a)/a. The force that makes just this gain is
//! given to LIGGGHTS; what it has beyond F is the drag. A window begins and ends with a kick of half a step.

use crate::error::HostError;
use crate::library::{Liggghts, StepHook};

/// The fix with the numbers of each particle; the script makes it where drag comes by coefficient.
pub const DRAG: &str = "calcine_drag";
/// Numbers of each particle: K in kg/s, u in m/s, the drag in N that LIGGGHTS' forces contain, its impulse over the window
/// in N s, and 1/m in 1/kg, 0 for one that is held.
const NUMBERS: usize = 11;
const COEFFICIENT: usize = 0;
const GAS: usize = 1;
const ACTING: usize = 4;
const IMPULSE: usize = 7;
const INVERSE_MASS: usize = 10;

/// What is pushed to this rank's particles, in the order of its state.
#[derive(Debug, Default)]
pub struct PushedDrag {
    /// Coefficients in kg/s.
    pub coefficient: Vec<f64>,
    /// Velocities of the gas in m/s.
    pub gas: Vec<[f64; 3]>,
    /// 1/m in 1/kg; 0 for particles that are held.
    pub inverse_mass: Vec<f64>,
}

/// Begins a window of so many steps of a length in s: drag acts from the first half kick on until what is given back is
/// dropped. `place` has LIGGGHTS' place of each particle of the state; coefficients are multiplied by a scale.
pub fn begin(
    liggghts: &mut Liggghts,
    place: &[usize],
    pushed: &PushedDrag,
    scale: f64,
    (steps, step): (i64, f64),
) -> Result<StepHook, HostError> {
    let rows = liggghts.forces_with(DRAG, NUMBERS);
    let rows = rows.ok_or(HostError::Missing { name: DRAG })?;
    for (p, &place) in place.iter().enumerate() {
        let own = &mut rows.fix[NUMBERS * place..NUMBERS * (place + 1)];
        // The forces are those of the last window's end.
        for axis in 0..3 {
            rows.force[3 * place + axis] -= own[ACTING + axis];
        }
        own[COEFFICIENT] = scale * pushed.coefficient[p];
        own[GAS..ACTING].copy_from_slice(&pushed.gas[p]);
        own[IMPULSE..INVERSE_MASS].fill(0.0);
        own[INVERSE_MASS] = pushed.inverse_mass[p];
    }
    kick(liggghts, 0.5 * step);
    let mut left = steps;
    let work = move |liggghts: &mut Liggghts| {
        left -= 1;
        kick(liggghts, if left > 0 { step } else { 0.5 * step });
    };
    Ok(liggghts.at_each_step(Box::new(work)))
}

/// Adds the drag of a kick of a span in s to forces that have none, and its impulse to those of the window.
fn kick(liggghts: &mut Liggghts, span: f64) {
    let Some(rows) = liggghts.forces_with(DRAG, NUMBERS) else {
        return;
    };
    let moves = rows.force.as_chunks_mut::<3>().0.iter_mut();
    let moves = moves.zip(rows.velocity.as_chunks::<3>().0);
    for (own, (force, velocity)) in rows.fix.as_chunks_mut::<NUMBERS>().0.iter_mut().zip(moves) {
        let coefficient = own[COEFFICIENT];
        let relaxations = coefficient * span * own[INVERSE_MASS];
        let share = match relaxations > 0.0 {
            true => -(-relaxations).exp_m1() / relaxations,
            false => 1.0,
        };
        for axis in 0..3 {
            let slip = own[GAS + axis] - velocity[axis];
            let drag = share * coefficient * slip - (1.0 - share) * force[axis];
            own[IMPULSE + axis] += drag * span;
            if own[INVERSE_MASS] > 0.0 {
                force[axis] += drag;
                own[ACTING + axis] = drag;
            }
        }
    }
}

/// The impulses in N s of drag over the window, by LIGGGHTS' places, interleaved.
pub fn impulses(liggghts: &mut Liggghts, place: &[usize]) -> Result<Vec<f64>, HostError> {
    let rows = liggghts.forces_with(DRAG, NUMBERS);
    let rows = rows.ok_or(HostError::Missing { name: DRAG })?;
    let here = place.iter().map(|place| NUMBERS * place);
    let here = here.flat_map(|own| &rows.fix[own + IMPULSE..own + INVERSE_MASS]);
    Ok(here.copied().collect())
}

/// Takes the drag out of the forces, as the next window would at its begin.
pub fn take_off(liggghts: &mut Liggghts) {
    let Some(rows) = liggghts.forces_with(DRAG, NUMBERS) else {
        return;
    };
    let forces = rows.force.chunks_exact_mut(3);
    for (own, force) in rows.fix.chunks_exact_mut(NUMBERS).zip(forces) {
        for (force, drag) in force.iter_mut().zip(&mut own[ACTING..IMPULSE]) {
            *force -= std::mem::take(drag);
        }
    }
}

/// LIGGGHTS' setup has found all forces anew, without drag.
pub fn forget(liggghts: &mut Liggghts) {
    if let Some(rows) = liggghts.forces_with(DRAG, NUMBERS) {
        for own in rows.fix.chunks_exact_mut(NUMBERS) {
            own[ACTING..IMPULSE].fill(0.0);
        }
    }
}
