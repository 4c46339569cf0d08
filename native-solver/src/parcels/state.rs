//! Checkpoints of native parcels: all that decides the next step, so that writing one changes nothing.

use std::path::Path;

use calcine_coupler::checkpoint::StateFile;
use calcine_coupler::mesh::tetrahedra::TetPlace;
use calcine_coupler::physics::Vec3;

use super::{NativeParcels, ParcelError, ParcelRows};
use crate::gas::{NativeError, flat, vectors};
use crate::particles::check::length;

/// Name of the state file in a checkpoint's folder.
const STATE: &str = "parcels.state";

impl NativeParcels {
    /// Writes the state; a parcel's tetrahedron is a part of it, as places on a face belong to both.
    pub(super) fn write(&self, directory: &Path) -> Result<(), NativeError> {
        let rows = &self.rows;
        let population: Vec<u64> = rows.population.iter().map(|&p| u64::from(p)).collect();
        let numbers = |place: &TetPlace| [place.cell, place.face, place.edge].map(u64::from);
        let places: Vec<u64> = rows.place.iter().flat_map(numbers).collect();
        let mut file = StateFile::new();
        file.set_u64s("id", &rows.id);
        file.set_u64s("population", &population);
        file.set_u64s("place", &places);
        file.set_f64s("position", &flat(&rows.position));
        file.set_f64s("velocity", &flat(&rows.velocity));
        file.set_f64s("radius", &rows.radius);
        file.set_f64s("mass", &rows.mass);
        file.set_f64s("weight", &rows.weight);
        file.set_u64s("steps", &[self.steps]);
        Ok(file.write(&directory.join(STATE))?)
    }

    /// Takes up the state that a checkpoint left in a folder.
    pub fn restore(&mut self, directory: &Path) -> Result<(), ParcelError> {
        let file = StateFile::read(&directory.join(STATE)).map_err(NativeError::from)?;
        let rows = self.read(&file)?;
        self.steps = match file.u64s("steps").map_err(NativeError::from)? {
            &[steps] => steps,
            other => return Err(length("the state's list of steps", other.len(), 1).into()),
        };
        self.impulse = vec![Vec3::zeros(); rows.id.len()];
        self.rows = rows;
        Ok(())
    }

    fn read(&self, file: &StateFile) -> Result<ParcelRows, NativeError> {
        let id = file.u64s("id")?.to_vec();
        let count = id.len();
        let population = file.u64s("population")?;
        if population.len() != count {
            return Err(length(
                "the state's list of populations",
                population.len(),
                count,
            ));
        }
        let known = self.motion.walls.iter().map(|wall| wall.impact.len()).min();
        let known = known.unwrap_or(usize::MAX) as u64;
        if let Some(&strange) = population.iter().find(|&&one| one >= known) {
            let most = strange as usize + 1;
            return Err(length(
                "the state's highest population",
                most,
                known as usize,
            ));
        }
        let numbers = file.u64s("place")?;
        let mesh = self.tetrahedra.mesh();
        let place = |[cell, face, edge]: &[u64; 3]| {
            let there = *cell < mesh.cells() as u64
                && mesh.faces_of(*cell as usize).contains(&(*face as u32))
                && *edge < mesh.face_points(*face as usize).len() as u64;
            there.then_some(TetPlace {
                cell: *cell as u32,
                face: *face as u32,
                edge: *edge as u32,
            })
        };
        let places = numbers.as_chunks::<3>().0.iter().map(place);
        let places: Option<Vec<TetPlace>> = places.collect();
        let Some(places) = places.filter(|places| places.len() == count) else {
            return Err(length(
                "the state's list of places",
                numbers.len() / 3,
                count,
            ));
        };
        Ok(ParcelRows {
            population: population.iter().map(|&one| one as u32).collect(),
            position: vectors(file.f64s_of("position", 3 * count)?),
            velocity: vectors(file.f64s_of("velocity", 3 * count)?),
            spin: vec![Vec3::zeros(); count],
            radius: file.f64s_of("radius", count)?.to_vec(),
            mass: file.f64s_of("mass", count)?.to_vec(),
            weight: file.f64s_of("weight", count)?.to_vec(),
            place: places,
            id,
        })
    }
}
