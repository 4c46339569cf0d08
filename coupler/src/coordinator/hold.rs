//! Windows in which the bed is held (see [`crate::hold`]). Only the coordinator knows of them: the solver of the
//! particles is told once that they come to rest, and is not asked for steps.

use super::{CoupledRun, RunError};
use crate::motion::ParticleChanges;
use crate::supervisor::Supervisor;
use crate::time::{Clocks, Window};

impl CoupledRun {
    /// True where particles that move are held over a window.
    pub(super) fn holds(&self, window: &Window) -> bool {
        !self.plan.free.is_empty() && self.plan.holds.at(window.start.process).0
    }

    /// Brings the bed to rest before a window in which it is held; it is told once, as it still moves.
    pub(super) fn bring_to_rest(
        &mut self,
        supervisor: &Supervisor,
        window: &Window,
    ) -> Result<(), RunError> {
        if !self.holds(window) {
            return Ok(());
        }
        let fields = self.parts.particles.fields();
        let mut speeds = fields.velocity.iter().chain(fields.angular_velocity);
        if speeds.any(|speed| speed.iter().any(|x| *x != 0.0)) {
            let change = ParticleChanges {
                rest: true,
                ..ParticleChanges::default()
            };
            self.parts.particles.change(supervisor, &change)?;
        }
        Ok(())
    }

    /// A window in which the bed is held: what holds it takes up the force of the gas, and no balance of the
    /// momentum of free particles is made.
    pub(super) fn hold(&mut self, window: &Window) {
        let span = window.span.motion.seconds();
        let (force, received) = (&self.work.push.force, &mut self.work.particle_received);
        received.impulse.clear();
        received
            .impulse
            .extend(force.iter().map(|force| force * span));
        (received.acted, received.support) = (span, None);
    }

    /// A window on the particles' own clock, which stands while they are held.
    pub(super) fn own_window(&self, window: &Window) -> Window {
        let start = Clocks {
            motion: window.start.motion.since(self.held),
            ..window.start
        };
        Window { start, ..*window }
    }
}
