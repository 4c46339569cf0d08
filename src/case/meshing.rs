//! From the mesh of a case to cells.

use std::path::PathBuf;

use calcine_coupler::mesh::block::{BoxSpec, box_mesh};
use calcine_coupler::mesh::cut::cut;
use calcine_coupler::mesh::cylinder::{
    CylinderSpec, GradedBoxSpec, cylinder_mesh, graded_box_mesh,
};
use calcine_coupler::mesh::flat::FlatError;
use calcine_coupler::mesh::grading::{Stretch, shared};
use calcine_coupler::mesh::openings::open;
use calcine_coupler::mesh::periodic::PeriodicError;
use calcine_coupler::mesh::polymesh::{self, PolyMeshError};
use calcine_coupler::mesh::refine::refine;
use calcine_coupler::mesh::{Mesh, MeshError};
use calcine_coupler::physics::Vec3;
use thiserror::Error;

use super::model::MeshSpec;

/// A mesh that cannot be made or read.
#[derive(Debug, Error)]
pub enum MeshingError {
    /// The mesh cannot be generated.
    #[error(transparent)]
    Mesh(#[from] MeshError),
    /// The polyMesh cannot be read.
    #[error(transparent)]
    PolyMesh(#[from] PolyMeshError),
    /// Patches that are no periodic pair.
    #[error("{0}; mesh both sides alike, or give the patches another condition in `gas.patch`")]
    Periodic(#[from] PeriodicError),
    /// Sides that are not those of a plane or axisymmetric flow.
    #[error("{0}; mesh one cell across, or give the patches another condition in `gas.patch`")]
    Flat(#[from] FlatError),
    /// A patch that is something else in the mesh than in the case.
    #[error(
        "patch `{patch}` is of type `{kind}` in {}, and `gas.patch.{patch}` states {stated}: write {wanted}, or change the type there",
        file.display()
    )]
    Boundary {
        /// The file of the mesh.
        file: PathBuf,
        /// The patch.
        patch: String,
        /// Its type there.
        kind: String,
        /// The key of its condition in the case.
        stated: String,
        /// A condition that agrees with the type.
        wanted: String,
    },
    /// A type of patch that neither gas has.
    #[error("patch `{patch}` is of type `{kind}` in {}, which is not supported: {remedy}", file.display())]
    Unsupported {
        /// The file of the mesh.
        file: PathBuf,
        /// The patch.
        patch: String,
        /// Its type there.
        kind: String,
        /// What to do.
        remedy: &'static str,
    },
    /// Two cells on one side of the face between them.
    #[error(
        "the mesh is folded in cell {cell} at ({:.4}, {:.4}, {:.4}) m: the line to the next cell makes {angle:.1} degrees with the normal of the face \
         between them, so that both lie on one side of it; mesh anew (`checkMesh` lists such faces)", at.x, at.y, at.z
    )]
    Folded {
        /// The cell that owns the face.
        cell: usize,
        /// Its centre in m.
        at: Vec3,
        /// In degrees.
        angle: f64,
    },
    /// Pieces that nothing joins, without a level of pressure.
    #[error("{0}")]
    Pieces(String),
    /// Patches and conditions that do not go together.
    #[error("{0}")]
    Patches(String),
    /// Particles that move in a plane or axisymmetric flow.
    #[error(
        "the gas is one cell deep between patches that are `{kind}`, and `{population}` moves: particles move in three dimensions; use \
         symmetry or periodic patches in place of `{kind}`, or make the particles frozen"
    )]
    Moving {
        /// `empty` or `wedge`.
        kind: &'static str,
        /// The population.
        population: String,
    },
    /// A mean pressure gradient along a direction that is not periodic.
    #[error(
        "`gas.pressure_gradient` is {gradient} Pa/m along {axis}, which is not periodic: there the boundary conditions drive the gas; \
         make the direction periodic, or the component 0"
    )]
    Gradient {
        /// Name of the axis.
        axis: char,
        /// In Pa/m.
        gradient: f64,
    },
}

/// The mesh, if no two cells lie on one side of the face between them.
fn unfolded(mesh: Mesh) -> Result<Mesh, MeshingError> {
    match mesh.quality() {
        Some(quality) if quality.angle.value >= 90.0 => Err(MeshingError::Folded {
            cell: quality.angle.cell,
            at: quality.angle.centre,
            angle: quality.angle.value,
        }),
        _ => Ok(mesh),
    }
}

/// Generates or reads the gas mesh: graded first, then refined in its zones, then bodies are cut out, then
/// it is opened.
pub fn mesh(spec: &MeshSpec) -> Result<Mesh, MeshingError> {
    let (made, zones, bodies, openings) = match spec {
        MeshSpec::Box {
            origin,
            size,
            cells,
            grading,
            refine,
            cut,
            openings,
            patches,
        } => {
            let plain = BoxSpec {
                origin: *origin,
                size: *size,
                cells: *cells,
                patches: patches.clone(),
            };
            (boxed(plain, grading)?, refine, cut, openings)
        }
        MeshSpec::Cylinder {
            origin,
            diameter,
            length,
            cells,
            grading,
            refine,
            cut,
            openings,
        } => {
            let made = cylinder_mesh(&CylinderSpec {
                origin: *origin,
                diameter: *diameter,
                length: *length,
                cells_across: cells[0],
                along: shared(cells[1], grading)?,
                patches: ["side", "bottom", "top"].map(String::from),
            })?;
            (made, refine, cut, openings)
        }
        MeshSpec::PolyMesh(directory) => return unfolded(polymesh::read(directory)?),
    };
    let made = if zones.is_empty() {
        made
    } else {
        refine(&made, zones)?
    };
    let made = if bodies.is_empty() {
        made
    } else {
        cut(&made, bodies)?
    };
    if openings.is_empty() {
        return Ok(made);
    }
    Ok(open(&made, openings)?)
}

fn boxed(plain: BoxSpec, grading: &[Vec<Stretch>; 3]) -> Result<Mesh, MeshError> {
    if grading.iter().all(Vec::is_empty) {
        return box_mesh(&plain);
    }
    let along = |axis: usize| shared(plain.cells[axis], &grading[axis]);
    graded_box_mesh(&GradedBoxSpec {
        along: [along(0)?, along(1)?, along(2)?],
        origin: plain.origin,
        size: plain.size,
        patches: plain.patches,
    })
}
