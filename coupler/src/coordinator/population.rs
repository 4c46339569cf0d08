//! Stage: particles that come and go between two windows, in every part alike: by feeds and outlets, and because they
//! are used up.

use calcine_interior::{Inventory, Newcomer, TEMPERATURE, without};
use calcine_physics::Vec3;

use super::CoupledRun;
use super::balances::place;
use super::error::RunError;
use super::particles::momentum;
use crate::feeds::WindowSpan;
use crate::findings::{Finding, FindingKind, FindingPlace};
use crate::ledger::{CarriedInventory, Ledger};
use crate::models::{ParticleModels, PopulationNewcomer};
use crate::motion::{LostParticles, ParticleChanges};
use crate::outflows::Leaving;
use crate::part::ParticleFields;
use crate::supervisor::Supervisor;
use crate::time::Window;

/// Particles that go and come.
struct PopulationStep {
    change: ParticleChanges,
    /// Rows of those that go, ascending.
    rows: Vec<usize>,
    /// Temperatures in K of those that come.
    temperature: Vec<f64>,
}

/// What went and came, as the particles' solver has it, and inside of them.
struct Moved {
    gone: CarriedInventory,
    come: CarriedInventory,
    elements: [Inventory; 2],
}

impl CoupledRun {
    /// Lets feeds and outlets act before a window, and books what they moved. They stand while the bed is held.
    pub(super) fn feed_and_discharge(
        &mut self,
        supervisor: &Supervisor,
        window: &Window,
    ) -> Result<(), RunError> {
        if self.plan.feeds_and_outlets.is_none() || self.holds(window) {
            return Ok(());
        }
        let moment = WindowSpan {
            window: window.index,
            start: self.clocks.process.seconds(),
            span: window.span.process.seconds(),
            acceleration: window.acceleration(),
        };
        let fields = self.parts.particles.fields();
        let due = self.plan.feeds_and_outlets.decide(moment, &fields)?;
        if due.change.is_empty() {
            return Ok(());
        }
        let went: Vec<_> = due.rows.iter().copied().zip(due.outlets).collect();
        self.note_outflow(&went);
        if let Some(new) = due.change.insert.first() {
            let outflows = &mut self.plan.feeds_and_outlets.outflows;
            outflows.came(new.id, self.clocks.process.seconds());
        }
        let moved = self.exchange_particles(
            supervisor,
            PopulationStep {
                change: due.change,
                rows: due.rows,
                temperature: due.temperature,
            },
        )?;
        let [came, went] = &mut self.ledger.fed_and_discharged;
        came.add_all(&moved.come);
        went.add_all(&moved.gone);
        Ok(())
    }

    /// Notes rows that leave, each through an outlet.
    fn note_outflow(&mut self, went: &[(usize, usize)]) {
        if went.is_empty() {
            return;
        }
        let fields = self.parts.particles.fields();
        let outflows = &mut self.plan.feeds_and_outlets.outflows;
        outflows.forget_below(fields.id.first().copied().unwrap_or(0));
        for &(row, outlet) in went {
            let particle = Leaving {
                id: fields.id[row],
                population: fields.population[row],
                weight: fields.weight_of(row),
                mass: fields.row_mass(row),
            };
            outflows.went(outlet, particle, self.clocks.process.seconds());
        }
    }

    /// Ids of particles that left the mesh within a window, on a way through an outlet that takes all, each with the outlet.
    pub(super) fn gone_through_outlets(&self, window: &Window) -> Vec<(u64, usize)> {
        let feeds = &self.plan.feeds_and_outlets;
        if !feeds.lets_out() || self.holds(window) {
            return Vec::new();
        }
        let fields = self.parts.particles.fields();
        let before = &self.bed.mapped.position;
        let rows = self.bed.outside(fields.position).into_iter();
        let through = |row| feeds.outlet_between([before[row], fields.position[row]]);
        rows.filter_map(|row| Some((fields.id[row], through(row)?)))
            .collect()
    }

    /// Takes particles out that left through outlets, and books them as discharged.
    pub(super) fn discharge(
        &mut self,
        supervisor: &Supervisor,
        ids: &[(u64, usize)],
    ) -> Result<(), RunError> {
        if ids.is_empty() {
            return Ok(());
        }
        let own = self.parts.particles.fields().id.iter().enumerate();
        let went = own.filter_map(|(row, id)| {
            let found = ids.iter().find(|(gone, _)| gone == id);
            Some((row, found?.1))
        });
        let went: Vec<_> = went.collect();
        self.note_outflow(&went);
        let rows = went.into_iter().map(|(row, _)| row).collect();
        let moved = self.take_out(supervisor, rows)?;
        let [_, went] = &mut self.ledger.fed_and_discharged;
        went.add_all(&moved.gone);
        Ok(())
    }

    /// Takes particles out that their models have used up, and books what is left of them.
    pub(super) fn take_out_used_up(
        &mut self,
        supervisor: &Supervisor,
        rows: Vec<usize>,
    ) -> Result<(), RunError> {
        if rows.is_empty() {
            return Ok(());
        }
        let fields = self.parts.particles.fields();
        let held = |&row: &usize| fields.weight_of(row) * self.interior.mass[row];
        let left: f64 = rows.iter().map(held).sum();
        let mut moved = self.take_out(supervisor, rows)?;
        // The solver of the motion has the masses from before the window.
        moved.gone.mass = left;
        self.ledger.used_up.add_all(&moved.gone);
        Ok(())
    }

