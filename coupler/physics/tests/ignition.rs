//! Verification of gas reactions against an independent code, Cantera: `reference/references.py` made the tables.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

use calcine_physics::kinetics::{Mechanism, MixtureState, Reactor, Tolerances};
use calcine_physics::thermo::Mixture;

fn table(text: &str) -> Vec<Vec<f64>> {
    let lines = text.lines().filter(|line| !line.starts_with('#')).skip(1);
    lines
        .map(|line| line.split(',').map(|cell| cell.parse().unwrap()).collect())
        .collect()
}

fn gas() -> Mixture {
    Mixture::new(["CH4", "O2", "CO", "H2", "H2O", "CO2", "N2"]).unwrap()
}

fn fresh(phi: f64) -> Vec<f64> {
    let n2 = 2.0 * 79.0 / 21.0;
    gas().mass_fractions(&[phi, 2.0, 0.0, 0.0, 0.0, 0.0, n2])
}

fn reactor() -> Reactor {
    let jl4 = Mechanism::jones_lindstedt(&gas()).unwrap();
    Reactor::new(&jl4, Tolerances::default())
}

/// Time at which gas of 1 mole of fuel to 2/φ of oxygen is 400 K hotter than at its start.
fn delay(reactor: &Reactor, phi: f64, start: f64, pressure: f64, guess: f64) -> f64 {
    let hotter = |time: f64| {
        let (mut t, mut y) = (start, fresh(phi));
        reactor.advance(pressure, &mut t, &mut y, time).unwrap();
        t - start - 400.0
    };
    let (mut low, mut high) = (0.5 * guess, 2.0 * guess);
    assert!(hotter(low) < 0.0 && hotter(high) > 0.0, "{phi} {start}");
    while high - low > 1e-5 * high {
        let middle = 0.5 * (low + high);
        if hotter(middle) < 0.0 {
            low = middle;
        } else {
            high = middle;
        }
    }
    0.5 * (low + high)
}

#[test]
fn ignition_delays_and_final_temperatures_are_cantera_s() {
    let reactor = reactor();
    let mut worst = [0.0_f64; 2];
    for row in table(include_str!("reference/ignition.csv")) {
        let [phi, start, pressure, expected, end] = row[..] else {
            panic!("{row:?}")
        };
        let found = delay(&reactor, phi, start, pressure, expected);
        let (mut t, mut y) = (start, fresh(phi));
        reactor.advance(pressure, &mut t, &mut y, 10.0).unwrap();
        worst[0] = worst[0].max((found / expected - 1.0).abs());
        worst[1] = worst[1].max((t / end - 1.0).abs());
    }
    assert!(worst[0] < 5e-5 && worst[1] < 5e-6, "{worst:?}");
}

#[test]
fn burnt_gas_reaches_cantera_s_equilibrium() {
    let reactor = reactor();
    let gas = gas();
    let mut worst = [0.0_f64; 2];
    for row in table(include_str!("reference/equilibrium.csv")) {
        let (phi, start, pressure, end) = (row[0], row[1], row[2], row[3]);
        let fresh = fresh(phi);
        let (mut t, mut y) = (start, fresh.clone());
        if start < 1000.0 {
            // What does not light itself starts as its own products: at 1 mole of O2 to φ/2 of CH4.
            let enthalpy = gas.enthalpy(t, &fresh) + gas.formation_enthalpy(&fresh);
            let lack = (4.0 * phi - 4.0_f64).max(0.0);
            let burnt = [
                0.0,
                (2.0 - 2.0 * phi).max(0.0),
                0.5 * lack,
                0.5 * lack,
                2.0 * phi - 0.5 * lack,
                phi - 0.5 * lack,
                2.0 * 79.0 / 21.0,
            ];
            y = gas.mass_fractions(&burnt);
            let sensible = enthalpy - gas.formation_enthalpy(&y);
            t = gas.temperature(sensible, &y, 2200.0).unwrap();
        }
        for (one, other) in gas
            .element_fractions(&y)
            .iter()
            .zip(gas.element_fractions(&fresh))
        {
            assert!((one - other).abs() < 1e-12);
        }
        reactor.advance(pressure, &mut t, &mut y, 10.0).unwrap();
        let mut x = vec![0.0; 7];
        gas.mole_fractions(&y, &mut x);
        worst[0] = worst[0].max((t / end - 1.0).abs());
        for (found, expected) in x.iter().zip(&row[4..]) {
            worst[1] = worst[1].max((found - expected).abs());
        }
    }
    assert!(worst[0] < 1e-6 && worst[1] < 1e-6, "{worst:?}");
}

#[test]
fn rates_forth_and_back_are_cantera_s() {
    let gas = gas();
    let jl4 = Mechanism::jones_lindstedt(&gas).unwrap();
    let y = gas.mass_fractions(&[0.05, 0.12, 0.03, 0.02, 0.11, 0.07, 0.6]);
    let text = include_str!("reference/rates.csv").lines();
    let mut count = 0;
    for line in text.filter(|line| line.starts_with("jones-lindstedt,")) {
        let row: Vec<f64> = line
            .split(',')
            .skip(1)
            .map(|cell| cell.parse().unwrap())
            .collect();
        let [temperature, pressure, reaction, forth, back] = row[..] else {
            panic!("{line}")
        };
        let state = MixtureState {
            pressure,
            temperature,
            fractions: &y,
        };
        let found = jl4.progress(state)[reaction as usize];
        // Atomic weights of two editions: 1e-5 in a concentration.
        assert!((found.0 / forth - 1.0).abs() < 1e-4, "{line}: {found:?}");
        assert!((found.1 - back).abs() <= 1e-4 * back, "{line}: {found:?}");
        count += 1;
    }
    assert_eq!(count, 12);
}
