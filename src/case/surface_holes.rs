//! Holes in surfaces of triangles: rims around which the surface goes on, as where triangles of a file are missing.

use std::collections::{BTreeMap, HashMap};

use calcine_coupler::physics::Vec3;

/// Corners nearer than this share of the surface's extent are one: corners of files are single precision.
const SAME: f64 = 1e-6;
/// Cosine of the angle between a hole and the triangles at its rim up to which they are one surface; the mouth of a pipe or a cone is no hole.
const SMOOTH: f64 = 0.8;

/// A hole.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Hole {
    /// The middle of its corners in m.
    pub centre: Vec3,
    /// Diameter in m of the circle of its area.
    pub width: f64,
    /// Edges of its rim.
    pub edges: usize,
}

/// An edge that one triangle has alone: its ends, that triangle's third corner and normal.
struct OpenEdge {
    ends: [usize; 2],
    third: Vec3,
    normal: Vec3,
}

/// The holes of a surface, in the order of their first corners.
pub(super) fn holes(triangles: &[[Vec3; 3]], extent: f64) -> Vec<Hole> {
    let mut places: Vec<Vec3> = Vec::new();
    let mut known: HashMap<[i64; 3], usize> = HashMap::new();
    let mut corner = |place: &Vec3| {
        let cell = [0, 1, 2].map(|axis| (place[axis] / (SAME * extent)).round() as i64);
        *known.entry(cell).or_insert_with(|| {
            places.push(*place);
            places.len() - 1
        })
    };
    let mut edges: BTreeMap<[usize; 2], Vec<OpenEdge>> = BTreeMap::new();
    for triangle in triangles {
        let [a, b, c] = triangle;
        let normal = (b - a).cross(&(c - a));
        let Some(normal) = normal.try_normalize(0.0) else {
            continue;
        };
        let index = triangle.each_ref().map(&mut corner);
        for k in 0..3 {
            let ends = [index[k], index[(k + 1) % 3]];
            let key = [ends[0].min(ends[1]), ends[0].max(ends[1])];
            let third = triangle[(k + 2) % 3];
            let edge = OpenEdge {
                ends,
                third,
                normal,
            };
            edges.entry(key).or_default().push(edge);
        }
    }
    let mut open: Vec<OpenEdge> = edges
        .into_values()
        .filter_map(|mut all| (all.len() == 1).then(|| all.pop()).flatten())
        .collect();
    let mut holes = Vec::new();
    while let Some(first) = open.pop() {
        let mut rim = vec![first];
        let begin = rim[0].ends[0];
        let mut end = rim[0].ends[1];
        while end != begin {
            let Some(next) = open.iter().position(|edge| edge.ends.contains(&end)) else {
                break;
            };
            let edge = open.swap_remove(next);
            end = edge.ends[usize::from(edge.ends[0] == end)];
            rim.push(edge);
        }
        if end == begin {
            holes.extend(hole(&rim, &places));
        }
    }
    holes.sort_by(|a, b| {
        let place = |hole: &Hole| [hole.centre.x, hole.centre.y, hole.centre.z];
        place(a)
            .partial_cmp(&place(b))
            .unwrap_or(std::cmp::Ordering::Equal)
    });
    holes
}

