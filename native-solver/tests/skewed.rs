//! The gas on cells that are sheared by up to 70 degrees.
#![allow(clippy::unwrap_used)]

use std::sync::Arc;

use calcine_coupler::mesh::Mesh;
use calcine_coupler::part::Gas;
use calcine_coupler::physics::Vec3;

use crate::common::*;

/// A duct of 60 × 10 × 100 mm whose layers are displaced, so that its upright edges lean by an angle in degrees.
fn leaning(degrees: f64) -> Arc<Mesh> {
    lean(&duct([0.06, 0.01, 0.1], [12, 2, 20]), degrees)
}

/// A mesh whose layers are displaced, so that its upright edges lean by an angle in degrees.
fn lean(mesh: &Mesh, degrees: f64) -> Arc<Mesh> {
    let mut topology = mesh.topology().clone();
    for point in &mut topology.points {
        point.x += point.z * degrees.to_radians().tan();
    }
    Arc::new(Mesh::new(topology).unwrap())
}

/// Air of 1 m/s through an empty duct: lean in degrees, window in s (Courant numbers 1, 5 and 20), and the fastest cell in m/s after
/// 0.2 s. `adapters/tests/openfoam_flow.rs` has them within 1e-5.
const FASTEST: [(f64, f64, f64); 8] = [
    (0.0, 5e-3, 1.0),
    (30.0, 5e-3, 1.980_061_7),
    (35.0, 5e-3, 2.207_245_5),
    (45.0, 5e-3, 2.773_055_0),
    (55.0, 5e-3, 3.588_852_1),
    (65.0, 5e-3, 4.930_512_1),
    (65.0, 25e-3, 4.927_978_8),
    (65.0, 0.1, 4.891_448_8),
];

#[test]
fn air_passes_a_duct_that_leans_by_up_to_65_degrees() {
    for (degrees, span, expected) in FASTEST {
        let mut setup = setup(&[
            ("side", slip()),
            ("bottom", inlet(1.0, 300.0)),
            ("top", outlet()),
        ]);
        setup.controls.outer_iterations = 100;
        setup.controls.outer_tolerance = 1e-8;
        let mut driver = Driver::new(&leaning(degrees), &setup);
        for window in 0..(0.2 / span).round() as usize {
            let done = driver.window(span, 1.0);
            assert!(
                done.converged,
                "{degrees} degrees, window {window}: {done:?}"
            );
        }
        let speeds = driver.gas.fields().velocity.iter().map(|u| u.norm());
        let fastest = speeds.fold(0.0, f64::max);
        assert!(
            (fastest / expected - 1.0).abs() < 1e-6,
            "{degrees} degrees: {fastest}"
        );
    }
}

/// Darcy's flow along a leaning bed: what comes in across the floor runs along the sides, pulled by a force across, so that pressure
/// falls with the height alone and the open lid has one.
#[test]
fn flow_along_a_leaning_bed_is_uniform_at_any_angle() {
    // So much drag that what the gas brings in of the floor's velocity is 1e-8 of it.
    let (w, density, drag, pores) = (0.01, 1000.0, 1e11, 0.4);
    for degrees in [30.0_f64, 45.0, 60.0, 70.0] {
        let mesh = leaning(degrees);
        let mut setup = setup(&[
            ("side", slip()),
            ("bottom", inlet(w, 300.0)),
            ("top", outlet()),
        ]);
        let exact = Vec3::new(w * degrees.to_radians().tan(), 0.0, w) / pores;
        setup.properties = fluid(density, 4000.0, 1e-9, 1e-9);
        setup.gravity = Vec3::new(drag * exact.x / (pores * density), 0.0, 0.0);
        setup.controls.outer_iterations = 300;
        let mut driver = Driver::new(&mesh, &setup);
        driver.bed.void_fraction.fill(pores);
        let volumes = mesh.cell_volume();
        for (coefficient, volume) in driver.exchange.drag_coefficient.iter_mut().zip(volumes) {
            *coefficient = drag * volume;
        }
        for window in 0..3 {
            let done = driver.window(1.0, 1.0);
            assert!(
                done.converged,
                "{degrees} degrees, window {window}: {done:?}"
            );
        }
        let fields = driver.gas.fields();
        let slope = Vec3::new(0.0, 0.0, -drag * exact.z / pores);
        let off = |cell: usize| {
            let velocity = (fields.velocity[cell] - exact).norm() / exact.norm();
            velocity.max((fields.pressure_gradient[cell] - slope).norm() / slope.norm())
        };
        let worst = (0..mesh.cells()).map(off).fold(0.0, f64::max);
        assert!(worst < 1e-6, "{degrees} degrees: {worst}");
    }
}

