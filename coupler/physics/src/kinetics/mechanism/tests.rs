//! What holds of every mechanism.

use super::*;
use crate::kinetics::Broadening;
use crate::kinetics::statement::Collider;
use crate::reaction::{Arrhenius, Equation};
use calcine_numerics::{Dual, Number};

const SPECIES: [&str; 7] = ["CH4", "O2", "CO", "H2", "H2O", "CO2", "N2"];

fn gas() -> Mixture {
    Mixture::new(SPECIES).unwrap()
}

fn stated(equation: &str) -> ReactionStatement {
    ReactionStatement {
        name: equation.into(),
        equation: Equation::parse(equation).unwrap(),
        orders: None,
        rate: RateConstant::Arrhenius(Arrhenius {
            factor: 2e6,
            exponent: 0.3,
            activation_energy: 9e4,
        }),
        collider: None,
    }
}

const FRACTIONS: [f64; 7] = [0.03, 0.12, 0.04, 0.004, 0.09, 0.1, 0.616];

fn state(fractions: &[f64]) -> MixtureState<'_> {
    MixtureState {
        pressure: 2e5,
        temperature: 1600.0,
        fractions,
    }
}

#[test]
fn the_first_step_is_its_tables_rate() {
    // 4.4e11 · exp(−1.26e8/8314.462618/1600) · (c_CH4/1000)^0.5 · (c_O2/1000)^1.25 · 1000.
    let jl4 = Mechanism::jones_lindstedt(&gas()).unwrap();
    let mut c = [0.0; MOST_SPECIES];
    jl4.concentrations(&state(&FRACTIONS), &mut c);
    let k = 4.4e11 * (-1.26e8 / 8_314.462_618 / 1600.0_f64).exp();
    let expected = 1e3 * k * (c[0] / 1e3).powf(0.5) * (c[1] / 1e3).powf(1.25);
    let progress = jl4.progress(state(&FRACTIONS));
    assert!((progress[0].0 / expected - 1.0).abs() < 1e-12);
    assert_eq!(progress[0].1, 0.0);
    let total: f64 = c.iter().sum();
    assert!((total * GAS_CONSTANT * 1600.0 / 2e5 - 1.0).abs() < 1e-14);
}

#[test]
fn the_original_third_step_is_its_tables_and_runs_back_by_the_equilibrium() {
    let jl4 = Mechanism::jones_lindstedt_original(&gas()).unwrap();
    let mut c = [0.0; MOST_SPECIES];
    jl4.concentrations(&state(&FRACTIONS), &mut c);
    let k = 6.8e15 / 1600.0 * (-1.67e8 / 8_314.462_618 / 1600.0_f64).exp();
    let (h2, o2, h2o) = (c[3] / 1e3, c[1] / 1e3, c[4] / 1e3);
    let expected = 1e3 * k * h2.powf(0.25) * o2.powf(1.5);
    let (forth, back) = jl4.progress(state(&FRACTIONS))[2];
    assert!((forth / expected - 1.0).abs() < 1e-12);
    // K of kmol/m³, ln K_p = −ΔG°/(R T) at 1600 K of the tables.
    let g = |k: usize| gas().species()[k].polynomial().gibbs_energy(1600.0);
    let k_p = (-(g(4) - g(3) - 0.5 * g(1)) / (GAS_CONSTANT * 1600.0)).exp();
    let k_c = k_p * (1e5_f64 / (8_314.462_618 * 1600.0)).powf(-0.5);
    let expected = 1e3 * k / k_c * h2.powf(-0.75) * o2 * h2o;
    assert!((back / expected - 1.0).abs() < 1e-12);
}

#[test]
fn elements_and_mass_are_neither_made_nor_lost() {
    for mechanism in [
        Mechanism::jones_lindstedt(&gas()).unwrap(),
        Mechanism::jones_lindstedt_original(&gas()).unwrap(),
    ] {
        let mut rates = [0.0; 7];
        mechanism.rates(state(&FRACTIONS), &mut rates);
        let scale = rates.iter().fold(0.0_f64, |most, w| most.max(w.abs()));
        assert!(scale > 1.0 && rates.iter().sum::<f64>().abs() < 1e-13 * scale);
        for (name, shares) in gas().elements() {
            let made: f64 = shares.iter().zip(rates).map(|(a, w)| a * w).sum();
            assert!(made.abs() < 1e-13 * scale, "{name}");
        }
    }
}

