//! Walls that turn, and walls of a temperature along an axis, against exact solutions.
#![allow(clippy::unwrap_used, clippy::print_stdout)]

use std::sync::Arc;

use calcine_coupler::conformance::annulus::{annulus, off_couette, turning, turning_ring};
use calcine_coupler::mesh::cylinder::{CylinderSpec, cylinder_mesh};
use calcine_coupler::mesh::grading::uniform;
use calcine_coupler::part::Gas;
use calcine_coupler::physics::Vec3;
use calcine_coupler::setup::{AxialTemperature, Schedule, WallHeat};
use calcine_native::gas::NativeGas;

use crate::common::{Driver, closure, duct, fluid, orders, rms, setup, slip, slip_wall};

#[test]
fn gas_between_turning_cylinders_is_circular_couette_flow_to_order_two() {
    let (radii, rates) = ([0.02, 0.05], [3.0, -1.0]);
    let mut errors = Vec::new();
    for across in [4, 8, 16] {
        let mesh = Arc::new(annulus(radii, 0.01, [across, 6 * across]).unwrap());
        let mut setup = setup(&turning_ring(rates));
        setup.properties = fluid(1.0, 1000.0, 0.1, 0.03);
        let mut driver = Driver::new(&mesh, &setup);
        for _ in 0..20 {
            driver.window(10.0, 1.0);
        }
        let fields = driver.gas.fields();
        errors.push(rms(&mesh, |cell| {
            let place = mesh.cell_centre()[cell];
            off_couette(radii, rates, place, fields.velocity[cell])
        }));
        for momentum in &driver.received.momentum {
            assert!(closure(momentum) < 1e-8, "{momentum:?}");
        }
    }
    let orders = orders(&errors);
    println!("errors {errors:?} m/s, orders {orders:?}");
    assert!(orders.iter().all(|order| *order > 1.8), "{orders:?}");
    // Of walls at 0.06 and 0.05 m/s.
    assert!(errors[2] < 3e-4, "{errors:?}");
}

/// Gas that turns as one with the drum and its ends.
#[test]
fn gas_in_a_turning_drum_comes_to_turn_with_it() {
    let mut errors = Vec::new();
    for across in [6, 12, 24] {
        let mesh = cylinder_mesh(&CylinderSpec {
            origin: Vec3::zeros(),
            diameter: 0.1,
            length: 0.05,
            cells_across: across,
            along: uniform(across / 3),
            patches: ["side", "bottom", "top"].map(str::to_owned),
        });
        let mesh = Arc::new(mesh.unwrap());
        let names = ["side", "bottom", "top"];
        let mut setup = setup(&names.map(|name| (name, turning(2.0))));
        setup.properties = fluid(1.0, 1000.0, 0.1, 0.03);
        let mut driver = Driver::new(&mesh, &setup);
        for _ in 0..20 {
            driver.window(10.0, 1.0);
        }
        let fields = driver.gas.fields();
        errors.push(rms(&mesh, |cell| {
            let place = mesh.cell_centre()[cell];
            let exact = 2.0 * Vec3::new(-place.y, place.x, 0.0);
            (fields.velocity[cell] - exact).norm()
        }));
    }
    println!("errors {errors:?} m/s of 0.1");
    // The profile is linear in place, which differences have exactly but where the lines of the mesh bend.
    assert!(errors[0] < 1e-4, "{errors:?}");
    assert!(
        errors.windows(2).all(|pair| pair[1] < 0.7 * pair[0]),
        "{errors:?}"
    );
}

#[test]
fn a_wall_that_would_sweep_through_the_gas_is_refused() {
    let mesh = duct([0.02, 0.02, 0.04], [2, 2, 2]);
    let setup = setup(&[("side", turning(1.0)), ("bottom", slip()), ("top", slip())]);
    let error = NativeGas::new(mesh, &setup).unwrap_err().to_string();
    assert!(error.contains("a wall turns within itself"), "{error}");
}

/// Conduction in a fluid at rest between walls whose temperature is linear: so is its own. What the walls come to later it comes to
/// as well.
#[test]
fn a_wall_temperature_along_an_axis_holds_face_by_face_and_over_time() {
    let mesh = duct([0.02, 0.02, 0.04], [3, 3, 8]);
    let over = |first: f64, last: f64| Schedule(vec![(100.0, first), (110.0, last)]);
    let along = WallHeat::Along(AxialTemperature {
        axis: Vec3::z(),
        stations: vec![(0.0, over(300.0, 350.0)), (0.04, over(340.0, 450.0))],
    });
    let ends = |first: f64, last: f64| slip_wall(WallHeat::Temperature(over(first, last)));
    let mut setup = setup(&[
        ("side", slip_wall(along)),
        ("bottom", ends(300.0, 350.0)),
        ("top", ends(340.0, 450.0)),
    ]);
    setup.properties = fluid(1.0, 1000.0, 0.1, 10.0);
    let mut driver = Driver::new(&mesh, &setup);
    for (windows, first, slope) in [(10, 300.0, 1000.0), (20, 350.0, 2500.0)] {
        for _ in 0..windows {
            driver.window(10.0, 1.0);
        }
        let fields = driver.gas.fields();
        for (centre, temperature) in mesh.cell_centre().iter().zip(fields.temperature) {
            let expected = first + slope * centre.z;
            assert!(
                (temperature - expected).abs() < 1e-6,
                "{temperature} {expected}"
            );
        }
    }
}
