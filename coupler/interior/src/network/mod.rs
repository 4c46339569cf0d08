//! Heat between particles and to walls: a network of conductances, solved implicitly.
//!
//! Particles are nodes that store heat; walls and surroundings are reservoirs of a given temperature.
//! Contacts and gaps are bonds of a conductance in W/K that is fixed over an attempt. Views are bonds too:
//! black radiation between surfaces of exchange area S is S σ (T_i⁴ − T_j⁴) = S h (T_i − T_j) with
//! h = σ (T_i² + T_j²)(T_i + T_j) (`radiation::linear`), h from the last iterate. With positive conductances
//! every iterate lies between the temperatures it starts from and those beside it, whatever the span, so
//! that steps of process time may be as long as a case asks for.
//!
//! Temperatures of particles are means over the span: a thin particle on its way to what it is beside has its heat from that
//! of the way, not of its end (`span_means`). Particles that follow the network by steps of their own say their means
//! (`beside`).
//!
//! A grey surface gets a second node without heat capacity, its radiosity J = σ T_J⁴: views lead from one
//! radiosity to the other, and A e/(1 − e) from the surface to its own. Their heat is booked where the views
//! end, so that what a pair exchanges adds up to zero to the last bit.

mod beside;
mod contacts;
mod neighbours;
mod radiation;
mod solver;
mod span_means;

use calcine_physics::conduction::{Conduction, Conductivity, ContactArea, GasGap, Stiffness};
use calcine_physics::radiation::conducted_share;

pub use neighbours::{
    ExchangeAreas, NeighbourPair, NeighbourWall, Neighbours, NetworkBodies, NetworkSurroundings,
    RowImbalance,
};
use radiation::Radiation;
use solver::{NetworkSolver, NetworkSystem};
use span_means::SpanMeans;

use crate::model::SurfaceLine;
use crate::without;

/// What heat between particles needs to know of a material.
#[derive(Clone, Debug, PartialEq)]
pub struct ThermalProperties {
    /// Conductivity.
    pub conductivity: Conductivity,
    /// Emissivity of its surface, above 0 and up to 1.
    pub emissivity: f64,
    /// Density in kg/m³.
    pub density: f64,
    /// Elastic constants in the computation of contacts.
    pub soft: Stiffness,
    /// Elastic constants of the real material.
    pub real: Stiffness,
}

/// Laws of heat between particles.
#[derive(Debug)]
pub struct HeatLaws {
    /// Through contacts.
    pub conduction: Box<dyn Conduction>,
    /// By which overlap contacts conduct.
    pub area: ContactArea,
    /// Through the gas between surfaces.
    pub gap: Box<dyn GasGap>,
    /// True where surfaces radiate to each other.
    pub radiates: bool,
    /// True where what a sphere cannot conduct from side to side is taken off its radiation
    /// (`radiation::conducted_share`).
    pub inside: bool,
}

impl HeatLaws {
    /// Conduction by the overlap alone.
    pub fn contacts(conduction: Box<dyn Conduction>) -> Self {
        Self {
            conduction,
            area: ContactArea::Overlap,
            gap: Box::new(calcine_physics::conduction::NoGap),
            radiates: false,
            inside: false,
        }
    }

    /// The widest gap in m across which spheres of up to a radius in m exchange heat by conduction.
    pub fn reach(&self, radius: f64) -> f64 {
        let walls = self.gap.reach([radius, f64::INFINITY]);
        self.gap
            .reach([radius; 2])
            .max(walls)
            .max(self.area.within())
    }
}

/// Conductances between particles, and to reservoirs.
#[derive(Debug)]
pub struct HeatNetwork {
    laws: HeatLaws,
    materials: Vec<ThermalProperties>,
    /// Index of the material of each particle.
    material: Vec<usize>,
    /// Index of the material of each reservoir that is a wall.
    walls: Vec<usize>,
    pairs: Vec<NeighbourPair>,
    wall_touches: Vec<NeighbourWall>,
    radiation: Radiation,
    /// By how much in K each surface radiates as a warmer one than its mean over the span, the fourth root of the mean of the
    /// fourth powers, as it was in the last attempt; empty where none said so.
    warmer: Vec<f64>,
    /// Heat into each particle from the others and from reservoirs in W.
    pub heat: Vec<f64>,
    /// Heat from each reservoir into the particles in W.
    pub reservoir_heat: Vec<f64>,
    /// Temperature of each body in K.
    pub body_temperature: Vec<f64>,
    /// Conductance in W/K that the network adds to each surface, all else staying as warm as it is.
    pub stiffness: Vec<f64>,
    work: Work,
}