#[test]
fn at_the_equilibrium_of_the_gibbs_energies_forth_and_back_are_equal_whatever_the_orders() {
    let mut odd = stated("H2 + 0.5 O2 <=> H2O");
    odd.orders = Some(vec![("H2".into(), 0.25), ("O2".into(), 1.5)]);
    let mechanism = Mechanism::new(&gas(), &[stated("H2 + 0.5 O2 <=> H2O"), odd]).unwrap();
    // ln K of partial pressures over 1 bar at 1600 K.
    let g = |k: usize| gas().species()[k].polynomial().gibbs_energy(1600.0);
    let ln_k = -(g(4) - g(3) - 0.5 * g(1)) / (GAS_CONSTANT * 1600.0);
    let mut y = FRACTIONS;
    let mut moles = [0.0; 7];
    for _ in 0..100 {
        // x_H2 = x_H2O/(K √(x_O2 p/p°)), iterated as H2 is a trace of the mixture.
        gas().mole_fractions(&y, &mut moles);
        let h2 = moles[4] / (ln_k.exp() * (moles[1] * 2.0).sqrt());
        y[3] = h2 * gas().species()[3].molar_mass() / gas().molar_mass(&y);
    }
    for (forth, back) in mechanism.progress(state(&y)) {
        assert!(
            forth > 0.0 && (back / forth - 1.0).abs() < 1e-10,
            "{forth} {back}"
        );
    }
}

#[test]
fn powers_are_regular_where_a_reactant_ends() {
    for n in [0.5, -0.75] {
        let below: f64 = power(FLOOR * (1.0 - 1e-12), n);
        let above: f64 = power(FLOOR * (1.0 + 1e-12), n);
        assert!((below / above - 1.0).abs() < 1e-11, "{n}");
    }
    let half: f64 = power(0.5 * FLOOR, 0.5);
    assert!((half / (0.5 * FLOOR.sqrt()) - 1.0).abs() < 1e-14);
    for n in [0.5, 1.0, 1.25, 2.0] {
        assert_eq!(power(0.0, n), 0.0, "{n}");
    }
    assert_eq!(power(-1e-9, 2.0), -1e-18);
    assert_eq!(power(3.0, 0.0), 1.0);
    // The pair of orders n and n − 1 keeps the ratio c below the floor too.
    let c = 0.01 * FLOOR;
    let ratio: f64 = power(c, 0.25) / power(c, -0.75);
    assert!((ratio / c - 1.0).abs() < 1e-12);
}

#[test]
fn derivatives_are_the_difference_quotients() {
    let mut falloff = stated("CO + H2O <=> CO2 + H2");
    let RateConstant::Arrhenius(law) = falloff.rate else {
        unreachable!()
    };
    falloff.rate = RateConstant::Falloff {
        high: law,
        low: law,
        broadening: crate::kinetics::Broadening::Lindemann,
    };
    falloff.collider = Some(Collider {
        efficiencies: vec![("H2O".into(), 6.0), ("HE".into(), 2.0)],
        others: 1.0,
    });
    let mut all = super::super::jones_lindstedt::steps(false).unwrap();
    all.push(falloff);
    let mechanism = Mechanism::new(&gas(), &all).unwrap();
    let mut c = [0.0; MOST_SPECIES];
    mechanism.concentrations(&state(&FRACTIONS), &mut c);
    let direction = [0.3, -0.2, 0.5, 0.1, -0.4, 0.2, 0.9];
    let at = |s: f64| -> Vec<f64> {
        let mut moved = c;
        for (c, d) in moved.iter_mut().zip(direction) {
            *c += s * d;
        }
        let mut out = vec![0.0; 7];
        mechanism.mass_rates(1600.0 + 50.0 * s, &moved, &mut out);
        out
    };
    let mut duals = [Dual::constant(0.0); MOST_SPECIES];
    for (k, dual) in duals.iter_mut().enumerate() {
        *dual = Dual {
            value: c[k],
            slope: [direction.get(k).copied().unwrap_or(0.0)],
        };
    }
    let mut out = vec![Dual::constant(0.0); 7];
    let t = Dual {
        value: 1600.0,
        slope: [50.0],
    };
    mechanism.mass_rates(t, &duals, &mut out);
    let h = 1e-5;
    for ((dual, high), low) in out.iter().zip(at(h)).zip(at(-h)) {
        let quotient = (high - low) / (2.0 * h);
        let scale = out
            .iter()
            .fold(0.0_f64, |most, x| most.max(x.slope[0].abs()));
        assert!((dual.slope[0] - quotient).abs() < 1e-7 * scale);
    }
}

