//! Spheres about a region, found by place.

use std::collections::HashMap;

use calcine_physics::Vec3;

use crate::periodicity::Periodicity;

/// Spheres whose images lie in a region or beside it, in cubes as wide as the largest of them is.
#[derive(Clone, Debug)]
pub(crate) struct Neighbourhood {
    periodicity: Periodicity,
    /// Lowest and highest corner of the region in m.
    region: [Vec3; 2],
    /// Largest radius in m of a sphere that is looked for.
    reach: f64,
    /// Width of the cubes in m.
    width: f64,
    /// Numbers of the spheres in each cube.
    cubes: HashMap<[i64; 3], Vec<usize>>,
    /// Centre in m and radius in m of each sphere.
    spheres: Vec<(Vec3, f64)>,
}

impl Neighbourhood {
    /// Of these spheres, centres and radii in m, those that may touch one of up to a radius in m with its centre in the region.
    pub fn new(
        periodicity: &Periodicity,
        region: [Vec3; 2],
        reach: f64,
        spheres: impl Iterator<Item = (Vec3, f64)> + Clone,
    ) -> Self {
        let radii = spheres.clone().map(|one| one.1);
        let mut made = Self {
            periodicity: *periodicity,
            region,
            reach,
            width: reach + radii.fold(reach, f64::max),
            cubes: HashMap::new(),
            spheres: Vec::new(),
        };
        spheres.for_each(|(place, radius)| made.put(place, radius));
        made
    }

    /// True where spheres of a radius in m may be looked for.
    pub fn reaches(&self, radius: f64) -> bool {
        radius <= self.reach
    }

    /// Puts in a sphere about a place in m, no larger than the largest one, where one of its images may touch what is looked for.
    pub fn put(&mut self, place: Vec3, radius: f64) {
        let number = self.spheres.len();
        let reach = radius + self.reach;
        let [low, high] = self.region;
        let mut met = false;
        for image in self.images(place) {
            let near = (0..3)
                .all(|axis| image[axis] >= low[axis] - reach && image[axis] <= high[axis] + reach);
            if near {
                let cube = self.cube(image);
                self.cubes.entry(cube).or_default().push(number);
                met = true;
            }
        }
        if met {
            self.spheres.push((place, radius));
        }
    }

    /// True where a sphere with its centre in the region overlaps none of those put in.
    pub fn has_room(&self, centre: Vec3, radius: f64) -> bool {
        let middle = self.cube(centre);
        let within = self.periodicity.wrap(centre);
        let offsets = -1..=1;
        let mut cubes = offsets
            .clone()
            .flat_map(|x| offsets.clone().map(move |y| (x, y)))
            .flat_map(|(x, y)| (-1..=1).map(move |z| [x, y, z]));
        cubes.all(|[x, y, z]| {
            let cube = self
                .cubes
                .get(&[middle[0] + x, middle[1] + y, middle[2] + z]);
            let mut numbers = cube.into_iter().flatten();
            numbers.all(|&number| {
                let (place, other) = self.spheres[number];
                let apart = other + radius;
                self.periodicity.shortest(place - within).norm_squared() >= apart * apart
            })
        })
    }

    fn cube(&self, place: Vec3) -> [i64; 3] {
        [0, 1, 2].map(|axis| (place[axis] / self.width).floor() as i64)
    }

    /// A place with its images by one period each way.
    fn images(&self, place: Vec3) -> Vec<Vec3> {
        let mut all = vec![place];
        for (axis, span) in self.periodicity.axes.iter().enumerate() {
            let Some(span) = span else { continue };
            for k in 0..all.len() {
                for period in [-span.length(), span.length()] {
                    let mut image = all[k];
                    image[axis] += period;
                    all.push(image);
                }
            }
        }
        all
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::packing::random::SplitMix64;
    use crate::periodicity::PeriodicSpan;

    #[test]
    fn room_is_where_no_sphere_is_overlapped_in_any_period() {
        let mut random = SplitMix64(11);
        let mut between = |low: f64, high: f64| low + (high - low) * random.unit();
        let span = Some(PeriodicSpan {
            low: 0.0,
            high: 1.0,
        });
        let mut rooms = 0;
        for periodicity in [
            Periodicity::default(),
            Periodicity {
                axes: [span, None, span],
            },
        ] {
            let mut place = |low: f64| Vec3::from_fn(|_, _| between(low, 1.0));
            let places: Vec<Vec3> = (0..300).map(|_| place(0.0)).collect();
            let sphere = |k: usize| (places[k], 0.02 + 0.04 * (k % 5) as f64 / 4.0);
            let region = [Vec3::repeat(0.6), Vec3::repeat(1.0)];
            let spheres = (0..places.len()).map(sphere);
            let found = Neighbourhood::new(&periodicity, region, 0.05, spheres.clone());
            assert!(found.reaches(0.05) && !found.reaches(0.051));
            assert!(
                found.spheres.len() < places.len(),
                "those far away are left out"
            );
            for k in 0..2000 {
                let (centre, radius) = (place(0.6), [0.03, 0.05][k % 2]);
                let within = periodicity.wrap(centre);
                let touches = |(place, other): (Vec3, f64)| {
                    periodicity.shortest(place - within).norm() < other + radius
                };
                let room = !spheres.clone().any(touches);
                assert_eq!(found.has_room(centre, radius), room, "{centre}");
                rooms += usize::from(room);
            }
        }
        assert!((500..3500).contains(&rooms), "{rooms}");
    }
}
