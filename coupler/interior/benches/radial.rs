//! Processor time of attempts at particles with shells: µs a shell and attempt, on one and two threads.
//!
//! `cargo bench -p calcine-interior --bench radial`

#![allow(clippy::unwrap_used, clippy::print_stdout, missing_docs)]

use std::time::Instant;

use calcine_interior::radial::{
    PoreGas, PorousSolid, Radial, RadialNumerics, ShellGrid, ShellResolution,
};
use calcine_interior::reacting::{Rate, Reaction, SizeChange, SolidChemistry};
use calcine_interior::{GasLines, Newcomer, ParticleModel, Surroundings, TEMPERATURE};
use calcine_physics::conduction::Conductivity;
use calcine_physics::film::{FilmCoefficient, FilmTemperature, FilmTheory, StefanFlow};
use calcine_physics::pores::{Permeability, PorousConductivity};
use calcine_physics::reaction::conversion::FirstOrder;
use calcine_physics::reaction::equilibrium::GibbsLine;
use calcine_physics::reaction::{Arrhenius, Conversion, Equilibrium};
use calcine_physics::solids::SolidSpecies;
use calcine_physics::sphere;
use calcine_physics::thermo::Mixture;

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
    };
    let pores = PoreGas {
        pressure: 101_325.0,
        fractions: vec![0.0, 1.0],
    };
    let numerics = RadialNumerics {
        resolution: ShellResolution::All,
        ..RadialNumerics::new(ShellGrid {
            shells: SHELLS,
            grading: 2.0,
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

/// Wall time in s of an attempt, and steps of a particle in it.
fn attempt(model: &mut Radial, radius: f64, count: usize, span: f64) -> (f64, f64) {
    let gas = Mixture::new(["CO2", "N2"]).unwrap();
    let composition = gas.mass_fractions(&[0.2, 0.8]).repeat(count);
    let around = Surroundings {
        temperature: &vec![1400.0; count],
        pressure: &vec![101_325.0; count],
        composition: &composition,
        conductance: &vec![100.0 * sphere::surface(radius); count],
        film: &vec![FilmCoefficient::constant(0.1); 2 * count],
        theory: FilmTheory {
            temperature: FilmTemperature::TwoThirds,
            stefan_flow: StefanFlow::Mass,
        },
        radius: &vec![radius; count],
        end: 0.0,
    };
    let mut lines = GasLines::default();
    lines.reset(count, 2);
    let network = vec![0.0; count];
    let before = model.work()[0];
    let start = Instant::now();
    model.respond(&around, span, &network, &mut lines).unwrap();
    let time = start.elapsed().as_secs_f64();
    (time, (model.work()[0] - before) as f64 / count as f64)
}

fn main() {
    for (radius, span, what) in [
        (10e-3, 1.0, "stones of 20 mm, windows of 1 s"),
        (10e-3, 10.0, "stones of 20 mm, windows of 10 s"),
    ] {
        for threads in [1, 2] {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads);
            let pool = pool.build().unwrap();
            let count = 2000;
            let mut model = stones(radius, count as u64);
            let (time, steps) = pool.install(|| {
                attempt(&mut model, radius, count, span);
                attempt(&mut model, radius, count, span)
            });
            let each = 1e6 * time / (count * SHELLS) as f64;
            println!(
                "{what}, {threads} threads: {each:.2} µs a shell and attempt ({:.2} of processor time), {steps:.1} steps; {} bytes a particle",
                each * threads as f64,
                model.bytes()
            );
        }
    }
}
