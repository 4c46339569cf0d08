//! Shared memory keeps the laws of every transport.

#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

use calcine_wire::shared_memory::LinkEnd;
use calcine_wire::{RunDirectory, SharedMemory};

use crate::laws::Ends;

fn shared_memory() -> Ends {
    let run = RunDirectory::create().unwrap();
    let address = run.address("gas");
    let open = |end| Box::new(SharedMemory::open(&address, 0, end).unwrap());
    Ends {
        coordinator: open(LinkEnd::Coordinator),
        solver: open(LinkEnd::Solver),
        number: address.number(),
        run: Some(run),
    }
}

conformance!(shared_memory);
