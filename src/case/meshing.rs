//! From the mesh of a case to cells.

use calcine_coupler::mesh::block::{BoxSpec, box_mesh};
use calcine_coupler::mesh::cylinder::{
    CylinderSpec, GradedBoxSpec, cylinder_mesh, graded_box_mesh,
};
use calcine_coupler::mesh::grading::{Stretch, shared};
use calcine_coupler::mesh::openings::open;
use calcine_coupler::mesh::polymesh::{self, PolyMeshError};
use calcine_coupler::mesh::refine::refine;
use calcine_coupler::mesh::{Mesh, MeshError};
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
}

/// Generates or reads the gas mesh: graded first, then refined in its zones, then opened.
pub fn mesh(spec: &MeshSpec) -> Result<Mesh, MeshingError> {
    let (made, zones, openings) = match spec {
        MeshSpec::Box {
            origin,
            size,
            cells,
            grading,
            refine,
            openings,
            patches,
        } => {
            let plain = BoxSpec {
                origin: *origin,
                size: *size,
                cells: *cells,
                patches: patches.clone(),
            };
            (boxed(plain, grading)?, refine, openings)
        }
        MeshSpec::Cylinder {
            origin,
            diameter,
            length,
            cells,
            grading,
            refine,
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
            (made, refine, openings)
        }
        MeshSpec::PolyMesh(directory) => return Ok(polymesh::read(directory)?),
    };
    let made = if zones.is_empty() {
        made
    } else {
        refine(&made, zones)?
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
