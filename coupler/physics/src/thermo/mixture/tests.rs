//! What holds of every mixture, and figures of some.

use proptest::prelude::*;

use super::*;
use crate::gas::GasProperties;

/// Mass fractions of the flue gas of N2, O2, CO2, H2O at which the independent values are taken.
const FLUE: [f64; 4] = [0.68, 0.05, 0.2, 0.07];

fn flue() -> Mixture {
    Mixture::new(["N2", "O2", "CO2", "H2O"]).unwrap()
}

fn all() -> Mixture {
    Mixture::new(Species::built_in_names()).unwrap()
}

fn close(value: f64, expected: f64) {
    assert!(
        (value / expected - 1.0).abs() < 1e-12,
        "{value:e} for {expected:e}"
    );
}

#[test]
fn flue_gas_agrees_with_an_independent_evaluation_at_900_k_and_1_2_bar() {
    // In Python, from the equations of the docs.
    let gas = flue();
    close(gas.molar_mass(&FLUE), 0.029183148223469527);
    close(gas.density(1.2e5, 900.0, &FLUE), 0.4679901285949755);
    close(gas.heat_capacity(900.0, &FLUE), 1229.4980576896435);
    close(gas.enthalpy(900.0, &FLUE), 685038.022984106);
    close(gas.formation_enthalpy(&FLUE), -2727951.881480394);
    close(gas.viscosity(900.0, &FLUE), 3.872226438162821e-5);
    close(gas.conductivity(900.0, &FLUE), 0.06861101562782591);
    let mut moles = [0.0; 4];
    gas.mole_fractions(&FLUE, &mut moles);
    close(moles[3], 0.11339552459854937);
    let mut diffusivities = [0.0; 4];
    gas.diffusivities(1.2e5, 900.0, &FLUE, &mut diffusivities);
    for (d, expected) in diffusivities.into_iter().zip([
        1.0912490139670703e-4,
        1.1859293653573087e-4,
        9.734437388779378e-5,
        1.4515133054342376e-4,
    ]) {
        close(d, expected);
    }
}

#[test]
fn elements_of_flue_gas_agree_with_an_independent_evaluation() {
    let fractions = flue().element_fractions(&FLUE);
    for (z, expected) in fractions.into_iter().zip([
        0.007833472106577852,
        0.054584289577131954,
        0.68,
        0.2575822383162902,
    ]) {
        close(z, expected);
    }
    assert_eq!(fractions[Element::Ar as usize], 0.0);
}

#[test]
fn air_has_the_properties_of_the_tables() {
    // Incropera, Fundamentals of Heat and Mass Transfer, table A.4; the conductivity of the modified
    // Eucken relation is on the high side.
    let (air, y) = Mixture::air().unwrap();
    assert!((air.molar_mass(&y) - 28.964e-3).abs() < 0.005e-3);
    for (t, c_p, mu, kappa) in [
        (300.0, 1007.0, 184.6e-7, 26.3e-3),
        (400.0, 1014.0, 230.1e-7, 33.8e-3),
        (600.0, 1051.0, 305.8e-7, 46.9e-3),
        (1000.0, 1141.0, 424.4e-7, 66.7e-3),
    ] {
        let transport = air.transport(t, &y);
        assert!((air.heat_capacity(t, &y) / c_p - 1.0).abs() < 0.003, "{t}");
        assert!(
            (transport.viscosity / mu - 1.0).abs() < 0.016,
            "{t}: {transport:?}"
        );
        assert!(
            (transport.conductivity / kappa - 1.0).abs() < 0.056,
            "{t}: {transport:?}"
        );
    }
}

#[test]
fn air_of_three_species_is_close_to_air_of_one_at_room_temperature() {
    let (air, y) = Mixture::air().unwrap();
    let single = GasProperties::air();
    let ratio = air.density(1e5, 300.0, &y) / single.density(1e5, 300.0);
    assert!((ratio - 1.0).abs() < 2e-4, "{ratio}");
    assert!((air.heat_capacity(300.0, &y) / single.heat_capacity - 1.0).abs() < 0.003);
    assert!((air.viscosity(300.0, &y) / single.viscosity(300.0) - 1.0).abs() < 0.01);
}

