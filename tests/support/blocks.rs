//! Meshes of files as users' own mesh generators make them: one block of hexahedra whose points are moved, and from which cells may be
//! left out.

#![allow(clippy::unwrap_used, dead_code)]

use std::collections::HashMap;
use std::f64::consts::PI;
use std::path::Path;

use calcine_coupler::mesh::{Mesh, Patch, Topology, polymesh};
use calcine_coupler::physics::Vec3;

/// Whether a cell with a centre is meant.
pub type Choice = dyn Fn([f64; 3]) -> bool;

/// A block.
pub struct Block<'a> {
    /// Levels of the points along each axis, before they are moved.
    pub levels: [Vec<f64>; 3],
    /// Patches of x−, x+, y−, y+, z−, z+; equal names make one patch.
    pub patches: [&'a str; 6],
    /// A patch, and whether the cell with a centre, before points are moved, is left out and leaves faces of it.
    pub hole: Option<(&'a str, &'a Choice)>,
    /// Where a point goes, in m.
    pub shape: &'a dyn Fn([f64; 3]) -> [f64; 3],
}

/// Levels from 0 to 1.
pub fn even(cells: usize) -> Vec<f64> {
    (0..=cells).map(|k| k as f64 / cells as f64).collect()
}

/// Levels of equal distance within a core that grow geometrically, at most by a ratio from one to the next, out of it.
pub fn growing(ends: [f64; 2], core: [f64; 2], cell: f64, ratio: f64) -> Vec<f64> {
    let count = ((core[1] - core[0]) / cell).round() as usize;
    let inner = (0..=count).map(|k| core[0] + k as f64 * cell);
    let mut levels: Vec<f64> = outwards(core[0] - ends[0], cell, ratio)
        .iter()
        .rev()
        .map(|way| core[0] - way)
        .collect();
    levels.extend(inner);
    let beyond = outwards(ends[1] - core[1], cell, ratio);
    levels.extend(beyond.iter().map(|way| core[1] + way));
    levels
}

/// Ways from a core to the ends of cells, the last of which is the length.
fn outwards(length: f64, cell: f64, ratio: f64) -> Vec<f64> {
    if length <= 0.0 {
        return Vec::new();
    }
    let reach = |count: i32, ratio: f64| (1..=count).map(|k| cell * ratio.powi(k)).sum::<f64>();
    let count = (1..).find(|&count| reach(count, ratio) >= length).unwrap();
    let [mut low, mut high] = [0.0, ratio];
    for _ in 0..100 {
        let middle = 0.5 * (low + high);
        if reach(count, middle) < length {
            low = middle;
        } else {
            high = middle;
        }
    }
    let mut ways: Vec<f64> = (1..=count).map(|k| reach(k, high)).collect();
    *ways.last_mut().unwrap() = length;
    ways
}

/// Displaces layers along x, so that upright edges lean by an angle in degrees.
pub fn leaning(size: [f64; 3], degrees: f64) -> impl Fn([f64; 3]) -> [f64; 3] {
    let slope = degrees.to_radians().tan();
    move |[x, y, z]| {
        let height = z * size[2];
        [x * size[0] + height * slope, y * size[1], height]
    }
}

/// A point of the square from −1 to 1 on a disc of radius 1: rings of the square become round towards the rim.
pub fn disc(a: f64, b: f64) -> [f64; 2] {
    let (ring, way) = (a.abs().max(b.abs()), a.hypot(b));
    if way == 0.0 {
        return [0.0, 0.0];
    }
    let factor = ring * ring / way + 1.0 - ring;
    [a * factor, b * factor]
}

/// A parallelogram of sides along x and at an angle in degrees from it, of one cell of thickness.
pub fn rhombus(side: f64, degrees: f64, depth: f64) -> impl Fn([f64; 3]) -> [f64; 3] {
    let (sine, cosine) = (degrees * PI / 180.0).sin_cos();
    move |[x, y, z]| [side * (x + y * cosine), side * y * sine, depth * z]
}

