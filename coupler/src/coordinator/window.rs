//! One coupling window (design: "One window").

use std::f64::consts::PI;
use std::sync::Arc;
use std::time::{Duration, Instant};

use calcine_interior::{NetworkSurroundings, Reacting};
use calcine_physics::Vec3;
use calcine_physics::gas_model::GasModel;
use calcine_physics::thermo::Element;
use rustix::time::{ClockId, clock_gettime};

use super::span::next_span;
use super::{CoupledRun, Mapped, RunError};
use crate::exchange::{ExchangeConvergence, ExchangeInputs};
use crate::ledger::Ledger;
use crate::mapping::{Mapper, Method};
use crate::mesh::Mesh;
use crate::observer::Timing;
use crate::part::{Balance, Bed, CellReceived, Particles};
use crate::smoother::Smoother;
use crate::supervisor::Supervisor;
use crate::time::Window;

/// Adds the time that a stage takes to its account.
pub(super) fn timed<T>(account: &mut Duration, stage: impl FnOnce() -> T) -> T {
    let begun = Instant::now();
    let value = stage();
    *account += begun.elapsed();
    value
}

/// Processor time that all threads of this process have used.
fn processor() -> Duration {
    let time = clock_gettime(ClockId::ProcessCPUTime);
    Duration::new(time.tv_sec.unsigned_abs(), time.tv_nsec as u32)
}

/// Adds what a stage takes to its accounts of wall time and of processor time.
fn metered<T>(wall: &mut Duration, used: &mut Duration, stage: impl FnOnce() -> T) -> T {
    let before = processor();
    let value = timed(wall, stage);
    *used += processor().saturating_sub(before);
    value
}

/// Base mapping and smoother for the present positions.
pub(super) fn map(
    mapper: &Mapper<Arc<Mesh>>,
    method: Method,
    smoother: &Smoother,
    particles: &dyn Particles,
    timing: &mut Timing,
) -> Result<Mapped, RunError> {
    let fields = particles.fields();
    let solid_volume: Vec<f64> = fields
        .radius
        .iter()
        .map(|r| 4.0 / 3.0 * PI * r.powi(3))
        .collect();
    let weights = timed(&mut timing.mapping, || {
        mapper.fill(method, fields.position, fields.radius)
    })?;
    let operator = timed(&mut timing.smoother, || {
        smoother.operator(weights, &solid_volume)
    })?;
    let void_fraction = operator
        .solid_fraction()
        .iter()
        .map(|alpha| 1.0 - alpha)
        .collect();
    Ok(Mapped {
        operator,
        bed: Bed { void_fraction },
        position: fields.position.to_vec(),
        radius: fields.radius.to_vec(),
        solid_volume,
    })
}

impl CoupledRun {
    pub(super) fn next_window(&self) -> Result<Window, RunError> {
        let plan = &self.plan;
        let (_, change) = plan.holds.at(self.clocks.process);
        let span = next_span(
            &plan.acceleration,
            self.clocks,
            plan.motion_window,
            change.map_or(plan.end, |time| time.min(plan.end)),
        )?;
        Ok(Window {
            index: self.windows,
            attempt: 0,
            start: self.clocks,
            span,
        })
    }

    /// One window: bed, laws, attempts of gas and interior, particles last, commit, ledger.
    pub(super) fn advance(
        &mut self,
        supervisor: &Supervisor,
        window: &Window,
    ) -> Result<(), RunError> {
        self.map_if_moved()?;
        let mut attempt = *window;
        for _ in 0..self.evaluations() {
            self.evaluate_laws(window)?;
            self.exchange_with_gas(supervisor, &mut attempt)?;
        }
        self.move_particles(supervisor, window)?;
        self.commit(window)
    }

    /// How often the laws are evaluated in the coming window: once, on the gas of the window
    /// before. The first window of a run has none before it (its gas may be at rest, and does not
    /// know the bed yet), so it is repeated with the laws evaluated on what came out, by a gas that can.
    fn evaluations(&self) -> u32 {
        const IN_FIRST_WINDOW: u32 = 4;
        if self.windows == 0 && self.plan.repeats {
            IN_FIRST_WINDOW
        } else {
            1
        }
    }

    fn map_if_moved(&mut self) -> Result<(), RunError> {
        let fields = self.parts.particles.fields();
        if fields.position == self.mapped.position && fields.radius == self.mapped.radius {
            return Ok(());
        }
        self.mapped = map(
            &self.mapper,
            self.plan.mapping,
            &self.smoother,
            &*self.parts.particles,
            &mut self.timing,
        )?;
        self.find_contacts();
        Ok(())
    }

