//! One window of the host: what is pushed acts over its steps, and what came of it goes back.

use std::time::Duration;

use calcine_wire::{Header, MessageKind, WireError};

use super::{Host, TICKS, UNCOUNTED, on_link};
use crate::drag::{self, PushedDrag};
use crate::error::HostError;
use crate::library::StepHook;
use crate::pushed_force::PUSH;

impl Host {
    /// Advances one window and answers with state and impulses.
    pub(super) fn window(&mut self, header: Header) -> Result<(), HostError> {
        let (force, drag) = self.pushed()?;
        let steps = self.steps(&header)?;
        if self.told.elapsed() > Duration::from_secs(1) {
            self.tell(&format!("window {}: {steps} steps", header.window));
        }
        self.push(&force, &header, steps)?;
        let follows = self.follow(&drag, &header, steps)?;
        let [x, y, z] = self.run(steps)?;
        drop(follows);
        self.look()?;
        let mut impulse = self.impulse(&force, &header, steps)?;
        let dragged = self.drag_impulse(&drag, &header)?;
        for (impulse, drag) in impulse.iter_mut().zip(&dragged) {
            *impulse += drag;
        }
        let acted = steps as f64 * self.step()?;
        let support = [acted, x, y, z];
        let header = header.answer(MessageKind::Finished);
        self.reply(header, [&impulse, &dragged], support)
    }

    /// What is pushed to this rank's particles, in the order of the state: forces, and drag where it may come beside them.
    fn pushed(&self) -> Result<(Vec<[f64; 3]>, PushedDrag), HostError> {
        let mut drag = PushedDrag::default();
        let force = on_link(|link| {
            let ids = link.column_words("id")?;
            let find = |&id: &u64| ids.binary_search(&id).map_err(|_| HostError::Push { id });
            let rows = self.state.id.iter().map(find);
            let rows = match rows.collect::<Result<Vec<usize>, _>>() {
                Ok(rows) => rows,
                Err(error) => return Ok(Err(error)),
            };
            let vectors = |name: &str| {
                let all = link.column(name)?;
                let rows = rows.iter().map(|row| 3 * row);
                let own = rows.map(|row| [all[row], all[row + 1], all[row + 2]]);
                Ok::<Vec<[f64; 3]>, WireError>(own.collect())
            };
            if self.moving_drag {
                let all = link.column("drag_coefficient")?;
                drag.coefficient = rows.iter().map(|&row| all[row]).collect();
                drag.gas = vectors("gas_velocity")?;
                drag.inverse_mass = self.state.inverse_masses(&self.held);
            }
            vectors("force").map(Ok)
        })??;
        Ok((force, drag))
    }

    /// Has drag by coefficient and gas velocity act over the window, such that its coefficients act over its span.
    fn follow(
        &mut self,
        drag: &PushedDrag,
        header: &Header,
        steps: i64,
    ) -> Result<Option<StepHook>, HostError> {
        if !self.moving_drag || self.frozen {
            return Ok(None);
        }
        let step = self.step()?;
        let scale = header.span_motion as f64 / TICKS / (steps as f64 * step);
        let place = &self.state.place;
        drag::begin(&mut self.liggghts, place, drag, scale, (steps, step)).map(Some)
    }

    /// Impulse in N s of drag on each particle that is here now; empty where none may be pushed.
    fn drag_impulse(&mut self, drag: &PushedDrag, header: &Header) -> Result<Vec<f64>, HostError> {
        if !self.moving_drag {
            return Ok(Vec::new());
        }
        if !self.frozen {
            return drag::impulses(&mut self.liggghts, &self.state.place);
        }
        // Nothing moves, nor changes its rank.
        let span = header.span_motion as f64 / TICKS;
        let pairs = drag.coefficient.iter().zip(&drag.gas);
        let each = pairs.flat_map(|(drag, gas)| gas.map(|gas| drag * gas * span));
        Ok(each.collect())
    }

