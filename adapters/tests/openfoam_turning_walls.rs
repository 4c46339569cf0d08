//! calcineGasFoam beside walls that turn, and walls of a temperature along an axis, against exact solutions.
#![allow(clippy::unwrap_used, clippy::print_stdout)]

use calcine_coupler::conformance::annulus::{annulus, off_couette, turning_ring};
use calcine_coupler::part::Gas;
use calcine_coupler::physics::Vec3;
use calcine_coupler::setup::{AxialTemperature, GasPatch, Schedule, WallHeat, WallVelocity};

use crate::openfoam_periodic::{Run, at_rest, fluid, orders, rms};
use crate::openfoam_support::mesh;

#[test]
fn gas_between_turning_cylinders_is_circular_couette_flow_to_order_two_on_one_rank_and_on_two() {
    let (radii, rates) = ([0.02, 0.05], [3.0, -1.0]);
    let setup = |rates: [f64; 2]| {
        let mut setup = at_rest(&turning_ring(rates));
        setup.properties = fluid(0.1);
        setup
    };
    for ranks in [1, 2] {
        let mut errors = Vec::new();
        for across in [4, 8, 16] {
            let mesh = annulus(radii, 0.01, [across, 6 * across]).unwrap();
            let mut run = Run::new(&mesh, &setup(rates), None, ranks);
            run.windows(20, 10.0);
            let fields = run.gas.fields();
            errors.push(rms(&mesh, |cell| {
                let place = mesh.cell_centre()[cell];
                off_couette(radii, rates, place, fields.velocity[cell])
            }));
        }
        let orders = orders(&errors);
        println!("{ranks} ranks: errors {errors:?} m/s, orders {orders:?}");
        assert!(orders.iter().all(|order| *order > 1.8), "{orders:?}");
        assert!(errors[2] < 3e-4, "{errors:?}");
    }
}

/// Conduction in a fluid at rest between walls whose temperature is linear: so is its own.
#[test]
fn a_wall_temperature_along_an_axis_holds_face_by_face_and_over_time() {
    let mesh = mesh([3, 3, 8]);
    let length = 0.12;
    let over = |first: f64, last: f64| Schedule(vec![(100.0, first), (110.0, last)]);
    let wall = |heat: WallHeat| GasPatch::Wall {
        velocity: WallVelocity::Slip,
        heat,
    };
    let along = WallHeat::Along(AxialTemperature {
        axis: Vec3::z(),
        stations: vec![(0.0, over(300.0, 350.0)), (length, over(340.0, 450.0))],
    });
    let ends = |first: f64, last: f64| wall(WallHeat::Temperature(over(first, last)));
    let mut setup = at_rest(&[
        ("side", wall(along)),
        ("bottom", ends(300.0, 350.0)),
        ("top", ends(340.0, 450.0)),
    ]);
    setup.properties = fluid(0.1);
    for ranks in [1, 2] {
        let mut run = Run::new(&mesh, &setup, None, ranks);
        for (windows, first, last) in [(10, 300.0, 340.0), (20, 350.0, 450.0)] {
            run.windows(windows, 10.0);
            let fields = run.gas.fields();
            for (centre, temperature) in mesh.cell_centre().iter().zip(fields.temperature) {
                let expected = first + (last - first) * centre.z / length;
                assert!(
                    (temperature - expected).abs() < 1e-6,
                    "{temperature} {expected}"
                );
            }
        }
    }
}