#[test]
fn measured_diffusivities_in_air_are_met_within_7_percent() {
    // CRC Handbook of Chemistry and Physics, "Diffusion in gases", 101325 Pa: cm²/s at 293.15 and 673.15 K.
    for (name, cold, hot) in [
        ("CO2", 0.160, 0.728),
        ("H2O", 0.242, 1.135),
        ("H2", 0.756, 3.238),
        ("CH4", 0.210, 0.899),
        ("CO", 0.208, 0.875),
    ] {
        let gas = Mixture::new(["N2", "O2", name]).unwrap();
        let y = gas.mass_fractions(&[0.79, 0.21, 0.0]);
        for (t, measured) in [(293.15, cold), (673.15, hot)] {
            let mut d = [0.0; 3];
            gas.diffusivities(101_325.0, t, &y, &mut d);
            let (d, wide) = (1e4 * d[2], if name == "CO2" { 0.08 } else { 0.06 });
            assert!((d / measured - 1.0).abs() < wide, "{name} {t}: {d}");
        }
    }
}

#[test]
fn a_mixture_of_one_species_is_that_species() {
    for name in Species::built_in_names() {
        let (gas, one) = (
            Mixture::new([name]).unwrap(),
            Species::built_in(name).unwrap(),
        );
        for t in [300.0, 1700.0] {
            close(gas.viscosity(t, &[1.0]), one.viscosity(t));
            close(gas.conductivity(t, &[1.0]), one.conductivity(t));
            close(gas.heat_capacity(t, &[1.0]), one.heat_capacity(t));
            let mut d = [0.0];
            gas.diffusivities(1e5, t, &[1.0], &mut d);
            close(d[0], gas.pair_diffusivity((0, 0), 1e5, t));
        }
        close(gas.molar_mass(&[1.0]), one.molar_mass());
    }
}

#[test]
fn mixtures_that_cannot_be_are_refused() {
    let message = |error: ThermoError| error.to_string();
    let none = message(Mixture::new([]).unwrap_err());
    assert_eq!(none, "a mixture of 0 species; it needs 1 to 32");
    let twice = message(Mixture::new(["N2", "O2", "N2"]).unwrap_err());
    assert_eq!(twice, "the species N2 stands twice");
    let unknown = message(Mixture::new(["N2", "Xe"]).unwrap_err());
    assert!(
        unknown.starts_with("the species Xe is not built in; there are N2, O2"),
        "{unknown}"
    );
    let n2 = Species::built_in("N2").unwrap();
    let crowd = (0..33).map(|k| {
        let name = format!("N2 {k}");
        Species::new(&name, *n2.atoms(), *n2.polynomial(), *n2.sutherland(), 18.5)
    });
    let crowd: Result<Vec<_>, _> = crowd.collect();
    let crowd = message(Mixture::of(crowd.unwrap()).unwrap_err());
    assert_eq!(crowd, "a mixture of 33 species; it needs 1 to 32");
}

#[test]
fn an_enthalpy_that_no_gas_has_is_refused() {
    let gas = flue();
    let message = gas.temperature(1e9, &FLUE, 300.0).unwrap_err().to_string();
    assert!(
        message.contains("from 1 K to 20000 K has the enthalpy 1000000000 J/kg"),
        "{message}"
    );
    assert!(gas.temperature(f64::NAN, &FLUE, 300.0).is_err());
}

#[test]
fn a_solver_may_pass_the_polynomials_range_and_come_back() {
    let gas = flue();
    assert_eq!(gas.range(), (200.0, 6000.0));
    for t in [20.0, 150.0, 7000.0] {
        for guess in [100.0, 300.0, 6500.0] {
            let found = gas
                .temperature(gas.enthalpy(t, &FLUE), &FLUE, guess)
                .unwrap();
            assert!((found / t - 1.0).abs() < 1e-12, "{t} from {guess}: {found}");
        }
    }
    assert_eq!(gas.enthalpy(298.15, &FLUE), 0.0);
}

#[test]
fn the_elements_of_a_unit_mass_sum_to_one_for_each_species() {
    let gas = Mixture::new(["CH4", "O2", "CO2", "H2O"]).unwrap();
    let elements = gas.elements();
    let symbols: Vec<_> = elements.iter().map(|(symbol, _)| symbol.as_str()).collect();
    assert_eq!(symbols, ["H", "C", "O"]);
    for k in 0..4 {
        let sum: f64 = elements.iter().map(|(_, shares)| shares[k]).sum();
        assert!((sum - 1.0).abs() < 1e-15, "{k}: {sum}");
    }
    close(elements[1].1[0], 12.011 / 16.043);
}

