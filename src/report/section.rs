//! The plane section of a snapshot: polygons of gas cells and circles of particles, seen along y.

use super::cells::each_cell;
use super::colour::Range;
use crate::results::read::Arrays;

/// A point of the picture: x to the right, z upwards, in m.
pub(super) type Spot = [f64; 2];

/// A gas cell cut by the plane.
pub(super) struct Polygon {
    /// Index of the cell.
    pub cell: usize,
    /// Corners, counter-clockwise.
    pub corners: Vec<Spot>,
}

/// A particle cut by the plane.
pub(super) struct Circle {
    /// Index of the particle in its file.
    pub particle: usize,
    /// Its centre.
    pub centre: Spot,
    /// Radius of the cut in m.
    pub radius: f64,
}

/// The height y of the plane through the middle of the gas, off by a millionth of the depth so that
/// it does not run along faces.
pub(super) fn plane(gas: &Arrays) -> f64 {
    let points = gas.get("points").map_or(&[][..], |array| &array.values);
    let ys = points.iter().skip(1).step_by(3);
    let (low, high) = ys.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), &y| {
        (low.min(y), high.max(y))
    });
    0.5 * (low + high) + 1e-6 * (high - low)
}

/// The cells that the plane cuts.
pub(super) fn polygons(gas: &Arrays, plane: f64) -> Vec<Polygon> {
    let points = gas.get("points").map_or(&[][..], |array| &array.values);
    let mut polygons = Vec::new();
    let mut cell = 0;
    each_cell(gas, |faces| {
        let edges = edges(faces).into_iter();
        let cuts = edges.filter_map(|edge| cut(points, edge, plane));
        let corners = hull(cuts.collect());
        if corners.len() > 2 {
            polygons.push(Polygon { cell, corners });
        }
        cell += 1;
    });
    polygons
}

/// Corners of the box about polygons, lowest and highest; `None` where there are none.
pub(super) fn extent(polygons: &[Polygon]) -> Option<(Spot, Spot)> {
    let corners = || polygons.iter().flat_map(|polygon| polygon.corners.iter());
    let x = Range::of(corners().map(|corner| corner[0]))?;
    let z = Range::of(corners().map(|corner| corner[1]))?;
    Some(([x.low, z.low], [x.high, z.high]))
}

/// The particles that the plane cuts; one that stands for several as a sphere of their volume, weight^(1/3) times as wide.
pub(super) fn circles(particles: &Arrays, plane: f64) -> Vec<Circle> {
    let points = particles
        .get("points")
        .map_or(&[][..], |array| &array.values);
    points
        .chunks_exact(3)
        .zip(radii(particles))
        .enumerate()
        .filter_map(|(particle, (centre, radius))| {
            let squared = radius * radius - (centre[1] - plane).powi(2);
            (squared > 0.0).then(|| Circle {
                particle,
                centre: [centre[0], centre[2]],
                radius: squared.sqrt(),
            })
        })
        .collect()
}

/// Radii of particles in m; of one that stands for several that of a sphere of their volume.
pub(super) fn radii(particles: &Arrays) -> Vec<f64> {
    let list = |name: &str| particles.get(name).map_or(&[][..], |array| &array.values);
    let wide = |(particle, &radius): (usize, &f64)| match list("weight").get(particle) {
        Some(&weight) if weight != 1.0 => radius * weight.cbrt(),
        _ => radius,
    };
    list("radius").iter().enumerate().map(wide).collect()
}

/// What the circles of a picture are, under it, where a particle stands for several; else nothing.
pub(super) fn legend(particles: &Arrays) -> &'static str {
    let weights = particles
        .get("weight")
        .map_or(&[][..], |array| &array.values);
    match weights.iter().any(|&weight| weight != 1.0) {
        true => {
            "<p class=\"note\">Each circle is a parcel, drawn as a sphere with the volume of all particles that it stands \
             for: weight<sup>1/3</sup> times the diameter of one.</p>"
        }
        false => "",
    }
}

/// The edges of faces, each once.
fn edges(faces: &[Vec<usize>]) -> Vec<[usize; 2]> {
    let of_face = |face: &Vec<usize>| -> Vec<[usize; 2]> {
        let next = face.iter().cycle().skip(1);
        let pairs = face.iter().zip(next);
        pairs.map(|(&a, &b)| [a.min(b), a.max(b)]).collect()
    };
    let mut edges: Vec<_> = faces.iter().flat_map(of_face).collect();
    edges.sort_unstable();
    edges.dedup();
    edges
}

