//! What every equation of an attempt looks at: geometry, bed, exchange, spans, gas properties.

use calcine_coupler::gas_chemistry::GasChemistry;
use calcine_coupler::part::CellExchange;
use calcine_coupler::physics::Vec3;
use calcine_coupler::physics::gas_model::GasModel;
use calcine_coupler::setup::{Convection, Turbulence};

use super::boundary::Boundaries;
use super::state::GasState;
use crate::numerics::grid::MeshGraph;
use crate::numerics::parallel::{fill, sums, update};

/// The frame of an attempt; constant while it lasts.
#[derive(Clone, Copy, Debug)]
pub struct AttemptFrame<'a> {
    /// Faces and links.
    pub grid: &'a MeshGraph,
    /// Boundary values at the end of the window.
    pub boundary: &'a Boundaries,
    /// Properties of the gas.
    pub properties: &'a GasModel,
    /// Schmidt number of all species.
    pub schmidt: f64,
    /// Reactions of the gas with itself.
    pub chemistry: &'a GasChemistry,
    /// Eddies; those of the attempt are of its old state.
    pub turbulence: &'a Turbulence,
    /// How cell values are carried to faces.
    pub convection: Convection,
    /// Change of a mass fraction to which the equations are solved.
    pub tolerance: f64,
    /// Gravity in m/s².
    pub gravity: Vec3,
    /// Mean pressure gradient in Pa/m beside that of the pressure field.
    pub mean_gradient: Vec3,
    /// Void fraction at the end of the window.
    pub void_fraction: &'a [f64],
    /// Share of −∇p and ρ g that the gas of each cell takes: ε by model A, 1 by model B (docs/theory.md,
    /// DRG-1).
    pub pressure_share: &'a [f64],
    /// Exchange with the particles.
    pub exchange: &'a CellExchange,
    /// State at the start of the window.
    pub old: &'a GasState,
    /// Motion span Δt in s.
    pub motion_span: f64,
    /// Storage span Δτ in s.
    pub storage_span: f64,
    /// True of one of several stages of a window.
    pub is_stage: bool,
}

/// Of several stages the second begins (1 − γ)/γ = 2.4 times as far from the start as the first came, with what that left of continuity, which drives
/// pressures of its own over γ Δt: continuity is judged by this share of the terms of short windows.
const STAGES: f64 = 1e-2;
/// Tolerance from which on that is close enough.
const CLOSE: f64 = 1e-9;

impl AttemptFrame<'_> {
    /// By what share of the usual terms continuity is judged where they are those of short windows.
    pub fn closer(&self) -> f64 {
        match self.is_stage {
            true => (CLOSE / self.tolerance).clamp(STAGES, 1.0),
            false => 1.0,
        }
    }

    /// Number of species; zero for a single gas.
    pub fn species(&self) -> usize {
        self.properties.species().len()
    }

    /// Void fraction × eddy viscosity on a boundary face in Pa s; zero for a laminar gas.
    #[inline]
    pub fn eddies_at(&self, index: usize) -> f64 {
        let eddies = self.old.turbulence.boundary.get(index - self.grid.internal);
        eddies.copied().unwrap_or(0.0)
    }

    /// The same through a Prandtl number, as void fraction × μ_t/Pr_t in kg/m/s.
    #[inline]
    pub fn heat_eddies_at(&self, index: usize) -> f64 {
        match self.turbulence {
            Turbulence::Laminar => 0.0,
            Turbulence::KEpsilon { prandtl, .. } => self.eddies_at(index) / prandtl,
        }
    }

    /// The same through a Schmidt number.
    #[inline]
    pub fn species_eddies_at(&self, index: usize) -> f64 {
        match self.turbulence {
            Turbulence::Laminar => 0.0,
            Turbulence::KEpsilon { schmidt, .. } => self.eddies_at(index) / schmidt,
        }
    }

    /// Mass that the gas of a cell gains from particles in kg/s.
    pub fn mass_source(&self, now: &GasState, cell: usize) -> f64 {
        let given = &self.exchange.species;
        if given.is_none() {
            return 0.0;
        }
        given.mass(cell, now.composition_of(cell, self.species()))
    }
}

