//! MPI as what carries a run's messages: solvers are spawned, each in a world of its own, and talk over
//! the intercommunicator.

#[allow(unsafe_code)]
mod carrier;
mod network;

pub use carrier::{MpiCarrier, SpawnedWorld, finalize, place_files};
pub use network::{MpiNetwork, end};
