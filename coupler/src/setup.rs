//! What a run starts from, in plain SI values: the same for every backend.

use calcine_physics::Vec3;
use calcine_physics::gas_model::GasModel;

use crate::gas_chemistry::GasChemistry;
pub use crate::gas_wall::{AxialTemperature, WallVelocity};
use crate::momentum_model::MomentumModel;
use crate::motion::Motion;
pub use crate::schedule::Schedule;
use crate::time::GasStorage;
pub use crate::turbulence::{InletTurbulence, Turbulence};

/// The gas: mixture, start, boundary.
#[derive(Clone, Debug)]
pub struct GasSetup {
    /// Name of the mixture, for example `air`.
    pub mixture: String,
    /// Properties of the mixture.
    pub properties: GasModel,
    /// Schmidt number of all species of a mixture (docs/theory.md, SPC-1); 1 where there are none.
    pub schmidt: f64,
    /// Reactions of the gas with itself.
    pub chemistry: GasChemistry,
    /// Over which clock the gas stores.
    pub storage: GasStorage,
    /// Start temperature in K.
    pub temperature: f64,
    /// Mass fractions at the start, in the order of the mixture's species; empty for a single gas.
    pub composition: Vec<f64>,
    /// Start pressure, and the reference of the low-Mach gas, in Pa.
    pub pressure: f64,
    /// Start velocity (superficial) in m/s.
    pub velocity: Vec3,
    /// Gravity in m/s².
    pub gravity: Vec3,
    /// Mean pressure gradient in Pa/m beside that of the pressure field, which drives gas along periodic directions.
    pub pressure_gradient: Vec3,
    /// How gas and particles share their momentum.
    pub momentum: MomentumModel,
    /// Eddies.
    pub turbulence: Turbulence,
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
    /// How cell values are carried to faces.
    pub convection: Convection,
    /// How a window is stepped where its clocks are one.
    pub time_scheme: TimeScheme,
    /// Pressure corrections per outer iteration.
    pub pressure_corrections: u32,
    /// Pressure corrections per outer iteration at most, where the pace of the outer loop asks for more than
    /// `pressure_corrections`.
    pub most_pressure_corrections: u32,
    /// The outer loop ends where scaled initial residuals fall below this.
    pub outer_tolerance: f64,
    /// Tolerance of the linear solvers, relative to the throughput; nothing: that which the outer loop can make use of.
    pub linear_tolerance: Option<f64>,
}

impl GasControls {
    /// Tolerance of linear solvers that do not follow the outer loop.
    pub const CLOSE: f64 = 1e-13;
}

/// How the gas is stepped over a window in which motion and process clock are one (AF 1); under time splitting it is implicit Euler
/// (docs/theory.md, TSM-5, TSM-8).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum TimeScheme {
    /// Implicit Euler: first order, positive.
    #[default]
    ImplicitEuler,
    /// Two diagonally implicit stages: second order, L-stable.
    Sdirk2,
}

/// How cell values of velocity, enthalpy and composition are carried to faces.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Convection {
    /// First-order upwind.
    Upwind,
    /// Second order where the field is smooth, upwind at extrema: the limiter of van Leer 1974,
    /// doi 10.1016/0021-9991(74)90019-9.
    #[default]
    VanLeer,
    /// Velocity and enthalpy by linear interpolation to this share, by upwind for the rest: second order at a share of one,
    /// not bounded. Mass fractions by van Leer's limiter, which bounds them.
    Central(f64),
    /// Velocity and enthalpy by linear interpolation limited with a coefficient k in [0, 1], OpenFOAM's `limitedLinear`:
    /// ψ = max(0, min(2 r/k, 1)), bounded at k = 1, linear wherever r > 0 at k = 0. Mass fractions by van Leer's limiter.
    LimitedLinear(f64),
}

impl Convection {
    /// True where enthalpy and temperature are limited; mass fractions are with any scheme of second order.
    pub fn limits(self) -> bool {
        matches!(self, Self::VanLeer | Self::LimitedLinear(_))
    }
}

/// A composition over process time: (time in s, mass fractions in the order of the mixture's
/// species) entries with increasing times, at least one; linear in between, constant outside.
#[derive(Clone, Debug, PartialEq)]
pub struct CompositionSchedule(pub Vec<(f64, Vec<f64>)>);

impl CompositionSchedule {
    /// Mass fractions at a process time in s.
    pub fn at(&self, time: f64) -> Vec<f64> {
        let species = self.0.first().map_or(0, |entry| entry.1.len());
        let one = |k: usize| Schedule(self.0.iter().map(|(t, y)| (*t, y[k])).collect()).at(time);
        (0..species).map(one).collect()
    }
}

/// Boundary condition of the gas on a patch.
#[derive(Clone, Debug, PartialEq)]
pub enum GasPatch {
    /// Gas flows in, normal to the patch.
    Inlet {
        /// How much.
        flow: InletFlow,
        /// Temperature in K, over process time in s.
        temperature: Schedule,
        /// Composition; `None` for a single gas.
        composition: Option<CompositionSchedule>,
        /// Eddies that come in; `None` where the gas is laminar.
        turbulence: Option<InletTurbulence>,
        /// How temperature and composition are given.
        scalars: InletScalars,
    },
    /// Gas leaves at a pressure.
    Outlet {
        /// Absolute pressure in Pa, over process time in s.
        pressure: Schedule,
        /// Gas that comes back in; `None`: of the state of the cell behind.
        backflow: Option<PatchGas>,
    },
    /// Gas flows out to surroundings at rest or in from them, as the pressures have it.
    Opening {
        /// Absolute pressure of the surroundings in Pa at the height of `at`, over process time in s.
        pressure: Schedule,
        /// Point in m at whose height the surroundings have the pressure; above and below they have that of their own
        /// weight.
        at: Vec3,
        /// Gas of the surroundings.
        gas: PatchGas,
    },
    /// A wall.
    Wall {
        /// How the gas moves along it.
        velocity: WallVelocity,
        /// Heat through the wall.
        heat: WallHeat,
    },
    /// A plane of symmetry.
    Symmetry,
    /// One side of a pair through which the domain repeats itself: what leaves through one comes in through the other.
    Periodic {
        /// The patch on the other side, which has this one as its own partner.
        with: String,
    },
    /// The sides of a plane flow, one cell apart: nothing passes and nothing varies from one to the other.
    Empty,
    /// One of the two sides of an axisymmetric flow without swirl, one cell apart.
    Wedge,
}

