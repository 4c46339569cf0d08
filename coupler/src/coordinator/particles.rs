//! Stage: the motion of the particles over a window, with the force of the gas; last in a window.
//!
//! While the bed is held (see [`crate::hold`]) the solver is not asked for steps: only the coordinator knows of it.

use calcine_interior::without;
use calcine_physics::Vec3;

use super::bed::MappedBed;
use super::error::RunError;
use super::meter::{Meter, Stage};
use crate::checkpoint::{StateFile, StateFileError};
use crate::closures::{CouplingCoefficients, DragInertia};
use crate::exchange::Exchange;
use crate::excursion::Excursion;
use crate::ledger::Ledger;
use crate::momentum_model::MomentumModel;
use crate::part::{
    DRAG_COEFFICIENT, DRAG_IMPULSE, GAS_VELOCITY, GasFields, ParticleFields, ParticlePush,
    ParticleReceived, Particles,
};
use crate::supervisor::Supervisor;
use crate::time::{Clocks, Ticks, Window};
use crate::window_drag::{DragCarry, WindowDrag};

/// What acts on the particles, and what came of it.
#[derive(Default)]
pub(super) struct MotionStage {
    /// True for each population that moves.
    moves: Vec<bool>,
    gravity: Vec3,
    /// True for each particle that moves.
    pub free: Vec<bool>,
    /// As many, and none of them free.
    still: Vec<bool>,
    /// All but drag that acted on each particle in the last window, in N.
    pub other: Vec<Vec3>,
    /// Velocities in m/s at the start of the window.
    velocity: Vec<Vec3>,
    /// How drag acts within a window.
    window_drag: WindowDrag,
    /// What the gas owes of drag that followed the particles.
    pub carry: DragCarry,
    /// Mean drag on each particle over the window in N.
    drag: Vec<Vec3>,
    /// Mean force of the gas on each particle over the window in N.
    pub force: Vec<Vec3>,
    pub push: ParticlePush,
    pub pressure_force: Vec<Vec3>,
    pub received: ParticleReceived,
    /// Motion time for which the bed has been held so far.
    pub held: Ticks,
}

/// What the particles are told of a window.
pub(super) struct MotionInputs<'a> {
    pub mapped: &'a MappedBed,
    pub gas: GasFields<'a>,
    pub exchange: &'a Exchange,
    pub coefficients: &'a CouplingCoefficients,
    pub model: MomentumModel,
    pub window: &'a Window,
    /// True where the bed is held.
    pub holds: bool,
}

impl MotionStage {
    /// Before the first window nothing but its weight is known to act on a particle.
    pub fn new(
        moves: Vec<bool>,
        gravity: Vec3,
        window_drag: WindowDrag,
        particles: &ParticleFields<'_>,
    ) -> Self {
        let mut stage = Self {
            moves,
            gravity,
            window_drag,
            ..Self::default()
        };
        stage.change(&[], particles, 0);
        stage
    }

    /// Takes up what acted on the particles beside drag when a state was recorded.
    pub fn restore_other(&mut self, state: &StateFile) -> Result<(), StateFileError> {
        let values = state.f64s_of("particle_other_force", 3 * self.other.len())?;
        for (force, values) in self.other.iter_mut().zip(values.chunks_exact(3)) {
            force.copy_from_slice(values);
        }
        Ok(())
    }

