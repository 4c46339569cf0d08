//! A window of the gas, stage by stage.

use calcine_coupler::part::{CellReceived, Convergence};
use calcine_coupler::setup::TimeScheme;
use calcine_coupler::time::Window;

use super::attempt::AttemptFrame;
use super::failure::GasFailure;
use super::outer::{Begin, Equations};
use super::stages::{self, Stage, StageStates};
use super::{NativeGas, balance};
use crate::numerics::parallel::fill;

impl NativeGas {
    /// The scheme of a window: that of the case where its clocks are one and nothing reacts. Reactions of the gas are split from its
    /// transport, and what particles give and take is told by the fractions at the window's end; both are first order anyhow.
    fn scheme(&self, window: &Window) -> TimeScheme {
        let one_clock = window.span.motion == window.span.process;
        let reacts = self.setup.chemistry.reacting().is_some() || !self.exchange.species.is_none();
        match one_clock && !reacts {
            true => self.setup.controls.time_scheme,
            false => TimeScheme::ImplicitEuler,
        }
    }

    /// Void fraction and share of the pressure gradient at the end of a stage; the bed moves evenly over the window.
    fn take_bed(&mut self, end: f64) {
        let (start, bed) = (&self.committed.void_fraction, &self.void_fraction);
        let pores = &mut self.steps.void_fraction;
        pores.resize(bed.len(), 0.0);
        fill(pores, |cell| match end {
            1.0 => bed[cell],
            _ => start[cell] + end * (bed[cell] - start[cell]),
        });
        let share = |&pores: &f64| self.setup.momentum.pressure_share(pores);
        self.pressure_share.clear();
        self.pressure_share.extend(pores.iter().map(share));
        self.now.void_fraction.clone_from(pores);
    }

    /// Advances `now` over a window from what is committed; an attempt that `continues` the one before takes what that one found as
    /// its first guess.
    pub(super) fn advance(
        &mut self,
        window: &Window,
        continues: bool,
        received: &mut CellReceived,
    ) -> Result<Convergence, GasFailure> {
        let (start, span) = (
            window.start.process.seconds(),
            window.span.process.seconds(),
        );
        if !self.started {
            self.boundaries.update(&self.setup, start + span);
            self.place();
        }
        let stages = stages::stages(self.scheme(window));
        let several = stages.len() > 1;
        if !continues {
            self.now.take(&self.committed);
        } else if several {
            self.now.take(&self.steps.first);
        }
        let mut convergence: Option<Convergence> = None;
        for (number, stage) in stages.iter().enumerate() {
            self.boundaries
                .update(&self.setup, start + stage.end * span);
            let begin = match (number, continues, several) {
                (0, false, _) => Begin::Window,
                (0, true, false) => Begin::Again,
                _ => Begin::Stage,
            };
            if number > 0 {
                let StageStates { first, between, .. } = &mut self.steps;
                first.take(&self.now);
                stages::extrapolate(&self.committed, first, stage.beyond, between);
            }
            self.take_bed(stage.end);
            let found = self.step(window, stage, begin)?;
            let part = &mut self.steps.received;
            if several {
                stages::add(received, part, stage, number == 0);
            } else {
                std::mem::swap(received, part);
            }
            convergence = Some(match convergence {
                None => found,
                Some(before) => both(&before, &found),
            });
        }
        Ok(convergence.unwrap_or_default())
    }

    fn step(
        &mut self,
        window: &Window,
        stage: &Stage,
        begin: Begin,
    ) -> Result<Convergence, GasFailure> {
        let StageStates {
            between,
            received,
            void_fraction,
            ..
        } = &mut self.steps;
        let frame = AttemptFrame {
            grid: &self.grid,
            boundary: &self.boundaries,
            properties: &self.setup.properties,
            schmidt: self.setup.schmidt,
            chemistry: &self.setup.chemistry,
            turbulence: &self.setup.turbulence,
            convection: self.setup.controls.convection,
            tolerance: self.setup.controls.outer_tolerance,
            gravity: self.setup.gravity,
            mean_gradient: self.setup.pressure_gradient,
            void_fraction,
            pressure_share: &self.pressure_share,
            exchange: &self.exchange,
            old: match stage.beyond {
                0.0 => &self.committed,
                _ => between,
            },
            motion_span: stage.span * window.span.motion.seconds(),
            storage_span: stage.span * self.setup.storage.span(window),
            is_stage: stage.span < 1.0,
        };
        let convergence =
            self.equations
                .solve(&frame, &self.setup.controls, begin, &mut self.now)?;
        let Equations {
            momentum,
            enthalpy,
            species,
            material,
            ..
        } = &self.equations;
        let taken = &enthalpy.taken;
        balance::receive(
            &frame, material, momentum, taken, species, &self.now, received,
        );
        Ok(convergence)
    }
}

/// How two stages went.
fn both(one: &Convergence, other: &Convergence) -> Convergence {
    Convergence {
        outer_iterations: one.outer_iterations + other.outer_iterations,
        linear_iterations: one.linear_iterations + other.linear_iterations,
        residual: one.residual.max(other.residual),
        volume_residual: one.volume_residual.max(other.volume_residual),
        converged: one.converged && other.converged,
    }
}
