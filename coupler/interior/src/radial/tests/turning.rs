//! Particles with `auto` that turn from one shell to all, against those that have all from the start.

use calcine_physics::sphere;

use super::limits::raw;
use super::support::*;
use super::verification::RADIUS;
use crate::column::{ColumnKind, Ragged};
use crate::model::{At, ParticleModel, SurfaceLine};
use crate::radial::{PoreGas, Radial, RadialNumerics, ShellResolution};

const DENSITY: f64 = 2000.0;
const SHELLS: usize = 30;

/// Tolerances of steps that do not count beside what one shell leaves out; shells from the start, or from a difference of 5 K on.
fn numerics(auto: bool) -> RadialNumerics {
    RadialNumerics {
        resolution: match auto {
            true => ShellResolution::Beyond {
                temperature: 5.0,
                pressure: 0.05,
            },
            false => ShellResolution::All,
        },
        temperature: 0.02,
        conversion: 1e-5,
        ..RadialNumerics::new(grid(SHELLS))
    }
}

/// A stone without reactions.
fn stone(auto: bool) -> Radial {
    let mut model = inert(DENSITY, 1000.0, 1.0, numerics(auto));
    put(&mut model, RADIUS, DENSITY, 300.0, 1);
    model
}

/// A stone that takes up heat as it reacts.
fn reacting_stone(auto: bool) -> Radial {
    let solid = porous(&[4000.0; 2], 1.0);
    let pores = PoreGas::default();
    let mut model = Radial::new(raw(), &[1.0, 0.0], solid, pores, numerics(auto)).unwrap();
    put(&mut model, RADIUS, DENSITY, 700.0, 1);
    model
}

/// Gas with 50 W/m²/K about it: Bi 0.5.
fn hot(kelvin: f64) -> Still {
    Still {
        temperature: kelvin,
        pressure: 1e5,
        composition: Vec::new(),
        conductance: 50.0 * sphere::surface(RADIUS),
        film: 0.0,
        network: 0.0,
    }
}

fn surface(model: &Radial) -> f64 {
    model.bodies(At::Commit).temperature[0]
}

#[test]
fn a_stone_that_hot_gas_meets_has_its_shells_from_the_window_in_which_it_does() {
    let (mut auto, mut all) = (stone(true), stone(false));
    for k in 0..20 {
        // Gas as warm as the stone, and suddenly hot gas.
        let gas = hot(if k < 5 { 300.0 } else { 500.0 });
        for model in [&mut auto, &mut all] {
            window(model, &gas, RADIUS, 5.0);
        }
        assert_eq!(auto.shells_of(auto.row(0)) > 1, k >= 5, "{k}");
        let found = [surface(&auto), surface(&all), mean(&auto), mean(&all)];
        assert!((found[0] - found[1]).abs() < 1e-9, "{k}: {found:?}");
        assert!((found[2] - found[3]).abs() < 1e-9, "{k}: {found:?}");
    }
}

#[test]
fn a_stone_that_is_heated_ever_faster_turns_within_a_thousandth_of_its_rise() {
    let (mut auto, mut all) = (stone(true), stone(false));
    let mut turned = 0;
    let mut off = [0.0_f64; 2];
    for k in 1..=120 {
        let time = 10.0 * f64::from(k);
        // The parabola inside grows with the rate of heating, to some 10 K.
        let gas = hot(300.0 + 2.5e-4 * time * time);
        for model in [&mut auto, &mut all] {
            window(model, &gas, RADIUS, 10.0);
        }
        if auto.shells_of(auto.row(0)) > 1 && turned == 0 {
            turned = k;
        }
        off[0] = off[0].max((surface(&auto) - surface(&all)).abs());
        off[1] = off[1].max((mean(&auto) - mean(&all)).abs());
    }
    let rise = mean(&all) - 300.0;
    assert!((20..100).contains(&turned), "{turned}");
    assert!(off.iter().all(|off| *off < 1e-3 * rise), "{off:?}, {rise}");
}

#[test]
fn a_reacting_stone_turns_without_a_jump_of_its_temperature_or_its_conversion() {
    let (mut auto, mut all) = (reacting_stone(true), reacting_stone(false));
    let (mut turned, mut at_turn) = (0, 0.0);
    let mut off = [0.0_f64; 3];
    for k in 1..=260 {
        let time = 10.0 * f64::from(k);
        let gas = hot(700.0 + 1.2e-4 * time * time);
        for model in [&mut auto, &mut all] {
            window(model, &gas, RADIUS, 10.0);
        }
        let converted = [&auto, &all].map(|model| model.conversion(model.row(0), None));
        if auto.shells_of(auto.row(0)) > 1 && turned == 0 {
            (turned, at_turn) = (k, converted[1]);
        }
        off[0] = off[0].max((converted[0] - converted[1]).abs());
        off[1] = off[1].max((mean(&auto) - mean(&all)).abs());
        off[2] = off[2].max((surface(&auto) - surface(&all)).abs());
    }
    let rise = mean(&all) - 700.0;
    assert!((0.03..0.9).contains(&at_turn), "{at_turn}");
    assert!(all.conversion(all.row(0), None) > 0.99);
    let kelvin = off[1].max(off[2]);
    assert!(off[0] < 1e-4 && kelvin < 1e-4 * rise, "{off:?}, {rise}");
}

