//! Velocity Verlet, with rotation.
//!
//! What walls and held particles give the free ones is counted on the way, from the other side of the
//! forces: Σ_free walls − Σ_held pairs = Σ_all walls − Σ_held (walls + pairs), because the forces of a pair
//! cancel. That the momentum of the free particles changes by no more than this, gravity and what they
//! are pushed with is what a ledger can find out.

use calcine_coupler::physics::Vec3;

use super::block::Block;
use super::sphere::{SphereDrag, SphereMotion, SpherePosition};

/// What a kick needs.
#[derive(Clone, Copy, Debug)]
pub struct KickInputs {
    /// Half a step in s.
    pub half: f64,
    /// Number of half kicks, one or two: the last of one step and the first of the next are done together.
    pub times: u32,
    /// Gravity in m/s².
    pub gravity: Vec3,
}

/// What kicks a particle.
pub trait Kick {
    /// Kicks it with a force in N and a torque in N m of contacts and push; the impulse in N s of what acts beside them.
    fn kick(self, now: &KickInputs, moves: &mut SphereMotion, force: Vec3, torque: Vec3) -> Vec3;
}

/// Force, torque and gravity alone.
#[derive(Clone, Copy, Debug)]
pub struct ForceKick;

impl Kick for ForceKick {
    #[inline(always)]
    fn kick(self, now: &KickInputs, moves: &mut SphereMotion, force: Vec3, torque: Vec3) -> Vec3 {
        // A held particle has no inverse mass: no gravity either.
        let gravity = if moves.inverse_mass > 0.0 {
            now.gravity
        } else {
            Vec3::zeros()
        };
        let change = (force * moves.inverse_mass + gravity) * now.half;
        let turn = torque * (moves.inverse_inertia * now.half);
        moves.velocity += change;
        moves.spin += turn;
        if now.times > 1 {
            moves.velocity += change;
            moves.spin += turn;
        }
        Vec3::zeros()
    }
}

/// A drag K (u − v) beside them: with the other forces constant over the kick the exact solution of
/// m dv/dt = K (u − v) + F, stable however stiff. The impulse of the drag is what the others leave of the change of
/// momentum.
impl Kick for &mut SphereDrag {
    #[inline(always)]
    fn kick(self, now: &KickInputs, moves: &mut SphereMotion, force: Vec3, torque: Vec3) -> Vec3 {
        let span = now.half * f64::from(now.times);
        if moves.inverse_mass == 0.0 {
            let impulse = self.coefficient * span * self.gas;
            self.impulse += impulse;
            return impulse;
        }
        let other = force * moves.inverse_mass + now.gravity;
        let rate = self.coefficient * moves.inverse_mass;
        let a = rate * span;
        let share = if a > 0.0 { -(-a).exp_m1() / a } else { 1.0 };
        let change = (other + rate * (self.gas - moves.velocity)) * (share * span);
        moves.velocity += change;
        moves.spin += torque * (moves.inverse_inertia * span);
        let impulse = (change - other * span) / moves.inverse_mass;
        self.impulse += impulse;
        impulse
    }
}

/// Kicks and moves the particles of a block; returns the square of their largest speed in m²/s².
pub fn drift<const BUDGET: bool, K: Kick>(
    block: &mut Block,
    now: &KickInputs,
    (place, moves): (&mut [SpherePosition], &mut [SphereMotion]),
    push: &[Vec3],
    kicks: impl IntoIterator<Item = K>,
) -> f64 {
    pulp::Arch::new().dispatch(Drift::<BUDGET, _> {
        block,
        now,
        place,
        moves,
        push,
        kicks: kicks.into_iter(),
    })
}

/// The work of [`drift`], compiled for each set of vector instructions.
struct Drift<'a, const BUDGET: bool, I> {
    block: &'a mut Block,
    now: &'a KickInputs,
    place: &'a mut [SpherePosition],
    moves: &'a mut [SphereMotion],
    push: &'a [Vec3],
    kicks: I,
}

impl<const BUDGET: bool, I: Iterator<Item: Kick>> pulp::WithSimd for Drift<'_, BUDGET, I> {
    type Output = f64;

    #[inline(always)]
    fn with_simd<S: pulp::Simd>(self, _: S) -> f64 {
        let Self {
            block,
            now,
            place,
            moves,
            push,
            kicks,
        } = self;
        move_all::<BUDGET, _>(block, now, (place, moves), push, kicks)
    }
}

#[inline(always)]
fn move_all<const BUDGET: bool, K: Kick>(
    block: &mut Block,
    now: &KickInputs,
    (place, moves): (&mut [SpherePosition], &mut [SphereMotion]),
    push: &[Vec3],
    kicks: impl Iterator<Item = K>,
) -> f64 {
    let step = 2.0 * now.half;
    let mut fastest = 0.0f64;
    let mut held = Vec3::zeros();
    let spheres = block.load.iter().zip(place).zip(moves).zip(push).zip(kicks);
    for ((((load, place), moves), push), kick) in spheres {
        let impulse = kick.kick(now, moves, load.force + push, load.torque);
        place.centre += moves.velocity * step;
        let square = moves.velocity.norm_squared();
        if square > fastest {
            fastest = square;
        }
        if moves.inverse_mass == 0.0 {
            held += load.force;
        }
        if BUDGET && moves.inverse_mass > 0.0 {
            let way = moves.velocity * step;
            block.budget.gravity_work += now.gravity.dot(&way) / moves.inverse_mass;
            let beside = impulse / (now.half * f64::from(now.times));
            block.budget.push_work += (push + beside).dot(&way);
        }
    }
    block.support += (block.wall_force - held) * (now.half * f64::from(now.times));
    fastest
}

/// The last half kick of a window.
pub fn close<K: Kick>(
    block: &mut Block,
    now: &KickInputs,
    moves: &mut [SphereMotion],
    push: &[Vec3],
    kicks: impl IntoIterator<Item = K>,
) {
    let mut held = Vec3::zeros();
    for (((load, moves), push), kick) in block.load.iter().zip(moves).zip(push).zip(kicks) {
        kick.kick(now, moves, load.force + push, load.torque);
        if moves.inverse_mass == 0.0 {
            held += load.force;
        }
    }
    block.support += (block.wall_force - held) * now.half;
}
