//! The particles of a solver at the other end of links, whichever it is.

use std::fmt::Write;
use std::path::Path;
use std::time::Duration;

use calcine_coupler::checkpoint::{StateFile, StateFileError};
use calcine_coupler::error::{FailureKind, PartError};
use calcine_coupler::motion::{Motion, ParticleChanges};
use calcine_coupler::named_columns::NamedColumns;
use calcine_coupler::part::{
    Bed, Part, ParticleFields, ParticlePush, ParticleReceived, Particles, SolverInfo,
};
use calcine_coupler::periodicity::Periodicity;
use calcine_coupler::physics::Vec3;
use calcine_coupler::setup::ParticleSetup;
use calcine_coupler::supervisor::Supervisor;
use calcine_coupler::time::Window;
use calcine_wire::{Catalogue, ColumnSet, Field, Link, MessageKind, WireError};
use thiserror::Error;

use crate::answer::{self, WrongAnswer};
use crate::checkpoint::unusable;
use crate::solver::{ExternalSolver, header};

/// Name of the file with ids and radii in a checkpoint's folder.
const IDENTITY: &str = "identity.state";

/// Ids and radii in m of the particles that a solver starts with: those of a checkpoint where there is one, which may
/// be others than at the start of the run.
pub(crate) fn identity(
    name: &str,
    setup: &ParticleSetup,
    resume: Option<&Path>,
) -> Result<(Vec<u64>, Vec<f64>), PartError> {
    let folder = match resume {
        Some(folder) if folder.join(IDENTITY).is_file() => folder,
        _ => return Ok((setup.id.clone(), setup.radius.clone())),
    };
    let read = || {
        let state = StateFile::read(&folder.join(IDENTITY))?;
        Ok((state.u64s("id")?.to_vec(), state.f64s("radius")?.to_vec()))
    };
    read().map_err(|error: StateFileError| unusable(name, folder, error))
}

/// What is wrong with the particles that a solver starts with, where ids and radii must be these.
pub(crate) fn other_than(
    particles: &LinkedParticles,
    ids: &[u64],
    radii: &[f64],
) -> Option<String> {
    let fields = particles.fields();
    let pairs = ids.iter().zip(radii);
    let mut pairs = pairs.zip(fields.id.iter().zip(fields.radius));
    let ((id, radius), (other, own)) = pairs
        .find(|((id, radius), (other, own))| id != other || radius.to_bits() != own.to_bits())?;
    Some(format!(
        "it starts with particle {other} of radius {own} m where the run has particle {id} of radius {radius} m"
    ))
}

/// A change in the lines of CHANGE, with every digit.
fn change_text(change: &ParticleChanges, weights: bool) -> String {
    let mut text = String::from(if change.rest { "rest\n" } else { "" });
    for id in &change.remove {
        let _ = writeln!(text, "remove {id}");
    }
    for new in &change.insert {
        let _ = write!(text, "insert {} {}", new.id, new.population + 1);
        let values = new.position.iter().chain(new.velocity.iter());
        for value in values.chain([&new.radius, &new.density]) {
            let _ = write!(text, " {value:e}");
        }
        if weights {
            let _ = write!(text, " {:e}", new.weight);
        }
        text.push('\n');
    }
    for new in &change.resize {
        let _ = writeln!(text, "resize {} {:e} {:e}", new.id, new.radius, new.mass);
    }
    text
}

/// True where rows of a link may stand for several particles.
fn has_weights(catalogue: &Catalogue) -> bool {
    catalogue.has(ColumnSet::State, "weight")
}

/// Particles as columns, in ascending id.
#[derive(Clone, Debug, Default)]
struct ReceivedParticles {
    id: Vec<u64>,
    population: Vec<u32>,
    position: Vec<Vec3>,
    velocity: Vec<Vec3>,
    angular_velocity: Vec<Vec3>,
    radius: Vec<f64>,
    mass: Vec<f64>,
    /// Statistical weights; empty where the link has none.
    weight: Vec<f64>,
    impulse: Vec<Vec3>,
    /// What the solver reports beyond all this.
    further: NamedColumns,
    /// Time in s that the window's steps cover.
    acted: f64,
    /// Impulse of walls on all particles in N s; NaN where it is not counted.
    support: Vec3,
    /// By rank: where the particles that it had stand in the columns above, in ascending id.
    places: Vec<Vec<usize>>,
}

