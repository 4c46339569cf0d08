//! Which particles meet what: other particles, walls, and who sees whom.

use std::fmt;

use crate::model::SurfaceLine;

/// Two particles whose surfaces touch or are near.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NeighbourPair {
    /// Their places in the order of the particles.
    pub particles: [usize; 2],
    /// Their radii in m.
    pub radius: [f64; 2],
    /// Their overlap in m; negative where there is a gap.
    pub overlap: f64,
}

/// A particle whose surface touches a wall or is near it. Walls count as flat.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NeighbourWall {
    /// The particle's place in the order of the particles.
    pub particle: usize,
    /// Index of the reservoir that the wall is.
    pub reservoir: usize,
    /// The particle's radius in m.
    pub radius: f64,
    /// Overlap of particle and wall in m; negative where there is a gap.
    pub overlap: f64,
}

/// Who sees whom: exchange areas in m², the surface of one times its view factor to the other.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ExchangeAreas {
    /// Pairs of particles, each once: reciprocity holds by construction.
    pub pairs: Vec<([usize; 2], f64)>,
    /// Particle and reservoir.
    pub reservoirs: Vec<([usize; 2], f64)>,
    /// What each particle sees of itself, by reflection, in m²; exchanges nothing.
    pub own: Vec<f64>,
    /// True where areas are those of black surfaces, and grey ones need a radiosity each; false where they
    /// already are of what is emitted and absorbed.
    pub radiosity: bool,
    /// What the areas of each particle sum to in m²: its surface, or that times its emissivity.
    pub surface: Vec<f64>,
    /// Particles whose areas could not be brought to that sum.
    pub imbalance: RowImbalance,
}

/// Particles whose exchange areas do not sum to their surface.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct RowImbalance {
    /// How many.
    pub rows: usize,
    /// The largest relative difference.
    pub worst: f64,
    /// The row that has it.
    pub row: usize,
}

/// What particles meet at their present places.
#[derive(Clone, Copy, Debug)]
pub struct Neighbours<'a> {
    /// Particles that touch or are near each other.
    pub pairs: &'a [NeighbourPair],
    /// Particles at walls.
    pub walls: &'a [NeighbourWall],
    /// Views; `None`: those of before still hold.
    pub views: Option<&'a ExchangeAreas>,
}

/// What is beside the particles during an attempt.
#[derive(Clone, Copy, Debug)]
pub struct NetworkSurroundings<'a> {
    /// Conductivity of the gas that each particle sees in W/m/K.
    pub gas_conductivity: &'a [f64],
    /// Temperature of each reservoir in K: walls, then the surroundings.
    pub reservoirs: &'a [f64],
    /// Bodies that reservoirs are parts of, whose temperatures the network finds too.
    pub bodies: NetworkBodies<'a>,
}

/// Bodies of one temperature that store heat, and the reservoirs that are parts of them.
#[derive(Clone, Copy)]
pub struct NetworkBodies<'a> {
    /// The body of each reservoir; `None`, or nothing, where it has a temperature of its own.
    pub of: &'a [Option<usize>],
    /// Temperature of each body in K from which the iteration begins.
    pub start: &'a [f64],
    /// What a body takes from the network over its temperature, about a given one in K.
    pub line: &'a (dyn Fn(usize, f64) -> SurfaceLine + Sync),
}

impl NetworkBodies<'_> {
    /// No body at all.
    pub const NONE: NetworkBodies<'static> = NetworkBodies {
        of: &[],
        start: &[],
        line: &|_, _| SurfaceLine::prescribed(0.0),
    };

    /// The body that a reservoir is a part of.
    pub fn of_reservoir(&self, reservoir: usize) -> Option<usize> {
        self.of.get(reservoir).copied().flatten()
    }
}

impl fmt::Debug for NetworkBodies<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut shown = f.debug_struct("NetworkBodies");
        shown.field("of", &self.of).field("start", &self.start);
        shown.finish_non_exhaustive()
    }
}