/// Material properties of each cell at its temperature and composition.
#[derive(Clone, Debug, Default)]
pub struct CellProperties {
    /// Density ρ of the equation of state in kg/m³.
    pub density: Vec<f64>,
    /// Specific heat capacity c_p in J/kg/K.
    pub heat_capacity: Vec<f64>,
    /// Void fraction × viscosity, εμ, in Pa s, eddies included.
    pub viscosity: Vec<f64>,
    /// Void fraction × conductivity, εκ, in W/m/K: the gas in the pores conducts by its share of
    /// the cross-section; conduction through the bed of particles is the particles' own. Eddies included.
    pub conductivity: Vec<f64>,
    /// Void fraction × diffusivity of species × density, εμ/Sc, in kg/m/s, eddies included; empty for a
    /// single gas.
    pub diffusivity: Vec<f64>,
}

impl CellProperties {
    /// Evaluates the properties of a state. In a closed domain the base pressure of the low-Mach gas
    /// first follows: the one at which the gas that is there fills the pores.
    pub fn update(&mut self, frame: &AttemptFrame<'_>, now: &mut GasState) {
        let gas = frame.properties;
        let (cells, species) = (now.temperature.len(), frame.species());
        for list in [
            &mut self.density,
            &mut self.heat_capacity,
            &mut self.viscosity,
            &mut self.conductivity,
        ] {
            list.resize(cells, 0.0);
        }
        if frame.boundary.closed() && gas.compressible() {
            now.base_pressure = closed_pressure(frame, now);
        }
        let (pressure, pores) = (now.base_pressure, frame.void_fraction);
        let state = |cell: usize| (now.temperature[cell], now.composition_of(cell, species));
        fill(&mut self.density, |cell| {
            let (temperature, composition) = state(cell);
            gas.density(pressure, temperature, composition)
        });
        fill(&mut self.heat_capacity, |cell| {
            let (temperature, composition) = state(cell);
            gas.heat_capacity(temperature, composition)
        });
        fill(&mut self.viscosity, |cell| {
            let (temperature, composition) = state(cell);
            pores[cell] * gas.viscosity(temperature, composition)
        });
        fill(&mut self.conductivity, |cell| {
            let (temperature, composition) = state(cell);
            pores[cell] * gas.conductivity(temperature, composition)
        });
        let species = if species == 0 { 0 } else { cells };
        self.diffusivity.resize(species, 0.0);
        let viscosity = &self.viscosity;
        fill(&mut self.diffusivity, |cell| {
            viscosity[cell] / frame.schmidt
        });
        self.add_eddies(frame);
    }

    fn add_eddies(&mut self, frame: &AttemptFrame<'_>) {
        let eddies = &frame.old.turbulence.viscosity;
        let &Turbulence::KEpsilon {
            prandtl, schmidt, ..
        } = frame.turbulence
        else {
            return;
        };
        let heat_capacity = &self.heat_capacity;
        update(&mut self.viscosity, |cell, sum| *sum += eddies[cell]);
        update(&mut self.conductivity, |cell, sum| {
            *sum += heat_capacity[cell] * eddies[cell] / prandtl;
        });
        update(&mut self.diffusivity, |cell, sum| {
            *sum += eddies[cell] / schmidt;
        });
    }
}

/// The pressure at which Σ ε ρ V is the gas that continuity leaves in a closed domain, in Pa. Densities
/// of ideal gases are proportional to the pressure.
fn closed_pressure(frame: &AttemptFrame<'_>, now: &GasState) -> f64 {
    let grid = frame.grid;
    let species = frame.species();
    let [held, at_one_pascal] = sums(grid.cells(), |cell| {
        let composition = now.composition_of(cell, species);
        let density = frame
            .properties
            .density(1.0, now.temperature[cell], composition);
        let pores = frame.void_fraction[cell] * grid.volume[cell];
        let gained = frame.storage_span * frame.mass_source(now, cell);
        [frame.old.mass[cell] + gained, pores * density]
    });
    let boundary = grid.faces.len() - grid.internal;
    let [outflow] = sums(boundary, |face| {
        let index = grid.internal + face;
        match *frame.boundary.at(index) {
            super::boundary::FaceCondition::Inlet { mass_flux, .. } => {
                [-mass_flux * grid.faces[index].area]
            }
            _ => [0.0],
        }
    });
    (held - frame.storage_span * outflow) / at_one_pascal
}
