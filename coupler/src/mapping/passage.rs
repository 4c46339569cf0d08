//! From cell to cell through the faces that a sphere cuts.

use std::collections::HashMap;
use std::f64::consts::PI;
use std::ops::Deref;

use calcine_physics::{Vec3, sphere};

use super::disc::Point;
use super::lanes::{Batch, CutFace, NONE};
use super::overlap::{GRAZING, Overlap};
use crate::mesh::Mesh;
use crate::mesh::locate::Locator;

/// The sides of a mesh's cells as a sphere meets them: the cells that it overlaps are found through the
/// faces that it cuts, beginning with the cell of its centre, and each face's part is found on the way.
///
/// A face whose edges the sphere does not reach takes a cap, π/3 (R − h)² (2R + h), or nothing; the others are evaluated
/// in lanes. Cells must be convex with plane faces; spheres that meet others, or whose centre lies in the plane
/// of a face to round-off, are left to [`Overlap::volumes`]. So are spheres that cut the boundary of a domain that
/// is not convex, where cells may overlap the sphere that no cut face leads to.
#[derive(Clone, Debug)]
pub(super) struct Passage {
    /// Where the sides of each cell begin in `sides`; none of cells that are not convex.
    offsets: Vec<u32>,
    sides: Vec<Side>,
    /// Whether the sphere may cut the boundary.
    is_convex: bool,
}

/// A side of a cell.
#[derive(Clone, Copy, Debug)]
struct Side {
    /// Unit normal, out of the cell.
    normal: Vec3,
    /// Height of the plane over the cell's centre in m.
    height: f64,
    /// The cell beyond, or `NONE`.
    beyond: u32,
    face: u32,
}

/// Cells and their volumes in m³ of one sphere after the other.
#[derive(Default)]
pub(super) struct Parts {
    pub cells: Vec<u32>,
    pub volumes: Vec<f64>,
    /// What faces in lanes take, kept apart: when a batch is full depends on the spheres before.
    lanes: Vec<f64>,
    /// Cells that lie in their sphere as a whole.
    whole: Vec<bool>,
    batch: Batch,
}

impl Parts {
    pub fn clear(&mut self) {
        self.truncate(0);
    }

    pub fn len(&self) -> usize {
        self.cells.len()
    }

    fn truncate(&mut self, first: usize) {
        self.batch.forget(first);
        self.cells.truncate(first);
        self.volumes.truncate(first);
        self.lanes.truncate(first);
        self.whole.truncate(first);
    }

    /// Adds a cell with a volume that is known.
    pub fn push(&mut self, cell: u32, volume: f64) {
        self.cells.push(cell);
        self.volumes.push(volume);
        self.lanes.push(0.0);
        self.whole.push(false);
    }

    /// Adds a volume that is known to a cell of the sphere whose first cell stands at `first`.
    pub fn add(&mut self, first: usize, cell: u32, volume: f64) {
        let place = self.place(first, cell);
        self.volumes[place] += volume;
    }

    /// Evaluates the faces that still wait.
    pub fn finish(&mut self, mesh: &Mesh) {
        self.batch.flush(&mut self.lanes);
        for (volume, lanes) in self.volumes.iter_mut().zip(&self.lanes) {
            *volume += lanes;
        }
        for (place, &cell) in self.cells.iter().enumerate() {
            if self.whole[place] {
                self.volumes[place] = mesh.cell_volume()[cell as usize];
            }
        }
    }

    /// The place of a cell of the sphere whose first cell stands at `first`; at the end where it is new.
    fn place(&mut self, first: usize, cell: u32) -> usize {
        let known = self.cells[first..].iter().position(|&known| known == cell);
        known.map_or_else(
            || {
                self.push(cell, 0.0);
                self.cells.len() - 1
            },
            |place| first + place,
        )
    }
}

/// How the disc that a sphere cuts from a plane lies in a face.
enum Disc {
    Within,
    Beside,
    Across,
}

