//! Laws between the phases, evaluated once per window, here and nowhere else.

use std::f64::consts::PI;

use calcine_physics::Vec3;
use calcine_physics::drag::Drag;
use calcine_physics::figures::Brief;
use calcine_physics::film::{
    FILM_TEMPERATURES, FilmCoefficient, FilmDiffusivity, FilmState, FilmTemperature, FilmTheory,
};
use calcine_physics::gas_model::GasModel;
use calcine_physics::heat_transfer::HeatTransfer;
use calcine_physics::local::LocalGas;
use calcine_physics::mass_transfer;
use calcine_physics::numbers::VoidFraction;
use calcine_physics::turbulence::BedEddies;
use rayon::prelude::*;
use thiserror::Error;

use crate::excursion::{FlowExcursion, LawExcursions};
use crate::momentum_model::MomentumModel;
use crate::part::{Bed, GasFields, ParticleFields};
use crate::smoother::Operator;

/// Particles that one thread takes at a time.
const CHUNK: usize = 1024;

/// The laws of a run.
#[derive(Debug)]
pub struct Closures {
    /// Properties of the gas.
    pub gas: GasModel,
    /// Drag on a particle.
    pub drag: Box<dyn Drag>,
    /// How the momentum is shared, which says what of the drag law's coefficient acts.
    pub momentum: MomentumModel,
    /// Heat transfer between gas and particle.
    pub heat_transfer: Box<dyn HeatTransfer>,
    /// At which temperature the properties of the gas in it are taken.
    pub heat_film: FilmTemperature,
    /// Mass transfer between gas and particles that react, by the analogy with heat transfer; only asked for
    /// where some do.
    pub mass_transfer: Box<dyn HeatTransfer>,
    /// By which diffusivities.
    pub film_diffusivity: FilmDiffusivity,
    /// What the particles of a bed make of eddies.
    pub bed_eddies: Box<dyn BedEddies>,
    /// How it is computed.
    pub film: FilmTheory,
}

/// A law that got a state it is not defined for.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum ClosureError {
    /// A void fraction outside (0, 1].
    #[error("particle {id} sees a void fraction of {value}, which is not in (0, 1]", value = Brief(*.value))]
    VoidFraction {
        /// The particle's id.
        id: u64,
        /// The void fraction.
        value: f64,
    },
    /// A coefficient that is negative or not finite.
    #[error(
        "the {law} coefficient of particle {id} is {value} {unit} at a gas temperature of {temperature} K and a slip of {slip} \
         m/s; it must be finite and zero or above: look at `warnings` of summary.json for what left its range before, shorten \
         the windows, or choose another law", value = Brief(*.value), temperature = Brief(*.temperature), slip = Brief(*.slip))]
    Coefficient {
        /// Which law.
        law: &'static str,
        /// The particle's id.
        id: u64,
        /// The coefficient.
        value: f64,
        /// Its unit.
        unit: &'static str,
        /// Gas temperature that the particle sees, in K.
        temperature: f64,
        /// Slip velocity in m/s.
        slip: f64,
    },
}

/// The gas that each particle sees: Wᵀ applied to the gas.
#[derive(Clone, Debug, Default)]
pub struct SampledGas {
    /// Temperature in K.
    pub temperature: Vec<f64>,
    /// Density in kg/m³.
    pub density: Vec<f64>,
    /// Mass fractions, species by species within each particle; empty for a single gas.
    pub composition: Vec<f64>,
    /// Interstitial velocity in m/s.
    pub velocity: Vec<Vec3>,
    /// Void fraction.
    pub void_fraction: Vec<f64>,
}

