//! Why a plant cannot be followed.

use calcine_coupler::coordinator::CheckpointError;
use calcine_flowsheet::PlantError;
use miette::Diagnostic;
use thiserror::Error;

use crate::exit;
use crate::results::ResultsError;
use crate::simulation::SimulationError;

/// Why a plant cannot be followed, or its results not be written.
#[derive(Debug, Error)]
pub enum PlantRunError {
    /// The plant could not be followed.
    #[error("{0}")]
    Plant(#[from] PlantError),
    /// Results that cannot be written or read.
    #[error(transparent)]
    Results(#[from] ResultsError),
    /// A checkpoint that cannot be written or read.
    #[error(transparent)]
    Checkpoint(#[from] CheckpointError),
    /// A results folder that cannot be used.
    #[error(transparent)]
    Folder(#[from] SimulationError),
    /// A state that a bed is no part of.
    #[error(
        "`--from` does not go with the bed \"{0}\", which begins as its case says: leave `--from` out"
    )]
    FromWithBed(String),
    /// A state of another plant.
    #[error(
        "the plant in {folder} has {found} unknowns, this one has {own}: `--from` takes the state of a plant with the same units, sizes and compounds"
    )]
    OtherPlant {
        /// Folder that the state is from.
        folder: String,
        /// Unknowns of it.
        found: usize,
        /// Unknowns of this plant.
        own: usize,
    },
}

impl PlantRunError {
    /// The exit code of the command.
    pub fn exit_code(&self) -> u8 {
        match self {
            Self::Plant(_) => exit::DIVERGED,
            Self::Results(ResultsError::File { .. } | ResultsError::Spoilt { .. })
            | Self::Checkpoint(CheckpointError::Io { .. }) => exit::OTHER,
            Self::Folder(error) => error.exit_code(),
            Self::Results(_)
            | Self::Checkpoint(_)
            | Self::OtherPlant { .. }
            | Self::FromWithBed(_) => exit::CASE,
        }
    }

    /// What to do, where the message does not say it.
    pub fn help(&self) -> Option<String> {
        match self {
            Self::Results(error) => error.help().map(|help| help.to_string()),
            _ => None,
        }
    }
}