    /// Tells the interior what particles touch and see, where that matters.
    pub(super) fn find_contacts(&mut self) {
        if self.parts.interior.conducts() {
            let begun = Instant::now();
            let time = self.clocks.process.seconds();
            let interior = &mut self.parts.interior;
            let particles = self.parts.particles.fields();
            self.paths.find_neighbours(&particles, time, |neighbours| {
                interior.set_neighbours(neighbours)
            });
            self.timing.interior += begun.elapsed();
        }
    }

    fn evaluate_laws(&mut self, window: &Window) -> Result<(), RunError> {
        let begun = Instant::now();
        let (mapped, work) = (&self.mapped, &mut self.work);
        let particles = self.parts.particles.fields();
        let acceleration = window.acceleration();
        work.sampled_gas
            .sample(&mapped.operator, &self.parts.gas.fields(), &mapped.bed);
        self.closures
            .evaluate(
                &work.sampled_gas,
                &particles,
                acceleration,
                &mut work.coefficients,
            )
            .map_err(|cause| RunError::Closure {
                window: window.index,
                cause,
            })?;
        let span = window.span.process.seconds();
        self.relax_drag(window);
        self.evaluate_films(window);
        let (work, count) = (&mut self.work, self.parts.particles.fields().len());
        work.exchange.conductance.resize(count, 0.0);
        self.parts.interior.eliminated(
            &work.coefficients.conductance,
            span,
            &mut work.exchange.conductance,
        );
        self.timing.exchange += begun.elapsed();
        Ok(())
    }

    /// Repeats the window of gas and interior until the exchange is where it belongs, and what reacts is what the
    /// gas has for it; then once more with what particles give and take fixed, where they react.
    fn exchange_with_gas(
        &mut self,
        supervisor: &Supervisor,
        window: &mut Window,
    ) -> Result<(), RunError> {
        let first_attempt = window.attempt;
        let reacts = self.reacts();
        self.begin_exchange(window);
        loop {
            self.look_at_particles(window)?;
            let mut misplaced = self.attempt(supervisor, window)?;
            let off = misplaced.max(self.follow_rates());
            let mut attempts = window.attempt - first_attempt;
            let settled = off <= self.plan.exchange_tolerance;
            if !settled && attempts + u32::from(reacts) < self.plan.exchange_attempts {
                continue;
            }
            if reacts {
                self.fix_rates(window);
                misplaced = self.attempt(supervisor, window)?;
                attempts += 1;
            }
            if !settled {
                tracing::warn!(
                    window = window.index,
                    attempts,
                    misplaced = off,
                    "the attempts ended with a larger share of the exchange in the wrong cells \
                     of a particle, or of what reacts off its rate, than coupling.exchange.tolerance allows"
                );
            }
            self.book_rates(window);
            self.credit_drag(window);
            let (work, timing) = (&self.work, &mut self.timing);
            timed(&mut timing.interior, || {
                let span = window.span.process.seconds();
                self.parts.interior.advance(&work.exchange.heat, span);
            });
            self.exchange_convergence = ExchangeConvergence {
                attempts: window.attempt,
                misplaced: if settled { misplaced.min(off) } else { off },
                settled,
            };
            return Ok(());
        }
    }

    /// Spreads what does not change between attempts.
    fn begin_exchange(&mut self, window: &Window) {
        let (mapped, work, timing) = (&self.mapped, &mut self.work, &mut self.timing);
        let inputs = ExchangeInputs {
            operator: &mapped.operator,
            particles: self.parts.particles.fields(),
            coefficients: &work.coefficients,
            acceleration: window.acceleration(),
        };
        timed(&mut timing.exchange, || {
            work.exchange.begin(&inputs, &self.parts.gas.fields());
        });
    }

    /// What the interior does over the window with the gas as it is: conduction, and reactions with the heat that
    /// is conducted. Conduction takes the heat of reactions from the attempt before; a first attempt has none,
    /// and looks twice: heat that is set free would leave a window late.
    fn look_at_particles(&mut self, window: &Window) -> Result<(), RunError> {
        let twice = window.attempt == 0 && self.reacts() && self.parts.interior.conducts();
        for _ in 0..=u8::from(twice) {
            self.conduct(window);
            self.react(window)?;
        }
        self.tell_rates(window);
        Ok(())
    }

