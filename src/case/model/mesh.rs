//! Where the gas mesh comes from.

use std::path::PathBuf;

use calcine_coupler::mesh::cut::Cut;
use calcine_coupler::mesh::grading::Stretch;
use calcine_coupler::mesh::openings::Opening;
use calcine_coupler::mesh::refine::Refinement;
use calcine_coupler::physics::Vec3;

/// Where the gas mesh comes from.
#[derive(Clone, Debug, PartialEq)]
#[allow(clippy::large_enum_variant, reason = "there is one a case")]
pub enum MeshSpec {
    /// A box, generated. Patches by default `side` (x−, x+, y−, y+), `bottom` (z−), `top` (z+).
    Box {
        /// Corner with the smallest coordinates in m.
        origin: Vec3,
        /// Edge lengths in m.
        size: Vec3,
        /// Cells along x, y, z.
        cells: [usize; 3],
        /// How cell sizes change along x, y, z; empty for equal ones.
        grading: [Vec<Stretch>; 3],
        /// Zones in which cells are split.
        refine: Vec<Refinement>,
        /// Bodies that are cut out.
        cut: Vec<Cut>,
        /// Parts of the boundary with patches of their own.
        openings: Vec<Opening>,
        /// Patch names of x−, x+, y−, y+, z−, z+; equal names make one patch.
        patches: [String; 6],
    },
    /// An upright cylinder, generated as an O-grid. Patches `side`, `bottom`, `top`.
    Cylinder {
        /// Centre of the bottom in m.
        origin: Vec3,
        /// Diameter in m.
        diameter: f64,
        /// Length along z in m.
        length: f64,
        /// Cells across the diameter, and along z.
        cells: [usize; 2],
        /// How cell sizes change along z; empty for equal ones.
        grading: Vec<Stretch>,
        /// Zones in which cells are split.
        refine: Vec<Refinement>,
        /// Bodies that are cut out.
        cut: Vec<Cut>,
        /// Parts of the boundary with patches of their own.
        openings: Vec<Opening>,
    },
    /// An OpenFOAM polyMesh folder (absolute path).
    PolyMesh(PathBuf),
}
