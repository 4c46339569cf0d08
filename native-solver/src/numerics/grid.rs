//! Geometry of faces and links between cells as the operators need them, made once from a mesh.

use calcine_coupler::mesh::Mesh;
use calcine_coupler::physics::Vec3;

use super::least_squares::LeastSquares;

/// Directions shorter than this share of the distance between centres count as round-off.
const SKEW: f64 = 1e-9;
/// A centre farther along a face than this many times its distance from the face's plane counts as one at the limit: corrections are limited
/// beyond an angle of 75 degrees.
const OBLIQUE: f64 = 3.732_050_807_568_877;

/// The part of a way along a face, limited by its part along the normal.
fn limited(along: Vec3, normal: f64) -> Vec3 {
    let (length, most) = (along.norm(), OBLIQUE * normal.abs());
    if length > most {
        along * (most / length)
    } else {
        along
    }
}

/// What a face's geometry means for differences across it. With n the unit normal (out of the
/// owner), x_P, x_N, x_f the centres of owner, neighbour and face.
#[derive(Clone, Copy, Debug)]
pub struct Face {
    /// Owner cell.
    pub owner: usize,
    /// Neighbour cell; `usize::MAX` on the boundary.
    pub neighbour: usize,
    /// Area in m².
    pub area: f64,
    /// Unit normal n.
    pub normal: Vec3,
    /// n·(x_f − x_P) in m.
    pub owner_distance: f64,
    /// n·(x_N − x_f) in m; zero on the boundary.
    pub neighbour_distance: f64,
    /// Part of x_f − x_P along the face, in m.
    pub owner_skew: Vec3,
    /// Part of x_N − x_f along the face, in m; zero on the boundary.
    pub neighbour_skew: Vec3,
    /// Weight of the owner in linear interpolation.
    weight: f64,
    /// Area over distance in m.
    conductance: f64,
}

impl Face {
    /// n·(x_N − x_P) in m; on the boundary n·(x_f − x_P).
    #[inline]
    pub fn distance(&self) -> f64 {
        self.owner_distance + self.neighbour_distance
    }

    /// From where the line between two centres meets the face's plane to the face's centre, in m.
    #[inline]
    pub fn miss(&self) -> Vec3 {
        let weight = self.owner_weight();
        weight * self.owner_skew - (1.0 - weight) * self.neighbour_skew
    }

    /// True where half of the line between two centres has more along the face than this share of what it has along the normal.
    pub fn leans(&self, share: f64) -> bool {
        let half = |along: &Vec3, across: f64| along.norm() > share * across;
        half(&self.owner_skew, self.owner_distance)
            || half(&self.neighbour_skew, self.neighbour_distance)
    }

    /// Weight of the owner in linear interpolation.
    #[inline]
    pub fn owner_weight(&self) -> f64 {
        self.weight
    }

    /// Area over distance in m: what a unit of conductivity conducts.
    #[inline]
    pub fn conductance(&self) -> f64 {
        self.conductance
    }
}

/// One face as a cell sees it.
#[derive(Clone, Copy, Debug)]
pub struct CellFace {
    /// The face.
    pub face: u32,
    /// The cell on the other side; `u32::MAX` on the boundary.
    pub other: u32,
    /// Position of the other cell within the matrix row of this one.
    pub slot: u32,
    /// +1 where the face's normal points out of the cell, else −1.
    pub sign: f64,
}

impl CellFace {
    /// True on the boundary.
    #[inline]
    pub fn is_boundary(&self) -> bool {
        self.other == u32::MAX
    }
}

/// Faces, links and the graph of the matrix.
#[derive(Clone, Debug)]
pub struct MeshGraph {
    /// Cell volumes in m³.
    pub volume: Vec<f64>,
    /// Cell centres in m.
    pub centre: Vec<Vec3>,
    /// Faces: the mesh's internal ones, one for each pair of periodic faces, then the others of the boundary in the mesh's order.
    pub faces: Vec<Face>,
    /// Number of faces between two cells.
    pub internal: usize,
    /// True where no face needs a correction for a line between centres that misses the face's
    /// centre or is not normal to it.
    pub orthogonal: bool,
    /// What the neighbour's coordinates lack to lie beside the face, of each pair of periodic faces, in m.
    shifts: Vec<Vec3>,
    /// What gradients by least squares need, where they are made.
    least_squares: LeastSquares,
    links: Vec<CellFace>,
    link_offsets: Vec<u32>,
    row_offsets: Vec<u32>,
    columns: Vec<u32>,
}

