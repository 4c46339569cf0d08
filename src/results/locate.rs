//! Which cell holds a point.

use calcine_coupler::mesh::Mesh;
use calcine_coupler::physics::Vec3;

use super::ResultsError;
use crate::case::model::Probe;

/// How far outside its cell's faces a point may lie, relative to the cell's size: round-off.
const TOLERANCE: f64 = 1e-9;

/// The cell that holds a point: the one whose outermost face is least exceeded; `None` outside.
pub(super) fn cell_of(mesh: &Mesh, point: &Vec3) -> Option<usize> {
    let exceeded = |cell: usize| {
        mesh.faces_of(cell)
            .iter()
            .fold(f64::NEG_INFINITY, |far, &face| {
                let face = face as usize;
                let outward = mesh.outward(cell, face);
                far.max(outward.dot(&(point - mesh.face_centre()[face])) / outward.norm())
            })
    };
    let mut best = (f64::INFINITY, 0);
    for cell in 0..mesh.cells() {
        let distance = exceeded(cell);
        if distance < best.0 {
            best = (distance, cell);
        }
    }
    let size = mesh.cell_volume()[best.1].cbrt();
    (best.0 <= TOLERANCE * size).then_some(best.1)
}

/// The points of a probe, and the cell of each.
pub(super) struct Line {
    /// Name of the probe.
    pub name: String,
    /// Points in m.
    pub points: Vec<Vec3>,
    /// The cell of each point, `None` outside the mesh.
    pub cells: Vec<Option<usize>>,
}

impl Line {
    /// Finds the cells of a probe's points; an error where none lies in the mesh.
    pub fn new(probe: &Probe, mesh: &Mesh) -> Result<Self, ResultsError> {
        let points: Vec<Vec3> = (0..probe.points)
            .map(|i| {
                let share = i as f64 / probe.points.saturating_sub(1).max(1) as f64;
                probe.from + share * (probe.to - probe.from)
            })
            .collect();
        let cells: Vec<_> = points.iter().map(|point| cell_of(mesh, point)).collect();
        if cells.iter().all(Option::is_none) {
            return Err(ResultsError::ProbeOutside {
                probe: probe.name.clone(),
            });
        }
        Ok(Self {
            name: probe.name.clone(),
            points,
            cells,
        })
    }
}
