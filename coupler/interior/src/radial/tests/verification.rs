//! Exact solutions (requirements XDP-10 to XDP-13, XDP-15; XDP-14 is in the physics of the dusty gas).

use calcine_physics::gas::GAS_CONSTANT;
use calcine_physics::pores::Permeability;
use calcine_physics::reaction::{Arrhenius, Equilibrium, PowerLaw};
use calcine_physics::solid::HeatCapacity;
use calcine_physics::solids::SolidSpecies;
use calcine_physics::sphere;
use calcine_physics::thermo::Mixture;

use super::support::*;
use crate::radial::{PoreGas, PorousSolid, Radial, RadialNumerics, ShellGrading, ShellGrid};
use crate::reacting::{Rate, Reaction, SolidChemistry};

pub const RADIUS: f64 = 10e-3;

/// Centre, surface and mean of a sphere that is cooled, at Fo = 0.2.
fn cooled(biot: f64, shells: usize, steps: usize) -> [f64; 3] {
    let (density, capacity, conductivity) = (2000.0, 1000.0, 1.0);
    let mut model = inert(density, capacity, conductivity, one_step(grid(shells)));
    put(&mut model, RADIUS, density, 400.0, 1);
    let still = Still {
        temperature: 300.0,
        pressure: 1e5,
        composition: Vec::new(),
        conductance: biot * conductivity / RADIUS * sphere::surface(RADIUS),
        film: 0.0,
        network: 0.0,
    };
    let end = 0.2 * RADIUS * RADIUS * density * capacity / conductivity;
    for _ in 0..steps {
        window(&mut model, &still, RADIUS, end / steps as f64);
    }
    let row = model.row(0);
    let mean: f64 = (0..shells)
        .map(|k| model.share(row, k) * model.shell_temperature(row, k))
        .sum();
    let all = [model.shell_temperature(row, 0), row[0], mean];
    all.map(|kelvin| (kelvin - 300.0) / 100.0)
}

#[test]
fn a_sphere_in_gas_cools_as_its_series_has_it() {
    // Requirements XDP-10: centre, surface, mean.
    for (biot, exact) in [
        (1.0, [0.772_312, 0.495_912, 0.601_810]),
        (10.0, [0.382_664, 0.041_055, 0.152_439]),
    ] {
        let found = cooled(biot, 40, 100);
        for (one, other) in found.iter().zip(exact) {
            assert!((one - other).abs() < 1e-3, "{biot}: {found:?}");
        }
    }
}

#[test]
fn conduction_is_of_second_order_in_shells_and_in_steps() {
    let exact = [0.601_810_f64, 0.495_912];
    let off = |shells: usize, steps: usize| {
        let [_, surface, mean] = cooled(1.0, shells, steps);
        [(mean - exact[0]).abs(), (surface - exact[1]).abs()]
    };
    let (coarse, fine) = (off(5, 400), off(10, 400));
    for (coarse, fine) in coarse.iter().zip(fine) {
        let order = (coarse / fine).log2();
        assert!(order > 1.85, "shells: {order}");
    }
    // In steps against many of them, by what both have in common in space.
    let fine = cooled(1.0, 20, 640);
    let off = |steps: usize| (cooled(1.0, 20, steps)[2] - fine[2]).abs();
    let order = (off(10) / off(20)).log2();
    assert!(order > 1.85, "steps: {order}");
}

/// A pellet of one solid in two gases of about one mass, of which the first, dilute, becomes the second.
pub fn pellet(
    rate: Rate,
    solids: Vec<(usize, f64)>,
    porous: PorousSolid,
    grid: ShellGrid,
) -> Radial {
    let two = ["one", "other"].map(|name| {
        SolidSpecies::new(name, "C", 0.0, 1.0, HeatCapacity::constant(1000.0)).unwrap()
    });
    let reaction = Reaction {
        name: "in pores".into(),
        solids,
        gases: vec![(0, -1.0), (1, 1.0)],
        rate,
        equilibrium: Equilibrium::OneWay,
    };
    let gas = Mixture::new(["CO", "N2"]).unwrap();
    let chemistry = SolidChemistry::new(two.to_vec(), Some(gas), vec![reaction]).unwrap();
    let pores = PoreGas {
        pressure: 1e5,
        fractions: vec![DILUTE, 1.0 - DILUTE],
    };
    let numerics = RadialNumerics {
        temperature: 100.0,
        conversion: 1e-3,
        ..RadialNumerics::new(grid)
    };
    Radial::new(chemistry, &[1.0, 0.0], porous, pores, numerics).unwrap()
}

