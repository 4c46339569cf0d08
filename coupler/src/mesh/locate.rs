//! Finding cells by position, for general polyhedra.

use std::borrow::Cow;
use std::f64::consts::TAU;
use std::ops::Deref;

use calcine_physics::Vec3;

use super::{Mesh, bounds};

/// Finds the cells of a mesh by position: a regular grid of bins, finer where cells are, lists the
/// cells whose bounding boxes reach into each bin; among those the faces decide. The mesh is borrowed or shared.
#[derive(Clone, Debug)]
pub struct Locator<M> {
    mesh: M,
    boxes: Vec<[Vec3; 2]>,
    /// Unit normals of the faces, out of their owners.
    normal: Vec<Vec3>,
    /// How far each face's points lie from its plane, in m; 0 to round-off for plane faces.
    warp: Vec<f64>,
    bins: Bins,
}

impl<M: Deref<Target = Mesh>> Locator<M> {
    /// The locator of a mesh.
    pub fn new(owner: M) -> Self {
        let mesh: &Mesh = &owner;
        let points = &mesh.topology().points;
        let boxes: Vec<_> = (0..mesh.cells())
            .map(|cell| {
                let faces = mesh.faces_of(cell).iter();
                bounds(
                    faces
                        .flat_map(|&face| mesh.face_points(face as usize))
                        .map(|&point| points[point as usize]),
                )
            })
            .collect();
        let bins = Bins::new(&boxes);
        let warp = (0..mesh.faces()).map(|face| warp(mesh, face)).collect();
        let normal = mesh.face_area().iter().map(Vec3::normalize).collect();
        Self {
            mesh: owner,
            boxes,
            normal,
            warp,
            bins,
        }
    }

    /// How far a face's points lie from its plane, in m; 0 for plane faces (to 1e-9 of their size).
    pub fn warp(&self, face: usize) -> f64 {
        self.warp[face]
    }

    /// The mesh.
    pub fn mesh(&self) -> &Mesh {
        &self.mesh
    }

    /// Unit normal of a face, out of its owner.
    pub fn normal(&self, face: usize) -> Vec3 {
        self.normal[face]
    }

    /// The cell that holds a position; `None` outside the mesh. A position on a face belongs to
    /// one of its cells.
    pub fn cell_at(&self, position: Vec3) -> Option<usize> {
        self.cell_and_depth(position).map(|(cell, _)| cell)
    }

    /// The cell that holds a position, and how deep it lies there, see [`Locator::depth`].
    pub fn cell_and_depth(&self, position: Vec3) -> Option<(usize, f64)> {
        let candidates = self.bins.at(position)?;
        let mut best: Option<(usize, f64)> = None;
        for &cell in candidates.iter() {
            let cell = cell as usize;
            // Within round-off of coordinates, so that a position on a wall lies inside.
            let [lower, upper] = self.boxes[cell];
            let margin = 1e-12 * (upper - lower).norm();
            let beyond = (lower - position).sup(&(position - upper)).max();
            if beyond > margin {
                continue;
            }
            let depth = self.depth(cell, position);
            // No other cell holds what lies well within all planes of one.
            if depth > margin {
                return Some((cell, depth));
            }
            if best.is_none_or(|(_, deepest)| depth > deepest) {
                best = Some((cell, depth));
            }
        }
        let (cell, depth) = best?;
        let [lower, upper] = self.boxes[cell];
        if depth >= -1e-12 * (upper - lower).norm() {
            return Some((cell, depth));
        }
        // Cells that are not convex or have warped faces: the faces of the right one surround it.
        let surrounds = |&&cell: &&u32| self.surrounds(cell as usize, position);
        let cell = *candidates.iter().find(surrounds)? as usize;
        Some((cell, self.depth(cell, position)))
    }

