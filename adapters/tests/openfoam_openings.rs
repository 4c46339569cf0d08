//! Openings of OpenFOAM's gas to surroundings at rest (docs/theory.md, BND-1). The native ones:
//! `native-solver/tests/openings.rs`.

#![allow(clippy::unwrap_used, clippy::print_stdout)]

use std::path::Path;

use calcine_coupler::part::{Bed, Gas};
use calcine_coupler::physics::Vec3;
use calcine_coupler::physics::gas::GasProperties;
use calcine_coupler::setup::{GasPatch, GasSetup, PatchGas, Schedule};
use calcine_coupler::time::{Clocks, Ticks};

use crate::openfoam_support::{CELLS, Duct, PRESSURE, SIDE, exchange_of_nothing, mesh, setup};

const GRAVITY: f64 = 9.81;
const HEIGHT: f64 = SIDE * CELLS as f64;

/// The duct with openings to air of 300 K at both ends, filled with air of another temperature in K.
fn open(temperature: f64) -> GasSetup {
    let mut open = setup();
    for (name, patch) in &mut open.patches {
        if name != "side" {
            *patch = GasPatch::Opening {
                pressure: Schedule::constant(PRESSURE),
                at: Vec3::zeros(),
                gas: PatchGas {
                    temperature: Schedule::constant(300.0),
                    composition: None,
                },
            };
        }
    }
    open.temperature = temperature;
    open.velocity = Vec3::zeros();
    open.gravity = Vec3::new(0.0, 0.0, -GRAVITY);
    open.controls.outer_tolerance = 1e-9;
    open
}

fn launch(folder: &Path, setup: &GasSetup, span: f64) -> Duct {
    let mut duct = Duct::launch_on(mesh([1, 1, CELLS]), setup, folder);
    let ticks = Ticks::from_seconds(span).unwrap();
    duct.window.span = Clocks {
        motion: ticks,
        process: ticks,
    };
    duct
}

fn empty() -> Bed {
    Bed {
        void_fraction: vec![1.0; CELLS],
    }
}

#[test]
fn a_chimney_of_openfoam_draws_what_its_draught_drives_through_its_resistance() {
    // (ρ_c − ρ_h) g H = ½ ρ_c u_c² + G (u_h − u_c) + k u_h H,   G = ρ_c u_c = ρ_h u_h
    let [cold, hot] = [300.0, 500.0].map(|kelvin| GasProperties::air().density(PRESSURE, kelvin));
    for drag in [0.1, 2.0, 50.0] {
        let folder = tempfile::tempdir().unwrap();
        let mut duct = launch(folder.path(), &open(500.0), 0.05);
        let mut exchange = exchange_of_nothing(CELLS);
        exchange.heat_coefficient.fill(1e6);
        exchange.heat_source.fill(500e6);
        exchange.drag_coefficient.fill(drag * SIDE.powi(3));
        let last = duct.advance(200, &empty(), &exchange);
        assert!(last.converged);
        let square = 0.5 / cold + 1.0 / hot - 1.0 / cold;
        let linear = drag * HEIGHT / hot;
        let push = (cold - hot) * GRAVITY * HEIGHT;
        let exact = ((linear * linear + 4.0 * square * push).sqrt() - linear) / (2.0 * square);
        let fields = duct.gas.fields();
        let found = fields.velocity[CELLS / 2].z * fields.density[CELLS / 2];
        println!("k {drag}: {found} kg/m²/s, closed form {exact}");
        // OpenFOAM's gas constant is 1e-6 above CODATA's.
        assert!((found / exact - 1.0).abs() < 5e-6, "{found} {exact}");
    }
}

/// The duct with outlets at both ends, the upper one of more pressure, after 1 s at 10 Pa s/m over the duct.
fn drawn_in(folder: &Path, backflow: Option<PatchGas>) -> Duct {
    let mut ends = setup();
    for (name, patch) in &mut ends.patches {
        match name.as_str() {
            "bottom" => *patch = GasPatch::outlet(Schedule::constant(PRESSURE)),
            "top" => {
                *patch = GasPatch::Outlet {
                    pressure: Schedule::constant(PRESSURE + 2.0),
                    backflow: backflow.clone(),
                }
            }
            _ => {}
        }
    }
    ends.velocity = Vec3::zeros();
    ends.controls.outer_tolerance = 1e-9;
    let mut duct = launch(folder, &ends, 0.05);
    let mut exchange = exchange_of_nothing(CELLS);
    exchange.drag_coefficient.fill(100.0 * SIDE.powi(3));
    duct.advance(200, &empty(), &exchange);
    duct
}

#[test]
fn gas_that_comes_back_in_through_an_outlet_of_openfoam_is_that_of_its_backflow_or_told() {
    let folder = tempfile::tempdir().unwrap();
    let stated = drawn_in(
        &folder.path().join("stated"),
        Some(PatchGas {
            temperature: Schedule::constant(450.0),
            composition: None,
        }),
    );
    let fields = stated.gas.fields();
    assert!(fields.velocity[5].z < -0.01);
    assert!(fields.temperature.iter().all(|t| (t - 450.0).abs() < 1e-6));
    assert!(stated.gas.backflow().is_none());

    let own = drawn_in(&folder.path().join("own"), None);
    let fields = own.gas.fields();
    assert!(fields.temperature.iter().all(|t| (t - 300.0).abs() < 1e-6));
    let told = own.gas.backflow().unwrap();
    assert_eq!((told.faces, told.cell), (1, CELLS - 1));
    assert!((told.velocity / -fields.velocity[CELLS - 1].z - 1.0).abs() < 1e-6);
}

#[test]
fn still_air_of_openfoam_between_openings_stays_at_rest() {
    let folder = tempfile::tempdir().unwrap();
    let mut duct = launch(folder.path(), &open(300.0), 0.05);
    let mut fastest = 0.0_f64;
    for _ in 0..20 {
        duct.advance(1, &empty(), &exchange_of_nothing(CELLS));
        let speeds = duct.gas.fields().velocity.iter().map(|u| u.norm());
        fastest = speeds.fold(fastest, f64::max);
    }
    println!("fastest {fastest:.1e} m/s");
    assert!(fastest < 1e-10, "{fastest:.1e}");
}