impl Block<'_> {
    /// Its mesh.
    pub fn mesh(&self) -> Mesh {
        let cells: [usize; 3] = std::array::from_fn(|axis| self.levels[axis].len() - 1);
        let places = |counts: [usize; 3]| {
            (0..counts[2]).flat_map(move |k| {
                (0..counts[1]).flat_map(move |j| (0..counts[0]).map(move |i| [i, j, k]))
            })
        };
        let point = |[i, j, k]: [usize; 3]| (i + (cells[0] + 1) * (j + (cells[1] + 1) * k)) as u32;
        let points = places(cells.map(|count| count + 1)).map(|at| {
            Vec3::from((self.shape)(
                [0, 1, 2].map(|axis| self.levels[axis][at[axis]]),
            ))
        });
        let kept = |at: &[usize; 3]| {
            let centre = [0, 1, 2]
                .map(|axis| 0.5 * (self.levels[axis][at[axis]] + self.levels[axis][at[axis] + 1]));
            self.hole.is_none_or(|(_, left_out)| !left_out(centre))
        };
        let numbers: HashMap<[usize; 3], u32> = (places(cells).filter(kept)).zip(0..).collect();
        let (mut inner, mut outer) = (Vec::new(), Vec::new());
        for at in places(cells).filter(kept) {
            let own = numbers[&at];
            for axis in 0..3 {
                let across = [(axis + 1) % 3, (axis + 2) % 3];
                let corners = |upper: bool| {
                    let mut base = at;
                    base[axis] += usize::from(upper);
                    let ways = [[0, 0], [1, 0], [1, 1], [0, 1]];
                    let mut face = ways.map(|way| {
                        let mut corner = base;
                        corner[across[0]] += way[0];
                        corner[across[1]] += way[1];
                        point(corner)
                    });
                    if !upper {
                        face.reverse();
                    }
                    face
                };
                let mut next = at;
                next[axis] += 1;
                match numbers.get(&next) {
                    Some(&other) => inner.push((own, other, corners(true))),
                    None => outer.push((self.side(axis, at, true), own, corners(true))),
                }
                let before = at[axis].checked_sub(1).map(|level| {
                    let mut before = at;
                    before[axis] = level;
                    before
                });
                if before.is_none_or(|before| !numbers.contains_key(&before)) {
                    outer.push((self.side(axis, at, false), own, corners(false)));
                }
            }
        }
        inner.sort_unstable();
        let mut topology = Topology {
            points: points.collect(),
            face_offsets: vec![0],
            ..Topology::default()
        };
        let push = |topology: &mut Topology, owner: u32, face: [u32; 4]| {
            topology.owner.push(owner);
            topology.face_points.extend(face);
            topology
                .face_offsets
                .push(topology.face_points.len() as u32);
        };
        for (owner, neighbour, face) in inner {
            push(&mut topology, owner, face);
            topology.neighbour.push(neighbour);
        }
        let mut names: Vec<&str> = Vec::new();
        for (name, ..) in &outer {
            if !names.contains(name) {
                names.push(name);
            }
        }
        for name in names {
            let start = topology.owner.len();
            for (_, owner, face) in outer.iter().filter(|one| one.0 == name) {
                push(&mut topology, *owner, *face);
            }
            topology.patches.push(Patch {
                name: name.into(),
                start,
                count: topology.owner.len() - start,
            });
        }
        Mesh::new(topology).unwrap()
    }

    /// The patch of a face without a cell beyond it.
    fn side(&self, axis: usize, at: [usize; 3], upper: bool) -> &str {
        let last = self.levels[axis].len() - 2;
        match (upper, at[axis]) {
            (true, level) if level == last => self.patches[2 * axis + 1],
            (false, 0) => self.patches[2 * axis],
            _ => self.hole.map_or("", |(name, _)| name),
        }
    }

    /// Writes its mesh into a folder `polyMesh` and returns it.
    pub fn write(&self, directory: &Path) -> Mesh {
        let mesh = self.mesh();
        polymesh::write(&mesh, &directory.join("polyMesh")).unwrap();
        mesh
    }
}
