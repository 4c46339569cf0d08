//! Gas that comes back in through outlets whose case does not state it.

use calcine_coupler::part::Backflow;

use super::NativeGas;
use super::boundary::FaceCondition;

impl NativeGas {
    /// Faces of outlets through which more than the outer tolerance of their cell's gas came in, in the state of the cell, over
    /// a storage span in s.
    pub(super) fn find_backflow(&self, span: f64) -> Option<Backflow> {
        let (grid, now) = (&self.grid, &self.now);
        let tolerance = self.setup.controls.outer_tolerance;
        let mut found: Option<Backflow> = None;
        for index in grid.internal..grid.faces.len() {
            let FaceCondition::Outlet { backflow: None, .. } = self.boundaries.at(index) else {
                continue;
            };
            let (face, inwards) = (&grid.faces[index], -now.flux[index]);
            if inwards * span <= tolerance * now.mass[face.owner] {
                continue;
            }
            let velocity = inwards / (self.density[face.owner] * face.area);
            let faces = found.map_or(1, |other| other.faces + 1);
            found = match found {
                Some(other) if other.velocity >= velocity => Some(Backflow { faces, ..other }),
                _ => Some(Backflow {
                    faces,
                    velocity,
                    cell: face.owner,
                }),
            };
        }
        found
    }
}
