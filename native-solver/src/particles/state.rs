//! Checkpoints of the native particles: all that decides the next step, so that writing one changes nothing.

use std::path::Path;

use calcine_coupler::checkpoint::StateFile;
use calcine_coupler::physics::Vec3;

use super::check::length;
use super::dem::{EngineState, ServoState, StoredContact, StoredWallContact};
use super::{NativeError, NativeParticles};
use crate::gas::{flat, vectors};

/// Name of the state file in a checkpoint's folder.
const STATE: &str = "particles.state";

impl NativeParticles {
    /// Writes the state, with the memories of contacts, loads and the last search for neighbours.
    pub(super) fn write(&mut self, directory: &Path) -> Result<(), NativeError> {
        let population: Vec<u64> = self.population.iter().map(|&p| u64::from(p)).collect();
        // As the solver has them: beyond periodic planes since its last search.
        let mut position = self.position.clone();
        if let Some(engine) = &self.engine {
            engine.read_places(&mut position);
        }
        let mut file = StateFile::new();
        file.set_u64s("id", &self.id);
        file.set_u64s("population", &population);
        file.set_f64s("position", &flat(&position));
        file.set_f64s("velocity", &flat(&self.velocity));
        file.set_f64s("angular_velocity", &flat(&self.angular_velocity));
        file.set_f64s("radius", &self.radius);
        file.set_f64s("mass", &self.mass);
        file.set_f64s("weight", &self.weight);
        if let Some(engine) = &mut self.engine {
            record_memories(engine.memories(), &mut file);
            record_engine(&engine.state(), &mut file);
            file.set_u64s("steps", &[self.steps as u64]);
        }
        Ok(file.write(&directory.join(STATE))?)
    }

