//! Drag that follows the velocities of particles (docs/theory.md, DRG-3), and its impulse.

use calcine_coupler::physics::Vec3;
use rayon::prelude::*;

use super::super::motion::{self, KickInputs};
use super::super::sphere::{SphereDrag, Spheres};
use super::{Engine, Portion};

/// Particles of a block, with their drags.
type DragPortion<'a> = (Portion<'a>, &'a mut [SphereDrag]);

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

    /// Kicks and moves the particles; their largest speed in m/s.
    pub(super) fn drift_with_drag(
        &mut self,
        kick: &KickInputs,
        size: usize,
        parallel: bool,
    ) -> f64 {
        let (counting, outgoing, spheres) = (self.counting, &self.outgoing, &mut self.spheres);
        let work = |((((block, place), moves), push), drag): DragPortion<'_>| {
            if kick.times > 1 {
                block.take_up(outgoing);
            }
            let own = (place, moves);
            if counting {
                motion::drift_with_drag::<true>(block, kick, own, push, drag)
            } else {
                motion::drift_with_drag::<false>(block, kick, own, push, drag)
            }
        };
        let fastest = if parallel {
            self.blocks
                .par_iter_mut()
                .zip(spheres.place.par_chunks_mut(size))
                .zip(spheres.moves.par_chunks_mut(size))
                .zip(spheres.push.par_chunks(size))
                .zip(spheres.drag.par_chunks_mut(size))
                .map(work)
                .reduce(|| 0.0, f64::max)
        } else {
            self.blocks
                .iter_mut()
                .zip(spheres.place.chunks_mut(size))
                .zip(spheres.moves.chunks_mut(size))
                .zip(spheres.push.chunks(size))
                .zip(spheres.drag.chunks_mut(size))
                .map(work)
                .fold(0.0, f64::max)
        };
        fastest.sqrt()
    }

    /// The last half kick of a window.
    pub(super) fn close_with_drag(&mut self, kick: &KickInputs, size: usize) {
        let Spheres {
            moves, push, drag, ..
        } = &mut self.spheres;
        let blocks = self.blocks.iter_mut().zip(moves.chunks_mut(size));
        let portions = blocks.zip(push.chunks(size)).zip(drag.chunks_mut(size));
        for (((block, moves), push), drag) in portions {
            motion::close_with_drag(block, kick, moves, push, drag);
        }
    }
}
