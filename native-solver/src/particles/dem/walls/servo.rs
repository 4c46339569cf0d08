//! A wall that is moved to hold a force.

use calcine_coupler::motion::WallMotion;
use calcine_coupler::physics::Vec3;

/// m dv/dt = F − c v − P, with the force P that the particles press against it, along a line (docs/theory.md, COR-40).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Servo {
    /// Unit vector along the line, in which F presses.
    pub direction: Vec3,
    force: f64,
    mass: f64,
    damping: f64,
    /// Distance in m from where it started.
    pub distance: f64,
    /// Speed in m/s.
    pub rate: f64,
}

impl Servo {
    /// The servo of a wall that holds a force, at rest where it starts.
    pub fn of(motion: &WallMotion) -> Option<Self> {
        match *motion {
            WallMotion::Servo {
                direction,
                force,
                mass,
                damping,
            } => Some(Self {
                direction,
                force,
                mass,
                damping,
                distance: 0.0,
                rate: 0.0,
            }),
            _ => None,
        }
    }

    /// Kicks it over a time in s against the force in N of the particles: with the forces constant over the kick the exact solution,
    /// stable however large the damping.
    pub fn kick(&mut self, span: f64, pressed: f64) {
        let a = self.damping / self.mass * span;
        let share = if a > 0.0 { -(-a).exp_m1() / a } else { 1.0 };
        let change = (self.force - pressed - self.damping * self.rate) / self.mass;
        self.rate += change * (share * span);
    }

    /// Moves it over a time in s.
    pub fn drift(&mut self, span: f64) {
        self.distance += self.rate * span;
    }

    /// Where it is from where it started, in m.
    pub fn shift(&self) -> Vec3 {
        self.direction * self.distance
    }

    /// Velocity in m/s.
    pub fn velocity(&self) -> Vec3 {
        self.direction * self.rate
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn servo(damping: f64) -> Servo {
        Servo::of(&WallMotion::Servo {
            direction: -Vec3::z(),
            force: 3.0,
            mass: 0.5,
            damping,
        })
        .unwrap()
    }

    /// Velocity Verlet over so many steps of 1 ms, without particles.
    fn moved(mut servo: Servo, steps: u32) -> Servo {
        for _ in 0..steps {
            servo.kick(0.5e-3, 0.0);
            servo.drift(1e-3);
            servo.kick(0.5e-3, 0.0);
        }
        servo
    }

    #[test]
    fn a_free_wall_is_accelerated_by_its_force() {
        let servo = moved(servo(0.0), 100);
        assert!((servo.rate / (6.0 * 0.1) - 1.0).abs() < 1e-13);
        assert!((servo.distance / (0.5 * 6.0 * 0.01) - 1.0).abs() < 1e-13);
        assert!((servo.shift() + Vec3::z() * servo.distance).norm() < 1e-18);
    }

    #[test]
    fn a_damped_wall_approaches_the_speed_at_which_damping_takes_the_force() {
        // m/c = 0.05 s: v = F/c (1 − exp(−t c/m)) at 0.1 s.
        let servo = moved(servo(10.0), 100);
        let exact = 0.3 * -(-2.0f64).exp_m1();
        assert!((servo.rate / exact - 1.0).abs() < 1e-13, "{}", servo.rate);
        let at_once = moved(self::servo(1e9), 1);
        assert!((at_once.rate / 3e-9 - 1.0).abs() < 1e-13);
    }

    #[test]
    fn a_wall_that_is_pressed_as_hard_stays() {
        let mut servo = servo(10.0);
        servo.kick(1.0, 3.0);
        assert_eq!(servo.rate, 0.0);
        servo.kick(1e-6, 4.0);
        assert!(servo.rate < 0.0);
    }
}
