//! Collisions of the particles of a bed, counted by their approach.

use calcine_coupler::contacts::{near, pairs_across};
use calcine_coupler::part::ParticleFields;
use calcine_coupler::periodicity::Periodicity;
use calcine_coupler::physics::Vec3;

/// Collisions of particles by pairs of diameters, from what is seen at many moments (docs/theory.md, FLS-8).
///
/// Pairs collide at the rate at which they cross the end of a thin shell about contact: of all pairs whose gap s is below
/// δ (d + d')/2, each adds (−v_n)/s_max where it approaches, v_n being the velocity along the line of centres and s_max the
/// shell's width. No collision is missed, however short it is, and contacts that last do not count.
///
/// Source: the collision rate as a flux through the surface of contact is that of kinetic theory: Chapman and Cowling, The
/// Mathematical Theory of Non-uniform Gases (1970), section 5.2.
#[derive(Clone, Debug, Default)]
pub(super) struct CollisionCount {
    /// Diameters in m to which particles are counted.
    diameters: Vec<f64>,
    /// δ.
    gap: f64,
    /// ∫ Z dt of each pair of diameters, row by row, and ∫ N N' dt and ∫ M dt in s, s and kg s.
    collisions: Vec<f64>,
    pairs: Vec<f64>,
    mass: f64,
    time: f64,
}

impl CollisionCount {
    /// A count that begins.
    pub fn new(diameters: &[f64], gap: f64) -> Self {
        let count = diameters.len();
        Self {
            diameters: diameters.to_vec(),
            gap,
            collisions: vec![0.0; count * count],
            pairs: vec![0.0; count * count],
            mass: 0.0,
            time: 0.0,
        }
    }

    /// The diameter of the table that a particle counts to: the nearest by ratio.
    fn place(&self, diameter: f64) -> usize {
        let apart = |d: &f64| (d / diameter).ln().abs();
        let places = self.diameters.iter().enumerate();
        let nearest = places.min_by(|a, b| apart(a.1).total_cmp(&apart(b.1)));
        nearest.map_or(0, |(place, _)| place)
    }

    /// Adds what is seen over a span of process time in s, with an acceleration factor by which the motion is faster.
    pub fn add(
        &mut self,
        particles: &ParticleFields<'_>,
        periodicity: &Periodicity,
        span: f64,
        acceleration: f64,
    ) {
        let count = self.diameters.len();
        if count == 0 {
            return;
        }
        let places: Vec<usize> = particles
            .radius
            .iter()
            .map(|radius| self.place(2.0 * radius))
            .collect();
        let mut numbers = vec![0.0; count];
        for (row, place) in places.iter().enumerate() {
            numbers[*place] += particles.weight_of(row);
            self.mass += span * particles.row_mass(row);
        }
        self.time += span;
        for (one, other) in (0..count).flat_map(|one| (0..count).map(move |other| (one, other))) {
            self.pairs[one * count + other] += span * numbers[one] * numbers[other];
        }
        let (radii, centres) = (particles.radius, particles.position);
        let widest = self.gap * 2.0 * radii.iter().copied().fold(0.0, f64::max);
        let within = near(radii, centres, widest).into_iter();
        let within = within.map(|pair| (pair, Vec3::zeros()));
        for ([a, b], image) in within.chain(pairs_across(periodicity, radii, centres, widest)) {
            let (a, b) = (a as usize, b as usize);
            let touch = radii[a] + radii[b];
            let way = centres[b] + image - centres[a];
            let (apart, reach) = (way.norm() - touch, self.gap * touch);
            let speed = (particles.velocity[b] - particles.velocity[a]).dot(&way) / way.norm();
            if speed >= 0.0 || apart <= 0.0 || apart >= reach {
                continue;
            }
            // Weighted particles meet as often as the real ones that they stand for.
            let weight = particles.weight_of(a) * particles.weight_of(b);
            let rate = -speed / reach / acceleration * weight;
            let (one, other) = (places[a], places[b]);
            self.collisions[one * count + other] += span * rate;
            self.collisions[other * count + one] += span * rate;
        }
    }

