//! Particles that dry and give off volatiles, against balances of their own and closed forms (docs/theory.md, DRY, DEV).

use std::f64::consts::PI;

use calcine_physics::film::{FilmCoefficient, FilmTheory, StefanFlow, bernoulli};
use calcine_physics::moisture::WetSurface;
use calcine_physics::moisture::antoine::{boiling_temperature, vapour_pressure};
use calcine_physics::moisture::bound_water::sorption_heat_ratio;
use calcine_physics::moisture::isotherm::equilibrium_moisture;
use calcine_physics::reaction::{Arrhenius, Devolatilisation, Equilibrium, Evaporation};
use calcine_physics::solid::HeatCapacity;
use calcine_physics::solids::SolidSpecies;
use calcine_physics::thermo::Mixture;

use super::*;
use crate::reacting::drying::LEAST_OTHER;
use crate::reacting::passage::ParticleSurroundings;
use crate::reacting::{Rate, Reaction, SizeChange};

const PRESSURE: f64 = 101_325.0;
const GASES: [&str; 3] = ["O2", "H2O", "N2"];
const WATER: f64 = 18.015e-3;
fn wood() -> SolidSpecies {
    SolidSpecies::inert("wood", HeatCapacity::constant(1500.0))
}

fn drying(law: Evaporation, equilibrium: Equilibrium) -> SolidChemistry {
    let reaction = Reaction {
        name: "drying".into(),
        solids: vec![(1, -1.0)],
        gases: vec![(1, 1.0)],
        rate: Rate::Evaporation(law),
        equilibrium,
    };
    let solids = vec![wood(), SolidSpecies::built_in("H2O(l)").unwrap()];
    let gas = Mixture::new(GASES).unwrap();
    SolidChemistry::new(solids, Some(gas), vec![reaction]).unwrap()
}

const FREE: Evaporation = Evaporation {
    fibre_saturation: None,
    isotherm: false,
};

fn both_ways() -> Equilibrium {
    Equilibrium::Line {
        constant: 0.0,
        over_temperature: 0.0,
    }
}

/// A drop, or a wet particle, in a gas: radius in m, masses of dry solid and of water in kg, its temperature in K.
struct Wet<'a> {
    chemistry: &'a SolidChemistry,
    radius: f64,
    masses: [f64; 2],
    temperature: f64,
    gas_temperature: f64,
    /// Mole fraction of vapour.
    vapour: f64,
    beta: f64,
    conductance: f64,
    heat: f64,
}

impl Wet<'_> {
    fn after(&self, span: f64) -> ([f64; 2], ParticleOutcome) {
        let fractions = [
            0.21 * (1.0 - self.vapour),
            self.vapour,
            0.79 * (1.0 - self.vapour),
        ];
        let films = vec![FilmCoefficient::constant(self.beta); 3];
        let amounts = [
            self.masses[0],
            self.masses[1] / self.chemistry.solids[1].molar_mass(),
        ];
        let start = ParticleStart {
            amounts: &amounts,
            first: &amounts,
            temperature: self.temperature,
            around: ParticleSurroundings {
                temperature: self.gas_temperature,
                pressure: PRESSURE,
                fractions: &fractions,
                film: &films,
                theory: FilmTheory {
                    stefan_flow: StefanFlow::Mass,
                    temperature: calcine_physics::film::FilmTemperature::TwoThirds,
                },
                radius: self.radius,
                size: &SizeChange::Constant,
            },
            conductance: self.conductance,
            heat: self.heat,
        };
        let accuracy = ParticleAccuracy {
            amount: 1e-9,
            temperature: 1e-6,
        };
        let mut workspace = ParticleWorkspace::default();
        let outcome = self
            .chemistry
            .follow(&start, span, accuracy, &mut workspace)
            .unwrap();
        let used = workspace.extents[0] * self.chemistry.solids[1].molar_mass();
        ([used, self.masses[1] - used], outcome)
    }

    /// The state of its surface by the balance of heat of its own.
    fn balance(
        &self,
        film_temperature: f64,
        taken: impl Fn(f64) -> f64,
    ) -> calcine_physics::moisture::WetState {
        let area = 4.0 * PI * self.radius * self.radius;
        let dry_air = 0.21 * 31.998e-3 + 0.79 * 28.0134e-3;
        let mean = self.vapour * WATER + (1.0 - self.vapour) * dry_air;
        let gas = self.chemistry.gas.as_ref().unwrap();
        let density = PRESSURE * mean / (calcine_physics::gas::GAS_CONSTANT * film_temperature);
        WetSurface {
            conductance: self.conductance,
            mass_transfer: density * self.beta * area,
            vapour_heat_capacity: gas.species()[1].heat_capacity(film_temperature),
            gas_temperature: self.gas_temperature,
            vapour_fraction: self.vapour * WATER / mean,
            molar_mass_ratio: WATER / dry_air,
            pressure: PRESSURE,
            activity: 1.0,
            heat: self.heat,
        }
        .balance(taken)
        .unwrap()
    }

    /// Heat of evaporation in J/kg at a temperature in K, by the enthalpies.
    fn evaporation_heat(&self, temperature: f64) -> f64 {
        let gas = self.chemistry.gas.as_ref().unwrap();
        let (vapour, liquid) = (&gas.species()[1], &self.chemistry.solids[1]);
        vapour.formation_enthalpy() + vapour.enthalpy(temperature)
            - liquid.formation_enthalpy() / liquid.molar_mass()
            - liquid.enthalpy(temperature)
    }
}