/// k c of the first gas, in mol/m³/s.
pub fn first_order(k: f64) -> Rate {
    Rate::Power(PowerLaw {
        rate_constant: Arrhenius {
            factor: k,
            exponent: 0.0,
            activation_energy: 0.0,
        },
        in_series: None,
        solids: Vec::new(),
        gases: vec![(0, 1.0)],
    })
}

pub const DILUTE: f64 = 1e-4;
pub const KELVIN: f64 = 800.0;

/// Wide pores, ε/τ = 0.25.
pub fn wide() -> PorousSolid {
    PorousSolid {
        pore_diameter: 1.0,
        permeability: Permeability::Constant(1e-8),
        ..porous(&[4000.0, 4000.0], 1e4)
    }
}

pub fn diffusivity() -> f64 {
    let gas = Mixture::new(["CO", "N2"]).unwrap();
    0.25 * gas.pair_diffusivity((0, 1), 1e5, KELVIN)
}

/// Gas about it, with a Biot number of the film.
pub fn dilute_gas(biot: f64) -> Still {
    Still {
        temperature: KELVIN,
        pressure: 1e5,
        composition: Mixture::new(["CO", "N2"])
            .unwrap()
            .mass_fractions(&[DILUTE, 1.0 - DILUTE]),
        conductance: 1e3,
        film: biot * diffusivity() / RADIUS,
        network: 0.0,
    }
}

#[test]
fn a_catalyst_sphere_has_the_effectiveness_of_its_thiele_number() {
    // Requirements XDP-11.
    for (thiele, biot, exact) in [
        (1.0, 1e7, 0.939_106),
        (5.0, 1e7, 0.480_054),
        (10.0, 1e7, 0.270_000),
        (30.0, 1e7, 0.096_667),
        (5.0, 10.0, 0.342_885),
    ] {
        let k = thiele * thiele * diffusivity() / (RADIUS * RADIUS);
        let rate = first_order(k);
        let graded = ShellGrid {
            shells: 40,
            grading: ShellGrading::Thiele(thiele),
        };
        let mut model = pellet(rate, Vec::new(), wide(), graded);
        put(&mut model, RADIUS, 2000.0, KELVIN, 1);
        let still = dilute_gas(biot);
        let mut passed = Vec::new();
        for _ in 0..10 {
            passed = window(&mut model, &still, RADIUS, 1e4);
        }
        let concentration = DILUTE * 1e5 / (GAS_CONSTANT * KELVIN);
        let full = k * concentration * sphere::volume(RADIUS) * 1e4;
        let found = -passed[0] / full;
        assert!(
            (found / exact - 1.0).abs() < 1e-3,
            "{thiele} {biot}: {found}"
        );
    }
}

#[test]
fn a_solid_whose_gas_diffuses_in_is_used_up_as_ishida_and_wen_have_it() {
    // Requirements XDP-12: conversion at the end of the first stage, times of that and of the end over τ = c_solid/(k c_gas).
    for (biot, first, full) in [(1e7, 1.0, 2.666_667), (10.0, 1.217_363, 3.0)] {
        let k = 10.0 * diffusivity() / (RADIUS * RADIUS);
        let rate = first_order(k);
        let solids = vec![(0, -1.0), (1, 1.0)];
        let mut model = pellet(rate, solids, wide(), grid(40));
        put(&mut model, RADIUS, 2000.0, KELVIN, 1);
        let still = dilute_gas(biot);
        let solid = 2000.0 / 0.012_011;
        let time = solid / (k * DILUTE * 1e5 / (GAS_CONSTANT * KELVIN));
        let steps = 100;
        let span = first * time / f64::from(steps);
        let mut now = 0.0;
        for _ in 0..steps {
            window(&mut model, &still, RADIUS, span);
            now += span;
        }
        let found = model.conversion(model.row(0), None);
        if biot > 100.0 {
            assert!((found - 0.652_089).abs() < 1e-3, "{found}");
        }
        let surface = model.conversion(model.row(0), Some(39));
        assert!(surface > 0.97, "{surface}");
        while model.conversion(model.row(0), None) < 1.0 - 1e-5 {
            window(&mut model, &still, RADIUS, span);
            now += span;
            assert!(now < 4.0 * time);
        }
        assert!((now / time / full - 1.0).abs() < 0.01, "{}", now / time);
    }
}

