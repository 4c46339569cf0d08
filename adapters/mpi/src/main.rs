//! `calcine-mpi`: the command `calcine` where solvers are spawned by MPI. `calcine run --transport mpi`
//! becomes it.

use std::process::ExitCode;
use std::sync::Arc;

use calcine_mpi::{MpiNetwork, end};
use calcine_wire::SolverNetwork;

fn main() -> ExitCode {
    let (network, universe) = match MpiNetwork::start_guarded() {
        Ok(started) => started,
        Err(error) => {
            eprintln!("MPI cannot be started: {error}");
            return ExitCode::from(calcine::exit::PEER);
        }
    };
    let network = Arc::new(network);
    let code = {
        let network: Arc<dyn SolverNetwork> = network.clone();
        calcine::commands::run_line(Some(&network))
    };
    let quiet = network.is_quiet();
    // With it the run's files go.
    drop(network);
    end(quiet, universe, code)
}
