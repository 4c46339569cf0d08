//! The gas in boxes of many cells: rest, friction at walls, conduction, threads.
#![allow(clippy::unwrap_used, clippy::needless_range_loop)]

use std::sync::Arc;

use calcine_coupler::mesh::Mesh;
use calcine_coupler::part::Gas;
use calcine_coupler::physics::Vec3;

use crate::common::*;

/// A box whose points are moved, so that no face is normal to the line between its centres.
fn sheared(mesh: &Mesh) -> Arc<Mesh> {
    let mut topology = mesh.topology().clone();
    for point in &mut topology.points {
        point.x += 0.3 * point.y + 0.2 * point.z;
    }
    Arc::new(Mesh::new(topology).unwrap())
}

fn still(mesh: &Arc<Mesh>) -> f64 {
    let mut setup = setup(&[("top", outlet()), ("bottom", no_slip()), ("side", slip())]);
    setup.gravity = Vec3::new(0.0, 0.0, -9.81);
    // Corrections for faces that lean or are warped are as exact as the outer loop.
    setup.controls.outer_tolerance = 1e-12;
    let mut driver = Driver::new(mesh, &setup);
    for (cell, share) in scatter(mesh.cells(), 7).into_iter().enumerate() {
        driver.bed.void_fraction[cell] = 0.3 + 0.7 * share;
        driver.exchange.drag_coefficient[cell] = 1e-5 * (1.0 - share);
    }
    for _ in 0..100 {
        driver.window(1e-3, 1.0);
    }
    let fields = driver.gas.fields();
    let density = AIR.density(ATMOSPHERE, 300.0);
    for cell in 0..mesh.cells() {
        let depth = 0.06 - mesh.cell_centre()[cell].z;
        let exact = ATMOSPHERE + density * 9.81 * depth;
        assert!((fields.pressure[cell] - exact).abs() < 1e-9, "hydrostatic");
    }
    let speeds = fields.velocity.iter().map(|u| u.norm());
    speeds.fold(0.0, f64::max)
}

#[test]
fn still_gas_stays_still_in_a_bed_of_random_void_fraction_under_gravity() {
    let speed = still(&duct([0.05, 0.04, 0.06], [5, 4, 6]));
    assert!(speed < 1e-10, "{speed} m/s");
}

#[test]
fn still_gas_stays_still_on_a_sheared_mesh_too() {
    let speed = still(&sheared(&duct([0.05, 0.04, 0.06], [5, 4, 6])));
    assert!(speed < 1e-10, "{speed} m/s");
}

#[test]
fn still_gas_stays_still_where_faces_are_warped() {
    // Points inside are displaced by up to 15 % of a cell.
    let mesh = duct([0.05, 0.04, 0.06], [5, 4, 6]);
    let mut topology = mesh.topology().clone();
    for (number, point) in topology.points.iter_mut().enumerate() {
        let inside = |x: f64, end: f64| x > 1e-9 && x < end - 1e-9;
        if inside(point.x, 0.05) && inside(point.y, 0.04) && inside(point.z, 0.06) {
            let phase = number as f64;
            let way = Vec3::new(phase.sin(), (1.7 * phase).cos(), (2.3 * phase).sin());
            *point += 0.0015 * way;
        }
    }
    let speed = still(&Arc::new(Mesh::new(topology).unwrap()));
    assert!(speed < 1e-10, "{speed} m/s");
}

/// −dp/dz of developed flow between plates 10 mm apart, at a superficial velocity of 1 mm/s and a
/// void fraction of 0.8 that does no drag.
fn plate_gradient(across: usize) -> f64 {
    let patches = ["side", "side", "plate", "plate", "bottom", "top"];
    let mesh = named_box([0.01, 0.01, 0.08], [1, across, 32], patches);
    let setup = setup(&[
        ("side", slip()),
        ("plate", no_slip()),
        ("bottom", inlet(0.001, 300.0)),
        ("top", outlet()),
    ]);
    let mut driver = Driver::new(&mesh, &setup);
    driver.bed.void_fraction.fill(0.8);
    for _ in 0..300 {
        driver.window(0.05, 1.0);
    }
    let cell = 28 * across + across / 2;
    -driver.gas.fields().pressure_gradient[cell].z
}

