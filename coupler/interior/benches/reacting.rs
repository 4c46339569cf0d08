//! Processor time of one attempt at one reacting particle, and of many on one and two threads.
//!
//! `cargo bench -p calcine-interior` prints a table: three shrinking cores in series (iron ore in CO and H2, two reactions at
//! each interface), a power law of a gas (oxidation of iron), one that its product holds back, and three that share the gas at the
//! surface, over all windows of their conversion.
#![allow(clippy::unwrap_used, clippy::print_stdout, missing_docs)]

use std::time::{Duration, Instant};

use calcine_interior::reacting::attempt::{ParticleAccuracy, ParticleStart, ParticleWorkspace};
use calcine_interior::reacting::passage::ParticleSurroundings;
use calcine_interior::reacting::{LayerDiffusivity, Rate, Reaction, SizeChange, SolidChemistry};
use calcine_numerics::batch::each_row;
use calcine_physics::film::{FilmCoefficient, FilmTemperature, FilmTheory, StefanFlow};
use calcine_physics::reaction::equilibrium::GibbsLine;
use calcine_physics::reaction::{Arrhenius, Equilibrium, PowerLaw};
use calcine_physics::solids::SolidSpecies;
use calcine_physics::sphere;
use calcine_physics::thermo::{Mixture, Species};
use rustix::time::{ClockId, clock_gettime};

/// Particles of one kind in a gas.
struct Kind {
    name: &'static str,
    chemistry: SolidChemistry,
    /// Of the start, by mass; of the gas, by mole.
    solids: Vec<f64>,
    gas: Vec<f64>,
    temperature: f64,
    density: f64,
    radius: f64,
    window: f64,
    windows: usize,
}

const THEORY: FilmTheory = FilmTheory {
    temperature: FilmTemperature::TwoThirds,
    stefan_flow: StefanFlow::Mass,
};
const SIZE: SizeChange = SizeChange::Constant;

fn arrhenius(factor: f64, activation_energy: f64) -> Arrhenius {
    Arrhenius {
        factor,
        exponent: 0.0,
        activation_energy,
    }
}

/// ln K of a reaction from the species' Gibbs energies.
fn gibbs(solids: &[(&str, f64)], gases: &[(&str, f64)]) -> Equilibrium {
    let of_solids: Vec<_> = solids
        .iter()
        .map(|(name, n)| (SolidSpecies::built_in(name).unwrap(), *n))
        .collect();
    let of_gases: Vec<_> = gases
        .iter()
        .map(|(name, n)| (Species::built_in(name).unwrap(), *n))
        .collect();
    Equilibrium::Gibbs(GibbsLine::new(|t| {
        let solids = of_solids.iter().map(|(one, n)| n * one.gibbs_energy(t));
        let gases = of_gases
            .iter()
            .map(|(one, n)| n * one.polynomial().gibbs_energy(t));
        solids.chain(gases).sum()
    }))
}

fn ore() -> Kind {
    let solids = ["Fe2O3", "Fe3O4", "Fe0.947O", "Fe", "Al2O3"];
    let gases = ["CO", "CO2", "H2", "H2O", "N2"];
    let steps = [
        ((0, 3.0), (1, 2.0), 1.0),
        ((1, 0.947), (2, 3.0), 0.788),
        ((2, 1.0), (3, 0.947), 1.0),
    ];
    let rates = [
        [
            (2700.0, 113_859.0, 1.5e-5),
            (25.0, 73_674.0, 2.3e-5),
            (17.0, 69_488.0, 3.5e-5),
        ],
        [
            (160.0, 92_092.0, 5.8e-5),
            (23.0, 71_162.0, 8.7e-5),
            (30.0, 63_627.0, 1.3e-4),
        ],
    ];
    let mut reactions = Vec::new();
    for (gas, rates) in [(0, 1), (2, 3)].into_iter().zip(rates) {
        for ((from, to, moles), (factor, energy, diffusivity)) in steps.into_iter().zip(rates) {
            let in_solids = [(solids[from.0], -from.1), (solids[to.0], to.1)];
            let in_gases = [(gases[gas.0], -moles), (gases[gas.1], moles)];
            reactions.push(Reaction {
                name: format!("{} by {}", solids[from.0], gases[gas.0]),
                solids: vec![(from.0, -from.1), to],
                gases: vec![(gas.0, -moles), (gas.1, moles)],
                rate: Rate::Core {
                    rate_constant: arrhenius(factor, energy),
                    diffusivity: LayerDiffusivity {
                        value: diffusivity,
                        at: 1173.0,
                        exponent: 1.75,
                    },
                },
                equilibrium: gibbs(&in_solids, &in_gases),
            });
        }
    }
    Kind {
        name: "three cores in series",
        chemistry: chemistry(&solids, &gases, reactions),
        solids: vec![0.95, 0.0, 0.0, 0.0, 0.05],
        gas: vec![0.34, 0.04, 0.50, 0.06, 0.06],
        temperature: 1173.0,
        density: 3500.0,
        radius: 6e-3,
        window: 20.0,
        windows: 360,
    }
}

