//! Walls of the gas: how they move, and their temperature along an axis.

use calcine_physics::Vec3;
use calcine_physics::points::linear;

use crate::schedule::Schedule;

/// How the gas moves along a wall.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum WallVelocity {
    /// It sticks.
    NoSlip,
    /// It slides freely.
    Slip,
    /// It sticks to a wall that slides in its own plane with this velocity in m/s.
    Moving(Vec3),
    /// It sticks to a wall that turns within itself about an axis.
    Rotating {
        /// A point of the axis in m.
        point: Vec3,
        /// Angular velocity in rad/s along the axis.
        angular_velocity: Vec3,
    },
}

impl WallVelocity {
    /// The velocity ω × r in m/s of a wall that turns, at a place in m; that of one that slides anywhere, 0 of one at rest.
    pub fn at(&self, place: Vec3) -> Vec3 {
        match self {
            Self::NoSlip | Self::Slip => Vec3::zeros(),
            Self::Moving(velocity) => *velocity,
            Self::Rotating {
                point,
                angular_velocity,
            } => angular_velocity.cross(&(place - point)),
        }
    }

    /// The velocity in m/s that gas has at a face of this wall: without the part along the unit normal, which flat faces of a
    /// round wall leave; `None` where it slips.
    pub fn of_gas(&self, place: Vec3, normal: Vec3) -> Option<Vec3> {
        let velocity = self.at(place);
        match self {
            Self::Slip => None,
            Self::NoSlip | Self::Moving(_) => Some(velocity),
            Self::Rotating { .. } => Some(velocity - velocity.dot(&normal) * normal),
        }
    }
}

/// The temperature of a wall along an axis, each of its stations over process time: linear between stations, constant beyond the
/// first and the last.
#[derive(Clone, Debug, PartialEq)]
pub struct AxialTemperature {
    /// Unit vector along the axis.
    pub axis: Vec3,
    /// Coordinate along the axis in m, measured from the origin, and temperature in K of each station; coordinates increase.
    pub stations: Vec<(f64, Schedule)>,
}

impl AxialTemperature {
    /// The profile at a process time in s: coordinates in m and temperatures in K.
    pub fn at(&self, time: f64) -> Vec<(f64, f64)> {
        let stations = self.stations.iter();
        stations.map(|(x, over)| (*x, over.at(time))).collect()
    }

    /// The temperature in K of a profile at a place in m.
    pub fn of(&self, profile: &[(f64, f64)], place: Vec3) -> f64 {
        linear(profile, place.dot(&self.axis))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_drum_of_0_6_m_at_10_rpm_moves_at_0_628_m_s_along_itself() {
        let drum = WallVelocity::Rotating {
            point: Vec3::new(1.0, 2.0, 3.0),
            angular_velocity: Vec3::new(0.0, 0.0, std::f64::consts::PI / 3.0),
        };
        let velocity = drum.at(Vec3::new(1.6, 2.0, -4.0));
        // 10/60 · 2 π · 0.6
        assert!((velocity - Vec3::new(0.0, 0.628_318_530_717_958_6, 0.0)).norm() < 1e-15);
        let oblique = Vec3::new(0.8, 0.6, 0.0);
        let along = drum.of_gas(Vec3::new(1.6, 2.0, 0.0), oblique).unwrap();
        // v - (v·n) n with v·n = 0.6 v.
        let expected = 0.628_318_530_717_958_6 * Vec3::new(-0.48, 0.64, 0.0);
        assert!((along - expected).norm() < 1e-15, "{along}");
    }

    #[test]
    fn a_temperature_along_an_axis_is_linear_in_place_and_time() {
        let wall = AxialTemperature {
            axis: Vec3::new(0.0, 0.6, 0.8),
            stations: vec![
                (1.0, Schedule(vec![(0.0, 300.0), (10.0, 400.0)])),
                (3.0, Schedule::constant(700.0)),
            ],
        };
        let at = |time: f64, x: f64| wall.of(&wall.at(time), x * wall.axis);
        // Half way in time and a quarter of the way along: 350 + 0.25 · 350.
        assert!((at(5.0, 1.5) - 437.5).abs() < 1e-12);
        assert!((at(0.0, -2.0) - 300.0).abs() < 1e-12 && (at(20.0, 9.0) - 700.0).abs() < 1e-12);
    }
}
