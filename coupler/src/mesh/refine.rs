//! Local refinement of hexahedral meshes: cells in a zone are split 2 × 2 × 2, once or several
//! times; their coarser neighbours keep their shape and get more faces. Levels of cells that share a
//! corner differ by one at most.

use std::collections::HashMap;

use calcine_physics::Vec3;

use super::zone::Zone;
use super::{Mesh, MeshError, Patch, Topology};

/// Cells that are split.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Refinement {
    /// Cells are split whose centres lie here.
    pub zone: Zone,
    /// How often; each time halves the edges.
    pub levels: u32,
}

/// Most cells that the 32-bit lists of faces hold: up to 24 corners a cell.
const MOST_CELLS: usize = u32::MAX as usize / 24;
/// Most levels of a zone.
pub const MOST_LEVELS: u32 = 6;

/// The six sides of a hexahedron, outward. Corner numbers are bits: 1 along the first edge, 2 along
/// the second, 4 along the third; the three edges are right-handed.
const SIDES: [[usize; 4]; 6] = [
    [0, 4, 6, 2],
    [1, 3, 7, 5],
    [0, 1, 5, 4],
    [2, 6, 7, 3],
    [0, 2, 3, 1],
    [4, 5, 7, 6],
];

/// Splits the cells of a hexahedral mesh. Children take their parent's place in the numbering;
/// internal faces are in upper-triangular order, patches stay in theirs.
pub fn refine(mesh: &Mesh, refinements: &[Refinement]) -> Result<Mesh, MeshError> {
    let wrong = |text: String| Err(MeshError::Inconsistent(text));
    let mut forest = Forest::new(mesh)?;
    for level in 0..refinements.iter().map(|r| r.levels).max().unwrap_or(0) {
        if level == MOST_LEVELS {
            return wrong(format!("a region is split more than {MOST_LEVELS} times"));
        }
        let mut marks = vec![false; forest.leaves.len()];
        for (index, refinement) in refinements.iter().enumerate() {
            let mut found = false;
            for (leaf, mark) in forest.leaves.iter().zip(&mut marks) {
                let inside = refinement.zone.holds(forest.centre(leaf));
                found |= inside;
                *mark |= inside && leaf.level == level && refinement.levels > level;
            }
            if !found {
                return wrong(format!(
                    "the refined region {index} holds no centre of a cell; enlarge it, or move it"
                ));
            }
        }
        forest.balance(&mut marks);
        forest.split(&marks)?;
    }
    Mesh::new(forest.topology(mesh)?)
}

/// A cell of the refined mesh.
#[derive(Clone, Copy, Debug)]
struct Leaf {
    corners: [u32; 8],
    level: u32,
}

/// All cells, and where edges and faces were split.
struct Forest {
    points: Vec<Vec3>,
    leaves: Vec<Leaf>,
    /// Middle of each split edge, by its ends in ascending order.
    edges: HashMap<[u32; 2], u32>,
    /// Middle of each split face, by its corners in ascending order.
    faces: HashMap<[u32; 4], u32>,
}

impl Forest {
    fn new(mesh: &Mesh) -> Result<Self, MeshError> {
        let leaf = |cell: usize| {
            let corners = corners(mesh, cell).ok_or_else(|| {
                MeshError::Inconsistent(format!("cell {cell} is no hexahedron; it cannot be split"))
            })?;
            Ok(Leaf { corners, level: 0 })
        };
        Ok(Self {
            points: mesh.topology().points.clone(),
            leaves: (0..mesh.cells())
                .map(leaf)
                .collect::<Result<_, MeshError>>()?,
            edges: HashMap::new(),
            faces: HashMap::new(),
        })
    }

    fn centre(&self, leaf: &Leaf) -> Vec3 {
        self.mean(&leaf.corners)
    }

    fn mean(&self, points: &[u32]) -> Vec3 {
        let sum: Vec3 = points.iter().map(|&p| self.points[p as usize]).sum();
        sum / points.len() as f64
    }

