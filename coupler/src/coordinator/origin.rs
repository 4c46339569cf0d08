//! What another run left behind, for a run of a changed case to continue from.

use std::path::{Path, PathBuf};

use calcine_physics::{Vec3, sphere};

use super::CoupledRun;
use super::checkpoint_paths::CheckpointPaths;
use super::error::{OriginError, RunError};
use crate::checkpoint::{StateFile, StateFileError};
use crate::mesh::Mesh;
use crate::models::amounts;
use crate::motion::Motion;
use crate::part::Gas as _;
use crate::setup::{GasStart, ParticleSetup};
use crate::time::{Clocks, Ticks};

/// Centres and radii count as the same within this share of the radius: solvers that write
/// decimal numbers return them rounded.
const SAME: f64 = 1e-9;

/// Angular velocities in a checkpoint of the coordinator.
const SPIN: &str = "particle_angular_velocity";

/// The last checkpoint of another run: what a run of a changed case takes over from it, and what
/// must be the same for that.
#[derive(Debug)]
pub struct Origin {
    /// The checkpoint's folder.
    pub path: PathBuf,
    /// What is wrong with a newer one, where there is one.
    pub damage: Option<String>,
    /// Hash of the other run's case.
    pub case_hash: String,
    /// Windows that the other run had committed.
    pub windows: u64,
    /// Where its clocks stood.
    pub clocks: Clocks,
    state: StateFile,
}

impl Origin {
    /// Reads the newest whole checkpoint that a run left in its results folder; that folder stays as it is.
    pub fn read(results: &Path) -> Result<Self, RunError> {
        let paths = CheckpointPaths::new(results);
        let (path, damage) = match paths.newest_whole()? {
            Some(whole) => (whole.path, whole.damage),
            None => (paths.committed(), None),
        };
        let state = StateFile::read(&path.join("coordinator.state"))?;
        let case_hash = text(state.u64s("case_hash")?);
        let [windows, motion, process] = match *state.u64s("windows_and_clocks")? {
            [windows, motion, process] => [windows, motion, process],
            _ => [0; 3],
        };
        let clocks = Clocks {
            motion: Ticks::new(motion.cast_signed()),
            process: Ticks::new(process.cast_signed()),
        };
        Ok(Self {
            path,
            damage,
            case_hash,
            windows,
            clocks,
            state,
        })
    }

    /// Solids that the particles are made of, by name.
    fn solids(&self) -> Vec<String> {
        amounts(self.state.names())
    }

    /// The gas as any solver may start from it.
    pub fn gas(&self) -> Result<GasStart, StateFileError> {
        let temperature = self.state.f64s("gas_temperature")?.to_vec();
        let cells = temperature.len();
        let velocity = self.state.f64s_of("gas_velocity", 3 * cells)?;
        Ok(GasStart {
            pressure: self.state.f64s_of("gas_pressure", cells)?.to_vec(),
            velocity: velocity
                .chunks_exact(3)
                .map(Vec3::from_column_slice)
                .collect(),
            composition: self.state.f64s("gas_composition")?.to_vec(),
            temperature,
        })
    }

    /// The particles to go on with, and an error where mesh, species or what must be the same of the particles differ.
    ///
    /// Where particles of this case move, it goes on with all those that the other run left, of the same populations by
    /// name: where they came to, as large, heavy and fast, with their spins, without what contacts remember. Where
    /// none moves, with those of this case that the other run still has; only particles of the populations of which `reacts`
    /// is true may then have changed their sizes and masses and been used up.
    pub fn take_particles(
        &self,
        mesh: &Mesh,
        species: &[String],
        populations: &[String],
        here: &ParticleSetup,
        reacts: &[bool],
    ) -> Result<ParticleSetup, RunError> {
        self.check_mesh(mesh)?;
        self.check_species(species)?;
        if here.motion != Motion::Frozen {
            self.check_populations(populations)?;
            return self.all_rows(&here.motion);
        }
        let reacts = |row: usize| {
            let population = here.population[row] as usize;
            reacts.get(population).copied().unwrap_or(false)
        };
        let taken = self.rows_of(here, reacts)?;
        self.check_weights(&taken)?;
        Ok(taken)
    }

