//! The gas in a duct one cell wide, with and without a bed: verification against exact solutions.
#![allow(clippy::unwrap_used, clippy::needless_range_loop)]

use calcine_coupler::part::{Balance, Gas};
use calcine_coupler::time::GasStorage;

use crate::common::*;

const SIZE: [f64; 3] = [0.01, 0.01, 0.12];
const CELLS: usize = 12;
const VOLUME: f64 = 0.01 * 0.01 * 0.01;

fn column_of(velocity: f64, temperature: f64, change: impl Fn(&mut GasSetup)) -> Driver {
    let mut setup = setup(&[
        ("bottom", inlet(velocity, temperature)),
        ("top", outlet()),
        ("side", slip()),
    ]);
    change(&mut setup);
    Driver::new(&duct(SIZE, [1, 1, CELLS]), &setup)
}

fn column(velocity: f64, temperature: f64) -> Driver {
    column_of(velocity, temperature, |_| {})
}

/// A bed of ten cells that heats or cools what flows through it.
fn with_bed(mut column: Driver, drag: f64, heat: f64) -> Driver {
    for cell in 1..11 {
        column.bed.void_fraction[cell] = 0.476;
        column.exchange.drag_coefficient[cell] = drag;
        column.exchange.heat_coefficient[cell] = heat;
        column.exchange.heat_source[cell] = heat * 300.0;
    }
    column
}

#[test]
fn flow_through_a_jump_of_void_fraction_keeps_the_superficial_velocity() {
    // Hardly any viscosity: its stress at the jump is no part of the expected gradient.
    let mut column = column_of(0.5, 300.0, |setup| {
        setup.properties = inviscid();
    });
    for cell in 3..9 {
        column.bed.void_fraction[cell] = 0.4;
        column.exchange.drag_coefficient[cell] = 1e-4;
    }
    column.settle(1e-3, 1.0, 3000);
    let fields = column.gas.fields();
    for cell in 0..CELLS {
        // Linear solves to 1e-12, an outer loop to 1e-9.
        let superficial = column.bed.void_fraction[cell] * fields.velocity[cell].z;
        assert!((superficial / 0.5 - 1.0).abs() < 1e-9, "{superficial} m/s");
        assert!(fields.velocity[cell].xy().norm() < 1e-15);
        let drag = -column.exchange.drag_coefficient[cell] * fields.velocity[cell];
        assert_eq!(column.received.drag[cell], drag);
    }
    // −ε V dp/dz = K u + φ (u − u_upstream): drag, and the jet that enters the pores.
    let flux = AIR.density(ATMOSPHERE, 300.0) * 0.5 * 1e-4;
    let gradient = |cell: usize| {
        let velocity = |c: usize| 0.5 / column.bed.void_fraction[c];
        let drag = column.exchange.drag_coefficient[cell] * velocity(cell);
        let jet = flux * (velocity(cell) - velocity(cell - 1));
        -(drag + jet) / (column.bed.void_fraction[cell] * VOLUME)
    };
    for cell in 1..CELLS {
        let found = fields.pressure_gradient[cell].z;
        let scale = gradient(3).abs();
        assert!(
            (found - gradient(cell)).abs() < 1e-8 * scale,
            "{found} Pa/m in {cell}"
        );
    }
}

#[test]
fn pressure_falls_by_resistances_in_series_down_to_the_half_cells_at_the_bed_ends() {
    let mut column = column(0.5, 300.0);
    let drag = |cell: usize| {
        if (3..9).contains(&cell) {
            1e-4 * (cell - 2) as f64
        } else {
            0.0
        }
    };
    for cell in 0..CELLS {
        column.exchange.drag_coefficient[cell] = drag(cell);
    }
    column.settle(1e-3, 1.0, 3000);
    // Each cell takes K U h/V; a centre lies half a cell below its upper face.
    let fall = |cell: usize| drag(cell) * 0.5 * 0.01 / VOLUME;
    let mut above = 0.0;
    for cell in (0..CELLS).rev() {
        let exact = ATMOSPHERE + above + 0.5 * fall(cell);
        let found = column.gas.fields().pressure[cell];
        assert!(
            (found - exact).abs() < 1e-8 * fall(8),
            "{found} against {exact} Pa in {cell}"
        );
        above += fall(cell);
    }
}

