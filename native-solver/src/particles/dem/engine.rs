//! The solver: steps of velocity Verlet, and when to find candidates anew.

mod drag;
mod pass;
mod servo;
mod state;

use std::iter::repeat;

use calcine_coupler::excursion::Excursion;
use calcine_coupler::motion::{ContactForce, Contacts, LostParticles};
use calcine_coupler::physics::Vec3;
use calcine_coupler::physics::contact::{
    ContactModel, HertzMindlin, Linear, LinearSprings, OpenfoamSpringSliderDashpot,
    SpringSliderDashpot,
};
use rayon::prelude::*;

use super::block::{Block, size};
use super::energy::{BedEnergy, ContactEnergy};
use super::motion::{self, ForceKick, Kick, KickInputs};
use super::rebuild::{NeighbourSearch, SearchInputs};
use super::rules::ContactRules;
use super::sphere::{SphereLoad, SphereMotion, SpherePosition, Spheres};
use super::stored_contacts::{StoredContact, StoredContacts, StoredWallContact};
use super::walls::WallBody;

pub use servo::ServoState;
pub use state::EngineState;

/// Skin at the start, in radii of the smallest sphere.
const SKIN: f64 = 0.2;
/// Least and largest skin, in radii of the smallest sphere.
const SKINS: [f64; 2] = [0.04, 1.0];
/// Between so many steps per search the skin is right: below, it grows; above, it shrinks.
const STEPS: [u64; 2] = [15, 60];
/// Up to so many particles one thread does the work alone.
const ALONE: usize = 2048;
/// After so many steps without a search the skin is too wide in any case.
const IDLE: u64 = 500;

/// A block with its share of places, motions and pushes.
type Portion<'a> = (
    (
        (&'a mut Block, &'a mut [SpherePosition]),
        &'a mut [SphereMotion],
    ),
    &'a [Vec3],
);

/// Kick and move of one step.
struct Drift<'a> {
    kick: &'a KickInputs,
    /// Whether works are counted.
    counting: bool,
    outgoing: &'a [Vec<SphereLoad>],
}

impl Drift<'_> {
    /// Kicks and moves the particles of a block, with the loads of other blocks taken up first where this is not the first
    /// step of a window; the square of their largest speed in m²/s².
    fn of<K: Kick>(&self, portion: Portion<'_>, kicks: impl IntoIterator<Item = K>) -> f64 {
        let (((block, place), moves), push) = portion;
        if self.kick.times > 1 {
            block.take_up(self.outgoing);
        }
        if self.counting {
            motion::drift::<true, K>(block, self.kick, (place, moves), push, kicks)
        } else {
            motion::drift::<false, K>(block, self.kick, (place, moves), push, kicks)
        }
    }
}

/// A particle as it comes into the solver.
#[derive(Clone, Copy, Debug, Default)]
pub struct InsertedSphere {
    /// Centre in m.
    pub centre: Vec3,
    /// Velocity in m/s.
    pub velocity: Vec3,
    /// Angular velocity in rad/s.
    pub spin: Vec3,
    /// Radius in m.
    pub radius: f64,
    /// Mass in kg.
    pub mass: f64,
    /// Index of its material.
    pub material: u32,
    /// True where it is held.
    pub held: bool,
}

/// A particle out of bounds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EscapedParticle {
    /// Its row among ascending ids.
    pub row: u32,
    /// Its centre in m.
    pub centre: Vec3,
    /// Its velocity in m/s.
    pub velocity: Vec3,
}

/// Particles in motion.
#[derive(Clone, Debug)]
pub struct Engine {
    contacts: Contacts,
    rules: ContactRules,
    walls: Vec<WallBody>,
    spheres: Spheres,
    blocks: Vec<Block>,
    outgoing: Vec<Vec<SphereLoad>>,
    /// Loads of the block at hand, of steps that go block by block.
    spare: Vec<SphereLoad>,
    search: NeighbourSearch,
    smallest: f64,
    skin: f64,
    /// How far any particle may have gone since the last search, in m.
    gone: f64,
    /// How far any wall may have.
    wall_gone: f64,
    /// Steps since the last search.
    age: u64,
    /// Steps of the run after which the walls are where they are.
    posed: i64,
    /// Centres in m at the last search, in the order of the particles, and the steps of the run before it.
    searched: (Vec<Vec3>, i64),
    /// Distances in m of walls that hold a force at the last search.
    searched_servos: Vec<f64>,
    /// Evaluations of all forces so far.
    stamp: u64,
    searches: u64,
    counting: bool,
    /// Contacts that were pressed in too far since they were asked for last.
    deep: Excursion,
}

