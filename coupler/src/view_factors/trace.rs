//! The first sphere on a ray, by a grid of cells.

use calcine_physics::Vec3;

/// Spheres in cells; each is listed in every cell that its box touches.
#[derive(Debug)]
pub struct SphereGrid<'a> {
    radii: &'a [f64],
    centres: &'a [Vec3],
    low: Vec3,
    high: Vec3,
    size: Vec3,
    count: [usize; 3],
    start: Vec<u32>,
    list: Vec<u32>,
}

impl<'a> SphereGrid<'a> {
    /// Cells of about the largest diameter.
    pub fn new(radii: &'a [f64], centres: &'a [Vec3]) -> Self {
        let (mut low, mut high) = (Vec3::repeat(f64::MAX), Vec3::repeat(f64::MIN));
        for (centre, radius) in centres.iter().zip(radii) {
            low = low.inf(&centre.add_scalar(-radius));
            high = high.sup(&centre.add_scalar(*radius));
        }
        let largest = 2.0 * radii.iter().copied().fold(0.0, f64::max);
        let most = 4.0 * centres.len() as f64 + 64.0;
        let extent = high - low;
        // Wide beds of few spheres get larger cells.
        let mut width = largest
            .max((extent.x * extent.y * extent.z / most).cbrt())
            .max(1e-9 * extent.max());
        let counts = |width: f64| [0, 1, 2].map(|axis| ((extent[axis] / width) as usize).max(1));
        let cells = |count: [usize; 3]| count.iter().map(|&one| one as f64).product::<f64>();
        // Flat beds have a layer of cells, whatever their volume.
        while cells(counts(width)) > 2.0 * most {
            width *= 1.25;
        }
        let count = counts(width);
        let size = Vec3::from([0, 1, 2].map(|axis| extent[axis] / count[axis] as f64));
        let mut grid = Self {
            radii,
            centres,
            low,
            high,
            size,
            count,
            start: vec![0; count[0] * count[1] * count[2] + 1],
            list: Vec::new(),
        };
        for sphere in 0..centres.len() {
            let ends = grid.ends(sphere);
            each(ends, |cell| {
                let index = grid.index(cell);
                grid.start[index + 1] += 1;
            });
        }
        for k in 1..grid.start.len() {
            grid.start[k] += grid.start[k - 1];
        }
        let mut next = grid.start.clone();
        grid.list = vec![0; grid.start[grid.start.len() - 1] as usize];
        for sphere in 0..centres.len() {
            let ends = grid.ends(sphere);
            each(ends, |cell| {
                let slot = &mut next[grid.index(cell)];
                grid.list[*slot as usize] = sphere as u32;
                *slot += 1;
            });
        }
        grid
    }

    fn index(&self, [i, j, k]: [usize; 3]) -> usize {
        i + self.count[0] * (j + self.count[1] * k)
    }

    fn cell(&self, point: Vec3) -> [usize; 3] {
        [0, 1, 2].map(|axis| {
            let place = (point[axis] - self.low[axis]) / self.size[axis];
            (place.max(0.0) as usize).min(self.count[axis] - 1)
        })
    }

    fn ends(&self, sphere: usize) -> [[usize; 3]; 2] {
        let (centre, radius) = (self.centres[sphere], self.radii[sphere]);
        [
            self.cell(centre.add_scalar(-radius)),
            self.cell(centre.add_scalar(radius)),
        ]
    }

