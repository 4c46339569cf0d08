//! The point of a triangle that is nearest to a place, and which touches of a mesh count.

use calcine_coupler::physics::Vec3;

/// The nearest point of a triangle.
#[derive(Clone, Copy, Debug, Default)]
pub struct TriangleTouch {
    /// The point.
    pub point: Vec3,
    /// Square of its distance in m².
    pub square: f64,
    /// True within the face, false on an edge or a corner.
    pub face: bool,
    /// Index of the triangle.
    pub triangle: u32,
}

/// Most triangles that one sphere is compared with in a contact.
pub const MOST: usize = 32;

/// The point of a triangle nearest to a place: by the Voronoi regions of corners, edges and face
/// (Ericson, Real-Time Collision Detection, 2005, section 5.1.5).
#[inline]
pub fn nearest(place: Vec3, corners: &[Vec3; 3]) -> (Vec3, bool) {
    let [a, b, c] = *corners;
    let (ab, ac, ap) = (b - a, c - a, place - a);
    let (d1, d2) = (ab.dot(&ap), ac.dot(&ap));
    if d1 <= 0.0 && d2 <= 0.0 {
        return (a, false);
    }
    let bp = place - b;
    let (d3, d4) = (ab.dot(&bp), ac.dot(&bp));
    if d3 >= 0.0 && d4 <= d3 {
        return (b, false);
    }
    let vc = d1 * d4 - d3 * d2;
    if vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0 {
        return (a + d1 / (d1 - d3) * ab, false);
    }
    let cp = place - c;
    let (d5, d6) = (ab.dot(&cp), ac.dot(&cp));
    if d6 >= 0.0 && d5 <= d6 {
        return (c, false);
    }
    let vb = d5 * d2 - d1 * d6;
    if vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0 {
        return (a + d2 / (d2 - d6) * ac, false);
    }
    let va = d3 * d6 - d5 * d4;
    if va <= 0.0 && d4 >= d3 && d5 >= d6 {
        let share = (d4 - d3) / ((d4 - d3) + (d5 - d6));
        return (b + share * (c - b), false);
    }
    let scale = 1.0 / (va + vb + vc);
    (a + vb * scale * ab + vc * scale * ac, true)
}

/// Keeps those touches of a mesh that are contacts of their own, nearest first, at most `most`; returns
/// their number.
///
/// A touch of an edge or a corner counts only where no triangle that is as near covers its point: beside a
/// face it is the face's, on a ridge it counts once. A face counts unless another touch has its point.
pub fn keep_distinct(
    touches: &mut [TriangleTouch],
    triangles: &[[Vec3; 3]],
    radius: f64,
    most: usize,
) -> usize {
    touches.sort_unstable_by(|a, b| {
        let order = a.square.total_cmp(&b.square);
        // Of equals a face goes first, then the lower index.
        order
            .then(b.face.cmp(&a.face))
            .then(a.triangle.cmp(&b.triangle))
    });
    let near = (1e-6 * radius).powi(2);
    let mut kept = 0;
    let mut covered = [false; MOST];
    for k in 0..touches.len() {
        let touch = touches[k];
        let earlier = &touches[..k];
        covered[k] = earlier.iter().any(|other| {
            if touch.face {
                return (other.point - touch.point).norm_squared() <= near;
            }
            let (point, _) = nearest(touch.point, &triangles[other.triangle as usize]);
            (point - touch.point).norm_squared() <= near
        });
    }
    for k in 0..touches.len() {
        if !covered[k] && kept < most {
            touches[kept] = touches[k];
            kept += 1;
        }
    }
    kept
}

#[cfg(test)]
mod tests {
    use super::*;

    const CORNERS: [Vec3; 3] = [
        Vec3::new(0.0, 0.0, 0.0),
        Vec3::new(1.0, 0.0, 0.0),
        Vec3::new(0.0, 1.0, 0.0),
    ];

    #[test]
    fn the_nearest_point_lies_in_the_face_on_an_edge_or_at_a_corner() {
        for (place, point, face) in [
            ([0.2, 0.3, 0.5], [0.2, 0.3, 0.0], true),
            ([0.5, -1.0, 0.5], [0.5, 0.0, 0.0], false),
            ([-1.0, 0.25, 0.0], [0.0, 0.25, 0.0], false),
            ([1.0, 1.0, 2.0], [0.5, 0.5, 0.0], false),
            ([-1.0, -2.0, 0.0], [0.0, 0.0, 0.0], false),
            ([3.0, 0.5, 1.0], [1.0, 0.0, 0.0], false),
            ([0.1, 4.0, 1.0], [0.0, 1.0, 0.0], false),
        ] {
            let (found, in_face) = nearest(Vec3::from(place), &CORNERS);
            assert!((found - Vec3::from(point)).norm() < 1e-15, "{place:?}");
            assert_eq!(in_face, face, "{place:?}");
        }
    }
}
