//! Units and streams together.

mod explicit;
mod flows;
mod implicit;
mod jacobian;
mod ledger;
mod order;
mod run;
mod steady;
mod topology;

pub use flows::{FlowWorkspace, LOOP_CLOSURE};
pub use ledger::{LedgerLine, PlantLedger};
pub use run::{Integrator, PlantRun, PlantStep};
pub use steady::{Mode, Stability, SteadyState};
pub use topology::{Connection, Plant, PlantUnit};
