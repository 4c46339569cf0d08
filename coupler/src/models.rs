//! The models of all particles of a run: which row of the run is which row of which model.
//!
//! Every population has one model. What the coordinator asks of all particles is gathered from the models and put
//! back row by row, in the order of the run's rows, which are in ascending id.

mod columns;
mod error;
mod merged_column;

use calcine_interior::{
    At, Channel, GasLines, Inventory, NetworkHeat, Newcomer, ParticleModel, SurfaceLine,
    SurfaceMean, Surroundings, TEMPERATURE, Tally, Transfer, without,
};
use calcine_physics::film::FilmCoefficient;
use calcine_physics::thermo::Element;

pub use columns::ParticleColumn;
pub(crate) use columns::amounts;
use error::named;
pub use error::{ParticleModelError, RestoreError};
use merged_column::{MergedColumn, merge};

use crate::excursion::Excursion;
use crate::part::ParticleFields;

/// Models of all particles.
#[derive(Default)]
pub struct ParticleModels {
    members: Vec<Member>,
    /// The model of each population.
    model_of: Vec<usize>,
    /// Model, and row in it, of each row of the run.
    places: Vec<(usize, usize)>,
    /// Id of each row of the run.
    id: Vec<u64>,
    /// Number of real particles that each row of the run stands for.
    weight: Vec<f64>,
    /// Channels of all models; those that are the same in several stand once.
    channels: Vec<Channel>,
    columns: Vec<MergedColumn>,
    /// Surface temperatures at the last commit in K.
    temperature: Vec<f64>,
}

/// A model with the rows of the run that it has.
struct Member {
    model: Box<dyn ParticleModel>,
    /// Its rows in the run.
    rows: Vec<usize>,
    /// Its own rows by their statistical weights.
    alike: Vec<(f64, Vec<usize>)>,
    /// Where its channels stand among all.
    channels: Vec<usize>,
    work: Work,
}

/// What a model is told and tells of its own rows.
#[derive(Default)]
struct Work {
    inputs: [Vec<f64>; 6],
    films: Vec<FilmCoefficient>,
    network: Vec<NetworkHeat>,
    rates: Vec<f64>,
    surface: Vec<SurfaceLine>,
    lines: GasLines,
}

/// A particle that comes in, for its population's model.
#[derive(Clone, Copy, Debug)]
pub struct PopulationNewcomer<'a> {
    /// Index of its population.
    pub population: usize,
    /// Number of real particles that it stands for.
    pub weight: f64,
    /// What the model is told.
    pub particle: Newcomer<'a>,
}

impl ParticleModels {
    /// Models without particles yet, and the model of each population. The columns of models that have the same name
    /// must agree in unit, type and shape.
    pub fn new(
        models: Vec<Box<dyn ParticleModel>>,
        model_of: Vec<usize>,
    ) -> Result<Self, ParticleModelError> {
        if let Some(population) = model_of.iter().position(|&k| k >= models.len()) {
            return Err(ParticleModelError::Population { population });
        }
        let columns = merge(&models)?;
        let mut channels: Vec<Channel> = Vec::new();
        let mut members = Vec::new();
        for model in models {
            let mut places: Vec<usize> = Vec::new();
            for own in model.channels() {
                let same = |(k, other): (usize, &Channel)| {
                    (other.key, &other.mass) == (own.key, &own.mass) && !places.contains(&k)
                };
                let found = channels.iter().enumerate().position(same);
                places.push(found.unwrap_or(channels.len()));
                if found.is_none() {
                    channels.push(own.clone());
                }
            }
            members.push(Member {
                model,
                rows: Vec::new(),
                alike: Vec::new(),
                channels: places,
                work: Work::default(),
            });
        }
        Ok(Self {
            members,
            model_of,
            channels,
            columns,
            ..Self::default()
        })
    }

    /// Number of particles.
    pub fn len(&self) -> usize {
        self.places.len()
    }

    /// True where there is no particle.
    pub fn is_empty(&self) -> bool {
        self.places.is_empty()
    }

    /// Channels of all models.
    pub fn channels(&self) -> &[Channel] {
        &self.channels
    }

    /// Elements that the models count, in the order of [`Element::ALL`].
    pub fn elements(&self) -> Vec<Element> {
        let held: Vec<Element> = self
            .members
            .iter()
            .flat_map(|member| member.model.elements())
            .collect();
        let all = Element::ALL.into_iter();
        all.filter(|element| held.contains(element)).collect()
    }

