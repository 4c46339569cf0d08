//! The walls of a case as polygons: what the gas mesh ends at, and what particles touch.

use std::f64::consts::TAU;
use std::path::{Path, PathBuf};

use calcine_coupler::motion::WallShape;
use calcine_coupler::physics::Vec3;

use crate::case;
use crate::report::cells::{Point, boundary};
use crate::results::read::Arrays;
use crate::results::{CASE, files};

/// Sides of what is round.
const SIDES: usize = 64;

/// Corners of a box.
pub(super) type Extent = [Point; 2];

/// All polygons: the boundary of the gas mesh, and the walls of the case as they are at its start.
pub(super) fn polygons(directory: &Path, gas: &Arrays) -> Vec<Vec<Point>> {
    let mut polygons = boundary(gas);
    let Some(extent) = extent(polygons.iter().flatten()) else {
        return polygons;
    };
    for shape in shapes(directory) {
        polygons.extend(of_shape(&shape, extent));
    }
    polygons
}

/// The box around points; `None` without any.
pub(super) fn extent<'a>(points: impl Iterator<Item = &'a Point>) -> Option<Extent> {
    points.fold(None, |so_far, point| {
        let [low, high] = so_far.unwrap_or([*point; 2]);
        Some([low.inf(point), high.sup(point)])
    })
}

/// Walls of the case; none where it cannot be read any more, as a file of it has gone.
fn shapes(directory: &Path) -> Vec<WallShape> {
    let Ok(text) = files::read(&directory.join(CASE)) else {
        return Vec::new();
    };
    // Files are where the case was.
    let path = original(directory).unwrap_or_else(|| directory.join(CASE));
    let case = case::parse(&path, &text, &[]);
    let walls = case.map(|case| case.walls).unwrap_or_default();
    walls.into_iter().map(|wall| wall.shape).collect()
}

/// The case file that the command of the run names.
fn original(directory: &Path) -> Option<PathBuf> {
    let text = files::read(&directory.join(files::COMMAND)).ok()?;
    let command: serde_json::Value = serde_json::from_str(&text).ok()?;
    Some(PathBuf::from(command["case"].as_str()?))
}

fn of_shape(shape: &WallShape, extent: Extent) -> Vec<Vec<Point>> {
    match shape {
        WallShape::Plane { point, normal } => {
            let polygon = across(extent, *point, *normal);
            polygon.into_iter().collect()
        }
        WallShape::Cylinder {
            point,
            axis,
            radius,
        } => {
            let along = corners(extent).map(|corner| (corner - point).dot(axis));
            let low = along.iter().copied().fold(f64::INFINITY, f64::min);
            let high = along.iter().copied().fold(f64::NEG_INFINITY, f64::max);
            let ends = [low, high].map(|at| point + axis * at);
            round(ends, [*radius; 2])
        }
        WallShape::Cone { ends, radii } => round(*ends, *radii),
        WallShape::Mesh { triangles } => {
            triangles.iter().map(|triangle| triangle.to_vec()).collect()
        }
    }
}

fn corners([low, high]: Extent) -> [Point; 8] {
    std::array::from_fn(|corner| {
        let end = |axis: usize| [low, high][corner >> axis & 1][axis];
        Point::new(end(0), end(1), end(2))
    })
}

/// The part of a plane inside a box; `None` where it does not cross it or is one of its sides.
fn across(extent: Extent, point: Point, normal: Point) -> Option<Vec<Point>> {
    let corners = corners(extent);
    let heights = corners.map(|corner| (corner - point).dot(&normal));
    let size = (extent[1] - extent[0]).norm();
    let mut spots = Vec::new();
    for a in 0..8_usize {
        for axis in 0..3 {
            let b = a | 1 << axis;
            if b == a || heights[a] * heights[b] > 0.0 || heights[a] == heights[b] {
                continue;
            }
            let share = heights[a] / (heights[a] - heights[b]);
            spots.push(corners[a].lerp(&corners[b], share));
        }
    }
    let outside = |sign: f64| heights.iter().all(|height| sign * height >= -1e-9 * size);
    if spots.len() < 3 || outside(1.0) || outside(-1.0) {
        return None;
    }
    let middle = spots.iter().sum::<Point>() / spots.len() as f64;
    let right = spots[0] - middle;
    let up = normal.cross(&right);
    let angle = |spot: &Point| {
        let from = spot - middle;
        from.dot(&up).atan2(from.dot(&right))
    };
    spots.sort_by(|a, b| angle(a).total_cmp(&angle(b)));
    Some(spots)
}

/// Sides of a frustum between two points of its axis.
fn round(ends: [Vec3; 2], radii: [f64; 2]) -> Vec<Vec<Point>> {
    let axis = ends[1] - ends[0];
    let aside = if axis.x.abs() < 0.9 * axis.norm() {
        Vec3::x()
    } else {
        Vec3::y()
    };
    let right = axis.cross(&aside).normalize();
    let up = axis.normalize().cross(&right);
    let spot = |end: usize, side: usize| {
        let angle = TAU * (side % SIDES) as f64 / SIDES as f64;
        ends[end] + (right * angle.cos() + up * angle.sin()) * radii[end]
    };
    (0..SIDES)
        .map(|side| {
            vec![
                spot(0, side),
                spot(0, side + 1),
                spot(1, side + 1),
                spot(1, side),
            ]
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    const CUBE: Extent = [Point::new(0.0, 0.0, 0.0), Point::new(1.0, 1.0, 1.0)];

    #[test]
    fn a_plane_through_a_box_is_cut_at_its_sides_and_a_side_itself_is_left_out() {
        let middle = across(CUBE, Point::new(0.0, 0.0, 0.5), Point::z()).unwrap();
        assert_eq!(middle.len(), 4);
        assert!(middle.iter().all(|spot| spot[2] == 0.5));
        let slant = across(CUBE, Point::repeat(0.5), Point::repeat(1.0)).unwrap();
        assert_eq!(slant.len(), 6);
        assert_eq!(across(CUBE, Point::zeros(), Point::z()), None);
        assert_eq!(across(CUBE, Point::new(0.0, 0.0, 3.0), Point::z()), None);
    }

    #[test]
    fn an_endless_cylinder_is_as_long_as_the_box() {
        let cylinder = WallShape::Cylinder {
            point: Vec3::new(0.5, 0.5, 7.0),
            axis: Vec3::z(),
            radius: 0.5,
        };
        let sides = of_shape(&cylinder, CUBE);
        assert_eq!(sides.len(), SIDES);
        for spot in sides.iter().flatten() {
            assert!((f64::hypot(spot[0] - 0.5, spot[1] - 0.5) - 0.5).abs() < 1e-14);
            assert!(spot[2].abs() < 1e-14 || (spot[2] - 1.0).abs() < 1e-14);
        }
    }
}