impl SampledGas {
    /// Samples all that the laws need.
    pub fn sample(&mut self, operator: &Operator, gas: &GasFields<'_>, bed: &Bed) {
        let particles = operator.particles();
        self.temperature.resize(particles, 0.0);
        self.density.resize(particles, 0.0);
        self.velocity.resize(particles, Vec3::zeros());
        self.void_fraction.resize(particles, 0.0);
        operator.sample(gas.temperature, &mut self.temperature);
        operator.sample(gas.density, &mut self.density);
        self.sample_composition(operator, gas.composition);
        operator.sample_vectors(gas.velocity, &mut self.velocity);
        operator.sample(&bed.void_fraction, &mut self.void_fraction);
    }

    fn sample_composition(&mut self, operator: &Operator, composition: &[f64]) {
        let (cells, particles) = (operator.cells(), operator.particles());
        let species = composition.len() / cells.max(1);
        self.composition.resize(species * particles, 0.0);
        let mut one = vec![0.0; if species == 0 { 0 } else { cells }];
        let mut sampled_gas = vec![0.0; if species == 0 { 0 } else { particles }];
        for k in 0..species {
            for (cell, value) in one.iter_mut().enumerate() {
                *value = composition[cell * species + k];
            }
            operator.sample(&one, &mut sampled_gas);
            for (p, value) in sampled_gas.iter().enumerate() {
                self.composition[p * species + k] = *value;
            }
        }
    }
}

/// Coefficients per particle, fixed over the window.
#[derive(Clone, Debug, Default)]
pub struct CouplingCoefficients {
    /// Mass transfer coefficient of each species over the temperature of the film, species by species within each
    /// particle; empty where none reacts.
    pub film: Vec<FilmCoefficient>,
    /// Drag coefficient in kg/s: K_A by model A, K_A/ε by model B (docs/theory.md, DRG-1).
    pub drag: Vec<f64>,
    /// Heat conductance h A in W/K.
    pub conductance: Vec<f64>,
    /// Magnitude of the slip u − v/AF in m/s by which they were evaluated.
    pub slip: Vec<f64>,
    /// Conductivity of the gas in W/m/K.
    pub gas_conductivity: Vec<f64>,
    /// The drag coefficients in kg/s before [`CouplingCoefficients::relax`], by which drag follows a particle.
    pub instantaneous_drag: Vec<f64>,
    /// Share of the other forces in N that drag holds back within the window (docs/theory.md,
    /// DRG-2, see [`CouplingCoefficients::relax`]); zero, or empty, where particles are held.
    pub held_back: Vec<Vec3>,
    /// Where the laws were evaluated outside the ranges that their sources state.
    pub outside: LawExcursions,
}

/// What particles are to their drag besides their velocity, one value each.
#[derive(Clone, Copy, Debug)]
pub struct DragInertia<'a> {
    /// Masses in kg.
    pub mass: &'a [f64],
    /// True for those that move.
    pub free: &'a [bool],
    /// Everything but drag that acted on each in the last window, contacts included, in N.
    pub other: &'a [Vec3],
    /// The coming window's motion span in s.
    pub span: f64,
    /// Its acceleration factor.
    pub acceleration: f64,
}

impl CouplingCoefficients {
    /// Stiff drag (docs/theory.md, DRG-2). The force on a particle is constant over a window; it is the
    /// mean of what acts on one that moves by drag and by all else as in the last window:
    /// m dv/dt = K (u − v/AF) + F. With a = K Δt/(m AF) and φ = (1 − e^−a)/a that mean is
    ///
    /// K φ (u − v/AF) − (1 − φ) F,
    ///
    /// with the velocity v at the window's start. A free particle relaxes without overshoot however
    /// long the window; one that contacts hold has F = −K u at rest and feels its full drag K u.
    pub fn relax(&mut self, inertia: &DragInertia<'_>) {
        self.held_back.clear();
        self.instantaneous_drag.clone_from(&self.drag);
        for (p, drag) in self.drag.iter_mut().enumerate() {
            if !inertia.free[p] {
                self.held_back.push(Vec3::zeros());
                continue;
            }
            let a = *drag * inertia.span / (inertia.mass[p] * inertia.acceleration);
            let share = if a > 0.0 { -(-a).exp_m1() / a } else { 1.0 };
            *drag *= share;
            self.held_back.push((1.0 - share) * inertia.other[p]);
        }
    }