/// A drop of 1 mm of air at rest: Nu = Sh = 2.
fn drop(chemistry: &SolidChemistry, celsius: f64, humidity: f64) -> Wet<'_> {
    let (radius, kelvin) = (5e-4, celsius + 273.15);
    Wet {
        chemistry,
        radius,
        masses: [0.0, 4.0 / 3.0 * PI * f64::powi(radius, 3) * 996.0],
        temperature: kelvin,
        gas_temperature: kelvin,
        vapour: humidity * vapour_pressure(kelvin) / PRESSURE,
        beta: 2.56e-5 / radius,
        conductance: 0.0259 / radius * 4.0 * PI * radius * radius,
        heat: 0.0,
    }
}

#[test]
fn a_drop_comes_to_the_wet_bulb_temperature_of_its_own_balance() {
    let chemistry = drying(FREE, both_ways());
    for (celsius, humidity) in [
        (30.0, 0.05),
        (30.0, 0.5),
        (30.0, 0.95),
        (80.0, 0.02),
        (150.0, 0.0),
    ] {
        let mut wet = drop(&chemistry, celsius, humidity);
        // The heat capacity of vapour in the film is that of the start.
        wet.temperature = wet
            .balance(wet.gas_temperature, |t| wet.evaporation_heat(t))
            .temperature
            + 3.0;
        let (_, outcome) = wet.after(30.0);
        // The film at two thirds of the particle's and one third of the gas' temperature.
        let film = (2.0 * outcome.end + wet.gas_temperature) / 3.0;
        // What warms the water that is still there is left out: it is steady.
        let expected = wet.balance(film, |t| wet.evaporation_heat(t));
        assert!(
            (outcome.end - expected.temperature).abs() < 0.05,
            "{celsius} {humidity}: {} {}",
            outcome.end,
            expected.temperature
        );
        if (celsius, humidity) == (30.0, 0.5) {
            // DRY-8, as MFiX has it.
            assert!((outcome.end - 294.91).abs() < 0.5, "{}", outcome.end);
        }
    }
}

#[test]
fn in_steam_water_boils_by_the_heat_that_comes() {
    let chemistry = drying(FREE, both_ways());
    let boiling = boiling_temperature(PRESSURE);
    for (celsius, heat) in [(120.0, 0.0), (300.0, 0.0), (300.0, 0.05), (900.0, 0.0)] {
        let mut wet = drop(&chemistry, celsius, 0.0);
        wet.vapour = 1.0 - LEAST_OTHER;
        wet.temperature = boiling;
        wet.heat = heat;
        let span = 1.0;
        let (used, outcome) = wet.after(span);
        assert!(
            (outcome.end - boiling).abs() < 1e-4,
            "{celsius}: {}",
            outcome.end
        );
        // Between two times, both at the boiling point.
        let (later, _) = wet.after(2.0 * span);
        let rate = (later[0] - used[0]) / span;
        let gas = chemistry.gas.as_ref().unwrap();
        let mean = 0.5 * (boiling + wet.gas_temperature);
        let flow = rate * gas.species()[1].heat_capacity(mean) / wet.conductance;
        let came = wet.conductance * bernoulli(flow) * (wet.gas_temperature - boiling) + heat;
        let expected = came / wet.evaporation_heat(boiling);
        assert!(
            (rate / expected - 1.0).abs() < 1e-6,
            "{celsius}: {rate:e} {expected:e}"
        );
    }
}