impl Engine {
    /// A solver without particles.
    pub fn new(contacts: Contacts) -> Self {
        Self {
            rules: ContactRules::new(&contacts),
            walls: contacts
                .walls
                .iter()
                .map(|wall| WallBody::new(wall, contacts.bounds, &contacts.periodicity))
                .collect(),
            spheres: Spheres::default(),
            blocks: Vec::new(),
            outgoing: Vec::new(),
            spare: Vec::new(),
            search: NeighbourSearch::default(),
            smallest: 0.0,
            skin: 0.0,
            gone: 0.0,
            wall_gone: 0.0,
            age: 0,
            posed: 0,
            searched: (Vec::new(), 0),
            searched_servos: Vec::new(),
            stamp: 1,
            searches: 0,
            counting: false,
            deep: Excursion::default(),
            contacts,
        }
    }

    /// What it was made of.
    pub fn contacts(&self) -> &Contacts {
        &self.contacts
    }

    /// Takes particles by rows of ascending ids, with the memories of their contacts, after so many steps
    /// of the run, and evaluates their forces without bringing the memories up to date.
    pub fn load(
        &mut self,
        particles: &[InsertedSphere],
        memories: (Vec<StoredContact>, Vec<StoredWallContact>),
        steps: i64,
    ) -> Result<(), EscapedParticle> {
        self.take(particles);
        self.skin = SKIN * self.smallest;
        if particles.is_empty() {
            self.blocks.clear();
            return Ok(());
        }
        self.check()?;
        self.pose(steps);
        self.search.stored = StoredContacts::of(memories.0, memories.1);
        self.find();
        self.evaluate(0.0);
        self.take_up();
        Ok(())
    }

    /// The memories of all contacts, in order of their rows.
    pub fn memories(&mut self) -> (Vec<StoredContact>, Vec<StoredWallContact>) {
        let stored = &mut self.search.stored;
        stored.collect(&self.blocks, &self.spheres, self.stamp);
        stored.sort(self.spheres.len());
        (stored.pairs.clone(), stored.walls.clone())
    }

    /// Sets the force of the gas on each particle, by rows, in N; no drag acts beside it.
    pub fn push(&mut self, force: &[Vec3]) {
        self.spheres.drag.clear();
        for (push, &row) in self.spheres.push.iter_mut().zip(&self.spheres.row) {
            *push = force[row as usize];
        }
    }

    /// Copies centres, velocities and angular velocities out, by rows. Between two searches centres may be beyond a
    /// periodic plane, as far as a particle goes in that time.
    pub fn read(&self, centre: &mut [Vec3], velocity: &mut [Vec3], spin: &mut [Vec3]) {
        let spheres = &self.spheres;
        for ((place, moves), &row) in spheres.place.iter().zip(&spheres.moves).zip(&spheres.row) {
            centre[row as usize] = place.centre;
            velocity[row as usize] = moves.velocity;
            spin[row as usize] = moves.spin;
        }
    }

    /// Copies centres out, by rows, as they are between two searches.
    pub fn read_places(&self, centre: &mut [Vec3]) {
        for (place, &row) in self.spheres.place.iter().zip(&self.spheres.row) {
            centre[row as usize] = place.centre;
        }
    }

    /// Impulse in N s that walls and held particles gave the free ones since this was asked last.
    pub fn take_support(&mut self) -> Vec3 {
        let blocks = self.blocks.iter_mut();
        blocks.map(|block| std::mem::take(&mut block.support)).sum()
    }

    /// Counts energies from now on, at some cost, or no longer.
    pub fn count_energy(&mut self, on: bool) {
        self.counting = on;
        for block in &mut self.blocks {
            block.budget = ContactEnergy::default();
        }
    }

    /// Energies now; those of contacts and works only while they are counted, and elastic ones from the
    /// first step on.
    pub fn energy(&self) -> BedEnergy {
        let mut energy = BedEnergy::default();
        let spheres = self.spheres.place.iter().zip(&self.spheres.moves);
        for (place, moves) in spheres.take(self.spheres.len()) {
            if moves.inverse_mass > 0.0 {
                let mass = 1.0 / moves.inverse_mass;
                let inertia = 0.4 * mass * place.radius * place.radius;
                energy.kinetic += 0.5 * mass * moves.velocity.norm_squared();
                energy.rotational += 0.5 * inertia * moves.spin.norm_squared();
                energy.momentum += mass * moves.velocity;
            }
        }
        for block in &self.blocks {
            energy.contacts.add(&block.budget);
        }
        energy
    }

