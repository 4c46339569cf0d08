//! Which particles meet what: other particles, walls, and who sees whom.

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
}