fn oxidation() -> Kind {
    let reaction = Reaction {
        name: "oxidation".into(),
        solids: vec![(0, -2.0), (1, 2.0)],
        gases: vec![(0, -1.0)],
        rate: Rate::Power(PowerLaw {
            rate_constant: arrhenius(2e3, 59_700.0),
            in_series: Some(arrhenius(30.0, 18_040.0)),
            solids: vec![(0, 0.67)],
            gases: vec![(0, 0.5)],
        }),
        equilibrium: Equilibrium::OneWay,
    };
    Kind {
        name: "power law of solid and gas",
        chemistry: chemistry(&["Fe", "FeO"], &["O2", "N2"], vec![reaction]),
        solids: vec![1.0, 0.0],
        gas: vec![0.21, 0.79],
        temperature: 600.0,
        density: 3500.0,
        radius: 5e-3,
        window: 20.0,
        windows: 360,
    }
}

fn calcination() -> Kind {
    let reaction = Reaction {
        name: "calcination".into(),
        solids: vec![(0, -1.0), (1, 1.0)],
        gases: vec![(0, 1.0)],
        rate: Rate::Power(PowerLaw {
            rate_constant: arrhenius(6e6, 190_000.0),
            in_series: None,
            solids: vec![(0, 0.67)],
            gases: Vec::new(),
        }),
        equilibrium: gibbs(&[("CaCO3", -1.0), ("CaO", 1.0)], &[("CO2", 1.0)]),
    };
    Kind {
        name: "power law of solid, reversible",
        chemistry: chemistry(&["CaCO3", "CaO"], &["CO2", "N2"], vec![reaction]),
        solids: vec![1.0, 0.0],
        gas: vec![0.2, 0.8],
        temperature: 1250.0,
        density: 2700.0,
        radius: 5e-3,
        window: 5.0,
        windows: 360,
    }
}

/// Carbon to CO2 and CO, and by CO2 to CO, of which the film brings the gases together.
fn gasification() -> Kind {
    let law = |name: &str,
               carbon: f64,
               gases: &[(usize, f64)],
               (factor, energy): (f64, f64),
               equilibrium: Equilibrium| Reaction {
        name: name.into(),
        solids: vec![(0, -carbon)],
        gases: gases.to_vec(),
        rate: Rate::Power(PowerLaw {
            rate_constant: arrhenius(factor, energy),
            in_series: None,
            solids: vec![(0, 1.0)],
            gases: vec![(gases[0].0, 1.0)],
        }),
        equilibrium,
    };
    let boudouard = gibbs(&[("C", -1.0)], &[("CO2", -1.0), ("CO", 2.0)]);
    let one_way = Equilibrium::OneWay;
    let reactions = vec![
        law(
            "dioxide",
            1.0,
            &[(0, -1.0), (1, 1.0)],
            (3e3, 120_000.0),
            one_way.clone(),
        ),
        law(
            "monoxide",
            2.0,
            &[(0, -1.0), (2, 2.0)],
            (3e4, 150_000.0),
            one_way,
        ),
        law(
            "gasification",
            1.0,
            &[(1, -1.0), (2, 2.0)],
            (4e4, 220_000.0),
            boudouard,
        ),
    ];
    Kind {
        name: "three power laws of one film",
        chemistry: chemistry(&["C", "Al2O3"], &["O2", "CO2", "CO", "N2"], reactions),
        solids: vec![0.9, 0.1],
        gas: vec![0.1, 0.1, 0.0, 0.8],
        temperature: 1300.0,
        density: 1200.0,
        radius: 5e-3,
        window: 5.0,
        windows: 360,
    }
}

fn chemistry(solids: &[&str], gases: &[&str], reactions: Vec<Reaction>) -> SolidChemistry {
    let solids = solids.iter().map(|name| SolidSpecies::built_in(name));
    let gas = Mixture::new(gases.iter().copied()).unwrap();
    let solids = solids.map(Result::unwrap).collect();
    SolidChemistry::new(solids, Some(gas), reactions).unwrap()
}

