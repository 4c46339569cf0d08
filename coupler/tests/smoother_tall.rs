//! Tall beds near the threshold, where sweeps from neighbour to neighbour take tens of thousands:
//! active sets and multigrid must find what sweeps would (docs/theory.md, VFS-3, 4, 6, 8).

#![allow(clippy::unwrap_used)]

use calcine_coupler::mapping::Weights;
use calcine_coupler::mesh::Mesh;
use calcine_coupler::mesh::block::{BoxSpec, box_mesh};
use calcine_coupler::physics::Vec3;
use calcine_coupler::smoother::{Operator, Smoother, SmootherSettings};

const CUBE: f64 = 1e-9;

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

/// A pseudo-random number in [0, 1), the same in every run (splitmix64's finaliser).
fn noise(i: usize) -> f64 {
    let mut z = (i as u64 + 1).wrapping_mul(0x9E37_79B9_7F4A_7C15);
    z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
    ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 53) as f64
}

/// Solid volumes by cell as centroid mapping gives them, three cells in ten full and the others
/// nearly empty, with this mean solid fraction; the top holds `tilt` times less than the bottom.
fn spiky(shape: [usize; 3], mean: f64, tilt: f64) -> Vec<f64> {
    let layer = shape[0] * shape[1];
    let of = |cell: usize| {
        let full = noise(2 * cell) < 0.3;
        let amount = noise(2 * cell + 1);
        let height = (cell / layer) as f64 / shape[2] as f64;
        (if full { 1.0 + amount } else { 0.3 * amount }) / (1.0 + (tilt - 1.0) * height)
    };
    let amounts: Vec<f64> = (0..layer * shape[2]).map(of).collect();
    let scale = mean * amounts.len() as f64 * CUBE / amounts.iter().sum::<f64>();
    amounts.iter().map(|amount| amount * scale).collect()
}

/// W of a bed of one particle per cell: S alone.
fn smoothed(mesh: &Mesh, solid: &[f64]) -> Operator {
    let rows = (0..mesh.cells()).map(|cell| vec![(cell as u32, 1.0)]);
    let weights = Weights::new(mesh.cells(), rows.collect()).unwrap();
    let smoother = Smoother::new(mesh, SmootherSettings::default()).unwrap();
    smoother.operator(weights, solid).unwrap()
}

/// A sum without round-off of its own (Neumaier).
fn sum(terms: impl Iterator<Item = f64>) -> f64 {
    let (mut sum, mut lost) = (0.0f64, 0.0);
    for term in terms {
        let next = sum + term;
        lost += if sum.abs() >= term.abs() {
            (sum - next) + term
        } else {
            (term - next) + sum
        };
        sum = next;
    }
    sum + lost
}

/// The beds of this file: shape, mean solid fraction, tilt.
const BEDS: [([usize; 3], f64, f64); 6] = [
    ([10, 10, 200], 0.60, 2.0),
    ([10, 10, 200], 0.62, 1.0),
    ([10, 10, 200], 0.635, 2.0),
    ([10, 10, 200], 0.63999, 1.5),
    ([3, 3, 800], 0.635, 1.2),
    ([24, 24, 24], 0.635, 1.5),
];

#[test]
fn tall_beds_near_the_threshold_come_below_it_and_keep_their_volume() {
    for (shape, mean, tilt) in BEDS {
        let solid = spiky(shape, mean, tilt);
        let operator = smoothed(&cubes(shape), &solid);
        let alpha = operator.solid_fraction();
        let highest = alpha.iter().copied().fold(0.0, f64::max);
        assert!(highest <= 0.64 + 1e-4, "{shape:?} {mean}: {highest}");
        assert!(alpha.iter().all(|&alpha| alpha >= 0.0));
        let kept = sum(alpha.iter().map(|alpha| alpha * CUBE)) / sum(solid.iter().copied()) - 1.0;
        assert!(kept.abs() < 1e-14, "{shape:?} {mean}: {kept:e}");
    }
}

#[test]
fn multigrid_stands_for_many_sweeps_in_tall_beds() {
    let (shape, mean, tilt) = BEDS[2];
    let operator = smoothed(&cubes(shape), &spiky(shape, mean, tilt));
    assert!(operator.is_multigrid());
    // Each cycle takes some eight times the work of a sweep.
    assert!(operator.sweeps() < 40, "{}", operator.sweeps());
    assert!(operator.active_cells() > 10_000);
}

