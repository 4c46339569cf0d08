//! Straight ways through the tetrahedra of a mesh.

use calcine_coupler::mesh::tetrahedra::TetPlace;
use calcine_coupler::physics::Vec3;

use super::tetrahedra::{Beyond, Tetrahedra};

/// Sides in a row that a way may cross without getting on: around an edge or a corner of the mesh there are fewer.
const STANDSTILL: u32 = 256;
/// Progress, as a share of the way, below which it does not get on.
const PROGRESS: f64 = 1e-12;
/// How far towards the middle of its tetrahedron, as a share of the distance, a parcel is put that does not get on.
const ASIDE: f64 = 1e-7;
/// The same for one at a wall, so that it stands on the wall's inner side.
const INSIDE: f64 = 1e-12;
/// Times that a parcel is put aside in one way.
const TRIALS: u32 = 8;

/// Where a way has ended.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum WayEnd {
    /// At its end.
    Arrived,
    /// At a wall: after this share of the way, with the wall's unit normal out of the domain.
    Wall {
        /// Share of the way.
        share: f64,
        /// The boundary face.
        face: usize,
        /// Unit normal.
        normal: Vec3,
    },
}

impl Tetrahedra {
    /// Takes a parcel along a straight way in m, from tetrahedron to tetrahedron, up to its end or a wall. Barycentric
    /// coordinates along the way tell through which side it leaves each. In a tetrahedron that is turned inside out, where
    /// cells fold over, the way is run backwards, so that it leaves the fold where it ought to. Round-off never loses a
    /// parcel: what cannot get on at a corner is put aside by 1e-7 of the distance to the middle of its tetrahedron.
    pub fn take(&self, place: &mut TetPlace, at: &mut Vec3, way: Vec3) -> WayEnd {
        let mut way = way;
        let mut done = 0.0;
        for _ in 0..TRIALS {
            match self.walk(place, at, way) {
                Walk::End(WayEnd::Wall {
                    share,
                    face,
                    normal,
                }) => {
                    let share = done + (1.0 - done) * share;
                    return WayEnd::Wall {
                        share,
                        face,
                        normal,
                    };
                }
                Walk::End(end) => return end,
                Walk::Stuck(share) => {
                    self.pull(*place, at, ASIDE);
                    way *= 1.0 - share;
                    done += (1.0 - done) * share;
                }
            }
        }
        // It stays where it is for this time.
        WayEnd::Arrived
    }

    fn walk(&self, place: &mut TetPlace, at: &mut Vec3, way: Vec3) -> Walk {
        let mut start = *at;
        let (mut reached, mut idle) = (0.0_f64, 0);
        loop {
            let map = self.map(*place);
            let (here, rate) = (map.of(start), map.along(way));
            let direction = map.determinant.signum();
            let (mut side, mut share) = (usize::MAX, f64::INFINITY);
            for corner in 0..4 {
                if direction * rate[corner] < 0.0 {
                    let leaves = -here[corner] / rate[corner];
                    if direction * leaves < share {
                        (side, share) = (corner, direction * leaves);
                    }
                }
            }
            share *= direction;
            if direction > 0.0 && (side == usize::MAX || share >= 1.0) {
                *at = start + way;
                return Walk::End(WayEnd::Arrived);
            }
            if share > reached + PROGRESS {
                (reached, idle) = (share, 0);
            } else {
                idle += 1;
            }
            if idle > STANDSTILL || side == usize::MAX || !share.is_finite() {
                let share = reached.clamp(0.0, 1.0);
                *at = start + share * way;
                return Walk::Stuck(share);
            }
            match self.beyond(*place, side) {
                Beyond::Place(next) => *place = next,
                Beyond::Shifted(next, shift) => {
                    *place = next;
                    start += shift;
                }
                Beyond::Wall => {
                    let share = share.clamp(0.0, 1.0);
                    *at = start + share * way;
                    self.pull(*place, at, INSIDE);
                    return Walk::End(WayEnd::Wall {
                        share,
                        face: place.face as usize,
                        normal: self.outward(*place).normalize(),
                    });
                }
            }
        }
    }

    /// Moves a place towards the middle of a tetrahedron by a share of the distance.
    fn pull(&self, place: TetPlace, at: &mut Vec3, share: f64) {
        let corners = self.corners(place);
        let middle = corners.iter().sum::<Vec3>() / 4.0;
        *at += share * (middle - *at);
    }
}

/// How a walk ended: as the way, or at a corner after a share of it.
enum Walk {
    End(WayEnd),
    Stuck(f64),
}