    /// Searches for candidates so far, and candidates now.
    pub fn effort(&self) -> (u64, usize) {
        let candidates = |block: &Block| block.inner.pair.len() + block.cross.pair.len();
        (self.searches, self.blocks.iter().map(candidates).sum())
    }

    /// Takes `steps` steps after the `done` first of the run. Velocities are whole after the last one.
    pub fn advance(&mut self, done: i64, steps: i64) -> Result<(), EscapedParticle> {
        if self.spheres.len() == 0 || steps <= 0 {
            self.steer_alone(steps);
            return Ok(());
        }
        let step = self.contacts.step;
        let mut fastest = self.drift(1);
        for k in 0..steps {
            self.steer(if k == 0 { 1 } else { 2 });
            self.pose(done + k + 1);
            self.spheres.move_images();
            self.gone += fastest * step;
            self.wall_gone += step * self.walls.iter().map(|wall| wall.speed).fold(0.0, f64::max);
            self.age += 1;
            let near = self.gone + self.gone.max(self.wall_gone);
            let idle = self.age >= IDLE && self.skin > SKINS[0] * self.smallest;
            // A speed that is not a number is no speed here; the check of places finds it out.
            if near >= self.skin || idle {
                self.check()?;
                self.adapt();
                let stored = &mut self.search.stored;
                stored.collect(&self.blocks, &self.spheres, self.stamp);
                self.find();
            }
            fastest = if k + 1 == steps {
                self.evaluate(step);
                0.0
            } else if self.sweeps() {
                self.sweep(step)
            } else {
                self.evaluate(step);
                self.drift(2)
            };
            self.note_deep_contacts();
        }
        self.take_up();
        self.close();
        self.release();
        self.check()
    }

    /// Every particle must be within the bounds, or at least somewhere where the coordinator takes those out that left.
    fn check(&self) -> Result<(), EscapedParticle> {
        let (low, high) = match self.contacts.lost {
            LostParticles::End => self.contacts.bounds,
            LostParticles::TakeOut | LostParticles::Through => {
                (Vec3::repeat(f64::MIN), Vec3::repeat(f64::MAX))
            }
        };
        for (k, place) in self.spheres.place[..self.spheres.len()].iter().enumerate() {
            let centre = self.contacts.periodicity.wrap(place.centre);
            if !(0..3).all(|axis| centre[axis] >= low[axis] && centre[axis] <= high[axis]) {
                return Err(EscapedParticle {
                    row: self.spheres.row[k],
                    centre,
                    velocity: self.spheres.moves[k].velocity,
                });
            }
        }
        Ok(())
    }

    /// Brings all particles back between the periodic planes, and the memories in `search.stored` with them.
    fn wrap(&mut self) {
        let periodicity = &self.contacts.periodicity;
        if periodicity.is_none() {
            return;
        }
        let mut moved = vec![Vec3::zeros(); self.spheres.len()];
        for (place, &row) in self.spheres.place.iter_mut().zip(&self.spheres.row) {
            let within = periodicity.wrap(place.centre);
            moved[row as usize] = within - place.centre;
            place.centre = within;
        }
        self.search.stored.shift(|row| moved[row as usize]);
    }

    /// A wider skin means fewer searches, a thinner one fewer candidates.
    fn adapt(&mut self) {
        let factor = if self.age < STEPS[0] {
            1.3
        } else if self.age >= IDLE {
            0.5
        } else if self.age > STEPS[1] {
            0.8
        } else {
            1.0
        };
        self.skin = (factor * self.skin).clamp(SKINS[0] * self.smallest, SKINS[1] * self.smallest);
    }

    fn pose(&mut self, steps: i64) {
        self.posed = steps;
        let time = steps as f64 * self.contacts.step;
        for wall in &mut self.walls {
            wall.pose(time);
        }
    }

    /// True where more than one thread is worth waking.
    fn parallel(&self) -> bool {
        self.spheres.len() > ALONE && rayon::current_num_threads() > 1
    }

    fn kick(&self, times: u32) -> KickInputs {
        KickInputs {
            half: 0.5 * self.contacts.step,
            times,
            gravity: self.contacts.gravity,
        }
    }