    /// A distance in m that a sphere around a position may have without leaving the cell; negative
    /// where a plane through a face, moved inwards by what the face is warped, is passed.
    pub fn depth(&self, cell: usize, position: Vec3) -> f64 {
        let mut least = f64::INFINITY;
        for &face in self.mesh.faces_of(cell) {
            let face = face as usize;
            let away = self.mesh.face_centre()[face] - position;
            let height = self.mesh.side(cell, face) * self.normal[face].dot(&away);
            least = least.min(height - self.warp[face]);
        }
        least
    }

    /// The number of a region of space that holds a position, or is nearest to it: neighbours have the same, or one
    /// near it.
    pub fn region(&self, position: Vec3) -> usize {
        self.bins.region(position)
    }

    /// Number of these regions.
    pub fn regions(&self) -> usize {
        self.bins.blocks().iter().product::<usize>() * BLOCK.pow(3)
    }

    /// Sets `cells` to those whose bounding boxes reach into a sphere, ascending.
    pub fn cells_near(&self, centre: Vec3, radius: f64, cells: &mut Vec<u32>) {
        let reach = Vec3::repeat(radius);
        self.bins.between(centre - reach, centre + reach, cells);
        cells.retain(|&cell| {
            let [lower, upper] = self.boxes[cell as usize];
            let nearest = centre.sup(&lower).inf(&upper);
            (nearest - centre).norm_squared() < radius * radius
        });
    }

    /// Whether the faces of a cell wind around a position, or around one within round-off of it
    /// towards the cell's centre.
    fn surrounds(&self, cell: usize, position: Vec3) -> bool {
        let inwards = (self.mesh.cell_centre()[cell] - position) * 1e-9;
        self.winding(cell, position) > 0.5 || self.winding(cell, position + inwards) > 0.5
    }

    /// How often the faces of a cell wind around a position: 1 inside, 0 outside.
    fn winding(&self, cell: usize, position: Vec3) -> f64 {
        let mut angle = 0.0;
        for &face in self.mesh.faces_of(cell) {
            let face = face as usize;
            let points = self.mesh.face_points(face);
            let at = |i: usize| {
                self.mesh.topology().points[points[i % points.len()] as usize] - position
            };
            let middle = (0..points.len()).map(at).sum::<Vec3>() / points.len() as f64;
            let sign = self.mesh.side(cell, face);
            for i in 0..points.len() {
                angle += sign * solid_angle(middle, at(i), at(i + 1));
            }
        }
        angle / (2.0 * TAU)
    }
}

/// Solid angle of a triangle seen from the origin, positive where its corners run clockwise seen
/// from there (outward normal away from the origin).
///
/// tan(Ω/2) = a·(b × c)/(abc + (a·b)c + (b·c)a + (c·a)b). A. Van Oosterom, J. Strackee, IEEE Trans.
/// Biomed. Eng. 30 (1983) 125, doi:10.1109/TBME.1983.325207.
fn solid_angle(a: Vec3, b: Vec3, c: Vec3) -> f64 {
    let (la, lb, lc) = (a.norm(), b.norm(), c.norm());
    let denominator = la * lb * lc + a.dot(&b) * lc + b.dot(&c) * la + c.dot(&a) * lb;
    2.0 * a.dot(&b.cross(&c)).atan2(denominator)
}

/// Greatest distance in m of a face's points from the plane through its centre, 0 below round-off.
fn warp(mesh: &Mesh, face: usize) -> f64 {
    let area = mesh.face_area()[face];
    let normal = area.normalize();
    let centre = mesh.face_centre()[face];
    let points = mesh.face_points(face).iter();
    let distance = |&point: &u32| {
        let from = mesh.topology().points[point as usize] - centre;
        normal.dot(&from).abs()
    };
    let greatest = points.map(distance).fold(0.0, f64::max);
    if greatest > 1e-9 * area.norm().sqrt() {
        greatest
    } else {
        0.0
    }
}

