//! Cells as tetrahedra: one between the centre of the cell, the centre of a face and an edge of that face. The triangles in
//! which two cells meet are the same from both sides, so that the tetrahedra fill the mesh without gaps, warped faces too.

use std::sync::Arc;

use calcine_coupler::mesh::Mesh;
use calcine_coupler::mesh::locate::Locator;
use calcine_coupler::mesh::tetrahedra::{TetMap, TetPlace};
use calcine_coupler::physics::Vec3;

use super::error::ParcelError;

/// What lies on the other side of a side of a tetrahedron.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Beyond {
    /// Another tetrahedron.
    Place(TetPlace),
    /// One beyond a periodic plane; what has to be added to coordinates, in m.
    Shifted(TetPlace, Vec3),
    /// A wall: the boundary face.
    Wall,
}

/// The tetrahedra of a mesh, evaluated as they are needed.
#[derive(Clone, Debug)]
pub struct Tetrahedra {
    locator: Locator<Arc<Mesh>>,
}

impl Tetrahedra {
    /// The tetrahedra of a mesh; an error where an edge of a cell does not belong to two of its faces.
    pub fn new(mesh: Arc<Mesh>) -> Result<Self, ParcelError> {
        let all = Self {
            locator: Locator::new(mesh),
        };
        let mesh = all.mesh();
        for cell in 0..mesh.cells() {
            for place in all.of_cell(cell) {
                if all.other_face(place).is_none() {
                    return Err(ParcelError::OpenEdge {
                        cell,
                        face: place.face as usize,
                    });
                }
            }
        }
        Ok(all)
    }

    /// The mesh.
    pub fn mesh(&self) -> &Mesh {
        self.locator.mesh()
    }

    /// Tetrahedra of a cell.
    pub fn of_cell(&self, cell: usize) -> impl Iterator<Item = TetPlace> + '_ {
        TetPlace::of_cell(self.mesh(), cell)
    }

    /// Point indices of the ends of the edge.
    #[inline]
    pub fn ends(&self, place: TetPlace) -> [u32; 2] {
        place.ends(self.mesh())
    }

    /// Corners in m: centres of cell and face, ends of the edge.
    #[inline]
    pub fn corners(&self, place: TetPlace) -> [Vec3; 4] {
        place.corners(self.mesh())
    }

    /// Barycentric coordinates in a tetrahedron.
    #[inline]
    pub fn map(&self, place: TetPlace) -> TetMap {
        place.map(self.mesh())
    }

    /// Area vector in m² of the side in the cell's face, out of the cell.
    pub fn outward(&self, place: TetPlace) -> Vec3 {
        let [_, face, start, end] = self.corners(place);
        let side = self.mesh().side(place.cell as usize, place.face as usize);
        0.5 * side * (start - face).cross(&(end - face))
    }

    /// What lies beyond the side opposite to a corner.
    pub fn beyond(&self, place: TetPlace, corner: usize) -> Beyond {
        let edges = self.mesh().face_points(place.face as usize).len() as u32;
        let in_face = |edge: u32| Beyond::Place(TetPlace { edge, ..place });
        match corner {
            0 => self.across(place),
            1 => Beyond::Place(self.other_face(place).unwrap_or(place)),
            2 => in_face((place.edge + 1) % edges),
            _ => in_face((place.edge + edges - 1) % edges),
        }
    }

    /// The tetrahedron of another face of the cell on the same edge.
    fn other_face(&self, place: TetPlace) -> Option<TetPlace> {
        let mesh = self.mesh();
        let ends = self.ends(place);
        for &face in mesh.faces_of(place.cell as usize) {
            if face == place.face {
                continue;
            }
            let points = mesh.face_points(face as usize);
            for (edge, &start) in points.iter().enumerate() {
                let end = points[(edge + 1) % points.len()];
                if [start, end] == ends || [end, start] == ends {
                    let edge = edge as u32;
                    return Some(TetPlace {
                        face,
                        edge,
                        ..place
                    });
                }
            }
        }
        None
    }

    fn across(&self, place: TetPlace) -> Beyond {
        let mesh = self.mesh();
        let (cell, face) = (place.cell as usize, place.face as usize);
        if let Some(other) = mesh.across(cell, face) {
            let cell = other as u32;
            return Beyond::Place(TetPlace { cell, ..place });
        }
        let Some(beyond) = mesh.beyond(cell, face) else {
            return Beyond::Wall;
        };
        let Some(pair) = mesh.periodic_pair(face) else {
            return Beyond::Wall;
        };
        let pair = &mesh.periodic_faces()[pair];
        let partner = if pair.face == face {
            pair.partner
        } else {
            pair.face
        };
        // What is added to coordinates here to have them in the other cell.
        let shift = -beyond.shift;
        let middle = |[start, end]: [u32; 2]| {
            let points = &mesh.topology().points;
            0.5 * (points[start as usize] + points[end as usize])
        };
        let here = middle(self.ends(place)) + shift;
        let mut there = TetPlace {
            cell: beyond.cell as u32,
            face: partner as u32,
            edge: 0,
        };
        let mut least = f64::INFINITY;
        for edge in 0..mesh.face_points(partner).len() as u32 {
            let found = TetPlace { edge, ..there };
            let off = (middle(self.ends(found)) - here).norm_squared();
            if off < least {
                least = off;
                there = found;
            }
        }
        Beyond::Shifted(there, shift)
    }

    /// The tetrahedron that holds a place, or of its cell the one that comes nearest to it; `None` outside the mesh.
    pub fn locate(&self, place: Vec3) -> Option<TetPlace> {
        let cell = self.locator.cell_at(place)?;
        Some(TetPlace::nearest(self.mesh(), cell, place)?.0)
    }
}
