//! Linear weights in the tetrahedra of a mesh: what a parcel is counts at the centres of cells, continuously in its place.
//!
//! A parcel belongs to the corners of its tetrahedron by its barycentric coordinates. What belongs to the centre of a face is
//! shared by its two cells, what belongs to a point by all cells about it, each by what its tetrahedra have of the volume about that
//! corner; at walls it stays with those within. So an even bed is even on any mesh: the volume that belongs to a cell is its own.

use calcine_physics::Vec3;

use crate::mesh::Mesh;
use crate::mesh::tetrahedra::{Barycentric, TetPlace};

/// Which cells share the points of a mesh, and the volumes that belong to cells.
#[derive(Clone, Debug)]
pub struct LinearWeights {
    /// Number of each point among those that periodic planes do not tell apart.
    number: Vec<u32>,
    offsets: Vec<u32>,
    cells: Vec<u32>,
    /// Share of each of `cells` in what belongs to its point.
    share: Vec<f64>,
    /// Share of the owner in what belongs to the centre of each face.
    owner: Vec<f64>,
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
    pub fn new(mesh: &Mesh) -> Self {
        let number = numbers(mesh);
        let count = number.iter().max().map_or(0, |most| *most as usize + 1);
        let mut about: Vec<Vec<(u32, f64)>> = vec![Vec::new(); count];
        let mut sides = vec![[0.0; 2]; mesh.faces()];
        for cell in 0..mesh.cells() {
            for place in TetPlace::of_cell(mesh, cell) {
                let volume = place.map(mesh).determinant.max(0.0);
                for end in place.ends(mesh) {
                    let point = &mut about[number[end as usize] as usize];
                    match point.last_mut().filter(|last| last.0 == cell as u32) {
                        Some(last) => last.1 += volume,
                        None => point.push((cell as u32, volume)),
                    }
                }
                let face = place.face as usize;
                let owner = mesh.owner()[face] as usize;
                sides[face][usize::from(owner != cell)] += volume;
            }
        }
        for pair in mesh.periodic_faces() {
            let (here, there) = (sides[pair.face][0], sides[pair.partner][0]);
            sides[pair.face][1] = there;
            sides[pair.partner][1] = here;
        }
        let share = |part: f64, whole: f64, sharing: usize| match whole > 0.0 {
            true => part / whole,
            false => 1.0 / sharing as f64,
        };
        let mut weights = Self {
            owner: (sides.iter())
                .map(|[own, other]| share(*own, own + other, 2))
                .collect(),
            number,
            offsets: vec![0],
            cells: Vec::new(),
            share: Vec::new(),
            volume: Vec::new(),
        };
        for list in about {
            let whole: f64 = list.iter().map(|(_, volume)| volume).sum();
            for &(cell, volume) in &list {
                weights.cells.push(cell);
                weights.share.push(share(volume, whole, list.len()));
            }
            weights.offsets.push(weights.cells.len() as u32);
        }
        let mut volumes = weights.corners(mesh);
        for cell in 0..mesh.cells() {
            for place in TetPlace::of_cell(mesh, cell) {
                let volume = place.map(mesh).determinant / 6.0;
                weights.add(mesh, &mut volumes, (place, [0.25; 4]), volume);
            }
        }
        weights.volume = weights.gather(mesh, &volumes);
        weights
    }

    /// Adds the cells to which a point with its coordinates in a tetrahedron belongs, with the share of each; one cell may come
    /// several times. The point may lie outside by round-off.
    pub fn shares(
        &self,
        mesh: &Mesh,
        (place, weights): (TetPlace, Barycentric),
        mut give: impl FnMut(u32, f64),
    ) {
        let [own, middle, start, end] = weights.map(|weight| weight.max(0.0));
        give(place.cell, own);
        let face = place.face as usize;
        let owner = mesh.owner()[face] as usize;
        match mesh.beyond(owner, face) {
            None => give(place.cell, middle),
            Some(beyond) => {
                give(owner as u32, middle * self.owner[face]);
                give(beyond.cell as u32, middle * (1.0 - self.owner[face]));
            }
        }
        for (point, weight) in place.ends(mesh).into_iter().zip([start, end]) {
            for (cell, share) in self.about(self.number[point as usize] as usize) {
                give(cell, weight * share);
            }
        }
    }

