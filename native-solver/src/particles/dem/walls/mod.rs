//! Walls: where they are, how they move, which point of them is nearest to a sphere.

pub mod group;
mod servo;
pub mod shape;
pub mod triangle;

use calcine_coupler::motion::{Wall, WallMotion, WallShape};
use calcine_coupler::periodicity::Periodicity;
use calcine_coupler::physics::Vec3;
use nalgebra::{Matrix3, Rotation3};

pub use servo::Servo;

/// Distance in m from a place to a plane, cylinder or cone; negative behind a plane or cylinder. Nothing for a mesh.
pub fn distance_to_shape(shape: &WallShape, place: Vec3) -> Option<f64> {
    shape::nearest(shape, place).map(|near| near.distance)
}

/// Distance in m from a place to a triangle.
pub fn distance_to_triangle(corners: &[Vec3; 3], place: Vec3) -> f64 {
    (triangle::nearest(place, corners).0 - place).norm()
}

/// A wall in its own frame, which is that of the start of the run, and the frame's pose now.
#[derive(Clone, Debug)]
pub struct WallBody {
    /// Shape at the start.
    pub shape: WallShape,
    /// Index of its material.
    pub material: u32,
    motion: WallMotion,
    turn: Matrix3<f64>,
    shift: Vec3,
    /// Velocity in m/s of a wall that does not turn.
    rate: Vec3,
    /// Where it is where it holds a force.
    pub servo: Option<Servo>,
    /// Largest speed in m/s at which its surface comes nearer to a place within the bounds.
    pub speed: f64,
}

impl WallBody {
    /// A wall at the start of the run, within the bounds of the particles, with its images beyond periodic planes.
    pub fn new(wall: &Wall, bounds: (Vec3, Vec3), periodicity: &Periodicity) -> Self {
        Self {
            shape: repeated(&wall.shape, periodicity),
            material: wall.material as u32,
            motion: wall.motion.clone(),
            turn: Matrix3::identity(),
            shift: Vec3::zeros(),
            rate: wall.motion.displacement(0.0).1,
            servo: Servo::of(&wall.motion),
            speed: speed(wall, bounds),
        }
    }

    /// Moves it to where it is at a motion time in s; a wall that holds a force to where its servo is.
    pub fn pose(&mut self, time: f64) {
        if let Some(servo) = &self.servo {
            (self.shift, self.rate) = (servo.shift(), servo.velocity());
            self.speed = servo.rate.abs();
            return;
        }
        match &self.motion {
            WallMotion::Rotating {
                point,
                angular_velocity,
            } => {
                self.turn = *Rotation3::new(angular_velocity * time).matrix();
                self.shift = point - self.turn * point;
            }
            WallMotion::Still => {}
            moving => (self.shift, self.rate) = moving.displacement(time),
        }
    }

    /// A place in the wall's own frame.
    #[inline]
    pub fn own(&self, place: Vec3) -> Vec3 {
        match &self.motion {
            WallMotion::Still => place,
            WallMotion::Rotating { .. } => self.turn.tr_mul(&(place - self.shift)),
            _ => place - self.shift,
        }
    }

    /// Where a place of the wall's own frame is now.
    #[inline]
    pub fn placed(&self, own: Vec3) -> Vec3 {
        self.turn * own + self.shift
    }

    /// A direction of the wall's own frame as seen from outside.
    #[inline]
    pub fn outside(&self, direction: Vec3) -> Vec3 {
        match &self.motion {
            WallMotion::Rotating { .. } => self.turn * direction,
            _ => direction,
        }
    }

    /// Velocity in m/s of its surface at a place.
    #[inline]
    pub fn velocity(&self, place: Vec3) -> Vec3 {
        match &self.motion {
            WallMotion::Rotating {
                point,
                angular_velocity,
            } => angular_velocity.cross(&(place - point)),
            _ => self.rate,
        }
    }

    /// Angular velocity in rad/s.
    #[inline]
    pub fn spin(&self) -> Vec3 {
        match &self.motion {
            WallMotion::Rotating {
                angular_velocity, ..
            } => *angular_velocity,
            _ => Vec3::zeros(),
        }
    }
}

/// A mesh with the images of its triangles that are no farther than half a period from the particles: more than particles
/// reach. All other walls go on beyond the planes.
pub fn repeated(shape: &WallShape, periodicity: &Periodicity) -> WallShape {
    let WallShape::Mesh { triangles } = shape else {
        return shape.clone();
    };
    let mut triangles = triangles.clone();
    for (axis, span) in periodicity.axes.iter().enumerate() {
        let Some(span) = span else { continue };
        let near = |triangle: &[Vec3; 3]| {
            let along = triangle.map(|corner| corner[axis]);
            let low = along.iter().copied().fold(f64::INFINITY, f64::min);
            let high = along.iter().copied().fold(f64::NEG_INFINITY, f64::max);
            high >= span.low - 0.5 * span.length() && low <= span.high + 0.5 * span.length()
        };
        let shift = Vec3::ith(axis, span.length());
        let images = [shift, -shift].map(|shift| {
            let images = triangles.iter().map(|one| one.map(|corner| corner + shift));
            images.filter(near).collect::<Vec<_>>()
        });
        triangles.extend(images.into_iter().flatten());
    }
    WallShape::Mesh { triangles }
}

/// The largest speed of the surface where particles can be; zero for one that turns within itself.
fn speed(wall: &Wall, (low, high): (Vec3, Vec3)) -> f64 {
    match &wall.motion {
        WallMotion::Rotating {
            point,
            angular_velocity,
        } => {
            let (point, angular_velocity) = (*point, *angular_velocity);
            let axial = |axis: Vec3, on_axis: Vec3| {
                axis.cross(&angular_velocity).norm() <= 1e-12 * angular_velocity.norm()
                    && axis.cross(&(on_axis - point)).norm() <= 1e-12 * (high - low).norm()
            };
            let within_itself = match &wall.shape {
                WallShape::Cylinder {
                    point: on_axis,
                    axis,
                    ..
                } => axial(*axis, *on_axis),
                WallShape::Cone { ends, .. } => axial((ends[1] - ends[0]).normalize(), ends[0]),
                WallShape::Plane { normal, .. } => {
                    normal.cross(&angular_velocity).norm() <= 1e-12 * angular_velocity.norm()
                }
                WallShape::Mesh { .. } => false,
            };
            if within_itself {
                return 0.0;
            }
            // The farthest corner of the bounds from the point bounds the distance from the axis.
            let far = (low - point).abs().sup(&(high - point).abs());
            angular_velocity.norm() * far.norm()
        }
        other => other.largest_speed(),
    }
}
