//! Populations, where they are, and what comes in.

use std::path::PathBuf;

use calcine_coupler::mesh::zone::Zone;
use calcine_coupler::packing::Sizes;
use calcine_coupler::packing::regular::Lattice;
use calcine_coupler::physics::Vec3;
use calcine_coupler::setup::Schedule;

/// Particles of one kind.
#[derive(Clone, Debug)]
pub struct Population {
    /// Name.
    pub name: String,
    /// Index into `Case::materials`.
    pub material: usize,
    /// Diameters; a file of particles may state its own.
    pub sizes: Sizes,
    /// Seed by which diameters that differ are drawn.
    pub size_seed: u64,
    /// How the particles move.
    pub motion: MotionSpec,
    /// Velocity at the start in m/s of motion time.
    pub velocity: Vec3,
    /// Where they are at the start.
    pub place: PlacementSpec,
    /// Start temperature in K; a file of particles may state its own where none is prescribed.
    pub temperature: f64,
    /// Temperature in K over process time that they have whatever heat they take; `None`: they follow their heat.
    pub prescribed_temperature: Option<Schedule>,
    /// Statistical weight: number of real particles that each stands for.
    pub weight: f64,
}

/// Particles that come in.
#[derive(Clone, Debug, PartialEq)]
pub struct FeedSpec {
    /// Name.
    pub name: String,
    /// Index of their population, which gives material and sizes.
    pub population: usize,
    /// Where they appear.
    pub zone: Zone,
    /// Mass flow in kg/s.
    pub rate: f64,
    /// Process times in s at which that flow begins and ends.
    pub period: [f64; 2],
    /// Mass in kg at the start.
    pub batch: f64,
    /// Their velocity in m/s of process time.
    pub velocity: Vec3,
    /// Their temperature in K.
    pub temperature: f64,
    /// Equal seeds give equal particles.
    pub seed: u64,
}

/// How particles move.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MotionSpec {
    /// They stay where they are.
    Frozen,
    /// They move by gravity, contacts and the force of the gas.
    Free,
    /// Each stands for many, and moves by gravity, the stress of the solid and the force of the gas.
    Parcels,
}

/// How many spheres a random packing has.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum RandomAmount {
    /// As many as come nearest to this volume of spheres over the filled space, layers at the walls included.
    SolidFraction(f64),
    /// So many.
    Number(usize),
}

/// What a packing fills: a box along the axes or an upright cylinder, in m.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PackingSpace {
    /// Lowest corner of a box; centre of a cylinder's bottom.
    pub origin: Vec3,
    /// Its horizontal section.
    pub section: PackingSection,
    /// Its height.
    pub height: f64,
}

/// The horizontal section of what a packing fills.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum PackingSection {
    /// A rectangle with its widths along x and y in m.
    Rectangle([f64; 2]),
    /// A disc with its diameter in m.
    Disc(f64),
}

impl PackingSection {
    /// Its area in m².
    pub fn area(&self) -> f64 {
        match self {
            Self::Rectangle([x, y]) => x * y,
            Self::Disc(diameter) => std::f64::consts::PI / 4.0 * diameter * diameter,
        }
    }
}

/// Where particles are at the start.
#[derive(Clone, Debug, PartialEq)]
pub enum PlacementSpec {
    /// A regular stacking: `counts` particles along x, y, z from `first` on.
    Grid {
        /// Centre of the first particle in m.
        first: Vec3,
        /// Distances between centres along x, y, z in m.
        spacing: Vec3,
        /// Number along x, y, z.
        counts: [usize; 3],
    },
    /// A random packing.
    Random {
        /// What it fills.
        space: PackingSpace,
        /// How many.
        amount: RandomAmount,
        /// Equal seeds give equal packings.
        seed: u64,
    },
    /// A regular stacking.
    Regular {
        /// The stacking.
        lattice: Lattice,
        /// What it fills.
        space: PackingSpace,
    },
    /// Read from a file: CSV, a LIGGGHTS dump, or VTK.
    File {
        /// Absolute path.
        path: PathBuf,
        /// The snapshot of a dump; `None`: its last one.
        timestep: Option<u64>,
        /// Those of one type; `None`: all.
        kind: Option<u64>,
    },
}