/// Round-off is larger by what passes a cell over what stays there: some thousands where excess
/// climbs 800 layers, some tens in the other beds.
#[test]
fn spread_and_sample_of_tall_beds_are_adjoint_to_round_off() {
    for (shape, mean, tilt) in BEDS {
        let mesh = cubes(shape);
        let operator = smoothed(&mesh, &spiky(shape, mean, tilt));
        let x: Vec<f64> = (0..mesh.cells()).map(|i| noise(i) - 0.5).collect();
        let y: Vec<f64> = (0..mesh.cells()).map(|i| noise(i + 77_777) - 0.5).collect();
        let (mut through, mut seen) = (vec![0.0; mesh.cells()], vec![0.0; mesh.cells()]);
        operator.spread(&x, &mut through);
        operator.sample(&y, &mut seen);
        let cells = sum(through.iter().zip(&y).map(|(a, b)| a * b));
        let particles = sum(x.iter().zip(&seen).map(|(a, b)| a * b));
        let size = sum(through.iter().zip(&y).map(|(a, b)| (a * b).abs()));
        let error = (cells - particles) / size;
        let tolerance = if shape[2] == 800 { 1e-13 } else { 1e-14 };
        assert!(error.abs() < tolerance, "{shape:?} {mean}: {error:e}");
    }
}

/// Weights are shares: none is negative, those of a particle sum to 1.
#[test]
fn weights_of_tall_beds_are_shares() {
    for (shape, mean, tilt) in BEDS {
        let mesh = cubes(shape);
        let operator = smoothed(&mesh, &spiky(shape, mean, tilt));
        let (mut one, mut weights) = (vec![0.0; mesh.cells()], vec![0.0; mesh.cells()]);
        for k in 0..12 {
            let particle = (noise(900 + k) * mesh.cells() as f64) as usize;
            one[particle] = 1.0;
            operator.spread(&one, &mut weights);
            one[particle] = 0.0;
            let least = weights.iter().copied().fold(0.0, f64::min);
            assert!(least >= -1e-13, "{shape:?} {mean}: {least:e}");
            let total = sum(weights.iter().copied()) - 1.0;
            assert!(total.abs() < 1e-14, "{shape:?} {mean}: {total:e}");
        }
        operator.sample(&vec![1.0; mesh.cells()], &mut weights);
        assert!(weights.iter().all(|&seen| seen == 1.0));
    }
}

/// The paper's sweeps, written down as they are said (VFS-2): each cell gives a sixth of its
/// excess through each face, and keeps what would go through walls by giving more to the others.
fn swept(shape: [usize; 3], solid: &[f64], sweeps: usize) -> Vec<f64> {
    let at = |i: usize, j: usize, k: usize| i + shape[0] * (j + shape[1] * k);
    let mut neighbours = vec![Vec::new(); solid.len()];
    for k in 0..shape[2] {
        for j in 0..shape[1] {
            for i in 0..shape[0] {
                let others = [(i + 1, j, k), (i, j + 1, k), (i, j, k + 1)];
                for (i2, j2, k2) in others {
                    if i2 < shape[0] && j2 < shape[1] && k2 < shape[2] {
                        neighbours[at(i, j, k)].push(at(i2, j2, k2));
                        neighbours[at(i2, j2, k2)].push(at(i, j, k));
                    }
                }
            }
        }
    }
    let mut fraction: Vec<f64> = solid.iter().map(|solid| solid / CUBE).collect();
    for _ in 0..sweeps {
        let before = fraction.clone();
        for (cell, neighbours) in neighbours.iter().enumerate() {
            let excess = (before[cell] - 0.64).max(0.0);
            fraction[cell] -= excess;
            for &neighbour in neighbours {
                fraction[neighbour] += excess / neighbours.len() as f64;
            }
        }
    }
    fraction
}

#[test]
fn multigrid_finds_what_very_many_sweeps_find() {
    let shape = [4, 4, 30];
    let solid = spiky(shape, 0.61, 3.0);
    let operator = smoothed(&cubes(shape), &solid);
    assert!(operator.is_multigrid());
    let limit = swept(shape, &solid, 60_000);
    for (alpha, limit) in operator.solid_fraction().iter().zip(limit) {
        assert!((alpha - limit).abs() < 1e-9, "{alpha} {limit}");
    }
}

