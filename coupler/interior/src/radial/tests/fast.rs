//! Reactions as fast as any, and laws whose rate grows as the solid goes.

use calcine_physics::gas::GAS_CONSTANT;
use calcine_physics::pores::Permeability;
use calcine_physics::reaction::conversion::{
    ContractingVolume, Conversion, FirstOrder, Nucleation,
};
use calcine_physics::reaction::equilibrium::GibbsLine;
use calcine_physics::reaction::{Arrhenius, Equilibrium, PowerLaw};
use calcine_physics::solid::HeatCapacity;
use calcine_physics::solids::SolidSpecies;
use calcine_physics::sphere;
use calcine_physics::thermo::Mixture;

use super::support::*;
use super::verification::{
    DILUTE, KELVIN, RADIUS, diffusivity, dilute_gas, first_order, pellet, wide,
};

use crate::radial::rates::{ShellRate, ShellState};
use crate::radial::side_by_side::Wide;
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

#[test]
fn limestone_that_goes_one_way_sweeps_its_pores() {
    // Carbon dioxide drives the nitrogen out of the core to next to nothing.
    for permeability in [1e-14, 1e-15] {
        let found = [5, 20, 40].map(|shells| {
            let mut model = limestone(1.235e15, RadialNumerics::new(grid(shells)));
            model.physics.solid.permeability = Permeability::Constant(permeability);
            for reaction in &mut model.physics.chemistry.reactions {
                reaction.equilibrium = Equilibrium::OneWay;
            }
            put(&mut model, LIME_RADIUS, LIME_DENSITY, 1000.0, 1);
            for _ in 0..60 {
                window(&mut model, &flue_gas(1400.0), LIME_RADIUS, 10.0);
            }
            model.conversion(model.row(0), None)
        });
        assert!((found[0] - found[2]).abs() < 0.05, "{found:?}");
        assert!((found[1] - found[2]).abs() < 0.01, "{found:?}");
    }
}

#[test]
fn a_reaction_of_order_zero_ends_where_its_gas_does() {
    // Effectiveness 1 - r³ where the core is empty within r, φ² = 6/(1 - 3 r² + 2 r³) (Weisz, Z. Phys. Chem. 11 (1957) 1).
    for (thiele_squared, exact) in [(4.0, 1.0), (12.0, 0.875), (60.0, 0.479_894)] {
        for orders in [vec![(0, 0.0)], Vec::new()] {
            let full = thiele_squared * diffusivity() / (RADIUS * RADIUS) * DILUTE * 1e5
                / (GAS_CONSTANT * KELVIN);
            let rate = Rate::Power(PowerLaw {
                rate_constant: constant(full),
                in_series: None,
                solids: Vec::new(),
                gases: orders,
            });
            let mut model = pellet(rate, Vec::new(), wide(), grid(40));
            put(&mut model, RADIUS, 2000.0, KELVIN, 1);
            let still = dilute_gas(1e7);
            let mut passed = Vec::new();
            for _ in 0..5 {
                passed = window(&mut model, &still, RADIUS, 1e3);
            }
            let found = -passed[0] / (full * sphere::volume(RADIUS) * 1e3);
            assert!((found - exact).abs() < 5e-3, "{thiele_squared}: {found}");
        }
    }
}

#[test]
fn a_gas_without_an_order_ends_a_reaction_below_a_thousandth_of_a_pascal() {
    let rate = Rate::Power(PowerLaw {
        rate_constant: constant(2.0),
        in_series: None,
        solids: Vec::new(),
        gases: Vec::new(),
    });
    let model = pellet(rate, Vec::new(), wide(), grid(5));
    let at = |pascal: f64| {
        let mut out = ShellRate::new(2, 2);
        let state = ShellState {
            temperature: Wide::all(KELVIN),
            pressures: &[Wide::all(pascal), Wide::all(1e5)],
            amounts: &[Wide::all(1.0), Wide::all(0.0)],
            first: &[Wide::all(1.0), Wide::all(0.0)],
            volume: Wide::all(3.0),
        };
        model.physics.rate(0, &state, &mut out);
        [out.value[0], out.by_pressure[0][0]]
    };
    // x (2 - x) of 2 mol/m³/s in 3 m³, and its slope.
    for (pascal, value, slope) in [(1.0, 6.0, 0.0), (5e-4, 4.5, 6e3), (0.0, 0.0, 12e3)] {
        let found = at(pascal);
        assert!((found[0] - value).abs() < 1e-12, "{pascal}: {found:?}");
        assert!((found[1] - slope).abs() < 1e-8, "{pascal}: {found:?}");
    }
}

