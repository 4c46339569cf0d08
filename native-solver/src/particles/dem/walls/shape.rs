//! The point of a plane, cylinder or cone that is nearest to a place.

use calcine_coupler::motion::WallShape;
use calcine_coupler::physics::Vec3;

/// The surface as seen from a place.
#[derive(Clone, Copy, Debug)]
pub struct NearestPoint {
    /// Unit normal from the surface to the place (into the particles' side).
    pub normal: Vec3,
    /// Distance in m; negative behind a plane or cylinder.
    pub distance: f64,
}

/// The nearest point of a shape that is not a mesh; nothing where no direction is nearest (on the axis of a
/// cylinder), or for a mesh.
#[inline]
pub fn nearest(shape: &WallShape, place: Vec3) -> Option<NearestPoint> {
    match shape {
        WallShape::Plane { point, normal } => Some(NearestPoint {
            normal: *normal,
            distance: (place - point).dot(normal),
        }),
        WallShape::Cylinder {
            point,
            axis,
            radius,
        } => {
            let from = place - point;
            let out = from - from.dot(axis) * axis;
            let distance = out.norm();
            (distance > 0.0).then(|| NearestPoint {
                normal: -out / distance,
                distance: radius - distance,
            })
        }
        WallShape::Cone { ends, radii } => cone(place, ends, radii),
        WallShape::Mesh { .. } => None,
    }
}

/// In the half plane of the axis the frustum is a straight line between two points.
fn cone(place: Vec3, ends: &[Vec3; 2], radii: &[f64; 2]) -> Option<NearestPoint> {
    let along = ends[1] - ends[0];
    let length = along.norm();
    let axis = along / length;
    let from = place - ends[0];
    let height = from.dot(&axis);
    let out = from - height * axis;
    let distance = out.norm();
    let radial = if distance > 0.0 {
        out / distance
    } else {
        // On the axis every direction is the same by symmetry.
        let other = if axis.x.abs() < 0.5 {
            Vec3::x()
        } else {
            Vec3::y()
        };
        axis.cross(&other).normalize()
    };
    let (rise, spread) = (length, radii[1] - radii[0]);
    let share = (height * rise + (distance - radii[0]) * spread) / (rise * rise + spread * spread);
    let share = share.clamp(0.0, 1.0);
    let (up, outward) = (height - share * rise, distance - radii[0] - share * spread);
    let gap = up.hypot(outward);
    (gap > 0.0).then(|| NearestPoint {
        normal: (up * axis + outward * radial) / gap,
        distance: gap,
    })
}
