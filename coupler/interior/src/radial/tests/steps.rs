//! Steps within a window: as many as their errors ask for, and no more for what is far faster than they are long.

use calcine_physics::sphere;

use super::support::*;
use super::verification::RADIUS;
use crate::radial::{Radial, RadialNumerics};

fn within(tolerance: f64, radius: f64, kelvin: f64) -> Radial {
    let numerics = RadialNumerics {
        temperature: tolerance,
        ..RadialNumerics::new(grid(20))
    };
    let mut model = inert(2000.0, 1000.0, 1.0, numerics);
    put(&mut model, radius, 2000.0, kelvin, 1);
    model
}

fn gas(kelvin: f64, conductance: f64) -> Still {
    Still {
        temperature: kelvin,
        pressure: 1e5,
        composition: Vec::new(),
        conductance,
        film: 0.0,
        network: 0.0,
    }
}

#[test]
fn a_grain_that_follows_its_gas_within_milliseconds_takes_one_step() {
    // τ = ρ c R/3 (1/h + R/(5 λ)).
    let (radius, film) = (78e-6, 5200.0);
    let relaxes = 2000.0 * 1000.0 * radius / 3.0 * (1.0 / film + radius / 5.0);
    let mut grain = within(1.0, radius, 300.0);
    let (mut before, span) = (300.0, 60.0);
    for (k, kelvin) in [310.0, 360.0, 1000.0].into_iter().enumerate() {
        let still = gas(kelvin, film * sphere::surface(radius));
        window(&mut grain, &still, radius, span);
        let [steps, ..] = grain.work();
        assert_eq!(steps, k as u64 + 1, "{kelvin} K");
        // What the method leaves of it: R(z) = (1 + (1 − 2 γ) z)/(1 − γ z)², −4.83 τ/h of steps that are long.
        let found = mean(&grain);
        let left = (found - kelvin) / (before - kelvin) * span / relaxes;
        assert!((left + 4.83).abs() < 0.05, "{left}");
        before = kelvin;
    }
}

#[test]
fn a_stone_that_is_cooled_in_one_window_is_within_its_tolerance_a_step() {
    // Bi 1 and 10, Fo 0.2: mean of the series (requirements XDP-10).
    for (biot, exact) in [(1.0, 0.601_810), (10.0, 0.152_439)] {
        let mut last = 0;
        for tolerance in [1.0, 0.1, 0.01] {
            let mut stone = within(tolerance, RADIUS, 400.0);
            let film = biot / RADIUS * sphere::surface(RADIUS);
            let span = 0.2 * RADIUS * RADIUS * 2000.0 * 1000.0;
            window(&mut stone, &gas(300.0, film), RADIUS, span);
            let [steps, ..] = stone.work();
            let off = (mean(&stone) - 300.0 - 100.0 * exact).abs();
            assert!(steps > last, "{steps} {last}");
            // 20 shells alone are 0.06 K off.
            assert!(
                off < 0.1 + tolerance,
                "{biot} {tolerance}: {off} K in {steps}"
            );
            last = steps;
        }
    }
}