/// Scratch of an attempt.
#[derive(Debug, Default)]
struct Work {
    solver: NetworkSolver,
    /// Of each pair that touches in W/K.
    conductance: Vec<f64>,
    /// Pairs of nodes with their conductance in W/K; contacts first.
    bonds: Vec<([usize; 2], f64)>,
    /// Node and reservoir with their conductance in W/K; contacts first.
    reservoir_links: Vec<([usize; 2], f64)>,
    /// Temperatures of the reservoirs in K, of those that are parts of bodies that of the last iterate.
    reservoirs: Vec<f64>,
    capacity: Vec<f64>,
    old: Vec<f64>,
    sink_conductance: Vec<f64>,
    drive: Vec<f64>,
    temperature: Vec<f64>,
    /// The same of surfaces that radiate as warmer ones.
    seen: Vec<f64>,
    /// Mean temperatures in K, and fourth powers that surfaces radiate by in K⁴, while heat is booked by means.
    kelvin: Vec<f64>,
    shines: Vec<f64>,
    last: Vec<f64>,
    means: SpanMeans,
    /// How many of the bonds and links are contacts, and how many nodes are particles'.
    solid: usize,
    walled: usize,
    nodes: usize,
    lines: Vec<SurfaceLine>,
    last_lines: Vec<SurfaceLine>,
}

/// How the iteration of a network ended.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum NetworkOutcome {
    /// Lines, radiation and temperatures agree.
    #[default]
    Settled,
    /// The iteration over lines and radiation ended at its limit.
    Unsettled {
        /// Largest relative change of a temperature in the last iteration.
        change: f64,
        /// The particle that has it.
        row: usize,
    },
    /// The linear solver ended at its limit, or with NaN.
    Unsolved {
        /// Residual over that at the temperatures of the start.
        residual: f64,
    },
}

/// Changes of temperature below this share end the iteration over radiation and heat capacity.
const SETTLED: f64 = 1e-10;
/// Iterations at most; each shortens the change at least to a half in all but made-up cases.
const ITERATIONS: usize = 60;

impl HeatNetwork {
    /// A network without particles yet: laws, materials, and the material of each wall that is a reservoir.
    pub fn new(laws: HeatLaws, materials: Vec<ThermalProperties>, walls: Vec<usize>) -> Self {
        Self {
            laws,
            heat: Vec::new(),
            reservoir_heat: Vec::new(),
            body_temperature: Vec::new(),
            stiffness: Vec::new(),
            materials,
            material: Vec::new(),
            walls,
            pairs: Vec::new(),
            wall_touches: Vec::new(),
            radiation: Radiation::default(),
            warmer: Vec::new(),
            work: Work::default(),
        }
    }

    /// Particles that go, by their rows in ascending order, and come, each of a radius in m and a material; all
    /// contacts are forgotten. Exchange areas of those that stay hold; those that come have none with others until
    /// areas are found anew.
    pub fn change(&mut self, gone: &[usize], new: &[(f64, usize)]) {
        let come: Vec<(f64, f64)> = new
            .iter()
            .map(|&(radius, material)| (radius, self.materials[material].emissivity))
            .collect();
        self.radiation.change(gone, &come);
        without(&mut self.material, gone);
        self.material.extend(new.iter().map(|one| one.1));
        self.heat = vec![0.0; self.material.len()];
        self.warmer.clear();
        self.pairs.clear();
        self.wall_touches.clear();
    }

    /// The heat of the last attempt is no longer that of the coming one.
    pub fn begin(&mut self) {
        self.heat.fill(0.0);
        self.reservoir_heat.fill(0.0);
        self.warmer.clear();
    }

    /// Takes up what the particles meet at their present places.
    pub fn set_neighbours(&mut self, neighbours: &Neighbours<'_>) {
        self.pairs.clear();
        self.pairs.extend_from_slice(neighbours.pairs);
        self.wall_touches.clear();
        self.wall_touches.extend_from_slice(neighbours.walls);
        if let Some(views) = neighbours.views {
            self.set_views(views);
        }
    }

    /// Takes up whom the particles see.
    pub fn set_views(&mut self, views: &ExchangeAreas) {
        if self.laws.radiates {
            let emissivity = |&k: &usize| self.materials[k].emissivity;
            self.radiation = Radiation::new(views, self.material.iter().map(emissivity).collect());
        }
    }

    /// The views that hold: as they were taken up, of the particles that are there.
    pub fn views(&self) -> &ExchangeAreas {
        self.radiation.views()
    }

