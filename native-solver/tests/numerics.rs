//! Linear solvers and operators on general meshes.
#![allow(clippy::unwrap_used, clippy::needless_range_loop)]

use std::f64::consts::PI;
use std::sync::Arc;

use calcine_coupler::mesh::Mesh;
use calcine_coupler::physics::Vec3;
use calcine_native::numerics::grid::MeshGraph;
use calcine_native::numerics::krylov::{Krylov, SolveTolerance};
use calcine_native::numerics::matrix::Matrix;
use calcine_native::numerics::operators::{conductance, displacement, gradients, outflow};
use calcine_native::numerics::parallel::sum;
use calcine_native::numerics::preconditioner::{Incomplete, Preconditioner};

use crate::common::*;

const TIGHT: SolveTolerance = SolveTolerance {
    absolute: 0.0,
    of_terms: 0.0,
    relative: 1e-13,
    iterations: 500,
};

fn unit_box(cells: [usize; 3]) -> Arc<Mesh> {
    named_box([1.0, 1.0, 1.0], cells, ["wall"; 6])
}

/// The unit box, its points moved along x and y.
fn sheared(cells: [usize; 3]) -> Mesh {
    let mut topology = unit_box(cells).topology().clone();
    for point in &mut topology.points {
        point.x += 0.4 * point.z;
        point.y += 0.2 * point.z;
    }
    Mesh::new(topology).unwrap()
}

/// Diffusion with zero on the boundary, and an upwind convection of this strength along z.
fn transport(grid: &Arc<MeshGraph>, diffusion: f64, speed: f64) -> Matrix {
    let mut matrix = Matrix::new(grid.clone());
    matrix.assemble(|cell, diagonal, neighbours| {
        for link in grid.links(cell) {
            let face = &grid.faces[link.face as usize];
            let inflow = (-link.sign * speed * face.area * face.normal.z).max(0.0);
            let weight = conductance(face, diffusion) + inflow;
            *diagonal += weight;
            if !link.is_boundary() {
                neighbours[link.slot as usize] -= weight;
            }
        }
    });
    matrix
}

#[test]
fn both_solvers_find_the_known_solution_of_a_diffusion_and_a_transport_problem() {
    let grid = Arc::new(MeshGraph::new(&unit_box([9, 8, 7])));
    for speed in [0.0, 30.0] {
        let matrix = transport(&grid, 1.0, speed);
        let known = scatter(grid.cells(), 11);
        let mut b = vec![0.0; known.len()];
        matrix.times(&known, &mut b);
        let mut preconditioner = Incomplete::default();
        preconditioner.update(&matrix);
        let mut krylov = Krylov::default();
        let mut x = vec![0.0; known.len()];
        let solved = if speed == 0.0 {
            krylov.symmetric(&matrix, &mut preconditioner, &b, &mut x, TIGHT)
        } else {
            krylov.general(&matrix, &mut preconditioner, &b, &mut x, TIGHT)
        };
        assert!(solved.converged, "{solved:?}");
        assert!(solved.iterations < 30, "{solved:?}");
        // The condition of these matrices is below 100, residuals are 1e-13.
        for (x, known) in x.iter().zip(&known) {
            assert!((x - known).abs() < 1e-11, "{x} against {known}");
        }
    }
}

#[test]
fn the_incomplete_factorisation_solves_a_chain_of_cells_at_once() {
    let grid = Arc::new(MeshGraph::new(&unit_box([1, 1, 50])));
    let matrix = transport(&grid, 1.0, 3.0);
    let known = scatter(50, 5);
    let (mut b, mut x) = (vec![0.0; 50], vec![0.0; 50]);
    matrix.times(&known, &mut b);
    let mut preconditioner = Incomplete::default();
    preconditioner.update(&matrix);
    preconditioner.apply(&b, &mut x);
    for (x, known) in x.iter().zip(&known) {
        assert!((x - known).abs() < 1e-11);
    }
    let mut start = x.clone();
    let mut krylov = Krylov::default();
    let solved = krylov.general(&matrix, &mut preconditioner, &b, &mut start, TIGHT);
    assert!(solved.iterations <= 1, "{solved:?}");
}

