//! Reactions as fast as any, and laws whose rate grows as the solid goes.

use calcine_physics::reaction::conversion::{Conversion, FirstOrder, Nucleation};
use calcine_physics::reaction::{Arrhenius, Equilibrium, PowerLaw};
use calcine_physics::solid::HeatCapacity;
use calcine_physics::solids::SolidSpecies;
use calcine_physics::sphere;

use super::support::*;
use super::verification::{KELVIN, RADIUS, dilute_gas, first_order, pellet, wide};
use crate::radial::{PoreGas, Radial, RadialNumerics};
use crate::reacting::{Rate, Reaction, SolidChemistry};

fn constant(factor: f64) -> Arrhenius {
    Arrhenius {
        factor,
        exponent: 0.0,
        activation_energy: 0.0,
    }
}

/// Conversion of a pellet that a dilute gas uses up, after five windows of a time in s.
fn used(rate: Rate, span: f64) -> f64 {
    let mut model = pellet(rate, vec![(0, -1.0), (1, 1.0)], wide(), grid(20));
    put(&mut model, RADIUS, 2000.0, KELVIN, 1);
    for _ in 0..5 {
        window(&mut model, &dilute_gas(100.0), RADIUS, span);
    }
    model.conversion(model.row(0), None)
}

#[test]
fn a_rate_constant_without_bound_is_a_front() {
    for span in [1.0, 1e4] {
        let [front, others @ ..] =
            [1e12, 1e20, 1e21, 1e24, 1e30].map(|k| used(first_order(k), span));
        assert!(front > 0.0);
        for other in others {
            assert!(
                (other / front - 1.0).abs() < 1e-3,
                "{span}: {other} {front}"
            );
        }
    }
}

/// Lime made of limestone by a rate constant in 1/s, after five windows.
fn burnt(k: f64, span: f64) -> f64 {
    let numerics = RadialNumerics {
        temperature: 1.0,
        conversion: 1e-3,
        ..RadialNumerics::new(grid(15))
    };
    let mut model = limestone(1e15, numerics);
    for reaction in &mut model.physics.chemistry.reactions {
        if let Rate::Power(law) = &mut reaction.rate {
            law.rate_constant = constant(k);
        }
    }
    put(&mut model, LIME_RADIUS, LIME_DENSITY, 1100.0, 1);
    for _ in 0..5 {
        window(&mut model, &flue_gas(1300.0), LIME_RADIUS, span);
    }
    model.conversion(model.row(0), None)
}

#[test]
fn a_reversible_rate_without_bound_is_at_its_equilibrium() {
    for span in [1.0, 30.0] {
        let [slow, others @ ..] = [1e10, 1e20, 1e21, 1e22, 1e25, 1e30].map(|k| burnt(k, span));
        assert!(slow > 0.0);
        for other in others {
            assert!((other / slow - 1.0).abs() < 2e-3, "{span}: {other} {slow}");
        }
    }
}

/// A solid that becomes another by itself, after a window of 10 s: its conversion.
fn alone(rate: Rate) -> f64 {
    let made = |name, formation| {
        SolidSpecies::new(name, "C", formation, 1.0, HeatCapacity::constant(1000.0)).unwrap()
    };
    let reaction = Reaction {
        name: "inside".into(),
        solids: vec![(0, -1.0), (1, 1.0)],
        gases: Vec::new(),
        rate,
        equilibrium: Equilibrium::OneWay,
    };
    let solids = vec![made("raw", 0.0), made("burnt", 1e3)];
    let chemistry = SolidChemistry::new(solids, None, vec![reaction]).unwrap();
    let numerics = RadialNumerics::new(grid(8));
    let mut model = Radial::new(
        chemistry,
        &[1.0, 0.0],
        porous(&[4000.0; 2], 1.0),
        PoreGas::default(),
        numerics,
    )
    .unwrap();
    put(&mut model, RADIUS, 2000.0, 900.0, 1);
    let still = Still {
        temperature: 1000.0,
        pressure: 1e5,
        composition: Vec::new(),
        conductance: 50.0 * sphere::surface(RADIUS),
        film: 0.0,
        network: 0.0,
    };
    window(&mut model, &still, RADIUS, 10.0);
    model.conversion(model.row(0), None)
}

#[test]
fn laws_of_any_shape_and_rate_reach_their_end() {
    for k in [10.0, 1e3, 1e10, 1e12, 1e16, 1e21, 1e25, 1e30] {
        let laws = [2.0, 3.0, 4.0].map(|exponent| {
            Conversion::Nucleation(Nucleation {
                exponent,
                nuclei: 1e-3,
            })
        });
        for conversion in laws.into_iter().chain([Conversion::FirstOrder(FirstOrder)]) {
            let found = alone(Rate::Conversion {
                rate_constant: constant(k),
                conversion,
                gases: Vec::new(),
            });
            assert!(found > 1.0 - 1e-6, "{conversion:?} {k}: {found}");
        }
        for order in [0.01, 0.3, 0.7, 1.0] {
            let found = alone(Rate::Power(PowerLaw {
                // mol/m³ to the power 1 − m.
                rate_constant: constant(k * f64::powf(1e5, 1.0 - order)),
                in_series: None,
                solids: vec![(0, order)],
                gases: Vec::new(),
            }));
            assert!(found > 1.0 - 1e-6, "{order} {k}: {found}");
        }
    }
}

#[test]
fn nucleation_takes_its_time_where_it_is_not_fast() {
    // (a − ln w)^1/m = k t + a^1/m.
    let (m, a, k) = (4.0_f64, 1e-3_f64, 0.1);
    let found = alone(Rate::Conversion {
        rate_constant: constant(k),
        conversion: Conversion::Nucleation(Nucleation {
            exponent: m,
            nuclei: a,
        }),
        gases: Vec::new(),
    });
    let exact = 1.0 - (a - (k * 10.0 + a.powf(1.0 / m)).powf(m)).exp();
    assert!((found - exact).abs() < 0.02, "{found} {exact}");
}

#[test]
fn limestone_that_bursts_cools_until_it_no_longer_does() {
    for (factor, order) in [(1e20, 0.01), (1e23, 0.01), (1e28, 0.01), (1e21, 1.0)] {
        let numerics = RadialNumerics {
            temperature: 1.0,
            conversion: 1e-3,
            ..RadialNumerics::new(grid(15))
        };
        let mut model = limestone(1e15, numerics);
        for reaction in &mut model.physics.chemistry.reactions {
            reaction.equilibrium = Equilibrium::OneWay;
            if let Rate::Power(law) = &mut reaction.rate {
                law.rate_constant.factor = factor;
                law.solids = vec![(0, order)];
            }
        }
        put(&mut model, LIME_RADIUS, LIME_DENSITY, 1100.0, 1);
        for _ in 0..8 {
            window(&mut model, &flue_gas(1400.0), LIME_RADIUS, 2.44e-3);
        }
        // It takes 178 kJ/mol, and holds about 110 J/mol/K.
        let found = model.conversion(model.row(0), None);
        assert!((0.01..0.5).contains(&found), "{factor} {order}: {found}");
    }
}