impl Passage {
    /// The sides of a mesh's cells.
    pub fn new<M: Deref<Target = Mesh>>(locator: &Locator<M>, overlap: &Overlap) -> Self {
        let mesh = locator.mesh();
        let mut offsets = vec![0];
        let mut sides = Vec::with_capacity(6 * mesh.cells());
        for cell in 0..mesh.cells() {
            if overlap.is_convex(cell) {
                sides.extend(mesh.faces_of(cell).iter().map(|&face| {
                    let index = face as usize;
                    let normal = mesh.side(cell, index) * locator.normal(index);
                    let away = mesh.face_centre()[index] - mesh.cell_centre()[cell];
                    let beyond = mesh.across(cell, index);
                    Side {
                        normal,
                        height: normal.dot(&away),
                        beyond: beyond.map_or(NONE, |cell| cell as u32),
                        face,
                    }
                }));
            }
            offsets.push(sides.len() as u32);
        }
        Self {
            offsets,
            sides,
            is_convex: is_convex(locator),
        }
    }

    #[cfg(test)]
    pub fn is_convex(&self) -> bool {
        self.is_convex
    }

    fn sides(&self, cell: usize) -> &[Side] {
        &self.sides[self.offsets[cell] as usize..self.offsets[cell + 1] as usize]
    }

    /// The cell in which a position lies deeper than round-off, and how deep, by steps from a cell
    /// near it; `None` where they lead nowhere. No other cell holds such a position, so that the first cell decides about
    /// the work alone.
    pub fn home(&self, mesh: &Mesh, position: Vec3, near: usize) -> Option<(usize, f64)> {
        /// Cells that are tried.
        const STEPS: usize = 8;
        /// Depths, as a share of the cell's smallest extent, from which on no other cell is possible.
        const CERTAIN: f64 = 1e-9;
        let mut cell = near;
        for _ in 0..STEPS {
            let from = position - mesh.cell_centre()[cell];
            let (mut depth, mut beyond, mut extent) = (f64::INFINITY, NONE, f64::INFINITY);
            for side in self.sides(cell) {
                let height = side.height - side.normal.dot(&from);
                extent = extent.min(side.height);
                if height < depth {
                    (depth, beyond) = (height, side.beyond);
                }
            }
            if depth > CERTAIN * extent {
                return depth.is_finite().then_some((cell, depth));
            }
            if depth >= 0.0 || beyond == NONE || depth.is_nan() {
                return None;
            }
            cell = beyond as usize;
        }
        None
    }

    /// Adds the cells that a sphere overlaps, the first that of its centre, to the parts, whose volumes stand when they are
    /// finished. False, and nothing is added, where the sphere must be left to the general way.
    pub fn gather(
        &self,
        mesh: &Mesh,
        overlap: &Overlap,
        home: usize,
        (centre, radius): (Vec3, f64),
        parts: &mut Parts,
    ) -> bool {
        let first = parts.len();
        parts.push(home as u32, 0.0);
        let mut next = first;
        while next < parts.len() {
            if !self.pass(mesh, overlap, (centre, radius), (first, next), parts) {
                parts.truncate(first);
                return false;
            }
            next += 1;
        }
        true
    }

    /// Adds what the faces of the cell at `place` take, and the cells beyond them.
    fn pass(
        &self,
        mesh: &Mesh,
        overlap: &Overlap,
        (centre, radius): (Vec3, f64),
        (first, place): (usize, usize),
        parts: &mut Parts,
    ) -> bool {
        let cell = parts.cells[place] as usize;
        let sides = self.sides(cell);
        let from = centre - mesh.cell_centre()[cell];
        if sides.is_empty() {
            return false;
        }
        if overlap.holds_all(cell, from.norm(), radius) {
            parts.whole[place] = true;
            for side in sides {
                if side.beyond != NONE {
                    parts.place(first, side.beyond);
                } else if !self.is_convex {
                    return false;
                }
            }
            return true;
        }
        let mut is_home = true;
        for side in sides {
            let height = side.height - side.normal.dot(&from);
            is_home &= height > 0.0;
            if height.abs() >= radius {
                continue;
            }
            // Round-off of a height is that of the cell's extent.
            if height.abs() < GRAZING * radius + 1e-14 * side.height {
                return false;
            }
            // Faces of cells before have been passed from there, unless these are whole.
            let known = parts.cells[first..place]
                .iter()
                .position(|&known| known == side.beyond);
            if known.is_some_and(|known| !parts.whole[first + known]) {
                continue;
            }
            let face = overlap.face(side.face);
            let corners = overlap.corners_of(face);
            let foot = face.foot(centre);
            let square = (radius - height) * (radius + height);
            let disc = disc_in(corners, foot, square);
            if matches!(disc, Disc::Beside) {
                continue;
            }
            let slots = match (side.beyond, known) {
                (NONE, _) if !self.is_convex => return false,
                (NONE, _) => [place as u32, NONE],
                (_, Some(known)) => [place as u32, (first + known) as u32],
                (beyond, None) => [place as u32, parts.place(first, beyond) as u32],
            };
            let within = match disc {
                Disc::Within => -cap(height, radius),
                _ if corners.len() > 4 => overlap.within(face, centre, height, radius),
                _ => {
                    let cut = CutFace {
                        corners,
                        foot,
                        height,
                        radius,
                        slots,
                    };
                    parts.batch.push(&cut, &mut parts.lanes);
                    continue;
                }
            };
            parts.volumes[slots[0] as usize] += within;
            if slots[1] != NONE {
                parts.volumes[slots[1] as usize] -= within;
            }
        }
        if is_home {
            parts.volumes[place] += sphere::volume(radius);
        }
        true
    }
}