/// The particles of a running solver.
pub struct LinkedParticles {
    solver: ExternalSolver,
    about: SolverInfo,
    /// Name in messages.
    name: &'static str,
    committed: ReceivedParticles,
    attempt: ReceivedParticles,
    window: Option<Window>,
    /// True where there is neither a wall nor a held particle.
    alone: bool,
    /// The largest id that the solver can hold.
    largest_id: u64,
    /// Directions in which the domain repeats itself; the solver's places may lie beyond their planes.
    periodicity: Periodicity,
}

impl LinkedParticles {
    /// The particles of a solver that has shaken hands: takes over the state it starts from.
    pub(crate) fn new(
        name: &'static str,
        solver: ExternalSolver,
        setup: &ParticleSetup,
        largest_id: u64,
    ) -> Result<Self, PartError> {
        let hello = solver.hello();
        let other = (0..setup.id.len()).find(|&row| setup.weight_of(row) != 1.0);
        if let Some(row) = other.filter(|_| !has_weights(&hello.catalogue)) {
            let message = format!(
                "its particles stand for themselves alone, but particle {} stands for {}; write weight = 1",
                setup.id[row],
                setup.weight_of(row)
            );
            return Err(solver.refuse(None, message));
        }
        let mut particles = Self {
            about: SolverInfo {
                name: hello.name.clone(),
                version: hello.version.clone(),
                ranks: hello.ranks as usize,
            },
            solver,
            name,
            committed: ReceivedParticles::default(),
            attempt: ReceivedParticles::default(),
            window: None,
            alone: matches!(&setup.motion, Motion::Free(contacts)
                if contacts.walls.is_empty() && !contacts.held.contains(&true)),
            largest_id,
            periodicity: match &setup.motion {
                Motion::Free(contacts) => contacts.periodicity,
                Motion::Frozen | Motion::Parcels(_) => Periodicity::default(),
            },
        };
        particles.committed = particles.read(None)?;
        particles.attempt = particles.committed.clone();
        Ok(particles)
    }

    /// Process id of the solver (or of the `mpirun` above it).
    pub fn pid(&self) -> u32 {
        self.solver.pid()
    }

    /// Process ids of the ranks.
    pub fn rank_pids(&self) -> &[u32] {
        self.solver.rank_pids()
    }

    /// The particles in the messages that the links hold.
    fn read(&self, window: Option<&Window>) -> Result<ReceivedParticles, PartError> {
        let state = ReceivedParticles::read(self.solver.links(), &self.solver.hello().catalogue);
        let mut state = state.map_err(|error| self.solver.failure(window, error))?;
        if !self.periodicity.is_none() {
            for place in &mut state.position {
                *place = self.periodicity.wrap(*place);
            }
        }
        let unordered = state.id.windows(2).find(|pair| pair[0] >= pair[1]);
        if let Some(pair) = unordered {
            let message = format!("particle {} follows particle {}", pair[1], pair[0]);
            return Err(self.solver.refuse(window, message));
        }
        if let Some(found) = state.not_finite() {
            let mut error = self.solver.refuse(window, found.to_string());
            error.kind = FailureKind::NotFinite;
            return Err(error.caused_by(found));
        }
        for link in self.solver.links() {
            let wrong = wrong_answer(link, window);
            let wrong = wrong.map_err(|error| self.solver.failure(window, error))?;
            if let Some(wrong) = wrong {
                return Err(self.solver.wrong(window, wrong));
            }
        }
        Ok(state)
    }
}

