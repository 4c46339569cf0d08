//! The pressure in windows in which the gas moves by a small part of a cell.
#![allow(clippy::unwrap_used)]

use calcine_coupler::part::Gas as _;
use calcine_coupler::physics::Vec3;
use calcine_coupler::setup::{Schedule, TimeScheme, WallHeat};

use crate::common::{Driver, inlet, named_box, outlet, setup, wall};

const CELLS: [usize; 3] = [10, 6, 6];

/// Pressure of the first cells over that of the last in Pa, in the last of a hundred windows of so many seconds, in a duct of air into
/// which 1 m/s flow, at an outer tolerance.
fn drop(window: f64, tolerance: f64, scheme: TimeScheme, heat: WallHeat) -> f64 {
    let patches = ["in", "out", "wall", "wall", "wall", "wall"];
    let mesh = named_box([0.1, 0.06, 0.06], CELLS, patches);
    let mut setup = setup(&[
        ("in", inlet(1.0, 300.0)),
        ("out", outlet()),
        ("wall", wall(heat)),
    ]);
    setup.velocity = Vec3::new(1.0, 0.0, 0.0);
    setup.controls.outer_tolerance = tolerance;
    setup.controls.linear_tolerance = None;
    setup.controls.time_scheme = scheme;
    let mut duct = Driver::new(&mesh, &setup);
    for _ in 0..100 {
        assert!(duct.window(window, 1.0).converged);
    }
    let pressure = duct.gas.fields().pressure;
    let mean = |layer: usize| {
        let cells = (0..pressure.len()).filter(|cell| cell % CELLS[0] == layer);
        cells.map(|cell| pressure[cell]).sum::<f64>() / (CELLS[1] * CELLS[2]) as f64
    };
    mean(0) - mean(CELLS[0] - 1)
}

/// At Courant numbers of 2e-1 to 2e-4, in one stage and in two, beside walls as warm as the gas and warmer. What the pressure equation
/// leaves of continuity would drive pressures of its own.
#[test]
fn the_pressure_does_not_depend_on_what_solvers_leave_in_short_windows() {
    let warm = || WallHeat::Temperature(Schedule::constant(350.0));
    // Of two stages what is left is held to a hundredth, which the shortest windows leave to round-off.
    let schemes = [
        (
            TimeScheme::ImplicitEuler,
            &[2e-3, 2e-4, 2e-5, 2e-6][..],
            1e-11,
        ),
        (TimeScheme::Sdirk2, &[2e-3, 2e-4, 2e-5], 1e-9),
    ];
    for (scheme, windows, least) in schemes {
        for (name, heat) in [("adiabatic", WallHeat::Adiabatic), ("warm", warm())] {
            for &window in windows {
                let close = drop(window, least, scheme, heat.clone());
                for tolerance in [1e-6, 1e-8] {
                    let found = drop(window, tolerance, scheme, heat.clone());
                    // In units of the dynamic pressure, ρ u² = 1.18 Pa.
                    let off = (found - close) / 1.18;
                    assert!(
                        off.abs() < 1e-3,
                        "{scheme:?}, {name}, {window} s, {tolerance}: {found} Pa, not {close} Pa"
                    );
                }
            }
        }
    }
}
