//! What particles with shells become where conduction and diffusion are fast, or reactions are.

use calcine_physics::gas::GAS_CONSTANT;
use calcine_physics::reaction::{Arrhenius, Equilibrium, PowerLaw};
use calcine_physics::solid::HeatCapacity;
use calcine_physics::solids::SolidSpecies;
use calcine_physics::sphere;

use super::support::*;
use super::verification::{DILUTE, KELVIN, RADIUS, diffusivity, dilute_gas, pellet, wide};
use crate::model::{At, GasLines, NetworkHeat, ParticleModel, Transfer};
use crate::radial::{PoreGas, Radial, RadialNumerics};
use crate::reacting::{Rate, Reacting, Reaction, SolidChemistry};

fn power(rate_constant: Arrhenius, solids: Vec<(usize, f64)>, gases: Vec<(usize, f64)>) -> Rate {
    Rate::Power(PowerLaw {
        rate_constant,
        in_series: None,
        solids,
        gases,
    })
}

#[test]
fn with_fast_reactions_they_are_a_shrinking_core() {
    // All resistance in the layer of the product: t = c_s R²/(6 D c_g) (Levenspiel, Chemical Reaction Engineering, 3rd ed., eq. 25.17).
    let thiele_squared = 1e4;
    let k = thiele_squared * diffusivity() / (RADIUS * RADIUS);
    let constant = Arrhenius {
        factor: k,
        exponent: 0.0,
        activation_energy: 0.0,
    };
    let rate = power(constant, Vec::new(), vec![(0, 1.0)]);
    let mut model = pellet(rate, vec![(0, -1.0), (1, 1.0)], wide(), grid(60));
    put(&mut model, RADIUS, 2000.0, KELVIN, 1);
    let still = dilute_gas(1e7);
    let concentration = DILUTE * 1e5 / (GAS_CONSTANT * KELVIN);
    let exact = 2000.0 / 0.012_011 * RADIUS * RADIUS / (6.0 * diffusivity() * concentration);
    let span = exact / 500.0;
    let mut now = 0.0;
    while model.conversion(model.row(0), None) < 1.0 - 1e-5 {
        window(&mut model, &still, RADIUS, span);
        now += span;
        assert!(now < 2.0 * exact);
    }
    assert!((now / exact - 1.0).abs() < 0.005, "{}", now / exact);
}

/// A solid that takes up heat as it reacts, by its temperature alone.
pub fn raw() -> SolidChemistry {
    let made = |name, formation| {
        SolidSpecies::new(name, "C", formation, 1.0, HeatCapacity::constant(1000.0)).unwrap()
    };
    let reaction = Reaction {
        name: "inside".into(),
        solids: vec![(0, -1.0), (1, 1.0)],
        gases: Vec::new(),
        rate: power(
            Arrhenius {
                factor: 1e7,
                exponent: 0.0,
                activation_energy: 150e3,
            },
            vec![(0, 1.0)],
            Vec::new(),
        ),
        equilibrium: Equilibrium::OneWay,
    };
    SolidChemistry::new(
        vec![made("raw", 0.0), made("burnt", 5e3)],
        None,
        vec![reaction],
    )
    .unwrap()
}

#[test]
fn with_fast_conduction_they_are_thin() {
    let still = Still {
        temperature: 1200.0,
        pressure: 1e5,
        composition: Vec::new(),
        conductance: 50.0 * sphere::surface(RADIUS),
        film: 0.0,
        network: 0.0,
    };
    let (density, span) = (2000.0, 5.0);
    let numerics = RadialNumerics {
        temperature: 0.05,
        conversion: 1e-5,
        ..RadialNumerics::new(grid(10))
    };
    let solid = porous(&[4000.0; 2], 1e5);
    let mut shells = Radial::new(raw(), &[1.0, 0.0], solid, PoreGas::default(), numerics).unwrap();
    put(&mut shells, RADIUS, density, 600.0, 1);
    let mut thin = Reacting::new(raw(), &[1.0, 0.0]);
    let state: [(&str, &[f64]); 1] = [(crate::TEMPERATURE, &[600.0])];
    let one = crate::Newcomer {
        id: 1,
        mass: sphere::mass(RADIUS, density),
        radius: RADIUS,
        state: &state,
    };
    thin.change(&[], &[one]).unwrap();
    let all = thin.amounts()[0];
    let mut times = [0.0; 2];
    for window_index in 1..400 {
        window(&mut shells, &still, RADIUS, span);
        let lists = Lists::of(&still, RADIUS, 1);
        let mut lines = GasLines::default();
        lines.reset(1, 0);
        thin.respond(
            &still.around(&lists),
            span,
            &[NetworkHeat::default()],
            &mut lines,
        )
        .unwrap();
        let heat = [lines.conductance[0] * (still.temperature - lines.temperature[0])];
        let took = Transfer {
            heat: &heat,
            network: &[0.0],
            carried: &[0.0],
            rates: &[],
        };
        thin.settle(&took, span).unwrap();
        thin.commit();
        let now = f64::from(window_index) * span;
        let converted = [
            shells.conversion(shells.row(0), None),
            1.0 - thin.amounts()[0] / all,
        ];
        for (time, x) in times.iter_mut().zip(converted) {
            if x < 0.99 {
                *time = now;
            }
        }
        let kelvin = [
            shells.bodies(At::Commit).temperature[0],
            thin.bodies(At::Commit).temperature[0],
        ];
        assert!((kelvin[0] - kelvin[1]).abs() < 0.5, "{now}: {kelvin:?}");
        assert!(
            (converted[0] - converted[1]).abs() < 2e-3,
            "{now}: {converted:?}"
        );
    }
    assert!(
        (times[0] - times[1]).abs() <= 0.005 * times[1] && times[1] > 0.0,
        "{times:?}"
    );
}
