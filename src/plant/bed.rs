//! A bed of particles as a unit of a plant: a case of its own, followed by a [`Simulation`].

use std::collections::HashMap;
use std::fs;
use std::path::{Path, PathBuf};

use calcine_coupler::coordinator::{CheckpointPaths, Control};
use calcine_flowsheet::{BedCharge, BedExchange, CoupledBed, PlantError, StreamLayout};

use super::collisions::CollisionCount;
use crate::case::plant::{PlantBedSpec, PlantCase};
use crate::error_chain::chain;
use crate::results::files::BEDS;
use crate::simulation::{Simulation, SimulationError};

/// Share of what a bed holds that its particles may gain or lose otherwise than by feeds and outlets.
const SAME: f64 = 1e-9;

/// A bed of a plant.
pub(super) struct PlantBed {
    spec: PlantBedSpec,
    simulation: Simulation,
    collisions: CollisionCount,
    /// Mass in kg and temperature in K with which each particle stood at the last commit, with its population and radius.
    known: HashMap<u64, KnownParticle>,
}

#[derive(Clone, Copy)]
struct KnownParticle {
    population: usize,
    diameter: f64,
    mass: f64,
    temperature: f64,
}

/// The results folder of a bed.
fn folder(plant: &Path, unit: &str) -> PathBuf {
    plant.join(BEDS).join(unit)
}

/// The beds of a plant, at their starts.
pub(super) fn begin(case: &PlantCase, out: &Path) -> Result<Vec<PlantBed>, SimulationError> {
    let all = out.join(BEDS);
    if all.exists() {
        // What is left of a run that ended before its first checkpoint.
        let io = |cause| SimulationError::Io {
            path: all.clone(),
            cause,
        };
        fs::remove_dir_all(&all).map_err(io)?;
    }
    let beds = case.beds.iter();
    beds.map(|spec| PlantBed::open(case, spec, out, false))
        .collect()
}

/// The beds of a plant, where its checkpoint has them after so many windows each.
pub(super) fn resume(
    case: &PlantCase,
    out: &Path,
    windows: &[u64],
) -> Result<Vec<PlantBed>, SimulationError> {
    let beds = case.beds.iter().zip(windows);
    beds.map(|(spec, windows)| {
        let bed = PlantBed::open(case, spec, out, true)?;
        if bed.windows() == *windows {
            return Ok(bed);
        }
        // The plant ended between the bed's checkpoint and its own: the bed's checkpoint before belongs to it.
        drop(bed);
        let own = folder(out, &spec.unit);
        let paths = CheckpointPaths::new(&own);
        let io = |cause| SimulationError::Io {
            path: paths.before(),
            cause,
        };
        fs::remove_dir_all(paths.committed()).map_err(io)?;
        fs::rename(paths.before(), paths.committed()).map_err(io)?;
        PlantBed::open(case, spec, out, true)
    })
    .collect()
}

impl PlantBed {
    fn open(
        case: &PlantCase,
        spec: &PlantBedSpec,
        out: &Path,
        resume: bool,
    ) -> Result<Self, SimulationError> {
        // Beyond the plant's end by the last exchange.
        let end = case.end + 2.0 * spec.interval;
        let simulation = Simulation::open(&spec.case)
            .set(format!("time.end={end:?} s"))
            .out(folder(out, &spec.unit))
            .resume(resume)
            .start()?;
        let mut bed = Self {
            collisions: CollisionCount::new(&spec.diameters, spec.gap),
            spec: spec.clone(),
            simulation,
            known: HashMap::new(),
        };
        bed.look();
        Ok(bed)
    }

    /// Windows of the bed so far.
    pub fn windows(&self) -> u64 {
        self.simulation.windows()
    }

    /// Writes a checkpoint of the bed.
    pub fn checkpoint(&mut self) -> Result<(), SimulationError> {
        self.simulation.checkpoint()
    }

    /// Ends the bed's run where it stands.
    pub fn stop(&mut self) -> Result<(), SimulationError> {
        self.simulation.stop().map(|_| ())
    }

    /// Remembers the particles as they stand.
    fn look(&mut self) {
        let state = self.simulation.state();
        let rows = 0..state.particles.len();
        self.known = rows
            .map(|row| {
                let one = KnownParticle {
                    population: state
                        .particles
                        .population
                        .get(row)
                        .map_or(0, |p| *p as usize),
                    diameter: 2.0 * state.particles.radius[row],
                    mass: state.particles.weight_of(row) * state.particle_mass[row],
                    temperature: state.particle_temperature[row],
                };
                (state.particles.id[row], one)
            })
            .collect();
    }