    /// Fixes the heat between particles and to walls.
    fn conduct(&mut self, window: &Window) {
        let span = window.span.process.seconds();
        let end = window.start.process.seconds() + span;
        if self.parts.interior.conducts() {
            let (work, timing) = (&self.work, &mut self.timing);
            timed(&mut timing.interior, || {
                let surroundings = NetworkSurroundings {
                    conductance: &work.coefficients.conductance,
                    temperature: work.exchange.sampled_temperature(),
                    gas_conductivity: &work.coefficients.gas_conductivity,
                    reservoirs: self.paths.reservoirs(end),
                };
                self.parts.interior.conduct(&surroundings, span);
            });
        }
    }

    /// One attempt of the gas; the share of the exchange that it left misplaced.
    fn attempt(&mut self, supervisor: &Supervisor, window: &mut Window) -> Result<f64, RunError> {
        let (mapped, work, timing) = (&self.mapped, &mut self.work, &mut self.timing);
        let inputs = ExchangeInputs {
            operator: &mapped.operator,
            particles: self.parts.particles.fields(),
            coefficients: &work.coefficients,
            acceleration: window.acceleration(),
        };
        let start = self.parts.interior.start_temperature();
        timed(&mut timing.exchange, || {
            work.exchange.linearise(&inputs, start);
        });
        let accounts = (&mut timing.gas, &mut timing.gas_processor);
        self.convergence = metered(accounts.0, accounts.1, || {
            self.parts
                .gas
                .start(window, &mapped.bed, &work.exchange.cells)?;
            self.parts.gas.finish(supervisor, &mut work.received)
        })?;
        window.attempt += 1;
        let misplaced = timed(&mut timing.exchange, || {
            let (gas, properties) = (self.parts.gas.fields(), &self.closures.gas);
            let (species_coupling, told) =
                (&mut work.species_coupling, &work.exchange.cells.species);
            species_coupling.heat_of_cells(&gas, properties, told);
            let apart = &species_coupling.cell_heat;
            work.exchange
                .credit_heat(&inputs, start, &gas, &work.received, apart)
        });
        Ok(misplaced)
    }

    /// Gives the particles their drag after the last attempt.
    fn credit_drag(&mut self, window: &Window) {
        let (mapped, work, timing) = (&self.mapped, &mut self.work, &mut self.timing);
        let inputs = ExchangeInputs {
            operator: &mapped.operator,
            particles: self.parts.particles.fields(),
            coefficients: &work.coefficients,
            acceleration: window.acceleration(),
        };
        timed(&mut timing.exchange, || {
            let gas = self.parts.gas.fields();
            work.exchange.credit_drag(&inputs, &gas, &work.received);
        });
    }

    fn move_particles(&mut self, supervisor: &Supervisor, window: &Window) -> Result<(), RunError> {
        let begun = Instant::now();
        self.note_velocities();
        let work = &mut self.work;
        work.exchange.push(
            &self.mapped.operator,
            &self.parts.gas.fields(),
            &self.mapped.solid_volume,
            (self.closures.momentum, self.plan.gravity),
            &mut work.pressure_force,
            &mut work.push,
        );
        self.timing.exchange += begun.elapsed();
        if self.holds(window) {
            self.hold(window);
            return Ok(());
        }
        let own = self.own_window(window);
        let (particles, timing) = (&mut self.parts.particles, &mut self.timing);
        let work = &mut self.work;
        let accounts = (&mut timing.particles, &mut timing.particles_processor);
        metered(accounts.0, accounts.1, || {
            particles.start(&own, &work.push)?;
            particles.finish(supervisor, &mut work.particle_received)
        })?;
        Ok(())
    }

    fn commit(&mut self, window: &Window) -> Result<(), RunError> {
        self.close_ledger(window);
        self.parts.gas.commit()?;
        self.parts.particles.commit()?;
        self.note_forces(window);
        self.work.reservoir_heat.clear();
        let heat = self.parts.interior.reservoir_heat();
        self.work.reservoir_heat.extend_from_slice(heat);
        self.parts.interior.commit();
        self.weigh();
        if self.holds(window) {
            self.held = self.held.checked_add(window.span.motion)?;
        }
        self.clocks = window.end()?;
        self.windows += 1;
        Ok(())
    }

