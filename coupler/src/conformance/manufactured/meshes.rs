//! Boxes of hexahedra, tetrahedra and polyhedra, sheared and perturbed.

use std::collections::BTreeMap;

use calcine_physics::Vec3;

use super::solution::WIDTH;
use crate::mesh::block::{BoxSpec, box_mesh};
use crate::mesh::{Mesh, MeshError, Patch, Topology};

/// What the cells of a box are.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum CellShape {
    /// Hexahedra, whose points are displaced at random by up to this share of their edges.
    Hexahedra(f64),
    /// Six tetrahedra in place of each of these.
    Tetrahedra(f64),
    /// The duals of those tetrahedra: a cell around each of their points, with fourteen faces inside the box.
    Polyhedra(f64),
}

/// Patches of the box: walls across ξ and ζ, planes of symmetry across η.
const PATCHES: [&str; 2] = ["wall", "symmetry"];

/// The box of so many cells along ξ and ζ, and half of them along η; its points as `displaced` puts them.
pub fn shaped_box(
    shape: CellShape,
    cells: usize,
    displaced: impl Fn(Vec3) -> Vec3,
) -> Result<Mesh, MeshError> {
    let counts = [cells, cells.div_ceil(2), cells];
    let names = ["wall", "wall", "symmetry", "symmetry", "wall", "wall"];
    let upright = box_mesh(&BoxSpec {
        origin: Vec3::zeros(),
        size: Vec3::new(1.0, WIDTH, 1.0),
        cells: counts,
        patches: names.map(str::to_owned),
    })?;
    let (CellShape::Hexahedra(share) | CellShape::Tetrahedra(share) | CellShape::Polyhedra(share)) =
        shape;
    let mut topology = upright.topology().clone();
    perturb(&mut topology.points, counts, share);
    match shape {
        CellShape::Hexahedra(_) => {
            for point in &mut topology.points {
                *point = displaced(*point);
            }
            Mesh::new(topology)
        }
        CellShape::Tetrahedra(_) => {
            let faces = faces_of(&tetrahedra(counts), &topology.points);
            Mesh::new(joined(topology.points, faces, &PATCHES, displaced))
        }
        CellShape::Polyhedra(_) => {
            let (points, faces) = dual(&tetrahedra(counts), &topology.points);
            Mesh::new(joined(points, faces, &PATCHES, displaced))
        }
    }
}

/// Displaces points; those of a side stay on it.
fn perturb(points: &mut [Vec3], counts: [usize; 3], share: f64) {
    let mut state = 1u64;
    let mut random = || {
        state = state
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    };
    let size = [1.0, WIDTH, 1.0];
    for point in points {
        for axis in 0..3 {
            let way = share * random() * size[axis] / counts[axis] as f64;
            if side_along(point[axis], size[axis]).is_none() {
                point[axis] += way;
            }
        }
    }
}

fn side_along(at: f64, size: f64) -> Option<usize> {
    let near = |value: f64| (at - value).abs() < 1e-9 * size;
    [0.0, size].into_iter().position(near)
}

/// The sides of the upright box that a point is on, as bits.
fn sides(point: &Vec3) -> u32 {
    let size = [1.0, WIDTH, 1.0];
    let bit =
        |axis: usize| side_along(point[axis], size[axis]).map_or(0, |side| 1 << (2 * axis + side));
    (0..3).map(bit).sum()
}

/// A face: its cells, the patch of one at the boundary, and its points in any sense.
pub(super) struct RawFace {
    pub owner: u32,
    pub neighbour: Option<u32>,
    pub patch: usize,
    pub points: Vec<u32>,
    /// A vector that its normal must follow.
    pub out: Vec3,
}

fn patch_of(side: u32) -> usize {
    usize::from(side & 0b00_1100 != 0)
}

/// Kuhn's six tetrahedra of each hexahedron, whose faces match across all.
pub(super) fn tetrahedra([nx, ny, nz]: [usize; 3]) -> Vec<[u32; 4]> {
    let orders = [
        [0, 1, 2],
        [0, 2, 1],
        [1, 0, 2],
        [1, 2, 0],
        [2, 0, 1],
        [2, 1, 0],
    ];
    let number = |at: [usize; 3]| (at[0] + (nx + 1) * (at[1] + (ny + 1) * at[2])) as u32;
    let mut cells = Vec::new();
    for k in 0..nz {
        for j in 0..ny {
            for i in 0..nx {
                for order in orders {
                    let mut at = [i, j, k];
                    let mut cell = [number(at); 4];
                    for (corner, axis) in cell[1..].iter_mut().zip(order) {
                        at[axis] += 1;
                        *corner = number(at);
                    }
                    cells.push(cell);
                }
            }
        }
    }
    cells
}

