//! The gas on cells that are sheared by up to 70 degrees.
#![allow(clippy::unwrap_used)]

use std::sync::Arc;

use calcine_coupler::mesh::Mesh;
use calcine_coupler::part::Gas;
use calcine_coupler::physics::Vec3;

use crate::common::*;

/// A duct of 60 × 10 × 100 mm whose layers are displaced, so that its upright edges lean by an angle in degrees.
fn leaning(degrees: f64) -> Arc<Mesh> {
    let mut topology = duct([0.06, 0.01, 0.1], [12, 2, 20]).topology().clone();
    for point in &mut topology.points {
        point.x += point.z * degrees.to_radians().tan();
    }
    Arc::new(Mesh::new(topology).unwrap())
}

/// Air of 1 m/s through an empty duct: lean in degrees, window in s (Courant numbers 1 and 5), and the fastest cell in m/s after
/// 0.2 s. `adapters/tests/openfoam_flow.rs` has them within 2e-4.
const FASTEST: [(f64, f64, f64); 7] = [
    (0.0, 5e-3, 1.0),
    (30.0, 5e-3, 1.971_487_5),
    (35.0, 5e-3, 2.194_631_3),
    (45.0, 5e-3, 2.750_781_8),
    (55.0, 5e-3, 3.556_197_3),
    (65.0, 5e-3, 4.881_921_3),
    (65.0, 25e-3, 4.881_098_6),
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
