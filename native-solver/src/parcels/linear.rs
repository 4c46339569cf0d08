//! Linear weights in the tetrahedra of a mesh: what a parcel is counts at the centres of cells, continuously in its place.
//!
//! A parcel belongs to the corners of its tetrahedron by its barycentric coordinates. What belongs to the centre of a face is
//! shared by its two cells, what belongs to a point by all cells about it; at walls it stays with those within. Quantities of a
//! cell are divided by the volume that belongs to it in the same way, so that an even bed is even on any mesh.

use calcine_coupler::physics::Vec3;

use super::tetrahedra::{Barycentric, TetPlace, Tetrahedra};

/// Which cells share the points of a mesh, and the volumes that belong to cells.
#[derive(Clone, Debug)]
pub struct LinearWeights {
    /// Number of each point among those that periodic planes do not tell apart.
    number: Vec<u32>,
    offsets: Vec<u32>,
    cells: Vec<u32>,
    /// Volume in m³ that belongs to each cell.
    volume: Vec<f64>,
}

/// Values at the corners of tetrahedra.
#[derive(Clone, Debug)]
pub struct CornerValues<T> {
    cell: Vec<T>,
    face: Vec<T>,
    point: Vec<T>,
}

/// What can be weighed.
pub trait Weighable:
    Copy + Send + Sync + std::ops::Add<Output = Self> + std::ops::Mul<f64, Output = Self>
{
    /// Nothing of it.
    const NONE: Self;
}

impl Weighable for f64 {
    const NONE: Self = 0.0;
}

impl Weighable for Vec3 {
    const NONE: Self = Vec3::new(0.0, 0.0, 0.0);
}

impl LinearWeights {
    /// The weights of a mesh.
    pub fn new(tetrahedra: &Tetrahedra) -> Self {
        let mesh = tetrahedra.mesh();
        let number = numbers(tetrahedra);
        let count = number.iter().max().map_or(0, |most| *most as usize + 1);
        let mut about: Vec<Vec<u32>> = vec![Vec::new(); count];
        let mut own = Vec::new();
        for cell in 0..mesh.cells() {
            own.clear();
            for &face in mesh.faces_of(cell) {
                own.extend(
                    mesh.face_points(face as usize)
                        .iter()
                        .map(|&at| number[at as usize]),
                );
            }
            own.sort_unstable();
            own.dedup();
            for &point in &own {
                about[point as usize].push(cell as u32);
            }
        }
        let mut offsets = vec![0];
        let mut cells = Vec::new();
        for list in about {
            cells.extend(list);
            offsets.push(cells.len() as u32);
        }
        let mut weights = Self {
            number,
            offsets,
            cells,
            volume: Vec::new(),
        };
        let mut volumes = weights.corners(tetrahedra);
        for cell in 0..mesh.cells() {
            for place in tetrahedra.of_cell(cell) {
                let volume = tetrahedra.map(place).determinant / 6.0;
                weights.add(tetrahedra, &mut volumes, place, [0.25; 4], volume);
            }
        }
        weights.volume = weights.gather(tetrahedra, &volumes);
        weights
    }

    /// Volume in m³ that belongs to each cell.
    pub fn volume(&self) -> &[f64] {
        &self.volume
    }

    /// Nothing at any corner.
    pub fn corners<T: Weighable>(&self, tetrahedra: &Tetrahedra) -> CornerValues<T> {
        let mesh = tetrahedra.mesh();
        CornerValues {
            cell: vec![T::NONE; mesh.cells()],
            face: vec![T::NONE; mesh.faces()],
            point: vec![T::NONE; self.offsets.len() - 1],
        }
    }

    /// Adds what a parcel has to the corners of its tetrahedron.
    #[inline]
    pub fn add<T: Weighable>(
        &self,
        tetrahedra: &Tetrahedra,
        corners: &mut CornerValues<T>,
        place: TetPlace,
        weights: Barycentric,
        value: T,
    ) {
        let [start, end] = tetrahedra
            .ends(place)
            .map(|at| self.number[at as usize] as usize);
        let [cell, face] = [place.cell, place.face].map(|at| at as usize);
        corners.cell[cell] = corners.cell[cell] + value * weights[0];
        corners.face[face] = corners.face[face] + value * weights[1];
        corners.point[start] = corners.point[start] + value * weights[2];
        corners.point[end] = corners.point[end] + value * weights[3];
    }

