//! The three parts' traits and the plain data that passes between them and the coordinator.
//!
//! All per-cell and per-particle arrays are extensive where that makes an exchange exact:
//! a coefficient is "per cell" in W/K, not "per volume".

use std::path::Path;
use std::time::Duration;

use calcine_physics::{Vec3, sphere};

use crate::boundary_value::BoundaryValue;
use crate::error::PartError;
use crate::excursion::Excursion;
use crate::motion::ParticleChanges;
use crate::named_columns::NamedColumns;
use crate::supervisor::Supervisor;
use crate::time::Window;

/// What a part says of itself.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SolverInfo {
    /// Name, for example "OpenFOAM".
    pub name: String,
    /// Version as the solver prints it.
    pub version: String,
    /// Number of ranks it runs on.
    pub ranks: usize,
}

/// What every participant can do. No method of a part's traits has a default, so that a part that wraps another one
/// cannot leave any out.
pub trait Part: Send {
    /// Name, version, ranks.
    fn about(&self) -> &SolverInfo;

    /// Takes the last attempt as the new start of attempts.
    fn commit(&mut self) -> Result<(), PartError>;

    /// Writes the committed state into `directory`, with all that decides the next window, and goes on as a resumed run
    /// does. A part that keeps everything to the bit changes nothing; one that cannot re-initialises from what it wrote, so
    /// that at least a run with this checkpoint takes the path of one that is resumed from it.
    fn checkpoint(&mut self, directory: &Path) -> Result<(), PartError>;

    /// Processor time that processes of its own have used since they were ready; zero for a part that works in
    /// the coordinator's.
    fn processor_time(&self) -> Duration {
        Duration::ZERO
    }

    /// Ends the part in an orderly way; what it started is gone afterwards. A part that started nothing has nothing to do.
    fn finish_run(&mut self, _supervisor: &Supervisor) -> Result<(), PartError> {
        Ok(())
    }
}

/// The gas as the coordinator sees it after a commit or an attempt, one value per cell.
#[derive(Clone, Copy, Debug)]
pub struct GasFields<'a> {
    /// Temperature in K.
    pub temperature: &'a [f64],
    /// Absolute pressure in Pa, hydrostatic part included.
    pub pressure: &'a [f64],
    /// Density of the gas itself (not times the void fraction) in kg/m³.
    pub density: &'a [f64],
    /// Mass fractions, species by species within each cell; empty for a single gas.
    pub composition: &'a [f64],
    /// Interstitial velocity in m/s.
    pub velocity: &'a [Vec3],
    /// The cell gradient of the total pressure that the momentum equation used, in Pa/m.
    pub pressure_gradient: &'a [Vec3],
    /// Eddies; empty where the gas is laminar.
    pub turbulence: TurbulenceFields<'a>,
}

/// Eddies of the gas, one value per cell.
#[derive(Clone, Copy, Debug, Default)]
pub struct TurbulenceFields<'a> {
    /// Turbulent energy k in m²/s².
    pub energy: &'a [f64],
    /// Its dissipation in m²/s³.
    pub dissipation: &'a [f64],
    /// Void fraction × eddy viscosity in Pa s; zero in the bed where eddies end there.
    pub viscosity: &'a [f64],
}

/// What the gas is told of the bed, one value per cell, valid at the end of the window.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Bed {
    /// Void fraction ε = 1 − α, positive.
    pub void_fraction: Vec<f64>,
}

/// Exchange terms that the gas treats implicitly, one value per cell, extensive (summed over the
/// cell, not per volume):
///
/// heat to the gas of cell c in W: Q_c = `heat_source` − `heat_coefficient` · T_c,
/// force on the gas in N:          F_c = `drag_source` − `drag_coefficient` · u_c.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct CellExchange {
    /// Σ W K_A in kg/s (docs/theory.md, DRG-1, model A: the pressure force is separate).
    pub drag_coefficient: Vec<f64>,
    /// Explicit part of the drag on the gas in N.
    pub drag_source: Vec<Vec3>,
    /// Σ W K_eff in W/K.
    pub heat_coefficient: Vec<f64>,
    /// Explicit part of the heat to the gas in W.
    pub heat_source: Vec<f64>,
    /// Gas that particles set free and take up.
    pub species: SpeciesExchange,
    /// What the particles make of eddies; empty where eddies end at the bed.
    pub eddies: EddyExchange,
}

/// What the particles of a bed make of the eddies of the gas, per mass of gas, one value per cell and zero outside the bed;
/// all lists are empty where eddies end at the bed.
///
/// Dk/Dt = … + `energy` + `growth` k,   Dε/Dt = … + `dissipation` + C₂ `growth` ε.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct EddyExchange {
    /// Production of k in m²/s³.
    pub energy: Vec<f64>,
    /// Production of ε in m²/s⁴.
    pub dissipation: Vec<f64>,
    /// Rate in 1/s at which k, and C₂ times which ε, grow.
    pub growth: Vec<f64>,
}

