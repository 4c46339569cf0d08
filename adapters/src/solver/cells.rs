//! What the ranks of a gas say of their cells, against the mesh of the case.

use calcine_coupler::error::{FailureKind, PartError};
use calcine_coupler::mesh::Mesh;
use calcine_coupler::physics::Vec3;
use calcine_wire::{Link, WireError};

use super::ExternalSolver;

/// How far a solver's cells may be from the mesh's: of a cell's size, and of its volume. Far above what rounding
/// and another way to weigh warped faces make, far below another mesh.
const GEOMETRY: f64 = 1e-6;

impl ExternalSolver {
    /// The cells that each rank says it has.
    pub(super) fn claims(&self) -> Result<Vec<Vec<usize>>, WireError> {
        let claim = |link: &Link| {
            let cells = link.column_words("cell")?.iter();
            Ok(cells.map(|&cell| cell as usize).collect())
        };
        self.links.iter().map(claim).collect()
    }

    /// Every cell must be on one rank.
    pub(super) fn check_claims(&self) -> Result<(), PartError> {
        let mut times = vec![0u32; self.hello.count as usize];
        for &cell in self.owned.iter().flatten() {
            let Some(times) = times.get_mut(cell) else {
                let message = format!("a rank has cell {cell} of {}", self.hello.count);
                return Err(self.refuse(None, message));
            };
            *times += 1;
        }
        match times.iter().position(|&times| times != 1) {
            None => Ok(()),
            Some(cell) => {
                let message = format!("{} ranks have cell {cell}", times[cell]);
                Err(self.refuse(None, message))
            }
        }
    }

    /// Every cell must lie where the mesh has it, and be as large.
    pub(super) fn check_geometry(&self, mesh: &Mesh) -> Result<(), PartError> {
        for (link, cells) in self.links.iter().zip(self.owned.iter()) {
            let columns = link.column("centre").and_then(|centres| {
                let volumes = link.column("volume")?;
                Ok((centres.as_chunks::<3>().0, volumes))
            });
            let (centres, volumes) = columns.map_err(|error| self.failure(None, error))?;
            for ((&cell, &centre), &volume) in cells.iter().zip(centres).zip(volumes) {
                let (own, size) = (mesh.cell_centre()[cell], mesh.cell_volume()[cell]);
                let shift = (own - Vec3::from(centre)).norm();
                let is_close =
                    shift <= GEOMETRY * size.cbrt() && (volume - size).abs() <= GEOMETRY * size;
                if !is_close {
                    let [x, y, z] = centre;
                    let message = format!(
                        "its cell {cell} has {volume} m^3 about ({x}, {y}, {z}) m, that of the case's mesh {size} m^3 \
                         about ({}, {}, {}) m; both must have the same mesh, numbered alike",
                        own.x, own.y, own.z
                    );
                    let mut error = self.refuse(None, message);
                    error.kind = FailureKind::NotStarted;
                    return Err(error);
                }
            }
        }
        Ok(())
    }
}
