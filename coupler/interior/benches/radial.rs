//! Processor time of attempts at particles with shells: µs a shell and attempt, on one and two threads.
//!
//! `cargo bench -p calcine-interior --bench radial`

#![allow(clippy::unwrap_used, clippy::print_stdout, missing_docs)]

use std::time::Instant;

use calcine_interior::radial::{
    PoreGas, PorousSolid, Radial, RadialNumerics, ShellGrading, ShellGrid, ShellResolution,
};
use calcine_interior::reacting::{Rate, Reaction, SizeChange, SolidChemistry};
use calcine_interior::{
    ColumnKind, GasLines, NetworkHeat, Newcomer, ParticleModel, Ragged, Surroundings, TEMPERATURE,
    Transfer,
};
use calcine_physics::conduction::Conductivity;
use calcine_physics::film::{FilmCoefficient, FilmTemperature, FilmTheory, StefanFlow};
use calcine_physics::pores::{Permeability, PorousConductivity};
use calcine_physics::reaction::conversion::FirstOrder;
use calcine_physics::reaction::equilibrium::GibbsLine;
use calcine_physics::reaction::{Arrhenius, Conversion, Equilibrium};
use calcine_physics::solids::SolidSpecies;
use calcine_physics::sphere;
use calcine_physics::thermo::Mixture;
use rustix::time::{ClockId, clock_gettime};

const SHELLS: usize = 30;

fn stones(radius: f64, count: u64) -> Radial {
    let solids = ["CaCO3", "CaO"].map(|name| SolidSpecies::built_in(name).unwrap());
    let gas = Mixture::new(["CO2", "N2"]).unwrap();
    let change = |t: f64| {
        solids[1].gibbs_energy(t) - solids[0].gibbs_energy(t)
            + gas.species()[0].polynomial().gibbs_energy(t)
    };
    let equilibrium = Equilibrium::Gibbs(GibbsLine::new(change));
    let reaction = Reaction {
        name: "calcination".into(),
        solids: vec![(0, -1.0), (1, 1.0)],
        gases: vec![(0, 1.0)],
        rate: Rate::Conversion {
            rate_constant: Arrhenius {
                factor: 1.235e15,
                exponent: 0.0,
                activation_energy: 325.1e3,
            },
            conversion: Conversion::FirstOrder(FirstOrder),
            gases: Vec::new(),
        },
        equilibrium,
    };
    let chemistry = SolidChemistry::new(solids.to_vec(), Some(gas), vec![reaction]).unwrap();
    let solid = PorousSolid {
        true_densities: vec![2711.0, 3340.0],
        conductivity: Conductivity::constant(0.6),
        conduction: PorousConductivity::Stated,
        pore_diameter: 1e-6,
        tortuosity: 2.0,
        permeability: Permeability::Constant(1e-13),
        size: SizeChange::Constant,
        standing_gas: None,
    };
    let pores = PoreGas {
        pressure: 101_325.0,
        fractions: vec![0.0, 1.0],
    };
    let numerics = RadialNumerics {
        resolution: ShellResolution::All,
        ..RadialNumerics::new(ShellGrid {
            shells: SHELLS,
            grading: ShellGrading::Ratio(2.0),
        })
    };
    let mut made = Radial::new(chemistry, &[1.0, 0.0], solid, pores, numerics).unwrap();
    let state: [(&str, &[f64]); 1] = [(TEMPERATURE, &[1100.0])];
    let new: Vec<Newcomer<'_>> = (1..=count)
        .map(|id| Newcomer {
            id,
            mass: sphere::mass(radius, 2440.0),
            radius,
            state: &state,
        })
        .collect();
    made.change(&[], &new).unwrap();
    made
}

/// Processor time in s of this process.
fn processor() -> f64 {
    let time = clock_gettime(ClockId::ProcessCPUTime);
    time.tv_sec as f64 + 1e-9 * time.tv_nsec as f64
}

/// Gas about so many particles.
struct Gas {
    temperature: Vec<f64>,
    pressure: Vec<f64>,
    composition: Vec<f64>,
    conductance: Vec<f64>,
    film: Vec<FilmCoefficient>,
    radius: Vec<f64>,
}

impl Gas {
    fn of(kelvin: f64, radius: f64, count: usize) -> Self {
        let gas = Mixture::new(["CO2", "N2"]).unwrap();
        Self {
            // No two particles see the same, however many there are.
            temperature: (0..count)
                .map(|p| kelvin + 2.0 * p as f64 / count as f64)
                .collect(),
            pressure: vec![101_325.0; count],
            composition: gas.mass_fractions(&[0.2, 0.8]).repeat(count),
            conductance: vec![100.0 * sphere::surface(radius); count],
            film: vec![FilmCoefficient::constant(0.1); 2 * count],
            radius: vec![radius; count],
        }
    }

