//! Reading a polyMesh folder.

use crate::regular_file;
use std::path::Path;

use calcine_physics::Vec3;

use super::error::PolyMeshError;
use super::tokens::{Header, Scanner};
use crate::mesh::{Mesh, Patch, Topology};

/// Reads the mesh in a polyMesh folder, ASCII or binary (as each file's header says).
pub fn read(dir: &Path) -> Result<Mesh, PolyMeshError> {
    let points = in_file(dir, "points", points)?;
    let (face_offsets, face_points) = in_file(dir, "faces", faces)?;
    let limit = face_offsets.len();
    let owner = in_file(dir, "owner", |scan, header| labels(scan, header, limit))?;
    let neighbour = in_file(dir, "neighbour", |scan, header| labels(scan, header, limit))?;
    let patches = in_file(dir, "boundary", |scan, _| boundary(scan))?;
    let patches = patches.into_iter().map(|(patch, _)| patch).collect();
    let topology = Topology {
        points,
        face_offsets,
        face_points,
        owner,
        neighbour,
        patches,
    };
    Mesh::new(topology).map_err(|cause| PolyMeshError::Mesh {
        folder: dir.to_path_buf(),
        cause,
    })
}

/// What a polyMesh itself says of a patch.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PatchType {
    /// Its name.
    pub name: String,
    /// Its `type`; empty where none is stated.
    pub kind: String,
    /// Its `neighbourPatch`, of coupled patches.
    pub neighbour: Option<String>,
}

/// Types of the patches of a polyMesh folder, in the order of its file `boundary`.
pub fn patch_types(dir: &Path) -> Result<Vec<PatchType>, PolyMeshError> {
    let patches = in_file(dir, "boundary", |scan, _| boundary(scan))?;
    Ok(patches.into_iter().map(|(_, kind)| kind).collect())
}

/// Opens a file, reads its header and body, and sees that nothing follows.
fn in_file<T>(
    dir: &Path,
    name: &str,
    body: impl FnOnce(&mut Scanner<'_>, &Header) -> Result<T, PolyMeshError>,
) -> Result<T, PolyMeshError> {
    let file = dir.join(name);
    let packed = dir.join(format!("{name}.gz"));
    if !file.exists() && packed.exists() {
        return Err(PolyMeshError::Compressed { file: packed });
    }
    let bytes = regular_file::read(&file).map_err(|cause| PolyMeshError::Io {
        file: file.clone(),
        cause,
    })?;
    let mut scan = Scanner::new(&file, &bytes);
    let header = scan.header()?;
    let value = body(&mut scan, &header)?;
    match scan.peek()? {
        None => Ok(value),
        Some(_) => Err(scan.error("text after the end of the list")),
    }
}

/// A list `N(…)`, `N{value}` or `(…)` in ASCII. `limit` bounds N where one value stands for all.
fn list<T: Clone>(
    scan: &mut Scanner<'_>,
    limit: usize,
    mut item: impl FnMut(&mut Scanner<'_>) -> Result<T, PolyMeshError>,
) -> Result<Vec<T>, PolyMeshError> {
    let count = match scan.peek()? {
        Some(b'(') => None,
        _ => Some(scan.number::<usize>("the length of a list")?),
    };
    if let Some(count) = count
        && scan.take(b'{')?
    {
        if count > limit {
            return Err(scan.error(format!("a list of {count} equal entries; at most {limit}")));
        }
        let value = item(scan)?;
        scan.expect(b'}')?;
        return Ok(vec![value; count]);
    }
    if count == Some(0) && scan.peek()? != Some(b'(') {
        return Ok(Vec::new());
    }
    scan.expect(b'(')?;
    let mut items = Vec::with_capacity(count.unwrap_or(0).min(scan.left()));
    while !scan.take(b')')? {
        items.push(item(scan)?);
    }
    match count {
        Some(count) if count != items.len() => Err(scan.error(format!(
            "a list of {} entries that announces {count}",
            items.len()
        ))),
        _ => Ok(items),
    }
}

/// The raw bytes of a binary list `N(…)` of entries of `size` bytes.
fn raw_list<'a>(scan: &mut Scanner<'a>, size: usize) -> Result<&'a [u8], PolyMeshError> {
    let count = scan.number::<usize>("the length of a list")?;
    if count == 0 && scan.peek()? != Some(b'(') {
        return Ok(&[]);
    }
    scan.expect(b'(')?;
    scan.raw(count.checked_mul(size))
}

