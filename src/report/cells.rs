//! The cells of a snapshot of the gas: their faces, volumes and centres, and the faces at the boundary.

use std::collections::HashMap;

use calcine_coupler::physics::Vec3;

use crate::results::read::Arrays;

/// A point in m.
pub(super) type Point = Vec3;

/// Faces of a hexahedron by its corners in VTK's order.
const FACES: [[usize; 4]; 6] = [
    [0, 3, 2, 1],
    [4, 5, 6, 7],
    [0, 1, 5, 4],
    [1, 2, 6, 5],
    [2, 3, 7, 6],
    [3, 0, 4, 7],
];

/// A cell.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct GasCell {
    /// Mean of its corners in m.
    pub centre: Point,
    /// Volume in m³.
    pub volume: f64,
}

/// Calls `with` for each cell with its faces, each by its points.
pub(super) fn each_cell(gas: &Arrays, mut with: impl FnMut(&[Vec<usize>])) {
    let list = |name: &str| gas.get(name).map_or(&[][..], |array| &array.values);
    let (corners, ends) = (list("connectivity"), list("offsets"));
    let (streams, stream_ends) = (list("faces"), list("faceoffsets"));
    let (mut start, mut stream_start) = (0, 0);
    for (cell, &end) in ends.iter().enumerate() {
        let end = (end as usize).min(corners.len());
        let nodes = &corners[start.min(end)..end];
        start = end;
        let stream_end = stream_ends.get(cell).copied().unwrap_or(-1.0);
        let faces: Vec<Vec<usize>> = if stream_end >= 0.0 {
            let stream_end = (stream_end as usize).min(streams.len());
            let stream = &streams[stream_start.min(stream_end)..stream_end];
            stream_start = stream_end;
            faces_of_stream(stream)
        } else if nodes.len() == 8 {
            let face = |face: &[usize; 4]| face.iter().map(|&at| nodes[at] as usize).collect();
            FACES.iter().map(face).collect()
        } else {
            Vec::new()
        };
        with(&faces);
    }
}

/// Faces of a polyhedron from VTK's stream: number of faces, then each face's size and points.
fn faces_of_stream(stream: &[f64]) -> Vec<Vec<usize>> {
    let mut faces = Vec::new();
    let mut rest = stream.get(1..).unwrap_or_default();
    while let Some((&size, after)) = rest.split_first() {
        let (face, after) = after.split_at((size as usize).min(after.len()));
        faces.push(face.iter().map(|&point| point as usize).collect());
        rest = after;
    }
    faces
}

fn point(points: &[f64], number: usize) -> Point {
    let at = |axis: usize| points.get(3 * number + axis).copied().unwrap_or(0.0);
    Point::new(at(0), at(1), at(2))
}

fn points(gas: &Arrays) -> &[f64] {
    gas.get("points").map_or(&[], |array| &array.values)
}

/// The points of a snapshot: of particles their centres.
pub(super) fn all_points(arrays: &Arrays) -> Vec<Point> {
    let points = points(arrays).as_chunks::<3>().0;
    points.iter().map(|point| Point::from(*point)).collect()
}

/// All cells; the volume is that of the pyramids from the centre onto the faces.
pub(super) fn cells(gas: &Arrays) -> Vec<GasCell> {
    let points = points(gas);
    let mut cells = Vec::new();
    each_cell(gas, |faces| {
        let mut corners: Vec<usize> = faces.iter().flatten().copied().collect();
        corners.sort_unstable();
        corners.dedup();
        let sum: Point = corners.iter().map(|&corner| point(points, corner)).sum();
        let centre = sum / corners.len() as f64;
        let mut volume = 0.0;
        for face in faces {
            let from = |at: usize| point(points, face[at]) - centre;
            for at in 2..face.len() {
                volume += from(0).dot(&from(at - 1).cross(&from(at))).abs() / 6.0;
            }
        }
        cells.push(GasCell { centre, volume });
    });
    cells
}

/// The faces that belong to one cell only, each by its corners in m.
pub(super) fn boundary(gas: &Arrays) -> Vec<Vec<Point>> {
    let points = points(gas);
    let mut open: HashMap<Vec<usize>, Vec<usize>> = HashMap::new();
    each_cell(gas, |faces| {
        for face in faces {
            let mut key = face.clone();
            key.sort_unstable();
            if open.remove(&key).is_none() {
                open.insert(key, face.clone());
            }
        }
    });
    let mut faces: Vec<Vec<usize>> = open.into_values().collect();
    // The same page from the same snapshot.
    faces.sort_unstable();
    let corners = |face: Vec<usize>| face.into_iter().map(|at| point(points, at)).collect();
    faces.into_iter().map(corners).collect()
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;
    use crate::results::read::Array;

    /// Two unit cubes beside each other along x, the second a polyhedron where asked for.
    pub fn two_cubes(polyhedron: bool) -> Arrays {
        let mut spots = Vec::new();
        for x in 0..3 {
            for (y, z) in [(0, 0), (1, 0), (1, 1), (0, 1)] {
                spots.extend([f64::from(x), f64::from(y), f64::from(z)]);
            }
        }
        let cube = |x: usize| (4 * x..4 * x + 8).collect::<Vec<usize>>();
        let list = |values: Vec<usize>| Array {
            components: 1,
            values: values.into_iter().map(|value| value as f64).collect(),
        };
        let mut gas = Arrays::from([
            (
                "points".to_owned(),
                Array {
                    components: 3,
                    values: spots,
                },
            ),
            ("connectivity".to_owned(), list([cube(0), cube(1)].concat())),
            ("offsets".to_owned(), list(vec![8, 16])),
        ]);
        if polyhedron {
            let mut stream = vec![6];
            for face in FACES {
                stream.push(4);
                stream.extend(face.map(|at| cube(1)[at]));
            }
            let end = stream.len() as f64;
            gas.insert("faces".into(), list(stream));
            gas.insert(
                "faceoffsets".into(),
                Array {
                    components: 1,
                    values: vec![-1.0, end],
                },
            );
        }
        gas
    }

    #[test]
    fn two_cubes_have_ten_faces_at_the_boundary_and_a_unit_volume_each() {
        for polyhedron in [false, true] {
            let gas = two_cubes(polyhedron);
            assert_eq!(boundary(&gas).len(), 10);
            let cells = cells(&gas);
            assert_eq!(cells.len(), 2);
            for (cell, x) in cells.iter().zip([0.5, 1.5]) {
                assert!((cell.volume - 1.0).abs() < 1e-14);
                assert!((cell.centre[0] - x).abs() < 1e-14);
            }
        }
    }
}