/// Ratio of the mean extents of cells along two axes from which their bins have another shape than cubes.
const ELONGATED: f64 = 16.0;

/// A regular grid over a box, about as many bins as cells; crowded bins hold a finer grid.
#[derive(Clone, Debug)]
struct Bins {
    lower: Vec3,
    upper: Vec3,
    count: [usize; 3],
    offsets: Vec<usize>,
    cells: Vec<u32>,
    /// Grids of the crowded bins, by ascending bin.
    finer: Vec<(usize, Bins)>,
    /// How far in m from a bin a cell may lie that reaches into it by its box only by round-off.
    slack: f64,
}

/// Boxes count without this share of their edges at their sides: those that a bin only touches, 26 for a bin as large as
/// equal cells, are none of its cells.
const WITHIN: f64 = 1e-10;
/// Cells of a bin from which on it gets a finer grid; a bin may lie across eight equal cells.
const CROWDED: usize = 64;
/// Bins along the edge of a block: as many as keep what is known of their cells in a processor's own memory.
const BLOCK: usize = 4;
/// Grids inside one another at most.
const DEPTH: usize = 4;

impl Bins {
    fn new(boxes: &[[Vec3; 2]]) -> Self {
        let all: Vec<u32> = (0..boxes.len() as u32).collect();
        let inner = |&[lower, upper]: &[Vec3; 2]| {
            let within = (upper - lower) * WITHIN;
            [lower + within, upper - within]
        };
        let inner: Vec<_> = boxes.iter().map(inner).collect();
        let largest = boxes.iter().map(|[lower, upper]| (upper - lower).max());
        Self {
            slack: 2.0 * WITHIN * largest.fold(0.0, f64::max),
            ..Self::over(bounds(boxes.iter().flatten().copied()), &all, &inner, 1)
        }
    }

    fn over([lower, upper]: [Vec3; 2], cells: &[u32], boxes: &[[Vec3; 2]], depth: usize) -> Self {
        let size = upper - lower;
        // Bins of long cells are as long as they are; in cubes each would lie in very many.
        let mean = cells.iter().fold(Vec3::zeros(), |sum, &cell| {
            let [low, high] = boxes[cell as usize];
            sum + (high - low) / cells.len() as f64
        });
        let shape = match mean.max() > ELONGATED * mean.min() && mean.min() > 0.0 {
            true => mean / mean.product().cbrt(),
            false => Vec3::repeat(1.0),
        };
        let edge = (size.product() / cells.len() as f64).cbrt();
        let along = |axis: usize| {
            let count = (size[axis] / (edge * shape[axis])).ceil();
            (count as usize).clamp(1, cells.len())
        };
        let mut bins = Self {
            lower,
            upper,
            count: [along(0), along(1), along(2)],
            offsets: Vec::new(),
            cells: Vec::new(),
            finer: Vec::new(),
            slack: 0.0,
        };
        let mut lists = vec![Vec::new(); bins.count.iter().product()];
        for &cell in cells {
            let [low, high] = boxes[cell as usize];
            for bin in bins.range(low, high) {
                lists[bin].push(cell);
            }
        }
        bins.offsets.push(0);
        for (bin, list) in lists.into_iter().enumerate() {
            if list.len() > CROWDED && depth < DEPTH {
                let finer = Self::over(bins.bounds_of(bin), &list, boxes, depth + 1);
                bins.finer.push((bin, finer));
            } else {
                bins.cells.extend(list);
            }
            bins.offsets.push(bins.cells.len());
        }
        bins
    }

    /// Lowest and highest corner of a bin in m.
    fn bounds_of(&self, bin: usize) -> [Vec3; 2] {
        let [nx, ny, _] = self.count;
        let place = [bin % nx, bin / nx % ny, bin / (nx * ny)];
        [0, 1].map(|end| {
            let share = |axis: usize| (place[axis] + end) as f64 / self.count[axis] as f64;
            let shares = Vec3::new(share(0), share(1), share(2));
            self.lower + (self.upper - self.lower).component_mul(&shares)
        })
    }