    /// Surface temperature of each particle at the last commit in K.
    pub fn temperature(&self) -> &[f64] {
        &self.temperature
    }

    /// Particles at temperatures for which the properties of their material are not given, by their rows.
    pub fn temperature_excursion(&self) -> Excursion {
        let mut found = Excursion::default();
        for member in &self.members {
            let range = member.model.temperature_range();
            if range != (0.0, f64::INFINITY) {
                let rows = member.rows.iter();
                rows.for_each(|&row| found.look(row, self.temperature[row], range));
            }
        }
        found
    }

    /// Takes the masses of particles that their models change, in kg.
    pub fn masses(&self, of: &mut [f64]) {
        self.members.iter().for_each(|member| {
            scatter(&member.rows, member.model.bodies(At::Commit).mass, of);
        });
    }

    /// Takes the radii of particles that their models change, in m.
    pub fn radii(&self, of: &mut [f64]) {
        self.members.iter().for_each(|member| {
            scatter(&member.rows, member.model.bodies(At::Commit).radius, of);
        });
    }

    /// True where some model changes the radius of its particles.
    pub fn change_sizes(&self) -> bool {
        let mut members = self.members.iter();
        members.any(|member| !member.model.bodies(At::Commit).radius.is_empty())
    }

    /// True where some model changes mass or radius of its particles.
    pub fn change_bodies(&self) -> bool {
        let mut members = self.members.iter();
        members.any(|member| !member.model.bodies(At::Commit).mass.is_empty())
            || self.change_sizes()
    }

    /// Takes in all particles of a run, with their masses in kg and temperatures in K.
    pub fn fill(
        &mut self,
        particles: &ParticleFields<'_>,
        mass: &[f64],
        temperature: &[f64],
    ) -> Result<(), ParticleModelError> {
        let states: Vec<[(&str, &[f64]); 1]> = temperature
            .chunks_exact(1)
            .map(|kelvin| [(TEMPERATURE, kelvin)])
            .collect();
        let new: Vec<PopulationNewcomer<'_>> = states
            .iter()
            .enumerate()
            .map(|(row, state)| PopulationNewcomer {
                population: particles.population[row] as usize,
                weight: particles.weight_of(row),
                particle: Newcomer {
                    id: particles.id[row],
                    mass: mass[row],
                    radius: particles.radius[row],
                    state,
                },
            })
            .collect();
        self.change(&[], &new)
    }

    /// Fills the line of each surface about surface temperatures in K; see [`ParticleModel::surface`].
    pub fn surface(
        &mut self,
        around: &Surroundings<'_>,
        span: f64,
        at: &[f64],
        out: &mut [SurfaceLine],
    ) -> Result<(), ParticleModelError> {
        let (count, id) = (self.places.len(), &self.id);
        for Member {
            model, rows, work, ..
        } in &mut self.members
        {
            let Work {
                inputs,
                films,
                surface,
                ..
            } = work;
            let [first, rest @ ..] = inputs;
            let own = gathered(rows, count, around, (rest, films));
            let mut buffer = std::mem::take(first);
            let at = gather(rows, count, at, &mut buffer);
            surface.clear();
            surface.resize(rows.len(), SurfaceLine::default());
            let done = model.surface(&own, span, at, surface);
            for (row, line) in rows.iter().zip(&*surface) {
                out[*row] = *line;
            }
            work.inputs[0] = buffer;
            done.map_err(|cause| named(cause, rows, id))?;
        }
        Ok(())
    }

    /// Fills the lines to the gas of all particles and channels; see [`ParticleModel::respond`].
    pub fn respond(
        &mut self,
        around: &Surroundings<'_>,
        span: f64,
        network: &[NetworkHeat],
        out: &mut GasLines,
    ) -> Result<(), ParticleModelError> {
        let (count, id) = (self.places.len(), &self.id);
        let all = self.channels.len();
        out.reset(count, all);
        for Member {
            model,
            rows,
            channels,
            work,
            ..
        } in &mut self.members
        {
            let [_, rest @ ..] = &mut work.inputs;
            let own = gathered(rows, count, around, (rest, &mut work.films));
            let network = gather(rows, count, network, &mut work.network);
            let lines = &mut work.lines;
            lines.reset(rows.len(), channels.len());
            let done = model.respond(&own, span, network, lines);
            scatter(rows, &lines.conductance, &mut out.conductance);
            scatter(rows, &lines.temperature, &mut out.temperature);
            scatter(rows, &lines.released, &mut out.released);
            for (from, to) in [
                (&lines.slope, &mut out.slope),
                (&lines.offset, &mut out.offset),
                (&lines.local_slope, &mut out.local_slope),
            ] {
                for (own, row) in rows.iter().enumerate() {
                    for (c, channel) in channels.iter().enumerate() {
                        to[row * all + channel] = from[own * channels.len() + c];
                    }
                }
            }
            done.map_err(|cause| named(cause, rows, id))?;
        }
        Ok(())
    }