#[test]
fn third_bodies_count_by_their_efficiencies() {
    let mut hit = stated("CO + H2O => CO2 + H2");
    hit.collider = Some(Collider {
        efficiencies: vec![("H2O".into(), 6.0), ("N2".into(), 0.0)],
        others: 1.0,
    });
    let mechanism = Mechanism::new(&gas(), &[stated("CO + H2O => CO2 + H2"), hit]).unwrap();
    let mut c = [0.0; MOST_SPECIES];
    mechanism.concentrations(&state(&FRACTIONS), &mut c);
    let bodies = c[0] + c[1] + c[2] + c[3] + 6.0 * c[4] + c[5];
    let progress = mechanism.progress(state(&FRACTIONS));
    assert!((progress[1].0 / (bodies * progress[0].0) - 1.0).abs() < 1e-14);
}

#[test]
fn negative_fractions_count_as_none() {
    let jl4 = Mechanism::jones_lindstedt(&gas()).unwrap();
    let mut without = FRACTIONS;
    without[0] = -1e-3;
    let mut rates = [1.0; 7];
    jl4.rates(state(&without), &mut rates);
    assert_eq!(rates[0], 0.0);
}

#[test]
fn what_is_no_mechanism_says_why() {
    let few = Mixture::new(["CH4", "O2", "N2"]).unwrap();
    let message = |mixture: &Mixture, statement: ReactionStatement| {
        Mechanism::new(mixture, &[statement])
            .unwrap_err()
            .to_string()
    };
    assert_eq!(
        Mechanism::jones_lindstedt(&few).unwrap_err().to_string(),
        "CH4 + 0.5 O2 => CO + 2 H2 names CO, which the gas does not have; it has CH4, O2, N2"
    );
    assert_eq!(
        message(&gas(), stated("CO + O2 => CO2")),
        "CO + O2 => CO2 is not balanced: 1.000000 O more on the left"
    );
    let mut wrong = stated("CO + H2O => CO2 + H2");
    wrong.orders = Some(vec![("CO".into(), f64::NAN)]);
    assert!(message(&gas(), wrong).contains("an order is NaN"));
    let mut by_helium = stated("CO + H2O => CO2 + H2");
    by_helium.collider = Some(Collider {
        efficiencies: vec![("HE".into(), 1.0)],
        others: 0.0,
    });
    assert!(message(&gas(), by_helium).contains("needs a third body"));
    let mut alone = stated("CO + H2O => CO2 + H2");
    let RateConstant::Arrhenius(law) = alone.rate else {
        unreachable!()
    };
    alone.rate = RateConstant::Falloff {
        high: law,
        low: law,
        broadening: Broadening::Lindemann,
    };
    assert!(message(&gas(), alone).contains("needs a third body"));
}

#[test]
fn numbers_that_no_third_body_and_no_falloff_can_have_are_refused() {
    let said = |rate: RateConstant, efficiencies: [f64; 2]| {
        let mut wrong = stated("CO + H2O => CO2 + H2");
        wrong.rate = rate;
        wrong.collider = Some(Collider {
            // Helium is no gas here, and its number is still wrong.
            efficiencies: vec![("HE".into(), efficiencies[0])],
            others: efficiencies[1],
        });
        match Mechanism::new(&gas(), &[wrong]) {
            Ok(_) => String::new(),
            Err(error) => error.to_string(),
        }
    };
    let RateConstant::Arrhenius(law) = stated("CO + H2O => CO2 + H2").rate else {
        unreachable!()
    };
    let falloff = |factor: f64, first: f64| RateConstant::Falloff {
        high: law,
        low: Arrhenius { factor, ..law },
        broadening: Broadening::Troe {
            share: 0.5,
            third: 100.0,
            first,
            second: None,
        },
    };
    assert_eq!(said(falloff(1.0, 1e3), [2.0, 1.0]), "");
    for (rate, efficiencies, what) in [
        (falloff(1.0, 1e3), [-1.0, 1.0], "an efficiency is -1,"),
        (falloff(1.0, 1e3), [1.0, -2.0], "an efficiency is -2,"),
        (falloff(1.0, 1e3), [f64::NAN, 1.0], "an efficiency is NaN,"),
        (
            falloff(1.0, f64::INFINITY),
            [1.0; 2],
            "Troe's T1 in K is inf,",
        ),
        (falloff(0.0, 1e3), [1.0; 2], "a factor A of a falloff is 0,"),
        (falloff(f64::NAN, 1e3), [1.0; 2], "a factor A is NaN,"),
    ] {
        let message = said(rate, efficiencies);
        assert!(message.contains(what), "{message}: {what}");
    }
}