pub(super) fn mean(points: &[Vec3], indices: &[u32]) -> Vec3 {
    indices
        .iter()
        .map(|&index| points[index as usize])
        .sum::<Vec3>()
        / indices.len() as f64
}

/// Triangles of tetrahedra by their points, each with the cells on its sides.
pub(super) fn triangles(cells: &[[u32; 4]]) -> BTreeMap<[u32; 3], Vec<u32>> {
    let mut triangles: BTreeMap<[u32; 3], Vec<u32>> = BTreeMap::new();
    for (index, cell) in cells.iter().enumerate() {
        for left in 0..4 {
            let mut key = [
                cell[(left + 1) % 4],
                cell[(left + 2) % 4],
                cell[(left + 3) % 4],
            ];
            key.sort_unstable();
            triangles.entry(key).or_default().push(index as u32);
        }
    }
    triangles
}

fn common_sides(points: &[Vec3], indices: &[u32]) -> u32 {
    indices
        .iter()
        .fold(u32::MAX, |all, &index| all & sides(&points[index as usize]))
}

fn faces_of(cells: &[[u32; 4]], points: &[Vec3]) -> Vec<RawFace> {
    let face = |(key, beside): (&[u32; 3], &Vec<u32>)| {
        let centre = mean(points, &cells[beside[0] as usize]);
        RawFace {
            owner: beside[0],
            neighbour: beside.get(1).copied(),
            patch: patch_of(common_sides(points, key)),
            points: key.to_vec(),
            out: mean(points, key) - centre,
        }
    };
    triangles(cells).iter().map(face).collect()
}

/// Links (from, to, value) around an edge or within a fan.
type Links = Vec<(u32, u32, u32)>;

/// Walks links from an end, or around; returns nodes and values between them.
fn walk(mut links: Links) -> (Vec<u32>, Vec<u32>) {
    let degree = |node: u32| {
        links
            .iter()
            .filter(|link| link.0 == node || link.1 == node)
            .count()
    };
    let ends = links
        .iter()
        .flat_map(|link| [link.0, link.1])
        .find(|&node| degree(node) == 1);
    let mut at = ends.unwrap_or(links[0].0);
    let (mut nodes, mut values) = (vec![at], Vec::new());
    while let Some(next) = links.iter().position(|link| link.0 == at || link.1 == at) {
        let (from, to, value) = links.swap_remove(next);
        at = if from == at { to } else { from };
        nodes.push(at);
        values.push(value);
    }
    (nodes, values)
}

/// Points and faces of the cells around the points of tetrahedra.
fn dual(cells: &[[u32; 4]], points: &[Vec3]) -> (Vec<Vec3>, Vec<RawFace>) {
    let mut all: Vec<Vec3> = cells.iter().map(|cell| mean(points, cell)).collect();
    // Points on triangles of the boundary, and on edges and points where two sides meet.
    let mut added: BTreeMap<Vec<u32>, u32> = BTreeMap::new();
    let mut add = |key: &[u32], all: &mut Vec<Vec3>| {
        let mut key = key.to_vec();
        key.sort_unstable();
        *added.entry(key.clone()).or_insert_with(|| {
            all.push(mean(points, &key));
            all.len() as u32 - 1
        })
    };
    let mut around: BTreeMap<[u32; 2], Links> = BTreeMap::new();
    for (index, cell) in cells.iter().enumerate() {
        for (a, b, c, d) in [
            (0, 1, 2, 3),
            (0, 2, 1, 3),
            (0, 3, 1, 2),
            (1, 2, 0, 3),
            (1, 3, 0, 2),
            (2, 3, 0, 1),
        ] {
            let edge = [cell[a].min(cell[b]), cell[a].max(cell[b])];
            around
                .entry(edge)
                .or_default()
                .push((cell[c], cell[d], index as u32));
        }
    }
    let mut faces = Vec::new();
    for (&[a, b], links) in &around {
        let (nodes, mut loop_points) = walk(links.clone());
        let (first, last) = (nodes[0], nodes[nodes.len() - 1]);
        if first != last {
            loop_points.insert(0, add(&[a, b, first], &mut all));
            loop_points.push(add(&[a, b, last], &mut all));
            if common_sides(points, &[a, b]).count_ones() > 1 {
                loop_points.push(add(&[a, b], &mut all));
            }
        }
        faces.push(RawFace {
            owner: a,
            neighbour: Some(b),
            patch: 0,
            points: loop_points,
            out: points[b as usize] - points[a as usize],
        });
    }
    let mut fans: BTreeMap<(u32, u32), Links> = BTreeMap::new();
    for (key, beside) in triangles(cells) {
        if beside.len() == 1 {
            let side = common_sides(points, &key);
            let centre = add(&key, &mut all);
            for k in 0..3 {
                let link = (key[(k + 1) % 3], key[(k + 2) % 3], centre);
                fans.entry((key[k], side)).or_default().push(link);
            }
        }
    }
    for ((vertex, side), links) in fans {
        let (nodes, mut loop_points) = walk(links);
        let (first, last) = (nodes[0], nodes[nodes.len() - 1]);
        if first != last {
            loop_points.insert(0, add(&[vertex, first], &mut all));
            loop_points.push(add(&[vertex, last], &mut all));
            loop_points.push(add(&[vertex], &mut all));
        }
        let middle = Vec3::new(0.5, 0.5 * WIDTH, 0.5);
        let axis = side.trailing_zeros() as usize / 2;
        let mut out = Vec3::zeros();
        out[axis] = points[vertex as usize][axis] - middle[axis];
        faces.push(RawFace {
            owner: vertex,
            neighbour: None,
            patch: patch_of(side),
            points: loop_points,
            out,
        });
    }
    (all, faces)
}

