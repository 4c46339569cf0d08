//! Stage: the exchange of heat and mass between gas and particles within a window, a fixed point over cells and
//! particles.

use super::bed::MappedBed;
use super::error::RunError;
use super::gas_iterate::GasIterate;
use super::interior::InteriorStage;
use super::laws::LawStage;
use super::meter::{Meter, Stage};
use crate::bodies::HeatBodies;
use crate::error::{FailureKind, PartError};
use crate::exchange::{Exchange, ExchangeConvergence, ExchangeInputs};
use crate::extreme::{larger, smaller};
use crate::finite::check_told;
use crate::part::{CellReceived, Convergence, Gas, ParticleFields};
use crate::species_coupling::{ChannelLines, SpeciesCoupling};
use crate::supervisor::Supervisor;
use crate::time::Window;
use calcine_interior::Surroundings;
use calcine_physics::Vec3;

/// Share of the particles' mass whose exchange in a window is none at all for the convergence of attempts.
const NOTHING: f64 = 1e-9;

/// What the gas and the particles exchanged in the last attempt.
#[derive(Default)]
pub(super) struct ExchangeStage {
    pub exchange: Exchange,
    pub species: SpeciesCoupling,
    /// What the gas reports.
    pub received: CellReceived,
    /// How well the gas solved it.
    pub convergence: Convergence,
    /// How well both agree.
    pub agreement: ExchangeConvergence,
    /// The gas about which particles were last linearised.
    iterate: GasIterate,
    /// Attempts at windows that were cut, and cuts, since the last commit.
    discarded: u32,
    cuts: u32,
    /// Attempts at the present window.
    tried: u32,
    interruptible: bool,
}

/// When the attempts of a window end.
#[derive(Clone, Copy, Debug)]
pub(super) struct ExchangeLimits {
    /// Share of the exchange that may be misplaced.
    pub tolerance: f64,
    /// Attempts at most.
    pub attempts: u32,
    /// False where the attempts only find the gas on which laws are evaluated next: what reacts is then not fixed, and
    /// nothing is credited.
    pub last: bool,
    /// True where a first interrupt ends the attempts: the run then stops at the last commit.
    pub interruptible: bool,
}

/// What takes part in the attempts of a window.
pub(super) struct Participants<'a> {
    pub gas: &'a mut dyn Gas,
    pub interior: &'a mut InteriorStage,
    pub laws: &'a mut LawStage,
    pub bodies: &'a mut HeatBodies,
    pub mapped: &'a MappedBed,
    /// Centres of the cells in m.
    pub centre: &'a [Vec3],
    pub particles: ParticleFields<'a>,
    /// Impulse of drag in N s that the gas of each cell owes from the window before; empty where it owes none.
    pub owed: &'a [Vec3],
    pub supervisor: &'a Supervisor,
    pub meter: &'a mut Meter,
}

impl Participants<'_> {
    fn inputs(&self, window: &Window) -> ExchangeInputs<'_> {
        ExchangeInputs {
            operator: &self.mapped.operator,
            particles: self.particles,
            coefficients: &self.laws.coefficients,
            acceleration: window.acceleration(),
        }
    }

    fn lines(&self) -> ChannelLines<'_> {
        ChannelLines {
            channels: self.interior.models.channels(),
            lines: &self.interior.lines,
        }
    }
}

