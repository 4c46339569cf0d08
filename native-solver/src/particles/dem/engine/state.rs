//! What a bed goes on from, beside its particles and the memories of their contacts.
//!
//! Candidates follow from where particles and walls were when they were found. Loads do not follow from where particles are:
//! contacts are evaluated with the velocities of the half step, and springs that slide are limited as often as they are
//! evaluated. So both are kept, and what goes on from them goes on to the bit.

use calcine_coupler::physics::Vec3;

use super::super::block::size;
use super::super::energy::ContactEnergy;
use super::super::sphere::{SphereLoad, SphereMotion, SpherePosition, Spheres};
use super::super::stored_contacts::{StoredContact, StoredContacts, StoredWallContact};
use super::servo::ServoState;
use super::{Engine, EscapedParticle, InsertedSphere};

/// Loads, and the last search for candidates; particles by rows of ascending ids.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct EngineState {
    /// Force in N and torque in N m of all contacts of each particle, as its next kick takes them.
    pub load: Vec<[Vec3; 2]>,
    /// Force in N of all walls on the particles of each block.
    pub wall_force: Vec<Vec3>,
    /// Centres in m of all particles at the search.
    pub searched: Vec<Vec3>,
    /// Steps of the run before the search.
    pub searched_after: i64,
    /// Surfaces nearer than this were candidates, in m.
    pub skin: f64,
    /// How far any particle, and any wall, may have gone since, in m.
    pub gone: [f64; 2],
    /// Steps since.
    pub age: u64,
    /// Walls that hold a force.
    pub servos: Vec<ServoState>,
}

impl EngineState {
    /// Number of blocks of so many particles.
    pub fn blocks(particles: usize) -> usize {
        particles.div_ceil(size(particles))
    }
}

impl Engine {
    /// What the next step needs beside particles and memories.
    pub fn state(&self) -> EngineState {
        let count = self.spheres.len();
        let rows = || self.spheres.row.iter().map(|&row| row as usize);
        let mut state = EngineState {
            load: vec![[Vec3::zeros(); 2]; count],
            searched: vec![Vec3::zeros(); count],
            wall_force: self.blocks.iter().map(|block| block.wall_force).collect(),
            searched_after: self.searched.1,
            skin: self.skin,
            gone: [self.gone, self.wall_gone],
            age: self.age,
            servos: self.servo_states(),
        };
        let loads = self.blocks.iter().flat_map(|block| &block.load);
        for (row, load) in rows().zip(loads) {
            state.load[row] = [load.force, load.torque];
        }
        for (row, centre) in rows().zip(&self.searched.0) {
            state.searched[row] = *centre;
        }
        state
    }

    /// Takes particles by rows of ascending ids, with the memories of their contacts, as they were after so many steps of a
    /// run: the next step is to the bit the one that would have followed. Lists of `state` are as long as there are
    /// particles, or blocks of them.
    pub fn resume(
        &mut self,
        particles: &[InsertedSphere],
        (pairs, walls): (Vec<StoredContact>, Vec<StoredWallContact>),
        steps: i64,
        state: &EngineState,
    ) -> Result<(), EscapedParticle> {
        self.take(particles);
        self.skin = state.skin;
        if particles.is_empty() {
            self.blocks.clear();
            self.place_servos(&state.servos, false);
            return Ok(());
        }
        self.check()?;
        for (place, searched) in self.spheres.place.iter_mut().zip(&state.searched) {
            place.centre = *searched;
        }
        self.place_servos(&state.servos, true);
        self.pose(state.searched_after);
        self.search.stored = StoredContacts::in_slots(pairs, walls);
        self.find();
        self.place_servos(&state.servos, false);
        self.pose(steps);
        ([self.gone, self.wall_gone], self.age) = (state.gone, state.age);
        let rows = self.spheres.row.iter().map(|&row| row as usize);
        for (place, row) in self.spheres.place.iter_mut().zip(rows) {
            place.centre = particles[row].centre;
        }
        self.spheres.move_images();
        for (block, wall_force) in self.blocks.iter_mut().zip(&state.wall_force) {
            block.wall_force = *wall_force;
            for (load, row) in block.load.iter_mut().zip(&self.spheres.row[block.begin..]) {
                let [force, torque] = state.load[*row as usize];
                *load = SphereLoad { force, torque };
            }
        }
        self.press(&state.servos);
        Ok(())
    }

    /// Takes particles by rows, without contacts.
    pub(super) fn take(&mut self, particles: &[InsertedSphere]) {
        let spheres = &mut self.spheres;
        *spheres = Spheres::default();
        for (row, particle) in particles.iter().enumerate() {
            let inverse = if particle.held {
                0.0
            } else {
                1.0 / particle.mass
            };
            spheres.place.push(SpherePosition {
                centre: particle.centre,
                radius: particle.radius,
            });
            spheres.moves.push(SphereMotion {
                velocity: if particle.held {
                    Vec3::zeros()
                } else {
                    particle.velocity
                },
                inverse_mass: inverse,
                spin: if particle.held {
                    Vec3::zeros()
                } else {
                    particle.spin
                },
                inverse_inertia: 2.5 * inverse / (particle.radius * particle.radius),
            });
            spheres.material.push(particle.material);
            spheres.push.push(Vec3::zeros());
            spheres.row.push(row as u32);
        }
        let radii = particles.iter().map(|particle| particle.radius);
        self.smallest = radii.fold(f64::INFINITY, f64::min);
        self.stamp = 1;
        for block in &mut self.blocks {
            block.budget = ContactEnergy::default();
            block.support = Vec3::zeros();
        }
    }
}