    /// Means of the surfaces of all rows in the last attempt; see [`ParticleModel::surface_mean`].
    pub fn surface_means(&self, out: &mut Vec<Option<SurfaceMean>>) {
        out.clear();
        let rows = self.places.iter();
        out.extend(rows.map(|&(model, own)| self.members[model].model.surface_mean(own)));
    }

    /// Lowers the rates of all channels to what the particles hold; see [`ParticleModel::limit`].
    pub fn limit(&mut self, rates: &mut [f64], span: f64) {
        let all = self.channels.len();
        for member in &mut self.members {
            member.take_rates(rates, all);
            member.model.limit(&mut member.work.rates, span);
            let width = member.channels.len();
            for (own, row) in member.rows.iter().enumerate() {
                for (c, channel) in member.channels.iter().enumerate() {
                    rates[row * all + channel] = member.work.rates[own * width + c];
                }
            }
        }
    }

    /// Forgets the attempts since the last commit; see [`ParticleModel::begin_again`].
    pub fn begin_again(&mut self) {
        for member in &mut self.members {
            member.model.begin_again();
        }
    }

    /// Ends the attempt with what passed; see [`ParticleModel::settle`].
    pub fn settle(&mut self, took: &Transfer<'_>, span: f64) -> Result<(), ParticleModelError> {
        let (count, all, id) = (self.places.len(), self.channels.len(), &self.id);
        for member in &mut self.members {
            member.take_rates(took.rates, all);
            let Member {
                model, rows, work, ..
            } = member;
            let [heat, network, carried, ..] = &mut work.inputs;
            let own = Transfer {
                heat: gather(rows, count, took.heat, heat),
                network: gather(rows, count, took.network, network),
                carried: gather(rows, count, took.carried, carried),
                rates: &work.rates,
            };
            model
                .settle(&own, span)
                .map_err(|cause| named(cause, rows, id))?;
        }
        Ok(())
    }

    /// What the last attempt changed in all particles, those of a row as many times as it stands for.
    pub fn changed(&self) -> Inventory {
        let mut all = Inventory::default();
        for member in &self.members {
            for (weight, rows) in &member.alike {
                all.add_times(*weight, &member.model.changed(rows));
            }
        }
        all
    }

    /// True where something outside may give particles heat, as where their temperature is prescribed.
    pub fn prescribe(&self) -> bool {
        self.members.iter().any(|member| member.model.prescribes())
    }

    /// Heat in J that something outside of the computation gave all particles in the last attempt.
    pub fn supplied(&self) -> Tally {
        let mut all = Tally::default();
        for member in &self.members {
            for (weight, rows) in &member.alike {
                all += member.model.supplied(rows) * *weight;
            }
        }
        all
    }

    /// What the particles of these rows hold, those of a row as many times as it stands for.
    pub fn held(&self, rows: impl IntoIterator<Item = usize>) -> Inventory {
        let mut own = vec![Vec::new(); self.members.len()];
        for row in rows {
            let (model, place) = self.places[row];
            own[model].push((self.weight[row], place));
        }
        let mut all = Inventory::default();
        for (member, rows) in self.members.iter().zip(own) {
            for (weight, rows) in &alike(rows) {
                all.add_times(*weight, &member.model.held(rows));
            }
        }
        all
    }

    /// Takes the last attempt as the new start; the rows, ascending, of particles that are used up.
    pub fn commit(&mut self) -> Vec<usize> {
        let mut used_up: Vec<usize> = Vec::new();
        for member in &mut self.members {
            let gone = member.model.commit();
            used_up.extend(gone.iter().map(|&own| member.rows[own]));
        }
        used_up.sort_unstable();
        self.note_temperatures();
        used_up
    }

