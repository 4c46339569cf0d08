//! A gas that stays as it is, whatever the particles give it: to see what a given flow does to them.

use std::path::Path;

use calcine_physics::Vec3;
use calcine_physics::gas_model::GasModel;

use crate::boundary_value::BoundaryValue;
use crate::error::{FailureKind, PartError};
use crate::gas_columns::GasColumns;
use crate::mesh::Mesh;
use crate::part::{
    Backflow, Balance, Bed, CellExchange, CellReceived, Convergence, Gas, GasFields, Part,
    SolverInfo,
};
use crate::setup::GasSetup;
use crate::supervisor::Supervisor;
use crate::time::Window;

/// The gas of a setup at its start: its superficial velocity everywhere, its temperature, and a
/// pressure gradient of its own weight. What it receives goes to a reservoir, which its balances name.
#[derive(Debug)]
pub struct HeldGas {
    about: SolverInfo,
    superficial: Vec3,
    properties: GasModel,
    columns: GasColumns,
    exchange: CellExchange,
    window: Window,
    storage: crate::time::GasStorage,
}

impl HeldGas {
    /// The gas of a setup on a mesh; its pressure is that of the setup at the mesh's first cell.
    pub fn new(mesh: &Mesh, setup: &GasSetup) -> Self {
        let cells = mesh.cells();
        let gas = &setup.properties;
        let density = gas.density(setup.pressure, setup.temperature, &setup.composition);
        let weight = density * setup.gravity;
        let origin = mesh.cell_centre().first().copied().unwrap_or_default();
        let centres = mesh.cell_centre().iter();
        Self {
            about: SolverInfo {
                name: "held gas".into(),
                version: env!("CARGO_PKG_VERSION").into(),
                ranks: 1,
            },
            superficial: setup.velocity,
            properties: gas.clone(),
            columns: GasColumns {
                temperature: vec![setup.temperature; cells],
                pressure: centres
                    .map(|centre| setup.pressure + weight.dot(&(centre - origin)))
                    .collect(),
                density: vec![density; cells],
                composition: setup.composition.repeat(cells),
                velocity: vec![setup.velocity; cells],
                pressure_gradient: vec![weight; cells],
                ..GasColumns::default()
            },
            exchange: CellExchange::default(),
            window: Window::default(),
            storage: setup.storage,
        }
    }
}

impl Part for HeldGas {
    fn about(&self) -> &SolverInfo {
        &self.about
    }

    fn commit(&mut self) -> Result<(), PartError> {
        Ok(())
    }

    fn checkpoint(&mut self, _directory: &Path) -> Result<(), PartError> {
        Ok(())
    }
}

impl Gas for HeldGas {
    fn fields(&self) -> GasFields<'_> {
        self.columns.fields()
    }

    fn backflow(&self) -> Option<Backflow> {
        None
    }

    fn begins_again(&self) -> bool {
        true
    }

    fn turbulence_residual(&self) -> Option<f64> {
        None
    }

    fn set_boundary(&mut self, value: &BoundaryValue) -> Result<(), PartError> {
        let message = format!(
            "the condition `{}` at patch `{}` cannot be set: a gas that is held has no patches; write gas.held = false",
            value.quantity.name(),
            value.patch
        );
        Err(PartError::new(
            self.about.name.clone(),
            FailureKind::Refused,
            message,
        ))
    }

    fn start(
        &mut self,
        window: &Window,
        bed: &Bed,
        exchange: &CellExchange,
    ) -> Result<(), PartError> {
        for (velocity, pores) in self.columns.velocity.iter_mut().zip(&bed.void_fraction) {
            *velocity = self.superficial / *pores;
        }
        self.exchange.clone_from(exchange);
        self.window = *window;
        Ok(())
    }

    fn finish(
        &mut self,
        _supervisor: &Supervisor,
        received: &mut CellReceived,
    ) -> Result<Convergence, PartError> {
        let told = &self.exchange;
        let GasColumns {
            temperature,
            composition,
            velocity,
            ..
        } = &self.columns;
        let heats = told.heat_source.iter().zip(&told.heat_coefficient);
        received.heat.clear();
        received.heat.extend(
            heats
                .zip(temperature)
                .map(|((source, coefficient), kelvin)| source - coefficient * kelvin),
        );
        let species = composition.len() / temperature.len().max(1);
        let mut moved = vec![0.0; species];
        if !told.species.is_none() {
            for (cell, heat) in received.heat.iter_mut().enumerate() {
                *heat += told.species.heat[cell];
                for (k, moved) in moved.iter_mut().enumerate() {
                    let at = cell * species + k;
                    let enthalpy = self.properties.species_enthalpy(k, temperature[cell]);
                    *heat -= told.species.taken[at] * enthalpy;
                    *moved +=
                        told.species.source[at] - told.species.coefficient[at] * composition[at];
                }
            }
        }
        let drags = told.drag_source.iter().zip(&told.drag_coefficient);
        received.drag.clear();
        received.drag.extend(
            drags
                .zip(velocity)
                .map(|((source, coefficient), velocity)| source - *coefficient * velocity),
        );
        let span = self.storage.span(&self.window);
        let heat: f64 = received.heat.iter().sum::<f64>() * span;
        let force: Vec3 = received.drag.iter().sum::<Vec3>() * self.window.span.motion.seconds();
        received.mass = reservoir(moved.iter().sum::<f64>() * span);
        received.species = moved.iter().map(|flow| reservoir(flow * span)).collect();
        received.energy = reservoir(heat);
        received.momentum = [0, 1, 2].map(|axis| reservoir(force[axis]));
        Ok(Convergence {
            converged: true,
            ..Convergence::default()
        })
    }
}

/// The balance of a gas that stores nothing: a reservoir takes what it receives.
fn reservoir(received: f64) -> Balance {
    Balance {
        exchange: received,
        reservoir: -received,
        ..Balance::default()
    }
}
