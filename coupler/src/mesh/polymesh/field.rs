//! Reading the cell values of a field that OpenFOAM wrote, ASCII or binary.

use crate::regular_file;
use std::path::Path;

use super::error::PolyMeshError;
use super::tokens::{Header, Scanner};

/// The `internalField` of a file of a time directory: `components` numbers for each of so many cells, one
/// cell after the other.
pub fn internal_field(
    file: &Path,
    components: usize,
    cells: usize,
) -> Result<Vec<f64>, PolyMeshError> {
    let bytes = regular_file::read(file).map_err(|cause| PolyMeshError::Io {
        file: file.to_path_buf(),
        cause,
    })?;
    let mut scan = Scanner::new(file, &bytes);
    let header = scan.header()?;
    loop {
        if scan.peek()?.is_none() {
            return Err(scan.error("the file has no `internalField`"));
        }
        if scan.word("a key")? == "internalField" {
            return values(&mut scan, &header, components, cells);
        }
        scan.entry()?;
    }
}

fn values(
    scan: &mut Scanner<'_>,
    header: &Header,
    components: usize,
    cells: usize,
) -> Result<Vec<f64>, PolyMeshError> {
    scan.peek()?;
    match scan.word("`uniform` or `nonuniform`")?.as_str() {
        "uniform" => {
            let one = ascii(scan, components)?;
            Ok(one.repeat(cells))
        }
        "nonuniform" => {
            scan.peek()?;
            let kind = scan.word("the kind of list")?;
            let wanted = if components == 1 { "scalar" } else { "vector" };
            if kind != format!("List<{wanted}>") {
                return Err(scan.error(format!("a `{kind}` where a `List<{wanted}>` is needed")));
            }
            list(scan, header, components, cells)
        }
        other => Err(scan.error(format!("`internalField` is `{other}`"))),
    }
}

fn list(
    scan: &mut Scanner<'_>,
    header: &Header,
    components: usize,
    cells: usize,
) -> Result<Vec<f64>, PolyMeshError> {
    let count = scan.number::<usize>("the length of a list")?;
    if count != cells {
        return Err(scan.error(format!(
            "{count} values for a mesh of {cells} cells: the directory belongs to another mesh, or \
             is one rank's of a decomposed case (reconstructPar joins them)"
        )));
    }
    if scan.take(b'{')? {
        let one = ascii(scan, components)?;
        scan.expect(b'}')?;
        return Ok(one.repeat(cells));
    }
    scan.expect(b'(')?;
    if header.binary {
        let bytes = scan.raw(cells.checked_mul(components * header.scalar))?;
        return Ok(if header.scalar == 8 {
            let words = bytes.as_chunks::<8>().0.iter();
            words.map(|word| f64::from_le_bytes(*word)).collect()
        } else {
            let words = bytes.as_chunks::<4>().0.iter();
            words.map(|word| f32::from_le_bytes(*word).into()).collect()
        });
    }
    let mut values = Vec::with_capacity((cells * components).min(scan.left()));
    for _ in 0..cells {
        values.extend(ascii(scan, components)?);
    }
    scan.expect(b')')?;
    Ok(values)
}

/// A number, or a vector in parentheses.
fn ascii(scan: &mut Scanner<'_>, components: usize) -> Result<Vec<f64>, PolyMeshError> {
    if components == 1 {
        return Ok(vec![scan.number("a number")?]);
    }
    scan.expect(b'(')?;
    let vector = (0..components)
        .map(|_| scan.number("a component"))
        .collect::<Result<_, _>>()?;
    scan.expect(b')')?;
    Ok(vector)
}

#[cfg(test)]
mod tests {
    use std::fs;

    use super::*;

    const DIMENSIONS: &str = "dimensions [0 1 -1 0 0 0 0];\n";

    fn read(body: &[u8], format: &str, components: usize) -> Result<Vec<f64>, String> {
        let directory = tempfile::tempdir().unwrap();
        let file = directory.path().join("U");
        let header = format!("FoamFile {{ format {format}; class volField; }}\n{DIMENSIONS}");
        fs::write(&file, [header.as_bytes(), body].concat()).unwrap();
        internal_field(&file, components, 2).map_err(|error| error.to_string())
    }

    #[test]
    fn uniform_ascii_and_binary_fields_are_read_as_they_are() {
        let one = read(b"internalField uniform (1 2 3);", "ascii", 3);
        assert_eq!(one.unwrap(), [1.0, 2.0, 3.0, 1.0, 2.0, 3.0]);
        let two = read(
            b"internalField nonuniform List<scalar> 2(300 1e2);",
            "ascii",
            1,
        );
        assert_eq!(two.unwrap(), [300.0, 100.0]);
        let mut body = b"internalField nonuniform List<scalar> \n2\n(".to_vec();
        for value in [0.1f64, -7.0] {
            body.extend(value.to_le_bytes());
        }
        body.extend(b");\n");
        assert_eq!(read(&body, "binary", 1).unwrap(), [0.1, -7.0]);
    }

    #[test]
    fn what_does_not_fit_the_mesh_is_refused_with_both_numbers() {
        let text = read(
            b"internalField nonuniform List<scalar> 3(1 2 3);",
            "ascii",
            1,
        );
        assert!(text.unwrap_err().contains("3 values for a mesh of 2 cells"));
        let text = read(
            b"internalField nonuniform List<vector> 2((1 2 3)(1 2 3));",
            "ascii",
            1,
        );
        assert!(text.unwrap_err().contains("a `List<vector>`"));
        assert!(
            read(b"", "ascii", 1)
                .unwrap_err()
                .contains("no `internalField`")
        );
    }
}