    /// Books the window (requirements CON-2). Gas amounts count in process time.
    fn close_ledger(&mut self, window: &Window) {
        let (process, motion) = (window.span.process.seconds(), window.span.motion.seconds());
        let scale = process / self.plan.storage.span(window);
        let (work, ledger) = (&self.work, &mut self.ledger);
        let received = &work.received;

        let (sum, magnitude) = open(&received.mass);
        ledger.mass.book(scale * sum, scale * magnitude);
        let reacting = self.parts.interior.reactions();
        book_elements(ledger, &self.closures.gas, received, reacting, scale);
        book_energy(
            ledger,
            received,
            [&work.exchange.heat, &work.species_coupling.carried],
            &*self.parts.interior,
            scale,
            process,
        );

        let drag_on_gas: Vec3 = received.drag.iter().sum::<Vec3>() * motion;
        let impulses = &work.particle_received.impulse;
        let drag_on_particles: Vec3 = impulses
            .iter()
            .zip(&work.pressure_force)
            .map(|(impulse, pressure)| impulse - pressure * motion)
            .sum();
        let moved: f64 = received
            .drag
            .iter()
            .map(|force| force.norm() * motion)
            .sum();
        ledger
            .momentum_exchange
            .book((drag_on_gas + drag_on_particles).norm(), 2.0 * moved);
        for (balance, clock) in received.momentum.iter().zip(&received.storage_clock) {
            let (sum, magnitude) = open(balance);
            ledger.gas_momentum.book(sum, magnitude);
            ledger.storage_clock.book(*clock, magnitude);
        }
    }
}

/// What a balance leaves open, and the sum of the magnitudes of its terms.
fn open(balance: &Balance) -> (f64, f64) {
    (
        balance.stored - balance.boundary - balance.exchange - balance.source,
        balance.stored_magnitude
            + balance.boundary_magnitude
            + balance.exchange.abs()
            + balance.source_magnitude,
    )
}

/// The mass of each element in gas and particles together, and that of the particles: what they exchange drops
/// out of the one and stands in the other.
fn book_elements(
    ledger: &mut Ledger,
    gas: &GasModel,
    received: &CellReceived,
    reacting: Option<&Reacting>,
    scale: f64,
) {
    let shares = gas.elements();
    let changes = reacting.map(Reacting::mass_changes);
    for (name, line) in &mut ledger.elements {
        let (mut sum, mut magnitude) = (0.0, 0.0);
        let own = shares.iter().find(|(element, _)| element == name);
        for (share, balance) in own
            .iter()
            .flat_map(|own| own.1.iter().zip(&received.species))
        {
            // Reactions of the gas make no element, so that what they make of the species is left in.
            let (open, terms) = open(balance);
            let other = balance.exchange.abs() + balance.source_magnitude;
            sum += scale * share * (open + balance.exchange + balance.source);
            magnitude += scale * share * (terms - other);
        }
        if let Some((_, elements)) = &changes {
            let place = Element::ALL.iter().position(|one| one.symbol() == name);
            let [change, moved] = place.map_or([0.0; 2], |k| elements[k]);
            sum += change;
            magnitude += moved;
        }
        line.book(sum, magnitude);
    }
    if let Some((change, _)) = changes {
        let given = scale * received.mass.exchange;
        let magnitude = received.species.iter().map(|one| one.exchange.abs());
        let magnitude = scale * magnitude.sum::<f64>();
        ledger.particle_mass.book(change + given, magnitude);
    }
}

/// Gas and particles together: the exchange drops out of the sum and is booked by itself.
fn book_energy(
    ledger: &mut Ledger,
    received: &CellReceived,
    [heat, carried]: [&[f64]; 2],
    interior: &dyn calcine_interior::ParticleModel,
    scale: f64,
    process: f64,
) {
    let gas = &received.energy;
    let (stored, stored_magnitude) = interior.stored_change();
    let reservoirs = interior.reservoir_heat();
    let walls: f64 = reservoirs.iter().sum::<f64>() * process;
    let walls_magnitude: f64 = reservoirs.iter().map(|q| q.abs()).sum::<f64>() * process;
    let to_gas: f64 = received.heat.iter().sum::<f64>() * process;
    let to_particles = (heat.iter().sum::<f64>() + carried.iter().sum::<f64>()) * process;
    let exchanged = process
        * (received.heat.iter().map(|q| q.abs()).sum::<f64>()
            + heat.iter().map(|q| q.abs()).sum::<f64>());
    ledger.energy.book(
        scale * (gas.stored - gas.boundary - gas.source) + stored - walls,
        scale * (gas.stored_magnitude + gas.boundary_magnitude + gas.source_magnitude)
            + stored_magnitude
            + walls_magnitude
            + exchanged,
    );
    ledger
        .energy_exchange
        .book(to_gas + to_particles, exchanged);
}