    /// Number of populations that the particles may be of: those whose contacts are known, or of a frozen bed those of the setup.
    fn populations(&self) -> usize {
        match &self.engine {
            Some(engine) => {
                let contacts = engine.contacts();
                contacts.material_of.len().min(contacts.held.len())
            }
            None => self
                .population
                .iter()
                .max()
                .map_or(0, |last| *last as usize + 1),
        }
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
        let populations = self.populations();
        if population.iter().any(|&one| one >= populations as u64) {
            return Err(length(
                "the state's highest population",
                populations + 1,
                populations,
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
        let walls = contacts.walls.len();
        let memories = memories(&file, count, walls)?;
        self.steps = file.u64s("steps")?.first().copied().unwrap_or(0) as i64;
        let state = engine_state(&file, count, engine.servo_states().len())?;
        let particles = self.spheres();
        let Some(engine) = &mut self.engine else {
            return Ok(());
        };
        engine
            .resume(&particles, memories, self.steps, &state)
            .map_err(|stray| self.outside(stray))?;
        self.read();
        Ok(())
    }
}

/// Writes the memories of contacts; rolling springs only where some contact has one.
fn record_memories(
    (pairs, walls): (Vec<StoredContact>, Vec<StoredWallContact>),
    file: &mut StateFile,
) {
    let rows: Vec<u64> = pairs
        .iter()
        .flat_map(|one| one.rows.map(u64::from))
        .collect();
    let near = walls.iter().flat_map(|one| [one.row, one.wall, one.slot]);
    let near: Vec<u64> = near.map(u64::from).collect();
    let shift: Vec<Vec3> = pairs.iter().map(|one| one.shift).collect();
    let at_wall = |one: &StoredWallContact| [one.point, one.shift];
    let wall_shift: Vec<Vec3> = walls.iter().flat_map(at_wall).collect();
    let of_walls = walls.iter().map(|one| one.rolling);
    let mut rolling: Vec<Vec3> = pairs
        .iter()
        .map(|one| one.rolling)
        .chain(of_walls)
        .collect();
    if rolling.iter().all(|torque| *torque == Vec3::zeros()) {
        rolling.clear();
    }
    file.set_u64s("contact_rows", &rows);
    file.set_f64s("contact_shift", &flat(&shift));
    file.set_u64s("wall_rows", &near);
    file.set_f64s("wall_shift", &flat(&wall_shift));
    file.set_f64s("contact_rolling", &flat(&rolling));
}

/// Writes loads and the last search for neighbours.
fn record_engine(state: &EngineState, file: &mut StateFile) {
    let loads: Vec<Vec3> = state.load.iter().flatten().copied().collect();
    let [gone, wall_gone] = state.gone;
    let counts = [state.searched_after as u64, state.age];
    file.set_f64s("load", &flat(&loads));
    file.set_f64s("wall_force", &flat(&state.wall_force));
    file.set_f64s("searched_position", &flat(&state.searched));
    file.set_f64s("search", &[state.skin, gone, wall_gone]);
    file.set_u64s("search_steps", &counts);
    if !state.servos.is_empty() {
        let servos = state.servos.iter();
        let values = servos.flat_map(|one| {
            let [x, y, z] = one.pressed.into();
            [one.distance, one.rate, x, y, z, one.searched]
        });
        file.set_f64s("servos", &values.collect::<Vec<_>>());
    }
}

/// Walls that hold a force; the state has none where the case has none.
fn servos(file: &StateFile, expected: usize) -> Result<Vec<ServoState>, NativeError> {
    if expected == 0 {
        return Ok(Vec::new());
    }
    let values = file.f64s_of("servos", 6 * expected)?.as_chunks::<6>().0;
    let state = |&[distance, rate, x, y, z, searched]: &[f64; 6]| ServoState {
        distance,
        rate,
        pressed: Vec3::new(x, y, z),
        searched,
    };
    Ok(values.iter().map(state).collect())
}

fn engine_state(
    file: &StateFile,
    count: usize,
    servos_of: usize,
) -> Result<EngineState, NativeError> {
    let blocks = EngineState::blocks(count);
    let loads = vectors(file.f64s_of("load", 6 * count)?);
    let search = file.f64s_of("search", 3)?;
    let steps = file.u64s("search_steps")?;
    let &[searched_after, age] = steps else {
        return Err(length("the state's list of steps", steps.len(), 2));
    };
    Ok(EngineState {
        load: loads.as_chunks::<2>().0.to_vec(),
        wall_force: vectors(file.f64s_of("wall_force", 3 * blocks)?),
        searched: vectors(file.f64s_of("searched_position", 3 * count)?),
        searched_after: searched_after as i64,
        skin: search[0],
        gone: [search[1], search[2]],
        age,
        servos: servos(file, servos_of)?,
    })
}

fn memories(
    file: &StateFile,
    count: usize,
    walls: usize,
) -> Result<(Vec<StoredContact>, Vec<StoredWallContact>), NativeError> {
    let rows = file.u64s("contact_rows")?.as_chunks::<2>().0;
    let shift = vectors(file.f64s_of("contact_shift", 3 * rows.len())?);
    let near = file.u64s("wall_rows")?.as_chunks::<3>().0;
    let wall_shift = vectors(file.f64s_of("wall_shift", 6 * near.len())?);
    let contacts = rows.len() + near.len();
    let rolling = match file.f64s("contact_rolling")? {
        [] => vec![Vec3::zeros(); contacts],
        _ => vectors(file.f64s_of("contact_rolling", 3 * contacts)?),
    };
    let (rolling, wall_rolling) = rolling.split_at(rows.len());
    let strange = rows.iter().flatten().any(|&row| row >= count as u64)
        || near
            .iter()
            .any(|&[row, wall, _]| row >= count as u64 || wall >= walls as u64);
    if strange {
        return Err(length("the state's list of contacts", contacts, count));
    }
    let pair = |((rows, shift), rolling): ((&[u64; 2], &Vec3), &Vec3)| StoredContact {
        rows: rows.map(|row| row as u32),
        shift: *shift,
        rolling: *rolling,
    };
    let wall = |((near, values), rolling): ((&[u64; 3], &[Vec3; 2]), &Vec3)| StoredWallContact {
        row: near[0] as u32,
        wall: near[1] as u32,
        slot: near[2] as u32,
        point: values[0],
        shift: values[1],
        rolling: *rolling,
    };
    let wall_shift = wall_shift.as_chunks::<2>().0;
    Ok((
        rows.iter().zip(&shift).zip(rolling).map(pair).collect(),
        near.iter()
            .zip(wall_shift)
            .zip(wall_rolling)
            .map(wall)
            .collect(),
    ))
}
