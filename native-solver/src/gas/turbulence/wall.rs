//! Cells at walls: between the wall and the centre of the first cell velocity follows the logarithmic law,
//! and eddies are in equilibrium there, so that with y the distance of the centre
//!
//! ε_t = C_μ^¾ k^(3/2)/(κ y)   and   the production of k is (μ_t + εμ) |Δu|/y · C_μ^¼ √k/(κ y),
//!
//! means over the faces of a cell in a corner. Launder and Spalding 1974, doi 10.1016/0045-7825(74)90029-2.

use calcine_coupler::physics::gas_model::GasModel;
use calcine_coupler::physics::turbulence::{KEpsilon, LogLaw};

use crate::gas::boundary::{Boundaries, FaceCondition, HeatCondition};
use crate::gas::state::GasState;
use crate::numerics::grid::MeshGraph;

/// The law of the wall with what it needs evaluated once.
#[derive(Clone, Copy, Debug)]
pub struct WallLaw {
    law: LogLaw,
    limit: f64,
    /// C_μ^¼.
    root: f64,
}

impl WallLaw {
    /// That of smooth walls.
    pub fn new() -> Self {
        let law = LogLaw::SMOOTH;
        Self {
            law,
            limit: law.laminar_limit(),
            root: KEpsilon::STANDARD.viscosity.powf(0.25),
        }
    }

    /// Eddy viscosity over the gas' own at a wall: k in m²/s² and distance in m of the first cell, ν in m²/s.
    #[inline]
    pub fn eddy_ratio(&self, energy: f64, distance: f64, viscosity: f64) -> f64 {
        let y_plus = self.root * energy.sqrt() * distance / viscosity;
        self.law.eddy_ratio(y_plus, self.limit)
    }

    /// ε_t in m²/s³ of a first cell.
    #[inline]
    pub fn dissipation(&self, energy: f64, distance: f64) -> f64 {
        KEpsilon::STANDARD.dissipation(energy, self.law.karman * distance)
    }

    /// The velocity gradient in 1/s at the centre of a first cell, by which the stress produces k.
    #[inline]
    pub fn shear(&self, energy: f64, distance: f64) -> f64 {
        self.root * energy.sqrt() / (self.law.karman * distance)
    }
}

/// A cell's face on a wall that gas sticks to.
#[derive(Clone, Copy, Debug)]
pub struct WallFace {
    /// Index of the face.
    pub face: usize,
    /// The cell.
    pub cell: usize,
    /// Share of this face among those of the cell.
    pub share: f64,
}

/// All faces on walls that gas sticks to.
pub fn wall_faces(grid: &MeshGraph, boundary: &Boundaries) -> Vec<WallFace> {
    let sticks = |index: &usize| {
        let value = boundary.at(*index);
        matches!(
            value,
            FaceCondition::Wall {
                sticks: Some(_),
                ..
            }
        )
    };
    let mut count = vec![0u32; grid.cells()];
    let faces: Vec<usize> = (grid.internal..grid.faces.len()).filter(sticks).collect();
    for &face in &faces {
        count[grid.faces[face].owner] += 1;
    }
    let one = |face: usize| {
        let cell = grid.faces[face].owner;
        WallFace {
            face,
            cell,
            share: 1.0 / f64::from(count[cell]),
        }
    };
    faces.into_iter().map(one).collect()
}

/// Void fraction × viscosity of the gas at a wall in Pa s: at the temperature of the wall where that is given.
pub fn viscosity(
    boundary: &Boundaries,
    gas: &GasModel,
    state: &GasState,
    index: usize,
    cell: usize,
) -> f64 {
    let temperature = match *boundary.at(index) {
        FaceCondition::Wall {
            heat: HeatCondition::Temperature(temperature),
            ..
        } => temperature,
        _ => state.temperature[cell],
    };
    let composition = state.composition_of(cell, gas.species().len());
    state.void_fraction[cell] * gas.viscosity(temperature, composition)
}
