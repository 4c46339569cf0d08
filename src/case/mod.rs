//! Case files: TOML to a checked [`model::Case`].

mod accuracy_cautions;
mod bed;
mod bodies;
mod boundaries;
pub mod buoyancy;
pub mod cautions;
mod check;
mod conduction_step;
pub mod contacts;
mod duct_flow;
pub mod expectations;
mod fall;
mod flow_numbers;
mod flow_time;
mod idle_cautions;
mod impact;
pub mod in_wall;
mod input_files;
pub mod keys;
mod kind;
mod located;
mod mesh_shape;
mod meshing;
pub mod model;
mod moving;
mod other_density;
mod overlap;
pub mod packed;
mod parcel_wall_error;
pub mod parcels;
mod parse;
mod patch_cautions;
mod place;
mod place_error;
pub mod plant;
mod problem;
mod ranges;
mod reach_cautions;
mod resolved;
mod schedules;
pub mod schema;
mod sections;
mod servo_cautions;
mod set;
mod size_cautions;
pub mod sizes;
mod span;
mod splitting;
mod step;
mod stl;
mod surface_holes;
mod syntax;
mod table;
mod temperature_cautions;
mod time_cautions;
mod tolerance;
mod touching;
pub mod units;
mod used_up;
mod wall_cautions;
pub mod warnings;
mod words;
mod work;

use calcine_coupler::regular_file;
use std::path::Path;

pub use boundaries::mesh_of;
pub use check::{Refusals, check_report};
pub use kind::{kind_of, kind_of_text};
pub use located::located;
pub use meshing::{MeshingError, mesh};
pub use place::{InitialParticles, particles};
pub use place_error::PlaceError;
pub use problem::{CaseErrors, Problem};
pub use schedules::breaks;
use sha2::{Digest, Sha256};
pub use step::settle;

use model::Case;
use parse::{parse_as, text_of};

use crate::hex::hex;
use crate::laws::LawCatalogue;
use crate::tuning::case::TuningCase;

/// Reads and checks a case file with `--set key=value` applied; all its errors at once.
pub fn read(path: &Path, set: &[String]) -> Result<Case, CaseErrors> {
    read_with(path, set, &LawCatalogue::default())
}

/// Reads a case file that may choose among these laws.
pub fn read_with(path: &Path, set: &[String], laws: &LawCatalogue) -> Result<Case, CaseErrors> {
    parse_with(path, &text_of(path)?, set, laws)
}

/// Checks the text of a case file; `path` places relative paths and messages.
pub fn parse(path: &Path, text: &str, set: &[String]) -> Result<Case, CaseErrors> {
    parse_with(path, text, set, &LawCatalogue::default())
}

/// Checks the text of a case file that may choose among these laws.
pub fn parse_with(
    path: &Path,
    text: &str,
    set: &[String],
    laws: &LawCatalogue,
) -> Result<Case, CaseErrors> {
    let (mut case, changes) = parse_as(
        path,
        text,
        set,
        &keys::KINDS[0],
        laws,
        |root, effective, hash| sections::case(root, path, effective, hash),
    )?;
    case.files = input_files::sums(&case);
    case.hash = input_files::extended(case.hash, &case.files);
    case.changes = changes;
    if !set.is_empty() {
        case.lines = set::lines(text, &case.effective);
    }
    Ok(case)
}

/// Reads and checks a tuning with `--set key=value` applied; all its errors at once.
pub fn read_tuning(path: &Path, set: &[String]) -> Result<TuningCase, CaseErrors> {
    parse_tuning(path, &text_of(path)?, set)
}

/// Checks the text of a tuning; `path` places relative paths and messages.
pub fn parse_tuning(path: &Path, text: &str, set: &[String]) -> Result<TuningCase, CaseErrors> {
    let kind = keys::kind_named("tuning").unwrap_or(&keys::KINDS[0]);
    let laws = LawCatalogue::default();
    let (mut case, changes) = parse_as(path, text, set, kind, &laws, |root, effective, hash| {
        sections::tuning::tuning(root, path, effective, hash)
    })?;
    case.changes = changes;
    let mut digest = Sha256::new();
    digest.update(case.hash.as_bytes());
    for file in &case.files {
        digest.update(regular_file::read(file).unwrap_or_default());
    }
    case.hash = hex(digest.finalize());
    Ok(case)
}
