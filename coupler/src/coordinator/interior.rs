//! Stage: inside and between particles. The network of contacts and radiation is solved over the surfaces of all models;
//! with its heat the models say what they exchange with the gas.

use calcine_interior::{
    GasLines, HeatNetwork, Inventory, NetworkBodies, NetworkHeat, NetworkOutcome,
    NetworkSurroundings, RowImbalance, SurfaceMean, Surroundings, Tally, Transfer,
};

use super::error::RunError;
use super::network_slope::slope_beside_network;
use crate::bodies::HeatBodies;
use crate::models::{ParticleModelError, ParticleModels, PopulationNewcomer};
use crate::part::ParticleFields;
use crate::paths::Paths;
use crate::time::Window;

/// Share of the heat of the network that particles which follow it by steps of their own may not have taken, and how often it is
/// solved in an attempt at most.
const APART: f64 = 1e-3;
const MOST_ROUNDS: u32 = 4;

/// The models of all particles, and the network between them.
pub(super) struct InteriorStage {
    pub models: ParticleModels,
    pub(super) network: Option<HeatNetwork>,
    /// Material of each population, for the network.
    substance: Vec<usize>,
    pub(super) paths: Paths,
    /// Heat from the network into each particle in W, of the attempt.
    heat: Vec<f64>,
    /// The same as the models are told of it, and the means of the surfaces of those that followed it by steps of their own.
    told: Vec<NetworkHeat>,
    means: Vec<Option<SurfaceMean>>,
    /// What particles exchange with the gas.
    pub lines: GasLines,
    /// Masses in kg at the last commit.
    pub mass: Vec<f64>,
    /// Heat in W of the last window from walls and surroundings into the particles.
    pub reservoir_heat: Vec<f64>,
    /// How the network of the last attempt ended.
    pub network_outcome: NetworkOutcome,
    /// What view factors found since the last commit leave open.
    imbalance: RowImbalance,
    /// Particles came, went or changed their size since the exchange areas of radiation were found.
    pub(super) changed: bool,
}

impl InteriorStage {
    /// Models that hold the particles of a run, and a network without any yet.
    pub fn new(
        models: ParticleModels,
        network: Option<HeatNetwork>,
        paths: Paths,
        substance: Vec<usize>,
        particles: &ParticleFields<'_>,
    ) -> Self {
        let mut stage = Self {
            heat: vec![0.0; particles.len()],
            told: Vec::new(),
            means: Vec::new(),
            models,
            network,
            substance,
            paths,
            lines: GasLines::default(),
            mass: Vec::new(),
            reservoir_heat: Vec::new(),
            network_outcome: NetworkOutcome::Settled,
            imbalance: RowImbalance::default(),
            changed: false,
        };
        stage.tell_network(&[], particles, 0);
        stage.weigh(particles);
        stage
    }

    /// True where mass passes between gas and particles.
    pub fn has_channels(&self) -> bool {
        !self.models.channels().is_empty()
    }

    /// True where elements of some particles count, so that reactions may set heat free inside.
    pub fn has_reactions(&self) -> bool {
        !self.models.elements().is_empty()
    }

    /// True where particles exchange heat with each other or with walls.
    pub fn has_network(&self) -> bool {
        self.network.is_some()
    }

    /// Names of walls and surroundings.
    pub fn reservoirs(&self) -> &[String] {
        self.paths.names()
    }

    /// Finds what particles touch and see, at a process time in s.
    pub fn find_neighbours(&mut self, particles: &ParticleFields<'_>, time: f64) {
        if let Some(network) = &mut self.network {
            let (imbalance, changed) = (&mut self.imbalance, &mut self.changed);
            self.paths.find_neighbours(particles, time, |neighbours| {
                network.set_neighbours(neighbours);
                if let Some(views) = neighbours.views {
                    (*imbalance, *changed) = (views.imbalance, false);
                }
            });
        }
    }