    fn back(&self, p: usize) -> Vec3 {
        self.held_back.get(p).copied().unwrap_or_default()
    }

    /// Drag on particle p in N at the slip u − v/AF in m/s of a window's start.
    pub fn drag_at(&self, p: usize, slip: Vec3) -> Vec3 {
        self.drag[p] * slip - self.back(p)
    }

    /// What does not depend on the gas of the drag on the gas, in N.
    pub fn drag_source(&self, p: usize, velocity: Vec3, acceleration: f64) -> Vec3 {
        self.drag[p] * velocity / acceleration + self.back(p)
    }
}

impl Closures {
    /// Evaluates mass transfer at these pressures in Pa about surfaces of these temperatures in K, for particles that react.
    pub fn evaluate_films(
        &self,
        sampled_gas: &SampledGas,
        particles: &ParticleFields<'_>,
        [pressure, surface]: [&[f64]; 2],
        acceleration: f64,
        coefficients: &mut CouplingCoefficients,
    ) -> Result<(), ClosureError> {
        let GasModel::Mixture(mixture) = &self.gas else {
            coefficients.film.clear();
            return Ok(());
        };
        let range = self.mass_transfer.range();
        let species = mixture.names().len();
        let none = FilmCoefficient::default();
        coefficients.film.resize(species * particles.len(), none);
        let chunks = coefficients.film.par_chunks_mut((species * CHUNK).max(1));
        let each = chunks.enumerate().map(|(chunk, films)| {
            let mut diffusivities = vec![0.0; species];
            let mut values = vec![[0.0; 3]; species];
            let mut outside = FlowExcursion::default();
            for (row, films) in films.chunks_exact_mut(species).enumerate() {
                let p = chunk * CHUNK + row;
                let own = p * species..(p + 1) * species;
                let composition = &sampled_gas.composition[own];
                let (law, diameter) = (&*self.mass_transfer, 2.0 * particles.radius[p]);
                let gas = sampled_gas.temperature[p];
                let at = self.film.temperature.of(surface[p], gas);
                for (place, factor) in FILM_TEMPERATURES.iter().enumerate() {
                    let temperature = factor * at;
                    let local = LocalGas {
                        void_fraction: void_fraction(sampled_gas, particles, p)?,
                        density: sampled_gas.density[p] * gas / temperature,
                        viscosity: mixture.viscosity(temperature, composition),
                        // Neither is part of a Schmidt number.
                        conductivity: 0.0,
                        heat_capacity: 1.0,
                        slip: slip(sampled_gas, particles, p, acceleration),
                    };
                    let state = FilmState {
                        pressure: pressure[p],
                        temperature,
                        density: local.density,
                        viscosity: local.viscosity,
                        composition,
                    };
                    let law_of_diffusion = &self.film_diffusivity;
                    law_of_diffusion.fill(mixture, &state, &mut diffusivities);
                    if *factor == 1.0 {
                        outside.look(&range, p, &local, diameter);
                    }
                    for (values, diffusivity) in values.iter_mut().zip(&diffusivities) {
                        values[place] =
                            mass_transfer::coefficient(law, &local, *diffusivity, diameter);
                    }
                }
                for (film, values) in films.iter_mut().zip(&values) {
                    *film = FilmCoefficient::through(at, *values);
                }
            }
            Ok(outside)
        });
        let outcomes: Vec<Result<FlowExcursion, ClosureError>> = each.collect();
        let mut outside = FlowExcursion::default();
        for outcome in outcomes {
            outside.add(&outcome?);
        }
        coefficients.outside.mass_transfer = outside;
        Ok(())
    }

