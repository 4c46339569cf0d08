//! Orders of convergence: in shells and steps, smooth and at fronts, and in windows with a gas that follows.

use calcine_physics::gas::GAS_CONSTANT;
use calcine_physics::sphere;

use super::limits::raw;
use super::support::*;
use super::verification::{
    DILUTE, FRONT, KELVIN, RADIUS, diffusivity, dilute_gas, first_order, front, pellet, wide,
};
use crate::model::{GasLines, NetworkHeat, ParticleModel, Transfer};
use crate::radial::{PoreGas, Radial, RadialNumerics};

/// Order by errors at twice the resolution each.
fn orders(errors: &[f64]) -> Vec<f64> {
    errors
        .windows(2)
        .map(|pair| (pair[0] / pair[1]).log2())
        .collect()
}

#[test]
fn diffusion_with_a_reaction_is_of_second_order_in_shells() {
    // The effectiveness of a sphere at φ = 5: 3 (φ coth φ − 1)/φ².
    let thiele = 5.0_f64;
    let exact = 3.0 * (thiele / thiele.tanh() - 1.0) / (thiele * thiele);
    let k = thiele * thiele * diffusivity() / (RADIUS * RADIUS);
    let off = |shells: usize| {
        let mut model = pellet(first_order(k), Vec::new(), wide(), grid(shells));
        put(&mut model, RADIUS, 2000.0, KELVIN, 1);
        let still = dilute_gas(1e7);
        let mut passed = Vec::new();
        for _ in 0..10 {
            passed = window(&mut model, &still, RADIUS, 1e4);
        }
        let concentration = DILUTE * 1e5 / (GAS_CONSTANT * KELVIN);
        let full = k * concentration * sphere::volume(RADIUS) * 1e4;
        (-passed[0] / full - exact).abs()
    };
    let found = orders(&[10, 20, 40].map(off));
    assert!(found.iter().all(|order| *order > 1.85), "{found:?}");
}

/// Conversion of a solid that takes up heat as it reacts, after a span in so many steps.
fn heated(steps: usize, span: f64) -> f64 {
    let still = Still {
        temperature: 1000.0,
        pressure: 1e5,
        composition: Vec::new(),
        conductance: 50.0 * sphere::surface(RADIUS),
        film: 0.0,
        network: 0.0,
    };
    let solid = porous(&[4000.0; 2], 1.0);
    let numerics = one_step(grid(12));
    let mut model = Radial::new(raw(), &[1.0, 0.0], solid, PoreGas::default(), numerics).unwrap();
    put(&mut model, RADIUS, 2000.0, 800.0, 1);
    for _ in 0..steps {
        window(&mut model, &still, RADIUS, span / steps as f64);
    }
    model.conversion(model.row(0), None)
}

#[test]
fn reactions_are_of_second_order_in_steps_where_they_are_smooth() {
    let exact = heated(2048, 200.0);
    let found = orders(&[32, 64, 128].map(|steps| (heated(steps, 200.0) - exact).abs()));
    assert!((0.2..0.9).contains(&exact), "{exact}");
    assert!(found.iter().all(|order| *order > 1.8), "{found:?}");
}

/// Mean over time of what the conversion by a front that heat limits is off by.
fn front_off(shells: usize) -> f64 {
    let numerics = RadialNumerics {
        temperature: 5.0,
        conversion: 1e-4,
        ..RadialNumerics::new(grid(shells))
    };
    let (mut model, still) = front(1e6, numerics);
    let [density, latent, conductivity, _] = FRONT;
    let whole = density * latent * RADIUS * RADIUS / (6.0 * conductivity * 200.0);
    let windows = 90;
    let mut sum = 0.0;
    for k in 1..=windows {
        window(&mut model, &still, RADIUS, 0.01 * whole);
        // t/τ = 1 − 3 x² + 2 x³ with the front at x (Levenspiel, eq. 25.18).
        let time = 0.01 * f64::from(k);
        let (mut low, mut high) = (0.0_f64, 1.0_f64);
        for _ in 0..60 {
            let x = 0.5 * (low + high);
            if 1.0 - 3.0 * x * x + 2.0 * x * x * x > time {
                low = x;
            } else {
                high = x;
            }
        }
        let exact = 1.0 - low.powi(3);
        sum += (model.conversion(model.row(0), None) - exact).abs();
    }
    sum / f64::from(windows)
}

#[test]
fn fronts_are_of_first_order_in_shells_at_least() {
    let errors = [10, 20, 40].map(front_off);
    let found = orders(&errors);
    assert!(
        found.iter().all(|order| *order > 0.9),
        "{errors:?}: {found:?}"
    );
}

/// Temperature of a gas that a sphere heats, after a span in so many windows: its balance over a window is implicit in what the sphere
/// gives, which is found with the gas held.
fn with_gas(windows: usize) -> f64 {
    let numerics = RadialNumerics {
        temperature: 1e-3,
        ..RadialNumerics::new(grid(20))
    };
    let mut model = inert(2000.0, 1000.0, 1.0, numerics);
    put(&mut model, RADIUS, 2000.0, 400.0, 1);
    let stored = 0.5 * 2000.0 * 1000.0 * sphere::volume(RADIUS);
    let span = 60.0 / windows as f64;
    let mut gas = 300.0;
    for _ in 0..windows {
        let mut still = Still {
            temperature: gas,
            pressure: 1e5,
            composition: Vec::new(),
            conductance: 100.0 * sphere::surface(RADIUS),
            film: 0.0,
            network: 0.0,
        };
        let mut heat = [0.0];
        let mut next = gas;
        for _ in 0..12 {
            still.temperature = next;
            let lists = Lists::of(&still, RADIUS, 1);
            let mut lines = GasLines::default();
            lines.reset(1, 0);
            model
                .respond(
                    &still.around(&lists),
                    span,
                    &[NetworkHeat::default()],
                    &mut lines,
                )
                .unwrap();
            let (slope, at) = (lines.conductance[0], lines.temperature[0]);
            next = (stored * gas + span * slope * at) / (stored + span * slope);
            heat = [slope * (next - at)];
        }
        let took = Transfer {
            heat: &heat,
            network: &[0.0],
            carried: &[0.0],
            rates: &[],
        };
        model.settle(&took, span).unwrap();
        model.commit();
        gas = next;
    }
    gas
}

#[test]
fn windows_with_a_gas_that_follows_are_of_first_order() {
    let exact = with_gas(1024);
    let found = orders(&[8, 16, 32].map(|windows| (with_gas(windows) - exact).abs()));
    assert!(
        found.iter().all(|order| (0.9..1.3).contains(order)),
        "{found:?}"
    );
}
