//! Stage: the ledger of a window (docs/theory.md, CON-2). Gas amounts count in process time.

use calcine_interior::{Inventory, Tally};
use calcine_physics::Vec3;
use calcine_physics::gas_model::GasModel;
use calcine_physics::thermo::Element;

use super::exchange::ExchangeStage;
use super::particles::MotionStage;
use crate::bodies::BodyBalance;
use crate::flows::{TwoWayFlow, WindowFlows};
use crate::ledger::{Ledger, PRESCRIBED_HEAT};
use crate::part::{Balance, CellReceived, ParticleFields};
use crate::time::{GasStorage, Window};

/// What a window comes to.
pub(super) struct WindowBalances<'a> {
    /// The particles, for their statistical weights.
    pub particles: ParticleFields<'a>,
    pub exchange: &'a ExchangeStage,
    pub motion: &'a MotionStage,
    /// What changed inside particles, and the heat in W from walls and surroundings into them.
    pub interior: (Inventory, &'a [f64]),
    /// The body that each of these walls and surroundings is of.
    pub walls_of_bodies: &'a [Option<usize>],
    /// What bodies stored and got.
    pub bodies: &'a BodyBalance,
    /// Heat in J that something outside gave particles.
    pub supplied: Tally,
    pub gas: &'a GasModel,
    /// True where mass passes between gas and particles.
    pub channels: bool,
}

