//! What holds of every reactor.

use super::*;
use crate::kinetics::RateConstant;
use crate::kinetics::statement::ReactionStatement;
use crate::reaction::{Arrhenius, Equation};
use crate::thermo::Mixture;

fn gas() -> Mixture {
    Mixture::new(["CH4", "O2", "CO", "H2", "H2O", "CO2", "N2"]).unwrap()
}

/// Methane in air, φ = 1.
fn fresh() -> [f64; 7] {
    let y = gas().mass_fractions(&[1.0, 2.0, 0.0, 0.0, 0.0, 0.0, 7.52]);
    std::array::from_fn(|k| y[k])
}

fn reactor() -> Reactor {
    let jl4 = Mechanism::jones_lindstedt(&gas()).unwrap();
    Reactor::new(&jl4, Tolerances::default())
}

#[test]
fn one_first_order_reaction_decays_by_its_exponential() {
    // CO + H2O => CO2 + H2 of the order of CO alone, no change of moles: the closed form exp(−k t) at fixed temperature.
    let stated = ReactionStatement {
        name: "shift".into(),
        equation: Equation::parse("CO + H2O => CO2 + H2").unwrap(),
        orders: Some(vec![("CO".into(), 1.0)]),
        rate: RateConstant::Arrhenius(Arrhenius {
            factor: 40.0,
            exponent: 0.0,
            activation_energy: 0.0,
        }),
        collider: None,
    };
    let mechanism = Mechanism::new(&gas(), &[stated]).unwrap();
    for (relative, error) in [(1e-4, 1e-3), (1e-8, 1e-6)] {
        let tolerances = Tolerances {
            relative,
            fraction: 1e-14,
            ..Tolerances::default()
        };
        let reactor = Reactor::new(&mechanism, tolerances);
        let mut y = [0.0, 0.0, 0.2, 0.0, 0.5, 0.0, 0.3];
        let outcome = reactor
            .advance_isothermal(1e5, 1000.0, &mut y, 0.1)
            .unwrap();
        assert!(outcome.steps > 5);
        assert!(
            (y[2] / (0.2 * (-4.0_f64).exp()) - 1.0).abs() < error,
            "{y:?}"
        );
    }
}

#[test]
fn elements_and_enthalpy_are_kept_through_ignition() {
    let gas = gas();
    let reactor = reactor();
    let (mut t, mut y) = (1500.0, fresh());
    let before = (gas.element_fractions(&y), total(&gas, t, &y));
    for _ in 0..50 {
        reactor.advance(101_325.0, &mut t, &mut y, 2e-4).unwrap();
        for (now, then) in gas.element_fractions(&y).into_iter().zip(before.0) {
            assert!((now - then).abs() < 1e-13, "{now} {then}");
        }
        assert!((total(&gas, t, &y) - before.1).abs() < 1e-6, "J/kg");
        assert!(y.iter().all(|y| (0.0..=1.0).contains(y)));
    }
    assert!(t > 2600.0 && y[0] < 1e-12, "{t} K, CH4 {:e}", y[0]);
}

fn total(gas: &Mixture, t: f64, y: &[f64]) -> f64 {
    gas.enthalpy(t, y) + gas.formation_enthalpy(y)
}

#[test]
fn cold_gas_is_left_to_the_bit() {
    let (mut t, mut y) = (300.0, fresh());
    let outcome = reactor().advance(101_325.0, &mut t, &mut y, 1.0).unwrap();
    assert_eq!((outcome.steps, t, y), (0, 300.0, fresh()));
}

#[test]
fn what_is_left_out_as_negligible_is_below_the_bound() {
    // 700 K: slow, but not nothing.
    let run = |negligible: f64| {
        let tolerances = Tolerances {
            negligible,
            ..Tolerances::default()
        };
        let reactor = Reactor::new(reactor().mechanism(), tolerances);
        let (mut t, mut y) = (700.0, fresh());
        let steps = reactor
            .advance(101_325.0, &mut t, &mut y, 1e-7)
            .unwrap()
            .steps;
        (steps, y)
    };
    let (integrated, left) = (run(0.0), run(1e-6));
    assert!(integrated.0 > 0 && left.0 == 0);
    for (a, b) in integrated.1.iter().zip(left.1) {
        assert!((a - b).abs() <= 1e-6, "{a} {b}");
    }
}

#[test]
fn two_halves_of_a_time_are_the_whole() {
    let mut once = (1700.0, fresh());
    reactor()
        .advance(101_325.0, &mut once.0, &mut once.1, 1e-3)
        .unwrap();
    let mut twice = (1700.0, fresh());
    for _ in 0..2 {
        reactor()
            .advance(101_325.0, &mut twice.0, &mut twice.1, 5e-4)
            .unwrap();
    }
    assert!((once.0 - twice.0).abs() < 0.5, "{} {}", once.0, twice.0);
}

#[test]
fn the_original_set_comes_through_where_hydrogen_ends() {
    let original = Mechanism::jones_lindstedt_original(&gas()).unwrap();
    let reactor = Reactor::new(&original, Tolerances::default());
    let (mut t, mut y) = (1500.0, fresh());
    reactor.advance(101_325.0, &mut t, &mut y, 0.1).unwrap();
    assert!(t > 2500.0, "{t}");
}

#[test]
fn a_parcel_that_cannot_be_is_refused_with_its_state() {
    let mut y = fresh();
    let reactor = reactor();
    for (p, t, time) in [
        (-1.0, 1500.0, 1e-3),
        (1e5, f64::NAN, 1e-3),
        (1e5, 1500.0, -1.0),
    ] {
        let mut temperature = t;
        let error = reactor.advance(p, &mut temperature, &mut y, time);
        let message = error.unwrap_err().to_string();
        assert!(
            message.contains("cannot react at") && message.contains("CH4"),
            "{message}"
        );
    }
    assert_eq!(y, fresh());
}

#[test]
fn an_integration_that_is_cut_short_says_where_it_came_from_and_leaves_the_gas() {
    let tolerances = Tolerances {
        steps: 3,
        ..Tolerances::default()
    };
    let short = Reactor::new(reactor().mechanism(), tolerances);
    let (mut t, mut y) = (1500.0, fresh());
    let error = short.advance(101_325.0, &mut t, &mut y, 1.0).unwrap_err();
    let message = error.to_string();
    assert!(
        message.contains("more than 3 steps") && message.contains("1500.00 K"),
        "{message}"
    );
    assert_eq!((t, y), (1500.0, fresh()));
}
