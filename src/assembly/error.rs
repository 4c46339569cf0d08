//! What keeps a case from being assembled.

use calcine_adapters::last_words;
use calcine_coupler::coordinator::RunError;
use calcine_coupler::error::PartError;
use calcine_coupler::interior::radial::RadialError;
use calcine_coupler::interior::reacting::LayersError;
use calcine_coupler::smoother::SmootherError;
use calcine_native::gas::NativeError;
use calcine_native::parcels::ParcelError;
use thiserror::Error;

use crate::case::model::Case;
use crate::case::sizes::TooLarge;
use crate::case::{MeshingError, PlaceError};

/// A case that cannot be assembled, although its file was in order.
#[derive(Debug, Error)]
pub enum AssemblyError {
    /// The mesh cannot be made or read.
    #[error("mesh: {0}")]
    Mesh(#[from] MeshingError),
    /// An excluded zone beside the mesh.
    #[error(
        "`coupling.smoother.excluded[{index}]` holds no centre of a cell; enlarge it, or move it into \
         the mesh"
    )]
    Excluded {
        /// Number of the zone, from 0.
        index: usize,
    },
    /// Radiation between particles of a domain that repeats itself.
    #[error(
        "particles do not see each other across the periodic planes along {axis}; write `laws.radiation = {{ law = \"none\" }}`, \
         or make the patches walls"
    )]
    PeriodicRadiation {
        /// Axis of the first periodic direction.
        axis: char,
    },
    /// More than this machine's memory.
    #[error(transparent)]
    TooLarge(#[from] TooLarge),
    /// The particles cannot be placed.
    #[error("particles: {0}")]
    Particles(#[from] PlaceError),
    /// Reactions that make no shrinking core.
    #[error("reactions: {0}")]
    Layers(#[from] LayersError),
    /// Particles that can have no shells.
    #[error("particles with shells: {0}")]
    Radial(#[from] RadialError),
    /// A native solver refuses the case or a checkpoint.
    #[error(transparent)]
    Native(#[from] NativeError),
    /// Parcels that the native solver cannot move.
    #[error(transparent)]
    Parcels(#[from] ParcelError),
    /// A gas of the user's own that the case does not name.
    #[error("the case names no gas solver of your own; add [external.gas] with program = \"…\"")]
    NoExternalGas,
    /// Particles of the user's own that the case does not name.
    #[error(
        "the case names no particle solver of your own; add [external.particles] with program = \"…\""
    )]
    NoExternalParticles,
    /// A part could not start.
    #[error(transparent)]
    Part(#[from] PartError),
    /// The bed does not fit, or a checkpoint cannot be taken up.
    #[error(transparent)]
    Run(#[from] RunError),
}

impl AssemblyError {
    /// What helps against the failure of an external solver at its start.
    pub fn remedy(&self) -> Option<&'static str> {
        match self {
            Self::Part(part) | Self::Run(RunError::Part(part)) => last_words::remedy(part),
            _ => None,
        }
    }

    /// The key of the case that the error is about, where it is about one.
    pub fn key(&self, case: &Case) -> Option<String> {
        match self {
            Self::Mesh(_) => Some("mesh".into()),
            Self::PeriodicRadiation { .. } => Some("laws.radiation".into()),
            Self::Excluded { index } => Some(format!("coupling.smoother.excluded[{index}]")),
            Self::Particles(error) => Some(error.key(case)),
            Self::Layers(_) => Some("reactions".into()),
            Self::Radial(_) => Some("materials".into()),
            Self::NoExternalGas | Self::NoExternalParticles => None,
            Self::Run(RunError::Smoother(SmootherError::DoesNotFit { .. })) => {
                Some("particles".into())
            }
            Self::Run(RunError::Smoother(SmootherError::DiffusionLength { .. })) => {
                Some("coupling.smoother".into())
            }
            Self::Parcels(_) => Some("particles".into()),
            Self::TooLarge(_) | Self::Native(_) | Self::Part(_) | Self::Run(_) => None,
        }
    }
}