/// A limestone in flue gas that becomes hotter, until its window of this number is attempted.
fn limestone_at(window_index: u32, stone: &mut Radial) {
    for k in 0..=window_index {
        let gas = flue_gas(1000.0 + 2.0 * f64::from(k));
        if k < window_index {
            window(stone, &gas, LIME_RADIUS, 10.0);
        } else {
            attempt(stone, &gas, LIME_RADIUS, 10.0);
        }
    }
}

/// The same in its start, and the window in which it turns.
fn turning_limestone() -> (Radial, u32) {
    let made = || {
        let mut stone = limestone(1.235e15, numerics(true));
        put(&mut stone, LIME_RADIUS, LIME_DENSITY, 1000.0, 1);
        stone
    };
    let mut stone = made();
    for k in 0..200 {
        let gas = flue_gas(1000.0 + 2.0 * f64::from(k));
        window(&mut stone, &gas, LIME_RADIUS, 10.0);
        if stone.shells_of(stone.row(0)) > 1 {
            assert!(k > 2, "{k}");
            return (made(), k);
        }
    }
    panic!("it has not turned");
}

#[test]
fn a_particle_turns_with_the_mass_the_elements_and_the_energy_that_it_had() {
    let (mut stone, turns) = turning_limestone();
    limestone_at(turns - 1, &mut stone);
    stone.commit();
    let before = stone.held(&[0]);
    let gas = flue_gas(1000.0 + 2.0 * f64::from(turns));
    attempt(&mut stone, &gas, LIME_RADIUS, 10.0);
    assert_eq!(stone.shells_of(stone.row(0)), SHELLS);
    let now = stone.held(&[0]);
    let close = |one: f64, other: f64, of: f64| (one - other).abs() <= 1e-14 * of;
    assert!(close(now.mass.sum, before.mass.sum, before.mass.magnitude));
    assert!(close(
        now.energy.sum,
        before.energy.sum,
        before.energy.magnitude
    ));
    for (now, before) in now.elements.iter().zip(&before.elements) {
        assert!(close(now.sum, before.sum, before.magnitude));
    }
    // The parabola ends at the temperature that the surface has.
    let row = stone.row(0);
    let [inner, outer] = [0, SHELLS - 1].map(|k| stone.shell_temperature(row, k));
    assert!(
        outer > inner && (outer - row[0]).abs() < 0.1 * (outer - inner),
        "{inner} {outer} {}",
        row[0]
    );
}

#[test]
fn a_window_that_is_given_up_leaves_the_shells_that_there_were() {
    let (mut stone, turns) = turning_limestone();
    limestone_at(turns - 1, &mut stone);
    stone.commit();
    let before = stone.committed.clone();
    let gas = flue_gas(1000.0 + 2.0 * f64::from(turns));
    attempt(&mut stone, &gas, LIME_RADIUS, 10.0);
    let turned = stone.attempt.clone();
    assert_ne!(stone.committed, before);
    stone.begin_again();
    assert_eq!(stone.committed, before);
    // Attempts that a network asks for before it knows its heat turn nothing; the one that follows comes to the same bits.
    let lists = Lists::of(&gas, LIME_RADIUS, 1);
    let mut lines = [SurfaceLine::default()];
    stone
        .surface(&gas.around(&lists), 10.0, &[1000.0], &mut lines)
        .unwrap();
    assert_eq!(stone.committed, before);
    attempt(&mut stone, &gas, LIME_RADIUS, 10.0);
    assert_eq!(stone.attempt, turned);
}

#[test]
fn a_state_of_one_shell_that_is_read_and_loaded_turns_with_the_same_bits() {
    let (mut stone, turns) = turning_limestone();
    limestone_at(turns - 1, &mut stone);
    stone.commit();
    let columns: Vec<Ragged> = (0..stone.columns().len())
        .map(|k| {
            let mut out = Ragged::new(ColumnKind::Real);
            stone.read(k, &mut out);
            out
        })
        .collect();
    let mut other = limestone(1.235e15, numerics(true));
    put(&mut other, LIME_RADIUS, LIME_DENSITY, 300.0, 1);
    other.load(&columns).unwrap();
    let gas = flue_gas(1000.0 + 2.0 * f64::from(turns));
    for model in [&mut stone, &mut other] {
        window(model, &gas, LIME_RADIUS, 10.0);
        assert_eq!(model.shells_of(model.row(0)), SHELLS);
    }
    assert_eq!(stone.committed, other.committed);
}