    /// Volume in m³ that belongs to each cell.
    pub fn volume(&self) -> &[f64] {
        &self.volume
    }

    /// Nothing at any corner.
    pub fn corners<T: Weighable>(&self, mesh: &Mesh) -> CornerValues<T> {
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
        mesh: &Mesh,
        corners: &mut CornerValues<T>,
        (place, weights): (TetPlace, Barycentric),
        value: T,
    ) {
        let [start, end] = place.ends(mesh).map(|at| self.number[at as usize] as usize);
        let [cell, face] = [place.cell, place.face].map(|at| at as usize);
        corners.cell[cell] = corners.cell[cell] + value * weights[0];
        corners.face[face] = corners.face[face] + value * weights[1];
        corners.point[start] = corners.point[start] + value * weights[2];
        corners.point[end] = corners.point[end] + value * weights[3];
    }

    /// What belongs to the cells of what was added to the corners.
    pub fn gather<T: Weighable>(&self, mesh: &Mesh, corners: &CornerValues<T>) -> Vec<T> {
        let mut sums = corners.cell.clone();
        for (face, &value) in corners.face.iter().enumerate() {
            let owner = mesh.owner()[face] as usize;
            match mesh.beyond(owner, face) {
                None => sums[owner] = sums[owner] + value,
                Some(beyond) => {
                    sums[owner] = sums[owner] + value * self.owner[face];
                    sums[beyond.cell] = sums[beyond.cell] + value * (1.0 - self.owner[face]);
                }
            }
        }
        for (point, &value) in corners.point.iter().enumerate() {
            for (cell, share) in self.about(point) {
                sums[cell as usize] = sums[cell as usize] + value * share;
            }
        }
        sums
    }

    /// Values at the corners of values of cells: the transpose of `gather`, so that Σ m v(x) over parcels is Σ M v over cells,
    /// with M the mass that belongs to each.
    pub fn spread<T: Weighable>(&self, mesh: &Mesh, cells: &[T]) -> CornerValues<T> {
        let face = |face: usize| {
            let owner = mesh.owner()[face] as usize;
            match mesh.beyond(owner, face) {
                None => cells[owner],
                Some(beyond) => {
                    cells[owner] * self.owner[face] + cells[beyond.cell] * (1.0 - self.owner[face])
                }
            }
        };
        let point = |point: usize| {
            let about = self.about(point);
            about.fold(T::NONE, |sum, (cell, share)| {
                sum + cells[cell as usize] * share
            })
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
        mesh: &Mesh,
        corners: &CornerValues<T>,
        (place, weights): (TetPlace, Barycentric),
    ) -> T {
        let [start, end] = place.ends(mesh).map(|at| self.number[at as usize] as usize);
        corners.cell[place.cell as usize] * weights[0]
            + corners.face[place.face as usize] * weights[1]
            + corners.point[start] * weights[2]
            + corners.point[end] * weights[3]
    }

    /// Cells about a point with the share of each.
    fn about(&self, point: usize) -> impl Iterator<Item = (u32, f64)> + '_ {
        let range = self.offsets[point] as usize..self.offsets[point + 1] as usize;
        let shares = self.share[range.clone()].iter().copied();
        self.cells[range].iter().copied().zip(shares)
    }
}