#[test]
fn a_heated_bed_warms_the_gas_as_the_exact_upwind_chain() {
    // Without viscosity the gas does not conduct, and T_c = (φ c_p T_{c−1} + Q)/(φ c_p + k).
    let mut column = column_of(0.5, 300.0, |setup| {
        setup.properties = inviscid();
    });
    for cell in 2..10 {
        column.exchange.heat_coefficient[cell] = 0.02;
        column.exchange.heat_source[cell] = 0.02 * 800.0;
    }
    // Hundreds of residence times; velocities then still move by what linear solvers leave.
    for _ in 0..300 {
        column.window(1e-3, 500.0);
    }
    let capacity = AIR.density(ATMOSPHERE, 300.0) * 0.5 * 1e-4 * AIR.heat_capacity;
    let mut exact = 300.0;
    for cell in 0..CELLS {
        let (k, q) = (
            column.exchange.heat_coefficient[cell],
            column.exchange.heat_source[cell],
        );
        exact = (capacity * exact + q) / (capacity + k);
        let found = column.gas.fields().temperature[cell];
        assert!(
            (found - exact).abs() < 1e-6,
            "{found} against {exact} K in {cell}"
        );
        assert!((column.received.heat[cell] - (q - k * found)).abs() < 1e-15);
    }
    assert!(exact > 500.0);
}

#[test]
fn mass_energy_and_momentum_close_in_every_window_of_a_hot_front() {
    for factor in [1.0, 50.0] {
        let mut column = with_bed(column(0.5, 400.0), 1e-5, 0.01);
        for _ in 0..200 {
            let convergence = column.window(1e-3, factor);
            assert!(convergence.converged, "{convergence:?}");
            assert!(convergence.volume_residual < 1e-7, "{convergence:?}");
            assert!(closure(&column.received.mass) < 1e-13);
            // Linear residuals end at 1e-12 of the energy that moves.
            assert!(closure(&column.received.energy) < 2e-12);
            // The outer loop ends at 1e-9 of all terms, of which the balance's parts are some.
            assert!(closure(&column.received.momentum[2]) < 1e-7);
        }
    }
}

#[test]
fn momentum_closes_with_what_two_clocks_owe_and_not_without_it() {
    let held = |column: &Driver| -> Vec<f64> {
        let pores = column.bed.void_fraction.iter();
        let density = column.gas.fields().density.iter();
        let cells = pores.zip(density);
        cells
            .map(|(pores, density)| pores * density * VOLUME)
            .collect()
    };
    for factor in [1.0, 50.0] {
        let mut column = with_bed(column(0.5, 400.0), 1e-5, 0.01);
        let mut most = 0.0_f64;
        for index in 0..30 {
            let before = held(&column);
            column.window(1e-3, factor);
            let [.., along] = &column.received.momentum;
            let clock = column.received.storage_clock.z;
            assert!(closure(along) < 1e-7, "{along:?}");
            let without = Balance {
                source: along.source - clock,
                ..*along
            };
            most = most.max(closure(&without));
            if index == 0 {
                // What the gas of the start holds is known after the bed has been filled.
                continue;
            }
            // By the densities of both ends; the masses of continuity are these within 1e-7.
            let (mut sum, mut all) = (0.0, 0.0);
            let speeds = column.gas.fields().velocity.iter();
            for (u, (after, before)) in speeds.zip(held(&column).into_iter().zip(before)) {
                sum += u.z * (after - before);
                all += u.z * after;
            }
            let expected = (1.0 - 1.0 / factor) * sum;
            assert!(
                (clock - expected).abs() < 2e-7 * all,
                "AF {factor}: {clock} N s, {expected} N s of {all} N s"
            );
        }
        match factor > 1.0 {
            true => assert!(most > 1e-3, "{most}"),
            false => assert_eq!(column.received.storage_clock.norm(), 0.0),
        }
    }
}

