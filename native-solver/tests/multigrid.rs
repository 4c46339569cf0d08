//! The algebraic multigrid: convergence whatever the size, symmetry, threads, resume.
#![allow(clippy::unwrap_used, clippy::needless_range_loop)]

use std::sync::Arc;

use calcine_coupler::physics::Vec3;
use calcine_native::numerics::amg::Multigrid;
use calcine_native::numerics::grid::MeshGraph;
use calcine_native::numerics::krylov::{Krylov, SolveStatistics, SolveTolerance};
use calcine_native::numerics::matrix::Matrix;
use calcine_native::numerics::preconditioner::Preconditioner;

use crate::common::*;

/// Diffusion in a box, zero on the boundary at the top only, with a coefficient per cell and its
/// harmonic mean on faces.
fn diffusion(size: [f64; 3], cells: [usize; 3], coefficient: impl Fn(&Vec3) -> f64) -> Matrix {
    let grid = Arc::new(MeshGraph::new(&duct(size, cells)));
    let resistance: Vec<f64> = grid.centre.iter().map(|x| 1.0 / coefficient(x)).collect();
    let mut matrix = Matrix::new(grid.clone());
    matrix.assemble(|cell, diagonal, neighbours| {
        for link in grid.links(cell) {
            let face = &grid.faces[link.face as usize];
            if link.is_boundary() {
                if face.normal.z > 0.5 {
                    *diagonal += face.area / (face.owner_distance * resistance[cell]);
                }
                continue;
            }
            let series = face.owner_distance * resistance[face.owner]
                + face.neighbour_distance * resistance[face.neighbour];
            *diagonal += face.area / series;
            neighbours[link.slot as usize] -= face.area / series;
        }
    });
    matrix
}

/// Coefficients of 1 and 1e4 in blocks of an eighth of the box's unit length.
fn jumping(x: &Vec3) -> f64 {
    let parity: f64 = x.iter().map(|x| (8.0 * x).floor()).sum();
    if parity % 2.0 == 0.0 { 1.0 } else { 1e4 }
}

fn solve(matrix: &Matrix) -> SolveStatistics {
    let cells = matrix.diagonal().len();
    let known = scatter(cells, 17);
    let (mut b, mut x) = (vec![0.0; cells], vec![0.0; cells]);
    matrix.times(&known, &mut b);
    let mut multigrid = Multigrid::default();
    multigrid.update(matrix);
    let target = SolveTolerance {
        absolute: 0.0,
        of_terms: 0.0,
        relative: 1e-8,
        iterations: 200,
    };
    let solved = Krylov::default().symmetric(matrix, &mut multigrid, &b, &mut x, target);
    assert!(solved.converged, "{solved:?}");
    assert!(multigrid.complexity() < 2.5, "{}", multigrid.complexity());
    solved
}

fn iterations_do_not_grow(size: [f64; 3], coefficient: impl Fn(&Vec3) -> f64) {
    // 13 824 and 110 592 cells; both resolve the blocks of `jumping`.
    let [small, large] = [24, 48].map(|n| solve(&diffusion(size, [n; 3], &coefficient)).iterations);
    assert!(large <= small + small / 2, "{small}, then {large}");
    assert!(large <= 40, "{large}");
}

#[test]
fn iterations_do_not_grow_with_the_number_of_cells() {
    iterations_do_not_grow([1.0; 3], |_| 1.0);
}

#[test]
fn nor_where_the_coefficient_jumps_by_ten_thousand() {
    iterations_do_not_grow([1.0; 3], jumping);
}

#[test]
fn nor_in_flat_and_in_long_cells() {
    iterations_do_not_grow([1.0, 1.0, 0.02], |_| 1.0);
    iterations_do_not_grow([1.0, 1.0, 30.0], |_| 1.0);
    iterations_do_not_grow([1.0, 5.0, 30.0], |_| 1.0);
}

#[test]
fn the_multigrid_is_symmetric_and_positive() {
    let matrix = diffusion([1.0, 1.0, 3.0], [14, 15, 16], jumping);
    let mut multigrid = Multigrid::default();
    multigrid.update(&matrix);
    let cells = matrix.diagonal().len();
    let [x, y] = [3, 4].map(|seed| scatter(cells, seed));
    let (mut mx, mut my) = (vec![0.0; cells], vec![0.0; cells]);
    multigrid.apply(&x, &mut mx);
    multigrid.apply(&y, &mut my);
    let product = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    let (left, right) = (product(&x, &my), product(&mx, &y));
    assert!((left / right - 1.0).abs() < 1e-11, "{left} against {right}");
    for seed in 5..25 {
        let mut x = scatter(cells, seed);
        x.iter_mut().for_each(|x| *x -= 0.5);
        multigrid.apply(&x, &mut mx);
        assert!(product(&x, &mx) > 0.0);
    }
}

#[test]
fn the_multigrid_has_the_same_bits_on_one_two_and_five_threads() {
    let matrix = diffusion([1.0; 3], [30; 3], jumping);
    let x = scatter(27_000, 9);
    let on = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
        pool.unwrap().install(|| {
            let (mut multigrid, mut z) = (Multigrid::default(), vec![0.0; x.len()]);
            multigrid.update(&matrix);
            multigrid.apply(&x, &mut z);
            z.iter().map(|z| z.to_bits()).collect::<Vec<_>>()
        })
    };
    let one = on(1);
    assert!(one == on(2) && one == on(5));
}

#[test]
fn a_forgotten_hierarchy_leaves_no_trace() {
    let first = diffusion([1.0; 3], [20; 3], jumping);
    let second = diffusion([1.0; 3], [20; 3], |x| 1.1 * jumping(x));
    let x = scatter(8000, 9);
    let (mut fresh, mut used) = (Multigrid::default(), Multigrid::default());
    fresh.update(&second);
    used.update(&first);
    used.forget();
    used.update(&second);
    let (mut a, mut b) = (vec![0.0; 8000], vec![0.0; 8000]);
    fresh.apply(&x, &mut a);
    used.apply(&x, &mut b);
    assert_eq!(a, b);
}

/// A duct of 6 750 cells, half of it a bed.
fn bed() -> Driver {
    let mesh = duct([0.05, 0.05, 0.1], [15, 15, 30]);
    let mut setup = setup(&[
        ("bottom", inlet(0.3, 400.0)),
        ("top", outlet()),
        ("side", no_slip()),
    ]);
    setup.controls.outer_iterations = 3;
    let mut driver = Driver::new(&mesh, &setup);
    for (cell, share) in scatter(mesh.cells(), 3).into_iter().enumerate() {
        if mesh.cell_centre()[cell].z < 0.05 {
            driver.bed.void_fraction[cell] = 0.4 + 0.1 * share;
            driver.exchange.drag_coefficient[cell] = 1e-5;
        }
    }
    driver
}

#[test]
fn a_large_gas_repeats_and_resumes_with_the_same_bits() {
    let folder = tempfile::tempdir().unwrap();
    let mut through = bed();
    through.window(1e-3, 20.0);
    calcine_coupler::part::Part::checkpoint(&mut through.gas, folder.path()).unwrap();
    let mut resumed = bed();
    resumed.gas.restore(folder.path()).unwrap();
    (resumed.clocks, resumed.index) = (through.clocks, through.index);
    through.attempt(2e-3, 5.0);
    for _ in 0..2 {
        through.window(1e-3, 20.0);
        resumed.window(1e-3, 20.0);
        assert_eq!(resumed.bits(), through.bits());
    }
}