/// Gas that particles that react give and take, summed over each cell; all lists are empty where none
/// does.
///
/// Mass of species k to the gas of cell c in kg/s: S_ck = `source` − `coefficient` · Y_ck; the gas of a cell
/// gains Σ_k S_ck. It comes and goes with the velocity of the gas. Heat to the gas in W, beside that of
/// [`CellExchange`]: `heat` − Σ_k `taken` h_k(T_c), with h_k the sensible enthalpy of a species.
///
/// The last species of a mixture is what the others leave, and has no coefficient.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SpeciesExchange {
    /// Explicit part in kg/s, species by species within each cell.
    pub source: Vec<f64>,
    /// Coefficient of the mass fraction in kg/s, zero or above, likewise.
    pub coefficient: Vec<f64>,
    /// What leaves with the gas' own temperature in kg/s, likewise.
    pub taken: Vec<f64>,
    /// Sensible enthalpy in W that comes from the particles with their temperature, one value per cell.
    pub heat: Vec<f64>,
}

impl SpeciesExchange {
    /// True where no particle exchanges species.
    pub fn is_none(&self) -> bool {
        self.source.is_empty()
    }

    /// Empties it, or makes room for so many cells and species, all zero.
    pub fn reset(&mut self, cells: usize, species: usize) {
        for list in [&mut self.source, &mut self.coefficient, &mut self.taken] {
            list.clear();
            list.resize(cells * species, 0.0);
        }
        self.heat.clear();
        self.heat.resize(if species == 0 { 0 } else { cells }, 0.0);
    }

    /// Mass that the gas of a cell gains in kg/s at its mass fractions.
    pub fn mass(&self, cell: usize, fractions: &[f64]) -> f64 {
        if self.is_none() {
            return 0.0;
        }
        let first = cell * fractions.len();
        let each = fractions.iter().enumerate();
        each.map(|(k, y)| self.source[first + k] - self.coefficient[first + k] * y)
            .sum()
    }
}

/// One conserved quantity of the gas over a window, in kg, J or N s of the gas' storage span
/// (momentum: of the motion span). Signs: + is into the gas.
/// In exact arithmetic and with exact linear solves `stored − boundary − reservoir − exchange − source = 0`.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Balance {
    /// Sum over cells of (end − start).
    pub stored: f64,
    /// Sum over cells of |end − start|.
    pub stored_magnitude: f64,
    /// Net inflow through the boundary, diffusion included.
    pub boundary: f64,
    /// Sum over boundary faces of |flow|.
    pub boundary_magnitude: f64,
    /// Received from the particles.
    pub exchange: f64,
    /// Other sources (gravity, pressure …).
    pub source: f64,
    /// Sum of the magnitudes of the other sources.
    pub source_magnitude: f64,
    /// Net inflow from the reservoir of a gas that is held as it is; zero for a gas that is solved. It carries mass, species
    /// and their energy as a boundary does.
    pub reservoir: f64,
}

impl Balance {
    /// What the balance leaves open: zero in exact arithmetic with exact linear solves.
    pub fn open(&self) -> f64 {
        self.stored - self.boundary - self.reservoir - self.exchange - self.source
    }

    /// The sum of the magnitudes of its terms.
    pub fn magnitude(&self) -> f64 {
        self.stored_magnitude
            + self.boundary_magnitude
            + self.reservoir.abs()
            + self.exchange.abs()
            + self.source_magnitude
    }
}

/// What passes a patch of the gas: means over a window, + into the gas.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PatchFlow {
    /// Heat in W: sensible enthalpy, zero at 298.15 K, that flows with the gas and its species, and conduction.
    pub heat: f64,
    /// Mass in kg/s.
    pub mass: f64,
    /// Momentum in N, pressure excluded: on a wall the viscous force of the wall on the gas.
    pub momentum: Vec3,
    /// Mass of each species in kg/s, in the order of the mixture; empty for a single gas.
    pub species: Vec<f64>,
}

impl PatchFlow {
    /// Multiplies all of it.
    pub fn scale(&mut self, factor: f64) {
        self.heat *= factor;
        self.mass *= factor;
        self.momentum *= factor;
        self.species.iter_mut().for_each(|flow| *flow *= factor);
    }

    /// Adds another one.
    pub fn add(&mut self, other: &Self) {
        self.heat += other.heat;
        self.mass += other.mass;
        self.momentum += other.momentum;
        let pairs = self.species.iter_mut().zip(&other.species);
        pairs.for_each(|(flow, other)| *flow += other);
    }
}

