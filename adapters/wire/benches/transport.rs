//! Latency and throughput of the shared-memory transport, between two processes.

#![allow(clippy::unwrap_used, missing_docs)]

mod trips;

use std::process::Command;

use calcine_wire::run::VARIABLE;
use calcine_wire::shared_memory::LinkEnd;
use calcine_wire::{LinkAddress, RunDirectory, SharedMemory};
use criterion::Criterion;

fn main() {
    // Started once more by itself: the solver.
    if let Ok(address) = LinkAddress::from_environment() {
        let end = SharedMemory::open(&address, 0, LinkEnd::Solver).unwrap();
        return trips::answer(Box::new(end));
    }
    let run = RunDirectory::create().unwrap();
    let address = run.address("gas");
    let end = SharedMemory::open(&address, 0, LinkEnd::Coordinator).unwrap();
    let mut solver = Command::new(std::env::current_exe().unwrap())
        .env(VARIABLE, address.to_text())
        .spawn()
        .unwrap();
    let mut criterion = Criterion::default().configure_from_args();
    trips::measure("transport: shared memory", Box::new(end), &mut criterion);
    solver.wait().unwrap();
    criterion.final_summary();
}