/// What is wrong with the state that a rank has sent.
fn wrong_answer(link: &Link, window: Option<&Window>) -> Result<Option<WrongAnswer>, WireError> {
    if let Some(window) = window
        && let Some(wrong) = answer::of_another_attempt(link, window)?
    {
        return Ok(Some(wrong));
    }
    let ids = link.column_words("id")?;
    answer::not_finite(link, |row| format!("particle {}", ids[row]))
}

/// What does not fit the link of pushed columns, for so many particles.
fn misfit(columns: &NamedColumns, taken: &[Field], count: usize) -> Option<String> {
    columns.iter().find_map(|column| {
        let name = column.name;
        let Some(field) = taken.iter().find(|field| field.name == name) else {
            return Some(format!("it takes no column `{name}`"));
        };
        let (found, due) = (column.values.len(), field.components * count);
        (column.components != field.components || found != due).then(|| {
            format!(
                "the column `{name}` has {} values for each of {count} particles, {found} in all; it takes {}, {due} in \
                 all",
                column.components, field.components
            )
        })
    })
}

/// Interleaved numbers as vectors.
fn vectors(numbers: &[f64]) -> impl Iterator<Item = Vec3> {
    numbers.chunks_exact(3).map(|x| Vec3::new(x[0], x[1], x[2]))
}

/// A number that no particle can have.
#[derive(Clone, Copy, Debug, Error, PartialEq)]
#[error("the {what} of particle {id} is {value} {unit}")]
struct NonFiniteParticle {
    what: &'static str,
    id: u64,
    value: f64,
    unit: &'static str,
}

impl ReceivedParticles {
    /// The first particle with a position or velocity that is not finite.
    fn not_finite(&self) -> Option<NonFiniteParticle> {
        self.id.iter().enumerate().find_map(|(row, &id)| {
            let vectors = [
                ("position", self.position[row], "m"),
                ("velocity", self.velocity[row], "m/s"),
                ("angular velocity", self.angular_velocity[row], "rad/s"),
            ];
            vectors.into_iter().find_map(|(what, vector, unit)| {
                let value = *vector.iter().find(|x| !x.is_finite())?;
                Some(NonFiniteParticle {
                    what,
                    id,
                    value,
                    unit,
                })
            })
        })
    }

    /// Joins the columns of all ranks by id.
    fn read(links: &[Link], catalogue: &Catalogue) -> Result<Self, WireError> {
        let mut order = Vec::new();
        for (rank, link) in links.iter().enumerate() {
            let ids = link.column_words("id")?.iter().enumerate();
            order.extend(ids.map(|(row, &id)| (id, rank, row)));
        }
        order.sort_unstable();
        let mut places = vec![Vec::new(); links.len()];
        for (place, &(_, rank, _)) in order.iter().enumerate() {
            places[rank].push(place);
        }
        let words = |name: &str| {
            let columns = links.iter().map(|link| link.column_words(name));
            let columns = columns.collect::<Result<Vec<_>, _>>()?;
            let joined = order.iter().map(|&(_, rank, row)| columns[rank][row]);
            Ok::<Vec<u64>, WireError>(joined.collect())
        };
        let scalars = |name: &str| {
            let bits = words(name)?.into_iter().map(f64::from_bits);
            Ok::<Vec<f64>, WireError>(bits.collect())
        };
        let vectors = |name: &str| {
            let columns = links.iter().map(|link| link.column(name));
            let columns = columns.collect::<Result<Vec<_>, _>>()?;
            let joined = order
                .iter()
                .flat_map(|&(_, rank, row)| vectors(&columns[rank][3 * row..3 * row + 3]));
            Ok::<Vec<Vec3>, WireError>(joined.collect())
        };
        let (mut acted, mut support) = (0.0, Vec3::zeros());
        for link in links {
            if let [time, x, y, z] = *link.column("support")? {
                acted = time;
                support += Vec3::new(x, y, z);
            }
        }
        let mut further = NamedColumns::default();
        for field in catalogue.further(ColumnSet::State) {
            let (name, items) = (field.name.as_str(), field.components);
            let columns = links.iter().map(|link| link.column(name));
            let columns = columns.collect::<Result<Vec<_>, _>>()?;
            let joined = order
                .iter()
                .flat_map(|&(_, rank, row)| &columns[rank][items * row..items * (row + 1)]);
            further.set(name, items, joined.copied().collect());
        }
        let small = |value: u64| u32::try_from(value).unwrap_or(u32::MAX);
        Ok(Self {
            id: words("id")?,
            population: words("population")?.into_iter().map(small).collect(),
            position: vectors("position")?,
            velocity: vectors("velocity")?,
            angular_velocity: vectors("angular_velocity")?,
            radius: scalars("radius")?,
            mass: scalars("mass")?,
            weight: match has_weights(catalogue) {
                true => scalars("weight")?,
                false => Vec::new(),
            },
            impulse: vectors("impulse")?,
            further,
            acted,
            support,
            places,
        })
    }
}