/// The hole of a closed rim; `None` where the surface ends there.
fn hole(rim: &[OpenEdge], places: &[Vec3]) -> Option<Hole> {
    let corners = rim
        .iter()
        .flat_map(|edge| edge.ends)
        .map(|corner| places[corner]);
    let centre = corners.sum::<Vec3>() / (2.0 * rim.len() as f64);
    let mut at = rim[0].ends[0];
    let mut area = Vec3::zeros();
    for edge in rim {
        let next = edge.ends[usize::from(edge.ends[0] == at)];
        area += 0.5 * (places[at] - centre).cross(&(places[next] - centre));
        at = next;
    }
    let normal = area.try_normalize(0.0)?;
    let mut goes_on = false;
    for edge in rim {
        let [from, to] = edge.ends.map(|corner| places[corner]);
        let along = (to - from).normalize();
        // On which side of the edge a place is.
        let aside = |place: Vec3| (place - from) - along * (place - from).dot(&along);
        let side = aside(edge.third).dot(&aside(centre));
        let flat = edge.normal.dot(&normal).abs() > SMOOTH;
        if flat && side > 0.0 {
            // The surface lies within the rim: it ends here.
            return None;
        }
        goes_on |= flat && side < 0.0;
    }
    goes_on.then(|| Hole {
        centre,
        width: 2.0 * (area.norm() / std::f64::consts::PI).sqrt(),
        edges: rim.len(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A cylinder of so many sides, 100 mm high, with a radius of 50 mm, and a bottom at which two rings of triangles meet.
    fn cup(sides: usize) -> Vec<[Vec3; 3]> {
        let at = |k: usize, radius: f64, height: f64| {
            let angle = std::f64::consts::TAU * k as f64 / sides as f64;
            Vec3::new(radius * angle.cos(), radius * angle.sin(), height)
        };
        let mut triangles = Vec::new();
        for k in 0..sides {
            let ring =
                |radius: f64, height: f64| [at(k, radius, height), at(k + 1, radius, height)];
            let [top, foot, inner] = [ring(0.05, 0.1), ring(0.05, 0.0), ring(0.02, 0.0)];
            for [outer, within] in [[top, foot], [foot, inner]] {
                triangles.push([outer[0], outer[1], within[0]]);
                triangles.push([outer[1], within[1], within[0]]);
            }
            triangles.push([inner[0], inner[1], Vec3::zeros()]);
        }
        triangles
    }

    #[test]
    fn a_cup_has_no_hole_and_its_mouth_is_none() {
        assert_eq!(holes(&cup(24), 0.1), []);
    }

    #[test]
    fn missing_triangles_are_a_hole_with_their_place_and_width() {
        let mut triangles = cup(24);
        let gone = triangles.remove(4);
        let found = holes(&triangles, 0.1);
        let [hole] = &found[..] else {
            panic!("{found:?}");
        };
        assert_eq!(hole.edges, 3);
        let centre = gone.iter().sum::<Vec3>() / 3.0;
        assert!((hole.centre - centre).norm() < 1e-9, "{hole:?}");
        let area = 0.5 * (gone[1] - gone[0]).cross(&(gone[2] - gone[0])).norm();
        assert!((hole.width.powi(2) * std::f64::consts::FRAC_PI_4 / area - 1.0).abs() < 1e-9);
        // Three of the bottom, apart from each other.
        let mut triangles = cup(24);
        for k in [103, 63, 23] {
            triangles.remove(k);
        }
        assert_eq!(holes(&triangles, 0.1).len(), 3);
    }

    /// One that has only the other half of its face beside it in its plane.
    #[test]
    fn a_triangle_that_a_box_lacks_is_a_hole() {
        let corner = |k: usize| {
            let bit = |axis: usize| 0.1 * ((k >> axis) & 1) as f64;
            Vec3::new(bit(0), bit(1), bit(2))
        };
        let faces = [
            [0, 2, 3, 1],
            [4, 5, 7, 6],
            [0, 1, 5, 4],
            [2, 6, 7, 3],
            [0, 4, 6, 2],
            [1, 3, 7, 5],
        ];
        let halves = faces.into_iter().flat_map(|[a, b, c, d]| {
            let [a, b, c, d] = [a, b, c, d].map(corner);
            [[a, b, c], [a, c, d]]
        });
        let triangles: Vec<_> = halves.collect();
        assert_eq!(holes(&triangles, 0.1), []);
        for lacking in 0..triangles.len() {
            let mut open = triangles.clone();
            open.remove(lacking);
            assert_eq!(holes(&open, 0.1).len(), 1, "{lacking}");
        }
        // Without a whole face it is a box that is open there.
        assert_eq!(holes(&triangles[2..], 0.1), []);
    }

    #[test]
    fn plates_end_at_their_rims_and_corners_in_single_precision_are_one() {
        let square = |x: f64| {
            let corner = |i: f64, j: f64| Vec3::new(x + 0.1 * i, 0.1 * j, 0.3);
            let [a, b, c, d] = [
                corner(0.0, 0.0),
                corner(1.0, 0.0),
                corner(1.0, 1.0),
                corner(0.0, 1.0),
            ];
            [[a, b, c], [a, c, d]]
        };
        let plates: Vec<_> = [square(0.0), square(0.5)].concat();
        assert_eq!(holes(&plates, 0.6), []);
        let rough = cup(24)
            .into_iter()
            .map(|one| one.map(|corner| corner.map(|x| f64::from(x as f32))));
        assert_eq!(holes(&rough.collect::<Vec<_>>(), 0.1), []);
    }
}
