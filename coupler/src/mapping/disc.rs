//! What a plane polygon has inside and outside a sphere, seen from the sphere's centre.

use std::f64::consts::TAU;

use nalgebra::Vector2;

/// A place in a plane in m.
pub(super) type Point = Vector2<f64>;

/// A plane seen from the sphere's centre. Places in it count from the centre's foot.
pub(super) struct Plane {
    /// Signed height h of the plane over the centre in m.
    height: f64,
    radius: f64,
    /// ρ² in m²; not positive where the sphere does not reach the plane.
    disc: f64,
}

/// A sum of angles, each in (−π, π], as the argument of a product of complex numbers, so that one arctangent does
/// for all of them.
struct Turns {
    re: f64,
    im: f64,
    /// How often the product's argument has passed π.
    whole: f64,
}

impl Turns {
    const NONE: Self = Self {
        re: 1.0,
        im: 0.0,
        whole: 0.0,
    };

    /// Adds the angle between the first axis and (re, im), of any length but none.
    fn add(&mut self, re: f64, im: f64) {
        let product = (self.re * re - self.im * im, self.re * im + self.im * re);
        if (self.im >= 0.0) == (im >= 0.0) && (product.1 >= 0.0) != (im >= 0.0) {
            self.whole += if im >= 0.0 { 1.0 } else { -1.0 };
        }
        // Neither many nor long factors leave the range of numbers.
        let scale = 1.0 / (product.0.abs() + product.1.abs());
        (self.re, self.im) = (product.0 * scale, product.1 * scale);
    }

    fn sum(&self) -> f64 {
        if self.im == 0.0 && self.re > 0.0 {
            return TAU * self.whole;
        }
        self.im.atan2(self.re) + TAU * self.whole
    }
}

/// Sums over a polygon's edges of what the triangles (foot, edge) have in the disc.
struct Sums {
    /// Twice the area in m² of triangles whose edges lie in the disc.
    triangles: f64,
    /// Half the solid angle of these.
    seen: Turns,
    /// Angle of the disc's sectors before edges beyond it.
    sectors: Turns,
    /// Half the solid angle of the triangles whose edges lie beyond the disc.
    beyond: Turns,
}

impl Plane {
    pub fn new(height: f64, radius: f64) -> Self {
        Self {
            height,
            radius,
            disc: (radius - height) * (radius + height),
        }
    }

    /// Square of the radius in m² of the disc that the sphere cuts from the plane; not positive where it cuts none.
    pub fn disc(&self) -> f64 {
        self.disc
    }

    /// h/3 · area(F ∩ D) − sign(h) R³/3 · Ω(F ∩ D) in m³ of a polygon F with these corners and this foot.
    pub fn inside(&self, corners: &[Point], foot: Point) -> f64 {
        let (area, angle) = self.in_disc(corners, foot);
        self.volume(area, -angle)
    }

    /// h/3 · area(F ∩ D) + sign(h) R³/3 · Ω(F ∖ D) in m³: the cone's part in the sphere.
    pub fn cone(&self, corners: &[Point], foot: Point) -> f64 {
        let sums = self.sums(corners, foot);
        let (sectors, beyond) = (sums.sectors.sum(), 2.0 * sums.beyond.sum());
        // Without the triangles in the disc: their angles are ill-conditioned where the centre lies next to a corner.
        let angle = beyond - sectors * (1.0 - self.height.abs() / self.radius);
        if self.disc <= 0.0 {
            return self.volume(0.0, beyond);
        }
        self.volume(self.area(&sums, sectors), angle)
    }

    fn volume(&self, area: f64, angle: f64) -> f64 {
        (self.height * area + self.radius.powi(3) * self.height.signum() * angle) / 3.0
    }

    /// Area in m² and solid angle of F ∩ D. A sector has ρ²/2 · θ and θ (1 − h/R).
    fn in_disc(&self, corners: &[Point], foot: Point) -> (f64, f64) {
        if self.disc <= 0.0 {
            return (0.0, 0.0);
        }
        let sums = self.sums(corners, foot);
        let sectors = sums.sectors.sum();
        let angle = 2.0 * sums.seen.sum() + sectors * (1.0 - self.height.abs() / self.radius);
        (self.area(&sums, sectors), angle)
    }

    fn area(&self, sums: &Sums, sectors: f64) -> f64 {
        0.5 * (sums.triangles + self.disc * sectors)
    }

    fn sums(&self, corners: &[Point], foot: Point) -> Sums {
        let mut sums = Sums {
            triangles: 0.0,
            seen: Turns::NONE,
            sectors: Turns::NONE,
            beyond: Turns::NONE,
        };
        edges(corners, foot, |a, b| self.edge(a, b, &mut sums));
        sums
    }