    /// True where no heat can flow.
    pub fn is_empty(&self) -> bool {
        self.pairs.is_empty() && self.wall_touches.is_empty() && self.radiation.is_empty()
    }

    /// Sets `heat` to that of an implicit step: surface temperatures T, means over the span, with
    /// k_i (T_i − T_i,free) = Σ_j G_ij (T_j − T_i), where `lines` fills k and T_free of all particles about given
    /// surface temperatures in K at the end of the span; `start` holds those of the last commit in K, by which conductivities
    /// go.
    pub fn solve<E>(
        &mut self,
        start: &[f64],
        surroundings: &NetworkSurroundings<'_>,
        mut lines: impl FnMut(&[f64], &mut [SurfaceLine]) -> Result<(), E>,
    ) -> Result<NetworkOutcome, E> {
        let count = start.len();
        self.conduct(start, surroundings);
        if self.laws.inside {
            let (materials, material) = (&self.materials, &self.material);
            self.radiation.limit(|p, diameter| {
                let of = &materials[material[p]];
                let conductivity = of.conductivity.at(start[p]);
                conducted_share(of.emissivity, conductivity, diameter, start[p])
            });
        }
        let work = &mut self.work;
        let (solid, walled) = (work.bonds.len(), work.reservoir_links.len());
        (work.solid, work.walled) = (solid, walled);
        let nodes = count + self.radiation.radiosities();
        work.nodes = nodes;
        let bodies = &surroundings.bodies;
        let all = nodes + bodies.start.len();
        work.reservoirs.clear();
        work.reservoirs.extend_from_slice(surroundings.reservoirs);
        work.temperature.clear();
        work.temperature.extend_from_slice(start);
        work.temperature.extend_from_slice(&start[..nodes - count]);
        work.temperature.extend_from_slice(bodies.start);
        work.lines.clear();
        work.lines.resize(count, SurfaceLine::default());
        work.means.begin(start);
        let mut outcome = NetworkOutcome::Settled;
        for iteration in 0..ITERATIONS {
            work.last_lines.clone_from(&work.lines);
            lines(&work.means.end, &mut work.lines)?;
            // Without radiation only the lines can bend.
            let bends = !self.radiation.is_empty() || all > nodes;
            if iteration > 0 && !bends && work.lines == work.last_lines {
                outcome = NetworkOutcome::Settled;
                break;
            }
            for (reservoir, kelvin) in work.reservoirs.iter_mut().enumerate() {
                if let Some(body) = bodies.of_reservoir(reservoir) {
                    *kelvin = work.temperature[nodes + body];
                }
            }
            work.bonds.truncate(solid);
            work.reservoir_links.truncate(walled);
            work.seen.clone_from(&work.temperature);
            warm(&mut work.seen, &self.warmer);
            self.radiation.linearise(
                &work.seen,
                &work.reservoirs,
                &mut work.bonds,
                &mut work.reservoir_links,
            );
            let shift = nodes - count;
            work.means
                .weigh(&work.lines, &work.bonds, &work.reservoir_links, shift);
            work.capacity.clear();
            work.old.clear();
            for line in work.means.lines(&work.lines, start) {
                work.capacity.push(line.conductance);
                work.old.push(line.temperature);
            }
            work.capacity.resize(nodes, 0.0);
            work.old.extend_from_slice(&start[..shift]);
            for (body, kelvin) in work.temperature[nodes..].iter().enumerate() {
                let line = (bodies.line)(body, *kelvin);
                work.capacity.push(line.conductance);
                work.old.push(line.temperature);
            }
            work.sink_conductance.clear();
            work.sink_conductance.resize(all, 0.0);
            work.drive.clear();
            work.drive.resize(all, 0.0);
            let warmer = |node: usize| self.warmer.get(node).copied().unwrap_or_default();
            if !self.warmer.is_empty() {
                for &([i, j], g) in &work.bonds[solid..] {
                    let more = g * (warmer(j) - warmer(i));
                    work.drive[i] += more;
                    work.drive[j] -= more;
                }
            }
            for (link, &([node, reservoir], g)) in work.reservoir_links.iter().enumerate() {
                let more = if link < walled { 0.0 } else { g * warmer(node) };
                work.drive[node] -= more;
                if let Some(body) = bodies.of_reservoir(reservoir) {
                    work.bonds.push(([node, nodes + body], g));
                    work.drive[nodes + body] += more;
                    continue;
                }
                work.sink_conductance[node] += g;
                work.drive[node] += g * (surroundings.reservoirs[reservoir] - work.old[node]);
            }
            work.last.clone_from(&work.temperature);
            let system = NetworkSystem {
                bonds: &work.bonds,
                capacity: &work.capacity,
                old: &work.old,
                sink_conductance: &work.sink_conductance,
                drive: &work.drive,
            };
            if let Err(unsolved) = work.solver.solve(&system, &mut work.temperature) {
                let residual = unsolved.residual;
                outcome = NetworkOutcome::Unsolved { residual };
                break;
            }
            work.means.advance(start, &work.temperature);
            let [now, last] = [&work.temperature, &work.last].map(|all| all.split_at(nodes));
            outcome = compare(now.0, last.0, count);
            let stays = compare(now.1, last.1, 0) == NetworkOutcome::Settled;
            if outcome == NetworkOutcome::Settled && stays {
                break;
            }
        }
        self.body_temperature.clear();
        self.body_temperature
            .extend_from_slice(&work.temperature[nodes..]);
        for (reservoir, kelvin) in work.reservoirs.iter_mut().enumerate() {
            if let Some(body) = bodies.of_reservoir(reservoir) {
                *kelvin = self.body_temperature[body];
            }
        }
        self.book(count);
        Ok(outcome)
    }

