//! STL files, ASCII and binary: triangles of walls.

use calcine_coupler::regular_file;
use std::path::Path;

use calcine_coupler::physics::Vec3;
use thiserror::Error;

/// Bytes before the triangles of a binary file: a comment and their number.
const HEAD: usize = 84;
/// Bytes of a triangle: a normal, three corners, an unused number.
const TRIANGLE: usize = 50;

/// The largest height of a triangle, over its longest edge, that is no area: corners of a file are single precision.
const FLAT: f64 = 1e-7;

/// What a file holds.
#[derive(Clone, Debug, PartialEq)]
pub struct Stl {
    /// Corners of the triangles in m.
    pub triangles: Vec<[Vec3; 3]>,
    /// Numbers, from 1, of triangles of the file that have no area, which are left out.
    pub flat: Vec<usize>,
}

/// A file that is no STL file.
#[derive(Debug, Error)]
pub enum StlError {
    /// It cannot be read.
    #[error("cannot be read: {0}")]
    Io(#[from] std::io::Error),
    /// It holds no triangle.
    #[error("holds no triangle")]
    Empty,
    /// No triangle has an area.
    #[error("holds {0} triangles, none of which has an area")]
    Flat(usize),
    /// A binary file of another length than its number of triangles takes.
    #[error("states {stated} triangles, and has {there}: it was cut short, or is damaged")]
    CutShort {
        /// Triangles that it states.
        stated: usize,
        /// Whole ones that it holds.
        there: usize,
    },
    /// A body that does not end.
    #[error("has no `endsolid` to the `solid` of line {line}: it was cut short")]
    Unended {
        /// The line that opens it, from 1.
        line: usize,
    },
    /// A line that is not as it should be.
    #[error("has in line {line} no three finite coordinates")]
    Line {
        /// The line, from 1.
        line: usize,
    },
    /// Corners that do not make triangles.
    #[error("has {corners} corners, not three a triangle")]
    Corners {
        /// Their number.
        corners: usize,
    },
    /// A coordinate that is not a finite number.
    #[error("has in triangle {triangle} a coordinate that is not a finite number")]
    NotFinite {
        /// The triangle, from 1.
        triangle: usize,
    },
}

/// The triangles of a file, its lengths times `scale`.
pub fn read(path: &Path, scale: f64) -> Result<Stl, StlError> {
    let bytes = regular_file::read(path)?;
    let all = match binary(&bytes)? {
        Some(triangles) => triangles,
        None => ascii(&String::from_utf8_lossy(&bytes))?,
    };
    if all.is_empty() {
        return Err(StlError::Empty);
    }
    let count = all.len();
    let (mut triangles, mut flat) = (Vec::with_capacity(count), Vec::new());
    for (number, corners) in (1..).zip(all) {
        match is_flat(&corners) {
            true => flat.push(number),
            false => triangles.push(corners.map(|corner| scale * corner)),
        }
    }
    if triangles.is_empty() {
        return Err(StlError::Flat(count));
    }
    Ok(Stl { triangles, flat })
}

/// True of a triangle without area: two corners are one, or all on a line.
fn is_flat([a, b, c]: &[Vec3; 3]) -> bool {
    let (ab, ac, bc) = (b - a, c - a, c - b);
    let longest = ab.norm().max(ac.norm()).max(bc.norm());
    ab.cross(&ac).norm() <= FLAT * longest * longest
}

/// The triangles of a binary file: one whose length fits the number of triangles that it states.
fn binary(bytes: &[u8]) -> Result<Option<Vec<[Vec3; 3]>>, StlError> {
    let Some(count) = bytes
        .get(80..HEAD)
        .and_then(|b| <[u8; 4]>::try_from(b).ok())
    else {
        return Ok(None);
    };
    let count = u32::from_le_bytes(count) as usize;
    let whole = HEAD + TRIANGLE * count;
    // Some programs append what is theirs.
    let longer = bytes.len() > whole && count > 0 && !bytes.starts_with(b"solid");
    if bytes.len() != whole && !(longer && bytes.contains(&0)) {
        // Text has no zero bytes; the head of a binary file is filled with them.
        return match bytes.contains(&0) {
            true => Err(StlError::CutShort {
                stated: count,
                there: (bytes.len() - HEAD) / TRIANGLE,
            }),
            false => Ok(None),
        };
    }
    let number = |bytes: &[u8]| {
        let four = <[u8; 4]>::try_from(bytes).unwrap_or_default();
        f64::from(f32::from_le_bytes(four))
    };
    let mut triangles = Vec::with_capacity(count);
    for (index, record) in bytes[HEAD..whole].chunks_exact(TRIANGLE).enumerate() {
        let values: Vec<f64> = record[12..48].chunks_exact(4).map(number).collect();
        if values.iter().any(|value| !value.is_finite()) {
            return Err(StlError::NotFinite {
                triangle: index + 1,
            });
        }
        let corner = |k: usize| Vec3::new(values[3 * k], values[3 * k + 1], values[3 * k + 2]);
        triangles.push([corner(0), corner(1), corner(2)]);
    }
    Ok(Some(triangles))
}

fn ascii(text: &str) -> Result<Vec<[Vec3; 3]>, StlError> {
    let mut corners = Vec::new();
    // Bodies that are open, by the line that opens them.
    let mut open = Vec::new();
    for (index, line) in text.lines().enumerate() {
        let line = line.trim_start();
        let begins = |word: &str| {
            let head = line.get(..word.len());
            head.filter(|head| head.eq_ignore_ascii_case(word))
                .map(|head| &line[head.len()..])
        };
        if begins("solid").is_some() {
            open.push(index + 1);
        } else if begins("endsolid").is_some() {
            open.pop();
        }
        let Some(rest) = begins("vertex") else {
            continue;
        };
        let numbers: Vec<f64> = rest
            .split_ascii_whitespace()
            .filter_map(|word| word.parse().ok())
            .filter(|value: &f64| value.is_finite())
            .collect();
        let [x, y, z] = numbers[..] else {
            return Err(StlError::Line { line: index + 1 });
        };
        corners.push(Vec3::new(x, y, z));
    }
    if corners.len() % 3 != 0 {
        let corners = corners.len();
        return Err(StlError::Corners { corners });
    }
    if let (Some(&line), false) = (open.last(), corners.is_empty()) {
        return Err(StlError::Unended { line });
    }
    Ok(corners
        .chunks_exact(3)
        .map(|c| [c[0], c[1], c[2]])
        .collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn both_kinds_of_file_give_the_same_triangles() {
        let folder = tempfile::tempdir().unwrap();
        let text = "solid x\n facet normal 0 0 1\n  outer loop\n   vertex 0 0 0\n   vertex 1 0 0\n   \
                    vertex 0 2.5 0\n  endloop\n endfacet\nendsolid x\n";
        let mut raw = vec![0u8; 80];
        raw.extend(1u32.to_le_bytes());
        for value in [
            0.0f32, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 2.5, 0.0,
        ] {
            raw.extend(value.to_le_bytes());
        }
        raw.extend([0, 0]);
        let (a, b) = (folder.path().join("a.stl"), folder.path().join("b.stl"));
        std::fs::write(&a, text).unwrap();
        std::fs::write(&b, raw).unwrap();
        let found = read(&a, 1e-3).unwrap();
        assert_eq!(found, read(&b, 1e-3).unwrap());
        assert_eq!(found.triangles[0][2], Vec3::new(0.0, 2.5e-3, 0.0));
        std::fs::write(&a, text.replace("2.5", "nan")).unwrap();
        assert_eq!(
            read(&a, 1.0).unwrap_err().to_string(),
            "has in line 6 no three finite coordinates"
        );
        std::fs::write(&a, "solid\nendsolid\n").unwrap();
        assert!(read(&a, 1.0).is_err());
    }

    /// A binary file of these triangles.
    fn binary_of(triangles: &[[f32; 9]]) -> Vec<u8> {
        let mut raw = vec![0u8; 80];
        raw.extend((triangles.len() as u32).to_le_bytes());
        for corners in triangles {
            let normal = [0.0; 3];
            for value in normal.iter().chain(corners) {
                raw.extend(value.to_le_bytes());
            }
            raw.extend([0, 0]);
        }
        raw
    }

    #[test]
    fn triangles_without_area_are_left_out_and_counted() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.stl");
        let good = [0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0];
        let point = [0.5; 9];
        let line = [0.0, 0.0, 0.0, 0.1, 0.2, 0.3, 0.2, 0.4, 0.6];
        let sliver = [0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.5, 1e-3, 0.0];
        let all = [good, point, sliver, line];
        std::fs::write(&path, binary_of(&all)).unwrap();
        let found = read(&path, 1.0).unwrap();
        assert_eq!((found.triangles.len(), found.flat), (2, vec![2, 4]));
        std::fs::write(&path, binary_of(&[point, line])).unwrap();
        assert_eq!(
            read(&path, 1.0).unwrap_err().to_string(),
            "holds 2 triangles, none of which has an area"
        );
    }

    #[test]
    fn a_binary_file_that_was_cut_short_says_so() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.stl");
        let good = [0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0];
        let mut bytes = binary_of(&[good; 5]);
        bytes.truncate(HEAD + 3 * TRIANGLE + 7);
        std::fs::write(&path, bytes).unwrap();
        assert_eq!(
            read(&path, 1.0).unwrap_err().to_string(),
            "states 5 triangles, and has 3: it was cut short, or is damaged"
        );
    }

    #[test]
    fn what_a_program_appends_to_a_binary_file_is_passed_over_and_words_may_be_in_capitals() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.stl");
        let good = [0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0];
        let mut bytes = binary_of(&[good; 2]);
        bytes.extend(b"made by a scanner");
        std::fs::write(&path, bytes).unwrap();
        assert_eq!(read(&path, 1.0).unwrap().triangles.len(), 2);
        let text = "SOLID X\nFACET NORMAL 0 0 1\nOUTER LOOP\nVERTEX 0 0 0\nVERTEX 1 0 0\nVERTEX 0 1 0\nENDLOOP\nENDFACET\n";
        std::fs::write(&path, format!("{text}ENDSOLID X\n")).unwrap();
        assert_eq!(read(&path, 1.0).unwrap().triangles.len(), 1);
        std::fs::write(&path, text).unwrap();
        let told = read(&path, 1.0).unwrap_err().to_string();
        assert!(
            told.contains("no `endsolid` to the `solid` of line 1"),
            "{told}"
        );
    }
}
