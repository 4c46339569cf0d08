//! Gradients of cell values by least squares: g minimises Σ (d·g − Δ)²/d² over what is beside a cell, d the way there from its
//! centre, Δ the difference. Exact for linear fields on any mesh, and without an iteration, whatever the skewness. On the
//! boundary the value at the centre of the face counts where it is given; where nothing but the slope along the normal is, zero,
//! that of the foot of the normal.

use std::ops::Sub;

use calcine_coupler::physics::Vec3;
use nalgebra::Matrix3;

use super::grid::{CellFace, MeshGraph};
use super::least_squares::{self, Normal};
use super::parallel::fill;

/// What is beside a cell at a face of the boundary.
#[derive(Clone, Copy, Debug)]
pub enum Beside<T> {
    /// A value at the centre of the face.
    AtFace(T),
    /// A value where the normal through the cell's centre meets the plane of the face.
    AtFoot(T),
}

impl<T: Sub<Output = T>> Beside<T> {
    /// What it has beyond the value of the cell.
    #[inline]
    fn less(self, own: T) -> Self {
        match self {
            Self::AtFace(value) => Self::AtFace(value - own),
            Self::AtFoot(value) => Self::AtFoot(value - own),
        }
    }
}

/// The way from a cell's centre to the centre of a face.
#[inline]
pub fn to_face(grid: &MeshGraph, link: &CellFace) -> Vec3 {
    let face = &grid.faces[link.face as usize];
    if link.sign > 0.0 {
        face.owner_distance * face.normal + face.owner_skew
    } else {
        -face.neighbour_distance * face.normal - face.neighbour_skew
    }
}

/// Gradients of a scalar; `boundary(face, value of its cell)` on the boundary.
pub fn scalar(
    grid: &MeshGraph,
    values: &[f64],
    boundary: impl Fn(usize, f64) -> Beside<f64> + Sync,
    gradients: &mut [Vec3],
) {
    fill(gradients, |cell| {
        let own = values[cell];
        let mut sum = Vec3::zeros();
        let inverse = over_faces(
            grid,
            cell,
            |link| boundary(link.face as usize, own).less(own),
            |other| values[other] - own,
            |weighted, difference| sum += weighted * difference,
        );
        inverse * sum
    });
}

/// Gradients ∂f_i/∂x_j of a vector; `boundary(face, value of its cell)` on the boundary.
pub fn vector(
    grid: &MeshGraph,
    values: &[Vec3],
    boundary: impl Fn(usize, Vec3) -> Beside<Vec3> + Sync,
    gradients: &mut [Matrix3<f64>],
) {
    fill(gradients, |cell| {
        let own = values[cell];
        let mut sum = Matrix3::zeros();
        let inverse = over_faces(
            grid,
            cell,
            |link| boundary(link.face as usize, own).less(own),
            |other| values[other] - own,
            |weighted, difference| sum += difference * weighted.transpose(),
        );
        sum * inverse
    });
}

/// Hands `add` the weighted way d/|d|² to what is beside a cell at each of its faces, and the difference there: of the cell there, or
/// `at_boundary`. Returns (Σ d dᵀ/|d|²)⁻¹.
#[inline]
fn over_faces<T>(
    grid: &MeshGraph,
    cell: usize,
    at_boundary: impl Fn(&CellFace) -> Beside<T>,
    inside: impl Fn(usize) -> T,
    mut add: impl FnMut(Vec3, T),
) -> Matrix3<f64> {
    let made = grid.least_squares();
    let mut beyond = Matrix3::zeros();
    for link in grid.links(cell) {
        if link.is_boundary() {
            let (way, difference) = located(grid, link, at_boundary(link));
            beyond += least_squares::outer(&way);
            add(least_squares::weighted(&way), difference);
        } else {
            let way = link.sign * made.towards(link.face as usize);
            add(way, inside(link.other as usize));
        }
    }
    match made.normal(cell) {
        Normal::Inverse(inverse) => *inverse,
        Normal::Inside(sum) => least_squares::inverse(&(sum + beyond)),
    }
}

/// What the cells beside have in [`averaged`] at least, and more where the boundary is free.
const BESIDE: f64 = 0.5;
const MORE: f64 = 0.25;
/// What they have in [`FreeCells::mix`].
const FREE: f64 = 0.5;

/// |Σ n|² up to which faces count as opposite ones, as the sides of wedges do.
const OPPOSITE: f64 = 0.1;

/// Cells at faces of the boundary along which gas slips, where the cell's own velocity without its normal part is beside it. What is made of such a gradient
/// and goes back into the values, as reaches of mass velocities and explicit stresses do, may be more than they were: on Kuhn's tetrahedra of boxes
/// with free-slip sides, in cells of edges, 1.1 to 1.6 times. With a share s of the mean of the gradients of the cells beside it is not: 0.6 to 0.9
/// times. The share rises with the normals n of those faces of a cell, outlets among them, as |Σ n|²; opposite ones cancel, as their values do
/// in the gradient.
#[derive(Debug, Default)]
pub struct FreeCells(Vec<(u32, f64)>);

