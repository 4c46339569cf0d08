//! Why the host ends.

use std::io;
use std::path::PathBuf;

use calcine_wire::{SolverFailure, WireError};
use thiserror::Error;

/// Why the host ends.
#[derive(Debug, Error)]
pub enum HostError {
    /// Not started by Calcine.
    #[error("usage: calcine-liggghts SCRIPT CASE-HASH [RESTART-FILE], started by `calcine run`")]
    Usage,
    /// The link.
    #[error("{0}")]
    Wire(#[from] WireError),
    /// A file.
    #[error("{}: {cause}", path.display())]
    File {
        /// Which.
        path: PathBuf,
        /// Why.
        cause: io::Error,
    },
    /// LIGGGHTS does not have what every granular run has.
    #[error("LIGGGHTS has no `{name}`; the script needs `atom_style granular` and particles")]
    Missing {
        /// The name asked for.
        name: &'static str,
    },
    /// A script by which the force of the gas would not act, or twice.
    #[error(
        "the script does not have the host add the force of the gas once a step (`fix {name}`): it is that of another version of \
         Calcine; install `calcine` and `calcine-liggghts` together"
    )]
    NoPush {
        /// The fix that does.
        name: &'static str,
    },
    /// Particles that went away.
    #[error(
        "{found} of {expected} particles are left; they left the box or their speed exploded{which}"
    )]
    Lost {
        /// Particles now.
        found: u64,
        /// Particles before.
        expected: u64,
        /// The first that is gone, with where it was last seen.
        which: String,
    },
    /// A window without a step.
    #[error("a window of {span} s holds no time step of {step} s; shorten `motion.motion_step`")]
    NoStep {
        /// The window in s.
        span: f64,
        /// The step in s.
        step: f64,
    },
    /// A change that cannot be understood.
    #[error("the change of particles has a line that is not understood: {line}")]
    Change {
        /// The line.
        line: String,
    },
    /// The push is for other particles.
    #[error("the push has no force for particle {id}")]
    Push {
        /// The particle's id.
        id: u64,
    },
}

impl HostError {
    /// Its kind on the wire.
    pub fn failure(&self) -> SolverFailure {
        match self {
            HostError::Usage | HostError::Wire(_) => SolverFailure::Other,
            HostError::File { .. } => SolverFailure::File,
            HostError::Lost { .. } => SolverFailure::LostParticles,
            HostError::Missing { .. } | HostError::NoPush { .. } | HostError::NoStep { .. } => {
                SolverFailure::InvalidInput
            }
            HostError::Change { .. } | HostError::Push { .. } => SolverFailure::InvalidInput,
        }
    }
}