    fn check_mesh(&self, mesh: &Mesh) -> Result<(), RunError> {
        let (found, expected) = (self.state.u64s("mesh")?, identity(mesh));
        if found == expected {
            return Ok(());
        }
        Err(OriginError::Mesh {
            path: self.path.clone(),
            found: found.first().copied().unwrap_or(0),
            expected: expected[0],
        }
        .into())
    }

    fn check_species(&self, names: &[String]) -> Result<(), RunError> {
        let (found, expected) = (text(self.state.u64s("species")?), names.join(", "));
        if found == expected {
            return Ok(());
        }
        let path = self.path.clone();
        Err(OriginError::Species {
            path,
            found,
            expected,
        }
        .into())
    }

    fn check_populations(&self, names: &[String]) -> Result<(), RunError> {
        let found = text(self.state.u64s("populations")?);
        let expected = names.join(", ");
        if found == expected {
            return Ok(());
        }
        let path = self.path.clone();
        Err(OriginError::Populations {
            path,
            found,
            expected,
        }
        .into())
    }

    /// All particles that the other run left.
    fn all_rows(&self, motion: &Motion) -> Result<ParticleSetup, RunError> {
        let id = self.state.u64s("particle_id")?.to_vec();
        let count = id.len();
        let vectors = |name| -> Result<Vec<Vec3>, StateFileError> {
            let values = self.state.f64s_of(name, 3 * count)?.chunks_exact(3);
            Ok(values.map(Vec3::from_column_slice).collect())
        };
        let radius = self.state.f64s_of("particle_radius", count)?.to_vec();
        let mass = self.state.f64s_of("particle_mass", count)?;
        let spheres = radius.iter().map(|radius| sphere::volume(*radius));
        let population = self.state.u64s("particle_population")?.iter();
        Ok(ParticleSetup {
            population: population
                .map(|&one| u32::try_from(one).unwrap_or(u32::MAX))
                .collect(),
            position: vectors("particle_position")?,
            density: mass.iter().zip(spheres).map(|(m, v)| m / v).collect(),
            radius,
            velocity: vectors("particle_velocity")?,
            angular_velocity: vectors(SPIN)?,
            weight: self.state.f64s("particle_weight")?.to_vec(),
            motion: motion.clone(),
            id,
        })
    }

    /// The rows of this case that the other run still has, with their sizes there.
    fn rows_of(
        &self,
        here: &ParticleSetup,
        reacts: impl Fn(usize) -> bool,
    ) -> Result<ParticleSetup, RunError> {
        let id = self.state.u64s("particle_id")?;
        let position = self.state.f64s_of("particle_position", 3 * id.len())?;
        let radius = self.state.f64s_of("particle_radius", id.len())?;
        let mass = self.state.f64s_of("particle_mass", id.len())?;
        let count = || OriginError::Count {
            path: self.path.clone(),
            found: id.len(),
            expected: here.id.len(),
        };
        let mut taken = ParticleSetup {
            motion: here.motion.clone(),
            ..ParticleSetup::default()
        };
        let mut there = 0;
        for row in 0..here.id.len() {
            if id.get(there) != Some(&here.id[row]) && reacts(row) {
                // It was used up.
                continue;
            }
            if there >= id.len() {
                return Err(count().into());
            }
            let centre = Vec3::from_column_slice(&position[3 * there..3 * there + 3]);
            let found = (id[there], centre, radius[there]);
            let expected = (here.id[row], here.position[row], here.radius[row]);
            let near = SAME * radius[there];
            let same = found.0 == expected.0
                && (found.1 - expected.1).norm() <= near
                && (reacts(row) || (found.2 - expected.2).abs() <= near);
            if !same {
                return Err(OriginError::Particle {
                    path: self.path.clone(),
                    number: there + 1,
                    found,
                    expected,
                }
                .into());
            }
            taken.take(here, row);
            if reacts(row) {
                let own = taken.radius.len() - 1;
                taken.radius[own] = found.2;
                taken.density[own] = mass[there] / sphere::volume(found.2);
            }
            there += 1;
        }
        if there < id.len() {
            return Err(count().into());
        }
        Ok(taken)
    }

    fn check_weights(&self, here: &ParticleSetup) -> Result<(), RunError> {
        let weight = match self.state.f64s("particle_weight")? {
            [] => &[],
            _ => self.state.f64s_of("particle_weight", here.id.len())?,
        };
        for (row, &id) in here.id.iter().enumerate() {
            let found = weight.get(row).copied().unwrap_or(1.0);
            let expected = here.weight_of(row);
            if found != expected {
                return Err(OriginError::Weight {
                    path: self.path.clone(),
                    id,
                    found,
                    expected,
                }
                .into());
            }
        }
        Ok(())
    }
}

