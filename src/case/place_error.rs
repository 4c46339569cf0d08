//! What keeps particles from being placed.

use std::path::PathBuf;

use calcine_coupler::packing::PackingError;
use calcine_coupler::physics::Vec3;
use thiserror::Error;

use super::contacts::ContactsError;
use super::model::Case;
use super::units::shown;

/// Particles that cannot be placed.
#[derive(Debug, Error)]
pub enum PlaceError {
    /// The file cannot be read.
    #[error("{path}: {cause}")]
    Io {
        /// The file.
        path: PathBuf,
        /// Why.
        cause: std::io::Error,
    },
    /// A particle, or a file of particles, that is not as it should be.
    #[error("{place}: {what}")]
    File {
        /// The file or population, and the line or particle.
        place: String,
        /// What is wrong.
        what: String,
    },
    /// Two particles in the same space.
    #[error(
        "particle {} of \"{}\" and particle {} of \"{}\" overlap: their centres are {} m apart, their \
         radii add up to {} m; {}",
        .ids[0], .names[0], .ids[1], .names[1], shown(*.distance), shown(*.radii), apart(.names)
    )]
    Overlap {
        /// Their ids.
        ids: [u64; 2],
        /// Their populations.
        names: [String; 2],
        /// Distance of their centres in m.
        distance: f64,
        /// Sum of their radii in m.
        radii: f64,
    },
    /// A particle in a wall.
    #[error(
        "particle {id} of \"{name}\" is in the wall \"{wall}\": {}, its radius is {} m; contacts would shoot it out. Move the \
         population, or check its unit of length, and that of the wall (`scale` of an STL file)",
        reach(*.distance), shown(*.radius)
    )]
    InWall {
        /// Its id.
        id: u64,
        /// Its population.
        name: String,
        /// The wall.
        wall: String,
        /// Distance of its centre from the wall in m, negative beyond it.
        distance: f64,
        /// Its radius in m.
        radius: f64,
    },
    /// A particle that is far wider than the mesh.
    #[error(
        "particle {id} of \"{name}\" has a diameter of {} m, but the mesh is {} m wide at its narrowest; check the unit of the \
         diameter, and that of the mesh",
        shown(*.diameter), shown(*.width)
    )]
    TooWide {
        /// Its id.
        id: u64,
        /// Its population.
        name: String,
        /// Its diameter in m.
        diameter: f64,
        /// The narrowest extent of the mesh in m.
        width: f64,
    },
    /// A particle whose centre lies in no cell.
    #[error(
        "particle {id} of \"{name}\" lies outside the mesh, at ({}, {}, {}) m; keep its place, a region or a grid, within the cells, and check the \
         units of both (`check` prints from where to where a mesh of a file reaches)",
        shown(at.x), shown(at.y), shown(at.z)
    )]
    Outside {
        /// Its id.
        id: u64,
        /// Index of its population.
        index: usize,
        /// Its population.
        name: String,
        /// Its centre in m.
        at: Vec3,
    },
    /// A packing or a distribution of sizes that cannot be made.
    #[error("population \"{name}\": {cause}")]
    Packing {
        /// Name of the population.
        name: String,
        /// Why.
        cause: PackingError,
    },
    /// What is wrong with one population.
    #[error("{cause}")]
    Population {
        /// Its number, from 0.
        index: usize,
        /// What is wrong.
        cause: Box<PlaceError>,
    },
    /// Contacts that cannot be stepped through.
    #[error(transparent)]
    Contacts(#[from] super::contacts::ContactsError),
    /// Walls that do not go with the mesh of parcels.
    #[error(transparent)]
    ParcelWalls(#[from] super::parcel_wall_error::ParcelWallError),
    /// No particle at all.
    #[error(
        "the case has no particles: {} place none; a run needs one particle at least", .names.join(", ")
    )]
    Empty {
        /// The populations.
        names: Vec<String>,
    },
}

/// How far a centre is from a wall.
fn reach(distance: f64) -> String {
    let side = if distance < 0.0 { "beyond" } else { "from" };
    format!("its centre lies {} m {side} it", shown(distance.abs()))
}

/// What to do about two particles of these populations in the same space.
fn apart(names: &[String; 2]) -> &'static str {
    if names[0] == names[1] {
        "take one of them out of its file, or check its unit of length and its diameters"
    } else {
        "move one of the populations"
    }
}

impl PlaceError {
    /// The key of the case that the error is about.
    pub fn key(&self, case: &Case) -> String {
        match self {
            Self::Population { index, cause } => match **cause {
                Self::Packing {
                    cause: PackingError::TooNarrow { .. },
                    ..
                } => format!("particles[{index}].diameter"),
                _ => format!("particles[{index}].place"),
            },
            Self::Outside { index, .. } => format!("particles[{index}].place"),
            Self::Overlap { names, .. } => of_population(case, &names[1], "place"),
            Self::InWall { name, .. } => of_population(case, name, "place"),
            Self::TooWide { name, .. } => of_population(case, name, "diameter"),
            Self::Contacts(ContactsError::Step { .. }) => "motion.motion_step".into(),
            Self::Contacts(ContactsError::Short { .. }) => "motion.held".into(),
            Self::Contacts(_) => "motion".into(),
            Self::ParcelWalls(_) => "motion.parcels".into(),
            _ => "particles".into(),
        }
    }
}

/// A key of the population of this name.
fn of_population(case: &Case, name: &str, key: &str) -> String {
    let index = case.particles.iter().position(|one| one.name == name);
    index.map_or("particles".into(), |index| {
        format!("particles[{index}].{key}")
    })
}
