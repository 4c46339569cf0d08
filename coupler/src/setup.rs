//! What a run starts from, in plain SI values: the same for every backend.

use calcine_physics::Vec3;
use calcine_physics::gas::GasProperties;

use crate::time::GasStorage;

/// A value over process time: (time in s, value) entries with increasing times,
/// at least one; linear in between, constant before the first and after the last.
#[derive(Clone, Debug, PartialEq)]
pub struct Schedule(pub Vec<(f64, f64)>);

impl Schedule {
    /// A constant.
    pub fn constant(value: f64) -> Self {
        Self(vec![(0.0, value)])
    }

    /// The value at a process time in s: linear between entries, constant outside them.
    pub fn at(&self, time: f64) -> f64 {
        let next = self.0.partition_point(|&(from, _)| from <= time);
        let before = self.0[next.saturating_sub(1)];
        match self.0.get(next) {
            Some(after) if next > 0 => {
                let share = (time - before.0) / (after.0 - before.0);
                before.1 + share * (after.1 - before.1)
            }
            _ => before.1,
        }
    }
}

/// The gas: mixture, start, boundary.
#[derive(Clone, Debug)]
pub struct GasSetup {
    /// Name of the mixture, for example `air`.
    pub mixture: String,
    /// Properties of the mixture.
    pub properties: GasProperties,
    /// Over which clock the gas stores.
    pub storage: GasStorage,
    /// Start temperature in K.
    pub temperature: f64,
    /// Start pressure, and the reference of the low-Mach gas, in Pa.
    pub pressure: f64,
    /// Start velocity (superficial) in m/s.
    pub velocity: Vec3,
    /// Gravity in m/s².
    pub gravity: Vec3,
    /// Boundary condition of each patch, in the order of the file; every patch of the mesh has one.
    pub patches: Vec<(String, GasPatch)>,
    /// Controls of the solver, honoured by native gas and calcineGasFoam alike.
    pub controls: GasControls,
}

/// Controls of the gas solver.
#[derive(Clone, Debug, PartialEq)]
pub struct GasControls {
    /// Outer (PIMPLE) iterations per window at most.
    pub outer_iterations: u32,
    /// Pressure corrections per outer iteration.
    pub pressure_corrections: u32,
    /// The outer loop ends where scaled initial residuals fall below this.
    pub outer_tolerance: f64,
    /// Tolerance of the linear solvers, relative to the throughput.
    pub linear_tolerance: f64,
}

/// Boundary condition of the gas on a patch.
#[derive(Clone, Debug, PartialEq)]
pub enum GasPatch {
    /// Gas flows in with a superficial velocity normal to the patch.
    Inlet {
        /// Superficial velocity into the domain in m/s, over process time in s.
        superficial_velocity: Schedule,
        /// Temperature in K, over process time in s.
        temperature: Schedule,
    },
    /// Gas leaves (or enters at the inner temperature) at a pressure.
    Outlet {
        /// Absolute pressure in Pa.
        pressure: f64,
    },
    /// A wall.
    Wall {
        /// True: no slip; false: free slip.
        no_slip: bool,
        /// Heat through the wall.
        heat: WallHeat,
    },
}

/// Heat through a wall.
#[derive(Clone, Debug, PartialEq)]
pub enum WallHeat {
    /// None.
    Adiabatic,
    /// Fixed wall temperature in K, over process time in s.
    Temperature(Schedule),
}

/// The particles at the start of a run.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ParticleSetup {
    /// Ids, ascending, from 1.
    pub id: Vec<u64>,
    /// Index of the population of each particle.
    pub population: Vec<u32>,
    /// Centres in m.
    pub position: Vec<Vec3>,
    /// Radii in m.
    pub radius: Vec<f64>,
    /// Densities in kg/m³.
    pub density: Vec<f64>,
    /// True where all particles stay where they are.
    pub frozen: bool,
}
