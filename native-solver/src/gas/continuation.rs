//! The state before the first window: the gas of the setup, or what another run left.

use std::path::Path;

use calcine_coupler::setup::GasStart;

use super::boundary::FaceCondition;
use super::state::GasState;
use super::{NativeError, NativeGas, STATE, start, turbulence};
use crate::numerics::parallel::fill;

impl NativeGas {
    /// Starts from the fields that another run on the same mesh left in a checkpoint's folder:
    /// temperature, composition, pressure, superficial velocity, mass flux and eddies. What follows from
    /// them (mass, enthalpy) is by the properties and the bed of this run, so that both may have
    /// changed. The base pressure is the setup's, in a closed domain the other run's.
    pub fn take_over(&mut self, directory: &Path) -> Result<(), NativeError> {
        let species = self.setup.properties.species().len();
        let (cells, faces) = (self.mesh.cells(), self.grid.faces.len());
        let state = GasState::read(&directory.join(STATE), cells, faces, species)?;
        self.begin_with(state);
        Ok(())
    }

    /// True where a native gas left its state in a checkpoint's folder.
    pub fn left_state(directory: &Path) -> bool {
        directory.join(STATE).is_file()
    }

    /// Starts from the fields of a gas of another solver on the same mesh. Mass fluxes are those of its velocity at
    /// the faces; eddies begin as the setup says.
    pub fn start_from(&mut self, other: &GasStart) {
        let gas = &self.setup.properties;
        let species = gas.species().len();
        let mut state = start(&self.setup, self.mesh.cells(), self.grid.faces.len());
        state.temperature.clone_from(&other.temperature);
        state.composition.clone_from(&other.composition);
        state.velocity.clone_from(&other.velocity);
        let base = state.base_pressure;
        state.pressure = other.pressure.iter().map(|pascal| pascal - base).collect();
        let mass_flux = |cell: usize| {
            let composition = state.composition_of(cell, species);
            let density = gas.density(base, state.temperature[cell], composition);
            density * state.velocity[cell]
        };
        let (grid, mut flux) = (&self.grid, vec![0.0; self.grid.faces.len()]);
        fill(&mut flux, |index| {
            let face = &grid.faces[index];
            let through = match index < grid.internal {
                true => 0.5 * (mass_flux(face.owner) + mass_flux(face.neighbour)),
                false => mass_flux(face.owner),
            };
            face.area * through.dot(&face.normal)
        });
        state.flux = flux;
        self.begin_with(state);
    }

    fn begin_with(&mut self, mut state: GasState) {
        let gas = &self.setup.properties;
        let (species, cells) = (gas.species().len(), self.mesh.cells());
        if !self.boundaries.closed() {
            let shift = state.base_pressure - self.setup.pressure;
            state.pressure.iter_mut().for_each(|value| *value += shift);
            state.base_pressure = self.setup.pressure;
        }
        for cell in 0..cells {
            let temperature = state.temperature[cell];
            state.enthalpy[cell] = gas.enthalpy(temperature, state.composition_of(cell, species));
        }
        state.heat_remainder.fill(0.0);
        state.turbulence.begin(&self.setup.turbulence, cells);
        self.now.take(&state);
        for (velocity, pores) in state.velocity.iter_mut().zip(&state.void_fraction) {
            *velocity *= *pores;
        }
        state.mass.clear();
        state.void_fraction.clear();
        self.committed.take(&state);
        self.started = false;
        self.taken_over = Some(state);
        self.update_fields();
    }

    /// The state before anything is known of the bed; its velocity is superficial.
    pub(super) fn origin(&self) -> GasState {
        let new = || start(&self.setup, self.mesh.cells(), self.grid.faces.len());
        self.taken_over.clone().unwrap_or_else(new)
    }

    /// Fills the pores of the bed with the gas to start the first window from.
    pub(super) fn place(&mut self) {
        let origin = self.origin();
        let (state, setup, grid) = (&mut self.committed, &self.setup, &self.grid);
        let (gas, species) = (&setup.properties, setup.properties.species().len());
        let density = |cell: usize| {
            let composition = origin.composition_of(cell, species);
            gas.density(origin.base_pressure, origin.temperature[cell], composition)
        };
        state.mass.resize(grid.cells(), 0.0);
        fill(&mut state.mass, |cell| {
            density(cell) * self.void_fraction[cell] * grid.volume[cell]
        });
        fill(&mut state.velocity, |cell| {
            origin.velocity[cell] / self.void_fraction[cell]
        });
        let boundaries = &self.boundaries;
        let taken_over = self.taken_over.is_some();
        fill(&mut state.flux, |index| {
            let face = &grid.faces[index];
            let closed = index >= grid.internal
                && matches!(boundaries.at(index), FaceCondition::Wall { .. });
            if closed {
                0.0
            } else if taken_over {
                origin.flux[index]
            } else {
                density(face.owner) * face.area * setup.velocity.dot(&face.normal)
            }
        });
        state.void_fraction.clone_from(&self.void_fraction);
        state.turbulence.begin(&setup.turbulence, grid.cells());
        turbulence::update_viscosity(grid, boundaries, gas, &setup.turbulence, state);
    }
}
