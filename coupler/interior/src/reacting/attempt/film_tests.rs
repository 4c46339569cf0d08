//! Films of particles that react against closed forms: their state, and the net flow through them.

use calcine_physics::film::{
    FILM_TEMPERATURES, FilmCoefficient, FilmTemperature, FilmTheory, StefanFlow,
};
use calcine_physics::gas::GAS_CONSTANT;
use calcine_physics::reaction::{Arrhenius, Equilibrium, PowerLaw};
use calcine_physics::solid::HeatCapacity;
use calcine_physics::solids::SolidSpecies;
use calcine_physics::thermo::Mixture;

use super::*;
use crate::reacting::passage::ParticleSurroundings;
use crate::reacting::{LayerDiffusivity, Rate, Reaction, SizeChange};

const PRESSURE: f64 = 1.5e5;
const GASES: [&str; 4] = ["O2", "CO2", "CO", "N2"];
const RADIUS: f64 = 5e-4;
const DENSITY: f64 = 1000.0;
const OXYGEN: f64 = 0.21;

fn constant(factor: f64) -> Arrhenius {
    Arrhenius {
        factor,
        exponent: 0.0,
        activation_energy: 0.0,
    }
}

/// Carbon that burns as fast as oxygen comes, with a solid beside it that has no volume and so much heat capacity that the
/// temperature stays.
fn burning(gases: Vec<(usize, f64)>) -> SolidChemistry {
    let carbon = SolidSpecies::built_in("C").unwrap();
    let ballast = SolidSpecies::inert("ballast", HeatCapacity::constant(1e12));
    let reaction = Reaction {
        name: "burn".into(),
        solids: vec![(0, -1.0)],
        gases,
        rate: Rate::Power(PowerLaw {
            rate_constant: constant(1e9),
            in_series: None,
            gases: vec![(0, 1.0)],
            solids: Vec::new(),
        }),
        equilibrium: Equilibrium::OneWay,
    };
    let gas = Mixture::new(GASES).unwrap();
    SolidChemistry::new(vec![carbon, ballast], Some(gas), vec![reaction]).unwrap()
}

/// β of all gases in m/s at a temperature of the film: that of still gas, 3e-4 m²/s at 1200 K with T^1.75.
fn coefficient(temperature: f64) -> f64 {
    3e-4 * (temperature / 1200.0).powf(1.75) / RADIUS
}

fn films(at: f64) -> Vec<FilmCoefficient> {
    let values = FILM_TEMPERATURES.map(|factor| coefficient(factor * at));
    vec![FilmCoefficient::through(at, values); GASES.len()]
}

/// The share of the carbon that is left after a share of its time to burn out, by the burning rate in kg/m²/s at the start.
fn left(
    gases: &[(usize, f64)],
    theory: FilmTheory,
    (particle, hot): (f64, f64),
    (rate, share): (f64, f64),
) -> (f64, ParticleOutcome) {
    let chemistry = burning(gases.to_vec());
    let molar = chemistry.solids[0].molar_mass();
    let amount = 4.0 / 3.0 * std::f64::consts::PI * RADIUS.powi(3) * DENSITY / molar;
    let size = SizeChange::Volumes {
        each: vec![molar / DENSITY, 0.0],
        least_radius: 1e-6,
    };
    let fractions = [OXYGEN, 0.0, 0.0, 1.0 - OXYGEN];
    let films = films(theory.temperature.of(particle, hot));
    let start = ParticleStart {
        amounts: &[amount, amount],
        first: &[amount, amount],
        temperature: particle,
        around: ParticleSurroundings {
            temperature: hot,
            pressure: PRESSURE,
            fractions: &fractions,
            film: &films,
            theory,
            radius: RADIUS,
            size: &size,
        },
        conductance: 1e-3,
        heat: 0.0,
    };
    let burnt_out = DENSITY * RADIUS / (2.0 * rate);
    let mut workspace = ParticleWorkspace::default();
    let accuracy = ParticleAccuracy::default();
    let outcome = chemistry
        .follow(&start, share * burnt_out, accuracy, &mut workspace)
        .unwrap();
    (1.0 - workspace.extents[0] / amount, outcome)
}

const TEMPERATURES: [FilmTemperature; 3] = [
    FilmTemperature::Gas,
    FilmTemperature::TwoThirds,
    FilmTemperature::Mean,
];

