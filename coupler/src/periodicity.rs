//! Directions in which the domain repeats itself: what leaves on one side comes in on the other.
//!
//! Periodic sides are pairs of planes normal to a coordinate axis. A point, a particle or a difference between two
//! places has an image in each period; the one within the domain and the shortest one are meant where nothing else is said.

use calcine_physics::Vec3;

/// The two planes of a periodic direction, normal to its axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PeriodicSpan {
    /// Coordinate of the lower plane in m.
    pub low: f64,
    /// Coordinate of the upper plane in m, above `low`.
    pub high: f64,
}

impl PeriodicSpan {
    /// Distance of the planes in m.
    pub fn length(&self) -> f64 {
        self.high - self.low
    }
}

/// A face of a lower periodic plane and its partner.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PeriodicFace {
    /// Face on the lower plane.
    pub face: usize,
    /// Its partner on the upper plane.
    pub partner: usize,
    /// From the face to its partner, along a coordinate axis, in m.
    pub translation: Vec3,
}

/// Periodic directions of a domain, by axis; none by default.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Periodicity {
    /// The planes of x, y and z.
    pub axes: [Option<PeriodicSpan>; 3],
}

impl Periodicity {
    /// True where no direction is periodic.
    pub fn is_none(&self) -> bool {
        self.axes.iter().all(Option::is_none)
    }

    /// The image of a place that lies within the domain: at or above the lower and below the upper planes.
    #[must_use]
    pub fn wrap(&self, mut place: Vec3) -> Vec3 {
        for (axis, span) in self.axes.iter().enumerate() {
            let Some(span) = span else { continue };
            let periods = ((place[axis] - span.low) / span.length()).floor();
            // Exact where nothing has to be done, so that places within the domain keep their bits.
            if periods != 0.0 {
                place[axis] -= periods * span.length();
                // Round-off of a place just below the lower plane may reach the upper one.
                if place[axis] >= span.high {
                    place[axis] = span.low;
                }
            }
        }
        place
    }

    /// The shortest of the images of a difference between two places.
    #[must_use]
    pub fn shortest(&self, mut difference: Vec3) -> Vec3 {
        for (axis, span) in self.axes.iter().enumerate() {
            let Some(span) = span else { continue };
            let periods = (difference[axis] / span.length()).round();
            if periods != 0.0 {
                difference[axis] -= periods * span.length();
            }
        }
        difference
    }

    /// Translations to the images of a sphere that reach into the domain where the sphere itself, within the domain,
    /// crosses a periodic plane; the sphere itself not among them.
    pub fn images(&self, centre: Vec3, radius: f64) -> impl Iterator<Item = Vec3> + use<> {
        let steps: [[Option<f64>; 3]; 3] = std::array::from_fn(|axis| {
            let none = [Some(0.0), None, None];
            let Some(span) = self.axes[axis] else {
                return none;
            };
            [
                Some(0.0),
                (centre[axis] - radius < span.low).then(|| span.length()),
                (centre[axis] + radius > span.high).then(|| -span.length()),
            ]
        });
        (1..27usize).filter_map(move |image| {
            let step = |axis: usize, index: usize| steps[axis][index % 3];
            Some(Vec3::new(
                step(0, image)?,
                step(1, image / 3)?,
                step(2, image / 9)?,
            ))
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn along_x_and_z() -> Periodicity {
        let span = |low: f64, high: f64| Some(PeriodicSpan { low, high });
        Periodicity {
            axes: [span(-1.0, 1.0), None, span(0.0, 4.0)],
        }
    }

    #[test]
    fn places_within_the_domain_are_kept_and_others_wrapped_into_it() {
        let periodicity = along_x_and_z();
        let inside = Vec3::new(-1.0, 7.0, 3.999);
        assert_eq!(periodicity.wrap(inside), inside);
        let wrapped = periodicity.wrap(Vec3::new(1.0, 7.0, -0.5));
        assert_eq!(wrapped, Vec3::new(-1.0, 7.0, 3.5));
        assert!(periodicity.wrap(Vec3::new(-1.0 - 1e-17, 0.0, -1e-18)).z < 4.0);
    }

    #[test]
    fn the_shortest_difference_crosses_the_planes() {
        let difference = along_x_and_z().shortest(Vec3::new(1.9, 9.0, -3.0));
        assert!((difference - Vec3::new(-0.1, 9.0, 1.0)).norm() < 1e-14);
    }

    #[test]
    fn a_sphere_in_a_corner_has_three_images_and_one_in_the_middle_none() {
        let periodicity = along_x_and_z();
        let images: Vec<_> = periodicity.images(Vec3::new(0.9, 0.0, 0.1), 0.2).collect();
        assert_eq!(images.len(), 3);
        for image in [
            Vec3::new(-2.0, 0.0, 0.0),
            Vec3::new(0.0, 0.0, 4.0),
            Vec3::new(-2.0, 0.0, 4.0),
        ] {
            assert!(images.contains(&image), "{images:?}");
        }
        let middle = periodicity.images(Vec3::new(0.0, 0.0, 2.0), 0.2);
        assert_eq!(middle.count(), 0);
    }
}