#[test]
fn a_steady_flow_does_not_depend_on_the_time_step() {
    let pressure = |span| {
        let mut column = with_bed(column(0.5, 400.0), 1e-5, 0.01);
        // Ten residence times at least.
        for _ in 0..1000 {
            column.window(span, 5.0);
        }
        column.gas.fields().pressure[0] - ATMOSPHERE
    };
    let (short, long) = (pressure(1e-3), pressure(1e-1));
    assert!(
        (short / long - 1.0).abs() < 1e-7,
        "{short} against {long} Pa"
    );
}

#[test]
fn energy_closes_even_where_the_outer_loop_is_cut_short() {
    let column = column_of(0.5, 400.0, |setup| setup.controls.outer_iterations = 1);
    let mut column = with_bed(column, 1e-5, 0.01);
    assert!(!column.window(1e-3, 50.0).converged);
    for _ in 0..50 {
        column.window(1e-3, 50.0);
        assert!(closure(&column.received.mass) < 1e-13);
        assert!(closure(&column.received.energy) < 2e-12);
    }
}

#[test]
fn a_uniform_temperature_stays_uniform_while_the_flow_changes() {
    let mut column = with_bed(column(0.5, 350.0), 1e-5, 0.0);
    column.settle(1e-3, 100.0, 3000);
    for &temperature in column.gas.fields().temperature {
        assert!((temperature - 350.0).abs() < 1e-6, "{temperature} K");
    }
}

#[test]
fn both_storages_give_the_same_bits_without_acceleration() {
    let run = |storage| {
        let column = column_of(0.5, 400.0, |setup| setup.storage = storage);
        let mut column = with_bed(column, 1e-5, 0.01);
        for _ in 0..50 {
            column.window(1e-3, 1.0);
        }
        column.bits()
    };
    assert_eq!(run(GasStorage::Process), run(GasStorage::Accelerated));
}

#[test]
fn accelerated_storage_delays_the_front_and_process_storage_does_not() {
    let run = |storage, factor: f64| {
        let column = column_of(0.5, 400.0, |setup| setup.storage = storage);
        let mut column = with_bed(column, 1e-5, 0.0);
        // 0.4 s of process time, longer than the gas stays.
        for _ in 0..(400.0 / factor) as usize {
            column.window(1e-3, factor);
        }
        column.gas.fields().temperature[11]
    };
    let plain = run(GasStorage::Process, 1.0);
    assert!(plain > 395.0, "{plain}");
    assert!((run(GasStorage::Process, 20.0) - plain).abs() < 5.0);
    assert!(run(GasStorage::Accelerated, 20.0) < 305.0);
}

#[test]
fn a_repeated_attempt_gives_the_same_bits() {
    let mut column = with_bed(column(0.5, 400.0), 1e-5, 0.01);
    for _ in 0..20 {
        column.attempt(1e-3, 50.0);
        let once = column.bits();
        column.exchange.heat_source[4] += 5.0;
        column.attempt(1e-3, 50.0);
        assert_ne!(column.bits(), once);
        column.exchange.heat_source[4] -= 5.0;
        column.attempt(1e-3, 50.0);
        assert_eq!(column.bits(), once);
        column.window(1e-3, 50.0);
    }
}

#[test]
fn the_first_attempt_may_be_repeated_with_another_bed() {
    let mut once = with_bed(column(0.5, 400.0), 1e-5, 0.01);
    let bed = once.bed.clone();
    once.bed.void_fraction.fill(0.9);
    once.attempt(1e-3, 1.0);
    once.bed = bed;
    once.window(1e-3, 1.0);
    let mut plain = with_bed(column(0.5, 400.0), 1e-5, 0.01);
    plain.window(1e-3, 1.0);
    assert_eq!(once.bits(), plain.bits());
}
