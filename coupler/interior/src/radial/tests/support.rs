//! Particles to test with.

use calcine_physics::conduction::Conductivity;
use calcine_physics::film::{FilmCoefficient, FilmTemperature, FilmTheory, StefanFlow};
use calcine_physics::pores::{Permeability, PorousConductivity};
use calcine_physics::reaction::{Arrhenius, Equilibrium, PowerLaw};
use calcine_physics::solid::HeatCapacity;
use calcine_physics::solids::SolidSpecies;
use calcine_physics::sphere;
use calcine_physics::thermo::Mixture;

use crate::model::{GasLines, NetworkHeat, Newcomer, ParticleModel, Surroundings, Transfer};
use crate::radial::{
    PoreGas, PorousSolid, Radial, RadialNumerics, ShellGrading, ShellGrid, ShellResolution,
};
use crate::reacting::{Rate, Reaction, SizeChange, SolidChemistry};
use crate::thin::TEMPERATURE;

/// The gas outside, held.
#[derive(Clone, Debug)]
pub struct Still {
    pub temperature: f64,
    pub pressure: f64,
    pub composition: Vec<f64>,
    pub conductance: f64,
    /// β in m/s of all gases.
    pub film: f64,
    pub network: f64,
}

impl Still {
    pub fn around<'a>(&'a self, lists: &'a Lists) -> Surroundings<'a> {
        Surroundings {
            temperature: &lists.temperature,
            pressure: &lists.pressure,
            composition: &lists.composition,
            conductance: &lists.conductance,
            film: &lists.film,
            theory: FilmTheory {
                temperature: FilmTemperature::TwoThirds,
                stefan_flow: StefanFlow::Molar,
            },
            radius: &lists.radius,
            end: 0.0,
        }
    }
}

pub struct Lists {
    temperature: Vec<f64>,
    pressure: Vec<f64>,
    composition: Vec<f64>,
    conductance: Vec<f64>,
    film: Vec<FilmCoefficient>,
    radius: Vec<f64>,
}

impl Lists {
    pub fn of(still: &Still, radius: f64, count: usize) -> Self {
        let gases = still.composition.len();
        Self {
            temperature: vec![still.temperature; count],
            pressure: vec![still.pressure; count],
            composition: still.composition.repeat(count),
            conductance: vec![still.conductance; count],
            film: vec![FilmCoefficient::constant(still.film); gases * count],
            radius: vec![radius; count],
        }
    }
}

/// One window of all particles, with what they say exchanged as they say it; what passed, gas in mol of the first particle.
pub fn window(model: &mut Radial, still: &Still, radius: f64, span: f64) -> Vec<f64> {
    let done = attempt(model, still, radius, span);
    model.commit();
    done
}

pub fn attempt(model: &mut Radial, still: &Still, radius: f64, span: f64) -> Vec<f64> {
    attempt_off(model, still, radius, span, 1.0)
}

/// The same, with so much of what they say.
pub fn attempt_off(
    model: &mut Radial,
    still: &Still,
    radius: f64,
    span: f64,
    share: f64,
) -> Vec<f64> {
    let count = model.bodies(crate::model::At::Commit).temperature.len();
    let lists = Lists::of(still, radius, count);
    let around = still.around(&lists);
    let channels = model.channels().len();
    let mut lines = GasLines::default();
    lines.reset(count, channels);
    let network = vec![still.network; count];
    let given: Vec<NetworkHeat> = network.iter().map(|q| NetworkHeat::constant(*q)).collect();
    model.respond(&around, span, &given, &mut lines).unwrap();
    let heat: Vec<f64> = (0..count)
        .map(|p| share * lines.conductance[p] * (still.temperature - lines.temperature[p]))
        .collect();
    let mut rates = vec![0.0; count * channels];
    let mut carried = vec![0.0; count];
    for p in 0..count {
        for (k, channel) in model.channels().iter().enumerate() {
            let at = p * channels + k;
            let fraction = channel.key.map_or(0.0, |key| still.composition[key]);
            rates[at] = share * (lines.slope[at] * fraction - lines.offset[at]);
        }
    }
    if let Some(gas) = &model.physics.chemistry.gas {
        for p in 0..count {
            for (k, one) in gas.species().iter().enumerate() {
                carried[p] -=
                    rates[p * channels + k] * one.molar_mass() * one.enthalpy(lines.released[p]);
            }
        }
    }
    let took = Transfer {
        heat: &heat,
        network: &network,
        carried: &carried,
        rates: &rates,
    };
    model.settle(&took, span).unwrap();
    rates[..channels].iter().map(|rate| rate * span).collect()
}