    /// Distance in m and index of the first sphere on a ray from a point along a unit vector, up to a
    /// distance in m; one sphere may be left out. A ray that begins inside a sphere meets it at once.
    #[inline(always)]
    pub fn first(
        &self,
        origin: Vec3,
        way: Vec3,
        within: f64,
        but: Option<usize>,
    ) -> Option<(f64, usize)> {
        // Where the ray enters the box, and leaves it.
        let (mut enter, mut leave) = (0.0_f64, within);
        for axis in 0..3 {
            if way[axis] == 0.0 {
                if !(self.low[axis]..=self.high[axis]).contains(&origin[axis]) {
                    return None;
                }
                continue;
            }
            let ends =
                [self.low[axis], self.high[axis]].map(|side| (side - origin[axis]) / way[axis]);
            enter = enter.max(ends[0].min(ends[1]));
            leave = leave.min(ends[0].max(ends[1]));
        }
        if enter > leave {
            return None;
        }
        let mut cell = self.cell(origin + enter * way);
        let mut best: Option<(f64, usize)> = None;
        loop {
            let index = self.index(cell);
            let spheres = &self.list[self.start[index] as usize..self.start[index + 1] as usize];
            for &sphere in spheres {
                let sphere = sphere as usize;
                if but == Some(sphere) {
                    continue;
                }
                if let Some(distance) =
                    meets(self.centres[sphere] - origin, self.radii[sphere], way)
                    && distance <= within
                    && best.is_none_or(|found| distance < found.0)
                {
                    best = Some((distance, sphere));
                }
            }
            // The next side of the cell on the way.
            let (mut exit, mut side) = (f64::INFINITY, 0);
            for axis in 0..3 {
                if way[axis] == 0.0 {
                    continue;
                }
                let ahead = cell[axis] + usize::from(way[axis] > 0.0);
                let plane = self.low[axis] + ahead as f64 * self.size[axis];
                let distance = (plane - origin[axis]) / way[axis];
                if distance < exit {
                    (exit, side) = (distance, axis);
                }
            }
            if best.is_some_and(|found| found.0 <= exit) || exit >= leave {
                return best;
            }
            if way[side] > 0.0 {
                cell[side] += 1;
                if cell[side] == self.count[side] {
                    return best;
                }
            } else if cell[side] == 0 {
                return best;
            } else {
                cell[side] -= 1;
            }
        }
    }
}

/// Distance at which a ray along a unit vector enters a sphere whose centre is at `towards` from its
/// origin; zero inside it.
#[inline]
pub fn meets(towards: Vec3, radius: f64, way: Vec3) -> Option<f64> {
    let outside = towards.norm_squared() - radius * radius;
    if outside < 0.0 {
        return Some(0.0);
    }
    let along = towards.dot(&way);
    let root = along * along - outside;
    (along > 0.0 && root > 0.0).then(|| along - root.sqrt())
}

fn each([low, high]: [[usize; 3]; 2], mut f: impl FnMut([usize; 3])) {
    for k in low[2]..=high[2] {
        for j in low[1]..=high[1] {
            for i in low[0]..=high[0] {
                f([i, j, k]);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::packing::random::SplitMix64;

    #[test]
    fn the_grid_finds_the_sphere_that_the_search_over_all_finds() {
        let mut random = SplitMix64(3);
        for count in [1, 2, 30, 300] {
            let mut place = || Vec3::new(random.unit(), 2.0 * random.unit(), 0.3 * random.unit());
            let centres: Vec<Vec3> = (0..count).map(|_| place()).collect();
            let radii: Vec<f64> = (0..count).map(|k| 0.01 + 0.002 * (k % 7) as f64).collect();
            let grid = SphereGrid::new(&radii, &centres);
            for ray in 0..300 {
                let origin = 1.5 * place() - Vec3::repeat(0.2);
                let mut way = place() - Vec3::new(0.5, 1.0, 0.15);
                if ray % 10 == 0 {
                    way = Vec3::y();
                }
                let way = way.normalize();
                let all = centres.iter().zip(&radii).enumerate();
                let hits = all.filter_map(|(k, (c, r))| Some((meets(c - origin, *r, way)?, k)));
                let first = hits.min_by(|a, b| a.0.total_cmp(&b.0));
                let found = grid.first(origin, way, 10.0, None);
                assert_eq!(found.map(|hit| hit.0), first.map(|hit| hit.0));
                if let Some((distance, sphere)) = first {
                    let next = grid.first(origin, way, 10.0, Some(sphere));
                    assert!(next.is_none_or(|hit| hit.0 >= distance && hit.1 != sphere));
                    assert!(
                        grid.first(origin, way, 0.5 * distance, None).is_none() || distance == 0.0
                    );
                }
            }
        }
    }
}
