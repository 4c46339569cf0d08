//! The loop: windows, attempts, commits, checkpoints. A window is a sequence of stages, one file each, of which every one
//! is told what it takes and owns what it makes.

mod balances;
mod bed;
mod checkpoint;
mod checkpoint_paths;
mod checkpoint_sums;
mod circumstances;
mod control;
mod controls;
mod cut;
mod error;
mod exchange;
mod findings;
mod finite;
mod gas_iterate;
mod hold;
mod interior;
mod laws;
mod length;
mod length_stage;
mod meter;
mod neighbours;
mod network_slope;
mod origin;
mod particles;
mod plan;
mod population;
mod repeat;
mod resize;
mod span;
mod step_limit;
mod unsolved;

use std::path::PathBuf;
use std::sync::Arc;
use std::time::{Duration, Instant};

use calcine_interior::HeatNetwork;

pub use checkpoint_paths::{CheckpointPaths, WholeCheckpoint};
pub use checkpoint_sums::sum as sum_of_file;
pub use control::Control;
pub use error::{CheckpointError, ControlError, OriginError, RunError, TooLight};
pub use origin::Origin;
pub use plan::Plan;
pub use step_limit::{ContactStepLimit, LONGEST_STEP};

use balances::WindowBalances;
use bed::BedStage;
use exchange::{ExchangeLimits, ExchangeStage, Participants};
use interior::InteriorStage;
use laws::{LawInputs, LawStage};
use length_stage::LengthStage;
use meter::{Meter, Stage};
use particles::{MotionInputs, MotionStage};
use repeat::{RepeatableGas, WindowCut};
use unsolved::UnsolvedWindows;

use crate::bodies::HeatBodies;
use crate::closures::Closures;
use crate::error::{FailureKind, PartError};
use crate::exchange::ExchangeConvergence;
use crate::findings::Finding;
use crate::ledger::{BalanceLine, Ledger};
use crate::mapping::MappingError;
use crate::mesh::Mesh;
use crate::models::ParticleModels;
use crate::observer::{CommittedState, Observer, ParticleGasExchange, Timing};
use crate::part::{Gas, Part as _, Particles};
use crate::paths::Paths;
use crate::smoother::Smoother;
use crate::supervisor::Supervisor;
use crate::time::{Clocks, Ticks, Window};

/// How a run ended without an error.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Ending {
    /// At the end of process time.
    Finished,
    /// On the user's interrupt, with a checkpoint in this folder.
    Checkpointed(PathBuf),
}

/// The parts that a run is made of.
pub struct RunParts {
    /// The gas.
    pub gas: Box<dyn Gas>,
    /// The particles.
    pub particles: Box<dyn Particles>,
    /// What is inside the particles: models that hold all of them.
    pub models: ParticleModels,
    /// Heat between particles and to walls, a network without particles yet; `None` where there is none.
    pub network: Option<HeatNetwork>,
    /// Bodies that store heat.
    pub bodies: HeatBodies,
}

/// The two solvers.
struct Solvers {
    gas: RepeatableGas,
    particles: Box<dyn Particles>,
}

/// What came of the attempts at a window.
enum Advanced {
    /// It is committed; the rows of particles that are used up.
    Committed(Vec<usize>),
    /// Nothing is, as its step was too long: it is begun again, shorter.
    TooLong,
    /// Nothing is, for this reason: it is begun again, shorter.
    GivenUp(String),
    /// Nothing is, by the user's interrupt.
    Interrupted,
}

/// A run: the solvers, the stages, the state of the loop.
pub struct CoupledRun {
    plan: Plan,
    mesh: Arc<Mesh>,
    parts: Solvers,
    bed: BedStage,
    laws: LawStage,
    interior: InteriorStage,
    bodies: HeatBodies,
    exchange: ExchangeStage,
    motion: MotionStage,
    ledger: Ledger,
    meter: Meter,
    clocks: Clocks,
    windows: u64,
    /// Where a window was cut, how it goes on.
    cut: WindowCut,
    /// Errors of the steps, and how long windows are by them.
    length: LengthStage,
    /// Windows in a row whose gas was not solved.
    unsolved: UnsolvedWindows,
    /// True where a run resumed after particles had moved: what they meet is found before the next window.
    neighbours_due: bool,
    /// What was set while the run goes on, each condition once.
    controls: Vec<Control>,
    /// What the last window left outside a law's range, or unconverged.
    findings: Vec<Finding>,
    /// The window committed last, and when the last checkpoint was written.
    last: Option<Window>,
    last_checkpoint: Instant,
}

