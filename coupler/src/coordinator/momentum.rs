//! What a window does to the momentum of moving particles (requirements DRG-2).

use calcine_physics::Vec3;

use super::{Run, Workspace};
use crate::closures::Inertia;
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
    }
}

impl Run<'_> {
    /// Makes of the coefficients of drag what acts over the window.
    pub(super) fn relax_drag(&mut self, window: &Window) {
        let particles = self.parts.particles.fields();
        let inertia = Inertia {
            mass: particles.mass,
            free: &self.work.free,
            other: &self.work.other,
            span: window.span.motion.seconds(),
            acceleration: window.acceleration(),
        };
        self.work.coefficients.relax(&inertia);
    }

    /// Remembers the velocities from which the particles start.
    pub(super) fn note_velocities(&mut self) {
        let fields = self.parts.particles.fields();
        self.work.velocity.clear();
        self.work.velocity.extend_from_slice(fields.velocity);
    }

    /// What acted on each particle besides drag, contacts included: from its change of momentum.
    pub(super) fn note_forces(&mut self, window: &Window) {
        let span = window.span.motion.seconds();
        let fields = self.parts.particles.fields();
        let work = &mut self.work;
        for p in 0..fields.len() {
            let change = fields.velocity[p] - work.velocity[p];
            work.other[p] = fields.mass[p] * change / span - work.exchange.drag[p];
        }
    }
}