    /// Evaluates all laws about surfaces of these temperatures in K. Slip is u − v/AF (docs/theory.md, TSM-7).
    pub fn evaluate(
        &self,
        sampled_gas: &SampledGas,
        particles: &ParticleFields<'_>,
        surface: &[f64],
        acceleration: f64,
        coefficients: &mut CouplingCoefficients,
    ) -> Result<(), ClosureError> {
        let count = particles.len();
        coefficients.drag.resize(count, 0.0);
        coefficients.conductance.resize(count, 0.0);
        coefficients.slip.resize(count, 0.0);
        coefficients.gas_conductivity.resize(count, 0.0);
        let chunks = (coefficients.drag.par_chunks_mut(CHUNK))
            .zip(coefficients.conductance.par_chunks_mut(CHUNK))
            .zip(coefficients.slip.par_chunks_mut(CHUNK))
            .zip(coefficients.gas_conductivity.par_chunks_mut(CHUNK));
        let ranges = [self.drag.range(), self.heat_transfer.range()];
        let outcomes: Vec<Result<[FlowExcursion; 2], ClosureError>> = chunks
            .enumerate()
            .map(|(chunk, (((drag, conductance), slip), gas_conductivity))| {
                let mut outside = [FlowExcursion::default(); 2];
                for row in 0..drag.len() {
                    let p = chunk * CHUNK + row;
                    let local = self.local(p, sampled_gas, particles, acceleration)?;
                    let diameter = 2.0 * particles.radius[p];
                    let ranges = [ranges[0].of_force(&local), ranges[1]];
                    for (found, range) in outside.iter_mut().zip(&ranges) {
                        found.look(range, p, &local, diameter);
                    }
                    let film = self.film(p, sampled_gas, surface[p], &local);
                    [drag[row], conductance[row]] =
                        self.of_particle(p, sampled_gas, particles, [&local, &film])?;
                    (slip[row], gas_conductivity[row]) = (local.slip, local.conductivity);
                }
                Ok(outside)
            })
            .collect();
        coefficients.outside = LawExcursions::default();
        let all = &mut coefficients.outside;
        for outcome in outcomes {
            // The error of the first particle that has one.
            let [drag, heat_transfer] = outcome?;
            all.drag.add(&drag);
            all.heat_transfer.add(&heat_transfer);
        }
        Ok(())
    }

    /// The gas that a particle sees.
    fn local(
        &self,
        p: usize,
        sampled_gas: &SampledGas,
        particles: &ParticleFields<'_>,
        acceleration: f64,
    ) -> Result<LocalGas, ClosureError> {
        let species = self.gas.species().len();
        let temperature = sampled_gas.temperature[p];
        let composition = &sampled_gas.composition[p * species..(p + 1) * species];
        Ok(LocalGas {
            void_fraction: void_fraction(sampled_gas, particles, p)?,
            density: sampled_gas.density[p],
            viscosity: self.gas.viscosity(temperature, composition),
            conductivity: self.gas.conductivity(temperature, composition),
            heat_capacity: self.gas.heat_capacity(temperature, composition),
            slip: slip(sampled_gas, particles, p, acceleration),
        })
    }

    /// The same with the properties of the film by which heat passes to a surface of a temperature in K.
    fn film(&self, p: usize, sampled_gas: &SampledGas, surface: f64, local: &LocalGas) -> LocalGas {
        let gas = sampled_gas.temperature[p];
        let temperature = self.heat_film.of(surface, gas);
        if temperature == gas {
            return *local;
        }
        let species = self.gas.species().len();
        let composition = &sampled_gas.composition[p * species..(p + 1) * species];
        let expansion = match self.gas.compressible() {
            true => gas / temperature,
            false => 1.0,
        };
        LocalGas {
            density: local.density * expansion,
            viscosity: self.gas.viscosity(temperature, composition),
            conductivity: self.gas.conductivity(temperature, composition),
            heat_capacity: self.gas.heat_capacity(temperature, composition),
            ..*local
        }
    }

