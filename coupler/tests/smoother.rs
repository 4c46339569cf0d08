//! The Volume Fraction Smoother (docs/theory.md, VFS-1..8, VFS-V1).

#![allow(clippy::unwrap_used)]

use calcine_coupler::mapping::{Mapper, Method, Weights};
use calcine_coupler::mesh::Mesh;
use calcine_coupler::mesh::block::{BoxSpec, box_mesh};
use calcine_coupler::physics::Vec3;
use calcine_coupler::smoother::{Operator, Smoother, SmootherSettings};
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

fn settings() -> SmootherSettings {
    SmootherSettings::default()
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

/// Particles at pseudo-random places, one to three cells each, with solid volumes that overfill
/// many cells of the mesh while the bed as a whole fits.
fn rough_bed(mesh: &Mesh, particles: usize) -> (Vec<Vec<(u32, f64)>>, Vec<f64>) {
    let rows = (0..particles).map(|p| {
        let first = (noise(3 * p) * mesh.cells() as f64) as usize;
        (0..1 + p % 3)
            .map(|i| (((first + i) % mesh.cells()) as u32, 0.2 + noise(p + i)))
            .collect()
    });
    let solid = (0..particles).map(|p| CUBE * (0.5 + noise(7 * p)));
    (rows.collect(), solid.collect())
}

#[test]
fn spread_and_sample_are_adjoint_to_round_off() {
    let mesh = cubes([6, 5, 7]);
    let (rows, solid) = rough_bed(&mesh, 90);
    for diffusion_length in [None, Some(1.3e-3)] {
        let smoother = Smoother::new(
            &mesh,
            SmootherSettings {
                diffusion_length,
                ..settings()
            },
        );
        let weights = Weights::new(mesh.cells(), rows.clone()).unwrap();
        let operator = smoother.unwrap().operator(weights, &solid).unwrap();
        assert!(operator.sweeps() > 0);
        let x: Vec<f64> = (0..90).map(|i| noise(i) - 0.5).collect();
        let y: Vec<f64> = (0..mesh.cells()).map(|i| noise(1000 + i) - 0.5).collect();
        let (mut wx, mut wy) = (vec![0.0; mesh.cells()], vec![0.0; 90]);
        operator.spread(&x, &mut wx);
        operator.sample(&y, &mut wy);
        let cells: f64 = wx.iter().zip(&y).map(|(a, b)| a * b).sum();
        let particles: f64 = x.iter().zip(&wy).map(|(a, b)| a * b).sum();
        // Terms of order 0.1, some hundreds of them, thirty sweeps: round-off of 1e-15.
        assert!((cells - particles).abs() < 1e-14, "{cells} {particles}");

        let along = |values: &[f64]| -> Vec<Vec3> {
            values
                .iter()
                .map(|&v| Vec3::new(v, -2.0 * v, 0.5 * v))
                .collect()
        };
        let (mut spread, mut seen) = (vec![Vec3::zeros(); mesh.cells()], vec![Vec3::zeros(); 90]);
        operator.spread_vectors(&along(&x), &mut spread);
        operator.sample_vectors(&along(&y), &mut seen);
        assert!(
            spread
                .iter()
                .zip(&wx)
                .all(|(v, s)| (v.y + 2.0 * s).abs() < 1e-15)
        );
        assert!(
            seen.iter()
                .zip(&wy)
                .all(|(v, s)| (v.z - 0.5 * s).abs() < 1e-15)
        );
    }
}

/// CON-6: what is spread arrives in full, and a uniform field is seen as it is.
#[test]
fn the_operator_is_a_partition_of_unity() {
    let mesh = cubes([6, 5, 7]);
    let (rows, solid) = rough_bed(&mesh, 90);
    let smoother = Smoother::new(
        &mesh,
        SmootherSettings {
            diffusion_length: Some(0.8e-3),
            ..settings()
        },
    );
    let weights = Weights::new(mesh.cells(), rows).unwrap();
    let operator = smoother.unwrap().operator(weights, &solid).unwrap();
    let mut seen = vec![0.0; 90];
    operator.sample(&vec![1.0; mesh.cells()], &mut seen);
    for seen in seen {
        assert!((seen - 1.0).abs() < 1e-14, "{seen}");
    }
    let mut one = vec![0.0; 90];
    let mut cells = vec![0.0; mesh.cells()];
    for particle in 0..90 {
        one.fill(0.0);
        one[particle] = 1.0;
        operator.spread(&one, &mut cells);
        assert!((cells.iter().sum::<f64>() - 1.0).abs() < 1e-14);
        assert!(cells.iter().all(|&share| share >= -1e-16));
    }
}

/// VFS-8: the gas keeps its share everywhere, VFS-3: the solid its volume.
#[test]
fn a_rough_bed_comes_below_the_threshold_and_keeps_its_volume() {
    let mesh = cubes([6, 5, 7]);
    let (rows, solid) = rough_bed(&mesh, 90);
    let operator = operator_of(&mesh, rows, &solid);
    let alpha = operator.solid_fraction();
    assert!(alpha.iter().all(|&a| a <= 0.64 + 1e-4));
    let total: f64 = alpha.iter().sum::<f64>() * CUBE;
    let expected: f64 = solid.iter().sum();
    assert!((total / expected - 1.0).abs() < 1e-14);
}

/// The obstacle problem of VFS-4 in closed form: a line of cells, the first overfull by one cell
/// volume, the others empty. Excess can only run along the line, so cells fill one after the other.
#[test]
fn excess_in_a_line_of_cells_fills_one_after_the_other() {
    let mesh = cubes([6, 1, 1]);
    let operator = operator_of(&mesh, vec![vec![(0, 1.0)]], &[1.64 * CUBE]);
    let expected = [0.64, 0.64, 0.36, 0.0, 0.0, 0.0];
    for (alpha, expected) in operator.solid_fraction().iter().zip(expected) {
        assert!((alpha - expected).abs() < 2e-4, "{alpha} {expected}");
    }
}

/// VFS-4: shares in proportion to |S|/|d|. Cells of 1 x 2 x 1 have conductances of 2, 1/2, 2
/// through their six faces, 9 in all.
#[test]
fn excess_is_shared_by_the_conductances_of_the_mesh() {
    let mesh = box_mesh(&BoxSpec {
        origin: Vec3::zeros(),
        size: Vec3::new(3.0, 6.0, 3.0),
        cells: [3, 3, 3],
        patches: ["all"; 6].map(String::from),
    })
    .unwrap();
    let operator = operator_of(&mesh, vec![vec![(13, 1.0)]], &[2.0]);
    let alpha = operator.solid_fraction();
    let excess = 1.0 - 0.64;
    for (neighbour, share) in [
        (12, 2.0),
        (14, 2.0),
        (10, 0.5),
        (16, 0.5),
        (4, 2.0),
        (22, 2.0),
    ] {
        let expected = excess * share / 9.0;
        assert!((alpha[neighbour] - expected).abs() < 1e-14, "{neighbour}");
    }
    assert!((alpha[13] - 0.64).abs() < 1e-14);
}

#[test]
fn a_field_below_the_threshold_is_untouched_to_the_bit() {
    let mesh = cubes([5, 4, 3]);
    let rows: Vec<_> = (0..mesh.cells())
        .map(|cell| vec![(cell as u32, 1.0)])
        .collect();
    let mut solid: Vec<f64> = (0..mesh.cells())
        .map(|cell| 0.63 * noise(cell) * mesh.cell_volume()[cell])
        .collect();
    solid[7] = 0.64 * mesh.cell_volume()[7];
    let operator = operator_of(&mesh, rows, &solid);
    assert_eq!(operator.sweeps(), 0);
    let mut spread = vec![0.0; mesh.cells()];
    operator.spread(&solid, &mut spread);
    assert_eq!(spread, solid);
    let mut seen = vec![0.0; mesh.cells()];
    operator.sample(&spread, &mut seen);
    assert_eq!(seen, solid);
}

#[test]
fn smoothing_a_smoothed_field_changes_nothing() {
    let mesh = cubes([6, 5, 7]);
    let (rows, solid) = rough_bed(&mesh, 90);
    let mut once = vec![0.0; mesh.cells()];
    operator_of(&mesh, rows, &solid).spread(&solid, &mut once);
    let each: Vec<_> = (0..mesh.cells())
        .map(|cell| vec![(cell as u32, 1.0)])
        .collect();
    let mut twice = vec![0.0; mesh.cells()];
    operator_of(&mesh, each, &once).spread(&once, &mut twice);
    for (once, twice) in once.iter().zip(&twice) {
        // What the tolerance left in place may move on.
        assert!((once - twice).abs() <= 1e-4 * CUBE, "{once} {twice}");
    }
}

#[test]
fn a_particle_five_times_larger_than_a_cell_loses_no_volume_and_leaves_gas() {
    let mesh = cubes([9, 9, 9]);
    let radius = 2.5e-3f64;
    let at = Vec3::new(4.4e-3, 4.7e-3, 4.5e-3);
    let volume = 4.0 / 3.0 * std::f64::consts::PI * radius.powi(3);
    let smoother = Smoother::new(&mesh, settings()).unwrap();
    for method in [
        Method::Centroid,
        Method::Divided,
        Method::Overlap,
        Method::Linear,
    ] {
        let weights = Mapper::new(&mesh).fill(method, &[at], &[radius]).unwrap();
        let operator = smoother.operator(weights, &[volume]).unwrap();
        let alpha = operator.solid_fraction();
        assert!(alpha.iter().all(|&a| a <= 0.64 + 1e-4), "{method:?}");
        let total: f64 = alpha.iter().sum::<f64>() * CUBE;
        assert!((total / volume - 1.0).abs() < 1e-14, "{method:?}: {total}");
    }
}

/// VFS-1, measured independently: a particle five cells wide that moves by 0.04 cells over a face
/// changes 56 % of α (L1) if mapped by its centre, 2.2 % by overlap.
#[test]
fn overlap_moves_a_particle_over_a_face_smoothly_and_the_centroid_does_not() {
    let mesh = cubes([15, 15, 15]);
    let mapper = Mapper::new(&mesh);
    let smoother = Smoother::new(&mesh, settings()).unwrap();
    let radius = 2.5e-3f64;
    let volume = 4.0 / 3.0 * std::f64::consts::PI * radius.powi(3);
    let change = |method: Method| {
        let alpha = |x: f64| {
            let weights = mapper.fill(method, &[Vec3::new(x, 7.5e-3, 7.5e-3)], &[radius]);
            let operator = smoother.operator(weights.unwrap(), &[volume]).unwrap();
            operator.solid_fraction().to_vec()
        };
        let (before, after) = (alpha(7.98e-3), alpha(8.02e-3));
        let changes = before.iter().zip(&after).map(|(a, b)| (a - b).abs());
        changes.sum::<f64>() * CUBE / volume
    };
    assert!((change(Method::Centroid) - 0.56).abs() < 0.005);
    assert!((change(Method::Overlap) - 0.022).abs() < 0.001);
    // One or two of 29 satellites change cells.
    let divided = change(Method::Divided);
    assert!(divided < 0.15, "{divided}");
}

#[test]
fn the_result_does_not_depend_on_the_numbering_of_cells() {
    let mesh = cubes([6, 5, 7]);
    let cells = mesh.cells();
    // 101 is prime to 210, so this is a permutation.
    let renumber = |cell: usize| (101 * cell + 17) % cells;
    let mut topology = mesh.topology().clone();
    for cell in topology.owner.iter_mut().chain(&mut topology.neighbour) {
        *cell = renumber(*cell as usize) as u32;
    }
    let renumbered = Mesh::new(topology).unwrap();
    let (rows, solid) = rough_bed(&mesh, 90);
    let rows_there: Vec<Vec<_>> = rows
        .iter()
        .map(|row| {
            row.iter()
                .map(|&(cell, share)| (renumber(cell as usize) as u32, share))
                .collect()
        })
        .collect();
    let here = operator_of(&mesh, rows, &solid);
    let there = operator_of(&renumbered, rows_there, &solid);
    assert_eq!(here.sweeps(), there.sweeps());
    for cell in 0..cells {
        let difference = here.solid_fraction()[cell] - there.solid_fraction()[renumber(cell)];
        assert!(difference.abs() < 1e-13, "{cell}: {difference}");
    }
}

#[test]
fn the_operator_is_the_same_bits_on_one_thread_and_on_four() {
    let mesh = cubes([16, 16, 16]);
    let (rows, solid) = rough_bed(&mesh, 1500);
    let on = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(threads)
            .build()
            .unwrap();
        pool.install(|| {
            operator_of(&mesh, rows.clone(), &solid)
                .solid_fraction()
                .to_vec()
        })
    };
    assert_eq!(on(1), on(4));
}