#[test]
fn a_solve_that_is_cut_short_says_so() {
    let grid = Arc::new(MeshGraph::new(&unit_box([10, 10, 10])));
    let matrix = transport(&grid, 1.0, 0.0);
    let mut preconditioner = Incomplete::default();
    preconditioner.update(&matrix);
    let target = SolveTolerance {
        iterations: 2,
        ..TIGHT
    };
    let (b, mut x) = (vec![1.0; 1000], vec![0.0; 1000]);
    let solved = Krylov::default().symmetric(&matrix, &mut preconditioner, &b, &mut x, target);
    assert!(!solved.converged);
    assert_eq!(solved.iterations, 2);
}

#[test]
fn the_gradient_of_a_linear_field_is_exact_on_a_sheared_mesh() {
    let grid = MeshGraph::new(&sheared([4, 5, 6]));
    assert!(!grid.orthogonal);
    let slope = Vec3::new(2.0, -3.0, 5.0);
    let values: Vec<f64> = grid.centre.iter().map(|x| slope.dot(x)).collect();
    let exact = vec![slope; values.len()];
    // On the boundary the value at the face's centre.
    let boundary = |index: usize, inner: f64| {
        let face = &grid.faces[index];
        Some(inner + slope.dot(&(face.owner_distance * face.normal + face.owner_skew)))
    };
    let mut faces = vec![0.0; grid.faces.len()];
    let mut found = vec![Vec3::zeros(); grid.cells()];
    gradients(&grid, &values, boundary, &mut found, &mut faces);
    for found in found {
        assert!((found - slope).norm() < 1e-12);
    }
    // And a difference across a face, corrected, is the slope along its normal.
    for face in &grid.faces[..grid.internal] {
        let fall = values[face.neighbour] - values[face.owner];
        let along = (fall - displacement(&grid, face, &exact)) / face.distance();
        assert!((along - slope.dot(&face.normal)).abs() < 1e-12);
    }
}

#[test]
fn the_outflow_of_a_uniform_field_is_zero() {
    let grid = MeshGraph::new(&sheared([3, 4, 5]));
    let speed = Vec3::new(1.0, 2.0, 3.0);
    let faces = grid.faces.iter();
    let flux: Vec<f64> = faces
        .map(|face| face.area * face.normal.dot(&speed))
        .collect();
    for cell in 0..grid.cells() {
        assert!(outflow(&grid, &flux, cell).abs() < 1e-15);
    }
}

/// RMS error of −∇²x = s for x = sin(πX) sin(πY) sin(πZ) in coordinates that the shear carries
/// along, so that x is zero on the whole boundary.
fn laplacian_error(n: usize, skewed: bool) -> f64 {
    let mesh = if skewed {
        sheared([n; 3])
    } else {
        unit_box([n; 3]).as_ref().clone()
    };
    let grid = Arc::new(MeshGraph::new(&mesh));
    let (a, b) = if skewed { (0.4, 0.2) } else { (0.0, 0.0) };
    let local = |x: &Vec3| [x.x - a * x.z, x.y - b * x.z, x.z].map(|x| PI * x);
    let exact = |x: &Vec3| local(x).map(f64::sin).iter().product::<f64>();
    // With X = x − a z, Y = y − b z: ∇² = (1+a²)∂XX + (1+b²)∂YY + ∂ZZ + 2ab ∂XY − 2a ∂XZ − 2b ∂YZ.
    let source = |x: &Vec3| {
        let [p, q, r] = local(x);
        let second = (3.0 + a * a + b * b) * p.sin() * q.sin() * r.sin();
        let mixed = 2.0 * a * b * p.cos() * q.cos() * r.sin()
            - 2.0 * a * p.cos() * q.sin() * r.cos()
            - 2.0 * b * p.sin() * q.cos() * r.cos();
        PI * PI * (second - mixed)
    };
    let matrix = transport(&grid, 1.0, 0.0);
    let mut preconditioner = Incomplete::default();
    preconditioner.update(&matrix);
    let mut krylov = Krylov::default();
    let cells = grid.cells();
    let (mut x, mut faces) = (vec![0.0; cells], vec![0.0; grid.faces.len()]);
    let mut slopes = vec![Vec3::zeros(); cells];
    for _ in 0..if skewed { 30 } else { 1 } {
        gradients(&grid, &x, |_, _| Some(0.0), &mut slopes, &mut faces);
        let right: Vec<f64> = (0..cells)
            .map(|cell| {
                let links = grid.links(cell).iter();
                let explicit: f64 = links
                    .map(|link| {
                        let face = &grid.faces[link.face as usize];
                        let skew = displacement(&grid, face, &slopes);
                        link.sign * conductance(face, 1.0) * skew
                    })
                    .sum();
                source(&grid.centre[cell]) * grid.volume[cell] - explicit
            })
            .collect();
        krylov.symmetric(&matrix, &mut preconditioner, &right, &mut x, TIGHT);
    }
    sum(cells, |cell| {
        (x[cell] - exact(&grid.centre[cell])).powi(2) / cells as f64
    })
    .sqrt()
}

