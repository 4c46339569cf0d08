//! Where rays end.

use calcine_physics::Vec3;

/// Where a ray meets a wall.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RayHit {
    /// Distance along the ray in m.
    pub distance: f64,
    /// Unit normal of the wall, against the ray.
    pub normal: Vec3,
}
