//! The Volume Fraction Smoother (requirements VFS-1..8, VFS-V1).

use calcine_coupler::mapping::Weights;
use calcine_coupler::mesh::Mesh;
use calcine_coupler::mesh::block::{BoxSpec, box_mesh};
use calcine_coupler::physics::Vec3;
use calcine_coupler::smoother::{Operator, Settings, Smoother, SmootherError};
use proptest::prelude::*;

/// A box of cubes of 1 mm.
fn cubes(cells: [usize; 3]) -> Mesh {
    box_mesh(&BoxSpec {
        origin: Vec3::zeros(),
        size: Vec3::new(cells[0] as f64, cells[1] as f64, cells[2] as f64) * 1e-3,
        cells,
        patches: ["all"; 6].map(String::from),
    })
    .unwrap()
}

const CUBE: f64 = 1e-9;

fn settings() -> Settings {
    Settings::default()
}

fn operator_of(mesh: &Mesh, rows: Vec<Vec<(u32, f64)>>, solid: &[f64]) -> Operator {
    let weights = Weights::new(mesh.cells(), rows).unwrap();
    let smoother = Smoother::new(mesh, settings()).unwrap();
    smoother.operator(weights, solid).unwrap()
}

/// A pseudo-random number in [0, 1) (Knuth's multiplicative hash), the same in every run.
fn noise(i: usize) -> f64 {
    ((i as u64 + 1).wrapping_mul(0x9E37_79B9_7F4A_7C15) >> 11) as f64 / (1u64 << 53) as f64
}

/// VFS-V1: a particle of five cell volumes in the middle of 7 x 7 x 7 cells.
fn five_cells_in_the_middle() -> (Mesh, Operator) {
    let mesh = cubes([7, 7, 7]);
    let middle = 3 + 7 * (3 + 7 * 3);
    let operator = operator_of(&mesh, vec![vec![(middle, 1.0)]], &[5.0 * CUBE]);
    (mesh, operator)
}

#[test]
fn a_particle_of_five_cells_is_nowhere_above_the_threshold_and_loses_no_volume() {
    let (_, operator) = five_cells_in_the_middle();
    let alpha = operator.solid_fraction();
    let highest = alpha.iter().copied().fold(0.0, f64::max);
    assert!(highest <= 0.64 + 1e-4, "{highest}");
    // The threshold is used: a smoother that spreads too far would leave the middle below it.
    assert!(highest > 0.64 - 1e-3, "{highest}");
    let total: f64 = alpha.iter().sum();
    assert!((total - 5.0).abs() < 5e-14, "{total}");
}

#[test]
fn a_particle_of_five_cells_touches_at_most_two_layers_of_neighbours() {
    let (_, operator) = five_cells_in_the_middle();
    for (cell, &alpha) in operator.solid_fraction().iter().enumerate() {
        let place = [cell % 7, cell / 7 % 7, cell / 49];
        let layer = place.iter().map(|&i| i.abs_diff(3)).max().unwrap();
        assert!(layer <= 2 || alpha == 0.0, "{place:?} holds {alpha}");
    }
}

#[test]
fn a_particle_of_five_cells_is_smoothed_symmetrically() {
    let (_, operator) = five_cells_in_the_middle();
    let alpha = operator.solid_fraction();
    let at = |i: usize, j: usize, k: usize| alpha[i + 7 * (j + 7 * k)];
    for k in 0..7 {
        for j in 0..7 {
            for i in 0..7 {
                for image in [at(6 - i, j, k), at(j, i, k), at(k, i, j)] {
                    assert!((at(i, j, k) - image).abs() <= 1e-14);
                }
            }
        }
    }
}