impl FreeCells {
    /// Those behind faces that `slip`; faces that are `free` besides count with them.
    pub fn find(
        grid: &MeshGraph,
        slip: impl Fn(usize) -> bool,
        free: impl Fn(usize) -> bool,
    ) -> Self {
        let sum = |cell: usize, counts: &dyn Fn(usize) -> bool| -> Vec3 {
            let beyond = grid.links(cell).iter().filter(|link| link.is_boundary());
            let faces = beyond.map(|link| link.face as usize);
            let normals = faces
                .filter(|&face| counts(face))
                .map(|face| grid.faces[face].normal);
            normals.sum()
        };
        let one_sided = |cell: usize| -> f64 {
            let slipping = sum(cell, &slip);
            match slipping.norm_squared() > OPPOSITE {
                true => (slipping + sum(cell, &free)).norm_squared(),
                false => 0.0,
            }
        };
        let cells = (0..grid.cells()).map(|cell| (cell as u32, one_sided(cell)));
        Self(cells.filter(|&(_, square)| square > 0.0).collect())
    }

    /// Mixes their gradients with those of the cells beside, s = min(1, 0.5 |Σ n|²): still exact for linear fields.
    pub fn mix(&self, grid: &MeshGraph, gradients: &mut [Matrix3<f64>]) {
        let mix = |&(cell, square): &(u32, f64)| {
            mixed(grid, gradients, cell as usize, (FREE * square).min(1.0))
        };
        let found: Vec<_> = self.0.iter().map(mix).collect();
        for (&(cell, _), gradient) in self.0.iter().zip(found) {
            gradients[cell as usize] = gradient;
        }
    }
}

/// A cell's gradient with a share of the mean of those of the cells beside it.
#[inline]
fn mixed(grid: &MeshGraph, plain: &[Matrix3<f64>], cell: usize, share: f64) -> Matrix3<f64> {
    let (mut sum, mut count) = (Matrix3::zeros(), 0.0);
    for link in grid.links(cell).iter().filter(|link| !link.is_boundary()) {
        sum += plain[link.other as usize];
        count += 1.0;
    }
    match count > 0.0 {
        true => plain[cell] * (1.0 - share) + sum * (share / count),
        false => plain[cell],
    }
}

/// Mixes the gradient of each cell with the mean of those of the cells beside it, one half of each: still exact for linear fields.
/// Where a gradient of the cells beside alone is fed back into the values that it is made of, it grows without bound on tetrahedra, whose few
/// faces look to one side; with the cells next to them it does not (Haider, Croisille and Courbet, Numer. Math. 113 (2009) 555). Cells at slipping faces take
/// min(1, 0.5 + 0.25 |Σ n|²) of those beside ([`FreeCells`]). `plain` is memory for what gradients were.
pub fn averaged(
    grid: &MeshGraph,
    gradients: &mut [Matrix3<f64>],
    free: &FreeCells,
    plain: &mut Vec<Matrix3<f64>>,
) {
    plain.clear();
    plain.extend_from_slice(gradients);
    let plain = &*plain;
    fill(gradients, |cell| mixed(grid, plain, cell, BESIDE));
    for &(cell, square) in &free.0 {
        let share = (BESIDE + MORE * square).min(1.0);
        gradients[cell as usize] = mixed(grid, plain, cell as usize, share);
    }
}

