//! Black radiation in a stack that stands for an endless simple cubic array, apart from Calcine: rays by plain
//! random numbers through the lattice of spheres itself, without mirrors, and the linear system of σ T⁴.

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

/// Layers up or down that a ray from a sphere of diameter 1 at the origin goes; the lattice has a sphere at
/// every whole point.
fn layers(random: &mut Random) -> i64 {
    let (normal, other) = (random.direction(), random.direction());
    // Lambert's law: the normal plus a random unit vector.
    let mut way = [0, 1, 2].map(|k| normal[k] + other[k]);
    let length = way.iter().map(|x| x * x).sum::<f64>().sqrt();
    way = way.map(|x| x / length);
    let origin = normal.map(|x| 0.5 * x);
    // Through the unit cells around the lattice points.
    let mut cell = [0i64; 3];
    loop {
        let mut exit = (f64::INFINITY, 0);
        for k in 0..3 {
            let side = cell[k] as f64 + 0.5 * way[k].signum();
            let distance = (side - origin[k]) / way[k];
            if distance < exit.0 {
                exit = (distance, k);
            }
        }
        cell[exit.1] += way[exit.1].signum() as i64;
        let towards = [0, 1, 2].map(|k| cell[k] as f64 - origin[k]);
        let along: f64 = (0..3).map(|k| towards[k] * way[k]).sum();
        let square: f64 = towards.iter().map(|x| x * x).sum();
        if along > 0.0 && square - along * along < 0.25 {
            return cell[2];
        }
    }
}

/// Heat in W through a stack of black spheres of a radius in m between black walls of two temperatures in K,
/// and the temperatures of the spheres in K.
pub fn stack(count: usize, radius: f64, walls: [f64; 2]) -> (f64, Vec<f64>) {
    const RAYS: u32 = 1_000_000;
    const SIGMA: f64 = 5.670_374_419e-8;
    let mut random = Random(11);
    let mut seen = vec![0.0; count + 1];
    for _ in 0..RAYS {
        let away = layers(&mut random).unsigned_abs() as usize;
        seen[away.min(count)] += 1.0 / f64::from(RAYS);
    }
    // Both ways count alike; beyond the stack's end is its wall.
    let one_way = |n: usize| if n == 0 { seen[0] } else { 0.5 * seen[n] };
    let beyond = |n: usize| (n..=count).map(one_way).sum::<f64>();
    let power = walls.map(|kelvin| SIGMA * kelvin.powi(4));
    let mut emitted = vec![0.5 * (power[0] + power[1]); count];
    for _ in 0..100_000 {
        for i in 0..count {
            let others: f64 = (0..count)
                .filter(|j| *j != i)
                .map(|j| one_way(i.abs_diff(j)) * emitted[j])
                .sum();
            let ends = beyond(i + 1) * power[0] + beyond(count - i) * power[1];
            emitted[i] = (others + ends) / (1.0 - one_way(0));
        }
    }
    let surface = 4.0 * PI * radius * radius;
    let from_wall = (0..count).map(|i| surface * beyond(i + 1) * (power[0] - emitted[i]));
    let kelvin = emitted.iter().map(|e| (e / SIGMA).powf(0.25)).collect();
    (from_wall.sum(), kelvin)
}
