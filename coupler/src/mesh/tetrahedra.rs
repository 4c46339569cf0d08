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

impl TetPlace {
    /// Tetrahedra of a cell.
    pub fn of_cell(mesh: &Mesh, cell: usize) -> impl Iterator<Item = Self> + '_ {
        mesh.faces_of(cell).iter().flat_map(move |&face| {
            let edges = mesh.face_points(face as usize).len() as u32;
            (0..edges).map(move |edge| Self {
                cell: cell as u32,
                face,
                edge,
            })
        })
    }

    /// The tetrahedron of a cell that holds a place, or comes nearest to it, with the place's coordinates in it; `None` where all
    /// fold over.
    pub fn nearest(mesh: &Mesh, cell: usize, place: Vec3) -> Option<(Self, Barycentric)> {
        let mut best = (f64::NEG_INFINITY, None);
        for found in Self::of_cell(mesh, cell) {
            let map = found.map(mesh);
            let share = map.of(place);
            let least = share.into_iter().fold(f64::INFINITY, f64::min);
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
