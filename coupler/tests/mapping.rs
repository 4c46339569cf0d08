//! Base mappings of particles onto cells (docs/theory.md, VFS-1, CON-6) and cell location.

#![allow(clippy::unwrap_used)]

use calcine_coupler::mapping::{Mapper, MappingError, Method};
use calcine_coupler::mesh::Mesh;
use calcine_coupler::mesh::block::{BoxSpec, box_mesh};
use calcine_coupler::mesh::locate::Locator;
use calcine_coupler::physics::Vec3;
use proptest::prelude::*;

/// Unit cells from the origin on.
fn unit_cells(cells: [usize; 3]) -> Mesh {
    box_mesh(&BoxSpec {
        origin: Vec3::zeros(),
        size: Vec3::new(cells[0] as f64, cells[1] as f64, cells[2] as f64),
        cells,
        patches: ["all"; 6].map(String::from),
    })
    .unwrap()
}

/// 4 x 4 x 4 cells sheared and warped within, still a box of edge 4 outside.
fn warped() -> Mesh {
    let mut topology = unit_cells([4, 4, 4]).topology().clone();
    for point in &mut topology.points {
        let p = *point;
        let bump = p.iter().map(|x| x * (4.0 - x) / 4.0).product::<f64>();
        *point += Vec3::new((3.0 * p.y).sin(), (2.0 * p.z).cos(), (p.x + p.y).sin()) * 0.12 * bump;
    }
    Mesh::new(topology).unwrap()
}

fn weights_at(mapper: &Mapper<&Mesh>, method: Method, at: Vec3, radius: f64) -> Vec<f64> {
    let weights = mapper.fill(method, &[at], &[radius]).unwrap();
    let mut cells = vec![0.0; weights.cells()];
    for (cell, share) in weights.of_particle(0) {
        cells[cell] = share;
    }
    cells
}

#[test]
fn a_position_is_found_in_its_cell_and_outside_in_none() {
    let mesh = unit_cells([3, 4, 5]);
    let locator = Locator::new(&mesh);
    for (cell, &centre) in mesh.cell_centre().iter().enumerate() {
        assert_eq!(locator.cell_at(centre), Some(cell));
        let corner = centre + Vec3::new(0.49, -0.49, 0.49);
        assert_eq!(locator.cell_at(corner), Some(cell));
    }
    let outside = [
        Vec3::new(-1e-6, 1.0, 1.0),
        Vec3::new(1.0, 4.000001, 1.0),
        Vec3::new(1.0, 1.0, 1e9),
        Vec3::new(f64::NAN, 1.0, 1.0),
    ];
    for position in outside {
        assert_eq!(locator.cell_at(position), None, "{position:?}");
    }
}

#[test]
fn positions_on_walls_and_corners_belong_to_the_mesh() {
    let mesh = unit_cells([3, 4, 5]);
    let locator = Locator::new(&mesh);
    for &point in &mesh.topology().points {
        assert!(locator.cell_at(point).is_some(), "{point:?}");
    }
    for &centre in mesh.face_centre() {
        assert!(locator.cell_at(centre).is_some(), "{centre:?}");
    }
}

#[test]
fn centroid_puts_a_particle_into_the_cell_of_its_centre() {
    let mesh = unit_cells([3, 3, 3]);
    let mapper = Mapper::new(&mesh);
    let cells = weights_at(&mapper, Method::Centroid, Vec3::new(1.9, 0.5, 2.5), 0.4);
    assert_eq!(cells[1 + 2 * 9], 1.0);
}

#[test]
fn divided_approximates_the_overlap() {
    let mesh = unit_cells([4, 4, 4]);
    let mapper = Mapper::new(&mesh);
    // 29 points: one of them is 3.4 %, and a plane passes few of them within its error.
    for at in [
        Vec3::new(1.9, 1.6, 2.2),
        Vec3::new(2.2, 2.15, 1.9),
        Vec3::new(1.55, 2.3, 1.2),
    ] {
        let divided = weights_at(&mapper, Method::Divided, at, 0.7);
        let overlap = weights_at(&mapper, Method::Overlap, at, 0.7);
        for (divided, overlap) in divided.iter().zip(&overlap) {
            assert!((divided - overlap).abs() < 0.1, "{divided} {overlap}");
        }
    }
}

#[test]
fn overlap_counts_what_lies_beyond_a_wall_in_the_cells_it_has() {
    let mesh = unit_cells([2, 1, 1]);
    let mapper = Mapper::new(&mesh);
    // A quarter of the width lies beyond x = 0 and none reaches x = 1: all in the first cell.
    let cells = weights_at(&mapper, Method::Overlap, Vec3::new(0.2, 0.5, 0.5), 0.4);
    assert_eq!(cells, [1.0, 0.0]);
    // Symmetric about the face, and larger than the mesh.
    let cells = weights_at(&mapper, Method::Overlap, Vec3::new(1.0, 0.5, 0.5), 3.0);
    assert!((cells[0] - 0.5).abs() < 1e-14, "{cells:?}");
}

