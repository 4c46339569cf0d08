//! VTK's XML format (`.vtp`, `.vtu`).

use super::sheet::{Fault, Sheet, add};
use crate::vtk_xml;

fn fault(what: impl Into<String>) -> Fault {
    (None, what.into())
}

pub(super) fn sheet(bytes: &[u8]) -> Result<Sheet, Fault> {
    let file = vtk_xml::read(bytes).map_err(|error| fault(error.to_string()))?;
    let values = |array: &vtk_xml::DataArray| {
        let values = file.values(array);
        values.map_err(|error| fault(error.to_string()))
    };
    let mut sheet = Sheet::default();
    for (piece, stated) in file.pieces.iter().zip(&file.points) {
        let section = |name: &'static str| piece.iter().filter(move |array| array.section == name);
        let mut part = Sheet::default();
        for array in section("Points") {
            if array.components != 3 {
                return Err(fault("its points have not three components"));
            }
            add(&mut part, "points", 3, &values(array)?);
        }
        let Some((_, first)) = part.columns.first() else {
            return Err(fault("a <Piece> has no <Points>"));
        };
        let count = first.len();
        if let Some(stated) = stated.filter(|stated| *stated != count) {
            return Err(fault(format!(
                "a <Piece> states {stated} points, but holds {count}: it was cut short or changed"
            )));
        }
        for array in section("PointData") {
            let values = values(array)?;
            if values.len() != count * array.components {
                let (name, found) = (&array.name, values.len());
                return Err(fault(format!(
                    "the array `{name}` has {found} values for {count} points"
                )));
            }
            add(&mut part, &array.name, array.components, &values);
        }
        join(&mut sheet, part)?;
    }
    if sheet.columns.is_empty() {
        return Err(fault("it has no points"));
    }
    Ok(sheet)
}

/// Appends the particles of a piece; all pieces have the same arrays.
fn join(sheet: &mut Sheet, part: Sheet) -> Result<(), Fault> {
    if sheet.columns.is_empty() {
        *sheet = part;
        return Ok(());
    }
    let names = |sheet: &Sheet| -> Vec<String> {
        let columns = sheet.columns.iter();
        columns.map(|(name, _)| name.clone()).collect()
    };
    if names(sheet) != names(&part) {
        return Err(fault("its pieces have different arrays"));
    }
    for ((_, all), (_, more)) in sheet.columns.iter_mut().zip(part.columns) {
        all.extend(more);
    }
    Ok(())
}
