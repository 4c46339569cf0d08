//! Observers: output, progress and timing look at the run after each committed window.

use std::path::Path;
use std::time::Duration;

use calcine_physics::Vec3;
use thiserror::Error;

use crate::bodies::HeatBodies;
use crate::exchange::ExchangeConvergence;
use crate::findings::Finding;
use crate::ledger::Ledger;
use crate::mesh::Mesh;
use crate::models::ParticleModels;
use crate::outflows::OutletTotals;
use crate::part::{Bed, Convergence, GasFields, GasPhases, ParticleFields, PatchFlow, SolverInfo};
use crate::step_error::StepError;
use crate::time::{Clocks, Window};

/// Wall time spent in each stage since this process began the run, and processor time of the two solvers.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Timing {
    /// Waiting for the gas.
    pub gas: Duration,
    /// Waiting for the particles.
    pub particles: Duration,
    /// Inside particles.
    pub interior: Duration,
    /// Base mapping of particles onto cells.
    pub mapping: Duration,
    /// Building and applying the smoother.
    pub smoother: Duration,
    /// Laws between the phases and the exchange.
    pub exchange: Duration,
    /// Observers and checkpoints.
    pub output: Duration,
    /// Processor time of the gas: of this process while it waits for the gas.
    pub gas_processor: Duration,
    /// Wall time of the gas' phases so far, where it tells.
    pub gas_phases: Option<GasPhases>,
    /// The same, of processes of the gas' own; up to date at checkpoints and at the end.
    pub gas_processes: Duration,
    /// Processor time of this process while it waits for the particles.
    pub particles_processor: Duration,
    /// The same, of processes of the particles' own; up to date at checkpoints and at the end.
    pub particles_processes: Duration,
}

/// What each particle had of the gas in the last window, in the order of the particles.
#[derive(Clone, Copy, Debug, Default)]
pub struct ParticleGasExchange<'a> {
    /// Force of the gas on each in N, constant over the window; zero before the first.
    pub force: &'a [Vec3],
    /// Void fraction that the laws saw.
    pub void_fraction: &'a [f64],
    /// Magnitude in m/s of the slip u − v/AF that the laws saw; zero before the first window.
    pub slip: &'a [f64],
}

/// The state of the run after a commit.
#[derive(Clone, Copy, Debug)]
pub struct CommittedState<'a> {
    /// Windows committed so far.
    pub windows: u64,
    /// Both clocks now.
    pub clocks: Clocks,
    /// The window just committed; `None` at the start of a run or right after a resume.
    pub window: Option<&'a Window>,
    /// The gas mesh.
    pub mesh: &'a Mesh,
    /// The gas.
    pub gas: GasFields<'a>,
    /// The bed that the gas saw.
    pub bed: &'a Bed,
    /// Share of the solid volume that the smoother moved out of cells above its threshold.
    pub smoothed_share: f64,
    /// The particles.
    pub particles: ParticleFields<'a>,
    /// Particle temperatures in K, in the order of `particles`.
    pub particle_temperature: &'a [f64],
    /// Mean heat flow into each particle over the window in W.
    pub particle_heat: &'a [f64],
    /// Particle masses in kg, as their models have it where these change it.
    pub particle_mass: &'a [f64],
    /// What is inside the particles, as columns by their names.
    pub models: &'a ParticleModels,
    /// What else the particles had of the gas.
    pub particle_gas: ParticleGasExchange<'a>,
    /// What passed each patch of the gas in the window, in the order of the mesh; empty before the first window of this process, and of
    /// a gas that does not tell.
    pub patch_flows: &'a [PatchFlow],
    /// Bodies that store heat.
    pub bodies: &'a HeatBodies,
    /// Names of walls and surroundings that give heat to the particles.
    pub reservoirs: &'a [String],
    /// Mean heat from each of these into the particles over the window in W; empty where there is none.
    pub reservoir_heat: &'a [f64],
    /// The ledger so far.
    pub ledger: &'a Ledger,
    /// What left through each outlet so far.
    pub outlets: &'a [OutletTotals],
    /// Mass in kg that feeds should have brought and that found no room.
    pub waiting: f64,
    /// The estimated error of the window's step; `None` where too few windows have passed for one.
    pub step_error: Option<&'a StepError>,
    /// Largest Courant number of the gas at the end of the window, over its motion time.
    pub courant: Option<f64>,
    /// Convergence of the gas in the window.
    pub convergence: &'a Convergence,
    /// Attempts of the window, and what they left misplaced.
    pub exchange_convergence: &'a ExchangeConvergence,
    /// What the window left outside the range of a law, or unconverged, in the order of the kinds.
    pub findings: &'a [Finding],
    /// Wall times by stage.
    pub timing: &'a Timing,
    /// The two solvers.
    pub about: [&'a SolverInfo; 2],
}

/// A window that is begun again, shorter.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CutNotice {
    /// Cuts since the last commit.
    pub cuts: u32,
    /// Attempts given up since then.
    pub attempts: u32,
    /// Length of the window now, in s of process time.
    pub span: f64,
}

/// An observer that could not do its work, for example because a disk is full.
#[derive(Debug, Error)]
#[error("{doing}: {cause}")]
pub struct ObserverError {
    /// What it was doing, with the path.
    pub doing: String,
    /// Why it failed.
    #[source]
    pub cause: Box<dyn std::error::Error + Send + Sync>,
}

/// Looks at the run; never changes it.
pub trait Observer {
    /// Called once before the first window of this process: at the start of a run
    /// (`windows` is 0) or after a resume.
    fn start(&mut self, moment: &CommittedState<'_>) -> Result<(), ObserverError>;

    /// Called after a window was given up because particles that react did not settle with their gas; it is begun again,
    /// shorter, from the moment given.
    fn cut(&mut self, moment: &CommittedState<'_>, notice: CutNotice) -> Result<(), ObserverError> {
        let _ = (moment, notice);
        Ok(())
    }

    /// Called after each committed window.
    fn window(&mut self, moment: &CommittedState<'_>) -> Result<(), ObserverError>;

    /// Called while a checkpoint is written: what the observer needs to go on from here goes into
    /// `directory`.
    fn checkpoint(
        &mut self,
        moment: &CommittedState<'_>,
        directory: &Path,
    ) -> Result<(), ObserverError>;

    /// Called once after the last window.
    fn finish(&mut self, moment: &CommittedState<'_>) -> Result<(), ObserverError>;
}
