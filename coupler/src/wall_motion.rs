//! How walls move.

use std::f64::consts::TAU;

use calcine_physics::Vec3;
use calcine_physics::points::linear;

/// How a wall moves, on the motion clock.
#[derive(Clone, Debug, Default, PartialEq)]
pub enum WallMotion {
    /// It stays.
    #[default]
    Still,
    /// It moves with this velocity in m/s.
    Translating(Vec3),
    /// It turns about an axis.
    Rotating {
        /// A point of the axis in m.
        point: Vec3,
        /// Angular velocity in rad/s.
        angular_velocity: Vec3,
    },
    /// It is moved along a line by a schedule, as gates are.
    Scheduled {
        /// Unit vector along the line.
        direction: Vec3,
        /// Distance in m from where it starts over motion time in s: linear between entries, constant outside them.
        distance: Vec<(f64, f64)>,
    },
    /// It oscillates about where it starts, by A sin(2 π t/T).
    Oscillating {
        /// Amplitude A in m.
        amplitude: Vec3,
        /// Period T in s.
        period: f64,
    },
    /// It is moved along a line to hold a force: m dv/dt = F − c v − what the particles press against it, from rest.
    Servo {
        /// Unit vector along the line, in which the force presses.
        direction: Vec3,
        /// Force F in N that it holds, its weight included.
        force: f64,
        /// Mass m in kg.
        mass: f64,
        /// Damping c in N s/m.
        damping: f64,
    },
}

impl WallMotion {
    /// Displacement in m at a motion time in s of a wall that does not turn, and its velocity in m/s; at a kink that of what follows.
    /// None of a wall that follows the particles.
    pub fn displacement(&self, time: f64) -> (Vec3, Vec3) {
        match self {
            Self::Still | Self::Rotating { .. } | Self::Servo { .. } => {
                (Vec3::zeros(), Vec3::zeros())
            }
            Self::Translating(velocity) => (velocity * time, *velocity),
            Self::Scheduled {
                direction,
                distance,
            } => {
                let mut legs = distance.windows(2);
                let leg = legs.find(|leg| leg[0].0 <= time && time < leg[1].0);
                let rate = leg.map_or(0.0, |leg| (leg[1].1 - leg[0].1) / (leg[1].0 - leg[0].0));
                (direction * linear(distance, time), direction * rate)
            }
            Self::Oscillating { amplitude, period } => {
                let rate = TAU / period;
                let (sine, cosine) = (rate * time).sin_cos();
                (amplitude * sine, amplitude * (rate * cosine))
            }
        }
    }

    /// Largest speed in m/s of a wall that does not turn, as far as it is known ahead.
    pub fn largest_speed(&self) -> f64 {
        match self {
            Self::Still | Self::Rotating { .. } | Self::Servo { .. } => 0.0,
            Self::Translating(velocity) => velocity.norm(),
            Self::Scheduled { distance, .. } => {
                let legs = distance.windows(2);
                let rates = legs.map(|leg| ((leg[1].1 - leg[0].1) / (leg[1].0 - leg[0].0)).abs());
                rates.fold(0.0, f64::max)
            }
            Self::Oscillating { amplitude, period } => TAU / period * amplitude.norm(),
        }
    }
}