/// The topology of faces, in upper-triangular order, with patches of these names, their points displaced.
pub(super) fn joined(
    points: Vec<Vec3>,
    mut faces: Vec<RawFace>,
    patches: &[&str],
    displaced: impl Fn(Vec3) -> Vec3,
) -> Topology {
    for face in &mut faces {
        let at = |k: usize| points[face.points[k % face.points.len()] as usize];
        let area: Vec3 = (1..face.points.len())
            .map(|k| (at(k) - at(0)).cross(&(at(k + 1) - at(0))))
            .sum();
        let mut turn = area.dot(&face.out) < 0.0;
        if let Some(neighbour) = &mut face.neighbour
            && *neighbour < face.owner
        {
            std::mem::swap(neighbour, &mut face.owner);
            turn = !turn;
        }
        if turn {
            face.points.reverse();
        }
    }
    let key = |face: &RawFace| match face.neighbour {
        Some(neighbour) => (0, face.owner, neighbour),
        None => (1 + face.patch, face.owner, 0),
    };
    faces.sort_by_key(key);
    let mut topology = Topology {
        face_offsets: vec![0],
        ..Topology::default()
    };
    for face in &faces {
        topology.face_points.extend(&face.points);
        topology
            .face_offsets
            .push(topology.face_points.len() as u32);
        topology.owner.push(face.owner);
        topology.neighbour.extend(face.neighbour);
    }
    for (patch, &name) in patches.iter().enumerate() {
        let start = faces
            .iter()
            .position(|face| face.neighbour.is_none() && face.patch == patch);
        topology.patches.push(Patch {
            name: name.to_owned(),
            start: start.unwrap_or(faces.len()),
            count: faces
                .iter()
                .filter(|face| face.neighbour.is_none() && face.patch == patch)
                .count(),
        });
    }
    topology.points = points.into_iter().map(displaced).collect();
    topology
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn all_shapes_fill_the_box() {
        for shape in [
            CellShape::Hexahedra(0.2),
            CellShape::Tetrahedra(0.0),
            CellShape::Tetrahedra(0.15),
            CellShape::Polyhedra(0.0),
            CellShape::Polyhedra(0.15),
        ] {
            let mesh = shaped_box(shape, 4, |point| point).unwrap();
            let volume: f64 = mesh.cell_volume().iter().sum();
            assert!((volume - WIDTH).abs() < 1e-12, "{shape:?}: {volume}");
            let area = |name: &str| {
                let faces = mesh.patch(name).unwrap().faces();
                faces.map(|face| mesh.face_area()[face].norm()).sum::<f64>()
            };
            assert!((area("wall") - 4.0 * WIDTH).abs() < 1e-9, "{shape:?}");
            assert!((area("symmetry") - 2.0).abs() < 1e-9, "{shape:?}");
        }
        let count = |shape| shaped_box(shape, 4, |point| point).unwrap().cells();
        assert_eq!(count(CellShape::Tetrahedra(0.1)), 6 * 32);
        assert_eq!(count(CellShape::Polyhedra(0.1)), 5 * 3 * 5);
    }
}