/// Hematite, magnetite, wustite and iron in hydrogen, by grains.
fn ore(one_way: bool) -> Radial {
    let names = ["Fe2O3", "Fe3O4", "FeO", "Fe"];
    let solids = names
        .map(|name| SolidSpecies::built_in(name).unwrap())
        .to_vec();
    let gas = Mixture::new(["H2", "H2O", "N2"]).unwrap();
    let reaction = |name: &str, solids_of: [(usize, f64); 2], (factor, energy): (f64, f64)| {
        let change = |t: f64| {
            let parts = solids_of
                .iter()
                .map(|&(s, n)| n * solids[s].gibbs_energy(t));
            let species = gas.species();
            parts.sum::<f64>() + species[1].polynomial().gibbs_energy(t)
                - species[0].polynomial().gibbs_energy(t)
        };
        Reaction {
            name: name.into(),
            solids: solids_of.to_vec(),
            gases: vec![(0, -1.0), (1, 1.0)],
            rate: Rate::Conversion {
                rate_constant: Arrhenius {
                    factor,
                    exponent: 0.0,
                    activation_energy: energy,
                },
                conversion: Conversion::ContractingVolume(ContractingVolume),
                gases: vec![(0, 1.0)],
            },
            equilibrium: match one_way {
                true => Equilibrium::OneWay,
                false => Equilibrium::Gibbs(GibbsLine::new(change)),
            },
        }
    };
    let reactions = vec![
        reaction("hematite", [(0, -3.0), (1, 2.0)], (730.0, 92_092.0)),
        reaction("magnetite", [(1, -1.0), (2, 3.0)], (48.7, 71_162.0)),
        reaction("wustite", [(2, -1.0), (3, 1.0)], (18.1, 63_627.0)),
    ];
    let chemistry = SolidChemistry::new(solids.clone(), Some(gas.clone()), reactions).unwrap();
    let pores = PoreGas {
        pressure: 101_325.0,
        fractions: vec![0.6, 0.02, 0.38],
    };
    let solid = porous(&[5250.0, 5180.0, 5700.0, 7870.0], 1.5);
    let start = [1.0, 0.0, 0.0, 0.0];
    Radial::new(
        chemistry,
        &start,
        solid,
        pores,
        RadialNumerics::new(grid(30)),
    )
    .unwrap()
}

#[test]
fn ore_whose_oxides_follow_each_other_is_reduced() {
    for one_way in [true, false] {
        let mut model = ore(one_way);
        let radius = 6e-3;
        put(&mut model, radius, 3500.0, 1173.0, 1);
        let gas = Mixture::new(["H2", "H2O", "N2"]).unwrap();
        let still = Still {
            temperature: 1173.0,
            pressure: 101_325.0,
            composition: gas.mass_fractions(&[0.6, 0.02, 0.38]),
            conductance: 150.0 * sphere::surface(radius),
            film: 0.15,
            network: 0.0,
        };
        let (mut before, windows) = (0, 150);
        for _ in 0..windows {
            window(&mut model, &still, radius, 10.0);
            let steps = model.work()[0];
            assert!(steps - before < 200, "{one_way}: {}", steps - before);
            before = steps;
        }
        let found = model.conversion(model.row(0), None);
        assert!(found > 0.99, "{one_way}: {found}");
    }
}