/// Gas beyond a patch.
#[derive(Clone, Debug, PartialEq)]
pub struct PatchGas {
    /// Temperature in K, over process time in s.
    pub temperature: Schedule,
    /// Composition; `None` for a single gas.
    pub composition: Option<CompositionSchedule>,
}

impl GasPatch {
    /// An outlet at an absolute pressure in Pa, through which gas comes back in the state of the cell behind.
    pub fn outlet(pressure: Schedule) -> Self {
        Self::Outlet {
            pressure,
            backflow: None,
        }
    }

    /// Temperature in K and composition of the gas that comes in, where they are stated.
    pub fn entering(&self) -> Option<(&Schedule, Option<&CompositionSchedule>)> {
        match self {
            Self::Inlet {
                temperature,
                composition,
                ..
            }
            | Self::Opening {
                gas:
                    PatchGas {
                        temperature,
                        composition,
                    },
                ..
            }
            | Self::Outlet {
                backflow:
                    Some(PatchGas {
                        temperature,
                        composition,
                    }),
                ..
            } => Some((temperature, composition.as_ref())),
            Self::Outlet { backflow: None, .. }
            | Self::Wall { .. }
            | Self::Symmetry
            | Self::Periodic { .. }
            | Self::Empty
            | Self::Wedge => None,
        }
    }

    /// True where gas passes as pressures drive it.
    pub fn is_open(&self) -> bool {
        matches!(self, Self::Outlet { .. } | Self::Opening { .. })
    }

    /// An inlet of a single gas with a superficial velocity in m/s and a temperature in K.
    pub fn inlet(velocity: Schedule, temperature: Schedule) -> Self {
        Self::Inlet {
            flow: InletFlow::SuperficialVelocity(velocity),
            temperature,
            composition: None,
            turbulence: None,
            scalars: InletScalars::default(),
        }
    }
}

/// How an inlet gives temperature and composition (docs/theory.md, BND-1).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum InletScalars {
    /// By the whole flux of species and enthalpy, that of the stated gas at the stated flow (Danckwerts): nothing
    /// diffuses or is conducted beside it.
    #[default]
    Flux,
    /// By their values at the face, to which and from which species diffuse and heat is conducted.
    Value,
}

/// How much gas flows through an inlet; zero or positive, into the domain.
#[derive(Clone, Debug, PartialEq)]
pub enum InletFlow {
    /// Superficial velocity in m/s, over process time in s.
    SuperficialVelocity(Schedule),
    /// Mass flow through the whole patch in kg/s, over process time in s, evenly spread.
    MassFlow(Schedule),
}

/// Heat through a wall.
#[derive(Clone, Debug, PartialEq)]
pub enum WallHeat {
    /// None.
    Adiabatic,
    /// Fixed wall temperature in K, over process time in s.
    Temperature(Schedule),
    /// Fixed wall temperature that changes along an axis.
    Along(AxialTemperature),
    /// Heat flux into the gas in W/m² of wall, over process time in s.
    Flux(Schedule),
    /// Heat exchange with surroundings beyond the wall.
    Convective {
        /// Overall coefficient between the inner face of the wall and the surroundings in W/m²/K,
        /// over process time in s.
        coefficient: Schedule,
        /// Temperature of the surroundings in K, over process time in s.
        ambient: Schedule,
    },
}

/// Fields of a gas that any gas solver can start from, one value a cell.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct GasStart {
    /// Temperature in K.
    pub temperature: Vec<f64>,
    /// Absolute pressure in Pa.
    pub pressure: Vec<f64>,
    /// Superficial velocity in m/s of motion time.
    pub velocity: Vec<Vec3>,
    /// Mass fractions, species by species within each cell; empty for a single gas.
    pub composition: Vec<f64>,
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
    /// Velocities in m/s of motion time; empty where all are at rest.
    pub velocity: Vec<Vec3>,
    /// Angular velocities in rad/s of motion time; empty where none spins.
    pub angular_velocity: Vec<Vec3>,
    /// Statistical weights: how many real particles each stands for; empty where each stands for itself alone.
    pub weight: Vec<f64>,
    /// How they move.
    pub motion: Motion,
}

impl ParticleSetup {
    /// Number of real particles that a row stands for.
    pub fn weight_of(&self, row: usize) -> f64 {
        self.weight.get(row).copied().unwrap_or(1.0)
    }

    /// Puts a row of other particles behind its own.
    pub fn take(&mut self, others: &Self, row: usize) {
        self.id.push(others.id[row]);
        self.population.push(others.population[row]);
        self.position.push(others.position[row]);
        self.radius.push(others.radius[row]);
        self.density.push(others.density[row]);
        self.velocity.extend(others.velocity.get(row));
        self.angular_velocity
            .extend(others.angular_velocity.get(row));
        self.weight.extend(others.weight.get(row));
    }
}
