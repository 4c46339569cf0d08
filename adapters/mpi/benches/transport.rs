//! Latency and throughput of the MPI transport, between a coordinator and a rank that it spawned.

#![allow(clippy::unwrap_used, missing_docs)]

#[path = "../../wire/benches/trips/mod.rs"]
mod trips;

use std::time::Duration;

use calcine_mpi::{MpiNetwork, SpawnedWorld, end, finalize};
use calcine_wire::run::VARIABLE;
use calcine_wire::{CarriedTransport, LinkAddress, SolverNetwork};
use criterion::Criterion;

fn main() {
    // Spawned by itself: the solver.
    if let Ok(address) = LinkAddress::from_environment() {
        let universe = mpi::initialize().unwrap();
        let place = SpawnedWorld::parent().unwrap().of_coordinator();
        trips::answer(Box::new(
            CarriedTransport::of_solver(place, &address).unwrap(),
        ));
        return finalize(universe);
    }
    let (network, universe) = MpiNetwork::start().unwrap();
    let address = network.address("gas");
    let line = [
        "/usr/bin/env".into(),
        format!("{VARIABLE}={}", address.to_text()).into(),
        std::env::current_exe().unwrap().into_os_string(),
    ];
    let patience = Duration::from_secs(60);
    let ends = network.spawn(&line, 1, patience, &|| false).unwrap();
    let mut criterion = Criterion::default().configure_from_args();
    for solver in ends {
        trips::measure("transport: MPI", solver, &mut criterion);
    }
    criterion.final_summary();
    network.goodbye();
    let quiet = network.is_quiet();
    drop(network);
    end(quiet, universe, 0)
}