/// Volume in m³ of a sphere beyond a plane at a height over its centre, with the sign of the height.
fn cap(height: f64, radius: f64) -> f64 {
    let over = radius - height.abs();
    PI / 3.0 * over * over * (2.0 * radius + height.abs()) * height.signum()
}

/// How a disc around a foot, of some radius squared, lies in a convex polygon, counter-clockwise.
#[inline]
fn disc_in(corners: &[Point], foot: Point, square: f64) -> Disc {
    let Some(last) = corners.last() else {
        return Disc::Beside;
    };
    let (mut a, mut within) = (last - foot, true);
    for corner in corners {
        let b = corner - foot;
        let along = b - a;
        // The edge's distance from the foot, times its length; positive where the foot lies inside.
        let distance = a.perp(&b);
        let is_reached = distance * distance < square * along.norm_squared();
        if !is_reached && distance < 0.0 {
            return Disc::Beside;
        }
        within &= !is_reached;
        a = b;
    }
    if within { Disc::Within } else { Disc::Across }
}

/// Whether the whole domain is convex, so that the part of any sphere in it is connected: its boundary is convex at
/// each edge, and its cells are connected (H. Tietze, Math. Z. 28 (1928) 697, doi:10.1007/BF01181191).
fn is_convex<M: Deref<Target = Mesh>>(locator: &Locator<M>) -> bool {
    let mesh = locator.mesh();
    let point = |index: u32| mesh.topology().points[index as usize];
    // Faces at each edge of the boundary; points to the precision at which a face counts as plane.
    let mut edges: HashMap<[u32; 2], Vec<usize>> = HashMap::new();
    for face in mesh.internal_faces()..mesh.faces() {
        if locator.warp(face) != 0.0 {
            return false;
        }
        let points = mesh.face_points(face);
        for (k, &a) in points.iter().enumerate() {
            let b = points[(k + 1) % points.len()];
            edges.entry([a.min(b), a.max(b)]).or_default().push(face);
        }
    }
    let behind = |face: usize, other: usize| {
        let (normal, centre) = (locator.normal(face), mesh.face_centre()[face]);
        let points = mesh.face_points(other).iter();
        points
            .map(|&index| point(index) - centre)
            .all(|from| normal.dot(&from) <= 1e-9 * from.norm())
    };
    let is_convex = |faces: &Vec<usize>| match faces[..] {
        [a, b] => behind(a, b) && behind(b, a),
        _ => false,
    };
    edges.values().all(is_convex) && is_connected(mesh)
}

/// Whether every cell can be reached from every other through faces.
fn is_connected(mesh: &Mesh) -> bool {
    let mut seen = vec![false; mesh.cells()];
    let (mut stack, mut count) = (vec![0], 1);
    seen[0] = true;
    while let Some(cell) = stack.pop() {
        for &face in mesh.faces_of(cell) {
            if let Some(other) = mesh.across(cell, face as usize)
                && !seen[other]
            {
                seen[other] = true;
                count += 1;
                stack.push(other);
            }
        }
    }
    count == mesh.cells()
}
