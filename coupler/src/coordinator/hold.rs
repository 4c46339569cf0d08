//! Windows in which the bed is held (see [`crate::hold`]): the solver of the particles is told once that they come to
//! rest.

use super::CoupledRun;
use super::error::RunError;
use crate::motion::ParticleChanges;
use crate::supervisor::Supervisor;
use crate::time::Window;

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
}