impl CoupledRun {
    /// Maps the bed for the first time; the clocks stand at zero.
    pub fn new(
        plan: Plan,
        mesh: Arc<Mesh>,
        smoother: Smoother,
        closures: Closures,
        parts: RunParts,
    ) -> Result<Self, RunError> {
        let mut meter = Meter::default();
        let RunParts {
            gas,
            particles,
            models,
            network,
            bodies,
        } = parts;
        let gas = RepeatableGas::new(gas);
        let parts = Solvers { gas, particles };
        let fields = parts.particles.fields();
        let bed = BedStage::new(
            Arc::clone(&mesh),
            plan.mapping,
            smoother,
            &fields,
            &mut meter,
        )?;
        let laws = LawStage::new(closures, &bed.mapped);
        let names = elements(&laws.closures, &models).into_iter();
        let ledger = Ledger {
            elements: names.map(|name| (name, BalanceLine::default())).collect(),
            drag_carry: plan.window_drag.follows().then(BalanceLine::default),
            body_energy: (!bodies.is_empty()).then(BalanceLine::default),
            prescribed_heat: models.prescribe().then(BalanceLine::default),
            ..Ledger::default()
        };
        let motion = MotionStage::new(plan.free.clone(), plan.gravity, plan.window_drag, &fields);
        particles::check_window_drag(plan.window_drag, &*parts.particles)?;
        let paths = Paths::new(plan.paths.clone(), *mesh.periodicity());
        let substance = plan.substance.clone();
        let interior = InteriorStage::new(models, network, paths, substance, &fields);
        interior.check_weights(&fields)?;
        let mut exchange = ExchangeStage::default();
        exchange.exchange.heat.resize(fields.len(), 0.0);
        exchange.agreement = ExchangeConvergence {
            settled: true,
            ..ExchangeConvergence::default()
        };
        let length = LengthStage::new(&plan, &parts.gas.fields());
        let mut run = Self {
            plan,
            mesh,
            parts,
            bed,
            laws,
            interior,
            bodies,
            exchange,
            motion,
            ledger,
            meter,
            clocks: Clocks::default(),
            windows: 0,
            cut: WindowCut::default(),
            length,
            unsolved: UnsolvedWindows::default(),
            neighbours_due: false,
            controls: Vec::new(),
            findings: Vec::new(),
            last: None,
            last_checkpoint: Instant::now(),
        };
        run.find_neighbours();
        Ok(run)
    }

    /// Runs to the end, to an interrupt's checkpoint, or to an error.
    pub fn run(
        &mut self,
        supervisor: &Supervisor,
        observers: &mut [&mut dyn Observer],
    ) -> Result<Ending, RunError> {
        self.begin(observers)?;
        loop {
            if let Some(ending) = self.step(supervisor, observers)? {
                return Ok(ending);
            }
        }
    }

    /// Shows the observers where the run stands, before the first step of this process.
    pub fn begin(&mut self, observers: &mut [&mut dyn Observer]) -> Result<(), RunError> {
        for observer in observers.iter_mut() {
            observer.start(&self.state())?;
        }
        self.last_checkpoint = Instant::now();
        Ok(())
    }