#[test]
fn the_laplacian_converges_with_second_order_on_straight_and_sheared_meshes() {
    for skewed in [false, true] {
        let errors = [6, 12, 24].map(|n| laplacian_error(n, skewed));
        for pair in errors.windows(2) {
            let order = (pair[0] / pair[1]).log2();
            assert!(
                (order - 2.0).abs() < 0.25,
                "order {order}, errors {errors:?}"
            );
        }
    }
}

/// RMS error of convection against diffusion between x = 0 and x = 1 at a Péclet number of 5.
fn transport_error(n: usize) -> f64 {
    let grid = Arc::new(MeshGraph::new(&unit_box([1, 1, n])));
    let speed = 5.0;
    let mut matrix = Matrix::new(grid.clone());
    let mut source = vec![0.0; n];
    let weight = |sign: f64, face: &calcine_native::numerics::grid::Face| {
        conductance(face, 1.0) + (-sign * speed * face.area * face.normal.z).max(0.0)
    };
    matrix.assemble(|cell, diagonal, neighbours| {
        for link in grid.links(cell) {
            let face = &grid.faces[link.face as usize];
            if !link.is_boundary() {
                *diagonal += weight(link.sign, face);
                neighbours[link.slot as usize] -= weight(link.sign, face);
            } else if face.normal.z.abs() > 0.5 {
                *diagonal += weight(link.sign, face);
            }
        }
    });
    for face in &grid.faces[grid.internal..] {
        if face.normal.z > 0.5 {
            source[face.owner] += weight(1.0, face);
        }
    }
    let mut preconditioner = Incomplete::default();
    preconditioner.update(&matrix);
    let mut x = vec![0.0; n];
    Krylov::default().general(&matrix, &mut preconditioner, &source, &mut x, TIGHT);
    let exact = |z: f64| (speed * z).exp_m1() / speed.exp_m1();
    sum(n, |cell| {
        (x[cell] - exact(grid.centre[cell].z)).powi(2) / n as f64
    })
    .sqrt()
}

#[test]
fn upwind_convection_with_diffusion_converges_with_first_order() {
    let errors = [40, 80, 160, 320].map(transport_error);
    for pair in errors.windows(2) {
        let order = (pair[0] / pair[1]).log2();
        assert!(
            (order - 1.0).abs() < 0.15,
            "order {order}, errors {errors:?}"
        );
    }
}

#[test]
fn the_incomplete_factorisation_of_many_cells_is_symmetric_and_has_the_same_bits_on_any_threads() {
    let grid = Arc::new(MeshGraph::new(&unit_box([30, 30, 40])));
    let matrix = transport(&grid, 1.0, 0.0);
    let [x, y] = [3, 4].map(|seed| scatter(grid.cells(), seed));
    let on = |threads, r: &[f64]| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
        pool.unwrap().install(|| {
            let (mut preconditioner, mut z) = (Incomplete::default(), vec![0.0; r.len()]);
            preconditioner.update(&matrix);
            preconditioner.apply(r, &mut z);
            z
        })
    };
    let (mx, my) = (on(1, &x), on(1, &y));
    assert_eq!(mx, on(3, &x));
    let product = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    let (left, right) = (product(&x, &my), product(&mx, &y));
    assert!((left / right - 1.0).abs() < 1e-11, "{left} against {right}");
}