    /// What view factors found since this was last asked leave open.
    pub fn take_imbalance(&mut self) -> RowImbalance {
        std::mem::take(&mut self.imbalance)
    }

    /// An attempt with the gas as it is: surface, network, respond. The network takes the heat that reactions set free
    /// from the attempt before; a first attempt has none, and is done `rounds` times: that heat would leave a window
    /// late. Where particles follow the network by steps of their own, it is repeated until they came to what the others took
    /// them to be. Bodies get their temperatures of the attempt.
    pub fn respond(
        &mut self,
        around: &Surroundings<'_>,
        (gas_conductivity, bodies): (&[f64], &mut HeatBodies),
        window: &Window,
        rounds: u32,
    ) -> Result<(), RunError> {
        let failed = |cause| RunError::Interior {
            window: window.index,
            cause,
        };
        for round in 1.. {
            self.conduct(around, (gas_conductivity, &mut *bodies), window)
                .map_err(failed)?;
            let span = window.span.process.seconds();
            let lines = &mut self.lines;
            let done = self.models.respond(around, span, &self.told, lines);
            done.map_err(failed)?;
            let apart = self.book_means();
            self.stiffen(around);
            tracing::trace!(window = window.index, round, apart, "network");
            if round >= rounds && (apart <= APART || round >= MOST_ROUNDS) {
                break;
            }
        }
        Ok(())
    }

    /// Books the heat of the network by what particles that followed it came to; how much of it they did not take, as a share. That is
    /// owed to them.
    fn book_means(&mut self) -> f64 {
        let Some(network) = self.network.as_mut().filter(|network| !network.is_empty()) else {
            return 0.0;
        };
        self.models.surface_means(&mut self.means);
        let apart = network.book_means(&self.means, &self.told);
        self.heat.copy_from_slice(&network.heat);
        apart
    }

    /// Tells the gas of particles that a network leads to that they do not follow it as alone, through the heat of the gas as it
    /// was seen.
    fn stiffen(&mut self, around: &Surroundings<'_>) {
        let Some(network) = self.network.as_ref().filter(|network| !network.is_empty()) else {
            return;
        };
        for (row, stiffness) in network.stiffness.iter().enumerate() {
            let own = self.lines.conductance[row];
            let film = around.conductance[row];
            if let Some(slope) = slope_beside_network(film, own, *stiffness) {
                let seen = around.temperature[row];
                let apart = own / slope * (seen - self.lines.temperature[row]);
                self.lines.conductance[row] = slope;
                self.lines.temperature[row] = seen - apart;
            }
        }
    }

    fn conduct(
        &mut self,
        around: &Surroundings<'_>,
        (gas_conductivity, bodies): (&[f64], &mut HeatBodies),
        window: &Window,
    ) -> Result<(), ParticleModelError> {
        self.network_outcome = NetworkOutcome::Settled;
        let [span, end] = window.process_span();
        let Some(network) = self.network.as_mut().filter(|network| !network.is_empty()) else {
            bodies.take(None, [span, end]);
            let heat = self.heat.iter();
            self.told.clear();
            self.told
                .extend(heat.map(|heat| NetworkHeat::constant(*heat)));
            return Ok(());
        };
        let (reservoirs, of) = self.paths.reservoirs(end, bodies.told());
        let surroundings = NetworkSurroundings {
            gas_conductivity,
            reservoirs,
            bodies: NetworkBodies {
                of,
                start: bodies.told(),
                line: &|body, kelvin| bodies.line(body, kelvin, [span, end]),
            },
        };
        let models = &mut self.models;
        let start = models.temperature().to_vec();
        self.network_outcome = network.solve(&start, &surroundings, |at, lines| {
            models.surface(around, span, at, lines)
        })?;
        self.heat.copy_from_slice(&network.heat);
        network.told(&mut self.told);
        bodies.take(Some(&network.body_temperature), [span, end]);
        Ok(())
    }

