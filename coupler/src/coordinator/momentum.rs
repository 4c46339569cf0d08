//! What a window does to the momentum of moving particles (requirements DRG-2).

use calcine_physics::Vec3;

use super::{CoupledRun, Workspace};
use crate::closures::DragInertia;
use crate::part::ParticleFields;
use crate::time::Window;

impl Workspace {
    /// Before the first window nothing but its weight is known to act on a particle.
    pub(super) fn begin(&mut self, particles: &ParticleFields<'_>, free: &[bool], gravity: Vec3) {
        self.free.clear();
        let moves = |&of: &u32| free.get(of as usize).copied().unwrap_or(false);
        self.free.extend(particles.population.iter().map(moves));
        self.other.clear();
        self.other
            .extend(particles.mass.iter().map(|mass| *mass * gravity));
        self.push.force.resize(particles.len(), Vec3::zeros());
        self.coefficients.slip.resize(particles.len(), 0.0);
    }
}

impl CoupledRun {
    /// Makes of the coefficients of drag what acts over the window.
    pub(super) fn relax_drag(&mut self, window: &Window) {
        let still = self.holds(window);
        let particles = self.parts.particles.fields();
        let work = &mut self.work;
        work.still.clear();
        work.still.resize(work.free.len(), false);
        let inertia = DragInertia {
            mass: particles.mass,
            free: if still { &work.still } else { &work.free },
            other: &work.other,
            span: window.span.motion.seconds(),
            acceleration: window.acceleration(),
        };
        work.coefficients.relax(&inertia);
    }

    /// Remembers the velocities from which the particles start.
    pub(super) fn note_velocities(&mut self) {
        let fields = self.parts.particles.fields();
        self.work.velocity.clear();
        self.work.velocity.extend_from_slice(fields.velocity);
    }

    /// Books the momentum of the particles that move, where the solver says what walls and held particles
    /// gave them: the forces between free particles cancel, whatever they are.
    fn book_momentum(&mut self) {
        let Some(support) = self.work.particle_received.support else {
            return;
        };
        let (fields, work) = (self.parts.particles.fields(), &self.work);
        let received = &work.particle_received;
        let (mut left, mut moved) = (-support, support.norm());
        for p in (0..fields.len()).filter(|&p| work.free[p]) {
            let mass = fields.mass[p];
            let change = mass * (fields.velocity[p] - work.velocity[p]);
            let weight = mass * received.acted * self.plan.gravity;
            left += change - received.impulse[p] - weight;
            moved += change.norm() + received.impulse[p].norm() + weight.norm();
        }
        self.ledger.particle_momentum.book(left.norm(), moved);
    }

    /// What acted on each particle besides drag, contacts included: from its change of momentum. While the bed
    /// is held that stays as it was: contacts go on from there.
    pub(super) fn note_forces(&mut self, window: &Window) {
        if self.holds(window) {
            return;
        }
        self.book_momentum();
        let span = window.span.motion.seconds();
        let fields = self.parts.particles.fields();
        let work = &mut self.work;
        for p in 0..fields.len() {
            let change = fields.velocity[p] - work.velocity[p];
            work.other[p] = fields.mass[p] * change / span - work.exchange.drag[p];
        }
    }
}
