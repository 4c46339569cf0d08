//! What every equation of an attempt looks at: geometry, bed, exchange, spans, gas properties.

use calcine_coupler::part::CellExchange;
use calcine_coupler::physics::Vec3;
use calcine_coupler::physics::gas::GasProperties;

use super::boundary::Boundaries;
use super::state::State;
use crate::numerics::grid::Grid;
use crate::numerics::parallel::fill;

/// The frame of an attempt; constant while it lasts.
#[derive(Clone, Copy, Debug)]
pub struct Frame<'a> {
    /// Faces and links.
    pub grid: &'a Grid,
    /// Boundary values at the end of the window.
    pub boundary: &'a Boundaries,
    /// Properties of the mixture.
    pub properties: &'a GasProperties,
    /// Reference pressure of the low-Mach gas in Pa.
    pub reference_pressure: f64,
    /// Gravity in m/s².
    pub gravity: Vec3,
    /// Void fraction at the end of the window.
    pub void_fraction: &'a [f64],
    /// Exchange with the particles.
    pub exchange: &'a CellExchange,
    /// State at the start of the window.
    pub old: &'a State,
    /// Motion span Δt in s.
    pub motion_span: f64,
    /// Storage span Δτ in s.
    pub storage_span: f64,
}

/// Material properties of each cell at its temperature.
#[derive(Clone, Debug, Default)]
pub struct Material {
    /// Density ρ of the equation of state in kg/m³.
    pub density: Vec<f64>,
    /// Void fraction × viscosity, εμ, in Pa s.
    pub viscosity: Vec<f64>,
    /// Void fraction × conductivity, εκ, in W/m/K: the gas in the pores conducts by its share of
    /// the cross-section; conduction through the bed of particles is the particles' own.
    pub conductivity: Vec<f64>,
}

impl Material {
    /// Evaluates the properties at temperatures in K.
    pub fn update(&mut self, frame: &Frame<'_>, temperature: &[f64]) {
        let gas = frame.properties;
        let cells = temperature.len();
        self.density.resize(cells, 0.0);
        self.viscosity.resize(cells, 0.0);
        self.conductivity.resize(cells, 0.0);
        let pressure = frame.reference_pressure;
        fill(&mut self.density, |c| gas.density(pressure, temperature[c]));
        fill(&mut self.viscosity, |c| {
            frame.void_fraction[c] * gas.viscosity(temperature[c])
        });
        fill(&mut self.conductivity, |c| {
            frame.void_fraction[c] * gas.conductivity(temperature[c])
        });
    }
}