    /// The finer grid of a crowded bin.
    fn finer(&self, bin: usize) -> Option<&Self> {
        let place = self.finer.binary_search_by_key(&bin, |(bin, _)| *bin);
        place.ok().map(|place| &self.finer[place].1)
    }

    /// The bin's index along an axis, clamped into the grid.
    fn index(&self, axis: usize, coordinate: f64) -> usize {
        let share = (coordinate - self.lower[axis]) / (self.upper[axis] - self.lower[axis]);
        // A float that is negative or NaN becomes 0.
        ((share * self.count[axis] as f64) as usize).min(self.count[axis] - 1)
    }

    fn range(&self, low: Vec3, high: Vec3) -> impl Iterator<Item = usize> + use<> {
        let span = |axis: usize| self.index(axis, low[axis])..=self.index(axis, high[axis]);
        let [nx, ny, _] = self.count;
        let (x, y) = (span(0), span(1));
        span(2).flat_map(move |k| {
            let x = x.clone();
            y.clone()
                .flat_map(move |j| x.clone().map(move |i| i + nx * (j + ny * k)))
        })
    }

    /// Cells that may hold a position; `None` beyond the mesh (and for NaN).
    fn at(&self, position: Vec3) -> Option<Cow<'_, [u32]>> {
        let margin = 1e-12 * (self.upper - self.lower).norm();
        let inside = |axis: usize| {
            position[axis] >= self.lower[axis] - margin
                && position[axis] <= self.upper[axis] + margin
        };
        let slack = Vec3::repeat(self.slack);
        (0..3)
            .all(inside)
            .then(|| self.around(position - slack, position + slack))
    }

    /// Blocks of bins along each axis.
    fn blocks(&self) -> [usize; 3] {
        self.count.map(|count| count.div_ceil(BLOCK))
    }

    /// The bin of a position, or the nearest one, counted block by block.
    fn region(&self, position: Vec3) -> usize {
        let at = [0, 1, 2].map(|axis| self.index(axis, position[axis]));
        let place =
            |of: [usize; 3], count: [usize; 3]| of[0] + count[0] * (of[1] + count[1] * of[2]);
        let block = place(at.map(|i| i / BLOCK), self.blocks());
        block * BLOCK.pow(3) + place(at.map(|i| i % BLOCK), [BLOCK; 3])
    }

    /// The bin of a position, or the nearest one.
    fn place(&self, position: Vec3) -> usize {
        let [i, j, k] = [0, 1, 2].map(|axis| self.index(axis, position[axis]));
        i + self.count[0] * (j + self.count[1] * k)
    }

    /// Cells of the bins of a small box, or of the nearest bins.
    fn around(&self, low: Vec3, high: Vec3) -> Cow<'_, [u32]> {
        let bin = self.place(low);
        if bin != self.place(high) {
            let mut cells = Vec::new();
            self.between(low, high, &mut cells);
            return Cow::Owned(cells);
        }
        match self.finer(bin) {
            Some(finer) => finer.around(low, high),
            None => Cow::Borrowed(&self.cells[self.offsets[bin]..self.offsets[bin + 1]]),
        }
    }

    /// Sets `cells` to those of all bins of a box, ascending, each once.
    fn between(&self, low: Vec3, high: Vec3, cells: &mut Vec<u32>) {
        cells.clear();
        self.gather(low, high, cells);
        cells.sort_unstable();
        cells.dedup();
    }

    fn gather(&self, low: Vec3, high: Vec3, cells: &mut Vec<u32>) {
        for bin in self.range(low, high) {
            match self.finer(bin) {
                Some(finer) => finer.gather(low, high, cells),
                None => cells.extend(&self.cells[self.offsets[bin]..self.offsets[bin + 1]]),
            }
        }
    }
}
