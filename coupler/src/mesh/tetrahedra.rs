//! Cells as tetrahedra: one between the centre of the cell, the centre of a face and an edge of that face. The triangles in
//! which two cells meet are the same from both sides, so that the tetrahedra fill the mesh without gaps, warped faces too.

use calcine_physics::Vec3;

use super::Mesh;

/// A tetrahedron of a mesh.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct TetPlace {
    /// Cell.
    pub cell: u32,
    /// Face of the cell.
    pub face: u32,
    /// Edge of the face, from its point of this number to the next one.
    pub edge: u32,
}

/// A point by its barycentric coordinates: of the centres of cell and face, and of both ends of the edge.
pub type Barycentric = [f64; 4];

/// Map from places to barycentric coordinates of a tetrahedron, and its orientation.
#[derive(Clone, Copy, Debug)]
pub struct TetMap {
    centre: Vec3,
    rows: [Vec3; 3],
    /// Six times the volume in m³; negative where a cell that is not star-shaped about its centre folds over.
    pub determinant: f64,
}

impl TetMap {
    /// Coordinates of a place.
    #[inline]
    pub fn of(&self, place: Vec3) -> Barycentric {
        self.rates(place - self.centre, 1.0)
    }

    /// Their change along a way.
    #[inline]
    pub fn along(&self, way: Vec3) -> Barycentric {
        self.rates(way, 0.0)
    }

    #[inline]
    fn rates(&self, from: Vec3, sum: f64) -> Barycentric {
        let [face, start, end] = self.rows.map(|row| row.dot(&from));
        [sum - face - start - end, face, start, end]
    }
}

/// Smallest of the coordinates.
#[inline]
fn least([a, b, c, d]: Barycentric) -> f64 {
    a.min(b).min(c.min(d))
}

/// The face that a ray from the centre of a cell through a place meets first, where faces are plane and the cell is convex; a first
/// guess in any other.
fn face_behind(mesh: &Mesh, cell: usize, place: Vec3) -> Option<u32> {
    let centre = mesh.cell_centre()[cell];
    let way = place - centre;
    let mut best = (0.0, None);
    for &face in mesh.faces_of(cell) {
        let area = mesh.face_area()[face as usize];
        let distance = (mesh.face_centre()[face as usize] - centre).dot(&area);
        // Of either orientation of the area.
        let share = way.dot(&area) / distance;
        if share > best.0 {
            best = (share, Some(face));
        }
    }
    best.1
}

impl TetPlace {
    /// Tetrahedra of a cell.
    pub fn of_cell(mesh: &Mesh, cell: usize) -> impl Iterator<Item = Self> + '_ {
        let faces = mesh.faces_of(cell).iter();
        faces.flat_map(move |&face| Self::of_face(mesh, cell, face))
    }

    /// Those of one of its faces.
    fn of_face(mesh: &Mesh, cell: usize, face: u32) -> impl Iterator<Item = Self> {
        let edges = mesh.face_points(face as usize).len() as u32;
        (0..edges).map(move |edge| Self {
            cell: cell as u32,
            face,
            edge,
        })
    }

    /// The tetrahedron of a cell that holds a place, or comes nearest to it, with the place's coordinates in it; `None` where all
    /// fold over.
    pub fn nearest(mesh: &Mesh, cell: usize, place: Vec3) -> Option<(Self, Barycentric)> {
        if let Some(face) = face_behind(mesh, cell, place) {
            for found in Self::of_face(mesh, cell, face) {
                let map = found.map(mesh);
                let share = map.of(place);
                if map.determinant > 0.0 && least(share) > 0.0 {
                    return Some((found, share));
                }
            }
        }
        Self::nearest_of_all(mesh, cell, place)
    }

    /// The same by looking at each of them.
    fn nearest_of_all(mesh: &Mesh, cell: usize, place: Vec3) -> Option<(Self, Barycentric)> {
        let mut best = (f64::NEG_INFINITY, None);
        for found in Self::of_cell(mesh, cell) {
            let map = found.map(mesh);
            let share = map.of(place);
            let least = least(share);
            if map.determinant > 0.0 && least > best.0 {
                best = (least, Some((found, share)));
                if least > 0.0 {
                    break;
                }
            }
        }
        best.1
    }

    /// Point indices of the ends of the edge.
    #[inline]
    pub fn ends(self, mesh: &Mesh) -> [u32; 2] {
        let points = mesh.face_points(self.face as usize);
        let next = (self.edge as usize + 1) % points.len();
        [points[self.edge as usize], points[next]]
    }

    /// Corners in m: centres of cell and face, ends of the edge.
    #[inline]
    pub fn corners(self, mesh: &Mesh) -> [Vec3; 4] {
        let [start, end] = self
            .ends(mesh)
            .map(|at| mesh.topology().points[at as usize]);
        let (cell, face) = (self.cell as usize, self.face as usize);
        [
            mesh.cell_centre()[cell],
            mesh.face_centre()[face],
            start,
            end,
        ]
    }

    /// Barycentric coordinates in it.
    #[inline]
    pub fn map(self, mesh: &Mesh) -> TetMap {
        let [centre, face, start, end] = self.corners(mesh);
        let [face, start, end] = [face, start, end].map(|corner| corner - centre);
        let crossed = [start.cross(&end), end.cross(&face), face.cross(&start)];
        let determinant = face.dot(&crossed[0]);
        let side = mesh.side(self.cell as usize, self.face as usize);
        TetMap {
            centre,
            rows: crossed.map(|row| row / determinant),
            determinant: side * determinant,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::conformance::manufactured::CellShape;
    use crate::conformance::manufactured::meshes::shaped_box;

    #[test]
    fn the_tetrahedron_behind_a_face_is_the_one_that_a_search_of_all_finds() {
        for shape in [
            CellShape::Hexahedra(0.0),
            CellShape::Hexahedra(0.25),
            CellShape::Polyhedra(0.2),
            CellShape::Tetrahedra(0.15),
        ] {
            let mesh = shaped_box(shape, 3, |place| place).unwrap();
            let mut by_face = 0;
            for cell in 0..mesh.cells() {
                let centre = mesh.cell_centre()[cell];
                assert_eq!(
                    TetPlace::nearest(&mesh, cell, centre),
                    TetPlace::nearest_of_all(&mesh, cell, centre)
                );
                for corner in TetPlace::of_cell(&mesh, cell) {
                    let corners = corner.corners(&mesh);
                    for k in 0..8 {
                        // Within the tetrahedron and beyond its face.
                        let share = |factor: f64| 0.02 + (f64::from(k) * factor).fract();
                        let weights = [share(0.618), share(0.414), share(0.732), share(0.5)];
                        let sum: f64 = weights.iter().sum();
                        let mut place = Vec3::zeros();
                        for (corner, weight) in corners.iter().zip(weights) {
                            place += *corner * (weight / sum);
                        }
                        if k % 4 == 3 {
                            place = centre + 1.7 * (place - centre);
                        }
                        let found = TetPlace::nearest(&mesh, cell, place);
                        assert_eq!(found, TetPlace::nearest_of_all(&mesh, cell, place));
                        let behind = face_behind(&mesh, cell, place);
                        by_face += usize::from(found.map(|found| found.0.face) == behind);
                    }
                }
            }
            let all: usize = (0..mesh.cells())
                .map(|cell| 8 * TetPlace::of_cell(&mesh, cell).count())
                .sum();
            assert!(by_face * 10 > all * 7, "{by_face} of {all}");
        }
    }
}