impl Part for LinkedParticles {
    fn about(&self) -> &SolverInfo {
        &self.about
    }

    fn commit(&mut self) -> Result<(), PartError> {
        self.solver.commit()?;
        self.committed.clone_from(&self.attempt);
        Ok(())
    }

    fn checkpoint(&mut self, directory: &Path) -> Result<(), PartError> {
        self.solver.checkpoint(directory)?;
        self.committed = self.read(None)?;
        // Which particles a resumed run must agree on: they may be others than at the start.
        let mut state = StateFile::new();
        state.set_u64s("id", &self.committed.id);
        state.set_f64s("radius", &self.committed.radius);
        state
            .write(&directory.join(IDENTITY))
            .map_err(|error| unusable(self.name, directory, error))
    }

    fn processor_time(&self) -> Duration {
        self.solver.processor_time()
    }

    fn finish_run(&mut self, _supervisor: &Supervisor) -> Result<(), PartError> {
        self.solver.goodbye()
    }
}

impl Particles for LinkedParticles {
    fn fields(&self) -> ParticleFields<'_> {
        let state = &self.committed;
        ParticleFields {
            id: &state.id,
            population: &state.population,
            position: &state.position,
            velocity: &state.velocity,
            angular_velocity: &state.angular_velocity,
            radius: &state.radius,
            mass: &state.mass,
            weight: &state.weight,
        }
    }

    fn change(
        &mut self,
        supervisor: &Supervisor,
        change: &ParticleChanges,
    ) -> Result<(), PartError> {
        if change.is_empty() {
            return Ok(());
        }
        let largest = self.largest_id;
        if let Some(new) = change.insert.iter().find(|new| new.id > largest) {
            let message = format!(
                "its ids end at {largest}, but a particle {} comes in",
                new.id
            );
            return Err(self.solver.refuse(None, message));
        }
        let weights = has_weights(&self.solver.hello().catalogue);
        if let Some(new) = change
            .insert
            .iter()
            .find(|new| new.weight != 1.0 && !weights)
        {
            let message = format!(
                "its particles stand for themselves alone, but particle {} comes in for {}; write weight = 1",
                new.id, new.weight
            );
            return Err(self.solver.refuse(None, message));
        }
        let before = self.committed.id.len();
        self.solver
            .change(supervisor, &change_text(change, weights))?;
        self.attempt = self.read(None)?;
        self.committed.clone_from(&self.attempt);
        let (now, due) = (
            self.committed.id.len(),
            before + change.insert.len() - change.remove.len(),
        );
        if now != due {
            let message = format!("{now} particles are left after a change, not {due}");
            return Err(self.solver.refuse(None, message));
        }
        Ok(())
    }

    fn takes(&self, column: &str) -> bool {
        let catalogue = &self.solver.hello().catalogue;
        catalogue
            .further(ColumnSet::Start)
            .any(|field| field.name == column)
    }

    /// The bed is not sent: no particle solver of the wire asks for it.
    fn start(&mut self, window: &Window, _bed: &Bed, push: &ParticlePush) -> Result<(), PartError> {
        let count = self.committed.id.len();
        if push.force.len() != count {
            let message = format!("{} forces for {count} particles", push.force.len());
            return Err(self.solver.refuse(Some(window), message));
        }
        let catalogue = &self.solver.hello().catalogue;
        let further: Vec<Field> = catalogue.further(ColumnSet::Start).cloned().collect();
        if let Some(message) = misfit(&push.columns, &further, count) {
            return Err(self.solver.refuse(Some(window), message));
        }
        self.window = Some(*window);
        // To each rank what it had at the last state: particles change ranks within windows only.
        let (ids, places) = (&self.committed.id, &self.committed.places);
        self.solver.send_columns(
            window,
            header(MessageKind::Start, window),
            |rank| places[rank].len(),
            |rank, link| {
                let own = link.column_words_mut("id")?.iter_mut();
                for (id, &place) in own.zip(&places[rank]) {
                    *id = ids[place];
                }
                let own = link.column_mut("force")?.chunks_exact_mut(3);
                for (force, &place) in own.zip(&places[rank]) {
                    force.copy_from_slice(push.force[place].as_slice());
                }
                for field in &further {
                    let items = field.components;
                    let own = link.column_mut(&field.name)?;
                    // A column that is not pushed is zero.
                    let Some(all) = push.columns.get(&field.name, items, count) else {
                        own.fill(0.0);
                        continue;
                    };
                    for (values, &place) in own.chunks_exact_mut(items).zip(&places[rank]) {
                        values.copy_from_slice(&all[items * place..items * (place + 1)]);
                    }
                }
                Ok(())
            },
        )
    }

    fn finish(
        &mut self,
        supervisor: &Supervisor,
        received: &mut ParticleReceived,
    ) -> Result<(), PartError> {
        let Some(window) = self.window.take() else {
            return Err(self.solver.refuse(None, "finished without a start".into()));
        };
        self.solver
            .wait(supervisor, &window, MessageKind::Finished)?;
        self.attempt = self.read(Some(&window))?;
        if self.attempt.id != self.committed.id {
            let (now, before) = (self.attempt.id.len(), self.committed.id.len());
            let message = format!("it came back with {now} particles of {before}, or other ids");
            return Err(self.solver.refuse(Some(&window), message));
        }
        received.impulse.clone_from(&self.attempt.impulse);
        received.columns.clone_from(&self.attempt.further);
        received.acted = self.attempt.acted;
        // Nothing on the wire tells of them.
        received.deep_contacts = None;
        // Without walls and held particles nothing else acts on a free one.
        received.support = match self.alone {
            true => Some(Vec3::zeros()),
            false => Some(self.attempt.support).filter(|sum| sum.iter().all(|x| x.is_finite())),
        };
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pushed_columns_are_those_that_the_link_takes_in_name_and_shape() {
        let taken = Catalogue::moving_drag();
        let mut columns = NamedColumns::default();
        columns.set("drag_coefficient", 1, vec![0.0; 2]);
        assert_eq!(misfit(&columns, &taken, 2), None);
        columns.set("gas_velocity", 2, vec![0.0; 4]);
        let told = misfit(&columns, &taken, 2).unwrap();
        assert!(told.contains("`gas_velocity` has 2 values") && told.contains("takes 3"));
        columns.set("gas_velocity", 3, vec![0.0; 6]);
        columns.set("film", 1, vec![0.0; 2]);
        let told = misfit(&columns, &taken, 2);
        assert_eq!(told.as_deref(), Some("it takes no column `film`"));
    }

    #[test]
    fn a_state_that_is_not_finite_names_the_particle_by_its_id() {
        let mut state = ReceivedParticles {
            id: vec![3, 17, 40],
            position: vec![Vec3::zeros(); 3],
            velocity: vec![Vec3::zeros(); 3],
            angular_velocity: vec![Vec3::zeros(); 3],
            ..ReceivedParticles::default()
        };
        assert_eq!(state.not_finite(), None);
        state.angular_velocity[2].x = f64::NAN;
        state.velocity[1].z = f64::INFINITY;
        let told = state.not_finite().map(|found| found.to_string());
        assert_eq!(
            told.as_deref(),
            Some("the velocity of particle 17 is inf m/s")
        );
    }
}