    /// Coefficients of drag and heat of one particle.
    fn of_particle(
        &self,
        p: usize,
        sampled_gas: &SampledGas,
        particles: &ParticleFields<'_>,
        [local, film]: [&LocalGas; 2],
    ) -> Result<[f64; 2], ClosureError> {
        let (id, temperature) = (particles.id[p], sampled_gas.temperature[p]);
        let diameter = 2.0 * particles.radius[p];
        let drag = self.drag.coefficient(local, diameter);
        // h A = (Nu κ/d) π d²
        let conductance =
            self.heat_transfer.nusselt(film, diameter) * film.conductivity * PI * diameter;
        let laws = [
            (self.drag.name(), drag, "kg/s"),
            (self.heat_transfer.name(), conductance, "W/K"),
        ];
        for (law, value, unit) in laws {
            if !(value.is_finite() && value >= 0.0) {
                let slip = local.slip;
                return Err(ClosureError::Coefficient {
                    law,
                    id,
                    value,
                    unit,
                    temperature,
                    slip,
                });
            }
        }
        let drag = self.momentum.coefficient(drag, local.void_fraction.value());
        Ok([drag, conductance])
    }
}

/// Magnitude of the slip u − v/AF of a particle in m/s.
fn slip(
    sampled_gas: &SampledGas,
    particles: &ParticleFields<'_>,
    p: usize,
    acceleration: f64,
) -> f64 {
    (sampled_gas.velocity[p] - particles.velocity[p] / acceleration).norm()
}

/// The void fraction that a particle sees.
fn void_fraction(
    sampled_gas: &SampledGas,
    particles: &ParticleFields<'_>,
    p: usize,
) -> Result<VoidFraction, ClosureError> {
    let value = sampled_gas.void_fraction[p];
    let id = particles.id[p];
    VoidFraction::new(value).map_err(|_| ClosureError::VoidFraction { id, value })
}

#[cfg(test)]
mod tests {
    use super::*;
    use calcine_physics::drag::ErgunWenYu;
    use calcine_physics::film::StefanFlow;
    use calcine_physics::gas_model::ConstantGas;
    use calcine_physics::heat_transfer::Gunn;
    use calcine_physics::turbulence::NoBedEddies;