fn cut(points: &[f64], edge: [usize; 2], plane: f64) -> Option<Spot> {
    let a = points.get(3 * edge[0]..3 * edge[0] + 3)?;
    let b = points.get(3 * edge[1]..3 * edge[1] + 3)?;
    if (a[1] < plane) == (b[1] < plane) {
        return None;
    }
    let share = (plane - a[1]) / (b[1] - a[1]);
    Some([a[0] + share * (b[0] - a[0]), a[2] + share * (b[2] - a[2])])
}

/// The convex hull of points, counter-clockwise (Andrew's monotone chain).
fn hull(mut spots: Vec<Spot>) -> Vec<Spot> {
    spots.sort_by(|a, b| a[0].total_cmp(&b[0]).then(a[1].total_cmp(&b[1])));
    spots.dedup();
    if spots.len() < 3 {
        return spots;
    }
    let turn =
        |o: Spot, a: Spot, b: Spot| (a[0] - o[0]) * (b[1] - o[1]) - (a[1] - o[1]) * (b[0] - o[0]);
    let half = |spots: &mut dyn Iterator<Item = Spot>| {
        let mut chain: Vec<Spot> = Vec::new();
        for spot in spots {
            while let [.., o, a] = chain[..] {
                if turn(o, a, spot) > 0.0 {
                    break;
                }
                chain.pop();
            }
            chain.push(spot);
        }
        chain.pop();
        chain
    };
    let mut chain = half(&mut spots.iter().copied());
    chain.extend(half(&mut spots.iter().rev().copied()));
    chain
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::results::read::Array;

    #[test]
    fn the_hull_of_a_square_with_points_inside_and_on_its_edges_is_the_square() {
        let spots = vec![
            [0.0, 0.0],
            [1.0, 0.0],
            [1.0, 1.0],
            [0.0, 1.0],
            [0.5, 0.5],
            [0.5, 0.0],
        ];
        assert_eq!(
            hull(spots),
            [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]]
        );
    }

    #[test]
    fn a_parcel_is_as_wide_as_a_sphere_of_the_volume_of_its_particles() {
        let array = |components: usize, values: &[f64]| Array {
            components,
            values: values.to_vec(),
        };
        let mut bed = Arrays::from([
            ("points".to_owned(), array(3, &[0.0, 0.0, 1.0])),
            ("radius".to_owned(), array(1, &[2.0])),
        ]);
        assert_eq!(circles(&bed, 0.0)[0].radius, 2.0);
        assert_eq!(legend(&bed), "");
        bed.insert("weight".to_owned(), array(1, &[27.0]));
        assert!((circles(&bed, 0.0)[0].radius - 6.0).abs() < 1e-14);
        assert!(legend(&bed).contains("parcel"));
        bed.insert("weight".to_owned(), array(1, &[1.0]));
        assert_eq!(legend(&bed), "");
    }

    #[test]
    fn a_tetrahedron_given_as_faces_is_cut_in_a_triangle() {
        let stream = [
            4.0, 3.0, 0.0, 1.0, 2.0, 3.0, 0.0, 1.0, 3.0, 3.0, 1.0, 2.0, 3.0, 3.0, 0.0, 2.0, 3.0,
        ];
        let points = [0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 1.0, 0.0];
        let list = |values: &[f64]| Array {
            components: 1,
            values: values.to_vec(),
        };
        let gas = Arrays::from([
            ("points".to_owned(), list(&points)),
            ("connectivity".to_owned(), list(&[0.0, 1.0, 2.0, 3.0])),
            ("offsets".to_owned(), list(&[4.0])),
            ("faces".to_owned(), list(&stream)),
            ("faceoffsets".to_owned(), list(&[stream.len() as f64])),
        ]);
        each_cell(&gas, |faces| assert_eq!(edges(faces).len(), 6));
        let found = polygons(&gas, 0.5);
        assert_eq!((found.len(), found[0].cell), (1, 0));
        assert_eq!(found[0].corners, [[0.0, 0.0], [0.5, 0.0], [0.0, 0.5]]);
    }
}