    /// Ends the attempt: heat in W and sensible enthalpy that exchanged gas carries in W into each particle, and the
    /// rates of all channels.
    pub fn settle(
        &mut self,
        [heat, carried, rates]: [&[f64]; 3],
        window: &Window,
    ) -> Result<(), RunError> {
        let took = Transfer {
            heat,
            network: &self.heat,
            carried,
            rates,
        };
        let done = self.models.settle(&took, window.span.process.seconds());
        done.map_err(|cause| RunError::Interior {
            window: window.index,
            cause,
        })
    }

    /// What the last attempt changed in the particles, and the heat in W from walls and surroundings.
    pub fn changed(&self) -> (Inventory, &[f64]) {
        let reservoirs = self.network.as_ref();
        let heat = reservoirs.map_or(&[][..], |network| &network.reservoir_heat);
        (self.models.changed(), heat)
    }

    /// Bodies whose walls gave particles heat in W in the last attempt, each wall with its body.
    pub fn heat_of_bodies(&self) -> impl Iterator<Item = (usize, f64)> {
        let heat = self.network.iter().flat_map(|one| &one.reservoir_heat);
        let bodies = self.paths.bodies().iter();
        bodies
            .zip(heat)
            .filter_map(|(body, heat)| Some(((*body)?, *heat)))
    }

    /// Heat in J that something outside gave the particles in the last attempt.
    pub fn supplied(&self) -> Tally {
        self.models.supplied()
    }

    /// Gives up the attempts since the last commit.
    pub fn begin_again(&mut self) {
        if let Some(network) = &mut self.network {
            network.begin();
        }
        self.heat.fill(0.0);
    }

    /// Takes the last attempt as the new start; the rows of particles that are used up.
    pub fn commit(&mut self, particles: &ParticleFields<'_>) -> Vec<usize> {
        self.reservoir_heat.clear();
        if let Some(network) = &self.network {
            self.reservoir_heat
                .extend_from_slice(&network.reservoir_heat);
        }
        self.begin_again();
        let used_up = self.models.commit();
        self.weigh(particles);
        used_up
    }

    /// Masses of all particles: those that their models change, and those that the solver of the motion has.
    pub fn weigh(&mut self, particles: &ParticleFields<'_>) {
        self.mass.clear();
        self.mass.extend_from_slice(particles.mass);
        self.models.masses(&mut self.mass);
    }

    /// Refuses weights that mean nothing, and others than 1 where heat passes between particles.
    pub fn check_weights(&self, particles: &ParticleFields<'_>) -> Result<(), RunError> {
        for (&id, &weight) in particles.id.iter().zip(particles.weight) {
            if !(weight.is_finite() && weight > 0.0) {
                return Err(RunError::Weight { id, weight });
            }
            if weight != 1.0 && self.has_network() {
                return Err(RunError::WeightInNetwork { id, weight });
            }
        }
        Ok(())
    }

    /// Takes rows out and puts new particles, the last of `particles`, behind the others.
    pub fn change(
        &mut self,
        gone: &[usize],
        new: &[PopulationNewcomer<'_>],
        particles: &ParticleFields<'_>,
    ) -> Result<(), ParticleModelError> {
        self.models.change(gone, new)?;
        self.tell_network(gone, particles, particles.len() - new.len());
        self.heat.clear();
        self.heat.resize(particles.len(), 0.0);
        self.changed = true;
        self.weigh(particles);
        Ok(())
    }

    /// Tells the network who went, and who came from a row on.
    fn tell_network(&mut self, gone: &[usize], particles: &ParticleFields<'_>, first: usize) {
        let Some(network) = &mut self.network else {
            return;
        };
        let material = |row: usize| {
            let population = particles.population[row] as usize;
            self.substance.get(population).copied().unwrap_or_default()
        };
        let new: Vec<(f64, usize)> = (first..particles.len())
            .map(|row| (particles.radius[row], material(row)))
            .collect();
        network.change(gone, &new);
    }
}
