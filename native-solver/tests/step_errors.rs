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
    velocity: Vec<Vec3>,
    temperature: Vec<f64>,
    /// Errors at the end of velocity in m/s and temperature in K by the estimates of all steps.
    expected: [f64; 2],
}

fn run(scheme: TimeScheme, windows: usize) -> Outcome {
    let mesh = named_box([1.0, 1.0, 0.1], [CELLS, CELLS, 1], ["side"; 6]);
    let mut setup = setup(&[("side", slip())]);
    setup.controls.time_scheme = scheme;
    setup.controls.convection = Convection::Central(1.0);
    setup.controls.outer_tolerance = 1e-12;
    setup.controls.linear_tolerance = 1e-14;
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
    let (mut expected, mut steps) = ([0.0; 2], 0);
    // The largest speed is that after the first window.
    let mut speed = 0.0_f64;
    for window in 1..=windows {
        driver.window(span, 1.0);
        let fields = driver.gas.fields();
        speed = speed.max(rms(&mesh, |cell| fields.velocity[cell].norm()));
        if let Some(error) = history.estimate(&fields, volume, spans, order) {
            // An error decays as the gas does.
            let left = END - span * window as f64;
            expected[0] += error.velocity * speed * (-DECAY * left).exp();
            let kelvin = fields.temperature[0];
            expected[1] += error.temperature * kelvin * (-COOLING * left).exp();
            steps += 1;
        }
        history.commit(&fields, volume, spans);
    }
    let fields = driver.gas.fields();
    Outcome {
        velocity: fields.velocity.to_vec(),
        temperature: fields.temperature.to_vec(),
        expected: expected.map(|sum| sum * windows as f64 / f64::from(steps)),
    }
}

/// The estimates of all steps, each with what is left of it at the end, make up the error at the end: their factor is 1, and the estimate
/// of one step falls with the second and the third power of its span.
#[test]
fn estimated_errors_of_steps_add_up_to_the_error_at_the_end() {
    let mesh = named_box([1.0, 1.0, 0.1], [CELLS, CELLS, 1], ["side"; 6]);
    // What is left of the mesh's error is in both.
    let reference = run(TimeScheme::Sdirk2, 256);
    for (scheme, order) in [(TimeScheme::ImplicitEuler, 1.0), (TimeScheme::Sdirk2, 2.0)] {
        let runs = [16, 32, 64].map(|windows| run(scheme, windows));
        let errors = runs.each_ref().map(|run| {
            let velocity = |cell: usize| (run.velocity[cell] - reference.velocity[cell]).norm();
            let exact = 300.0 + 100.0 * (-COOLING * END).exp();
            [
                rms(&mesh, velocity),
                rms(&mesh, |cell| run.temperature[cell] - exact),
            ]
        });
        for field in 0..2 {
            let of = |list: &[[f64; 2]; 3]| list.map(|one| one[field]);
            let expected = of(&runs.each_ref().map(|run| run.expected));
            let found = orders(&expected);
            let factors = [0, 1, 2].map(|k| expected[k] / errors[k][field]);
            println!(
                "{scheme:?} {field}: true {:?}, estimated {expected:?}, factors {factors:.3?}, orders {found:.3?}",
                of(&errors)
            );
            assert!((factors[2] - 1.0).abs() < 0.1, "{factors:?}");
            assert!((factors[2] - 1.0).abs() < (factors[0] - 1.0).abs() + 0.01);
            assert!(found.iter().all(|it| (it - order).abs() < 0.2), "{found:?}");
        }
    }
}