impl WindowBalances<'_> {
    /// Books all of it.
    pub fn book(&self, ledger: &mut Ledger, window: &Window, storage: GasStorage) {
        let process = window.span.process.seconds();
        let scale = process / storage.span(window);
        let gas = &self.exchange.received.mass;
        ledger
            .mass
            .book(scale * gas.open(), scale * gas.magnitude());
        ledger.flows = WindowFlows {
            mass: vec![
                ("boundary", through_boundary(gas, scale)),
                ("reservoir", TwoWayFlow::of_net(scale * gas.reservoir)),
                ("sources", TwoWayFlow::of_net(scale * gas.source)),
                ("particles", TwoWayFlow::of_net(scale * gas.exchange)),
                ("storage", TwoWayFlow::of_net(-scale * gas.stored)),
            ],
            energy: Vec::new(),
            species: self
                .exchange
                .received
                .species
                .iter()
                .map(|balance| through_boundary(balance, scale))
                .collect(),
        };
        self.book_elements(ledger, scale);
        self.book_energy(ledger, scale, process);
        self.book_momentum(ledger, window.span.motion.seconds());
    }

    /// The mass of each element in gas and particles together, and that of the particles: what they exchange drops
    /// out of the one and stands in the other.
    fn book_elements(&self, ledger: &mut Ledger, scale: f64) {
        let (received, changes) = (&self.exchange.received, &self.interior.0);
        let shares = self.gas.elements();
        for (name, line) in &mut ledger.elements {
            let (mut sum, mut magnitude) = (0.0, 0.0);
            let own = shares.iter().find(|(element, _)| element == name);
            for (share, balance) in own
                .iter()
                .flat_map(|own| own.1.iter().zip(&received.species))
            {
                // Reactions of the gas make no element, so that what they make of the species is left in.
                let (open, terms) = (balance.open(), balance.magnitude());
                let other = balance.exchange.abs() + balance.source_magnitude;
                sum += scale * share * (open + balance.exchange + balance.source);
                magnitude += scale * share * (terms - other);
            }
            if let Some(k) = place(name) {
                sum += changes.elements[k].sum;
                magnitude += changes.elements[k].magnitude;
            }
            line.book(sum, magnitude);
        }
        if self.channels {
            let given = scale * received.mass.exchange;
            let magnitude = received.species.iter().map(|one| one.exchange.abs());
            let magnitude = scale * magnitude.sum::<f64>();
            ledger
                .particle_mass
                .book(changes.mass.sum + given, magnitude);
        }
    }

    /// Gas and particles together: the exchange drops out of the sum and is booked by itself. Particles count energy
    /// from the elements; the gas counts sensible enthalpy, to which that of formation of what it received comes.
    fn book_energy(&self, ledger: &mut Ledger, scale: f64, process: f64) {
        let ExchangeStage {
            exchange,
            species,
            received,
            ..
        } = self.exchange;
        let gas = &received.energy;
        let (changes, reservoirs) = (&self.interior.0.energy, self.interior.1);
        // Heat from walls of bodies stays within.
        let outside = |(k, heat): (usize, &f64)| {
            let body = self.walls_of_bodies.get(k).is_some_and(Option::is_some);
            (!body).then_some(*heat)
        };
        let walls = || reservoirs.iter().enumerate().filter_map(outside);
        let way = TwoWayFlow::of_net;
        let [walls, walls_magnitude] = [walls().sum::<f64>(), walls().map(f64::abs).sum()];
        let [walls, walls_magnitude] = [walls, walls_magnitude].map(|watt| watt * process);
        let bodies = self.bodies;
        let to_gas: f64 = received.heat.iter().sum::<f64>() * process;
        let weighted = |(row, value): (usize, f64)| self.particles.weight_of(row) * value;
        let total = |values: &[f64]| {
            let rows = values.iter().copied().enumerate();
            rows.map(weighted).sum::<f64>()
        };
        let each = exchange.heat.iter().map(|q| q.abs()).enumerate();
        let to_particles = (total(&exchange.heat) + total(&species.carried)) * process;
        let exchanged = bodies.from_gas_magnitude
            + process
                * (received.heat.iter().map(|q| q.abs()).sum::<f64>()
                    + each.map(weighted).sum::<f64>());
        let formed = if self.channels {
            formation(self.gas, received)
        } else {
            0.0
        };
        let magnitude = scale * (gas.magnitude() - gas.exchange.abs())
            + changes.magnitude
            + walls_magnitude
            + self.supplied.magnitude
            + bodies.stored_magnitude
            + bodies.radiated_magnitude
            + exchanged;
        ledger.energy.book(
            scale * (gas.open() + gas.exchange + formed) + changes.sum + bodies.stored
                - walls
                - bodies.radiated
                - self.supplied.sum,
            magnitude,
        );
        ledger.flows.energy = vec![
            ("boundary", through_boundary(gas, scale)),
            ("reservoir", way(scale * gas.reservoir)),
            ("sources", way(scale * gas.source)),
            ("walls", TwoWayFlow::of_flows(walls, walls_magnitude)),
            (PRESCRIBED_HEAT, way(self.supplied.sum)),
            ("radiated", way(bodies.radiated)),
            ("particles", way(-(changes.sum + scale * formed))),
            ("gas_storage", way(-scale * gas.stored)),
            ("body_storage", way(-bodies.stored)),
        ];
        if let Some(line) = &mut ledger.prescribed_heat {
            line.book(self.supplied.sum, magnitude);
        }
        if let Some(line) = &mut ledger.body_energy {
            let [open, magnitude] = bodies.open();
            line.book(open, magnitude);
        }
        ledger
            .energy_exchange
            .book(to_gas + to_particles + bodies.from_gas, exchanged);
    }

    fn book_momentum(&self, ledger: &mut Ledger, motion: f64) {
        let (received, moved) = (&self.exchange.received, self.motion);
        let drag_on_gas: Vec3 = received.drag.iter().sum::<Vec3>() * motion;
        let impulses = &moved.received.impulse;
        let drag_on_particles: Vec3 = impulses
            .iter()
            .zip(&moved.pressure_force)
            .map(|(impulse, pressure)| impulse - pressure * motion)
            .enumerate()
            .map(|(row, drag)| self.particles.weight_of(row) * drag)
            .sum();
        let carry = &self.motion.carry;
        let moved: f64 = received
            .drag
            .iter()
            .map(|force| force.norm() * motion)
            .sum();
        ledger.momentum_exchange.book(
            (drag_on_gas + drag_on_particles - carry.change()).norm(),
            2.0 * moved,
        );
        if let Some(line) = &mut ledger.drag_carry {
            let late = carry.total().norm();
            line.drift = late;
            line.error += late;
            line.throughput += 2.0 * moved;
        }
        for (balance, clock) in received.momentum.iter().zip(&received.storage_clock) {
            let (sum, magnitude) = (balance.open(), balance.magnitude());
            ledger.gas_momentum.book(sum, magnitude);
            ledger.storage_clock.book(*clock, magnitude);
        }
    }
}

/// What passed the boundary of the gas.
fn through_boundary(balance: &Balance, scale: f64) -> TwoWayFlow {
    TwoWayFlow::of_flows(scale * balance.boundary, scale * balance.boundary_magnitude)
}

/// Enthalpy of formation in J of the gas that the particles gave.
fn formation(gas: &GasModel, received: &CellReceived) -> f64 {
    let GasModel::Mixture(mixture) = gas else {
        return 0.0;
    };
    let parts = mixture.species().iter().zip(&received.species);
    parts
        .map(|(species, balance)| species.formation_enthalpy() * balance.exchange)
        .sum()
}

/// Place of an element among all, by its symbol.
pub(super) fn place(name: &str) -> Option<usize> {
    Element::ALL.iter().position(|one| one.symbol() == name)
}
