//! What moving particles need of a domain that repeats itself: room for every pair to have one shortest image, and walls that
//! repeat as the domain does.

use calcine_physics::Vec3;
use thiserror::Error;

use crate::mesh::periodic::axis_name;
use crate::motion::{Contacts, Wall, WallMotion, WallShape};
use crate::periodicity::PeriodicSpan;

/// Fewest largest diameters in a period: with neighbour lists that reach three quarters of a diameter beyond a surface at
/// most, two particles are near each other by one image only.
pub const DIAMETERS: f64 = 3.0;
/// Directions and places are alike up to this, as a share.
const SAME: f64 = 1e-6;

/// Moving particles that do not go with the periodic directions.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum PeriodicMotionError {
    /// A period of a few particles.
    #[error(
        "the domain repeats every {period} m along {axis}, which is {diameters:.3} diameters of its largest particle \
         ({diameter} m); moving particles need {DIAMETERS} diameters"
    )]
    Short {
        /// Axis of the direction.
        axis: char,
        /// Distance of the planes in m.
        period: f64,
        /// Largest diameter in m.
        diameter: f64,
        /// The period in these.
        diameters: f64,
    },
    /// A wall that is not the same one period further.
    #[error("wall `{wall}`, {what}, does not repeat with the domain along {axis}")]
    Wall {
        /// Its name.
        wall: String,
        /// What of it does not.
        what: &'static str,
        /// Axis of the direction.
        axis: char,
    },
    /// A mesh that reaches into its own image.
    #[error(
        "wall `{wall}` reaches {beyond} m beyond the periodic plane at {axis} = {plane} m, where its own image continues it"
    )]
    Beyond {
        /// Its name.
        wall: String,
        /// Axis of the direction.
        axis: char,
        /// Coordinate of the plane in m.
        plane: f64,
        /// How far, in m.
        beyond: f64,
    },
}

impl PeriodicMotionError {
    /// What to do about it.
    pub fn remedy(&self) -> &'static str {
        match self {
            Self::Short { .. } => "widen the domain, or take smaller particles",
            Self::Wall { .. } => {
                "walls along a periodic direction are planes and cylinders along it and triangles that move across it or turn \
                 about it; tilt `gas.gravity` in place of a floor"
            }
            Self::Beyond { .. } => "cut its triangles at the plane",
        }
    }
}

/// Checks periods and walls, for particles of this largest radius in m.
pub fn check(contacts: &Contacts, largest: f64) -> Result<(), PeriodicMotionError> {
    check_period(contacts, largest)?;
    for (axis, span) in contacts.periodicity.axes.iter().enumerate() {
        if let Some(span) = span {
            let mut walls = contacts.walls.iter();
            walls.try_for_each(|one| wall(one, axis, span))?;
        }
    }
    Ok(())
}

/// Checks periods for particles of this largest radius in m.
pub fn check_period(contacts: &Contacts, largest: f64) -> Result<(), PeriodicMotionError> {
    let diameter = 2.0 * largest;
    for (axis, span) in contacts.periodicity.axes.iter().enumerate() {
        let Some(span) = span else { continue };
        if span.length() < DIAMETERS * diameter * (1.0 - SAME) {
            return Err(PeriodicMotionError::Short {
                axis: axis_name(axis),
                period: span.length(),
                diameter,
                diameters: span.length() / diameter,
            });
        }
    }
    Ok(())
}

fn wall(wall: &Wall, axis: usize, span: &PeriodicSpan) -> Result<(), PeriodicMotionError> {
    let refuse = |what| PeriodicMotionError::Wall {
        wall: wall.name.clone(),
        what,
        axis: axis_name(axis),
    };
    let along = Vec3::ith(axis, 1.0);
    let is_along = |direction: &Vec3| direction.cross(&along).norm() <= SAME * direction.norm();
    match &wall.shape {
        WallShape::Plane { normal, .. } if normal[axis].abs() > SAME => {
            return Err(refuse("a plane across or inclined to this direction"));
        }
        WallShape::Cylinder { axis: own, .. } if !is_along(own) => {
            return Err(refuse("a cylinder with its axis across this direction"));
        }
        WallShape::Cone { .. } => return Err(refuse("a cone")),
        WallShape::Mesh { triangles } => {
            let corners = triangles.iter().flatten().map(|corner| corner[axis]);
            let (low, high) = corners
                .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), at| {
                    (low.min(at), high.max(at))
                });
            let sides = [(span.low - low, span.low), (high - span.high, span.high)];
            for (beyond, plane) in sides {
                if beyond > SAME * span.length() {
                    return Err(PeriodicMotionError::Beyond {
                        wall: wall.name.clone(),
                        axis: axis_name(axis),
                        plane,
                        beyond,
                    });
                }
            }
        }
        WallShape::Plane { .. } | WallShape::Cylinder { .. } => {}
    }
    let is_mesh = matches!(wall.shape, WallShape::Mesh { .. });
    let moves_along = |way: &Vec3| is_mesh && way[axis].abs() > SAME * way.norm();
    match &wall.motion {
        WallMotion::Rotating {
            angular_velocity, ..
        } if !is_along(angular_velocity) => Err(refuse("which turns about another direction")),
        WallMotion::Translating(way)
        | WallMotion::Scheduled { direction: way, .. }
        | WallMotion::Servo { direction: way, .. }
        | WallMotion::Oscillating { amplitude: way, .. }
            if moves_along(way) =>
        {
            Err(refuse("whose triangles move along this direction"))
        }
        _ => Ok(()),
    }
}