    /// Heat over every bond and link to a reservoir, the same on both of its sides.
    fn book(&mut self, count: usize) {
        let work = &mut self.work;
        work.seen.clone_from(&work.temperature);
        warm(&mut work.seen, &self.warmer);
        let (solid, walled, nodes) = (work.solid, work.walled, work.nodes);
        let reservoirs = &work.reservoirs;
        let of = |contact: bool| match contact {
            true => &work.temperature,
            false => &work.seen,
        };
        self.heat.clear();
        self.heat.resize(count, 0.0);
        self.reservoir_heat.clear();
        self.reservoir_heat.resize(reservoirs.len(), 0.0);
        self.stiffness.clear();
        self.stiffness.resize(count, 0.0);
        let row = |node: usize| if node < count { node } else { node - count };
        for (k, &([i, j], g)) in work.bonds.iter().enumerate() {
            for node in [i, j] {
                if let Some(own) = self.stiffness.get_mut(node) {
                    *own += g;
                }
            }
            // A surface and its own radiosity are one particle; bonds to bodies are links to their reservoirs.
            if (row(i) == row(j) && k >= solid) || j >= nodes {
                continue;
            }
            let kelvin = of(k < solid);
            let flow = g * (kelvin[j] - kelvin[i]);
            self.heat[row(i)] += flow;
            self.heat[row(j)] -= flow;
        }
        for (k, &([node, reservoir], g)) in work.reservoir_links.iter().enumerate() {
            if let Some(own) = self.stiffness.get_mut(node) {
                *own += g;
            }
            let flow = g * (reservoirs[reservoir] - of(k < walled)[node]);
            self.heat[row(node)] += flow;
            self.reservoir_heat[reservoir] += flow;
        }
        // The network follows the mean over the span, which a temperature at its end moves by that share.
        for (own, share) in self.stiffness.iter_mut().zip(&work.means.share) {
            *own *= share;
        }
    }
}

/// Adds to the first temperatures in K what they are warmer.
fn warm(kelvin: &mut [f64], warmer: &[f64]) {
    for (kelvin, more) in kelvin.iter_mut().zip(warmer) {
        *kelvin += more;
    }
}

/// Whether temperatures in K of all nodes, two of each particle at most, are those of the iteration before.
fn compare(now: &[f64], last: &[f64], count: usize) -> NetworkOutcome {
    let mut outcome = NetworkOutcome::Settled;
    let mut largest = 0.0;
    for (node, (now, last)) in now.iter().zip(last).enumerate() {
        let moved = (now - last).abs();
        let settled = moved <= SETTLED * last.abs();
        let change = moved / last.abs();
        if !settled && (change > largest || change.is_nan()) {
            largest = change;
            let row = if node < count { node } else { node - count };
            outcome = NetworkOutcome::Unsettled { change, row };
        }
    }
    outcome
}

/// A black material of a conductivity in W/m/K.
#[cfg(test)]
pub(crate) fn plain(conductivity: f64) -> ThermalProperties {
    let stiffness = Stiffness {
        young: 1e9,
        poisson: 0.3,
    };
    ThermalProperties {
        conductivity: Conductivity::constant(conductivity),
        emissivity: 1.0,
        density: 2500.0,
        soft: stiffness,
        real: stiffness,
    }
}

#[cfg(test)]
mod tests;