pub fn grid(shells: usize) -> ShellGrid {
    ShellGrid {
        shells,
        grading: ShellGrading::Ratio(1.0),
    }
}

/// Tolerances that let every window be one step.
pub fn one_step(grid: ShellGrid) -> RadialNumerics {
    RadialNumerics {
        grid,
        resolution: ShellResolution::All,
        temperature: f64::INFINITY,
        conversion: f64::INFINITY,
    }
}

pub fn porous(solids: &[f64], conductivity: f64) -> PorousSolid {
    PorousSolid {
        true_densities: solids.to_vec(),
        conductivity: Conductivity::constant(conductivity),
        conduction: PorousConductivity::Stated,
        pore_diameter: 1e-6,
        tortuosity: 2.0,
        permeability: Permeability::Constant(1e-13),
        size: SizeChange::Constant,
        standing_gas: None,
    }
}

/// A solid without gas, reactions or pores: heat alone.
pub fn inert(density: f64, capacity: f64, conductivity: f64, numerics: RadialNumerics) -> Radial {
    let solid =
        SolidSpecies::new("inert", "C", 0.0, 1.0, HeatCapacity::constant(capacity)).unwrap();
    let chemistry = SolidChemistry::new(vec![solid], None, Vec::new()).unwrap();
    Radial::new(
        chemistry,
        &[1.0],
        porous(&[2.0 * density], conductivity),
        PoreGas::default(),
        numerics,
    )
    .unwrap()
}

pub fn put(model: &mut Radial, radius: f64, density: f64, kelvin: f64, count: u64) {
    let state: [(&str, &[f64]); 1] = [(TEMPERATURE, &[kelvin])];
    let new: Vec<Newcomer<'_>> = (1..=count)
        .map(|id| Newcomer {
            id,
            mass: sphere::mass(radius, density),
            radius,
            state: &state,
        })
        .collect();
    model.change(&[], &new).unwrap();
}

pub const LIME_RADIUS: f64 = 10e-3;
pub const LIME_DENSITY: f64 = 2440.0;

/// A limestone of porosity 0.1 in CO2 and N2 by first order with the equilibrium of the Gibbs energies.
pub fn limestone(factor: f64, numerics: RadialNumerics) -> Radial {
    let solids = ["CaCO3", "CaO"]
        .map(|name| SolidSpecies::built_in(name).unwrap())
        .to_vec();
    let gas = Mixture::new(["CO2", "N2"]).unwrap();
    let change = |t: f64| {
        solids[1].gibbs_energy(t) - solids[0].gibbs_energy(t)
            + gas.species()[0].polynomial().gibbs_energy(t)
    };
    let equilibrium = Equilibrium::Gibbs(calcine_physics::reaction::equilibrium::GibbsLine::new(
        change,
    ));
    let reaction = Reaction {
        name: "calcination".into(),
        solids: vec![(0, -1.0), (1, 1.0)],
        gases: vec![(0, 1.0)],
        rate: Rate::Power(PowerLaw {
            rate_constant: Arrhenius {
                factor,
                exponent: 0.0,
                activation_energy: 325.1e3,
            },
            in_series: None,
            solids: vec![(0, 1.0)],
            gases: Vec::new(),
        }),
        equilibrium,
    };
    let chemistry = SolidChemistry::new(solids, Some(gas), vec![reaction]).unwrap();
    let pores = PoreGas {
        pressure: 101_325.0,
        fractions: vec![0.0, 1.0],
    };
    Radial::new(
        chemistry,
        &[1.0, 0.0],
        porous(&[2711.0, 3340.0], 0.6),
        pores,
        numerics,
    )
    .unwrap()
}

/// Gas of 20 % CO2 about it.
pub fn flue_gas(kelvin: f64) -> Still {
    let gas = Mixture::new(["CO2", "N2"]).unwrap();
    Still {
        temperature: kelvin,
        pressure: 101_325.0,
        composition: gas.mass_fractions(&[0.2, 0.8]),
        conductance: 100.0 * sphere::surface(LIME_RADIUS),
        film: 0.1,
        network: 0.0,
    }
}

/// Mean temperature of the first particle in K, over the volume with which it came.
pub fn mean(model: &Radial) -> f64 {
    let row = model.row(0);
    let shells = 0..model.shells_of(row);
    shells
        .map(|k| model.share(row, k) * model.shell_temperature(row, k))
        .sum()
}