#[test]
fn a_gas_that_is_made_in_pores_has_the_pressure_of_darcy_s_law() {
    // Requirements XDP-13: p_c² = p_s² + s μ R T R²/(3 M K).
    let solids = ["CaCO3", "CaO"].map(|name| SolidSpecies::built_in(name).unwrap());
    let gas = Mixture::new(["CO2"]).unwrap();
    let molar = gas.species()[0].molar_mass();
    let (kelvin, radius, permeability, source) = (1150.0, 5e-3, 1e-15, 1.0);
    let viscosity = gas.viscosity(kelvin, &[1.0]);
    let reaction = Reaction {
        name: "source".into(),
        solids: vec![(0, -1.0), (1, 1.0)],
        gases: vec![(0, 1.0)],
        rate: Rate::Power(PowerLaw {
            rate_constant: Arrhenius {
                factor: source / molar,
                exponent: 0.0,
                activation_energy: 0.0,
            },
            in_series: None,
            solids: Vec::new(),
            gases: Vec::new(),
        }),
        equilibrium: Equilibrium::OneWay,
    };
    let chemistry = SolidChemistry::new(solids.to_vec(), Some(gas), vec![reaction]).unwrap();
    let solid = PorousSolid {
        pore_diameter: 1e-15,
        permeability: Permeability::Constant(permeability),
        ..porous(&[2711.0, 3340.0], 1e6)
    };
    let pores = PoreGas {
        pressure: 101_325.0,
        fractions: vec![1.0],
    };
    let mut model = Radial::new(
        chemistry,
        &[1.0, 0.0],
        solid,
        pores,
        RadialNumerics::new(grid(40)),
    )
    .unwrap();
    put(&mut model, radius, LIME_DENSITY, kelvin, 1);
    let still = Still {
        temperature: kelvin,
        pressure: 101_325.0,
        composition: vec![1.0],
        conductance: 1e6,
        film: 1.0,
        network: 0.0,
    };
    for _ in 0..5 {
        window(&mut model, &still, radius, 2.0);
    }
    let rise =
        source * viscosity * GAS_CONSTANT * kelvin * radius * radius / (3.0 * molar * permeability);
    let exact = (101_325.0_f64.powi(2) + rise).sqrt();
    let found = model.shell_pressure(model.row(0), 0);
    assert!((found / exact - 1.0).abs() < 1e-3, "{found} {exact}");
    // The requirement's own figure, with its viscosity.
    let stated = (101_325.0_f64.powi(2) + rise * 4.5e-5 / viscosity).sqrt();
    assert!((stated / 302_885.0 - 1.0).abs() < 1e-3, "{stated}");
}

/// Density in kg/m³, heat in J/kg, conductivity in W/m/K and temperature in K of a front that heat limits, in a particle without heat capacity.
pub const FRONT: [f64; 4] = [2700.0, 1.7e6, 0.6, 1000.0];

