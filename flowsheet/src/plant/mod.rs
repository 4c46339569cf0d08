//! Units and streams together.

mod beds;
mod continuation;
mod estimation;
mod explicit;
mod flows;
mod implicit;
mod jacobian;
mod ledger;
mod look;
mod method;
mod order;
mod run;
mod sensitivity;
mod stabilised;
mod steady;
mod tear;
mod topology;
mod waveform;
mod windows;

pub use continuation::{Continuation, ContinuationPoint};
pub use estimation::{MeasuredDistribution, MeasuredState, PlantEstimation, PlantResiduals};
pub use flows::{FlowWorkspace, LOOP_CLOSURE};
pub use ledger::{LedgerLine, PlantLedger};
pub use run::{Integrator, PlantRun, PlantStep};
pub use sensitivity::{Derivatives, PlantFamily};
pub use steady::{Mode, Stability, SteadyState};
pub use topology::{Connection, Plant, PlantUnit};
pub use waveform::{TearAcceleration, Waveform, WaveformSettings};