    /// Takes particles out, by their rows in ascending order, and puts new ones behind the others, in ascending id.
    pub fn change(
        &mut self,
        gone: &[usize],
        new: &[PopulationNewcomer<'_>],
    ) -> Result<(), ParticleModelError> {
        let mut out = vec![Vec::new(); self.members.len()];
        for &row in gone {
            let (model, place) = self.places[row];
            out[model].push(place);
        }
        let mut come: Vec<Vec<Newcomer<'_>>> = vec![Vec::new(); self.members.len()];
        without(&mut self.places, gone);
        without(&mut self.id, gone);
        without(&mut self.weight, gone);
        for one in new {
            let population = one.population;
            let model = self.model_of.get(population);
            let &model = model.ok_or(ParticleModelError::Population { population })?;
            come[model].push(one.particle);
            self.places.push((model, 0));
            self.id.push(one.particle.id);
            self.weight.push(one.weight);
        }
        self.number_rows();
        for ((member, gone), new) in self.members.iter_mut().zip(&out).zip(&come) {
            if !(gone.is_empty() && new.is_empty()) {
                let done = member.model.change(gone, new);
                done.map_err(|cause| named(cause, &member.rows, &self.id))?;
            }
        }
        self.note_temperatures();
        Ok(())
    }

    /// Numbers the rows of each model anew.
    fn number_rows(&mut self) {
        self.members
            .iter_mut()
            .for_each(|member| member.rows.clear());
        for (row, (model, place)) in self.places.iter_mut().enumerate() {
            let rows = &mut self.members[*model].rows;
            *place = rows.len();
            rows.push(row);
        }
        for member in &mut self.members {
            let own = member.rows.iter().enumerate();
            let own = own.map(|(place, &row)| (self.weight[row], place));
            member.alike = alike(own.collect());
        }
    }

    fn note_temperatures(&mut self) {
        self.temperature.resize(self.places.len(), 0.0);
        for member in &self.members {
            let temperature = member.model.bodies(At::Commit).temperature;
            scatter(&member.rows, temperature, &mut self.temperature);
        }
    }
}

impl Member {
    /// Gathers the rates of its own rows and channels.
    fn take_rates(&mut self, rates: &[f64], all: usize) {
        self.work.rates.clear();
        for row in &self.rows {
            let own = self.channels.iter().map(|c| rates[row * all + c]);
            self.work.rates.extend(own);
        }
    }
}

impl std::fmt::Debug for ParticleModels {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("ParticleModels")
            .field("models", &self.members.len())
            .field("particles", &self.places.len())
            .finish_non_exhaustive()
    }
}

/// The values of some of so many rows, of as many values each as the list holds of all; nothing is copied where all
/// rows are meant.
fn gather<'a, T: Copy>(
    rows: &[usize],
    count: usize,
    from: &'a [T],
    buffer: &'a mut Vec<T>,
) -> &'a [T] {
    if rows.len() == count || from.is_empty() {
        return from;
    }
    let width = from.len() / count;
    buffer.clear();
    for row in rows {
        buffer.extend_from_slice(&from[row * width..(row + 1) * width]);
    }
    buffer
}

fn gathered<'a>(
    rows: &[usize],
    count: usize,
    around: &Surroundings<'a>,
    (buffers, films): (&'a mut [Vec<f64>; 5], &'a mut Vec<FilmCoefficient>),
) -> Surroundings<'a> {
    let [temperature, pressure, composition, conductance, radius] = buffers;
    Surroundings {
        temperature: gather(rows, count, around.temperature, temperature),
        pressure: gather(rows, count, around.pressure, pressure),
        composition: gather(rows, count, around.composition, composition),
        conductance: gather(rows, count, around.conductance, conductance),
        film: gather(rows, count, around.film, films),
        theory: around.theory,
        radius: gather(rows, count, around.radius, radius),
        end: around.end,
    }
}

/// Puts values of rows back; an empty list leaves them as they are.
fn scatter(rows: &[usize], from: &[f64], to: &mut [f64]) {
    for (row, value) in rows.iter().zip(from) {
        to[*row] = *value;
    }
}

/// Rows by their weights: those of one weight together, in their order.
fn alike(mut rows: Vec<(f64, usize)>) -> Vec<(f64, Vec<usize>)> {
    rows.sort_by(|a, b| a.0.total_cmp(&b.0));
    rows.chunk_by(|a, b| a.0 == b.0)
        .map(|group| (group[0].0, group.iter().map(|one| one.1).collect()))
        .collect()
}