impl CoupledRun {
    /// What must be the same for another run to continue from this one's checkpoint.
    pub(super) fn record_identity(&self, state: &mut StateFile) {
        let particles = self.parts.particles.fields();
        let centres = particles.position.iter();
        let centres: Vec<f64> = centres.flat_map(|x| [x.x, x.y, x.z]).collect();
        let species = self.laws.closures.gas.species().join(", ");
        let bytes = |text: &str| -> Vec<u64> { text.bytes().map(u64::from).collect() };
        let velocities = particles.velocity.iter();
        let velocities: Vec<f64> = velocities.flat_map(|v| [v.x, v.y, v.z]).collect();
        let population: Vec<u64> = particles
            .population
            .iter()
            .copied()
            .map(u64::from)
            .collect();
        let (gas, voids) = (self.parts.gas.fields(), &self.bed.mapped.bed.void_fraction);
        let superficial = gas.velocity.iter().zip(voids);
        let velocity = superficial.flat_map(|(u, pores)| [u.x * pores, u.y * pores, u.z * pores]);
        state.set_f64s("gas_temperature", gas.temperature);
        state.set_f64s("gas_pressure", gas.pressure);
        state.set_f64s("gas_velocity", &velocity.collect::<Vec<f64>>());
        state.set_f64s("gas_composition", gas.composition);
        state.set_u64s("mesh", &identity(&self.mesh));
        state.set_u64s("species", &bytes(&species));
        state.set_u64s("populations", &bytes(&self.plan.populations.join(", ")));
        state.set_u64s("particle_population", &population);
        state.set_f64s("particle_velocity", &velocities);
        let spins = particles
            .angular_velocity
            .iter()
            .flat_map(|one| <[f64; 3]>::from(*one));
        state.set_f64s(SPIN, &spins.collect::<Vec<f64>>());
        state.set_u64s("particle_id", particles.id);
        state.set_f64s("particle_position", &centres);
        state.set_f64s("particle_radius", particles.radius);
        state.set_f64s("particle_mass", &self.interior.mass);
        state.set_f64s("particle_weight", particles.weight);
    }

    /// Takes over the inside of the particles of another run, and of those that move also what acted on them and what their
    /// feeds have drawn and owe. Gas and particles were built from it already (see
    /// [`Origin::take_particles`]); clocks and ledger stay at zero.
    pub fn take_over(&mut self, origin: &Origin) -> Result<(), RunError> {
        let (found, expected) = (origin.solids(), self.interior.models.amounts());
        let path = || origin.path.clone();
        if found != expected {
            return Err(OriginError::Solids {
                path: path(),
                found: found.join(", "),
                expected: expected.join(", "),
            }
            .into());
        }
        if let Err(error) = self.restore_particles(&origin.state) {
            let RunError::Restore(cause) = error else {
                return Err(error);
            };
            let (path, cause) = (path(), cause.to_string());
            return Err(OriginError::Inside { path, cause }.into());
        }
        self.bodies.take_over(&origin.state)?;
        if self.plan.free.is_empty() {
            return Ok(());
        }
        self.motion.restore_other(&origin.state)?;
        Ok(self.plan.feeds_and_outlets.go_on(&origin.state)?)
    }
}

fn text(bytes: &[u64]) -> String {
    let letters = bytes.iter().map(|&byte| u8::try_from(byte).unwrap_or(b'?'));
    String::from_utf8_lossy(&letters.collect::<Vec<u8>>()).into_owned()
}

/// Cells, faces, and a 64-bit FNV-1a hash, word by word, of points, owners and neighbours.
fn identity(mesh: &Mesh) -> [u64; 3] {
    let mut hash = 0xcbf2_9ce4_8422_2325u64;
    let mut add = |word: u64| hash = (hash ^ word).wrapping_mul(0x0100_0000_01b3).rotate_left(23);
    for x in mesh.topology().points.iter().flatten() {
        // A sum with zero makes -0 the same as 0.
        add((x + 0.0).to_bits());
    }
    for &cell in mesh.owner().iter().chain(mesh.neighbour()) {
        add(cell.into());
    }
    [mesh.cells() as u64, mesh.faces() as u64, hash]
}