/// VFS-1: the largest change of a sphere's volume on one side of a plane is its disc's area times
/// the step, so the weights change by at most 2 (3/4)(step/R) per plane that is crossed.
#[test]
fn overlap_is_continuous_while_a_particle_crosses_cells() {
    let mesh = unit_cells([4, 4, 4]);
    let mapper = Mapper::new(&mesh);
    let (radius, step) = (0.45, 0.004);
    let along = Vec3::new(1.0, 0.61, 0.37).normalize();
    let mut before: Option<Vec<f64>> = None;
    for i in 0..500 {
        let at = Vec3::new(0.6, 0.9, 1.2) + along * (step * f64::from(i));
        let now = weights_at(&mapper, Method::Overlap, at, radius);
        if let Some(before) = before {
            let change: f64 = before.iter().zip(&now).map(|(a, b)| (a - b).abs()).sum();
            let planes = along.iter().sum::<f64>();
            assert!(
                change <= 1.5 * step * planes / radius + 1e-12,
                "{i}: {change}"
            );
        }
        before = Some(now);
    }
}

#[test]
fn overlap_keeps_the_centre_of_a_particle_within_a_uniform_mesh() {
    // Over cells with linear fields: the first moment of shares by volume is the sphere's centre
    // plus what the cells' own extent adds, which cancels for a sphere symmetric in its cells.
    let mesh = unit_cells([5, 5, 5]);
    let mapper = Mapper::new(&mesh);
    let at = Vec3::new(2.5, 2.5, 2.5);
    let cells = weights_at(&mapper, Method::Overlap, at, 1.9);
    let centre: Vec3 = cells
        .iter()
        .zip(mesh.cell_centre())
        .map(|(w, c)| c * *w)
        .sum();
    assert!((centre - at).norm() < 1e-14);
}

#[test]
fn a_centre_outside_the_mesh_is_an_error_that_names_particle_and_position() {
    let mesh = unit_cells([2, 2, 2]);
    let mapper = Mapper::new(&mesh);
    let inside = Vec3::new(0.5, 0.5, 0.5);
    let position = Vec3::new(0.5, 2.25, 0.5);
    let error = mapper.fill(Method::Overlap, &[inside, position], &[0.1, 0.4]);
    assert_eq!(
        error,
        Err(MappingError::Outside {
            particle: 1,
            position
        })
    );
    let text = error.unwrap_err().to_string();
    assert_eq!(
        text,
        "particle 1 at (0.5, 2.25, 0.5) m lies outside the mesh"
    );
    let negative = mapper
        .fill(Method::Centroid, &[inside], &[-0.1])
        .unwrap_err();
    assert_eq!(
        negative,
        MappingError::Radius {
            particle: 0,
            radius: -0.1
        }
    );
    assert!(mapper.fill(Method::Centroid, &[inside], &[]).is_err());
}

#[test]
fn weights_are_the_same_bits_on_one_thread_and_on_four() {
    let mesh = warped();
    let mapper = Mapper::new(&mesh);
    let positions: Vec<_> = (0..200)
        .map(|i| {
            Vec3::new(
                0.37 * f64::from(i) % 4.0,
                0.53 * f64::from(i) % 4.0,
                0.71 * f64::from(i) % 4.0,
            )
        })
        .collect();
    let radii: Vec<_> = (0..200).map(|i| 0.1 + 0.01 * f64::from(i % 90)).collect();
    let on = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(threads)
            .build()
            .unwrap();
        pool.install(|| mapper.fill(Method::Overlap, &positions, &radii).unwrap())
    };
    assert_eq!(on(1), on(4));
}

proptest! {
    #[test]
    fn the_shares_of_a_particle_sum_to_one(
        x in 0.0..4.0, y in 0.0..4.0, z in 0.0..4.0, radius in 0.0..3.0, plane in any::<bool>(),
    ) {
        let mesh = if plane { unit_cells([4, 4, 4]) } else { warped() };
        let mapper = Mapper::new(&mesh);
        for method in [Method::Centroid, Method::Divided, Method::Overlap] {
            let cells = weights_at(&mapper, method, Vec3::new(x, y, z), radius);
            let total: f64 = cells.iter().sum();
            prop_assert!((total - 1.0).abs() < 1e-14, "{method:?}: {total}");
            prop_assert!(cells.iter().all(|&share| share >= 0.0));
        }
    }

    #[test]
    fn every_position_in_a_warped_mesh_is_found(
        x in 0.0..4.0, y in 0.0..4.0, z in 0.0..4.0,
    ) {
        let mesh = warped();
        prop_assert!(Locator::new(&mesh).cell_at(Vec3::new(x, y, z)).is_some());
    }
}
