//! What of mesh and flow may be behind a gas that diverged.

use super::CoupledRun;
use super::error::RunError;
use crate::error::FailureKind;
use crate::mesh::quality::InCell;
use crate::part::Gas as _;
use crate::setup::Convection;
use crate::time::Window;

/// Courant number up to which both gases were tried on cells that lean by up to 65 degrees (docs/verification.md).
const TRIED_COURANT: f64 = 5.0;
/// Angle in degrees from which a mesh is told of.
const LEANS: f64 = 30.0;

impl CoupledRun {
    /// The error, with the largest Courant number of the gas as the window began and the cells of the mesh that lean most, where
    /// a gas diverged.
    pub(super) fn told_with_circumstances(&self, error: RunError, window: &Window) -> RunError {
        match error {
            RunError::Part(part)
                if matches!(
                    part.kind,
                    FailureKind::Diverged | FailureKind::NotFinite | FailureKind::NotConverged
                ) =>
            {
                let lines = [
                    self.courant(window),
                    self.leaning(),
                    self.unbounded(),
                    self.reacting(),
                ];
                RunError::Part(part.under(lines.into_iter().flatten().collect()))
            }
            RunError::Closure { .. }
            | RunError::ClosureInGas { .. }
            | RunError::NotFinite(_)
            | RunError::Unphysical { .. } => match self.reacting() {
                Some(reacting) => RunError::Reacting {
                    cause: Box::new(error),
                    reacting,
                },
                None => error,
            },
            other => other,
        }
    }

    /// The particle and the reaction whose rate moved most between the last attempts, where some react.
    fn reacting(&self) -> Option<String> {
        let channels = self.interior.models.channels();
        let (at, [before, now]) = self.exchange.species.most_moved()?;
        let particles = self.parts.particles.fields();
        let id = particles.id.get(at / channels.len().max(1))?;
        let reaction = &channels.get(at % channels.len().max(1))?.name;
        Some(format!(
            "what reacts and its gas did not agree: the rate of `{reaction}` of particle {id} moved most between the last two \
             attempts, from {before:.3e} to {now:.3e} mol/s; check its rate constant and its equilibrium, and with slower \
             reactions or shorter windows (`time.process_step`, `time.motion_window`) that the particles need none so fast"
        ))
    }

    fn courant(&self, window: &Window) -> Option<String> {
        let span = window.span.motion.seconds();
        let largest = self
            .mesh
            .courant(self.parts.gas.fields().velocity, span)
            .filter(|largest| largest.value > 0.0)?;
        let found = format!(
            "the gas the window began with has its largest Courant number, {:.3}, {}",
            largest.value,
            place(&largest)
        );
        Some(match largest.value > TRIED_COURANT {
            true => format!(
                "{found}; windows of {:.3e} s of motion time would have {TRIED_COURANT}",
                span * TRIED_COURANT / largest.value
            ),
            false => found,
        })
    }

    /// That no limiter bounds what the gas carries, where it is so.
    fn unbounded(&self) -> Option<String> {
        matches!(self.plan.convection, Convection::Central(share) if share > 0.0).then(|| {
            String::from(
                "`gas.controls.convection` is central: nothing bounds what it carries, nor damps waves from cell to cell; \
                 \"van-leer\" and \"upwind\" do",
            )
        })
    }

    fn leaning(&self) -> Option<String> {
        let quality = self.mesh.quality()?;
        (quality.angle.value > LEANS).then(|| {
            format!(
                "the mesh leans most, by {:.1} degrees, {}; its largest skewness is {:.2}, {}; on such cells \
                 shorter windows help, or more `gas.controls.outer_iterations` or `pressure_corrections`",
                quality.angle.value,
                place(&quality.angle),
                quality.skewness.value,
                place(&quality.skewness)
            )
        })
    }
}

fn place(one: &InCell) -> String {
    let at = one.centre;
    format!(
        "in cell {} at ({:.6}, {:.6}, {:.6}) m",
        one.cell, at.x, at.y, at.z
    )
}