    /// One window, with the output and the checkpoint that are due after it; `None` as long as the run goes on.
    ///
    /// A finished run leaves a last checkpoint without the observers' part: another case may
    /// continue from it, but there is nothing left to resume.
    pub fn step(
        &mut self,
        supervisor: &Supervisor,
        observers: &mut [&mut dyn Observer],
    ) -> Result<Option<Ending>, RunError> {
        if self.clocks.process >= self.plan.end {
            return self.finish(supervisor, observers).map(Some);
        }
        let mut window = self.next_window()?;
        self.bring_to_rest(supervisor, &window)?;
        self.feed_and_discharge(supervisor, &window)?;
        let used_up = loop {
            let cause = match self.advance(supervisor, &window)? {
                Advanced::Committed(used_up) => break used_up,
                Advanced::TooLong => {
                    window = self.shorten_window()?;
                    continue;
                }
                Advanced::GivenUp(cause) => cause,
                Advanced::Interrupted => {
                    self.give_up();
                    return self.stop(supervisor, observers).map(Some);
                }
            };
            let (shorter, notice) = self.cut_window(&window, &cause)?;
            window = shorter;
            for observer in observers.iter_mut() {
                observer.cut(&self.moment(None), notice)?;
            }
        };
        self.check_finite(&window)?;
        let through = self.gone_through_outlets(&window);
        self.take_out_used_up(supervisor, used_up)?;
        self.discharge(supervisor, &through)?;
        self.take_out_lost(supervisor)?;
        self.resize(supervisor)?;
        self.last = Some(window);

        let output = Meter::start(Stage::Output);
        for observer in observers.iter_mut() {
            observer.window(&self.moment(Some(&window)))?;
        }
        self.meter.stop(output);

        if self.clocks.process >= self.plan.end {
            return self.finish(supervisor, observers).map(Some);
        }
        if supervisor.interrupts().count() > 0 {
            return self.stop(supervisor, observers).map(Some);
        }
        if self.checkpoint_due(window.start.process, self.last_checkpoint.elapsed()) {
            self.checkpoint(observers)?;
        }
        Ok(None)
    }

    /// Ends the run where it stands, with a checkpoint from which it can go on.
    pub fn stop(
        &mut self,
        supervisor: &Supervisor,
        observers: &mut [&mut dyn Observer],
    ) -> Result<Ending, RunError> {
        self.checkpoint(observers)?;
        self.finish_parts(supervisor)?;
        Ok(Ending::Checkpointed(self.plan.checkpoint.committed()))
    }

    /// Ends the run at the end of process time.
    fn finish(
        &mut self,
        supervisor: &Supervisor,
        observers: &mut [&mut dyn Observer],
    ) -> Result<Ending, RunError> {
        self.note_processors();
        let last = self.last;
        for observer in observers.iter_mut() {
            observer.finish(&self.moment(last.as_ref()))?;
        }
        self.checkpoint(&mut [])?;
        self.finish_parts(supervisor)?;
        Ok(Ending::Finished)
    }

