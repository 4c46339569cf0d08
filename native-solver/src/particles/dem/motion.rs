//! Velocity Verlet, with rotation.
//!
//! What walls and held particles give the free ones is counted on the way, from the other side of the
//! forces: Σ_free walls − Σ_held pairs = Σ_all walls − Σ_held (walls + pairs), because the forces of a pair
//! cancel. That the momentum of the free particles changes by no more than this, gravity and what they
//! are pushed with is what a ledger can find out.

use calcine_coupler::physics::Vec3;

use super::block::Block;
use super::sphere::{SphereMotion, SpherePosition};

/// What a kick needs.
#[derive(Clone, Copy, Debug)]
pub struct KickInputs {
    /// Half a step in s.
    pub half: f64,
    /// Number of half kicks: the last of one step and the first of the next are done together.
    pub times: u32,
    /// Gravity in m/s².
    pub gravity: Vec3,
}

/// Kicks the particles of a block.
#[inline(always)]
fn kick(kick: &KickInputs, moves: &mut SphereMotion, force: Vec3, torque: Vec3) {
    // A held particle has no inverse mass: no gravity either.
    let gravity = if moves.inverse_mass > 0.0 {
        kick.gravity
    } else {
        Vec3::zeros()
    };
    let change = (force * moves.inverse_mass + gravity) * kick.half;
    let turn = torque * (moves.inverse_inertia * kick.half);
    for _ in 0..kick.times {
        moves.velocity += change;
        moves.spin += turn;
    }
}

/// Kicks and moves the particles of a block; returns the square of their largest speed in m²/s².
pub fn drift<const BUDGET: bool>(
    block: &mut Block,
    now: &KickInputs,
    place: &mut [SpherePosition],
    moves: &mut [SphereMotion],
    push: &[Vec3],
) -> f64 {
    let step = 2.0 * now.half;
    let mut fastest = 0.0f64;
    let mut held = Vec3::zeros();
    for (((load, place), moves), push) in block.load.iter().zip(place).zip(moves).zip(push) {
        kick(now, moves, load.force + push, load.torque);
        place.centre += moves.velocity * step;
        fastest = fastest.max(moves.velocity.norm_squared());
        if moves.inverse_mass == 0.0 {
            held += load.force;
        }
        if BUDGET && moves.inverse_mass > 0.0 {
            let way = moves.velocity * step;
            block.budget.gravity_work += now.gravity.dot(&way) / moves.inverse_mass;
            block.budget.push_work += push.dot(&way);
        }
    }
    block.support += (block.wall_force - held) * (now.half * f64::from(now.times));
    fastest
}

/// The last half kick of a window.
pub fn close(block: &mut Block, now: &KickInputs, moves: &mut [SphereMotion], push: &[Vec3]) {
    let mut held = Vec3::zeros();
    for ((load, moves), push) in block.load.iter().zip(moves).zip(push) {
        kick(now, moves, load.force + push, load.torque);
        if moves.inverse_mass == 0.0 {
            held += load.force;
        }
    }
    block.support += (block.wall_force - held) * now.half;
}
