//! The one place that says whether a case can be run: `calcine check` and everything that runs a case ask here.

use std::path::Path;

use calcine_coupler::error::PartError;
use thiserror::Error;

use crate::assembly::{
    AssemblyError, GasBackend, Pairing, PreparedCase, check_for_liggghts,
    check_for_openfoam_parcels, native_parts, pairing_cautions, write_inputs,
};
use crate::case::model::Case;
use crate::case::packed::BedPacking;
use crate::case::warnings::warnings;
use crate::case::{CaseErrors, Refusals, check_report, located, read_with, settle};
use crate::laws::LawCatalogue;
use crate::results::{self, ResultsError};

/// A case that is in order, with what is made of it before a run.
#[derive(Debug)]
pub struct ValidCase {
    /// The case.
    pub case: Case,
    /// Its mesh and particles at the start.
    pub prepared: PreparedCase,
    /// How the bed is packed at the start.
    pub packing: BedPacking,
}

/// Why a case cannot be run.
#[derive(Debug, Error)]
pub enum InvalidCase {
    /// Errors of its file, all at once.
    #[error("{}", .0.render())]
    File(#[from] CaseErrors),
    /// A mesh, particles or a bed that cannot be made of it, or solvers that refuse them.
    #[error(transparent)]
    Assembly(#[from] AssemblyError),
    /// Results that cannot be written of it.
    #[error(transparent)]
    Results(#[from] ResultsError),
}

/// An error with the lines of the case that it is about, where it is about some.
fn placed(case: &Case, error: AssemblyError) -> InvalidCase {
    match error.key(case) {
        Some(key) => InvalidCase::File(located(case, &key, &error)),
        None => error.into(),
    }
}

impl ValidCase {
    /// Reads a case with `--set key=value` applied, makes its mesh and particles, and fits the bed into the mesh.
    pub fn open(path: &Path, set: &[String]) -> Result<Self, InvalidCase> {
        Self::open_with(path, set, &LawCatalogue::default())
    }

    /// The same of a case that may choose among these laws.
    pub fn open_with(
        path: &Path,
        set: &[String],
        laws: &LawCatalogue,
    ) -> Result<Self, InvalidCase> {
        let mut case = read_with(path, set, laws)?;
        let prepared = PreparedCase::new(&case).map_err(|error| placed(&case, error))?;
        settle(&mut case, &prepared.mesh);
        let packing = prepared.packing(&case);
        let packing = packing.map_err(|error| placed(&case, error))?;
        results::fits(&case, &prepared.mesh)?;
        case.warnings = warnings(
            &case,
            &prepared.mesh,
            (&prepared.particles, &prepared.temperature, &prepared.notes),
            &packing,
        );
        Ok(Self {
            case,
            prepared,
            packing,
        })
    }

    /// Adds to the warnings about the case what is to be warned of because of the solvers of a pairing.
    pub fn warn_of(&mut self, pairing: Pairing) {
        let more = pairing_cautions(&self.case, &self.prepared, pairing);
        self.case.warnings.extend(more);
    }

    /// The case in words: clocks, sizes, the flow, and whether LIGGGHTS and OpenFOAM can move its particles.
    pub fn report(&self) -> String {
        let (case, prepared) = (&self.case, &self.prepared);
        let told = |refused: Result<(), PartError>| {
            let refused = refused.err();
            refused.map(|error| crate::error_chain::chain(&error))
        };
        let liggghts = told(check_for_liggghts(case, prepared));
        let parcels = told(check_for_openfoam_parcels(case, prepared));
        check_report(
            case,
            &prepared.mesh,
            &prepared.particles,
            &self.packing,
            Refusals {
                liggghts: liggghts.as_deref(),
                openfoam_parcels: parcels.as_deref(),
            },
        )
    }

    /// Refuses what the solvers of a pairing would refuse at their start: makes the native ones, and writes the inputs
    /// of the external ones into a folder that is removed again.
    pub fn honoured_by(&self, pairing: Pairing) -> Result<(), InvalidCase> {
        native_parts(&self.case, &self.prepared, pairing)?;
        let written = Pairing {
            gas: match self.case.gas_held {
                true => GasBackend::Native,
                false => pairing.gas,
            },
            particles: pairing.particles_of(&self.case),
        };
        if !written.is_native() {
            let place = std::env::temp_dir();
            let folder = tempfile::tempdir_in(&place).map_err(ResultsError::file("create", &place));
            write_inputs(&self.case, &self.prepared, written, folder?.path())?;
        }
        Ok(())
    }
}