/// What the gas reports of an attempt.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct CellReceived {
    /// Mean heat flow into the gas of each cell over the window in W, as the solved enthalpy
    /// equation took it; that of exchanged species included.
    pub heat: Vec<f64>,
    /// Mean drag on the gas of each cell over the window in N (pressure force excluded).
    pub drag: Vec<Vec3>,
    /// Gas mass in kg.
    pub mass: Balance,
    /// Mass of each species in kg, in the order of the mixture; empty for a single gas.
    pub species: Vec<Balance>,
    /// Gas enthalpy in J.
    pub energy: Balance,
    /// Gas momentum along x, y, z in N s.
    pub momentum: [Balance; 3],
    /// What the form of the momentum equation gives the gas in N s because it stores mass over another span than
    /// momentum (docs/theory.md, TSM-8), Σ u (1 − Δt/Δτ) Δ(ε ρ V); a part of the momentum's sources.
    pub storage_clock: Vec3,
    /// What passed each patch of the mesh, in its order; empty of a gas that does not tell.
    pub patches: Vec<PatchFlow>,
}

/// How well the gas solved an attempt.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Convergence {
    /// Outer iterations done.
    pub outer_iterations: u32,
    /// Sum of inner iterations of all linear solvers.
    pub linear_iterations: u32,
    /// Largest scaled initial residual in the last outer iteration.
    pub residual: f64,
    /// Mismatch between the mass that continuity carries and the equation of state, largest over
    /// the cells, relative to the cell's gas mass (docs/theory.md, CON-2).
    pub volume_residual: f64,
    /// False where the outer loop ended at its limit; said in words by the log.
    pub converged: bool,
}

/// Wall time that a gas has taken for the parts of its windows so far.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct GasPhases {
    /// Momentum equation: assembly, predictor, residual.
    pub momentum: Duration,
    /// Pressure equation with fluxes and velocities, and continuity.
    pub pressure: Duration,
    /// Enthalpy.
    pub enthalpy: Duration,
    /// Species without reactions.
    pub species: Duration,
    /// Reactions of the gas.
    pub chemistry: Duration,
    /// Eddies.
    pub turbulence: Duration,
    /// Density, viscosity, conductivity, heat capacity.
    pub properties: Duration,
}

impl GasPhases {
    /// Every phase with its name.
    pub fn named(&self) -> [(&'static str, Duration); 7] {
        [
            ("momentum", self.momentum),
            ("pressure", self.pressure),
            ("enthalpy", self.enthalpy),
            ("species", self.species),
            ("chemistry", self.chemistry),
            ("turbulence", self.turbulence),
            ("properties", self.properties),
        ]
    }
}

/// Gas that comes back in through outlets for which no state of it is given, in that of the cell behind. It counts where it
/// renews more of a cell's gas in a window than the share to which the gas is solved.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Backflow {
    /// Faces with it.
    pub faces: u64,
    /// Largest superficial velocity inwards in m/s.
    pub velocity: f64,
    /// Cell behind that face.
    pub cell: usize,
}

/// Flow, enthalpy and species on a finite-volume mesh.
pub trait Gas: Part {
    /// Fields after the last finished attempt (initially: the start of the run).
    fn fields(&self) -> GasFields<'_>;

    /// Gas that comes back in through outlets after the last attempt, where its state is not given.
    fn backflow(&self) -> Option<Backflow>;

    /// True where the gas can begin a window again after an attempt that failed; a solver of its own process has ended by
    /// then.
    fn begins_again(&self) -> bool;

    /// Wall time of each phase so far, where the gas tells.
    fn phases(&self) -> Option<GasPhases> {
        None
    }

    /// Relative residual of the equations of turbulence where the last commit left them above their tolerance.
    fn turbulence_residual(&self) -> Option<f64>;

    /// Sets a condition of a patch from the start of the next window on; between two windows, after a commit. What
    /// was set is no part of the gas' checkpoint: the coordinator sets it again after a resume. A gas that cannot refuses.
    fn set_boundary(&mut self, value: &BoundaryValue) -> Result<(), PartError>;

    /// Starts an attempt from the last commit; does not wait. Attempts of one window above 0 may take what the
    /// attempt before found as their first guess, never as the old state.
    fn start(
        &mut self,
        window: &Window,
        bed: &Bed,
        exchange: &CellExchange,
    ) -> Result<(), PartError>;

    /// Waits for the attempt started last.
    fn finish(
        &mut self,
        supervisor: &Supervisor,
        received: &mut CellReceived,
    ) -> Result<Convergence, PartError>;
}