    /// Marks coarser cells at the corners of marked ones until levels differ by one at most.
    fn balance(&self, marks: &mut [bool]) {
        let mut needed = vec![0; self.points.len()];
        loop {
            for (leaf, _) in self.leaves.iter().zip(&*marks).filter(|(_, mark)| **mark) {
                for &corner in &leaf.corners {
                    let need = &mut needed[corner as usize];
                    *need = leaf.level.max(*need);
                }
            }
            let mut changed = false;
            for (leaf, mark) in self.leaves.iter().zip(&mut *marks) {
                let coarse = |&corner: &u32| needed[corner as usize] > leaf.level;
                if !*mark && leaf.corners.iter().any(coarse) {
                    *mark = true;
                    changed = true;
                }
            }
            if !changed {
                return;
            }
        }
    }

    fn split(&mut self, marks: &[bool]) -> Result<(), MeshError> {
        let more = marks.iter().filter(|mark| **mark).count();
        let cells = self.leaves.len() + 7 * more;
        if cells > MOST_CELLS {
            return Err(MeshError::Inconsistent(format!(
                "refinement makes {cells} cells, too many for 32-bit numbering"
            )));
        }
        let old = std::mem::take(&mut self.leaves);
        self.leaves.reserve(cells);
        for (leaf, &mark) in old.into_iter().zip(marks) {
            if mark {
                self.children(&leaf);
            } else {
                self.leaves.push(leaf);
            }
        }
        Ok(())
    }

    /// Adds the eight children of a cell: its 27 points are its corners and the middles of the
    /// edges, faces and the cell between them.
    fn children(&mut self, leaf: &Leaf) {
        let mut lattice = [0; 27];
        for (place, point) in lattice.iter_mut().enumerate() {
            let steps = [place % 3, place / 3 % 3, place / 9];
            let spans = |corner: &usize| {
                (0..3).all(|axis| steps[axis] == 1 || steps[axis] / 2 == corner >> axis & 1)
            };
            let between: Vec<u32> = (0..8)
                .filter(spans)
                .map(|corner| leaf.corners[corner])
                .collect();
            *point = self.middle(&between);
        }
        for child in 0..8usize {
            let corner = |bits: usize| {
                let at = |axis: usize| (child >> axis & 1) + (bits >> axis & 1);
                lattice[at(0) + 3 * (at(1) + 3 * at(2))]
            };
            self.leaves.push(Leaf {
                corners: std::array::from_fn(corner),
                level: leaf.level + 1,
            });
        }
    }

    /// The point in the middle of one, two, four or eight corners of a cell.
    fn middle(&mut self, corners: &[u32]) -> u32 {
        let next = self.points.len() as u32;
        let mut key = corners.to_vec();
        key.sort_unstable();
        let found = match key[..] {
            [corner] => return corner,
            [a, b] => *self.edges.entry([a, b]).or_insert(next),
            [a, b, c, d] => *self.faces.entry([a, b, c, d]).or_insert(next),
            _ => next,
        };
        if found == next {
            let middle = self.mean(corners);
            self.points.push(middle);
        }
        found
    }

    /// The parts of a face that no cell has split further.
    fn parts(&self, face: [u32; 4], found: &mut Vec<[u32; 4]>) {
        let Some(&middle) = self.faces.get(&sorted(face)) else {
            found.push(face);
            return;
        };
        let between = |i: usize| {
            let (a, b) = (face[i], face[(i + 1) % 4]);
            self.edges.get(&[a.min(b), a.max(b)]).copied()
        };
        // Whoever split the face split its edges too.
        let (Some(ab), Some(bc), Some(cd), Some(da)) =
            (between(0), between(1), between(2), between(3))
        else {
            return;
        };
        let [a, b, c, d] = face;
        self.parts([a, ab, middle, da], found);
        self.parts([ab, b, bc, middle], found);
        self.parts([middle, bc, c, cd], found);
        self.parts([da, middle, cd, d], found);
    }