    /// Kicks and moves all particles; returns their largest speed in m/s. The loads of the step before are
    /// taken up first where this is not the first step of a window.
    fn drift(&mut self, times: u32) -> f64 {
        let (parallel, kick, size) = (self.parallel(), self.kick(times), size(self.spheres.len()));
        let drift = Drift {
            kick: &kick,
            counting: self.counting,
            outgoing: &self.outgoing,
        };
        let Spheres {
            place,
            moves,
            push,
            drag,
            ..
        } = &mut self.spheres;
        let fastest = if parallel {
            let portions = self
                .blocks
                .par_iter_mut()
                .zip(place.par_chunks_mut(size))
                .zip(moves.par_chunks_mut(size))
                .zip(push.par_chunks(size));
            if drag.is_empty() {
                let speeds = portions.map(|portion| drift.of(portion, repeat(ForceKick)));
                speeds.reduce(|| 0.0, f64::max)
            } else {
                let portions = portions.zip(drag.par_chunks_mut(size));
                let speeds = portions.map(|(portion, drag)| drift.of(portion, drag));
                speeds.reduce(|| 0.0, f64::max)
            }
        } else {
            let portions = self
                .blocks
                .iter_mut()
                .zip(place.chunks_mut(size))
                .zip(moves.chunks_mut(size))
                .zip(push.chunks(size));
            if drag.is_empty() {
                let speeds = portions.map(|portion| drift.of(portion, repeat(ForceKick)));
                speeds.fold(0.0, f64::max)
            } else {
                let portions = portions.zip(drag.chunks_mut(size));
                let speeds = portions.map(|(portion, drag)| drift.of(portion, drag));
                speeds.fold(0.0, f64::max)
            }
        };
        fastest.sqrt()
    }

    fn close(&mut self) {
        let (kick, size) = (self.kick(1), size(self.spheres.len()));
        let Spheres {
            moves, push, drag, ..
        } = &mut self.spheres;
        let portions = self.blocks.iter_mut().zip(moves.chunks_mut(size));
        let portions = portions.zip(push.chunks(size));
        if drag.is_empty() {
            for ((block, moves), push) in portions {
                motion::close(block, &kick, moves, push, repeat(ForceKick));
            }
        } else {
            for (((block, moves), push), drag) in portions.zip(drag.chunks_mut(size)) {
                motion::close(block, &kick, moves, push, drag);
            }
        }
    }

    fn take_up(&mut self) {
        for block in &mut self.blocks {
            block.take_up(&self.outgoing);
        }
    }

    /// Finds candidates anew; the memories are in `search.stored`.
    fn find(&mut self) {
        self.wrap();
        match self.contacts.law.force {
            ContactForce::HertzMindlin => self.find_with(&HertzMindlin, false),
            ContactForce::SpringSliderDashpot => self.find_with(&SpringSliderDashpot, false),
            ContactForce::OpenfoamSpringSliderDashpot => {
                self.find_with(&OpenfoamSpringSliderDashpot, false);
            }
            ContactForce::Linear {
                characteristic_speed,
            } => self.find_with(
                &Linear {
                    speed: characteristic_speed,
                },
                true,
            ),
            ContactForce::LinearSprings {
                stiffness,
                tangential_ratio,
            } => self.find_with(
                &LinearSprings {
                    stiffness,
                    tangential_ratio,
                },
                false,
            ),
        }
    }

    fn find_with<L: ContactModel>(&mut self, law: &L, prepares: bool) {
        let parallel = self.parallel();
        let radii = self.spheres.place.iter().map(|place| place.radius);
        let largest = radii.fold(0.0, f64::max);
        let task = SearchInputs {
            law,
            prepares,
            rules: &self.rules,
            walls: &self.walls,
            bounds: self.contacts.bounds,
            periodicity: &self.contacts.periodicity,
            skin: self.skin,
            reach: self.skin + self.rules.longest_tear_off(largest),
            stamp: self.stamp,
        };
        self.search.run(
            &task,
            &mut self.spheres,
            &mut self.blocks,
            &mut self.outgoing,
            parallel,
        );
        (self.gone, self.wall_gone, self.age) = (0.0, 0.0, 0);
        let places = self.spheres.place[..self.spheres.len()].iter();
        self.searched.0.clear();
        self.searched.0.extend(places.map(|place| place.centre));
        self.searched.1 = self.posed;
        self.searched_servos = self.servos().map(|servo| servo.distance).collect();
        self.searches += 1;
    }
}
