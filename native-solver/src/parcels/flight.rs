//! Flight of a parcel by a constant acceleration, drag towards a constant gas velocity, and a resistance towards that of a wall.

use calcine_coupler::physics::Vec3;

/// What acts on a parcel between two impacts: dv/dt = a + k (u − v) + c (w − v).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Flight {
    /// Acceleration a in m/s² by forces and gravity.
    pub acceleration: Vec3,
    /// Rate k in 1/s of drag over mass, 0 or above.
    pub rate: f64,
    /// Gas velocity u in m/s.
    pub gas: Vec3,
    /// Rate c in 1/s of a resistance over mass, 0 or above.
    pub resistance: f64,
    /// Velocity w in m/s that it draws to.
    pub wall: Vec3,
}

impl Flight {
    /// Share φ₁ of what a constant force would add to the velocity over a time in s without drag.
    pub fn yielding(&self, time: f64) -> f64 {
        phi(self.pull().0 * time).0
    }

    /// Rate in 1/s and velocity in m/s of drag and resistance together, k + c and (k u + c w)/(k + c).
    fn pull(&self) -> (f64, Vec3) {
        let (k, c) = (self.rate, self.resistance);
        if c == 0.0 {
            return (k, self.gas);
        }
        (k + c, (k * self.gas + c * self.wall) / (k + c))
    }

    /// The part of the resistance in what it and drag together have added to a velocity over a time in s, in m/s:
    /// c ∫ (w − v) dt, where (k + c) ∫ (ū − v) dt is the whole.
    pub fn resisted(&self, gained: Vec3, time: f64) -> Vec3 {
        let (k, c) = (self.rate, self.resistance);
        if c == 0.0 {
            return Vec3::zeros();
        }
        c / (k + c) * (gained + k * time * (self.wall - self.gas))
    }

    /// Displacement in m and velocity in m/s after a time in s: the exact solution
    ///
    /// v(t) = v + (u − v)(1 − e^(−x)) + a t φ₁,   s(t) = v t + (u − v) t (1 − φ₁) + a t² φ₂,
    ///
    /// of k and u together with c and w; with x = k t, φ₁ = (1 − e^(−x))/x and φ₂ = (1 − φ₁)/x.
    pub fn after(&self, time: f64, velocity: Vec3) -> (Vec3, Vec3) {
        let (rate, towards) = self.pull();
        let x = rate * time;
        let (first, second) = phi(x);
        let slip = towards - velocity;
        let gained = self.acceleration * time;
        // 1 − φ₁ = x φ₂.
        let way = time * (velocity + slip * (x * second) + gained * second);
        (way, velocity + slip * (x * first) + gained * first)
    }
}

/// Up to this x φ₂ is summed up as a series, as its form loses digits there.
const SERIES: f64 = 0.5;

/// φ₁ and φ₂; 1 and 1/2 at x = 0.
fn phi(x: f64) -> (f64, f64) {
    if x > SERIES {
        let first = -(-x).exp_m1() / x;
        return (first, (1.0 - first) / x);
    }
    // φ₂ = Σ (−x)^n/(n + 2)!
    let (mut term, mut second) = (0.5, 0.5);
    for n in 1..16 {
        term *= -x / f64::from(n + 2);
        second += term;
    }
    (1.0 - x * second, second)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_series_meets_the_closed_form() {
        let below = phi(SERIES);
        let above = phi(SERIES * (1.0 + 1e-15));
        assert!((below.0 - above.0).abs() < 1e-15 && (below.1 - above.1).abs() < 2e-15);
        assert_eq!(phi(0.0), (1.0, 0.5));
    }

    #[test]
    fn without_drag_it_is_a_throw() {
        let flight = Flight {
            acceleration: Vec3::new(0.0, 0.0, -9.81),
            rate: 0.0,
            gas: Vec3::new(7.0, 0.0, 0.0),
            resistance: 0.0,
            wall: Vec3::zeros(),
        };
        let (way, velocity) = flight.after(0.5, Vec3::new(2.0, 0.0, 1.0));
        assert!((way - Vec3::new(1.0, 0.0, 0.5 - 9.81 / 8.0)).norm() < 1e-15);
        assert!((velocity - Vec3::new(2.0, 0.0, 1.0 - 9.81 / 2.0)).norm() < 1e-15);
    }

    /// A flight with a force, drag and a resistance.
    fn of_all() -> Flight {
        Flight {
            acceleration: Vec3::new(1.0, -2.0, -9.81),
            rate: 3.7,
            gas: Vec3::new(0.3, 0.1, 2.0),
            resistance: 1.9,
            wall: Vec3::new(-0.4, 0.0, 0.2),
        }
    }

    #[test]
    fn two_halves_are_the_whole() {
        let flight = of_all();
        let start = Vec3::new(-1.0, 0.5, 4.0);
        let (whole, end) = flight.after(0.6, start);
        let (first, middle) = flight.after(0.3, start);
        let (second, last) = flight.after(0.3, middle);
        assert!((first + second - whole).norm() < 1e-15);
        assert!((last - end).norm() < 2e-15);
    }

    #[test]
    fn drag_and_resistance_share_what_they_add_as_their_integrals_do() {
        let flight = of_all();
        let (start, time) = (Vec3::new(-1.0, 0.5, 4.0), 0.6);
        let (way, end) = flight.after(time, start);
        let gained = end - start - flight.acceleration * time;
        let by_wall = flight.resistance * (flight.wall * time - way);
        let by_gas = flight.rate * (flight.gas * time - way);
        assert!((flight.resisted(gained, time) - by_wall).norm() < 1e-14);
        assert!((gained - by_wall - by_gas).norm() < 1e-14);
    }
}
