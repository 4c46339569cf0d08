//! Polygons as few indexed triangles with the edges at which they turn, on a grid of 16 bits.

use std::collections::{HashMap, HashSet};

use super::walls::Extent;
use crate::report::cells::Point;

/// Triangles at most.
const TRIANGLES: usize = 9000;
/// Edges at most; a surface with more is drawn without.
const EDGES: usize = 6000;
/// Cosine of the angle between two sides from which their edge is drawn.
const TURN: f64 = 0.9;
/// Steps of the grid along each axis, finest first; the last that is needed is taken.
const STEPS: [f64; 10] = [
    65_535.0, 192.0, 128.0, 96.0, 64.0, 48.0, 32.0, 24.0, 16.0, 8.0,
];

/// A point on the grid.
pub(super) type GridPoint = [u16; 3];

/// A surface.
#[derive(Debug, Default, PartialEq)]
pub(super) struct Surface {
    /// Its points.
    pub points: Vec<GridPoint>,
    /// Corners of triangles, three each.
    pub triangles: Vec<u16>,
    /// Ends of edges, two each.
    pub edges: Vec<u16>,
}

/// The place of a point in a box, in shares of 65535.
pub(super) fn on_grid([low, high]: Extent, point: Point) -> GridPoint {
    std::array::from_fn(|axis| {
        let span = high[axis] - low[axis];
        let share = if span > 0.0 {
            (point[axis] - low[axis]) / span
        } else {
            0.0
        };
        (share.clamp(0.0, 1.0) * 65_535.0).round() as u16
    })
}

/// The surface of polygons in a box that holds them all.
pub(super) fn surface(polygons: &[Vec<Point>], extent: Extent) -> Surface {
    let mut numbers: HashMap<GridPoint, usize> = HashMap::new();
    let mut points = Vec::new();
    let number = |point: &Point| {
        let at = on_grid(extent, *point);
        *numbers.entry(at).or_insert_with(|| {
            points.push(at);
            points.len() - 1
        })
    };
    let mut number = number;
    let faces: Vec<Vec<usize>> = polygons
        .iter()
        .map(|polygon| polygon.iter().map(&mut number).collect())
        .collect();
    let turns = turns(polygons, &faces);
    for steps in STEPS {
        let (kept, of) = clustered(&points, steps);
        let triangles = triangles(&faces, &of);
        if triangles.len() <= TRIANGLES && kept.len() <= usize::from(u16::MAX) {
            let edges = edges(&turns, &of);
            let short = |all: Vec<usize>| all.into_iter().map(|at| at as u16).collect();
            return Surface {
                points: kept,
                triangles: short(triangles.into_iter().flatten().collect()),
                edges: short(edges.into_iter().flatten().collect()),
            };
        }
    }
    Surface::default()
}

/// Edges at which polygons turn or end, by the numbers of their ends.
fn turns(polygons: &[Vec<Point>], faces: &[Vec<usize>]) -> Vec<[usize; 2]> {
    let mut beside: HashMap<[usize; 2], Vec<Point>> = HashMap::new();
    for (polygon, face) in polygons.iter().zip(faces) {
        let normal = normal(polygon);
        for place in 0..face.len() {
            let mut edge = [face[place], face[(place + 1) % face.len()]];
            edge.sort_unstable();
            if edge[0] != edge[1] {
                beside.entry(edge).or_default().push(normal);
            }
        }
    }
    let turns = |normals: &[Point]| match normals {
        [a, b] => a.dot(b).abs() < TURN,
        _ => true,
    };
    let mut edges: Vec<[usize; 2]> = beside
        .into_iter()
        .filter(|(_, normals)| turns(normals))
        .map(|(edge, _)| edge)
        .collect();
    edges.sort_unstable();
    edges
}

/// Unit normal of a polygon; zero where it has no area.
fn normal(polygon: &[Point]) -> Point {
    let part = |at: usize| (polygon[at - 1] - polygon[0]).cross(&(polygon[at] - polygon[0]));
    let sum: Point = (2..polygon.len()).map(part).sum();
    sum.try_normalize(0.0).unwrap_or_default()
}