    /// K = β M in kg/s of each pair, row by row, over all that was added, where ½ Σ Σ β N N' pairs collide in a second; zero
    /// where there were no pairs. The count begins again.
    pub fn take(&mut self) -> Vec<f64> {
        let mass = if self.time > 0.0 {
            self.mass / self.time
        } else {
            0.0
        };
        let pairs = self.collisions.iter().zip(&self.pairs);
        let kernel = pairs.map(|(hits, pairs)| match *pairs > 0.0 {
            true => mass * hits / pairs,
            false => 0.0,
        });
        let kernel = kernel.collect();
        *self = Self::new(&std::mem::take(&mut self.diameters), self.gap);
        kernel
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::PI;

    use super::*;

    /// Vigna's generator, in [0, 1).
    struct SplitMix64(u64);

    impl SplitMix64 {
        fn unit(&mut self) -> f64 {
            self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
            let mut z = self.0;
            z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
            z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
            ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 53) as f64
        }
    }

    /// Normal numbers by Box and Muller.
    fn normal(random: &mut SplitMix64) -> f64 {
        let (u, v): (f64, f64) = (1.0 - random.unit(), random.unit());
        (-2.0 * u.ln()).sqrt() * (2.0 * PI * v).cos()
    }

    /// Probability that two points of a unit cube are apart by less than r, for r < 1.
    fn nearer(r: f64) -> f64 {
        4.0 / 3.0 * PI * r.powi(3) - 1.5 * PI * r.powi(4) + 1.6 * r.powi(5) - r.powi(6) / 6.0
    }

    /// Two sizes of points in a unit cube that ignore each other, at Maxwell's velocities. Through a shell of kinetic theory
    /// particles approach at w/√(2π), w² = σ² + σ'²; for a thin one far from walls that is its β = π d² √(8/π) w/V.
    #[test]
    fn a_dilute_gas_collides_as_kinetic_theory_says() {
        let (count, gap, acceleration) = (1500, 0.05, 4.0);
        let (radii, speeds, mass) = ([0.03, 0.06], [0.8, 0.3], [2.0, 3.0]);
        let mut random = SplitMix64(5);
        let mut counted = CollisionCount::new(&[0.06, 0.12], gap);
        for _ in 0..40 {
            let mut one = Made::default();
            for k in 0..2 * count {
                let kind = k % 2;
                let at = [random.unit(), random.unit(), random.unit()];
                one.position.push(Vec3::from(at));
                let speed = [0; 3].map(|_| speeds[kind] * normal(&mut random));
                one.velocity.push(Vec3::from(speed));
                one.radius.push(radii[kind]);
                one.mass.push(mass[kind]);
            }
            counted.add(&one.fields(), &Periodicity::default(), 0.25, acceleration);
        }
        let kernel = counted.take();
        let held = count as f64 * (mass[0] + mass[1]);
        for (one, other) in [(0, 0), (0, 1), (1, 1)] {
            let d: f64 = radii[one] + radii[other];
            let wide = (speeds[one].powi(2) + speeds[other].powi(2)).sqrt();
            let inside = nearer(d * (1.0 + gap)) - nearer(d);
            let beta = inside / (gap * d) * wide / (2.0 * PI).sqrt() / acceleration;
            let found = kernel[2 * one + other] / held;
            assert!(
                (found / beta - 1.0).abs() < 0.04,
                "{one} {other}: {found} {beta}"
            );
            let theory = PI * d * d * (8.0 / PI).sqrt() * wide / acceleration;
            // A shell of 5 % is 5 % larger than the surface of contact, and walls cut it.
            assert!(
                (found / theory - 1.0).abs() < 0.15,
                "{one} {other}: {found} {theory}"
            );
            assert_eq!(kernel[2 * one + other], kernel[2 * other + one]);
        }
        assert!(counted.take().iter().all(|k| *k == 0.0));
    }

    #[derive(Default)]
    struct Made {
        position: Vec<Vec3>,
        velocity: Vec<Vec3>,
        radius: Vec<f64>,
        mass: Vec<f64>,
    }

    impl Made {
        fn fields(&self) -> ParticleFields<'_> {
            ParticleFields {
                id: &[],
                population: &[],
                position: &self.position,
                velocity: &self.velocity,
                angular_velocity: &[],
                radius: &self.radius,
                mass: &self.mass,
                weight: &[],
            }
        }
    }
}
