//! MPI keeps the laws of every transport: both ends in one process, on a communicator with itself.

#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

#[macro_use]
#[path = "../../wire/tests/laws/mod.rs"]
mod laws;

use std::sync::{Mutex, Once};

use calcine_mpi::{MpiNetwork, SpawnedWorld};
use calcine_wire::CarriedTransport;
use laws::Ends;

/// MPI once for all tests; this process ends without ending it.
static STARTED: Once = Once::new();
/// One communicator is made at a time.
static TURN: Mutex<()> = Mutex::new(());

fn mpi() -> Ends {
    STARTED.call_once(|| {
        let (network, universe) = MpiNetwork::start().unwrap();
        // Its files go with the network; MPI goes with the process.
        drop(network);
        std::mem::forget(universe);
    });
    let _turn = TURN.lock().unwrap();
    let world = SpawnedWorld::alone().unwrap();
    Ends {
        coordinator: Box::new(CarriedTransport::new(world.of_rank(0))),
        solver: Box::new(CarriedTransport::new(world.of_coordinator())),
        number: 7,
        run: None,
    }
}

conformance!(mpi);
