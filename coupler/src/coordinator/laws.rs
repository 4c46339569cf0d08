//! Stage: from the gas about the particles to the coefficients of the exchange.

use calcine_interior::without;

use super::bed::MappedBed;
use super::error::RunError;
use crate::bed_eddies::{BedEddyInputs, BedEddyStage};
use crate::closures::{Closures, CouplingCoefficients, DragInertia, SampledGas};
use crate::part::{GasFields, ParticleFields};
use crate::physical::UnphysicalGas;
use crate::time::Window;

/// Round-off of mass fractions.
const ROUND_OFF: f64 = 1e-9;

/// The laws, the gas that particles see, and what the laws made of it.
pub(super) struct LawStage {
    pub closures: Closures,
    pub sampled_gas: SampledGas,
    pub coefficients: CouplingCoefficients,
    /// What the particles make of eddies.
    pub eddies: BedEddyStage,
    /// Pressure in Pa that each particle sees; empty where no mass passes between gas and particles.
    pub pressure: Vec<f64>,
}

/// What the laws depend on in a window.
pub(super) struct LawInputs<'a> {
    pub mapped: &'a MappedBed,
    pub gas: GasFields<'a>,
    pub particles: ParticleFields<'a>,
    /// Temperatures of their surfaces in K.
    pub surface: &'a [f64],
    pub window: &'a Window,
    /// How particles that move follow their drag.
    pub inertia: DragInertia<'a>,
    /// True where mass passes between gas and particles.
    pub channels: bool,
}

impl LawStage {
    /// Before the first window the particles see the bed's voids only.
    pub fn new(closures: Closures, mapped: &MappedBed) -> Self {
        let mut stage = Self {
            closures,
            sampled_gas: SampledGas::default(),
            coefficients: CouplingCoefficients::default(),
            eddies: BedEddyStage::default(),
            pressure: Vec::new(),
        };
        let count = mapped.operator.particles();
        let pores = &mut stage.sampled_gas.void_fraction;
        pores.resize(count, 1.0);
        mapped.operator.sample(&mapped.bed.void_fraction, pores);
        stage.coefficients.slip.resize(count, 0.0);
        stage
    }

    /// Evaluates all laws on the gas as it is.
    pub fn evaluate(&mut self, inputs: &LawInputs<'_>) -> Result<(), RunError> {
        let (particles, window) = (&inputs.particles, inputs.window);
        let (sampled, coefficients) = (&mut self.sampled_gas, &mut self.coefficients);
        let (mapped, species) = (inputs.mapped, self.closures.gas.species().to_vec());
        sampled.sample(&mapped.operator, &inputs.gas, &mapped.bed);
        let acceleration = window.acceleration();
        let evaluated = self.closures.evaluate(
            sampled,
            particles,
            inputs.surface,
            acceleration,
            coefficients,
        );
        let refused = |cause| {
            let window = window.index;
            match UnphysicalGas::find(&inputs.gas, &species, ROUND_OFF) {
                Some(found) => RunError::ClosureInGas {
                    window,
                    found,
                    cause,
                },
                None => RunError::Closure { window, cause },
            }
        };
        evaluated.map_err(refused)?;
        coefficients.relax(&inputs.inertia);
        let bed = BedEddyInputs {
            operator: &mapped.operator,
            bed: &mapped.bed,
            particles: *particles,
            acceleration,
        };
        self.eddies.evaluate(&self.closures, &bed, &inputs.gas);
        if inputs.channels {
            self.sample_pressure(mapped, &inputs.gas);
            let evaluated = self.closures.evaluate_films(
                &self.sampled_gas,
                particles,
                [&self.pressure, inputs.surface],
                acceleration,
                &mut self.coefficients,
            );
            evaluated.map_err(refused)?;
        }
        Ok(())
    }

    /// Rows went, and others came up to a number of particles: what results show of the laws stays with its particle. One
    /// that came has no gas around it before its first window.
    pub fn change(&mut self, gone: &[usize], particles: usize) {
        for (shown, of_new) in [
            (&mut self.sampled_gas.void_fraction, 1.0),
            (&mut self.coefficients.slip, 0.0),
        ] {
            without(shown, gone);
            shown.resize(particles, of_new);
        }
    }

    /// Looks at the gas of the last attempt, with the coefficients as they are.
    pub fn sample_again(&mut self, mapped: &MappedBed, gas: &GasFields<'_>) {
        self.sampled_gas.sample(&mapped.operator, gas, &mapped.bed);
        self.sample_pressure(mapped, gas);
    }

    fn sample_pressure(&mut self, mapped: &MappedBed, gas: &GasFields<'_>) {
        self.pressure.resize(mapped.operator.particles(), 0.0);
        mapped.operator.sample(gas.pressure, &mut self.pressure);
    }
}