#[test]
fn rates_are_continuous_where_a_particle_begins_to_boil() {
    // Heat that alone would take more than the film could carry off below the boiling point.
    let chemistry = drying(FREE, both_ways());
    let mut last: Option<(f64, f64)> = None;
    for step in 0..40 {
        let mut wet = drop(&chemistry, 100.0, 0.0);
        wet.vapour = 0.999;
        wet.heat = 1e-3 * f64::from(step);
        let (used, outcome) = wet.after(1.0);
        if let Some((heat, before)) = last {
            let expected = (wet.heat - heat) / 2.3e6;
            assert!(
                used[0] - before > 0.0 && used[0] - before < 3.0 * expected,
                "{step}"
            );
        }
        assert!(outcome.end < boiling_temperature(PRESSURE) + 1e-3);
        last = Some((wet.heat, used[0]));
    }
}

#[test]
fn a_cold_particle_in_steam_takes_what_warms_it_and_one_way_nothing() {
    for (equilibrium, condenses) in [(both_ways(), true), (Equilibrium::OneWay, false)] {
        let chemistry = drying(FREE, equilibrium);
        let mut wet = drop(&chemistry, 105.0, 0.0);
        wet.vapour = 1.0 - LEAST_OTHER;
        wet.temperature = 320.0;
        wet.masses = [4e-7, 1e-7];
        wet.conductance = 1e-9;
        let (used, outcome) = wet.after(100.0);
        if !condenses {
            assert_eq!(used[0], 0.0);
            continue;
        }
        let boiling = boiling_temperature(PRESSURE);
        assert!((outcome.end - boiling).abs() < 1e-3, "{}", outcome.end);
        // c_p of wood and water from 320 K on over the heat that steam of the gas' temperature gives.
        let liquid = &chemistry.solids[1];
        let wood = &chemistry.solids[0];
        let rise = wet.masses[0] * (wood.enthalpy(boiling) - wood.enthalpy(320.0))
            + wet.masses[1] * (liquid.enthalpy(boiling) - liquid.enthalpy(320.0));
        let steam = &chemistry.gas.as_ref().unwrap().species()[1];
        let given =
            wet.evaporation_heat(boiling) + steam.enthalpy(378.15) - steam.enthalpy(boiling);
        assert!(
            (-used[0] * given / rise - 1.0).abs() < 2e-3,
            "{} {}",
            -used[0] * given,
            rise
        );
    }
}

#[test]
fn a_wet_sphere_dries_in_the_time_of_its_balance() {
    // From 50 to 25 % moisture (of all), its surface wet: the rate is that of its wet bulb.
    let chemistry = drying(FREE, both_ways());
    let mut wet = drop(&chemistry, 90.0, 0.05);
    wet.masses = [2e-7, 2e-7];
    wet.temperature = wet.balance(340.0, |t| wet.evaporation_heat(t)).temperature;
    let film = (2.0 * wet.temperature + wet.gas_temperature) / 3.0;
    let expected = wet.balance(film, |t| wet.evaporation_heat(t)).evaporation;
    let time = (2e-7 - 2e-7 / 3.0) / expected;
    let (left, _) = wet.after(time);
    let moisture = left[1] / (left[1] + 2e-7);
    assert!((moisture - 0.25).abs() < 2e-3, "{moisture}");
}

#[test]
fn wood_ends_at_the_moisture_of_its_isotherm_and_takes_the_heat_of_sorption() {
    let law = Evaporation {
        fibre_saturation: Some(0.3),
        isotherm: true,
    };
    let chemistry = drying(law, both_ways());
    for (celsius, humidity, moisture) in [(60.0, 0.5, 1.0), (60.0, 0.5, 0.01), (25.0, 0.8, 0.5)] {
        let mut wet = drop(&chemistry, celsius, humidity);
        wet.masses = [2e-7, 2e-7 * moisture];
        let (used, outcome) = wet.after(3e5);
        let end = used[1] / 2e-7;
        let expected = equilibrium_moisture(humidity, wet.gas_temperature);
        assert!(
            (end / expected - 1.0).abs() < 1e-4,
            "{celsius}: {end} {expected}"
        );
        assert!((outcome.end - wet.gas_temperature).abs() < 1e-3);
        // All heat from the gas: evaporation and sorption, at one temperature in the end.
        let mut all = 0.0;
        let parts = 4000;
        let step = (moisture - end) / f64::from(parts);
        for k in 0..parts {
            let at = end + (f64::from(k) + 0.5) * step;
            all += step * 2e-7 * wet.evaporation_heat(wet.gas_temperature);
            all += step * 2e-7 * sorption_heat_ratio(at, 0.3) * wet.evaporation_heat(373.15);
        }
        let brought = outcome.flow * 3e5;
        assert!(
            (brought / all - 1.0).abs() < 2e-3,
            "{celsius} {moisture}: {brought:e} {all:e}"
        );
    }
}