/// The way to what is beside a face of the boundary, and its value.
#[inline]
fn located<T>(grid: &MeshGraph, link: &CellFace, beside: Beside<T>) -> (Vec3, T) {
    let face = &grid.faces[link.face as usize];
    match beside {
        Beside::AtFace(value) => (to_face(grid, link), value),
        Beside::AtFoot(value) => (face.owner_distance * face.normal, value),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use calcine_coupler::conformance::manufactured::CellShape;
    use calcine_coupler::conformance::manufactured::meshes::shaped_box;
    use calcine_coupler::mesh::Mesh;
    use calcine_coupler::mesh::block::{BoxSpec, box_mesh};

    #[test]
    fn gradients_of_linear_fields_are_exact_on_tetrahedra_with_and_without_the_cells_beside() {
        let lean = |point: Vec3| Vec3::new(point.x + 0.5 * point.z, point.y, point.z);
        let mesh = shaped_box(CellShape::Tetrahedra(0.15), 3, lean).unwrap();
        let grid = MeshGraph::new(&mesh);
        let slope = Matrix3::new(1.0, 2.0, -3.0, 0.5, 0.0, 4.0, -1.0, 1.0, 2.0);
        let at = |way: Vec3| slope * way;
        let values: Vec<Vec3> = grid.centre.iter().map(|centre| at(*centre)).collect();
        let boundary = |index: usize, _: Vec3| {
            let face = &grid.faces[index];
            let centre = grid.centre[face.owner];
            Beside::AtFace(at(centre
                + face.owner_distance * face.normal
                + face.owner_skew))
        };
        let mut gradients = vec![Matrix3::zeros(); grid.cells()];
        vector(&grid, &values, boundary, &mut gradients);
        assert!(gradients.iter().all(|found| (found - slope).norm() < 1e-11));
        let free = FreeCells::find(&grid, |_| true, |_| false);
        averaged(&grid, &mut gradients, &free, &mut Vec::new());
        free.mix(&grid, &mut gradients);
        assert!(gradients.iter().all(|found| (found - slope).norm() < 1e-11));
    }

    /// Kuhn's tetrahedra of a hexahedron have one or two faces on its sides, and none a pair of opposite ones.
    #[test]
    fn cells_at_free_faces_have_the_share_of_their_normals() {
        let mesh = shaped_box(CellShape::Tetrahedra(0.0), 3, |point| point).unwrap();
        let grid = MeshGraph::new(&mesh);
        let free = FreeCells::find(
            &grid,
            |face| grid.faces[face].normal.x.abs() < 0.5,
            |_| false,
        );
        let squares = free.0.iter().map(|&(_, square)| square.round() as u32);
        assert!(squares.clone().all(|square| square == 1 || square == 2));
        assert_eq!(squares.filter(|&square| square == 2).count(), 6);
        let mut gradients = vec![Matrix3::zeros(); grid.cells()];
        for &(cell, _) in free.0.iter().filter(|(_, square)| *square > 1.5) {
            gradients[cell as usize] = Matrix3::identity();
        }
        free.mix(&grid, &mut gradients);
        for &(cell, _) in free.0.iter().filter(|(_, square)| *square > 1.5) {
            let beside = grid
                .links(cell as usize)
                .iter()
                .filter(|link| !link.is_boundary());
            let alike = beside.filter(|link| {
                free.0
                    .iter()
                    .any(|&(other, square)| other == link.other && square > 1.5)
            });
            assert!((gradients[cell as usize][(0, 0)] - alike.count() as f64 / 2.0).abs() < 1e-15);
        }
    }

    #[test]
    fn half_of_a_gradient_is_that_of_the_cells_beside() {
        let mesh = shaped_box(CellShape::Hexahedra(0.0), 3, |point| point).unwrap();
        let grid = MeshGraph::new(&mesh);
        let mut gradients = vec![Matrix3::zeros(); grid.cells()];
        gradients[0] = Matrix3::identity();
        averaged(
            &grid,
            &mut gradients,
            &FreeCells::default(),
            &mut Vec::new(),
        );
        let shares: f64 = gradients.iter().map(|found| found[(0, 0)]).sum();
        let beside = grid.links(0).iter().filter(|link| !link.is_boundary());
        let given: f64 = beside
            .map(|link| {
                let of = grid.links(link.other as usize).iter();
                0.5 / of.filter(|link| !link.is_boundary()).count() as f64
            })
            .sum();
        assert!((shares - 0.5 - given).abs() < 1e-15, "{shares}");
    }

    /// Of a row of cells between planes of which every other one leans, one full wave of a field long, its ends periodic: no pair of cells is
    /// told from another.
    #[test]
    fn gradients_across_periodic_planes_are_those_within() {
        let count = 8;
        let spec = BoxSpec {
            origin: Vec3::zeros(),
            size: Vec3::new(8.0, 1.0, 1.0),
            cells: [count, 1, 1],
            patches: ["a", "b", "c", "d", "e", "f"].map(str::to_owned),
        };
        let mut topology = box_mesh(&spec).unwrap().topology().clone();
        for point in &mut topology.points {
            if point.x % 2.0 == 1.0 {
                point.x += 0.3 * point.y;
            }
        }
        let ends = [["a", "b"].map(str::to_owned)];
        let mesh = Mesh::new(topology).unwrap().with_periodic(&ends).unwrap();
        let grid = MeshGraph::new(&mesh);
        assert!(!grid.orthogonal);
        let of_wave = |phase: usize| {
            let angle = std::f64::consts::TAU / count as f64;
            let wave = |cell: usize| ((cell + phase) as f64 * angle).sin();
            let values: Vec<f64> = (0..count).map(wave).collect();
            let vectors: Vec<Vec3> = values.iter().map(|value| *value * Vec3::x()).collect();
            let mut scalars = vec![Vec3::zeros(); count];
            scalar(&grid, &values, |_, own| Beside::AtFoot(own), &mut scalars);
            let mut tensors = vec![Matrix3::zeros(); count];
            let open = |_: usize, own: Vec3| Beside::AtFoot(own);
            vector(&grid, &vectors, open, &mut tensors);
            (scalars, tensors)
        };
        let (scalars, tensors) = of_wave(3);
        assert!(scalars[0].norm() > 0.1);
        for phase in [5, 7, 9] {
            let (moved, moved_tensors) = of_wave(phase);
            for cell in 0..count {
                let before = (cell + phase - 3) % count;
                assert!((moved[cell] - scalars[before]).norm() < 1e-14);
                assert!((moved_tensors[cell] - tensors[before]).norm() < 1e-14);
            }
        }
    }
}