    /// How particles follow their drag in a window.
    pub fn inertia<'a>(
        &'a mut self,
        particles: &ParticleFields<'a>,
        window: &Window,
        holds: bool,
    ) -> DragInertia<'a> {
        self.still.clear();
        self.still.resize(self.free.len(), false);
        DragInertia {
            mass: particles.mass,
            free: if holds { &self.still } else { &self.free },
            other: &self.other,
            span: window.span.motion.seconds(),
            acceleration: window.acceleration(),
        }
    }

    /// Moves the particles over a window.
    pub fn advance(
        &mut self,
        particles: &mut dyn Particles,
        inputs: &MotionInputs<'_>,
        supervisor: &Supervisor,
        meter: &mut Meter,
    ) -> Result<(), RunError> {
        meter.time(Stage::Exchange, || {
            self.velocity.clear();
            self.velocity.extend_from_slice(particles.fields().velocity);
            inputs.exchange.push(
                &inputs.mapped.operator,
                &inputs.gas,
                &inputs.mapped.solid_volume,
                (inputs.model, self.gravity),
                &mut self.pressure_force,
                &mut self.push,
            );
        });
        self.drag.clone_from(&inputs.exchange.drag);
        self.force.clone_from(&self.push.force);
        self.carry.settle();
        if inputs.holds {
            self.hold(inputs.window);
            return Ok(());
        }
        let follows = self.window_drag.follows();
        if follows {
            inputs.exchange.follow(
                inputs.coefficients,
                inputs.window.acceleration(),
                &self.pressure_force,
                &mut self.push,
            );
        }
        let own = self.own_window(inputs.window);
        meter.time(Stage::Particles, || {
            particles.start(&own, &inputs.mapped.bed, &self.push)?;
            particles.finish(supervisor, &mut self.received)
        })?;
        if follows {
            meter.time(Stage::Exchange, || self.note_drag(particles, inputs))?;
        }
        Ok(())
    }

    /// Takes up what drag that followed the particles came to; what they got beyond what the gas gave, the gas owes.
    fn note_drag(
        &mut self,
        particles: &dyn Particles,
        inputs: &MotionInputs<'_>,
    ) -> Result<(), RunError> {
        let span = inputs.window.span.motion.seconds();
        let count = self.drag.len();
        if count == 0 {
            return Ok(());
        }
        let Some(impulses) = self.received.columns.get(DRAG_IMPULSE, 3, count) else {
            let solver = particles.about().name.clone();
            return Err(RunError::NoDragImpulse { solver, count });
        };
        let mut beyond = vec![Vec3::zeros(); count];
        let impulses = impulses.as_chunks::<3>().0.iter();
        for ((drag, beyond), got) in self.drag.iter_mut().zip(&mut beyond).zip(impulses) {
            let got = Vec3::from(*got);
            *beyond = got - span * *drag;
            *drag = got / span;
        }
        self.carry.carry(&inputs.mapped.operator, &beyond);
        self.force.clear();
        let forces = self.received.impulse.iter();
        self.force.extend(forces.map(|impulse| impulse / span));
        Ok(())
    }

    /// A window in which the bed is held: what holds it takes up the force of the gas, and no balance of the
    /// momentum of free particles is made.
    fn hold(&mut self, window: &Window) {
        let span = window.span.motion.seconds();
        let impulses = self.push.force.iter().map(|force| force * span);
        self.received.impulse.clear();
        self.received.impulse.extend(impulses);
        (self.received.acted, self.received.support) = (span, None);
        self.received.deep_contacts = Some(Excursion::default());
    }

    /// A window on the particles' own clock, which stands while they are held.
    fn own_window(&self, window: &Window) -> Window {
        let start = Clocks {
            motion: window.start.motion.since(self.held),
            ..window.start
        };
        Window { start, ..*window }
    }

    /// What acted on each particle besides drag in N, contacts included: from its change of momentum. While the bed
    /// is held that stays as it was: contacts go on from there.
    pub fn note_forces(
        &mut self,
        particles: &ParticleFields<'_>,
        window: &Window,
        ledger: &mut Ledger,
    ) {
        self.book_momentum(particles, ledger);
        let span = window.span.motion.seconds();
        for (p, drag) in self.drag.iter().enumerate() {
            let change = particles.velocity[p] - self.velocity[p];
            self.other[p] = particles.mass[p] * change / span - drag;
        }
    }

    /// Books the momentum of the particles that move, where the solver says what walls and held particles
    /// gave them: the forces between free particles cancel, whatever they are.
    fn book_momentum(&self, particles: &ParticleFields<'_>, ledger: &mut Ledger) {
        let received = &self.received;
        let Some(support) = received.support else {
            return;
        };
        let (mut left, mut moved) = (-support, support.norm());
        for p in (0..particles.len()).filter(|&p| self.free[p]) {
            let (mass, count) = (particles.row_mass(p), particles.weight_of(p));
            let change = mass * (particles.velocity[p] - self.velocity[p]);
            let weight = mass * received.acted * self.gravity;
            let impulse = count * received.impulse[p];
            left += change - impulse - weight;
            moved += change.norm() + impulse.norm() + weight.norm();
        }
        ledger.particle_momentum.book(left.norm(), moved);
    }

    /// Rows went, and new ones came from one on.
    pub fn change(&mut self, gone: &[usize], particles: &ParticleFields<'_>, first: usize) {
        without(&mut self.other, gone);
        without(&mut self.free, gone);
        for row in first..particles.len() {
            let population = particles.population[row] as usize;
            let free = self.moves.get(population).copied().unwrap_or(false);
            self.free.push(free);
            self.other.push(particles.mass[row] * self.gravity);
        }
        self.push.force.clear();
        self.push.force.resize(particles.len(), Vec3::zeros());
        self.force.clone_from(&self.push.force);
        debug_assert!(self.other.len() == particles.len() && self.free.len() == particles.len());
    }
}

/// Drag can follow the particles only where their solver takes it so.
pub(super) fn check_window_drag(
    drag: WindowDrag,
    particles: &dyn Particles,
) -> Result<(), RunError> {
    let columns = [DRAG_COEFFICIENT, GAS_VELOCITY];
    let missing = columns.into_iter().find(|column| !particles.takes(column));
    match (drag, missing) {
        (WindowDrag::Constant, _) | (WindowDrag::Following, None) => Ok(()),
        (WindowDrag::Following, Some(column)) => Err(RunError::NoFollowingDrag {
            solver: particles.about().name.clone(),
            column,
        }),
    }
}

/// Momentum of all particles in N s.
pub(super) fn momentum(particles: &ParticleFields<'_>) -> Vec3 {
    let rows = particles.velocity.iter().enumerate();
    rows.map(|(row, velocity)| particles.row_mass(row) * velocity)
        .sum()
}
