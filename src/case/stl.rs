//! STL files, ASCII and binary: triangles of walls.

use std::path::Path;

use calcine_coupler::physics::Vec3;
use thiserror::Error;

/// Bytes before the triangles of a binary file: a comment and their number.
const HEAD: usize = 84;
/// Bytes of a triangle: a normal, three corners, an unused number.
const TRIANGLE: usize = 50;

/// A file that is no STL file.
#[derive(Debug, Error)]
pub enum StlError {
    /// It cannot be read.
    #[error("cannot be read: {0}")]
    Io(#[from] std::io::Error),
    /// It holds no triangle.
    #[error("holds no triangle")]
    Empty,
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

/// Corners of the triangles in m; lengths of the file times `scale`.
pub fn read(path: &Path, scale: f64) -> Result<Vec<[Vec3; 3]>, StlError> {
    let bytes = std::fs::read(path)?;
    let mut triangles = match binary(&bytes)? {
        Some(triangles) => triangles,
        None => ascii(&String::from_utf8_lossy(&bytes))?,
    };
    if triangles.is_empty() {
        return Err(StlError::Empty);
    }
    for corner in triangles.iter_mut().flatten() {
        *corner *= scale;
    }
    Ok(triangles)
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
    if bytes.len() != HEAD + TRIANGLE * count {
        return Ok(None);
    }
    let number = |bytes: &[u8]| {
        let four = <[u8; 4]>::try_from(bytes).unwrap_or_default();
        f64::from(f32::from_le_bytes(four))
    };
    let mut triangles = Vec::with_capacity(count);
    for (index, record) in bytes[HEAD..].chunks_exact(TRIANGLE).enumerate() {
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
    for (index, line) in text.lines().enumerate() {
        let Some(rest) = line.trim_start().strip_prefix("vertex") else {
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
        assert_eq!(found[0][2], Vec3::new(0.0, 2.5e-3, 0.0));
        std::fs::write(&a, text.replace("2.5", "nan")).unwrap();
        assert_eq!(
            read(&a, 1.0).unwrap_err().to_string(),
            "has in line 6 no three finite coordinates"
        );
        std::fs::write(&a, "solid\nendsolid\n").unwrap();
        assert!(read(&a, 1.0).is_err());
    }
}