#[test]
fn volatiles_leave_by_their_closed_form() {
    // DEV-5: 71.098 % in 1800 s at 573 K.
    let reaction = Reaction {
        name: "devolatilisation".into(),
        solids: vec![(0, -1.0)],
        gases: Vec::new(),
        rate: Rate::Devolatilisation(Devolatilisation {
            rate: Arrhenius {
                factor: 2.58e11,
                exponent: 0.0,
                activation_energy: 159_200.0,
            },
            order: 1.22,
        }),
        equilibrium: Equilibrium::OneWay,
    };
    let ballast = SolidSpecies::inert("ballast", HeatCapacity::constant(1e12));
    let chemistry = SolidChemistry::new(vec![wood(), ballast], None, vec![reaction]).unwrap();
    let start = ParticleStart {
        amounts: &[0.7e-6, 1.0],
        first: &[1e-6, 1.0],
        temperature: 573.0,
        around: ParticleSurroundings {
            temperature: 573.0,
            pressure: PRESSURE,
            fractions: &[],
            film: &[],
            theory: FilmTheory {
                stefan_flow: StefanFlow::Mass,
                temperature: calcine_physics::film::FilmTemperature::TwoThirds,
            },
            radius: 1e-3,
            size: &SizeChange::Constant,
        },
        conductance: 0.0,
        heat: 0.0,
    };
    // The time at which 0.7 of it is left, and from there to 1800 s.
    let k = 2.58e11 * (-159_200.0 / (calcine_physics::gas::GAS_CONSTANT * 573.0)).exp();
    let before = (0.7f64.powf(-0.22) - 1.0) / (0.22 * k);
    let accuracy = ParticleAccuracy {
        amount: 1e-9 * 1e-6,
        temperature: 1e-6,
    };
    let mut workspace = ParticleWorkspace::default();
    chemistry
        .follow(&start, 1800.0 - before, accuracy, &mut workspace)
        .unwrap();
    let converted = 0.3 + workspace.extents[0] / 1e-6;
    assert!((converted - 0.710_984).abs() < 1e-5, "{converted}");
}

#[test]
fn superheated_water_flashes_to_its_boiling_point() {
    let chemistry = drying(FREE, both_ways());
    for kelvin in [380.0, 450.0, 500.0, 640.0] {
        let mut wet = drop(&chemistry, 400.0, 0.0);
        wet.masses = [4e-7, 2e-7];
        wet.temperature = kelvin;
        for span in [1e-6, 1e-3, 1.0] {
            let (used, outcome) = wet.after(span);
            assert!(
                used[0] >= 0.0 && used[0] <= 2e-7,
                "{kelvin} {span}: {used:?}"
            );
            if span == 1e-3 {
                // What cools the particle is what evaporates: C dT = −L dm, next to nothing comes through the film.
                assert!(
                    outcome.end < boiling_temperature(PRESSURE),
                    "{kelvin}: {outcome:?}"
                );
                let (mut water, parts) = (2e-7, 2000);
                let step = (kelvin - outcome.end) / f64::from(parts);
                for part in 0..parts {
                    let at = kelvin - (f64::from(part) + 0.5) * step;
                    let heats = [0, 1].map(|k: usize| chemistry.solids[k].heat_capacity(at));
                    let capacity = 4e-7 * heats[0] + water * heats[1];
                    water -= capacity * step / wet.evaporation_heat(at);
                }
                assert!(
                    (used[1] / water - 1.0).abs() < 5e-3,
                    "{kelvin}: {used:?} {water}"
                );
            }
        }
    }
}
