//! Walls as rays and particles meet them.

use calcine_physics::Vec3;

use super::ray::RayHit;
use super::tree::TriangleTree;
use crate::motion::WallShape;

/// The shape of a wall, ready to be asked.
#[derive(Clone, Debug)]
pub enum WallSurface {
    /// All shapes but triangles.
    Plain(WallShape),
    /// Triangles.
    Mesh(TriangleTree),
}

impl WallSurface {
    /// From the shape of a wall.
    pub fn new(shape: &WallShape) -> Self {
        match shape {
            WallShape::Mesh { triangles } => Self::Mesh(TriangleTree::new(triangles)),
            other => Self::Plain(other.clone()),
        }
    }

    /// Distance in m of a point within the bed from the wall, negative beyond it; infinite where a mesh is
    /// farther than `within` in m.
    pub fn distance(&self, point: Vec3, within: f64) -> f64 {
        match self {
            Self::Mesh(tree) => tree.distance(point, within),
            Self::Plain(WallShape::Plane { point: of, normal }) => (point - of).dot(normal),
            Self::Plain(WallShape::Cylinder {
                point: of,
                axis,
                radius,
            }) => radius - across(point - of, axis).norm(),
            Self::Plain(WallShape::Cone { ends, radii }) => {
                let frustum = Frustum::new(ends, radii);
                let (x, rho) = frustum.place(point);
                let along = Vec3::new(frustum.length, radii[1] - radii[0], 0.0);
                let from = Vec3::new(x, rho - radii[0], 0.0);
                let share = (from.dot(&along) / along.norm_squared()).clamp(0.0, 1.0);
                (from - share * along).norm()
            }
            Self::Plain(WallShape::Mesh { .. }) => f64::INFINITY,
        }
    }

    /// Where a ray from a point within the bed, along a unit vector, meets the wall first.
    pub fn hit(&self, origin: Vec3, way: Vec3) -> Option<RayHit> {
        match self {
            Self::Mesh(tree) => tree.hit(origin, way),
            Self::Plain(WallShape::Plane { point, normal }) => {
                let speed = way.dot(normal);
                (speed < 0.0).then(|| RayHit {
                    distance: ((origin - point).dot(normal) / -speed).max(0.0),
                    normal: *normal,
                })
            }
            Self::Plain(WallShape::Cylinder {
                point,
                axis,
                radius,
            }) => {
                let (from, speed) = (across(origin - point, axis), across(way, axis));
                let (a, b) = (speed.norm_squared(), from.dot(&speed));
                let root = b * b - a * (from.norm_squared() - radius * radius);
                if a == 0.0 || root < 0.0 {
                    return None;
                }
                let distance = ((root.sqrt() - b) / a).max(0.0);
                let out = from + distance * speed;
                let normal = -out.try_normalize(0.0)?;
                (normal.dot(&way) < 0.0).then_some(RayHit { distance, normal })
            }
            Self::Plain(WallShape::Cone { ends, radii }) => {
                Frustum::new(ends, radii).hit(origin, way)
            }
            Self::Plain(WallShape::Mesh { .. }) => None,
        }
    }
}

/// The part of a vector that is square to an axis.
fn across(vector: Vec3, axis: &Vec3) -> Vec3 {
    vector - vector.dot(axis) * axis
}

/// The inner side of a frustum.
struct Frustum {
    start: Vec3,
    axis: Vec3,
    length: f64,
    radius: f64,
    /// Growth of the radius along the axis.
    slope: f64,
}

impl Frustum {
    fn new(ends: &[Vec3; 2], radii: &[f64; 2]) -> Self {
        let length = (ends[1] - ends[0]).norm();
        Self {
            start: ends[0],
            axis: (ends[1] - ends[0]) / length,
            length,
            radius: radii[0],
            slope: (radii[1] - radii[0]) / length,
        }
    }

    /// Place along the axis and distance from it, in m.
    fn place(&self, point: Vec3) -> (f64, f64) {
        let from = point - self.start;
        (from.dot(&self.axis), across(from, &self.axis).norm())
    }