    /// One attempt at all particles; committed with what they say as what is exchanged, if asked for.
    fn attempt(&self, model: &mut Radial, span: f64, commit: bool) {
        let count = self.temperature.len();
        let around = Surroundings {
            temperature: &self.temperature,
            pressure: &self.pressure,
            composition: &self.composition,
            conductance: &self.conductance,
            film: &self.film,
            theory: FilmTheory {
                temperature: FilmTemperature::TwoThirds,
                stefan_flow: StefanFlow::Mass,
            },
            radius: &self.radius,
            end: 0.0,
        };
        let mut lines = GasLines::default();
        lines.reset(count, 2);
        let network = vec![0.0; count];
        let alone = vec![NetworkHeat::default(); count];
        model.respond(&around, span, &alone, &mut lines).unwrap();
        if commit {
            let pairs = (0..count)
                .map(|p| lines.conductance[p] * (self.temperature[p] - lines.temperature[p]));
            let heat: Vec<f64> = pairs.collect();
            let fractions = &self.composition;
            // The last gas is what the others leave: its line has no slope.
            let rates: Vec<f64> = (0..2 * count)
                .map(|at| {
                    lines.slope[at] * if at % 2 == 0 { fractions[at] } else { 0.0 }
                        - lines.offset[at]
                })
                .collect();
            let gas = Mixture::new(["CO2", "N2"]).unwrap();
            let carry = |at: usize| {
                let one = &gas.species()[at % 2];
                -rates[at] * one.molar_mass() * one.enthalpy(lines.released[at / 2])
            };
            let carried: Vec<f64> = (0..count)
                .map(|p| carry(2 * p) + carry(2 * p + 1))
                .collect();
            let took = Transfer {
                heat: &heat,
                network: &network,
                carried: &carried,
                rates: &rates,
            };
            model.settle(&took, span).unwrap();
            model.commit();
        }
    }
}

/// So many copies of a particle that went on for a while.
fn copies(radius: f64, kelvin: f64, (span, windows): (f64, usize), count: usize) -> Radial {
    let mut one = stones(radius, 1);
    let gas = Gas::of(kelvin, radius, 1);
    for _ in 0..windows {
        gas.attempt(&mut one, span, true);
    }
    let mut all = stones(radius, count as u64);
    let columns = one.columns().len();
    let mut state = vec![Ragged::new(ColumnKind::Real); columns];
    for (column, copies) in state.iter_mut().enumerate() {
        let mut own = Ragged::new(ColumnKind::Real);
        one.read(column, &mut own);
        copies.reset(ColumnKind::Real);
        (0..count).for_each(|_| copies.push_reals(own.reals(0)));
    }
    all.load(&state).unwrap();
    all
}

fn main() {
    let stone = (10e-3, 1400.0);
    let grain = (78e-6, 1000.0);
    for ((radius, kelvin), span, windows, what) in [
        (
            stone,
            1.0,
            0,
            "stones of 20 mm from their start, windows of 1 s",
        ),
        (
            stone,
            1.0,
            300,
            "stones of 20 mm after 300 s, windows of 1 s",
        ),
        (
            stone,
            10.0,
            30,
            "stones of 20 mm after 300 s, windows of 10 s",
        ),
        (
            grain,
            1.0,
            10,
            "grains of 156 um that react, windows of 1 s",
        ),
    ] {
        for (threads, count) in [
            (1, 2000),
            (2, 2000),
            (1, 20_000),
            (1, 100_000),
            (2, 100_000),
        ] {
            if count > 2000
                && (span > 1.0 || windows == 0 || std::env::var_os("CALCINE_BENCH_LARGE").is_none())
            {
                continue;
            }
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads);
            let pool = pool.build().unwrap();
            let mut model = copies(radius, kelvin, (span, windows), count);
            let gas = Gas::of(kelvin, radius, count);
            let (time, wall, steps, rounds) = pool.install(|| {
                gas.attempt(&mut model, span, false);
                let (before, start, begin) = (model.work(), processor(), Instant::now());
                gas.attempt(&mut model, span, false);
                let each = |k: usize| (model.work()[k] - before[k]) as f64 / count as f64;
                let (steps, rounds) = (each(0), each(3));
                (
                    processor() - start,
                    begin.elapsed().as_secs_f64(),
                    steps,
                    rounds,
                )
            });
            let each = 1e6 * time / (count * SHELLS) as f64;
            println!(
                "{what}, {threads} threads, {count} particles: {each:.3} µs of processor time a shell and attempt, {:.3} s of wall time; {steps:.1} steps, {rounds:.1} rounds; {} bytes a particle",
                wall,
                model.bytes()
            );
        }
    }
}