#[test]
fn carbon_follows_the_d_squared_law_with_spalding_s_number_at_the_state_of_its_film() {
    // d(d²)/dt = −8 ρ D ln(1 + B)/ρ_p, ρ D = ρ β r, with B = Y_O2 12/32 (CO2) and Y_O2 24/32 (CO).
    let weight = OXYGEN * 31.998 + (1.0 - OXYGEN) * 28.014;
    let oxygen = OXYGEN * 31.998 / weight;
    let ways = [
        (vec![(0, -1.0), (1, 1.0)], oxygen * 12.011 / 31.998),
        (vec![(0, -0.5), (2, 1.0)], oxygen * 24.022 / 31.998),
    ];
    for temperature in TEMPERATURES {
        let theory = FilmTheory {
            temperature,
            stefan_flow: StefanFlow::Mass,
        };
        for ratio in [0.5, 1.0, 2.0] {
            let (particle, hot) = (1200.0 * ratio, 1200.0);
            let film = temperature.of(particle, hot);
            let density = PRESSURE * weight * 1e-3 / (GAS_CONSTANT * film);
            for (gases, spalding) in &ways {
                let rate = density * coefficient(film) * spalding.ln_1p();
                for share in [0.001, 0.1, 0.5, 0.9, 0.999, 2.0] {
                    let given = (rate, share);
                    let (left, outcome) = left(gases, theory, (particle, hot), given);
                    let expected = (1.0 - share).max(0.0).powf(1.5);
                    let off = (left - expected).abs();
                    assert!(
                        off < 2e-4,
                        "{temperature:?} {ratio} {share}: {left} {expected}"
                    );
                    // The slope of d², over the whole window.
                    if share < 0.999 {
                        let slope = (1.0 - left.powf(2.0 / 3.0)) / share;
                        assert!((slope - 1.0).abs() < 2e-3, "{ratio} {share}: {slope}");
                    }
                    assert!(outcome.statistics.steps < 300, "{:?}", outcome.statistics);
                }
            }
        }
    }
}

#[test]
fn by_moles_carbon_follows_stefan_s_law_whose_density_is_that_of_each_place() {
    // C + O2 -> CO2 moves no moles: c β x. C + ½ O2 -> CO makes one of a half: 2 · c β ln(1 + x)/2 · 2 ½.
    let theory = FilmTheory {
        temperature: FilmTemperature::TwoThirds,
        stefan_flow: StefanFlow::Molar,
    };
    for ratio in [0.5, 2.0] {
        let (particle, hot) = (1200.0 * ratio, 1200.0);
        let film = theory.temperature.of(particle, hot);
        let flux = PRESSURE / (GAS_CONSTANT * film) * coefficient(film) * 12.011e-3;
        for (gases, rate) in [
            (vec![(0, -1.0), (1, 1.0)], flux * OXYGEN),
            (vec![(0, -0.5), (2, 1.0)], flux * 2.0 * OXYGEN.ln_1p()),
        ] {
            for share in [0.01, 0.5, 0.9] {
                let (left, _) = left(&gases, theory, (particle, hot), (rate, share));
                let expected = (1.0 - share).powf(1.5);
                assert!((left - expected).abs() < 2e-4, "{ratio} {share}: {left}");
            }
        }
    }
}

#[test]
fn with_the_density_of_a_mean_composition_spalding_s_law_is_stefan_s() {
    // M ln(1 + B)/… of bulk and surface in the mean is c x to 0.2 %: which of the two forms is taken is a matter of the
    // composition at which the density of a film is taken.
    let bulk = OXYGEN * 31.998 + (1.0 - OXYGEN) * 28.014;
    let surface = OXYGEN * 44.009 + (1.0 - OXYGEN) * 28.014;
    let spalding = OXYGEN * 12.011 / bulk;
    let by_mass = 0.5 * (bulk + surface) * spalding.ln_1p();
    assert!((by_mass / (12.011 * OXYGEN) - 1.0).abs() < 2e-3);
}

/// Limestone whose interface is as fast as any, in a layer that hinders nothing.
fn calcination(x_surface: f64, temperature: f64) -> SolidChemistry {
    calcination_by(1e20, x_surface, temperature)
}

/// The same with a rate constant in m/s; a mole fraction of equilibrium above 1 is a pressure above that of the gas.
fn calcination_by(factor: f64, x_surface: f64, temperature: f64) -> SolidChemistry {
    let solids = ["CaCO3", "CaO"].map(|name| SolidSpecies::built_in(name).unwrap());
    let reaction = Reaction {
        name: "calcination".into(),
        solids: vec![(0, -1.0), (1, 1.0)],
        gases: vec![(1, 1.0)],
        rate: Rate::Core {
            rate_constant: constant(factor),
            diffusivity: LayerDiffusivity {
                value: 1e3,
                at: temperature,
                exponent: 0.0,
            },
        },
        equilibrium: Equilibrium::Line {
            constant: (x_surface * PRESSURE / 1e5).ln(),
            over_temperature: 0.0,
        },
    };
    let gas = Mixture::new(GASES).unwrap();
    SolidChemistry::new(solids.to_vec(), Some(gas), vec![reaction]).unwrap()
}