/// Diffusion over ℓ widens by the variance 2ℓ² along each axis, exactly on a uniform mesh.
#[test]
fn diffusion_widens_by_twice_its_length_squared_and_makes_no_new_maximum() {
    let mesh = cubes([31, 1, 1]);
    let length = 1.4e-3;
    let smoother = Smoother::new(
        &mesh,
        SmootherSettings {
            diffusion_length: Some(length),
            ..settings()
        },
    );
    let weights = Weights::new(31, vec![vec![(15, 1.0)]]).unwrap();
    let operator = smoother.unwrap().operator(weights, &[0.5 * CUBE]).unwrap();
    let alpha = operator.solid_fraction();
    let at = |cell: usize| (cell as f64 - 15.0) * 1e-3;
    let total: f64 = alpha.iter().sum();
    let variance: f64 = (0..31).map(|c| alpha[c] * at(c) * at(c)).sum::<f64>() / total;
    assert!((total - 0.5).abs() < 1e-14);
    // The tails beyond 15 cells (7.6 standard deviations) are reflected.
    assert!((variance / (2.0 * length * length) - 1.0).abs() < 1e-9);
    assert!(alpha.iter().all(|&a| (0.0..0.5).contains(&a)));
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]
    #[test]
    fn any_bed_that_fits_is_smoothed_below_the_threshold(
        amounts in prop::collection::vec(0.0..3.0f64, 60),
        scale in 0.1..0.95f64,
    ) {
        let mesh = cubes([3, 4, 5]);
        let rows = (0..60).map(|cell| vec![(cell, 1.0)]).collect();
        let full = 60.0 * 0.64 * CUBE * scale / amounts.iter().sum::<f64>();
        let solid: Vec<f64> = amounts.iter().map(|a| a * full).collect();
        let operator = operator_of(&mesh, rows, &solid);
        let alpha = operator.solid_fraction();
        prop_assert!(alpha.iter().all(|&a| (0.0..=0.6401).contains(&a)));
        let total = alpha.iter().sum::<f64>() * CUBE;
        prop_assert!((total / solid.iter().sum::<f64>() - 1.0).abs() < 1e-14);
    }
}