/// Such a particle in gas 200 K hotter, of a Biot number.
pub fn front(biot: f64, numerics: RadialNumerics) -> (Radial, Still) {
    let [density, latent, conductivity, at_rest] = FRONT;
    let molar = 0.012_011;
    let made = |name, formation| {
        SolidSpecies::new(name, "C", formation, 1.0, HeatCapacity::constant(0.01)).unwrap()
    };
    let solids = vec![made("raw", 0.0), made("burnt", latent * molar)];
    let reaction = Reaction {
        name: "front".into(),
        solids: vec![(0, -1.0), (1, 1.0)],
        gases: Vec::new(),
        rate: Rate::Power(PowerLaw {
            rate_constant: Arrhenius {
                factor: 1e3,
                exponent: 0.0,
                activation_energy: 0.0,
            },
            in_series: None,
            solids: vec![(0, 1.0)],
            gases: Vec::new(),
        }),
        // At rest at the temperature of the front.
        equilibrium: Equilibrium::Line {
            constant: 20.0,
            over_temperature: -20.0 * at_rest,
        },
    };
    let chemistry = SolidChemistry::new(solids, None, vec![reaction]).unwrap();
    let solid = porous(&[5400.0, 5400.0], conductivity);
    let mut model =
        Radial::new(chemistry, &[1.0, 0.0], solid, PoreGas::default(), numerics).unwrap();
    put(&mut model, RADIUS, density, at_rest - 1e-3, 1);
    let still = Still {
        temperature: at_rest + 200.0,
        pressure: 1e5,
        composition: Vec::new(),
        conductance: biot * conductivity / RADIUS * sphere::surface(RADIUS),
        film: 0.0,
        network: 0.0,
    };
    (model, still)
}

#[test]
fn a_front_that_heat_limits_goes_as_its_law_has_it() {
    // Requirements XDP-15: t = ρ L R² (1 + 2/Bi)/(6 k ΔT), without heat capacity.
    for (biot, exact) in [(1e6, 637.5), (5.0, 892.5)] {
        let numerics = RadialNumerics {
            temperature: 5.0,
            ..RadialNumerics::new(grid(40))
        };
        let (mut model, still) = front(biot, numerics);
        let span = exact / 200.0;
        let mut now = 0.0;
        while model.conversion(model.row(0), None) < 1.0 - 1e-5 {
            window(&mut model, &still, RADIUS, span);
            now += span;
            assert!(
                now < 2.0 * exact,
                "{}",
                model.conversion(model.row(0), None)
            );
        }
        assert!((now / exact - 1.0).abs() < 0.01, "{biot}: {now}");
    }
}

#[test]
fn a_gas_that_stands_in_the_pores_is_swept_as_stefan_has_it() {
    // A gas that is made evenly, s, flows out by s r/3; another one does not flow: x = x_s exp(-s (R² - r²)/(6 c D)) (Bird, Stewart and
    // Lightfoot, Transport Phenomena, 2nd ed. (2002), section 18.2, for a sphere).
    for (number, shells) in [(2.0, 5), (2.0, 20), (12.0, 20), (12.0, 40)] {
        let moles = 1e5 / (GAS_CONSTANT * KELVIN);
        let source = 6.0 * number * moles * diffusivity() / (RADIUS * RADIUS);
        let rate = Rate::Power(PowerLaw {
            rate_constant: Arrhenius {
                factor: source,
                exponent: 0.0,
                activation_energy: 0.0,
            },
            in_series: None,
            solids: Vec::new(),
            gases: Vec::new(),
        });
        let even = grid(shells);
        let mut model = pellet(rate, vec![(0, -1.0), (1, 1.0)], wide(), even);
        model.physics.gas_moles[..2].copy_from_slice(&[1.0, 0.0]);
        model.physics.chemistry.reactions[0].gases = vec![(0, 1.0)];
        model.physics.ends_with[0].clear();
        put(&mut model, RADIUS, 2000.0, KELVIN, 1);
        let outside = 0.5;
        let gas = Mixture::new(["CO", "N2"]).unwrap();
        let still = Still {
            composition: gas.mass_fractions(&[1.0 - outside, outside]),
            ..dilute_gas(1e7)
        };
        for _ in 0..20 {
            window(&mut model, &still, RADIUS, 1.0);
        }
        let row = model.row(0);
        let squares = crate::radial::grid::mean_squares(&even.shares());
        for (k, square) in squares.iter().enumerate() {
            let own = model.shell_gas(row, k);
            let found = own[1] / (own[0] + own[1]);
            // What the made gas brings warms the particle, and c D goes with T^0.75.
            let warm = 0.5 * (model.shell_temperature(row, k) + row[0]) / KELVIN;
            let own_number = number / warm.powf(0.75);
            let exact = outside * f64::exp(-own_number * (1.0 - square));
            assert!(
                (found / exact).ln().abs() < 1e-4,
                "{number} {shells} {k}: {found} {exact}"
            );
        }
    }
}