    /// Takes particles out that left the mesh, where the case wants that, books them and tells of them.
    pub(super) fn take_out_lost(&mut self, supervisor: &Supervisor) -> Result<(), RunError> {
        let ends = self.plan.lost != LostParticles::TakeOut;
        // Without outlets the particles' solver ends the run, or else the next mapping.
        if ends && !self.plan.feeds_and_outlets.lets_out() {
            return Ok(());
        }
        let fields = self.parts.particles.fields();
        let rows = self.bed.outside(fields.position);
        if let Some(&row) = rows.first().filter(|_| ends) {
            return Err(self.lost(row));
        }
        let speed = |row: usize| fields.velocity[row].norm();
        let Some(fastest) = rows
            .iter()
            .copied()
            .max_by(|&a, &b| speed(a).total_cmp(&speed(b)))
        else {
            return Ok(());
        };
        self.findings.push(Finding {
            kind: FindingKind::LostParticles,
            count: rows.len() as u64,
            value: speed(fastest),
            limit: None,
            place: FindingPlace::Left {
                id: fields.id[fastest],
                at: fields.position[fastest],
            },
        });
        self.findings.sort_by_key(|finding| finding.kind);
        let moved = self.take_out(supervisor, rows)?;
        self.ledger.lost.add_all(&moved.gone);
        Ok(())
    }

    /// Takes particles out of every part; what they carried.
    fn take_out(&mut self, supervisor: &Supervisor, rows: Vec<usize>) -> Result<Moved, RunError> {
        let ids = self.parts.particles.fields().id;
        let change = ParticleChanges {
            remove: rows.iter().map(|&row| ids[row]).collect(),
            ..ParticleChanges::default()
        };
        let step = PopulationStep {
            change,
            rows,
            temperature: Vec::new(),
        };
        self.exchange_particles(supervisor, step)
    }

    /// The error of a particle that stands in no cell.
    pub(super) fn lost(&self, row: usize) -> RunError {
        let fields = self.parts.particles.fields();
        let population = fields.population[row] as usize;
        RunError::Lost {
            id: fields.id[row],
            population: self
                .plan
                .populations
                .get(population)
                .cloned()
                .unwrap_or_default(),
            place: fields.position[row],
            velocity: fields.velocity[row],
            window: self.windows,
            start: self.clocks.process,
        }
    }

    fn exchange_particles(
        &mut self,
        supervisor: &Supervisor,
        step: PopulationStep,
    ) -> Result<Moved, RunError> {
        let models = &self.interior.models;
        let fields = self.parts.particles.fields();
        let total = |fields: &ParticleFields<'_>| -> f64 {
            (0..fields.len()).map(|row| fields.row_mass(row)).sum()
        };
        let (before, momentum_before) = (total(&fields), momentum(&fields));
        let held_before = all_held(models);
        let held_gone = models.held(step.rows.iter().copied());
        let mut gone = CarriedInventory::default();
        for &row in &step.rows {
            let enthalpy = models.held([row]).energy.sum;
            gone.add(fields.row_mass(row), enthalpy, fields.velocity[row]);
        }
        self.parts.particles.change(supervisor, &step.change)?;

        // New ids are the highest: their rows are the last ones.
        let fields = self.parts.particles.fields();
        let first = fields.len() - step.change.insert.len();
        let states: Vec<[(&str, &[f64]); 1]> = step
            .temperature
            .chunks_exact(1)
            .map(|kelvin| [(TEMPERATURE, kelvin)])
            .collect();
        let newcomers: Vec<PopulationNewcomer<'_>> = (first..fields.len())
            .zip(&states)
            .map(|(row, state)| PopulationNewcomer {
                population: fields.population[row] as usize,
                weight: fields.weight_of(row),
                particle: Newcomer {
                    id: fields.id[row],
                    mass: fields.mass[row],
                    radius: fields.radius[row],
                    state,
                },
            })
            .collect();
        self.interior.check_weights(&fields)?;
        self.interior.change(&step.rows, &newcomers, &fields)?;
        let models = &self.interior.models;
        let held_come = models.held(first..fields.len());
        let mut come = CarriedInventory::default();
        for row in first..fields.len() {
            let enthalpy = models.held([row]).energy.sum;
            come.add(fields.row_mass(row), enthalpy, fields.velocity[row]);
        }
        let moved = Moved {
            gone,
            come,
            elements: [held_gone, held_come],
        };
        moved.book(
            &mut self.ledger,
            total(&fields) - before,
            momentum(&fields) - momentum_before,
            [held_before, all_held(models)],
        );
        let heat = &mut self.exchange.exchange.heat;
        without(heat, &step.rows);
        heat.resize(fields.len(), 0.0);
        self.laws.change(&step.rows, fields.len());
        self.motion.change(&step.rows, &fields, first);
        Ok(moved)
    }
}

/// What all particles hold.
fn all_held(models: &ParticleModels) -> Inventory {
    models.held(0..models.len())
}

impl Moved {
    /// Books the change of mass in kg and of momentum in N s that the solver shows, and of elements that the models
    /// show, against what went and came.
    fn book(&self, ledger: &mut Ledger, mass: f64, momentum: Vec3, held: [Inventory; 2]) {
        let (brought, taken) = (&self.come, &self.gone);
        ledger
            .particle_mass
            .book(mass - brought.mass + taken.mass, brought.mass + taken.mass);
        let left = momentum - brought.momentum + taken.momentum;
        ledger
            .particle_momentum
            .book(left.norm(), brought.momentum.norm() + taken.momentum.norm());
        let [before, after] = held;
        let [gone, come] = &self.elements;
        for (name, line) in &mut ledger.elements {
            if let Some(k) = place(name) {
                let of = |inventory: &Inventory| inventory.elements[k].sum;
                let left = of(&after) - of(&before) - of(come) + of(gone);
                line.book(left, of(come) + of(gone));
            }
        }
    }
}
