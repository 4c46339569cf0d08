//! What another run left behind, for a run of a changed case to continue from.

use std::path::{Path, PathBuf};

use calcine_physics::Vec3;

use super::CoupledRun;
use super::checkpoint_paths::CheckpointPaths;
use super::error::{OriginError, RunError};
use crate::checkpoint::{StateFile, StateFileError};
use crate::mesh::Mesh;
use crate::setup::ParticleSetup;
use crate::time::{Clocks, Ticks};

/// Centres and radii count as the same within this share of the radius: solvers that write
/// decimal numbers return them rounded.
const SAME: f64 = 1e-9;

/// The last checkpoint of another run: what a run of a changed case takes over from it, and what
/// must be the same for that.
#[derive(Debug)]
pub struct Origin {
    /// The checkpoint's folder.
    pub path: PathBuf,
    /// Hash of the other run's case.
    pub case_hash: String,
    /// Windows that the other run had committed.
    pub windows: u64,
    /// Where its clocks stood.
    pub clocks: Clocks,
    state: StateFile,
}

impl Origin {
    /// Reads what a run left in its results folder.
    pub fn read(results: &Path) -> Result<Self, StateFileError> {
        let path = CheckpointPaths::new(results).committed();
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
            case_hash,
            windows,
            clocks,
            state,
        })
    }

    /// Errors where this run's mesh, species or particles differ from the other run's.
    pub fn check(
        &self,
        mesh: &Mesh,
        species: &[String],
        particles: &ParticleSetup,
    ) -> Result<(), RunError> {
        self.check_mesh(mesh)?;
        self.check_species(species)?;
        self.check_particles(particles)
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

    fn check_particles(&self, here: &ParticleSetup) -> Result<(), RunError> {
        let id = self.state.u64s("particle_id")?;
        if id.len() != here.id.len() {
            return Err(OriginError::Count {
                path: self.path.clone(),
                found: id.len(),
                expected: here.id.len(),
            }
            .into());
        }
        let position = self.state.f64s_of("particle_position", 3 * id.len())?;
        let radius = self.state.f64s_of("particle_radius", id.len())?;
        for (p, centre) in position.as_chunks::<3>().0.iter().enumerate() {
            let found = (id[p], Vec3::from(*centre), radius[p]);
            let expected = (here.id[p], here.position[p], here.radius[p]);
            let near = SAME * radius[p];
            let same = found.0 == expected.0
                && (found.1 - expected.1).norm() <= near
                && (found.2 - expected.2).abs() <= near;
            if !same {
                return Err(OriginError::Particle {
                    path: self.path.clone(),
                    number: p + 1,
                    found,
                    expected,
                }
                .into());
            }
        }
        self.check_weights(here)
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
        let species: Vec<u64> = species.bytes().map(u64::from).collect();
        state.set_u64s("mesh", &identity(&self.mesh));
        state.set_u64s("species", &species);
        state.set_u64s("particle_id", particles.id);
        state.set_f64s("particle_position", &centres);
        state.set_f64s("particle_radius", particles.radius);
        state.set_f64s("particle_weight", particles.weight);
    }

    /// Takes over the inside of the particles of another run of the same mesh and particles. The
    /// gas was built from it already (see [`Origin::check`]); clocks and ledger stay at zero.
    pub fn take_over(&mut self, origin: &Origin) -> Result<(), RunError> {
        self.restore_particles(&origin.state)
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