    /// Adds a particle to a row of the layout.
    fn add(
        &self,
        layout: &StreamLayout,
        one: &KnownParticle,
        row: &mut [f64],
    ) -> Result<(), String> {
        let edges = layout.grid().edges();
        let (from, to) = layout.grid().range();
        if one.diameter < from || one.diameter > to {
            return Err(format!(
                "a particle of {} m lies outside of the size grid, {from} m to {to} m; widen `sizes`",
                one.diameter
            ));
        }
        let class = edges.partition_point(|edge| *edge <= one.diameter).max(1) - 1;
        let class = class.min(layout.grid().classes() - 1);
        let compound = self.spec.compounds[one.population];
        row[class * layout.inner() + compound] += one.mass;
        row[layout.enthalpy()] += enthalpy(layout, compound, one.mass, one.temperature);
        Ok(())
    }

    fn held(&self, layout: &StreamLayout) -> Result<Vec<f64>, String> {
        let mut row = vec![0.0; layout.width()];
        let mut ids: Vec<&u64> = self.known.keys().collect();
        ids.sort_unstable();
        for id in ids {
            self.add(layout, &self.known[id], &mut row)?;
        }
        Ok(row)
    }

    /// What waits, by the classes of the feeds that take it; else what no feed takes.
    fn sorted(&self, layout: &StreamLayout, waiting: &[f64]) -> Result<Vec<f64>, String> {
        let mut row = vec![0.0; layout.width()];
        row[layout.enthalpy()] = waiting[layout.enthalpy()];
        let total = layout.mass_flow(waiting);
        let d = layout.grid().diameters();
        for (place, mass) in waiting[..layout.enthalpy()].iter().enumerate() {
            if *mass == 0.0 {
                continue;
            }
            if place >= layout.solids() {
                if mass.abs() <= 1e-12 * total {
                    row[place] += mass;
                    continue;
                }
                let compounds = layout.compounds();
                let rest = place - layout.solids();
                let phase = match rest < compounds.len() {
                    true => "liquid",
                    false => "vapour",
                };
                return Err(format!(
                    "{phase} {} flows in, which a bed of particles does not take; separate it before, by a dryer or a cyclone",
                    compounds[rest % compounds.len()].name
                ));
            }
            let (class, compound) = (place / layout.inner(), place % layout.inner());
            let apart = |diameter: f64| (diameter / d[class]).ln().abs();
            let feeds = self
                .spec
                .feeds
                .iter()
                .filter(|feed| feed.compound == compound);
            let feed = feeds.min_by(|a, b| {
                let own = |feed: &crate::case::plant::PlantBedFeed| feed.class != class;
                let nearer = apart(a.diameter).total_cmp(&apart(b.diameter));
                own(a).cmp(&own(b)).then(nearer)
            });
            let Some(feed) = feed else {
                return Err(format!(
                    "{} flows in, which no feed of the bed takes; add a feed of this material to it, or keep it away",
                    layout.compounds()[compound].name
                ));
            };
            row[feed.class * layout.inner() + compound] += mass;
        }
        Ok(row)
    }