    /// What belongs to the cells of what was added to the corners.
    pub fn gather<T: Weighable>(
        &self,
        tetrahedra: &Tetrahedra,
        corners: &CornerValues<T>,
    ) -> Vec<T> {
        let mesh = tetrahedra.mesh();
        let mut sums = corners.cell.clone();
        for (face, &value) in corners.face.iter().enumerate() {
            let owner = mesh.owner()[face] as usize;
            match mesh.beyond(owner, face) {
                None => sums[owner] = sums[owner] + value,
                Some(beyond) => {
                    sums[owner] = sums[owner] + value * 0.5;
                    sums[beyond.cell] = sums[beyond.cell] + value * 0.5;
                }
            }
        }
        for (point, &value) in corners.point.iter().enumerate() {
            let about = self.about(point);
            let each = value * (1.0 / about.len() as f64);
            for &cell in about {
                sums[cell as usize] = sums[cell as usize] + each;
            }
        }
        sums
    }

    /// Values at the corners of values of cells: the transpose of `gather`, so that Σ m v(x) over parcels is Σ M v over cells,
    /// with M the mass that belongs to each.
    pub fn spread<T: Weighable>(&self, tetrahedra: &Tetrahedra, cells: &[T]) -> CornerValues<T> {
        let mesh = tetrahedra.mesh();
        let face = |face: usize| {
            let owner = mesh.owner()[face] as usize;
            match mesh.beyond(owner, face) {
                None => cells[owner],
                Some(beyond) => (cells[owner] + cells[beyond.cell]) * 0.5,
            }
        };
        let point = |point: usize| {
            let about = self.about(point);
            let sum = about
                .iter()
                .fold(T::NONE, |sum, &cell| sum + cells[cell as usize]);
            sum * (1.0 / about.len() as f64)
        };
        CornerValues {
            face: (0..mesh.faces()).map(face).collect(),
            point: (0..self.offsets.len() - 1).map(point).collect(),
            cell: cells.to_vec(),
        }
    }

    /// The value at a parcel.
    #[inline]
    pub fn at<T: Weighable>(
        &self,
        tetrahedra: &Tetrahedra,
        corners: &CornerValues<T>,
        place: TetPlace,
        weights: Barycentric,
    ) -> T {
        let [start, end] = tetrahedra
            .ends(place)
            .map(|at| self.number[at as usize] as usize);
        corners.cell[place.cell as usize] * weights[0]
            + corners.face[place.face as usize] * weights[1]
            + corners.point[start] * weights[2]
            + corners.point[end] * weights[3]
    }

    fn about(&self, point: usize) -> &[u32] {
        &self.cells[self.offsets[point] as usize..self.offsets[point + 1] as usize]
    }
}

/// Numbers of points; those at places that periodic planes do not tell apart have the same.
fn numbers(tetrahedra: &Tetrahedra) -> Vec<u32> {
    let mesh = tetrahedra.mesh();
    let points = &mesh.topology().points;
    let mut same: Vec<u32> = (0..points.len() as u32).collect();
    let root = |same: &[u32], mut point: u32| {
        while same[point as usize] != point {
            point = same[point as usize];
        }
        point
    };
    for pair in mesh.periodic_faces() {
        for &here in mesh.face_points(pair.face) {
            let beyond = points[here as usize] + pair.translation;
            let off = |there: &u32| (points[*there as usize] - beyond).norm_squared();
            let others = mesh.face_points(pair.partner).iter().copied();
            if let Some(there) = others.min_by(|a, b| off(a).total_cmp(&off(b))) {
                let (a, b) = (root(&same, here), root(&same, there));
                same[a.max(b) as usize] = a.min(b);
            }
        }
    }
    let mut number = vec![u32::MAX; points.len()];
    let mut next = 0;
    for point in 0..points.len() as u32 {
        let first = root(&same, point) as usize;
        if number[first] == u32::MAX {
            number[first] = next;
            next += 1;
        }
        number[point as usize] = number[first];
    }
    number
}