    /// Adds an edge from `a` to `b`: the stretch that lies in the disc, and those before and after it.
    fn edge(&self, a: Point, b: Point, sums: &mut Sums) {
        let along = b - a;
        let (square, slope) = (along.norm_squared(), a.dot(&along));
        let root = slope * slope - square * (a.norm_squared() - self.disc);
        if square == 0.0 || root <= 0.0 {
            return self.sector(a, b, sums);
        }
        let root = root.sqrt();
        let enter = ((-slope - root) / square).clamp(0.0, 1.0);
        let leave = ((-slope + root) / square).clamp(0.0, 1.0);
        let (p, q) = (a + along * enter, a + along * leave);
        sums.triangles += p.perp(&q);
        self.triangle(p, q, &mut sums.seen);
        // An edge that ends in the disc has no stretch beyond it.
        if enter > 0.0 {
            self.sector(a, p, sums);
        }
        if leave < 1.0 {
            self.sector(q, b, sums);
        }
    }

    /// Adds the stretch of an edge that lies beyond the disc.
    fn sector(&self, p: Point, q: Point, sums: &mut Sums) {
        let turn = p.perp(&q);
        if turn != 0.0 {
            sums.sectors.add(p.dot(&q), turn);
            self.triangle(p, q, &mut sums.beyond);
        }
    }

    /// Half the solid angle of the triangle (foot, p, q). Van Oosterom and Strackee, doi:10.1109/TBME.1983.325207,
    /// with one corner at the foot.
    fn triangle(&self, p: Point, q: Point, sum: &mut Turns) {
        let turn = p.perp(&q);
        if turn == 0.0 {
            return;
        }
        let height = self.height.abs();
        let far = |p: Point| (height * height + p.norm_squared()).sqrt();
        let (far_p, far_q) = (far(p), far(q));
        let along = far_p * far_q + height * (far_p + far_q + height) + p.dot(&q);
        sum.add(along, turn);
    }
}

/// Calls with the ends of each edge, from the foot.
fn edges(corners: &[Point], foot: Point, mut edge: impl FnMut(Point, Point)) {
    let Some(last) = corners.last() else {
        return;
    };
    let mut from = last - foot;
    for corner in corners {
        let to = corner - foot;
        edge(from, to);
        from = to;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::packing::random::SplitMix64;
    use std::f64::consts::PI;

    #[test]
    fn turns_sum_to_what_their_arctangents_sum_to() {
        // Angles of all sizes and both signs, lengths from 1e-9 to 1e9.
        let mut random = SplitMix64(1);
        for _ in 0..2000 {
            let mut turns = Turns::NONE;
            let mut sum = 0.0;
            for _ in 0..12 {
                let angle = TAU * (random.unit() - 0.5);
                let length = 10f64.powf(18.0 * random.unit() - 9.0);
                let (re, im) = (length * angle.cos(), length * angle.sin());
                turns.add(re, im);
                sum += im.atan2(re);
                assert!((turns.sum() - sum).abs() < 1e-14, "{} {sum}", turns.sum());
            }
        }
        let mut straight = Turns::NONE;
        straight.add(-1.0, 0.0);
        assert_eq!(straight.sum(), PI);
        straight.add(0.0, 1.0);
        assert!((straight.sum() - 1.5 * PI).abs() < 1e-15);
    }

    #[test]
    fn a_square_around_the_disc_has_all_of_it_and_one_within_sees_its_own_angle() {
        let square = |half: f64| {
            [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)]
                .map(|(x, y)| Point::new(x * half, y * half))
        };
        let plane = Plane::new(0.6, 1.0);
        // Disc of radius 0.8; the sphere's cap over it is seen as 2 pi (1 - 0.6).
        let (area, angle) = plane.in_disc(&square(2.0), Point::zeros());
        assert!((area - 0.64 * PI).abs() < 1e-15 && (angle - 0.8 * PI).abs() < 1e-15);
        // A square of side 2a at height h is seen as 4 asin(a^2/(a^2 + h^2)).
        let (area, angle) = plane.in_disc(&square(0.5), Point::zeros());
        let exact = 4.0 * (0.25f64 / 0.61).asin();
        assert!((area - 1.0).abs() < 1e-15 && (angle - exact).abs() < 1e-15);
        // Far beside the disc there is nothing, however the sectors turn.
        let (area, angle) = plane.in_disc(&square(0.5), Point::new(3.0, 0.2));
        assert!(area.abs() < 1e-15 && angle.abs() < 1e-15);
    }
}