impl ExchangeStage {
    /// Repeats the window of gas and interior until the exchange is where it belongs, and what reacts is what the
    /// gas has for it; then once more with what particles give and take fixed, where mass passes.
    pub fn run(
        &mut self,
        with: &mut Participants<'_>,
        limits: ExchangeLimits,
        window: &mut Window,
    ) -> Result<(), RunError> {
        let first = window.attempt;
        let channels = with.interior.has_channels();
        self.interruptible = limits.interruptible;
        self.begin(with, window);
        self.respond(with, window)?;
        self.tell_rates(with);
        let (mut limits, limit) = (limits, limits.attempts);
        // True where the rates agreed before they had been fixed, but the gas of the fixed rates was another.
        let mut damped = false;
        let (settled, misplaced, off) = loop {
            limits.attempts = limit.saturating_sub(window.attempt - first);
            let (settled, misplaced, off) = self.iterate(with, (&limits, damped), window)?;
            if channels && !limits.last {
                return Ok(());
            }
            if !channels {
                break (settled, misplaced, off);
            }
            self.iterate.keep(&with.gas.fields());
            self.fix_rates(with, window);
            let (misplaced, _) = self.attempt(with, window)?;
            // The lines may damp what the fixed rates do not; then the gas comes to where particles may do otherwise.
            let moved = self.iterate.moved(&with.gas.fields());
            tracing::debug!(window = window.index, moved, "rates fixed");
            if !settled || moved <= limits.tolerance {
                break (settled, misplaced, off);
            }
            if window.attempt - first + 1 >= limit {
                break (false, misplaced, larger(off, moved));
            }
            damped = true;
        };
        if !settled {
            tracing::debug!(
                window = window.index,
                attempts = window.attempt - first,
                misplaced = off,
                "the attempts ended with a larger share of the exchange in the wrong cells \
                 of a particle, or of what reacts off its rate, than coupling.exchange.tolerance allows"
            );
        }
        self.settle(with, window)?;
        self.agreement = ExchangeConvergence {
            attempts: self.discarded + window.attempt,
            cuts: self.cuts,
            misplaced: if settled {
                smaller(misplaced, off)
            } else {
                off
            },
            settled,
        };
        Ok(())
    }

    /// Attempts given up since the last commit.
    pub fn discarded(&self) -> u32 {
        self.discarded
    }

    /// Cuts since the last commit.
    pub fn cuts(&self) -> u32 {
        self.cuts
    }

    /// Begins to count attempts anew, after a commit.
    pub fn commit(&mut self) {
        (self.discarded, self.tried, self.cuts) = (0, 0, 0);
    }

    /// Counts the attempts of a window that is given up with those of the next.
    pub fn discard(&mut self) {
        self.discarded += self.tried;
        self.tried = 0;
    }

    /// The same of a window that is cut.
    pub fn cut(&mut self) {
        self.discard();
        self.cuts += 1;
    }

    /// Attempts until the exchange is where it belongs and what reacts is what the gas has for it, or the limit is
    /// reached: whether it is, the share of heat in the wrong cells, and how far off the last attempt was. Where lines
    /// damp the rates, until the gas stays as well.
    fn iterate(
        &mut self,
        with: &mut Participants<'_>,
        (limits, damped): (&ExchangeLimits, bool),
        window: &mut Window,
    ) -> Result<(bool, f64, f64), RunError> {
        let first = window.attempt;
        let channels = with.interior.has_channels();
        let fixes = u32::from(channels && limits.last);
        loop {
            let (misplaced, bodies) = self.attempt(with, window)?;
            let mut off = larger(misplaced, bodies);
            if channels {
                if damped {
                    off = larger(off, self.iterate.moved(&with.gas.fields()));
                    self.iterate.keep(&with.gas.fields());
                }
                // What the particles say of the gas that came of their lines, beside what the lines said of it.
                self.follow_rates(with);
                let extrapolated = self.advance_iterate(with);
                self.respond(with, window)?;
                let rates = self.tell_rates(with);
                tracing::debug!(bodies, rates, extrapolated, "apart");
                off = larger(larger(off, rates), extrapolated);
            }
            let settled = off <= limits.tolerance;
            tracing::debug!(
                window = window.index,
                attempt = window.attempt,
                misplaced,
                off
            );
            if settled || window.attempt - first + fixes >= limits.attempts {
                return Ok((settled, misplaced, off));
            }
            if !channels {
                let told = with.bodies.told().to_vec();
                self.respond(with, window)?;
                with.bodies.accelerate(&told);
            }
        }
    }

