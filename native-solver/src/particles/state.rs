//! Checkpoints of the native particles.

use std::path::Path;

use calcine_coupler::checkpoint::StateFile;
use calcine_coupler::physics::Vec3;

use super::check::length;
use super::dem::{StoredContact, StoredWallContact};
use super::{NativeError, NativeParticles};
use crate::gas::{flat, vectors};

/// Name of the state file in a checkpoint's folder.
const STATE: &str = "particles.state";

impl NativeParticles {
    /// Writes the state, with the memories of contacts.
    pub(super) fn write(&mut self, directory: &Path) -> Result<(), NativeError> {
        let population: Vec<u64> = self.population.iter().map(|&p| u64::from(p)).collect();
        let mut file = StateFile::new();
        file.set_u64s("id", &self.id);
        file.set_u64s("population", &population);
        file.set_f64s("position", &flat(&self.position));
        file.set_f64s("velocity", &flat(&self.velocity));
        file.set_f64s("angular_velocity", &flat(&self.angular_velocity));
        file.set_f64s("radius", &self.radius);
        file.set_f64s("mass", &self.mass);
        file.set_f64s("weight", &self.weight);
        if let Some(engine) = &mut self.engine {
            let (pairs, walls) = engine.memories();
            let rows: Vec<u64> = pairs
                .iter()
                .flat_map(|one| one.rows)
                .map(u64::from)
                .collect();
            let near = walls.iter().flat_map(|one| [one.row, one.wall]);
            let near: Vec<u64> = near.map(u64::from).collect();
            let values: Vec<Vec3> = pairs
                .iter()
                .flat_map(|one| [one.shift, one.rolling])
                .collect();
            let memory = |one: &StoredWallContact| [one.point, one.shift, one.rolling];
            let wall_values: Vec<Vec3> = walls.iter().flat_map(memory).collect();
            file.set_u64s("contact_rows", &rows);
            file.set_f64s("contact_memory", &flat(&values));
            file.set_u64s("wall_rows", &near);
            file.set_f64s("wall_memory", &flat(&wall_values));
            file.set_u64s("steps", &[self.steps as u64]);
        }
        Ok(file.write(&directory.join(STATE))?)
    }

    /// Takes up the state that a checkpoint left in a folder.
    pub fn restore(&mut self, directory: &Path) -> Result<(), NativeError> {
        let file = StateFile::read(&directory.join(STATE))?;
        let id = file.u64s("id")?;
        let count = id.len();
        // Moving particles may have come and gone since the setup, those of a frozen bed only gone.
        let known = |one: &u64| self.id.binary_search(one).is_ok();
        if self.engine.is_none() && !id.iter().all(known) {
            return Err(length("the state's list of ids", count, self.id.len()));
        }
        let population = file.u64s("population")?;
        if population.len() != count {
            return Err(length(
                "the state's list of populations",
                population.len(),
                count,
            ));
        }
        self.id = id.to_vec();
        self.population = population
            .iter()
            .map(|&population| population as u32)
            .collect();
        self.position = vectors(file.f64s_of("position", 3 * count)?);
        self.velocity = vectors(file.f64s_of("velocity", 3 * count)?);
        self.angular_velocity = vectors(file.f64s_of("angular_velocity", 3 * count)?);
        self.radius = file.f64s_of("radius", count)?.to_vec();
        self.mass = file.f64s_of("mass", count)?.to_vec();
        self.weight = match file.f64s("weight")? {
            [] => Vec::new(),
            _ => file.f64s_of("weight", count)?.to_vec(),
        };
        self.impulse = vec![Vec3::zeros(); count];
        let Some(engine) = &self.engine else {
            return Ok(());
        };
        let contacts = engine.contacts();
        let (known, walls) = (
            contacts.material_of.len().min(contacts.held.len()),
            contacts.walls.len(),
        );
        if self
            .population
            .iter()
            .any(|&population| population as usize >= known)
        {
            return Err(length("the state's highest population", known + 1, known));
        }
        let memories = memories(&file, count, walls)?;
        self.steps = file.u64s("steps")?.first().copied().unwrap_or(0) as i64;
        self.hand_over(memories)
            .map_err(|stray| self.outside(stray))
    }
}

fn memories(
    file: &StateFile,
    count: usize,
    walls: usize,
) -> Result<(Vec<StoredContact>, Vec<StoredWallContact>), NativeError> {
    let rows = file.u64s("contact_rows")?.as_chunks::<2>().0;
    let values = vectors(file.f64s_of("contact_memory", 6 * rows.len())?);
    let near = file.u64s("wall_rows")?.as_chunks::<2>().0;
    let wall_values = vectors(file.f64s_of("wall_memory", 9 * near.len())?);
    let strange = rows.iter().flatten().any(|&row| row >= count as u64)
        || near
            .iter()
            .any(|&[row, wall]| row >= count as u64 || wall >= walls as u64);
    if strange {
        return Err(length(
            "the state's list of contacts",
            rows.len() + near.len(),
            count,
        ));
    }
    let pair = |(rows, values): (&[u64; 2], &[Vec3])| StoredContact {
        rows: rows.map(|row| row as u32),
        shift: values[0],
        rolling: values[1],
    };
    let wall = |(near, values): (&[u64; 2], &[Vec3])| StoredWallContact {
        row: near[0] as u32,
        wall: near[1] as u32,
        point: values[0],
        shift: values[1],
        rolling: values[2],
    };
    Ok((
        rows.iter().zip(values.chunks(2)).map(pair).collect(),
        near.iter().zip(wall_values.chunks(3)).map(wall).collect(),
    ))
}