/// A plane duct of 16 cells across in which viscosity rules: ν Δt/Δx² = 43, a Reynolds number of 1. Lean in degrees, and the fastest
/// cell in m/s after three windows, by eight of the pressure corrections without anything held of the friction at walls.
const VISCOUS: [(f64, f64); 3] = [(0.0, 1.489_036_1), (45.0, 2.110_519_2), (60.0, 2.992_518_1)];

/// The duct, and its window in s.
fn viscous(degrees: f64, outer_iterations: u32) -> (Driver, f64) {
    let patches = ["wall", "wall", "slip", "slip", "bottom", "top"];
    let mesh = named_box([1.0, 0.0625, 2.0], [16, 1, 16], patches);
    let mut setup = setup(&[
        ("wall", no_slip()),
        ("slip", slip()),
        ("bottom", inlet(1.0, 300.0)),
        ("top", outlet()),
    ]);
    setup.properties = fluid(1.0, 1000.0, 1.0, 1.0);
    setup.controls.outer_iterations = outer_iterations;
    setup.controls.outer_tolerance = 1e-8;
    (Driver::new(&lean(&mesh, degrees), &setup), 0.168)
}

#[test]
fn viscosity_of_many_cells_a_window_changes_no_result() {
    for (degrees, expected) in VISCOUS {
        let (mut driver, span) = viscous(degrees, 100);
        for window in 0..3 {
            let done = driver.window(span, 1.0);
            assert!(
                done.converged,
                "{degrees} degrees, window {window}: {done:?}"
            );
        }
        let speeds = driver.gas.fields().velocity.iter().map(|u| u.norm());
        let fastest = speeds.fold(0.0, f64::max);
        assert!(
            (fastest / expected - 1.0).abs() < 1e-6,
            "{degrees} degrees: {fastest}"
        );
    }
}

#[test]
fn viscosity_of_many_cells_a_window_runs_by_the_default_controls() {
    for (degrees, _) in VISCOUS {
        let (mut driver, span) = viscous(degrees, 20);
        let done = (0..8).map(|_| driver.window(span, 1.0)).last().unwrap();
        assert!(done.converged, "{degrees} degrees: {done:?}");
    }
}

/// Air in a closed box, at rest at first, with its upper wall at 400 K and its lower one at 300 K, whose side walls lean.
fn hot_above(degrees: f64) -> Driver {
    let patches = ["side", "side", "slip", "slip", "floor", "lid"];
    let mesh = named_box([0.1, 0.0125, 0.1], [8, 1, 8], patches);
    let mut setup = setup(&[
        ("side", no_slip()),
        ("slip", slip()),
        ("floor", warm_wall(300.0)),
        ("lid", warm_wall(400.0)),
    ]);
    setup.gravity = Vec3::new(0.0, 0.0, -9.81);
    setup.controls.outer_iterations = 20;
    setup.controls.outer_tolerance = 1e-8;
    Driver::new(&lean(&mesh, degrees), &setup)
}

#[test]
fn hot_air_over_cold_creeps_in_windows_of_a_tenth_of_a_second() {
    for degrees in [0.0, 45.0, 55.0, 65.0, 70.0] {
        let mut driver = hot_above(degrees);
        let done: Vec<_> = (0..100).map(|_| driver.window(0.1, 1.0)).collect();
        let open = done.iter().filter(|done| !done.converged).count();
        let speeds = driver.gas.fields().velocity.iter().map(|u| u.norm());
        let fastest = speeds.fold(0.0, f64::max);
        assert!(
            open <= 20 && done[99].converged,
            "{degrees} degrees: {open} windows open, {:?}",
            done[99]
        );
        // Isotherms that meet adiabatic walls at right angles are not level where walls lean: air creeps along them.
        assert!(fastest < 0.02, "{degrees} degrees: {fastest} m/s");
    }
}
