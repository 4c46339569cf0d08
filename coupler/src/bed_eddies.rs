//! Eddies that the flow through a bed makes in its pores, cell by cell (docs/theory.md, TRB-1).

use calcine_numerics::parallel::fill;
use calcine_physics::law::NONE;
use calcine_physics::local::LocalGas;
use calcine_physics::numbers::VoidFraction;
use calcine_physics::turbulence::{BedEddies, EddySource};
use calcine_physics::{Vec3, sphere};

use crate::closures::Closures;
use crate::part::{Bed, EddyExchange, GasFields, ParticleFields};
use crate::smoother::Operator;
use crate::turbulence::is_free;

/// What the law is evaluated on, beside the gas.
#[derive(Clone, Copy, Debug)]
pub struct BedEddyInputs<'a> {
    /// The operator W.
    pub operator: &'a Operator,
    /// Void fractions.
    pub bed: &'a Bed,
    /// The particles.
    pub particles: ParticleFields<'a>,
    /// The acceleration factor.
    pub acceleration: f64,
}

/// The solid of each cell by W, with its scratch memory.
#[derive(Debug, Default)]
pub struct BedEddyStage {
    /// What the gas is told.
    pub exchange: EddyExchange,
    of_particles: Vec<Vec3>,
    /// Solid volume in m³ and surface in m² of each cell.
    solid: Vec<Vec3>,
    /// Solid volume times velocity of each cell in m⁴/s.
    moved: Vec<Vec3>,
    source: Vec<EddySource>,
}

impl BedEddyStage {
    /// Evaluates the law on the gas as it is, in all cells of the bed; with the law that does nothing all lists are empty.
    ///
    /// The diameter is that of spheres of the cell's surface per volume, 6 Σ W V_p/Σ W A_p; the slip is that between the
    /// cell's gas and the mean velocity of its solid volume, u − v/AF.
    pub fn evaluate(
        &mut self,
        closures: &Closures,
        inputs: &BedEddyInputs<'_>,
        gas: &GasFields<'_>,
    ) {
        let law = &*closures.bed_eddies;
        if law.name() == NONE {
            self.exchange = EddyExchange::default();
            return;
        }
        self.gather(inputs);
        let (solid, moved) = (&self.solid, &self.moved);
        self.source.resize(solid.len(), EddySource::default());
        fill(&mut self.source, |cell| {
            let [volume, surface] = [solid[cell].x, solid[cell].y];
            let pores = inputs.bed.void_fraction[cell];
            if is_free(pores) || !(volume > 0.0 && surface > 0.0) {
                return EddySource::default();
            }
            let drift = moved[cell] / volume / inputs.acceleration;
            let slip = (gas.velocity[cell] - drift).norm();
            of_cell(
                law,
                closures,
                gas,
                (cell, pores, slip),
                6.0 * volume / surface,
            )
        });
        let source = &self.source;
        let lists = [
            &mut self.exchange.energy,
            &mut self.exchange.dissipation,
            &mut self.exchange.growth,
        ];
        for list in lists {
            list.resize(source.len(), 0.0);
        }
        fill(&mut self.exchange.energy, |cell| source[cell].energy);
        fill(&mut self.exchange.dissipation, |cell| {
            source[cell].dissipation
        });
        fill(&mut self.exchange.growth, |cell| source[cell].growth);
    }

    /// Solid volume, surface and velocity of each cell.
    fn gather(&mut self, inputs: &BedEddyInputs<'_>) {
        let (operator, particles) = (inputs.operator, &inputs.particles);
        for list in [&mut self.solid, &mut self.moved] {
            list.resize(operator.cells(), Vec3::zeros());
        }
        self.of_particles.resize(particles.len(), Vec3::zeros());
        let (radius, velocity) = (particles.radius, particles.velocity);
        fill(&mut self.of_particles, |p| {
            Vec3::new(sphere::volume(radius[p]), sphere::surface(radius[p]), 0.0)
        });
        operator.spread_vectors(&self.of_particles, &mut self.solid);
        fill(&mut self.of_particles, |p| {
            sphere::volume(radius[p]) * velocity[p]
        });
        operator.spread_vectors(&self.of_particles, &mut self.moved);
    }
}

/// What the law makes in a cell of a void fraction and a slip in m/s, with a diameter in m.
fn of_cell(
    law: &dyn BedEddies,
    closures: &Closures,
    gas: &GasFields<'_>,
    (cell, pores, slip): (usize, f64, f64),
    diameter: f64,
) -> EddySource {
    // A void fraction that is none is told by the laws of the particles there.
    let Ok(void_fraction) = VoidFraction::new(pores) else {
        return EddySource::default();
    };
    let (properties, temperature) = (&closures.gas, gas.temperature[cell]);
    let species = properties.species().len();
    let composition = &gas.composition[cell * species..(cell + 1) * species];
    let local = LocalGas {
        void_fraction,
        density: gas.density[cell],
        viscosity: properties.viscosity(temperature, composition),
        conductivity: properties.conductivity(temperature, composition),
        heat_capacity: properties.heat_capacity(temperature, composition),
        slip,
    };
    law.source(&local, diameter)
}
