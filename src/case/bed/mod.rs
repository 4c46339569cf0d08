//! Particles read from files: CSV, LIGGGHTS dumps, particle input of MFiX, VTK in its old and its XML form.

mod csv;
mod dump;
mod legacy;
mod mfix;
mod sheet;
mod xml;

use calcine_coupler::regular_file;
use std::path::Path;

pub(super) use sheet::{Choice, Entry, Heaviness};
use sheet::{Fault, Row, Sheet};

use super::place_error::PlaceError;

/// The columns of a file that are read and those that are not, by their names in lower case.
pub(super) fn columns(path: &Path, choice: Choice) -> Result<[Vec<String>; 2], PlaceError> {
    let columns = open(path, choice)?.columns.into_iter();
    let named = columns.filter(|(name, _)| !name.is_empty());
    Ok(named
        .map(|(name, _)| name)
        .partition::<Vec<_>, _>(|name| sheet::is_read(name))
        .into())
}

/// The particles of a file, in the order of their ids where it has ids.
pub(super) fn read(path: &Path, choice: Choice) -> Result<Vec<Entry>, PlaceError> {
    open(path, choice)?
        .entries(choice)
        .map_err(|fault| in_file(path, fault))
}

fn in_file(path: &Path, (row, what): Fault) -> PlaceError {
    PlaceError::File {
        place: match row {
            Some(row) => format!("{}, {row}", path.display()),
            None => path.display().to_string(),
        },
        what,
    }
}

fn open(path: &Path, choice: Choice) -> Result<Sheet, PlaceError> {
    if path.is_dir() {
        return Err(PlaceError::File {
            place: path.display().to_string(),
            what: "it is a folder; name a file of particles in it".into(),
        });
    }
    let bytes = regular_file::read(path).map_err(|cause| PlaceError::Io {
        path: path.to_owned(),
        cause,
    })?;
    sheet(path, &bytes, choice).map_err(|fault| in_file(path, fault))
}

fn sheet(path: &Path, bytes: &[u8], choice: Choice) -> Result<Sheet, Fault> {
    let extension = path.extension().map(|e| e.to_string_lossy().to_lowercase());
    let text = || {
        std::str::from_utf8(bytes).map_err(|error| {
            let line = 1 + bytes[..error.valid_up_to()]
                .iter()
                .filter(|&&byte| byte == b'\n')
                .count();
            let what = "it is not text; binary files other than .vtu and .vtp are not read";
            (Some(Row::Line(line)), what.to_owned())
        })
    };
    // LIGGGHTS names dumps as users like, often by the step: bed.dump, dump.liggghts, d1000.
    let dump = bytes.starts_with(b"ITEM:");
    if choice.timestep.is_some() && !dump {
        let what = "it holds no timesteps to choose from; leave out `timestep`";
        return Err((None, what.into()));
    }
    if dump {
        return dump::sheet(text()?, choice.timestep).and_then(Sheet::checked);
    }
    match extension.as_deref() {
        Some("vtu" | "vtp") => xml::sheet(bytes),
        Some("vtk") => legacy::sheet(text()?),
        Some("csv" | "txt") => csv::sheet(text()?).and_then(Sheet::checked),
        Some("dat") => mfix::sheet(text()?),
        _ => {
            let what = "it is none of .csv, .dat, .vtk, .vtu, .vtp, nor does it begin with \"ITEM:\" as a \
                        LIGGGHTS dump does";
            Err((None, what.into()))
        }
    }
}