/// 240 cell volumes in the first of 400 cells in a line fill 375 of them.
#[test]
fn a_long_line_of_cells_fills_one_after_the_other() {
    let mut solid = vec![0.0; 400];
    solid[0] = 240.0 * CUBE;
    let operator = smoothed(&cubes([400, 1, 1]), &solid);
    for (cell, alpha) in operator.solid_fraction().iter().enumerate() {
        let expected = if cell < 375 { 0.64 } else { 0.0 };
        assert!((alpha - expected).abs() < 1e-9, "{cell}: {alpha}");
    }
}

#[test]
fn a_tall_bed_is_smoothed_to_the_same_bits_on_one_thread_and_on_two() {
    let (shape, mean, tilt) = BEDS[2];
    let mesh = cubes(shape);
    let solid = spiky(shape, mean, tilt);
    let field: Vec<f64> = (0..mesh.cells()).map(noise).collect();
    let on = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
        pool.unwrap().install(|| {
            let operator = smoothed(&mesh, &solid);
            let mut seen = vec![0.0; mesh.cells()];
            operator.sample(&field, &mut seen);
            (operator.solid_fraction().to_vec(), seen)
        })
    };
    assert!(on(1) == on(2));
}

#[test]
fn a_tall_bed_does_not_depend_on_the_numbering_of_cells() {
    let shape = [8, 8, 60];
    let (mesh, solid) = (cubes(shape), spiky(shape, 0.62, 1.5));
    let cells = mesh.cells();
    let mut renumber: Vec<usize> = (0..cells).collect();
    renumber.sort_by(|&a, &b| noise(a).total_cmp(&noise(b)));
    let mut topology = mesh.topology().clone();
    for cell in topology.owner.iter_mut().chain(&mut topology.neighbour) {
        *cell = renumber[*cell as usize] as u32;
    }
    let mut solid_there = vec![0.0; cells];
    for (cell, &solid) in solid.iter().enumerate() {
        solid_there[renumber[cell]] = solid;
    }
    let here = smoothed(&mesh, &solid);
    let there = smoothed(&Mesh::new(topology).unwrap(), &solid_there);
    assert!(here.is_multigrid() && there.is_multigrid());
    for (cell, &there_cell) in renumber.iter().enumerate() {
        let difference = here.solid_fraction()[cell] - there.solid_fraction()[there_cell];
        assert!(difference.abs() < 1e-13, "{cell}: {difference:e}");
    }
}

/// Cells of 1 x 1 x 0.2 mm, 25 times better joined upwards than sideways, around a duct that nothing
/// may enter.
#[test]
fn a_tall_bed_of_flat_cells_around_a_duct_is_smoothed_like_any_other() {
    let shape = [7, 7, 150];
    let mesh = box_mesh(&BoxSpec {
        origin: Vec3::zeros(),
        size: Vec3::new(7e-3, 7e-3, 30e-3),
        cells: shape,
        patches: ["all"; 6].map(String::from),
    })
    .unwrap();
    let in_duct = |cell: usize| (2..4).contains(&(cell % 7)) && (2..5).contains(&(cell / 7 % 7));
    let excluded: Vec<bool> = (0..mesh.cells()).map(in_duct).collect();
    let mut solid = spiky(shape, 0.62, 2.0);
    for (cell, solid) in solid.iter_mut().enumerate() {
        *solid *= if in_duct(cell) { 0.01 } else { 0.2 };
    }
    let outside = excluded.iter().filter(|&&excluded| !excluded).count();
    let held = sum(solid
        .iter()
        .zip(&excluded)
        .map(|(s, &e)| if e { 0.0 } else { *s }));
    let scale = 0.62 * outside as f64 * 0.2 * CUBE / held;
    solid.iter_mut().for_each(|solid| *solid *= scale);

    let rows = (0..mesh.cells()).map(|cell| vec![(cell as u32, 1.0)]);
    let weights = Weights::new(mesh.cells(), rows.collect()).unwrap();
    let smoother = Smoother::with_excluded(&mesh, SmootherSettings::default(), &excluded).unwrap();
    let operator = smoother.operator(weights, &solid).unwrap();
    assert!(operator.is_multigrid());
    let mut after = vec![0.0; mesh.cells()];
    operator.spread(&solid, &mut after);
    for cell in 0..mesh.cells() {
        let alpha = after[cell] / mesh.cell_volume()[cell];
        assert!((0.0..=0.64 + 1e-4).contains(&alpha), "{cell}: {alpha}");
        assert!(!excluded[cell] || after[cell] == solid[cell]);
    }
    let kept = sum(after.iter().copied()) / sum(solid.iter().copied()) - 1.0;
    assert!(kept.abs() < 1e-14, "{kept:e}");
}