fn processor() -> Duration {
    let time = clock_gettime(ClockId::ProcessCPUTime);
    Duration::new(time.tv_sec.unsigned_abs(), time.tv_nsec as u32)
}

/// Amounts in mol and temperature in K of a particle, one list.
fn begin(kind: &Kind, radius: f64) -> Vec<f64> {
    let mass = sphere::mass(radius, kind.density);
    let parts = kind.chemistry.solids.iter().zip(&kind.solids);
    let mut state: Vec<f64> = parts.map(|(one, y)| mass * y / one.molar_mass()).collect();
    state.push(kind.temperature);
    state
}

/// One attempt, taken up as the next start; its steps.
fn advance(
    kind: &Kind,
    radius: f64,
    state: &mut [f64],
    workspace: &mut ParticleWorkspace,
) -> [usize; 3] {
    let (amounts, temperature) = state.split_at(kind.chemistry.solids.len());
    let film = vec![FilmCoefficient::constant(0.08); kind.gas.len()];
    let area = sphere::surface(radius);
    let start = ParticleStart {
        amounts,
        first: amounts,
        temperature: temperature[0],
        around: ParticleSurroundings {
            temperature: kind.temperature,
            pressure: 1.5e5,
            fractions: &kind.gas,
            film: &film,
            theory: THEORY,
            radius,
            size: &SIZE,
        },
        conductance: 80.0 * area,
        heat: 0.0,
    };
    let accuracy = ParticleAccuracy::default();
    let outcome = kind
        .chemistry
        .follow(&start, kind.window, accuracy, workspace)
        .unwrap();
    for (extent, reaction) in workspace.extents.iter().zip(&kind.chemistry.reactions) {
        for &(s, n) in &reaction.solids {
            state[s] = (state[s] + n * extent).max(0.0);
        }
    }
    let last = state.len() - 1;
    state[last] = outcome.end;
    let done = outcome.statistics;
    [done.steps, done.rejected, done.evaluations]
}

fn main() {
    // `cargo bench` and `cargo test --benches` pass words of their own.
    let quick = std::env::args().any(|word| word == "--test");
    let early = Kind {
        name: "three cores, first ten minutes",
        windows: 30,
        ..ore()
    };
    let kinds = [ore(), early, oxidation(), calcination(), gasification()];
    println!("processor time of an attempt at one particle, over its whole conversion");
    for kind in &kinds {
        let mut workspace = ParticleWorkspace::default();
        let mut totals = [0; 3];
        let mut attempts = 0;
        let mut left = 0.0;
        let begun = processor();
        for repeat in 0..if quick { 1 } else { 20 } {
            let radius = kind.radius * (1.0 + 0.01 * f64::from(repeat));
            let mut state = begin(kind, radius);
            let first = state[0];
            for _ in 0..kind.windows {
                let done = advance(kind, radius, &mut state, &mut workspace);
                totals.iter_mut().zip(done).for_each(|(sum, n)| *sum += n);
                attempts += 1;
            }
            left = state[0] / first;
        }
        let used = (processor() - begun).as_secs_f64() / f64::from(attempts);
        let mean = |k: usize| totals[k] as f64 / f64::from(attempts);
        println!(
            "  {:32} {:7.2} µs, {:.2} steps, {:.2} rejected, {:.2} evaluations, {:.1e} of the first solid left",
            kind.name,
            1e6 * used,
            mean(0),
            mean(1),
            mean(2),
            left,
        );
    }
    let kind = &kinds[0];
    let count = if quick { 100 } else { 100_000 };
    println!("{count} particles of {}, one window", kind.name);
    let width = kind.chemistry.solids.len() + 1;
    let mut bits: Option<Vec<f64>> = None;
    for threads in [1, 2] {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
        let mut rows: Vec<f64> = (0..count)
            .flat_map(|k| begin(kind, kind.radius * (1.0 + 1e-6 * f64::from(k))))
            .collect();
        let begun = (Instant::now(), processor());
        let radius = |k: usize| kind.radius * (1.0 + 1e-6 * k as f64);
        let work = |k: usize, row: &mut [f64], workspace: &mut ParticleWorkspace| {
            advance(kind, radius(k), row, workspace);
            Ok::<(), ()>(())
        };
        pool.unwrap()
            .install(|| each_row(&mut rows, width, ParticleWorkspace::default, work).unwrap());
        println!(
            "  {threads} threads: {:.3} s wall, {:.3} s of processors",
            begun.0.elapsed().as_secs_f64(),
            (processor() - begun.1).as_secs_f64()
        );
        match &bits {
            None => bits = Some(rows),
            Some(first) => println!("  same bits: {}", *first == rows),
        }
    }
}
