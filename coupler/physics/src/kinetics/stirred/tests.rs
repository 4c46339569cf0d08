//! What holds of every cell that gas flows through.

use super::*;
use crate::kinetics::statement::ReactionStatement;
use crate::kinetics::{RateConstant, Tolerances};
use crate::reaction::{Arrhenius, Equation};
use crate::thermo::Mixture;

fn gas() -> Mixture {
    Mixture::new(["CH4", "O2", "CO", "H2", "H2O", "CO2", "N2"]).unwrap()
}

/// CO + H2O => CO2 + H2 of the order of CO alone, k in 1/s at any temperature: CO is a tracer that decays.
fn tracer(k: f64) -> Reactor {
    let stated = ReactionStatement {
        name: "shift".into(),
        equation: Equation::parse("CO + H2O => CO2 + H2").unwrap(),
        orders: Some(vec![("CO".into(), 1.0)]),
        rate: RateConstant::Arrhenius(Arrhenius {
            factor: k,
            exponent: 0.0,
            activation_energy: 0.0,
        }),
        collider: None,
    };
    let mechanism = Mechanism::new(&gas(), &[stated]).unwrap();
    Reactor::new(&mechanism, Tolerances::default())
}

/// One window of a cell with inflow of these fractions and 1000 K and a residence time: fractions and temperature become
/// those of its end.
fn window(
    reactor: &Reactor,
    inflow: &[f64],
    residence: f64,
    time: f64,
    fractions: &mut [f64],
    temperature: &mut f64,
) {
    let gas = gas();
    let leaving = [1.0 / residence; 7];
    let entering: Vec<f64> = inflow.iter().map(|y| y / residence).collect();
    let flow = Throughflow {
        entering: &entering,
        leaving: &leaving,
        heat_entering: gas.enthalpy(1000.0, inflow) / residence,
        heat_leaving: 1.0 / residence,
        opening: 0.0,
        mixing: 0.0,
    };
    let mut made = [0.0; 7];
    let state = MixtureState {
        pressure: 101_325.0,
        temperature: *temperature,
        fractions,
    };
    let mut workspace = ReactorWorkspace::default();
    reactor
        .flow_through(&mut workspace, state, &flow, time, &mut made)
        .unwrap();
    let heat = gas.enthalpy(*temperature, fractions);
    for k in 0..7 {
        fractions[k] = without(fractions[k], entering[k], leaving[k], time) + made[k];
    }
    let heat = without(heat, flow.heat_entering, flow.heat_leaving, time);
    let heat = heat - gas.formation_enthalpy(&made);
    *temperature = gas.temperature(heat, fractions, *temperature).unwrap();
}

const RICH: [f64; 7] = [0.0, 0.0, 0.2, 0.0, 0.5, 0.0, 0.3];
const EMPTY: [f64; 7] = [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0];

#[test]
fn a_cell_is_a_stirred_reactor_at_any_window() {
    for (number, left) in [
        (0.1, 1.0 / 1.1),
        (1.0, 0.5),
        (10.0, 1.0 / 11.0),
        (1000.0, 1.0 / 1001.0),
    ] {
        let reactor = tracer(number);
        for time in [0.01, 1.0, 10.0, 1e3, 1e6] {
            for start in [EMPTY, RICH] {
                let (mut fractions, mut temperature) = (start, 1000.0);
                let windows = (20.0 / f64::min(time, 1.0)) as usize;
                for _ in 0..windows {
                    window(&reactor, &RICH, 1.0, time, &mut fractions, &mut temperature);
                    let bounded = fractions.iter().all(|y| (0.0..=1.0).contains(y));
                    assert!(
                        bounded,
                        "Da {number}, {time} residence times: {fractions:?}"
                    );
                }
                let found = fractions[2] / RICH[2];
                // 1e-6 is the integration's tolerance; what the start has left after 20 residence times is less.
                let error = (found - left).abs();
                assert!(error < 2e-6, "Da {number}, {time}: {found} for {left}");
            }
        }
    }
}

#[test]
fn a_cell_without_flow_is_a_closed_reactor() {
    let jl4 = Mechanism::jones_lindstedt(&gas()).unwrap();
    let reactor = Reactor::new(&jl4, Tolerances::default());
    let y = gas().mass_fractions(&[1.0, 2.0, 0.0, 0.0, 0.0, 0.0, 7.52]);
    let flow = Throughflow {
        entering: &[0.0; 7],
        leaving: &[0.0; 7],
        heat_entering: 0.0,
        heat_leaving: 0.0,
        opening: 0.0,
        mixing: 0.0,
    };
    for time in [1e-6, 1e-5, 1e-3] {
        let mut made = [0.0; 7];
        let state = MixtureState {
            pressure: 101_325.0,
            temperature: 1500.0,
            fractions: &y,
        };
        let mut workspace = ReactorWorkspace::default();
        reactor
            .flow_through(&mut workspace, state, &flow, time, &mut made)
            .unwrap();
        let (mut alone, mut temperature) = (y.clone(), 1500.0);
        reactor
            .advance(101_325.0, &mut temperature, &mut alone, time)
            .unwrap();
        for k in 0..7 {
            assert!((y[k] + made[k] - alone[k]).abs() < 1e-5, "{time} s, {k}");
        }
    }
}

#[test]
fn what_a_cell_makes_is_free_of_every_element_and_leaves_nothing_negative() {
    let gas = gas();
    let jl4 = Mechanism::jones_lindstedt(&gas).unwrap();
    let reactor = Reactor::new(&jl4, Tolerances::default());
    let fresh = gas.mass_fractions(&[1.0, 2.2, 0.0, 0.0, 0.0, 0.0, 8.3]);
    let burnt = gas.mass_fractions(&[0.0, 0.2, 0.0, 0.0, 2.0, 1.0, 8.3]);
    let mut workspace = ReactorWorkspace::default();
    for exponent in -6..=2 {
        let residence = 10.0_f64.powi(exponent);
        // A species may leave by a path of its own besides, as a particle takes it.
        let leaving: [f64; 7] = std::array::from_fn(|k| (1.0 + 0.3 * k as f64) / residence);
        let entering: [f64; 7] = std::array::from_fn(|k| fresh[k] / residence);
        let flow = Throughflow {
            entering: &entering,
            leaving: &leaving,
            heat_entering: 0.0,
            heat_leaving: 1.0 / residence,
            opening: 0.0,
            mixing: 0.0,
        };
        for time in [1e-3, 1.0, 1e3] {
            let mut made = [0.0; 7];
            let state = MixtureState {
                pressure: 101_325.0,
                temperature: 2000.0,
                fractions: &burnt,
            };
            reactor
                .flow_through(&mut workspace, state, &flow, time, &mut made)
                .unwrap();
            let weighted: [f64; 7] = std::array::from_fn(|k| made[k] * (1.0 + leaving[k] * time));
            // Round-off of some hundred steps, of what passes through and what is made.
            let most = weighted.iter().fold(1.0_f64, |most, w| most.max(w.abs()));
            let most = 1e-13 * most.max(time / residence);
            for (name, shares) in gas.elements() {
                let sum: f64 = shares.iter().zip(&weighted).map(|(s, w)| s * w).sum();
                assert!(sum.abs() <= most, "{name}: {sum:e}");
            }
            for k in 0..7 {
                let end = without(burnt[k], entering[k], leaving[k], time) + made[k];
                assert!(end >= -1e-16, "{residence} s, {time} s, {k}: {end:e}");
            }
        }
    }
}