    /// The points along an edge, its end left out.
    fn along(&self, a: u32, b: u32, found: &mut Vec<u32>) {
        match self.edges.get(&[a.min(b), a.max(b)]) {
            Some(&middle) => {
                self.along(a, middle, found);
                self.along(middle, b, found);
            }
            None => found.push(a),
        }
    }

    fn topology(self, base: &Mesh) -> Result<Topology, MeshError> {
        // Each face by its corners: from the side of the first cell that has it.
        let mut open: HashMap<[u32; 4], (u32, [u32; 4])> = HashMap::new();
        let mut inner = Vec::new();
        let mut parts = Vec::new();
        for (cell, leaf) in self.leaves.iter().enumerate() {
            for side in SIDES {
                parts.clear();
                self.parts(side.map(|corner| leaf.corners[corner]), &mut parts);
                for &face in &parts {
                    let key = sorted(face);
                    match open.remove(&key) {
                        Some((owner, seen)) => inner.push((owner, cell as u32, seen)),
                        None => {
                            open.insert(key, (cell as u32, face));
                        }
                    }
                }
            }
        }
        inner.sort_unstable();
        let mut topology = Topology {
            face_offsets: vec![0],
            ..Topology::default()
        };
        for (owner, neighbour, face) in inner {
            self.push(&mut topology, owner, face);
            topology.neighbour.push(neighbour);
        }
        for patch in base.patches() {
            let start = topology.owner.len();
            for face in patch.faces() {
                let corners = <[u32; 4]>::try_from(base.face_points(face));
                parts.clear();
                if let Ok(corners) = corners {
                    self.parts(corners, &mut parts);
                }
                for part in &parts {
                    let (owner, seen) = open.remove(&sorted(*part)).ok_or_else(|| {
                        MeshError::Inconsistent(format!("face {face} has lost its cell"))
                    })?;
                    self.push(&mut topology, owner, seen);
                }
            }
            topology.patches.push(Patch {
                name: patch.name.clone(),
                start,
                count: topology.owner.len() - start,
            });
        }
        if !open.is_empty() {
            return Err(MeshError::Inconsistent(format!(
                "{} faces belong to no patch",
                open.len()
            )));
        }
        topology.points = self.points;
        Ok(topology)
    }

    fn push(&self, topology: &mut Topology, owner: u32, face: [u32; 4]) {
        for i in 0..4 {
            self.along(face[i], face[(i + 1) % 4], &mut topology.face_points);
        }
        topology
            .face_offsets
            .push(topology.face_points.len() as u32);
        topology.owner.push(owner);
    }
}

fn sorted(mut face: [u32; 4]) -> [u32; 4] {
    face.sort_unstable();
    face
}

/// The corners of a hexahedral cell, numbered as [`SIDES`] has them; `None` for other cells.
fn corners(mesh: &Mesh, cell: usize) -> Option<[u32; 8]> {
    let faces = mesh.faces_of(cell);
    let base = *faces.first()? as usize;
    let mut around = <[u32; 4]>::try_from(mesh.face_points(base)).ok()?;
    if mesh.owner()[base] as usize == cell {
        around.reverse();
    }
    if faces.len() != 6 {
        return None;
    }
    let mut corners = [0; 8];
    for (bits, point) in [0, 1, 3, 2].into_iter().zip(around) {
        corners[bits] = point;
        corners[bits + 4] = faces[1..].iter().find_map(|&face| {
            let points = <[u32; 4]>::try_from(mesh.face_points(face as usize)).ok()?;
            let at = points.iter().position(|&other| other == point)?;
            let beside = [points[(at + 1) % 4], points[(at + 3) % 4]];
            beside.into_iter().find(|other| !around.contains(other))
        })?;
    }
    let mut distinct = corners;
    distinct.sort_unstable();
    let all = distinct.windows(2).all(|pair| pair[0] != pair[1]);
    all.then_some(corners)
}