#[test]
fn flow_between_plates_loses_pressure_as_poiseuille_found_with_second_order() {
    let exact = 12.0 * AIR.viscosity(300.0) * (0.001 / 0.8) / 0.01f64.powi(2);
    let errors = [4, 8, 16].map(|across| (plate_gradient(across) / exact - 1.0).abs());
    for pair in errors.windows(2) {
        let order = (pair[0] / pair[1]).log2();
        assert!(
            (order - 2.0).abs() < 0.15,
            "order {order}, errors {errors:?}"
        );
    }
    assert!(errors[2] < 0.01);
}

/// Largest error in K of the steady temperature between walls of 300 and 600 K, and the relative
/// error of the heat that flows.
fn conduction_errors(cells: usize) -> [f64; 2] {
    let patches = ["cold", "hot", "side", "side", "bottom", "top"];
    let mesh = named_box([0.1, 0.01, 0.01], [cells, 1, 1], patches);
    let setup = setup(&[
        ("cold", warm_wall(300.0)),
        ("hot", warm_wall(600.0)),
        ("side", slip()),
        ("bottom", slip()),
        ("top", outlet()),
    ]);
    let mut driver = Driver::new(&mesh, &setup);
    // What little the gas still moves after its expansion is stopped by drag.
    driver.exchange.drag_coefficient.fill(1.0);
    driver.bed.void_fraction.fill(0.7);
    for _ in 0..40 {
        driver.window(1e-3, 1e5);
    }
    // κ depends on T: the integral of κ over T is linear in x (Kirchhoff). Midpoint rule.
    let integral = |to: f64| {
        let steps = 2000;
        let width = (to - 300.0) / f64::from(steps);
        (0..steps)
            .map(|i| AIR.conductivity(300.0 + (f64::from(i) + 0.5) * width) * width)
            .sum::<f64>()
    };
    let whole = integral(600.0);
    let temperature = driver.gas.fields().temperature;
    let mut worst = 0.0f64;
    for cell in 0..cells {
        let share = mesh.cell_centre()[cell].x / 0.1;
        let slope = AIR.conductivity(temperature[cell]);
        worst = worst.max((integral(temperature[cell]) - share * whole).abs() / slope);
    }
    // In at one wall and out at the other, over a window of 100 s.
    let heat = driver.received.energy.boundary_magnitude / 2.0 / 100.0;
    let exact = 0.7 * whole / 0.1 * 1e-4;
    [worst, (heat / exact - 1.0).abs()]
}

#[test]
fn conduction_between_walls_converges_to_the_exact_profile_with_second_order() {
    let errors = [5, 10, 20].map(conduction_errors);
    for pair in errors.windows(2) {
        let order = (pair[0][0] / pair[1][0]).log2();
        assert!(
            (order - 2.0).abs() < 0.2,
            "order {order}, errors {errors:?}"
        );
    }
    assert!(errors[2][1] < 2e-3, "errors {errors:?}");
}

#[test]
fn the_gas_has_the_same_bits_on_one_and_on_three_threads() {
    let run = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
        pool.unwrap().install(|| {
            let mesh = duct([0.1, 0.1, 0.1], [18, 18, 18]);
            let mut setup = setup(&[
                ("bottom", inlet(0.3, 400.0)),
                ("top", outlet()),
                ("side", no_slip()),
            ]);
            setup.controls.outer_iterations = 2;
            let mut driver = Driver::new(&mesh, &setup);
            let scatter = scatter(mesh.cells(), 3);
            for (cell, share) in scatter.into_iter().enumerate() {
                driver.bed.void_fraction[cell] = 0.4 + 0.6 * share;
                driver.exchange.drag_coefficient[cell] = 1e-5 * (1.0 - share);
            }
            driver.window(1e-3, 1.0);
            driver.window(1e-3, 1.0);
            driver.bits()
        })
    };
    assert_eq!(run(1), run(3));
}