    /// Spreads what does not change between attempts.
    fn begin(&mut self, with: &mut Participants<'_>, window: &Window) {
        let running = Meter::start(Stage::Exchange);
        let inputs = with.inputs(window);
        self.exchange.begin(&inputs, &with.gas.fields());
        self.exchange
            .cells
            .eddies
            .clone_from(&with.laws.eddies.exchange);
        let span = window.span.motion.seconds();
        self.exchange.repay(with.owed, span);
        let gas = &with.laws.closures.gas;
        with.bodies.begin(&with.gas.fields(), gas, &with.mapped.bed);
        if with.interior.has_channels() {
            let channels = with.interior.models.channels();
            let units = channels.iter().flat_map(|channel| &channel.mass);
            let largest = units.fold(0.0, |most: f64, mass| most.max(mass.abs()));
            let rows = 0..with.particles.len();
            let mass: f64 = rows.map(|row| with.particles.row_mass(row)).sum();
            let span = window.span.process.seconds();
            self.species.least = NOTHING * mass / (span * largest.max(f64::MIN_POSITIVE));
            self.iterate
                .begin(&with.mapped.operator, &with.gas.fields());
        }
        with.meter.stop(running);
    }

    /// Takes the gas of the last attempt as the next about which particles are linearised, accelerated; how far the
    /// acceleration took it from the gas that is there.
    fn advance_iterate(&mut self, with: &mut Participants<'_>) -> f64 {
        let running = Meter::start(Stage::Exchange);
        let (operator, gas) = (&with.mapped.operator, with.gas.fields());
        let extrapolated = self.iterate.advance(operator, &gas);
        with.meter.stop(running);
        extrapolated
    }

    /// What the interior does over the window with the gas as it is.
    fn respond(&mut self, with: &mut Participants<'_>, window: &Window) -> Result<(), RunError> {
        let Participants {
            gas,
            interior,
            laws,
            bodies,
            mapped,
            particles,
            meter,
            ..
        } = with;
        let channels = interior.has_channels();
        if channels {
            let seen = self.iterate.fields(gas.fields());
            meter.time(Stage::Exchange, || laws.sample_again(mapped, &seen));
            bodies.look(seen.temperature);
        } else {
            bodies.look(gas.fields().temperature);
        }
        let around = Surroundings {
            temperature: if channels {
                &self.iterate.sampled_temperature
            } else {
                self.exchange.sampled_temperature()
            },
            pressure: &laws.pressure,
            composition: &laws.sampled_gas.composition,
            conductance: &laws.coefficients.conductance,
            film: &laws.coefficients.film,
            theory: laws.closures.film,
            radius: particles.radius,
            end: window.start.process.seconds() + window.span.process.seconds(),
        };
        // Heat that reactions set free inside reaches the network of a first attempt by a second look.
        let first = window.attempt == 0 && interior.has_reactions() && interior.has_network();
        let conductivity = &laws.coefficients.gas_conductivity;
        meter.time(Stage::Interior, || {
            let others = (&conductivity[..], &mut **bodies);
            interior.respond(&around, others, window, 1 + u32::from(first))
        })?;
        self.exchange
            .conductance
            .clone_from(&interior.lines.conductance);
        Ok(())
    }

    /// Tells the gas of the channels as lines. The result is how far their rates, at the gas as it is, are from those of
    /// the lines before, as a share of all.
    fn tell_rates(&mut self, with: &mut Participants<'_>) -> f64 {
        let mut moved = 0.0;
        if with.interior.has_channels() {
            let running = Meter::start(Stage::Exchange);
            let told = &mut self.exchange.cells.species;
            let (operator, properties) = (&with.mapped.operator, &with.laws.closures.gas);
            let gas = with.gas.fields();
            moved = self
                .species
                .linearise(operator, with.lines(), &gas, properties, told);
            with.meter.stop(running);
        }
        moved
    }