#[test]
fn carbon_dioxide_leaves_limestone_by_the_logarithm_of_what_stands_still() {
    let (particle, hot) = (1000.0, 1400.0);
    let weight = |x: f64| x * 44.009 + (1.0 - x) * 28.014;
    let mass_fraction = |x: f64| x * 44.009 / weight(x);
    for (gas, surface) in [(0.0, 0.05), (0.1, 0.6), (0.0, 0.95), (0.4, 0.1)] {
        let chemistry = calcination(surface, particle);
        for temperature in TEMPERATURES {
            let film = temperature.of(particle, hot);
            let moles = PRESSURE / (GAS_CONSTANT * film) * coefficient(film);
            let log = |one: f64, other: f64| ((1.0 - other) / (1.0 - one)).ln();
            let by_mass = weight(gas) / 44.009 * log(mass_fraction(surface), mass_fraction(gas));
            for (stefan_flow, expected) in [
                (StefanFlow::None, surface - gas),
                (StefanFlow::Molar, log(surface, gas)),
                (StefanFlow::Mass, by_mass),
            ] {
                let films = films(film);
                let fractions = [0.0, gas, 0.0, 1.0 - gas];
                let start = ParticleStart {
                    amounts: &[1e-5, 1e-5],
                    first: &[1e-5, 1e-5],
                    temperature: particle,
                    around: ParticleSurroundings {
                        temperature: hot,
                        pressure: PRESSURE,
                        fractions: &fractions,
                        film: &films,
                        theory: FilmTheory {
                            temperature,
                            stefan_flow,
                        },
                        radius: RADIUS,
                        size: &SizeChange::Constant,
                    },
                    conductance: 0.0,
                    heat: 0.0,
                };
                let mut workspace = ParticleWorkspace::default();
                let accuracy = ParticleAccuracy::default();
                let span = 1e-9;
                chemistry
                    .follow(&start, span, accuracy, &mut workspace)
                    .unwrap();
                let area = 4.0 * std::f64::consts::PI * RADIUS * RADIUS;
                let flux = workspace.extents[0] / span / area / moles;
                // The interface has 1e-5 of the resistance of film and layer at least.
                assert!(
                    (flux / expected - 1.0).abs() < 1e-4,
                    "{stefan_flow:?} {temperature:?} {gas} {surface}: {flux} {expected}"
                );
            }
        }
    }
}

/// Flux in mol/m²/s of carbon dioxide from limestone at the start of a window of 1 ns, in gas without it.
fn calcination_flux(
    (factor, equilibrium): (f64, f64),
    theory: FilmTheory,
    (particle, hot): (f64, f64),
) -> f64 {
    let chemistry = calcination_by(factor, equilibrium, particle);
    let films = films(theory.temperature.of(particle, hot));
    let start = ParticleStart {
        amounts: &[1e-5, 1e-8],
        first: &[1e-5, 1e-8],
        temperature: particle,
        around: ParticleSurroundings {
            temperature: hot,
            pressure: PRESSURE,
            fractions: &[0.0, 0.0, 0.0, 1.0],
            film: &films,
            theory,
            radius: RADIUS,
            size: &SizeChange::Constant,
        },
        conductance: 0.0,
        heat: 0.0,
    };
    let mut workspace = ParticleWorkspace::default();
    let span = 1e-9;
    chemistry
        .follow(&start, span, ParticleAccuracy::default(), &mut workspace)
        .unwrap();
    workspace.extents[0] / span / (4.0 * std::f64::consts::PI * RADIUS * RADIUS)
}

#[test]
fn limestone_whose_pressure_is_above_that_of_the_gas_is_as_fast_as_its_interface() {
    let (particle, hot) = (1600.0, 1500.0);
    let [heavy, light] = [44.009, 28.014];
    for stefan_flow in [StefanFlow::Molar, StefanFlow::Mass] {
        let theory = FilmTheory {
            temperature: FilmTemperature::TwoThirds,
            stefan_flow,
        };
        let film = theory.temperature.of(particle, hot);
        for equilibrium in [0.95, 1.02, 1.5, 3.0, 10.0, 50.0, 300.0] {
            for factor in [1e-3, 0.1, 1.0, 30.0, 1e3] {
                let found = calcination_flux((factor, equilibrium), theory, (particle, hot));
                // What the interface makes and what the film carries away, by the mole fraction at the surface.
                let made = |x: f64| factor * (equilibrium - x) / particle;
                let carried = |x: f64| {
                    let y = x * heavy / (x * heavy + (1.0 - x) * light);
                    let of_mole = match stefan_flow {
                        StefanFlow::Mass => -(-y).ln_1p() * light / heavy,
                        _ => -(-x).ln_1p(),
                    };
                    coefficient(film) * of_mole / film
                };
                let (mut low, mut high) = (0.0, 1.0 - 1e-15);
                for _ in 0..200 {
                    let x = 0.5 * (low + high);
                    if made(x) > carried(x) {
                        low = x
                    } else {
                        high = x
                    }
                }
                let expected = made(0.5 * (low + high)) * PRESSURE / GAS_CONSTANT;
                assert!(
                    (found / expected - 1.0).abs() < 1e-3,
                    "{stefan_flow:?} {equilibrium} {factor}: {found} {expected}"
                );
            }
        }
    }
}