    /// Coefficients on some threads of three chunks of particles, the last not full, that all differ.
    fn evaluated(
        threads: usize,
        spoil: impl Fn(&mut SampledGas),
    ) -> Result<CouplingCoefficients, ClosureError> {
        let closures = Closures {
            gas: GasModel::Constant(ConstantGas {
                density: 1.2,
                heat_capacity: 1000.0,
                viscosity: 1.8e-5,
                conductivity: 0.026,
            }),
            drag: Box::new(ErgunWenYu),
            momentum: MomentumModel::A,
            heat_transfer: Box::new(Gunn),
            heat_film: FilmTemperature::Gas,
            mass_transfer: Box::new(Gunn),
            film_diffusivity: FilmDiffusivity::Fuller,
            bed_eddies: Box::new(NoBedEddies),
            film: FilmTheory {
                temperature: FilmTemperature::TwoThirds,
                stefan_flow: StefanFlow::Mass,
            },
        };
        let count = 2 * CHUNK + 700;
        let of = |scale: f64| -> Vec<f64> {
            let share = |p: usize| (p as f64 * 0.618_033_988_749_895 * scale).fract();
            (0..count).map(share).collect()
        };
        let mut gas = SampledGas {
            temperature: of(1.0).iter().map(|x| 300.0 + x).collect(),
            density: of(2.0).iter().map(|x| 1.0 + x).collect(),
            composition: Vec::new(),
            velocity: of(3.0).iter().map(|x| Vec3::new(*x, 0.1, 1.0)).collect(),
            void_fraction: of(4.0).iter().map(|x| 0.4 + 0.5 * x).collect(),
        };
        spoil(&mut gas);
        let (ids, zero) = (Vec::from_iter(0..count as u64), vec![Vec3::zeros(); count]);
        let (radius, population) = (vec![1e-3; count], vec![0; count]);
        let particles = ParticleFields {
            id: &ids,
            population: &population,
            position: &zero,
            velocity: &zero,
            angular_velocity: &zero,
            radius: &radius,
            mass: &radius,
            weight: &[],
        };
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads);
        let mut coefficients = CouplingCoefficients::default();
        pool.build().unwrap().install(|| {
            closures.evaluate(&gas, &particles, &gas.temperature, 1.0, &mut coefficients)
        })?;
        Ok(coefficients)
    }

    #[test]
    fn coefficients_are_the_same_bits_on_one_thread_and_on_two() {
        let [one, two] = [1, 2].map(|threads| evaluated(threads, |_| {}).unwrap());
        let bits = |values: &[f64]| -> Vec<u64> { values.iter().map(|x| x.to_bits()).collect() };
        assert_eq!(bits(&one.drag), bits(&two.drag));
        assert_eq!(bits(&one.conductance), bits(&two.conductance));
        assert_eq!(bits(&one.slip), bits(&two.slip));
    }

    #[test]
    fn the_first_particle_that_a_law_refuses_is_named_on_any_number_of_threads() {
        let refused = |gas: &mut SampledGas| {
            gas.void_fraction[CHUNK + 3] = 1.5;
            gas.void_fraction[2 * CHUNK + 5] = -1.0;
        };
        for threads in [1, 2] {
            let error = evaluated(threads, refused).unwrap_err();
            let (id, value) = (CHUNK as u64 + 3, 1.5);
            assert_eq!(error, ClosureError::VoidFraction { id, value });
        }
    }

    #[test]
    fn flow_outside_a_law_s_range_is_counted_and_the_worst_particle_found() {
        let found = evaluated(2, |gas| gas.void_fraction[CHUNK + 3] = 0.2).unwrap();
        let voids = found.outside.heat_transfer.void_fraction;
        assert_eq!((voids.count, voids.place), (1, CHUNK + 3));
        assert_eq!((voids.value, voids.limit), (0.2, 0.35));
        assert_eq!(found.outside.drag, FlowExcursion::default());
        assert_eq!(
            evaluated(1, |gas| gas.void_fraction[CHUNK + 3] = 0.2)
                .unwrap()
                .outside,
            found.outside
        );
    }

    #[test]
    fn a_film_at_a_void_fraction_of_1_2_is_refused_with_the_particle_s_id() {
        let (air, composition) = calcine_physics::thermo::Mixture::air().unwrap();
        let closures = Closures {
            gas: GasModel::Mixture(air),
            drag: Box::new(ErgunWenYu),
            momentum: MomentumModel::A,
            heat_transfer: Box::new(Gunn),
            heat_film: FilmTemperature::Gas,
            mass_transfer: Box::new(Gunn),
            film_diffusivity: FilmDiffusivity::Fuller,
            bed_eddies: Box::new(NoBedEddies),
            film: FilmTheory {
                temperature: FilmTemperature::TwoThirds,
                stefan_flow: StefanFlow::Mass,
            },
        };
        let gas = SampledGas {
            temperature: vec![300.0; 2],
            density: vec![1.2; 2],
            composition: composition.repeat(2),
            velocity: vec![Vec3::zeros(); 2],
            void_fraction: vec![0.4, 1.2],
        };
        let particles = ParticleFields {
            id: &[7, 9],
            population: &[0; 2],
            position: &[Vec3::zeros(); 2],
            velocity: &[Vec3::zeros(); 2],
            angular_velocity: &[Vec3::zeros(); 2],
            radius: &[1e-3; 2],
            mass: &[1e-5; 2],
            weight: &[],
        };
        let mut coefficients = CouplingCoefficients::default();
        let about = [[1e5; 2], [300.0; 2]];
        let [pressure, surface] = &about;
        let refused = closures.evaluate_films(
            &gas,
            &particles,
            [pressure, surface],
            1.0,
            &mut coefficients,
        );
        let (id, value) = (9, 1.2);
        assert_eq!(refused, Err(ClosureError::VoidFraction { id, value }));
    }
}
