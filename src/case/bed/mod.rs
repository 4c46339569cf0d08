//! Particles read from files: CSV, LIGGGHTS dumps, VTK in its old and its XML form.

mod csv;
mod dump;
mod legacy;
mod sheet;
mod xml;

use std::path::Path;

pub(super) use sheet::{Choice, Entry, Heaviness};
use sheet::{Fault, Row, Sheet};

use super::place_error::PlaceError;

/// The particles of a file, in the order of their ids where it has ids.
pub(super) fn read(path: &Path, choice: Choice) -> Result<Vec<Entry>, PlaceError> {
    if path.is_dir() {
        return Err(PlaceError::File {
            place: path.display().to_string(),
            what: "it is a folder; name a file of particles in it".into(),
        });
    }
    let bytes = std::fs::read(path).map_err(|cause| PlaceError::Io {
        path: path.to_owned(),
        cause,
    })?;
    sheet(path, &bytes, choice)
        .and_then(|sheet| sheet.entries(choice))
        .map_err(|(row, what)| PlaceError::File {
            place: match row {
                Some(row) => format!("{}, {row}", path.display()),
                None => path.display().to_string(),
            },
            what,
        })
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
    let known = ["csv", "txt", "vtk", "vtu", "vtp"];
    let dump = extension.as_deref().is_none_or(|e| !known.contains(&e));
    if choice.timestep.is_some() && !dump {
        let what = "it holds no timesteps to choose from; leave out `timestep`";
        return Err((None, what.into()));
    }
    match extension.as_deref() {
        Some("vtu" | "vtp") => xml::sheet(bytes),
        Some("vtk") => legacy::sheet(text()?),
        Some("csv" | "txt") => csv::sheet(text()?).and_then(Sheet::checked),
        // LIGGGHTS names dumps as users like, often by the step: bed.dump, dump.liggghts, d1000.
        _ if bytes.starts_with(b"ITEM:") => dump::sheet(text()?, choice.timestep),
        _ => {
            let what = "it is none of .csv, .vtk, .vtu, .vtp, nor does it begin with \"ITEM:\" as a \
                        LIGGGHTS dump does";
            Err((None, what.into()))
        }
    }
}