fn points(scan: &mut Scanner<'_>, header: &Header) -> Result<Vec<Vec3>, PolyMeshError> {
    if header.binary {
        let bytes = raw_list(scan, 3 * header.scalar)?;
        let scalars: Vec<f64> = bytes
            .chunks_exact(header.scalar)
            .map(|chunk| match *chunk {
                [a, b, c, d] => f64::from(f32::from_le_bytes([a, b, c, d])),
                [a, b, c, d, e, f, g, h] => f64::from_le_bytes([a, b, c, d, e, f, g, h]),
                _ => f64::NAN,
            })
            .collect();
        return Ok(scalars
            .chunks_exact(3)
            .map(|xyz| Vec3::new(xyz[0], xyz[1], xyz[2]))
            .collect());
    }
    list(scan, 0, |scan| {
        scan.expect(b'(')?;
        let mut point = Vec3::zeros();
        for coordinate in point.iter_mut() {
            *coordinate = scan.number("a coordinate")?;
        }
        scan.expect(b')')?;
        Ok(point)
    })
}

fn labels(
    scan: &mut Scanner<'_>,
    header: &Header,
    limit: usize,
) -> Result<Vec<u32>, PolyMeshError> {
    if !header.binary {
        return list(scan, limit, |scan| scan.number("a label, 0 or more"));
    }
    let bytes = raw_list(scan, header.label)?;
    let label = |chunk: &[u8]| match *chunk {
        [a, b, c, d] => u32::try_from(i32::from_le_bytes([a, b, c, d])).ok(),
        [a, b, c, d, e, f, g, h] => {
            u32::try_from(i64::from_le_bytes([a, b, c, d, e, f, g, h])).ok()
        }
        _ => None,
    };
    let labels: Option<Vec<u32>> = bytes.chunks_exact(header.label).map(label).collect();
    labels.ok_or_else(|| scan.error("a label is negative or above 4294967295"))
}

/// Offsets and points of all faces, from a `faceList` or a `faceCompactList`.
fn faces(scan: &mut Scanner<'_>, header: &Header) -> Result<(Vec<u32>, Vec<u32>), PolyMeshError> {
    if header.class == "faceCompactList" {
        let offsets = labels(scan, header, 0)?;
        let points = labels(scan, header, 0)?;
        return Ok((offsets, points));
    }
    if header.binary {
        return Err(scan.error("a binary file of faces that is not a `faceCompactList`"));
    }
    let mut offsets = vec![0u32];
    let mut points = Vec::new();
    list(scan, 0, |scan| {
        points.extend(list(scan, 0, |scan| {
            scan.number::<u32>("a point's label, 0 or more")
        })?);
        let end = u32::try_from(points.len())
            .map_err(|_| scan.error("the faces have more than 4294967295 points in all"))?;
        offsets.push(end);
        Ok(())
    })?;
    Ok((offsets, points))
}

fn boundary(scan: &mut Scanner<'_>) -> Result<Vec<(Patch, PatchType)>, PolyMeshError> {
    list(scan, 0, |scan| {
        let name = scan.word("a patch's name")?;
        scan.expect(b'{')?;
        let (mut start, mut count) = (None, None);
        let (mut kind, mut neighbour) = (String::new(), None);
        while !scan.take(b'}')? {
            let key = scan.word("a key of the patch")?;
            let wanted = match key.as_str() {
                "startFace" => &mut start,
                "nFaces" => &mut count,
                "type" => {
                    kind = scan.entry()?.unwrap_or_default();
                    continue;
                }
                "neighbourPatch" => {
                    neighbour = scan.entry()?;
                    continue;
                }
                _ => {
                    scan.entry()?;
                    continue;
                }
            };
            *wanted = Some(scan.number::<usize>(&format!("a number for `{key}`"))?);
            scan.expect(b';')?;
        }
        match (start, count) {
            (Some(start), Some(count)) => {
                let own = name.clone();
                let kind = PatchType {
                    name,
                    kind,
                    neighbour,
                };
                let name = own;
                Ok((Patch { name, start, count }, kind))
            }
            _ => Err(scan.error(format!(
                "patch `{name}` lacks `{}`",
                if start.is_none() {
                    "startFace"
                } else {
                    "nFaces"
                }
            ))),
        }
    })
}