    /// One attempt of the gas: the share of the exchange that it left misplaced, and how far bodies are from their balance.
    fn attempt(
        &mut self,
        with: &mut Participants<'_>,
        window: &mut Window,
    ) -> Result<(f64, f64), RunError> {
        self.check_interrupts(with.supervisor, window)?;
        let running = Meter::start(Stage::Exchange);
        let inputs = with.inputs(window);
        let start = &with.interior.lines.temperature;
        self.exchange.linearise(&inputs, start);
        with.bodies.tell(&mut self.exchange.cells);
        let gas = &with.laws.closures.gas;
        let named = (gas.species(), with.centre);
        check_told(&self.exchange.cells, &with.gas.fields(), named, window)?;
        with.meter.stop(running);
        let Participants {
            gas,
            mapped,
            supervisor,
            meter,
            ..
        } = with;
        self.convergence = meter.time(Stage::Gas, || {
            gas.start(window, &mapped.bed, &self.exchange.cells)?;
            gas.finish(supervisor, &mut self.received)
        })?;
        window.attempt += 1;
        self.tried = window.attempt;
        let running = Meter::start(Stage::Exchange);
        let (gas, properties) = (with.gas.fields(), &with.laws.closures.gas);
        let told = &self.exchange.cells.species;
        self.species.heat_of_cells(&gas, properties, told);
        let inputs = with.inputs(window);
        let misplaced = self.exchange.credit_heat(
            &inputs,
            &with.interior.lines.temperature,
            &gas,
            &self.received,
            &self.species.cell_heat,
        );
        let credited = |cell: usize| self.exchange.credited_temperature(cell);
        let off = with.bodies.credit(
            credited,
            with.interior.heat_of_bodies(),
            window.process_span(),
        );
        with.meter.stop(running);
        Ok((misplaced, off))
    }

    /// Ends the attempts on a second interrupt, and on the first where the window can be begun again.
    fn check_interrupts(&self, supervisor: &Supervisor, window: &Window) -> Result<(), PartError> {
        let patience = if self.interruptible { 1 } else { 2 };
        if supervisor.interrupts().count() < patience {
            return Ok(());
        }
        let who = "the exchange of gas and particles";
        Err(PartError::new(who, FailureKind::Interrupted, "interrupted").in_window(window))
    }

    /// What passes through channels, by their lines at the gas of the attempt.
    fn follow_rates(&mut self, with: &Participants<'_>) {
        let species = with.laws.closures.gas.species().len();
        let operator = &with.mapped.operator;
        self.species
            .follow(operator, with.lines(), &with.gas.fields(), species);
    }

    /// Fixes what particles give and take, limited to what they hold.
    fn fix_rates(&mut self, with: &mut Participants<'_>, window: &Window) {
        let InteriorStage { models, lines, .. } = &mut *with.interior;
        let span = window.span.process.seconds();
        let channels = models.channels().to_vec();
        let given = ChannelLines {
            channels: &channels,
            lines,
        };
        self.species.fix(
            &with.mapped.operator,
            given,
            |rates| models.limit(rates, span),
            &with.laws.closures.gas,
            &mut self.exchange.cells.species,
        );
    }

    /// Credits what the last attempt exchanged to the particles.
    fn settle(&mut self, with: &mut Participants<'_>, window: &Window) -> Result<(), RunError> {
        let running = Meter::start(Stage::Exchange);
        let (gas, operator) = (with.gas.fields(), &with.mapped.operator);
        if with.interior.has_channels() {
            self.species
                .credit(operator, with.lines(), &gas, &with.laws.closures.gas);
        } else {
            self.species.carried.clear();
            self.species.carried.resize(with.particles.len(), 0.0);
        }
        let inputs = with.inputs(window);
        self.exchange.credit_drag(&inputs, &gas, &self.received);
        with.meter.stop(running);
        let took: [&[f64]; 3] = [
            &self.exchange.heat,
            &self.species.carried,
            &self.species.rates,
        ];
        let Participants {
            interior, meter, ..
        } = with;
        meter.time(Stage::Interior, || interior.settle(took, window))
    }
}
