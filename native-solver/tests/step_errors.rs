//! The estimated error of a window's step against the true one.
#![allow(clippy::unwrap_used, clippy::print_stdout)]

use std::f64::consts::PI;

use calcine_coupler::part::Gas as _;
use calcine_coupler::physics::Vec3;
use calcine_coupler::setup::{Convection, GasStart, TimeScheme};
use calcine_coupler::step_error::{StepHistory, StepOrder, StepSpans};

use crate::common::{Driver, fluid, named_box, orders, rms, setup, slip};

const CELLS: usize = 12;
const END: f64 = 0.4;
/// A vortex that decays as e^(−λt), λ = 2 π² ν in s⁻¹, in a fluid that cools as e^(−kt).
const VISCOSITY: f64 = 0.05;
const DECAY: f64 = 2.0 * PI * PI * VISCOSITY;
const COOLING: f64 = 3.0;

struct Outcome {
    /// Estimated errors of the last step, of velocity in m/s and of temperature in K.
    estimated: [f64; 2],
    /// Root mean square of the velocity in m/s before the last step and after it.
    speeds: [f64; 2],
}

fn run(scheme: TimeScheme, windows: usize) -> Outcome {
    let mesh = named_box([1.0, 1.0, 0.1], [CELLS, CELLS, 1], ["side"; 6]);
    let mut setup = setup(&[("side", slip())]);
    setup.controls.time_scheme = scheme;
    setup.controls.convection = Convection::Central(1.0);
    setup.controls.outer_tolerance = 1e-12;
    setup.controls.linear_tolerance = Some(1e-14);
    setup.properties = fluid(1.0, 1000.0, VISCOSITY, 1.0);
    let mut driver = Driver::new(&mesh, &setup);
    driver.gas.start_from(&GasStart {
        temperature: vec![400.0; mesh.cells()],
        velocity: mesh
            .cell_centre()
            .iter()
            .map(|at| {
                let (x, y) = (PI * at.x, PI * at.y);
                Vec3::new(x.sin() * y.cos(), -x.cos() * y.sin(), 0.0)
            })
            .collect(),
        pressure: vec![101_325.0; mesh.cells()],
        ..GasStart::default()
    });
    for (cell, volume) in mesh.cell_volume().iter().enumerate() {
        driver.exchange.heat_coefficient[cell] = 1000.0 * COOLING * volume;
        driver.exchange.heat_source[cell] = 1000.0 * COOLING * 300.0 * volume;
    }
    let order = match scheme {
        TimeScheme::ImplicitEuler => StepOrder::First,
        TimeScheme::Sdirk2 => StepOrder::Second,
    };
    let span = END / windows as f64;
    let spans = StepSpans {
        motion: span,
        storage: span,
    };
    let volume = mesh.cell_volume();
    let mut history = StepHistory::begin(&driver.gas.fields());
    let mut outcome = Outcome {
        estimated: [0.0; 2],
        speeds: [0.0; 2],
    };
    // Velocity errors are shares of the largest speed, which is that after the first window.
    let mut largest = 0.0_f64;
    for _ in 0..windows {
        driver.window(span, 1.0);
        let fields = driver.gas.fields();
        let speed = rms(&mesh, |cell| fields.velocity[cell].norm());
        largest = largest.max(speed);
        if let Some(error) = history.estimate(&fields, volume, spans, order) {
            outcome.estimated = [
                error.velocity * largest,
                error.temperature * fields.temperature[0],
            ];
        }
        history.commit(&fields, volume, spans);
        outcome.speeds = [outcome.speeds[1], speed];
    }
    outcome
}

/// R(z) − e^z of a scheme.
fn error_of_step(scheme: TimeScheme, z: f64) -> f64 {
    let gamma = 1.0 - std::f64::consts::FRAC_1_SQRT_2;
    let made = match scheme {
        TimeScheme::ImplicitEuler => 1.0 / (1.0 - z),
        TimeScheme::Sdirk2 => (1.0 + (1.0 - 2.0 * gamma) * z) / (1.0 - gamma * z).powi(2),
    };
    (made - z.exp()).abs()
}

/// Vortex and temperature decay exponentially, the vortex at the pace that the mesh gives it: the error of a step is that of the scheme's
/// stability function. A start that is not quite the mesh's own vortex adjusts in 0.1 s.
#[test]
fn the_estimated_error_of_a_step_is_the_true_one_with_its_order() {
    let reference = run(TimeScheme::Sdirk2, 512);
    let decay = (reference.speeds[0] / reference.speeds[1]).ln() * 512.0 / END;
    assert!((decay / DECAY - 1.0).abs() < 0.03, "{decay}");
    for (scheme, power) in [(TimeScheme::ImplicitEuler, 2.0), (TimeScheme::Sdirk2, 3.0)] {
        let counts = [16, 32, 64];
        let runs = counts.map(|windows| run(scheme, windows));
        for (field, rate) in [decay, COOLING].into_iter().enumerate() {
            let estimated = runs.each_ref().map(|run| run.estimated[field]);
            let factors = [0, 1, 2].map(|k| {
                let span = END / counts[k] as f64;
                let before = match field {
                    0 => runs[k].speeds[0],
                    _ => 100.0 * (-COOLING * (END - span)).exp(),
                };
                estimated[k] / (before * error_of_step(scheme, -rate * span))
            });
            let found = orders(&estimated);
            println!(
                "{scheme:?} {field}: {estimated:?}, factors {factors:.3?}, orders {found:.3?}"
            );
            assert!((factors[2] - 1.0).abs() < 0.05, "{factors:?}");
            assert!(found.iter().all(|it| (it - power).abs() < 0.2), "{found:?}");
        }
    }
}