/// One point for each cell of a coarser grid, that farthest from the middle, so that corners stay; and which one each
/// point goes to.
fn clustered(points: &[GridPoint], steps: f64) -> (Vec<GridPoint>, Vec<usize>) {
    let cell = |point: &GridPoint| point.map(|x| (f64::from(x) / 65_535.0 * steps).round() as u16);
    let away = |point: &GridPoint| {
        let squares = point.map(|x| (f64::from(x) - 32_767.5).powi(2));
        squares.iter().sum::<f64>()
    };
    let mut numbers: HashMap<GridPoint, usize> = HashMap::new();
    let mut kept: Vec<GridPoint> = Vec::new();
    let of = points
        .iter()
        .map(|point| {
            let number = *numbers.entry(cell(point)).or_insert_with(|| {
                kept.push(*point);
                kept.len() - 1
            });
            if away(point) > away(&kept[number]) {
                kept[number] = *point;
            }
            number
        })
        .collect();
    (kept, of)
}

/// Triangles of polygons whose corners have gone to others, each once.
fn triangles(faces: &[Vec<usize>], of: &[usize]) -> Vec<[usize; 3]> {
    let (mut seen, mut triangles) = (HashSet::new(), Vec::new());
    for face in faces {
        let mut corners: Vec<usize> = face.iter().map(|&at| of[at]).collect();
        corners.dedup();
        for at in 2..corners.len() {
            let triangle = [corners[0], corners[at - 1], corners[at]];
            let mut sorted = triangle;
            sorted.sort_unstable();
            let flat = sorted[0] == sorted[1] || sorted[1] == sorted[2];
            if !flat && seen.insert(sorted) {
                triangles.push(triangle);
            }
        }
    }
    triangles
}

/// Edges whose ends have gone to others, each once; none where there are too many.
fn edges(turns: &[[usize; 2]], of: &[usize]) -> Vec<[usize; 2]> {
    let mut seen = HashSet::new();
    let mut edges = Vec::new();
    for turn in turns {
        let mut edge = turn.map(|at| of[at]);
        edge.sort_unstable();
        if edge[0] != edge[1] && seen.insert(edge) {
            edges.push(edge);
        }
    }
    if edges.len() > EDGES {
        edges.clear();
    }
    edges
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The sides of a unit cube in so many squares along each edge.
    fn cube(count: usize) -> Vec<Vec<Point>> {
        let step = 1.0 / count as f64;
        let mut polygons = Vec::new();
        for axis in 0..3 {
            for side in [0.0, 1.0] {
                for (i, j) in (0..count * count).map(|k| (k / count, k % count)) {
                    let spot = |i: usize, j: usize| {
                        let mut spot = Point::repeat(side);
                        spot[(axis + 1) % 3] = i as f64 * step;
                        spot[(axis + 2) % 3] = j as f64 * step;
                        spot
                    };
                    polygons.push(vec![
                        spot(i, j),
                        spot(i + 1, j),
                        spot(i + 1, j + 1),
                        spot(i, j + 1),
                    ]);
                }
            }
        }
        polygons
    }

    #[test]
    fn a_cube_has_its_triangles_and_the_edges_at_which_it_turns() {
        let surface = surface(&cube(10), [Point::zeros(), Point::repeat(1.0)]);
        assert_eq!(surface.triangles.len(), 3 * 2 * 6 * 100);
        // Twelve edges in ten pieces.
        assert_eq!(surface.edges.len(), 2 * 12 * 10);
        assert_eq!(surface.points.len(), 6 * 81 + 12 * 9 + 8);
    }

    #[test]
    fn a_fine_cube_is_made_coarser_and_keeps_its_corners() {
        let surface = surface(&cube(120), [Point::zeros(), Point::repeat(1.0)]);
        assert!(surface.triangles.len() <= 3 * TRIANGLES);
        assert!(surface.triangles.len() > 3000);
        for corner in 0..8_u8 {
            let spot =
                std::array::from_fn(|axis| if corner >> axis & 1 == 1 { u16::MAX } else { 0 });
            assert!(surface.points.contains(&spot), "{spot:?}");
        }
        // All points stay on a side.
        assert!(
            surface
                .points
                .iter()
                .all(|spot| spot.iter().any(|&x| x == 0 || x == u16::MAX))
        );
    }
}