/// Particles as the coordinator sees them, in ascending id.
#[derive(Clone, Copy, Debug)]
pub struct ParticleFields<'a> {
    /// Ids, ascending, never reused.
    pub id: &'a [u64],
    /// Index of the population in the case file (LIGGGHTS: atom type − 1).
    pub population: &'a [u32],
    /// Centres in m.
    pub position: &'a [Vec3],
    /// Velocities in m/s of motion time.
    pub velocity: &'a [Vec3],
    /// Angular velocities in rad/s of motion time.
    pub angular_velocity: &'a [Vec3],
    /// Radii in m.
    pub radius: &'a [f64],
    /// Masses in kg, of one real particle each.
    pub mass: &'a [f64],
    /// Statistical weights: how many real particles each row stands for; empty where each stands for itself alone.
    pub weight: &'a [f64],
}

impl ParticleFields<'_> {
    /// Number of real particles that a row stands for.
    pub fn weight_of(&self, row: usize) -> f64 {
        self.weight.get(row).copied().unwrap_or(1.0)
    }

    /// True where some row stands for another number of particles than one.
    pub fn has_weights(&self) -> bool {
        self.weight.iter().any(|weight| *weight != 1.0)
    }

    /// Mass in kg of all real particles that a row stands for.
    pub fn row_mass(&self, row: usize) -> f64 {
        self.weight_of(row) * self.mass[row]
    }

    /// Solid volume in m³ of all real particles that a row stands for.
    pub fn row_volume(&self, row: usize) -> f64 {
        self.weight_of(row) * sphere::volume(self.radius[row])
    }

    /// Number of particles.
    pub fn len(&self) -> usize {
        self.id.len()
    }

    /// True where there is no particle.
    pub fn is_empty(&self) -> bool {
        self.id.is_empty()
    }
}

/// What the particles are told, in the order of `ParticleFields`, of one real particle each; constant over the window.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ParticlePush {
    /// Force of the gas on each particle in N.
    pub force: Vec<Vec3>,
    /// Further columns; the solver must take each of them ([`Particles::takes`]).
    pub columns: NamedColumns,
}

/// Column of a push: K in kg/s. With [`GAS_VELOCITY`] a drag K (u − v) acts beside the force, with the velocity v of the
/// particle as it moves (docs/theory.md, DRG-3).
pub const DRAG_COEFFICIENT: &str = "drag_coefficient";
/// Column of a push: the velocity u of the gas at the particle in m/s of motion time, three values.
pub const GAS_VELOCITY: &str = "gas_velocity";
/// Column that is received: the impulse of that drag in N s, three values; a part of the whole impulse. Of a particle that
/// is held its support takes it up.
pub const DRAG_IMPULSE: &str = "drag_impulse";

/// Overlap of two surfaces over the radius of the smaller particle above which it is told of. Springs that are softened for longer
/// steps come to a tenth in impacts. At a fifth the contact of two equal spheres has 0.32 of their radius by Hertz, whose theory takes
/// it as small, and 1.5 % of a sphere's volume lies in each of its contacts.
pub const DEEP_CONTACT: f64 = 0.2;

/// What the particles report of a window, in the order of the push, of one real particle each.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ParticleReceived {
    /// Impulse of all that was pushed as applied over the motion span in N s; a frozen particle is
    /// held, and its support takes it up.
    pub impulse: Vec<Vec3>,
    /// Motion time in s that the solver's steps cover, over which gravity acted.
    pub acted: f64,
    /// Impulse in N s that walls and held particles gave all free ones together; `None` where it is not
    /// counted.
    pub support: Option<Vec3>,
    /// Contacts that were pressed in by more than [`DEEP_CONTACT`], by rows: the most in one step of the window, and the
    /// deepest of all, over the radius of the smaller particle; `None` where the solver does not look, and the coordinator
    /// looks at the end of the window.
    pub deep_contacts: Option<Excursion>,
    /// Further columns, as the solver has some.
    pub columns: NamedColumns,
}

/// Positions, velocities, contacts.
pub trait Particles: Part {
    /// State after the last commit (initially: the start of the run).
    fn fields(&self) -> ParticleFields<'_>;

    /// Takes particles out, puts new ones in and gives others another size, between two windows and after a
    /// commit. A held bed only has to take sizes.
    fn change(
        &mut self,
        supervisor: &Supervisor,
        change: &ParticleChanges,
    ) -> Result<(), PartError>;

    /// True where the solver takes a column of this name with a push, beside the forces.
    fn takes(&self, column: &str) -> bool;

    /// Starts the window in the bed as the gas had it, one value a cell of the gas' mesh; does not wait.
    fn start(&mut self, window: &Window, bed: &Bed, push: &ParticlePush) -> Result<(), PartError>;

    /// Waits for the window started last. Particles have one attempt only.
    fn finish(
        &mut self,
        supervisor: &Supervisor,
        received: &mut ParticleReceived,
    ) -> Result<(), PartError>;
}
