//! Whether pairings can run a case on this machine, found out before anything runs.

use calcine_adapters::find::REMEDY;

use super::doctor;
use super::failure::Failure;
use crate::assembly::{Pairing, SolverStarts, programs};
use crate::exit;
use crate::valid::ValidCase;

/// Refuses a pairing whose solvers are not on this machine, or would refuse the case.
pub(super) fn able(valid: &ValidCase, pairing: Pairing) -> Result<(), Failure> {
    let missing = |words: String| Failure::new(exit::PEER, words);
    let found = programs(&valid.case, pairing).map_err(|error| missing(error.to_string()))?;
    for program in found {
        let absent = doctor::absent_libraries(&program);
        if !absent.is_empty() {
            return Err(missing(format!(
                "{} needs {}, which is not on this machine; {REMEDY}",
                program.display(),
                absent.join(", ")
            )));
        }
    }
    let starts = SolverStarts::of(&valid.case, pairing);
    let parallel = !pairing.is_native() && starts.gas.ranks.max(starts.particles.ranks) > 1;
    if parallel && doctor::mpi().is_none() {
        return Err(missing(format!(
            "mpirun is not on this machine, and the case asks for several ranks; {REMEDY}"
        )));
    }
    Ok(valid.honoured_by(pairing)?)
}