impl MeshGraph {
    /// The grid of a mesh.
    pub fn new(mesh: &Mesh) -> Self {
        let (inside, pairs) = (mesh.internal_faces(), mesh.periodic_faces());
        let internal = inside + pairs.len();
        // Place of each face of the mesh's boundary.
        let mut next = internal;
        let mut place = Vec::with_capacity(mesh.faces() - inside);
        let mut order: Vec<usize> = (0..inside).collect();
        order.extend(pairs.iter().map(|pair| pair.face));
        for face in inside..mesh.faces() {
            match mesh.periodic_pair(face) {
                Some(pair) => place.push(inside + pair),
                None => {
                    place.push(next);
                    order.push(face);
                    next += 1;
                }
            }
        }
        let faces: Vec<Face> = order.iter().map(|&face| measure(mesh, face)).collect();
        let orthogonal = faces.iter().all(|face| {
            let skew = face.owner_skew.norm().max(face.neighbour_skew.norm());
            skew <= SKEW * face.distance()
        });
        let mut grid = Self {
            volume: mesh.cell_volume().to_vec(),
            centre: mesh.cell_centre().to_vec(),
            faces,
            internal,
            orthogonal,
            shifts: pairs.iter().map(|pair| -pair.translation).collect(),
            least_squares: LeastSquares::default(),
            links: Vec::with_capacity(mesh.faces() + inside),
            link_offsets: vec![0],
            row_offsets: vec![0],
            columns: Vec::with_capacity(2 * internal),
        };
        let mut others = Vec::new();
        for cell in 0..mesh.cells() {
            others.clear();
            let beyond = |&face: &u32| Some(mesh.beyond(cell, face as usize)?.cell);
            others.extend(mesh.faces_of(cell).iter().filter_map(beyond));
            others.sort_unstable();
            others.dedup();
            grid.columns.extend(others.iter().map(|&cell| cell as u32));
            grid.row_offsets.push(grid.columns.len() as u32);
            for face in mesh.faces_of(cell) {
                let other = beyond(face);
                let face = match (*face as usize).checked_sub(inside) {
                    None => *face,
                    Some(boundary) => place[boundary] as u32,
                };
                let owned = grid.faces[face as usize].owner == cell;
                let slot = other.and_then(|other| others.binary_search(&other).ok());
                grid.links.push(CellFace {
                    face,
                    other: other.map_or(u32::MAX, |cell| cell as u32),
                    slot: slot.map_or(u32::MAX, |slot| slot as u32),
                    sign: if owned { 1.0 } else { -1.0 },
                });
            }
            grid.link_offsets.push(grid.links.len() as u32);
        }
        if !orthogonal {
            grid.least_squares = grid.make_least_squares();
        }
        grid
    }

    fn make_least_squares(&self) -> LeastSquares {
        let between: Vec<Vec3> = (0..self.internal).map(|face| self.between(face)).collect();
        LeastSquares::new(&between, self.cells(), |cell| {
            let links = self.links(cell).iter();
            let inside = links.clone().filter(|link| !link.is_boundary());
            let faces = inside.map(|link| link.face as usize);
            (faces, links.clone().any(CellFace::is_boundary))
        })
    }

    /// What gradients by least squares need of the mesh; nothing where lines between centres are normal to faces.
    #[inline]
    pub fn least_squares(&self) -> &LeastSquares {
        &self.least_squares
    }

    /// Number of cells.
    #[inline]
    pub fn cells(&self) -> usize {
        self.volume.len()
    }

    /// From the centre of an internal face's owner to that of its neighbour beside it, in m.
    #[inline]
    pub fn between(&self, face: usize) -> Vec3 {
        let ends = &self.faces[face];
        let line = self.centre[ends.neighbour] - self.centre[ends.owner];
        match face.checked_sub(self.internal - self.shifts.len()) {
            None => line,
            Some(pair) => line + self.shifts[pair],
        }
    }

    /// Links of a cell.
    #[inline]
    pub fn links(&self, cell: usize) -> &[CellFace] {
        &self.links[self.link_offsets[cell] as usize..self.link_offsets[cell + 1] as usize]
    }

    /// Where the neighbours of each cell begin in `columns`; one more entry than cells.
    #[inline]
    pub fn row_offsets(&self) -> &[u32] {
        &self.row_offsets
    }

    /// Neighbours of all cells, ascending within each cell.
    #[inline]
    pub fn columns(&self) -> &[u32] {
        &self.columns
    }
}

fn measure(mesh: &Mesh, face: usize) -> Face {
    let owner = mesh.owner()[face] as usize;
    let beyond = mesh.beyond(owner, face);
    let neighbour = beyond.map(|beyond| beyond.cell);
    let area = mesh.face_area()[face].norm();
    let normal = mesh.face_area()[face] / area;
    let centre = mesh.face_centre()[face];
    let inner = centre - mesh.cell_centre()[owner];
    let outer = beyond.map_or_else(Vec3::zeros, |beyond| {
        mesh.cell_centre()[beyond.cell] + beyond.shift - centre
    });
    let (owner_distance, neighbour_distance) = (normal.dot(&inner), normal.dot(&outer));
    Face {
        owner,
        neighbour: neighbour.unwrap_or(usize::MAX),
        area,
        normal,
        owner_distance,
        neighbour_distance,
        owner_skew: limited(inner - owner_distance * normal, owner_distance),
        neighbour_skew: limited(outer - neighbour_distance * normal, neighbour_distance),
        weight: neighbour_distance / (owner_distance + neighbour_distance),
        conductance: area / (owner_distance + neighbour_distance),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ways_along_faces_are_limited_beyond_75_degrees() {
        let at = |degrees: f64| 0.2 * Vec3::new(degrees.to_radians().tan(), 0.0, 0.0);
        assert_eq!(limited(at(70.0), 0.2), at(70.0));
        assert_eq!(limited(at(74.9), -0.2), at(74.9));
        for degrees in [75.1, 80.0, 89.0] {
            assert!((limited(at(degrees), 0.2) - at(75.0)).norm() < 1e-12);
        }
    }
}