    /// The committed state: clocks, fields, particles, ledger.
    pub fn state(&self) -> CommittedState<'_> {
        self.moment(None)
    }

    /// Bed, laws, attempts of gas and interior, particles last, ledger, commit. Where the exchange did not settle and the
    /// window may be cut, nothing is committed.
    fn advance(&mut self, supervisor: &Supervisor, window: &Window) -> Result<Advanced, RunError> {
        self.map()?;
        let may_cut = self.may_cut();
        if may_cut || self.stops_between_attempts() || self.may_shorten() {
            self.parts.gas.keep();
        }
        let exchanged = self.exchange_over(supervisor, window);
        let exchanged = exchanged.and_then(|()| match may_cut {
            true => Ok(()),
            false => self.check_smallest(window),
        });
        match exchanged {
            Ok(()) => {
                if let Some(cause) = self.cause_of_cut().filter(|_| may_cut) {
                    return Ok(Advanced::GivenUp(cause));
                }
            }
            Err(error) if may_cut && self.begins_again_after(&error) => {
                return Ok(Advanced::GivenUp(error.to_string()));
            }
            Err(error) if self.ends_between_attempts(supervisor, &error) => {
                return Ok(Advanced::Interrupted);
            }
            Err(error) => return Err(self.told_with_circumstances(error, window)),
        }
        if self.is_too_long(window) {
            return Ok(Advanced::TooLong);
        }
        if let Err(error) = self.unsolved.check(&self.exchange.convergence, window) {
            return Err(self.told_with_circumstances(error.into(), window));
        }
        self.move_particles(supervisor, window)?;
        self.close_ledger(window);
        self.commit(window).map(Advanced::Committed)
    }

    /// True where the first interrupt ended the attempts: the run stops at the last commit.
    fn ends_between_attempts(&self, supervisor: &Supervisor, error: &RunError) -> bool {
        let asked = matches!(error, RunError::Part(part) if part.kind == FailureKind::Interrupted);
        asked && supervisor.interrupts().count() == 1 && self.stops_between_attempts()
    }

    /// True where the window at hand can be given up between two attempts: particles that react and do not move, with a gas
    /// that begins again. Their attempts may be many, and each may take long.
    fn stops_between_attempts(&self) -> bool {
        let can = self.interior.has_channels() && self.parts.gas.begins_again();
        can && self.plan.repeats && self.plan.free.is_empty()
    }

    /// Laws, and attempts of gas and interior.
    fn exchange_over(&mut self, supervisor: &Supervisor, window: &Window) -> Result<(), RunError> {
        let mut attempt = *window;
        for left in (0..self.evaluations()).rev() {
            self.evaluate_laws(window)?;
            self.exchange_with_gas(supervisor, &mut attempt, left == 0)?;
        }
        Ok(())
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

    fn map(&mut self) -> Result<(), RunError> {
        let particles = self.parts.particles.fields();
        let moved = match self.bed.update(&particles, &mut self.meter) {
            Err(RunError::Mapping(MappingError::Outside { particle, .. })) => {
                return Err(self.lost(particle));
            }
            moved => moved?,
        };
        if std::mem::take(&mut self.neighbours_due) || moved {
            self.find_neighbours();
        }
        Ok(())
    }

    fn find_neighbours(&mut self) {
        let (particles, time) = (self.parts.particles.fields(), self.clocks.process.seconds());
        let interior = &mut self.interior;
        self.meter.time(Stage::Interior, || {
            interior.find_neighbours(&particles, time);
        });
    }

    fn evaluate_laws(&mut self, window: &Window) -> Result<(), RunError> {
        let running = Meter::start(Stage::Exchange);
        let (particles, holds) = (self.parts.particles.fields(), self.holds(window));
        self.laws.evaluate(&LawInputs {
            mapped: &self.bed.mapped,
            gas: self.parts.gas.fields(),
            particles,
            surface: self.interior.models.temperature(),
            window,
            inertia: self.motion.inertia(&particles, window, holds),
            channels: self.interior.has_channels(),
        })?;
        self.meter.stop(running);
        Ok(())
    }

    fn exchange_with_gas(
        &mut self,
        supervisor: &Supervisor,
        attempt: &mut Window,
        last: bool,
    ) -> Result<(), RunError> {
        // Beds that react find the gas of their next laws in two attempts, what it is made of and what comes of that: more
        // would settle what the next laws change.
        const BETWEEN_LAWS: u32 = 2;
        let most = self.plan.exchange_attempts;
        let limits = ExchangeLimits {
            tolerance: self.plan.exchange_tolerance,
            attempts: if last || !self.interior.has_channels() {
                most
            } else {
                most.min(BETWEEN_LAWS)
            },
            last,
            interruptible: self.stops_between_attempts(),
        };
        let mut with = Participants {
            gas: &mut self.parts.gas,
            interior: &mut self.interior,
            laws: &mut self.laws,
            bodies: &mut self.bodies,
            mapped: &self.bed.mapped,
            centre: self.mesh.cell_centre(),
            particles: self.parts.particles.fields(),
            owed: self.motion.carry.owed(),
            supervisor,
            meter: &mut self.meter,
        };
        self.exchange.run(&mut with, limits, attempt)
    }

    fn move_particles(&mut self, supervisor: &Supervisor, window: &Window) -> Result<(), RunError> {
        let inputs = MotionInputs {
            mapped: &self.bed.mapped,
            gas: self.parts.gas.fields(),
            exchange: &self.exchange.exchange,
            coefficients: &self.laws.coefficients,
            model: self.laws.closures.momentum,
            window,
            holds: self.holds(window),
        };
        let (particles, meter) = (&mut *self.parts.particles, &mut self.meter);
        self.motion.advance(particles, &inputs, supervisor, meter)
    }

    fn close_ledger(&mut self, window: &Window) {
        let balances = WindowBalances {
            particles: self.parts.particles.fields(),
            exchange: &self.exchange,
            motion: &self.motion,
            interior: self.interior.changed(),
            walls_of_bodies: self.interior.paths.bodies(),
            bodies: self.bodies.balance(),
            supplied: self.interior.supplied(),
            gas: &self.laws.closures.gas,
            channels: self.interior.has_channels(),
        };
        balances.book(&mut self.ledger, window, self.plan.storage);
    }

    fn commit(&mut self, window: &Window) -> Result<Vec<usize>, RunError> {
        self.parts.gas.commit()?;
        self.judge_step(window);
        self.exchange.commit();
        self.bodies.commit();
        self.parts.particles.commit()?;
        let particles = self.parts.particles.fields();
        if self.holds(window) {
            self.motion.held = self.motion.held.checked_add(window.span.motion)?;
        } else {
            self.motion
                .note_forces(&particles, window, &mut self.ledger);
        }
        let used_up = self.interior.commit(&particles);
        self.gather_findings();
        self.clocks = window.end()?;
        self.windows += 1;
        self.lengthen(self.clocks);
        Ok(used_up)
    }

    fn finish_parts(&mut self, supervisor: &Supervisor) -> Result<(), PartError> {
        let gas = self.parts.gas.finish_run(supervisor);
        let particles = self.parts.particles.finish_run(supervisor);
        gas.and(particles)
    }

    /// What the solvers' own processes have used so far.
    fn note_processors(&mut self) {
        self.meter.timing.gas_phases = self.parts.gas.phases();
        self.meter.timing.gas_processes = self.parts.gas.processor_time();
        self.meter.timing.particles_processes = self.parts.particles.processor_time();
    }

    /// True where a multiple of `checkpoint_every` lies in (start, now], or wall time is up.
    fn checkpoint_due(&self, start: Ticks, since_last: Duration) -> bool {
        let crossed = self.plan.checkpoint_every.is_some_and(|every| {
            every.count() > 0
                && start.count() / every.count() < self.clocks.process.count() / every.count()
        });
        crossed
            || self
                .plan
                .checkpoint_wall
                .is_some_and(|wall| since_last >= wall)
    }

    fn moment<'a>(&'a self, window: Option<&'a Window>) -> CommittedState<'a> {
        CommittedState {
            windows: self.windows,
            clocks: self.clocks,
            window,
            mesh: &self.mesh,
            gas: self.parts.gas.fields(),
            bed: &self.bed.mapped.bed,
            smoothed_share: self.bed.mapped.operator.moved_share(),
            particles: self.parts.particles.fields(),
            particle_temperature: self.interior.models.temperature(),
            particle_heat: &self.exchange.exchange.heat,
            particle_mass: &self.interior.mass,
            models: &self.interior.models,
            particle_gas: ParticleGasExchange {
                force: &self.motion.force,
                void_fraction: &self.laws.sampled_gas.void_fraction,
                slip: &self.laws.coefficients.slip,
            },
            patch_flows: match self.windows {
                0 => &[],
                _ => &self.exchange.received.patches,
            },
            bodies: &self.bodies,
            reservoirs: self.interior.reservoirs(),
            reservoir_heat: &self.interior.reservoir_heat,
            ledger: &self.ledger,
            outlets: self.plan.feeds_and_outlets.outflows.totals(),
            waiting: self.plan.feeds_and_outlets.waiting(),
            step_error: self.length.error.as_ref(),
            courant: self.length.courant,
            convergence: &self.exchange.convergence,
            exchange_convergence: &self.exchange.agreement,
            findings: &self.findings,
            timing: &self.meter.timing,
            about: [self.parts.gas.about(), self.parts.particles.about()],
        }
    }

    /// Wall times so far.
    pub fn timing(&self) -> &Timing {
        &self.meter.timing
    }

    /// The ledger so far.
    pub fn ledger(&self) -> &Ledger {
        &self.ledger
    }
}

/// Symbols of the elements of gas and particles.
fn elements(closures: &Closures, models: &ParticleModels) -> Vec<String> {
    let gas = closures.gas.elements().into_iter();
    let mut names: Vec<String> = gas.map(|one| one.0).collect();
    for element in models.elements() {
        if !names.iter().any(|name| name == element.symbol()) {
            names.push(element.symbol().to_owned());
        }
    }
    names
}
