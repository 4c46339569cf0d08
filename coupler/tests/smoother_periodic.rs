//! Smoothing and diffusion across periodic planes (docs/theory.md, VFS-4, 6): where the domain is cut changes nothing.

#![allow(clippy::unwrap_used)]

use calcine_coupler::mapping::Weights;
use calcine_coupler::mesh::Mesh;
use calcine_coupler::mesh::block::{BoxSpec, box_mesh};
use calcine_coupler::physics::Vec3;
use calcine_coupler::smoother::{Operator, Smoother, SmootherSettings};

const SHAPE: [usize; 3] = [8, 5, 6];
const CUBE: f64 = 1e-9;

/// A box of cubes of 1 mm, periodic along x and z.
fn cubes(cells: [usize; 3]) -> Mesh {
    let mesh = box_mesh(&BoxSpec {
        origin: Vec3::zeros(),
        size: Vec3::new(cells[0] as f64, cells[1] as f64, cells[2] as f64) * 1e-3,
        cells,
        patches: ["a", "b", "c", "d", "e", "f"].map(String::from),
    });
    let pairs = [["a", "b"], ["e", "f"]].map(|pair| pair.map(String::from));
    mesh.unwrap().with_periodic(&pairs).unwrap()
}

fn smoothed(mesh: &Mesh, solid: &[f64], length: Option<f64>) -> Operator {
    let rows = (0..mesh.cells()).map(|cell| vec![(cell as u32, 1.0)]);
    let weights = Weights::new(mesh.cells(), rows.collect()).unwrap();
    let settings = SmootherSettings {
        diffusion_length: length,
        ..SmootherSettings::default()
    };
    let smoother = Smoother::new(mesh, settings).unwrap();
    smoother.operator(weights, solid).unwrap()
}

/// Where a cell comes to lie when the domain is cut elsewhere.
fn shifted(cell: usize) -> usize {
    let [i, j, k] = [cell % 8, cell / 8 % 5, cell / 40];
    (i + 3) % 8 + 8 * (j + 5 * ((k + 4) % 6))
}

#[test]
fn a_bed_is_smoothed_and_diffused_the_same_wherever_the_boundary_cuts() {
    let mesh = cubes(SHAPE);
    let cells = mesh.cells();
    // Particles of up to four cells in every seventh cell, some of them beside the planes.
    let solid: Vec<f64> = (0..cells)
        .map(|cell| match cell % 7 {
            0 => (1.0 + (cell % 4) as f64) * CUBE,
            _ => 0.1 * CUBE,
        })
        .collect();
    let mut moved = vec![0.0; cells];
    for cell in 0..cells {
        moved[shifted(cell)] = solid[cell];
    }
    for length in [None, Some(1.5e-3)] {
        let here = smoothed(&mesh, &solid, length);
        let there = smoothed(&mesh, &moved, length);
        let (here, there) = (here.solid_fraction(), there.solid_fraction());
        for cell in 0..cells {
            let off = (here[cell] - there[shifted(cell)]).abs();
            // What the solver of the obstacle problem leaves.
            assert!(off < 1e-10, "{length:?}, cell {cell}: {off}");
        }
        let sum = |values: &[f64]| values.iter().sum::<f64>();
        assert!((sum(here) * CUBE / sum(&solid) - 1.0).abs() < 1e-12);
    }
}

#[test]
fn excess_beside_a_periodic_plane_passes_to_both_sides_alike() {
    // Three cells' solid in the first of nine: half of the excess goes each way.
    let mesh = cubes([9, 1, 2]);
    let mut solid = vec![0.0; mesh.cells()];
    solid[0] = 3.0 * CUBE;
    solid[9] = 3.0 * CUBE;
    let operator = smoothed(&mesh, &solid, None);
    let fraction = operator.solid_fraction();
    assert!(fraction[8] > 0.1, "{fraction:?}");
    for cell in 1..9 {
        assert!((fraction[cell] - fraction[9 - cell]).abs() < 1e-12);
    }
}
