//! Decay of a Taylor–Green vortex in a square of walls without friction at Re 100: an exact solution of the Navier-Stokes
//! equations, in which convection and pressure balance and friction lets the velocity decay (G. I. Taylor and A. E. Green,
//! Proc. R. Soc. A 158 (1937) 499, doi 10.1098/rspa.1937.0036, in its plane form).

use std::f64::consts::PI;

use super::case::{ErrorCase, ErrorQuantity, Reference, at};
use super::start::{Here, Start};

/// Edge of the square in m.
const EDGE: f64 = 0.1;
/// Kinematic viscosity in m²/s; density (1 kg/m³) and largest speed (1 m/s) are one.
const VISCOSITY: f64 = 1e-3;
/// End in s, half of the time in which the velocity falls to 1/e.
const END: f64 = 0.25;

pub const CASE: ErrorCase = ErrorCase {
    name: "taylor-green",
    stock: "icoFoam",
    coarsest: [32, 32],
    end: END,
    quantities: &[ErrorQuantity {
        name: "velocity",
        calcine: "velocity",
        openfoam: "U",
        level: 0.0,
    }],
    runs: &[at(1, 5.0), at(1, 2.5), at(2, 5.0), at(2, 2.5), at(3, 2.5)],
    large: &[
        at(1, 10.0),
        at(1, 5.0),
        at(1, 2.5),
        at(2, 5.0),
        at(2, 2.5),
        at(2, 1.25),
        at(4, 1.25),
        at(4, 0.625),
        at(8, 0.3125),
        at(32, 0.3125),
    ],
    reference: Reference::Exact(decayed, EDGE),
    start: Some(Start {
        edge: EDGE,
        depth: 0.01,
        at: vortex,
    }),
};

/// The velocity at the end.
fn decayed(x: f64, y: f64) -> Vec<f64> {
    let [u, v] = vortex(x, y).velocity;
    let decay = (-2.0 * VISCOSITY * (PI / EDGE).powi(2) * END).exp();
    vec![decay * u, decay * v, 0.0]
}

/// The vortex at its start.
fn vortex(x: f64, y: f64) -> Here {
    let wave = PI / EDGE;
    let ((sx, cx), (sy, cy)) = ((wave * x).sin_cos(), (wave * y).sin_cos());
    Here {
        velocity: [sx * cy, -cx * sy],
        stream: sx * sy / wave,
        pressure: 0.25 * ((2.0 * wave * x).cos() + (2.0 * wave * y).cos()),
        pressure_gradient: [
            -0.5 * wave * (2.0 * wave * x).sin(),
            -0.5 * wave * (2.0 * wave * y).sin(),
        ],
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_vortex_is_that_of_its_stream_function_and_its_pressure_balances_convection() {
        let (x, y, step) = (0.013, 0.057, 1e-6);
        let slope = |value: &dyn Fn(f64, f64) -> f64| {
            [
                (value(x + step, y) - value(x - step, y)) / (2.0 * step),
                (value(x, y + step) - value(x, y - step)) / (2.0 * step),
            ]
        };
        let near = |one: f64, other: f64| assert!((one - other).abs() < 1e-6, "{one} {other}");
        let here = vortex(x, y);
        let [u, v] = here.velocity;
        let stream = slope(&|x, y| vortex(x, y).stream);
        near(stream[1], u);
        near(-stream[0], v);
        let pressure = slope(&|x, y| vortex(x, y).pressure);
        for (axis, gradient) in here.pressure_gradient.into_iter().enumerate() {
            near(pressure[axis], gradient);
            let velocity = slope(&|x, y| vortex(x, y).velocity[axis]);
            near(u * velocity[0] + v * velocity[1], -gradient);
        }
    }
}
