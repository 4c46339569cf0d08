//! Radiation and conduction in a stack that stands for an endless simple cubic array, apart from Calcine: rays by plain
//! random numbers through the lattice of spheres itself, without mirrors, and the balances of heat.

use std::f64::consts::PI;

/// Numbers in [0, 1) of a linear congruential generator (Knuth's MMIX constants).
struct Random(u64);

impl Random {
    fn next(&mut self) -> f64 {
        self.0 = self
            .0
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1u64 << 53) as f64
    }

    fn direction(&mut self) -> [f64; 3] {
        let (z, turn) = (2.0 * self.next() - 1.0, 2.0 * PI * self.next());
        let across = (1.0 - z * z).sqrt();
        [across * turn.cos(), across * turn.sin(), z]
    }
}

const SIGMA: f64 = 5.670_374_419e-8;
/// Rays of each sphere.
const RAYS: u32 = 200_000;

/// A stack of grey spheres between two grey walls.
pub struct Stack {
    /// Number of spheres.
    pub count: usize,
    /// Their radius in m.
    pub radius: f64,
    /// Emissivity of spheres and walls.
    pub emissivity: f64,
    /// Conductance in W/K between two spheres, and between a sphere and a wall.
    pub conductance: [f64; 2],
}

impl Stack {
    /// Where a ray ends that a sphere sends out: the layer that absorbs it, `count` for the wall below the first
    /// layer, `count + 1` for the other. What is not absorbed is reflected where it hits, by Lambert's law. The
    /// lattice has spheres of diameter 1 at every whole point.
    fn end(&self, layer: usize, random: &mut Random) -> usize {
        let (mut cell, last) = ([0, 0, layer as i64], self.count as i64 - 1);
        let mut normal = random.direction();
        let mut at = normal.map(|x| 0.5 * x);
        at[2] += layer as f64;
        loop {
            let other = random.direction();
            // Lambert's law: the normal plus a random unit vector.
            let way = [0, 1, 2].map(|k| normal[k] + other[k]);
            let length = way.iter().map(|x| x * x).sum::<f64>().sqrt();
            let way = way.map(|x| x / length);
            // Through the unit cells around the lattice points, the first without its own sphere if it starts there.
            let wall = loop {
                let mut exit = (f64::INFINITY, 0);
                for k in 0..3 {
                    let side = cell[k] as f64 + 0.5 * way[k].signum();
                    let distance = (side - at[k]) / way[k];
                    if distance < exit.0 {
                        exit = (distance, k);
                    }
                }
                let next = cell[exit.1] + way[exit.1].signum() as i64;
                if exit.1 == 2 && !(0..=last).contains(&next) {
                    at = [0, 1, 2].map(|k| at[k] + exit.0 * way[k]);
                    normal = [0.0, 0.0, if next < 0 { 1.0 } else { -1.0 }];
                    break Some(if next < 0 { self.count } else { self.count + 1 });
                }
                cell[exit.1] = next;
                if let Some(distance) = meets(cell, at, way) {
                    at = [0, 1, 2].map(|k| at[k] + distance * way[k]);
                    normal = [0, 1, 2].map(|k| 2.0 * (at[k] - cell[k] as f64));
                    break None;
                }
            };
            if random.next() < self.emissivity {
                return wall.unwrap_or(cell[2] as usize);
            }
            // From a wall the ray starts in the cell beside it, whose sphere it may meet.
            if wall.is_some() {
                cell[2] += if normal[2] > 0.0 { -1 } else { 1 };
            }
        }
    }

    /// Heat in W from the first wall, and the temperatures of the spheres in K, when it is steady. From wall to wall
    /// nothing is counted: the stack is many layers high.
    pub fn steady(&self, walls: [f64; 2]) -> (f64, Vec<f64>) {
        let count = self.count;
        let mut random = Random(11);
        let mut share = vec![vec![0.0; count + 2]; count];
        for (layer, ends) in share.iter_mut().enumerate() {
            for _ in 0..RAYS {
                ends[self.end(layer, &mut random)] += 1.0 / f64::from(RAYS);
            }
        }
        let black = 4.0 * PI * self.radius * self.radius * self.emissivity * SIGMA;
        // Reciprocity: what both ways say.
        let between = |i: usize, j: usize| match j < count {
            true => 0.5 * black * (share[i][j] + share[j][i]),
            false => black * share[i][j],
        };
        let touch = |i: usize, j: usize| match j {
            _ if j < count => f64::from(u8::from(i.abs_diff(j) == 1)) * self.conductance[0],
            _ if j == count => f64::from(u8::from(i == 0)) * self.conductance[1],
            _ => f64::from(u8::from(i + 1 == count)) * self.conductance[1],
        };
        let mut kelvin = vec![0.5 * (walls[0] + walls[1]); count];
        kelvin.extend(walls);
        // Conductance of both, by T_i⁴ − T_j⁴ = (T_i² + T_j²)(T_i + T_j)(T_i − T_j).
        let conducts = |i: usize, j: usize, t: &[f64]| {
            between(i, j) * (t[i] * t[i] + t[j] * t[j]) * (t[i] + t[j]) + touch(i, j)
        };
        for _ in 0..20_000 {
            for i in 0..count {
                let (mut pull, mut sum) = (0.0, 0.0);
                for j in (0..count + 2).filter(|j| *j != i) {
                    let one = conducts(i, j, &kelvin);
                    pull += one * kelvin[j];
                    sum += one;
                }
                kelvin[i] = pull / sum;
            }
        }
        let from_wall = |i: usize| conducts(i, count, &kelvin) * (kelvin[count] - kelvin[i]);
        let heat = (0..count).map(from_wall).sum();
        kelvin.truncate(count);
        (heat, kelvin)
    }
}

/// Way of a ray to the sphere around a lattice point, if it meets it ahead.
fn meets(cell: [i64; 3], at: [f64; 3], way: [f64; 3]) -> Option<f64> {
    let towards = [0, 1, 2].map(|k| cell[k] as f64 - at[k]);
    let along: f64 = (0..3).map(|k| towards[k] * way[k]).sum();
    let square: f64 = towards.iter().map(|x| x * x).sum();
    let under = 0.25 - (square - along * along);
    (along > 0.0 && under > 0.0).then(|| along - under.sqrt())
}