#[test]
fn the_slope_of_the_heat_capacity_is_the_difference_quotient() {
    let gas = flue();
    for t in [300.0, 800.0, 1500.0] {
        let quotient =
            (gas.heat_capacity(t + 0.1, &FLUE) - gas.heat_capacity(t - 0.1, &FLUE)) / 0.2;
        let slope = gas.heat_capacity_slope(t, &FLUE);
        assert!(
            (slope - quotient).abs() < 1e-6 * gas.heat_capacity(t, &FLUE) / t,
            "{t}"
        );
    }
}

/// Mass fractions of the eight built-in species, some of them absent.
fn compositions() -> impl Strategy<Value = Vec<f64>> {
    let amount = prop_oneof![1 => Just(0.0), 3 => 1e-6..1.0f64];
    proptest::collection::vec(amount, 8)
        .prop_filter("an empty gas", |amounts| amounts.iter().any(|y| *y > 0.0))
        .prop_map(|amounts| {
            let total: f64 = amounts.iter().sum();
            amounts.iter().map(|y| y / total).collect()
        })
}

proptest! {
    #[test]
    fn every_property_is_positive_and_about_within_those_of_its_species(
        y in compositions(), t in 200.0..6000.0f64,
    ) {
        let gas = all();
        let present = || gas.species().iter().zip(&y).filter(|(_, y)| **y > 0.0).map(|(s, _)| s);
        let least = |of: &dyn Fn(&Species) -> f64| present().map(of).fold(f64::INFINITY, f64::min);
        let most = |of: &dyn Fn(&Species) -> f64| present().map(of).fold(0.0, f64::max);
        let transport = gas.transport(t, &y);
        prop_assert_eq!(transport.viscosity, gas.viscosity(t, &y));
        for (value, of, below, above) in [
            (gas.molar_mass(&y), &Species::molar_mass as &dyn Fn(&Species) -> f64, 1e-12, 1e-12),
            (gas.heat_capacity(t, &y), &|one| one.heat_capacity(t), 1e-12, 1e-12),
            // Light and heavy gases together can be more viscous than either (7.7 % in 60 000 draws in
            // Python), and pass the conductivities of both a little (0.08 % down, 0.4 % up).
            (transport.viscosity, &|one| one.viscosity(t), 1e-12, 0.15),
            (transport.conductivity, &|one| one.conductivity(t), 0.01, 0.03),
        ] {
            prop_assert!(value >= least(of) * (1.0 - below), "{} {}", value, least(of));
            prop_assert!(value <= most(of) * (1.0 + above), "{} {}", value, most(of));
        }
        let mut d = vec![0.0; 8];
        gas.diffusivities(1e5, t, &y, &mut d);
        let pairs = (0..64).map(|k| gas.pair_diffusivity((k / 8, k % 8), 1e5, t));
        let (slowest, fastest) = pairs.fold((f64::INFINITY, 0.0f64), |(low, high), d| {
            (low.min(d), high.max(d))
        });
        for d in d {
            prop_assert!(d >= slowest * (1.0 - 1e-12) && d <= fastest * (1.0 + 1e-12), "{}", d);
        }
    }

    #[test]
    fn temperature_is_the_inverse_of_enthalpy(
        y in compositions(), t in 200.0..6000.0f64, guess in 200.0..6000.0f64,
    ) {
        let gas = all();
        let found = gas.temperature(gas.enthalpy(t, &y), &y, guess).unwrap();
        prop_assert!((found / t - 1.0).abs() < 1e-12, "{} {}", t, found);
    }

    #[test]
    fn mole_and_mass_fractions_are_inverse_and_elements_sum_to_one(y in compositions()) {
        let gas = all();
        let mut x = vec![0.0; 8];
        gas.mole_fractions(&y, &mut x);
        let back = gas.mass_fractions(&x);
        prop_assert!((x.iter().sum::<f64>() - 1.0).abs() < 1e-14);
        for (y, back) in y.iter().zip(&back) {
            prop_assert!((y - back).abs() < 1e-15);
        }
        let elements = gas.element_fractions(&y);
        prop_assert!((elements.iter().sum::<f64>() - 1.0).abs() < 1e-14);
    }

    #[test]
    fn hotter_gas_is_more_viscous_conducts_better_and_diffuses_faster(
        y in compositions(), t in 200.0..5900.0f64,
    ) {
        let gas = all();
        let at = |t| {
            let mut d = [0.0; 8];
            gas.diffusivities(1e5, t, &y, &mut d);
            let transport = gas.transport(t, &y);
            [transport.viscosity, transport.conductivity, d[0], d[7]]
        };
        for (cold, hot) in at(t).into_iter().zip(at(t + 100.0)) {
            prop_assert!(hot > cold, "{} {}", cold, hot);
        }
    }
}