/// Numbers of points; those at places that periodic planes do not tell apart have the same.
fn numbers(mesh: &Mesh) -> Vec<u32> {
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::conformance::manufactured::CellShape;
    use crate::conformance::manufactured::meshes::shaped_box;
    use crate::mapping::{Mapper, Method};

    fn shapes() -> Vec<Mesh> {
        let plain = |shape| shaped_box(shape, 3, |place| place).unwrap();
        // Cells that grow from 1 to 27 along x.
        let stretched = |place: Vec3| Vec3::new(place.x * (1.0 + 3.0 * place.x), place.y, place.z);
        let graded = shaped_box(CellShape::Hexahedra(0.0), 4, stretched).unwrap();
        vec![
            plain(CellShape::Hexahedra(0.2)),
            plain(CellShape::Polyhedra(0.2)),
            plain(CellShape::Tetrahedra(0.1)),
            graded,
        ]
    }

    #[test]
    fn the_volume_that_belongs_to_a_cell_is_its_own_so_that_an_even_bed_is_even() {
        for mesh in shapes() {
            let weights = LinearWeights::new(&mesh);
            for (found, own) in weights.volume().iter().zip(mesh.cell_volume()) {
                assert!((found / own - 1.0).abs() < 1e-12, "{found} {own}");
            }
        }
    }

    #[test]
    fn shares_of_a_point_sum_to_one_and_are_what_the_corners_pass_on() {
        for mesh in shapes() {
            let weights = LinearWeights::new(&mesh);
            let [low, high] = mesh.bounds();
            let mapper = Mapper::new(&mesh);
            let mut seen = 0;
            for k in 1..40 {
                let share = |factor: f64| (f64::from(k) * factor).fract();
                let way = Vec3::new(share(0.618), share(0.414), share(0.732));
                let at = low + (high - low).component_mul(&way);
                let Ok(found) = mapper.fill(Method::Linear, &[at], &[1e-3]) else {
                    continue;
                };
                let home = mapper.locator.cell_at(at).unwrap();
                let place = TetPlace::nearest(&mesh, home, at).unwrap();
                let mut corners = weights.corners(&mesh);
                weights.add(&mesh, &mut corners, place, 1.0);
                let mut cells = weights.gather(&mesh, &corners);
                assert!((cells.iter().sum::<f64>() - 1.0).abs() < 1e-14);
                for (cell, share) in found.of_particle(0) {
                    cells[cell] -= share;
                }
                assert!(cells.iter().all(|left| left.abs() < 1e-13), "{at}");
                seen += 1;
            }
            assert!(seen > 30, "{seen} of 39 points lie in the mesh");
        }
    }

    #[test]
    fn within_equal_cells_away_from_walls_a_linear_field_is_seen_exactly_and_shares_change_continuously()
     {
        let mesh = shaped_box(CellShape::Hexahedra(0.0), 5, |place| place).unwrap();
        let mapper = Mapper::new(&mesh);
        let [low, high] = mesh.bounds();
        let slope = Vec3::new(2.0, -1.0, 0.5);
        let field: Vec<f64> = mesh.cell_centre().iter().map(|at| slope.dot(at)).collect();
        let seen = |at: Vec3| {
            let weights = mapper.fill(Method::Linear, &[at], &[1e-3]).unwrap();
            let mut value = [0.0];
            weights.sample(&field, &mut value);
            (value[0], weights.of_particle(0).collect::<Vec<_>>())
        };
        let mut before: Option<Vec<f64>> = None;
        for k in 0..=1000 {
            // Through cells that do not touch walls.
            let t = f64::from(k) / 1000.0;
            let way = Vec3::new(0.21 + 0.58 * t, 0.35 + 0.3 * t * t, 0.79 - 0.55 * t);
            let at = low + (high - low).component_mul(&way);
            let (value, shares) = seen(at);
            assert!((value - slope.dot(&at)).abs() < 1e-12 * (high - low).norm());
            let mut cells = vec![0.0; mesh.cells()];
            shares
                .iter()
                .for_each(|(cell, share)| cells[*cell] = *share);
            if let Some(before) = before {
                let moved = cells.iter().zip(&before).map(|(a, b)| (a - b).abs());
                // A step is 1/340 of a cell at most; a weight's slope is 2 per cell along each axis.
                assert!(moved.fold(0.0, f64::max) < 0.02);
            }
            before = Some(cells);
        }
    }
}