    fn follow(&mut self, charge: &BedCharge<'_>) -> Result<BedExchange, String> {
        let layout = charge.layout;
        let told = |error: SimulationError| chain(&error);
        let mut waiting = self.sorted(layout, charge.waiting)?;
        let temperature = layout.temperature(&waiting);
        let begun = self.simulation.time();
        let span = charge.until - begun;
        let mut rates = Vec::new();
        for (feed, due) in self.spec.feeds.clone().iter().zip(charge.due) {
            let waits = waiting[feed.class * layout.inner() + feed.compound];
            // A feed gives a particle as soon as half of it is due: half a particle is kept back, so that none is given before
            // it is there.
            let given = (waits - 0.5 * feed.largest - due).max(0.0);
            let rate = if span > 0.0 { given / span } else { 0.0 };
            self.simulation
                .set_feed_rate(&feed.name, rate)
                .map_err(told)?;
            if let Some(temperature) = temperature.filter(|_| waits > 0.0) {
                let set = Control::FeedTemperature {
                    feed: feed.name.clone(),
                    temperature,
                };
                self.simulation.set(set).map_err(told)?;
            }
            rates.push(rate);
        }
        let mut due = charge.due.to_vec();
        let mut left = vec![0.0; layout.width()];
        let (mut heat, mut fed, mut gone) = (0.0, 0.0, 0.0);
        let before = self.held(layout)?;
        while self.simulation.time() < charge.until {
            let start = self.simulation.time();
            let motion = self.simulation.motion_time();
            let ended = self.simulation.step().map_err(told)?;
            let span = self.simulation.time() - start;
            if ended.is_some() || span <= 0.0 {
                return Err("its run ended before that of the plant; `calcine report` of its folder says more".into());
            }
            let state = self.simulation.state();
            let rows = 0..state.particles.len();
            let into = rows
                .clone()
                .map(|row| state.particles.weight_of(row) * state.particle_heat[row]);
            heat += span * (into.sum::<f64>() + state.reservoir_heat.iter().sum::<f64>());
            let moved = self.simulation.motion_time() - motion;
            let periodicity = state.mesh.periodicity();
            self.collisions
                .add(&state.particles, periodicity, span, span / moved);
            let mut old = std::mem::take(&mut self.known);
            self.look();
            let new: Vec<u64> = state_ids(&self.simulation);
            for id in &new {
                if old.remove(id).is_none() {
                    let one = self.known[id];
                    let places = self
                        .spec
                        .feeds
                        .iter()
                        .position(|f| f.population == one.population);
                    let Some(place) = places else { continue };
                    let feed = &self.spec.feeds[place];
                    waiting[feed.class * layout.inner() + feed.compound] -= one.mass;
                    let temperature = temperature.unwrap_or(one.temperature);
                    waiting[layout.enthalpy()] -=
                        enthalpy(layout, feed.compound, one.mass, temperature);
                    due[place] -= one.mass;
                    fed += one.mass;
                }
            }
            let mut ids: Vec<u64> = old.keys().copied().collect();
            ids.sort_unstable();
            for id in ids {
                self.add(layout, &old[&id], &mut left)?;
                gone += old[&id].mass;
            }
        }
        let took = self.simulation.time() - begun;
        due.iter_mut()
            .zip(&rates)
            .for_each(|(due, rate)| *due += rate * took);
        let held = self.held(layout)?;
        let [was, is] = [&before, &held].map(|row| layout.mass_flow(row));
        let open = (is - was - fed + gone).abs();
        if open > SAME * (was + is) {
            return Err(format!(
                "its particles gained or lost {open:.3e} kg otherwise than by feeds and outlets; a bed of a plant keeps the mass of its solids: leave reactions and drying out of its case"
            ));
        }
        Ok(BedExchange {
            waiting,
            left,
            held,
            heat,
            due,
            kernel: self.collisions.take(),
        })
    }
}

/// Ids of all particles, ascending.
fn state_ids(simulation: &Simulation) -> Vec<u64> {
    simulation.particles().id.to_vec()
}

/// Enthalpy in J of a solid's mass, as the plant counts it.
fn enthalpy(layout: &StreamLayout, compound: usize, mass: f64, temperature: f64) -> f64 {
    let capacity = layout.compounds()[compound].solid_heat_capacity;
    mass * capacity * (temperature - calcine_flowsheet::REFERENCE_TEMPERATURE)
}

/// A bed that the plant's run holds, and that its checkpoints reach too.
pub(super) type SharedBed = std::sync::Arc<std::sync::Mutex<PlantBed>>;

/// The plant's side of a bed.
pub(super) struct BedOfPlant(pub SharedBed);

impl CoupledBed for BedOfPlant {
    fn content(&self, layout: &StreamLayout, name: &str) -> Result<Vec<f64>, PlantError> {
        let bed = self
            .0
            .lock()
            .unwrap_or_else(std::sync::PoisonError::into_inner);
        bed.held(layout).map_err(|cause| PlantError::Bed {
            unit: name.to_owned(),
            time: bed.simulation.time(),
            cause,
        })
    }

    fn exchange(&mut self, charge: &BedCharge<'_>) -> Result<BedExchange, PlantError> {
        let mut bed = self
            .0
            .lock()
            .unwrap_or_else(std::sync::PoisonError::into_inner);
        bed.follow(charge).map_err(|cause| PlantError::Bed {
            unit: charge.name.to_owned(),
            time: charge.until,
            cause,
        })
    }
}