    /// Runs so many steps; the impulse in N s that walls gave this rank's particles, step by step where it
    /// is counted: the forces at the ends of a step act for half of it each.
    fn run(&mut self, steps: i64) -> Result<[f64; 3], HostError> {
        // Nothing moves a bed that is held, and it has no contacts: its windows may be days.
        if self.frozen {
            return Ok(UNCOUNTED);
        }
        if self.walls.is_empty() {
            if steps > 0 {
                self.liggghts
                    .command(&format!("run {steps} pre no post no"));
            }
            return Ok(UNCOUNTED);
        }
        let half = 0.5 * self.step()?;
        let mut impulse = [0.0; 3];
        let mut add = |force: [f64; 3]| {
            for (sum, force) in impulse.iter_mut().zip(force) {
                *sum += half * force;
            }
        };
        for _ in 0..steps {
            add(self.wall_force());
            self.liggghts.command("run 1 pre no post no");
            add(self.wall_force());
        }
        Ok(impulse)
    }

    /// Force in N of all walls on this rank's particles at the last step.
    fn wall_force(&mut self) -> [f64; 3] {
        let mut sum = [0.0; 3];
        for wall in &self.walls {
            let forces = self.liggghts.fix_vectors_mut(wall).unwrap_or_default();
            for force in forces.chunks_exact(3) {
                for (sum, force) in sum.iter_mut().zip(force) {
                    *sum += force;
                }
            }
        }
        sum
    }

    /// LIGGGHTS' time step in s.
    fn step(&self) -> Result<f64, HostError> {
        self.liggghts
            .step()
            .ok_or(HostError::Missing { name: "dt" })
    }

    /// Impulse in N s that the pushed forces gave each particle that is here now, in the order of the state: of
    /// free ones what their steps add up to (the pushed forces go with them from rank to rank), of held ones
    /// what their support takes up.
    fn impulse(
        &mut self,
        force: &[[f64; 3]],
        header: &Header,
        steps: i64,
    ) -> Result<Vec<f64>, HostError> {
        let step = self.step()?;
        let Some(pushed) = self.liggghts.fix_vectors_mut(PUSH) else {
            let span = header.span_motion as f64 / TICKS;
            return Ok(force.iter().flatten().map(|force| force * span).collect());
        };
        let acted = steps as f64 * step;
        let rows = self.state.place.iter();
        let here = rows.flat_map(|&place| &pushed[3 * place..3 * place + 3]);
        Ok(here.map(|force| force * acted).collect())
    }

    /// Has the forces act from the first half step on, and over the window's steps so much that their
    /// impulse is that over its span.
    fn push(&mut self, force: &[[f64; 3]], header: &Header, steps: i64) -> Result<(), HostError> {
        let step = self.step()?;
        let Some(pushed) = self.liggghts.fix_vectors_mut(PUSH) else {
            return Ok(()); // a bed that is held
        };
        let span = header.span_motion as f64 / TICKS;
        if steps == 0 {
            return Err(HostError::NoStep { span, step });
        }
        let scale = span / (steps as f64 * step);
        let mut change = vec![0.0; pushed.len()];
        for (&place, force) in self.state.place.iter().zip(force) {
            for (axis, value) in force.iter().enumerate() {
                let index = 3 * place + axis;
                change[index] = scale * value - pushed[index];
                pushed[index] = scale * value;
            }
        }
        // The first half kick of a run uses the forces of the last one's end.
        let forces = self.liggghts.vectors_mut("f");
        let forces = forces.ok_or(HostError::Missing { name: "f" })?;
        for (force, change) in forces.iter_mut().zip(change) {
            *force += change;
        }
        Ok(())
    }

    /// Steps of a window: those between the steps nearest to its start and to its end, so that
    /// rounding never adds up.
    fn steps(&self, header: &Header) -> Result<i64, HostError> {
        let step = self.step()? * TICKS;
        let nearest = |ticks: i64| (ticks as f64 / step).round() as i64;
        let end = header.start_motion.saturating_add(header.span_motion);
        Ok(nearest(end) - nearest(header.start_motion))
    }
}