    fn hit(&self, origin: Vec3, way: Vec3) -> Option<RayHit> {
        let from = origin - self.start;
        let (rho, speed) = (across(from, &self.axis), across(way, &self.axis));
        let (x, step_limit) = (from.dot(&self.axis), way.dot(&self.axis));
        let (r, growth) = (self.radius + self.slope * x, self.slope * step_limit);
        // |ρ + t v|² = (r + t g)²
        let a = speed.norm_squared() - growth * growth;
        let b = rho.dot(&speed) - r * growth;
        let c = rho.norm_squared() - r * r;
        let root = (b * b - a * c).max(0.0).sqrt();
        let ways = if a == 0.0 {
            [-c / (2.0 * b), f64::NAN]
        } else {
            [(-b - root) / a, (-b + root) / a]
        };
        let mut best: Option<RayHit> = None;
        for distance in ways {
            let place = x + distance * step_limit;
            let here = rho + distance * speed;
            let outward = here.dot(&speed) - (r + distance * growth) * growth;
            let inside = distance >= 0.0 && (0.0..=self.length).contains(&place);
            if inside && outward > 0.0 && best.is_none_or(|hit| distance < hit.distance) {
                let out = here.try_normalize(0.0)? - self.slope * self.axis;
                best = Some(RayHit {
                    distance,
                    normal: -out.normalize(),
                });
            }
        }
        best
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn unit(x: f64, y: f64, z: f64) -> Vec3 {
        Vec3::new(x, y, z).normalize()
    }

    #[test]
    fn a_ray_meets_planes_cylinders_and_cones_where_geometry_says() {
        let plane = WallSurface::Plain(WallShape::Plane {
            point: Vec3::new(0.0, 0.0, 1.0),
            normal: -Vec3::z(),
        });
        let hit = plane.hit(Vec3::zeros(), unit(0.0, 3.0, 4.0)).unwrap();
        assert!((hit.distance - 1.25).abs() < 1e-14);
        assert!(plane.hit(Vec3::zeros(), -Vec3::z()).is_none());
        assert_eq!(plane.distance(Vec3::new(5.0, 0.0, 0.25), 1.0), 0.75);
        let tube = WallSurface::Plain(WallShape::Cylinder {
            point: Vec3::new(1.0, 0.0, 0.0),
            axis: Vec3::z(),
            radius: 2.0,
        });
        let hit = tube.hit(Vec3::new(0.0, 0.0, 7.0), Vec3::x()).unwrap();
        assert!((hit.distance - 3.0).abs() < 1e-14 && (hit.normal + Vec3::x()).norm() < 1e-14);
        assert!((tube.distance(Vec3::new(0.0, 0.0, 3.0), 1.0) - 1.0).abs() < 1e-14);
        // Radius 1 at the bottom, 2 at a height of 1: at 45° the ray out meets its parallel never.
        let cone = WallSurface::Plain(WallShape::Cone {
            ends: [Vec3::zeros(), Vec3::z()],
            radii: [1.0, 2.0],
        });
        let hit = cone.hit(Vec3::new(0.0, 0.0, 0.5), Vec3::x()).unwrap();
        assert!((hit.distance - 1.5).abs() < 1e-14);
        assert!((hit.normal - unit(-1.0, 0.0, 1.0)).norm() < 1e-14);
        assert!(
            cone.hit(Vec3::new(0.0, 0.0, 0.5), unit(1.0, 0.0, 1.0))
                .is_none()
        );
        let apart = cone.distance(Vec3::new(0.0, 0.0, 0.5), 1.0);
        assert!((apart - 1.25_f64.sqrt()).abs() < 1e-14);
        let apart = cone.distance(Vec3::new(0.0, 1.2, 0.5), 1.0);
        assert!((apart - 0.3 * 0.5_f64.sqrt()).abs() < 1e-14);
    }
}
