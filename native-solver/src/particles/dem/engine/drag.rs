//! Drag that follows the velocities of particles (docs/theory.md, DRG-3), and its impulse.

use calcine_coupler::physics::Vec3;

use super::super::sphere::SphereDrag;
use super::Engine;

impl Engine {
    /// Has drags K (u − v) act beside the force, by rows: K in kg/s and u in m/s.
    pub fn drag(&mut self, coefficient: &[f64], gas: &[Vec3]) {
        let rows = self.spheres.row.iter().map(|&row| row as usize);
        self.spheres.drag.clear();
        self.spheres.drag.extend(rows.map(|row| SphereDrag {
            coefficient: coefficient[row],
            gas: gas[row],
            impulse: Vec3::zeros(),
        }));
    }

    /// Copies the impulses of these drags so far out, by rows, in N s.
    pub fn read_drag(&self, impulse: &mut [Vec3]) {
        for (drag, &row) in self.spheres.drag.iter().zip(&self.spheres.row) {
            impulse[row as usize] = drag.impulse;
        }
    }
}
