//! Random numbers that are the same on every machine.

/// The generator xoshiro256++ (Blackman and Vigna, ACM Trans. Math. Softw. 47 (2021) 36, doi 10.1145/3460772). Its state can
/// be kept and put back, so that a search goes on with the same bits.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SearchRandom {
    state: [u64; 4],
}

impl SearchRandom {
    /// A generator of a seed, whose bits are spread by an odd multiplier as the authors advise for poor seeds.
    pub fn new(seed: u64) -> Self {
        let mut place = seed;
        let state = std::array::from_fn(|_| {
            place = place.wrapping_add(0x9e37_79b9_7f4a_7c15);
            let mixed = (place ^ (place >> 32)).wrapping_mul(0xd6e8_feb8_6659_fd93);
            let mixed = (mixed ^ (mixed >> 32)).wrapping_mul(0xd6e8_feb8_6659_fd93);
            mixed ^ (mixed >> 32)
        });
        Self { state }
    }

    /// The next 64 bits.
    pub fn bits(&mut self) -> u64 {
        let s = &mut self.state;
        let out = s[0].wrapping_add(s[3]).rotate_left(23).wrapping_add(s[0]);
        let shifted = s[1] << 17;
        s[2] ^= s[0];
        s[3] ^= s[1];
        s[1] ^= s[2];
        s[0] ^= s[3];
        s[2] ^= shifted;
        s[3] = s[3].rotate_left(45);
        out
    }

    /// A number from zero to below one.
    pub fn unit(&mut self) -> f64 {
        // 53 bits, those that a number between zero and one can hold.
        (self.bits() >> 11) as f64 * (1.0 / (1u64 << 53) as f64)
    }

    /// An index below a count above zero.
    pub fn below(&mut self, count: usize) -> usize {
        ((self.unit() * count as f64) as usize).min(count.saturating_sub(1))
    }

    /// A number of the standard normal distribution (Box and Muller 1958, doi 10.1214/aoms/1177706645).
    pub fn normal(&mut self) -> f64 {
        let radius = (-2.0 * (1.0 - self.unit()).ln()).sqrt();
        radius * (std::f64::consts::TAU * self.unit()).cos()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn moments_of_uniform_and_normal_numbers_are_those_of_their_distributions() {
        let mut random = SearchRandom::new(5);
        let count = 200_000;
        let (mut sums, mut places) = ([0.0; 4], [0usize; 7]);
        for _ in 0..count {
            let (u, z) = (random.unit(), random.normal());
            for (sum, term) in sums.iter_mut().zip([u, u * u, z, z * z]) {
                *sum += term / count as f64;
            }
            places[random.below(7)] += 1;
        }
        // Four standard errors, 1/√200000 = 0.0022 times the deviation of each term.
        for (found, (mean, deviation)) in
            sums.iter()
                .zip([(0.5, 0.29), (1.0 / 3.0, 0.3), (0.0, 1.0), (1.0, 1.42)])
        {
            assert!((found - mean).abs() < 0.009 * deviation, "{sums:?}");
        }
        let mean = count as f64 / 7.0;
        assert!(
            places
                .iter()
                .all(|&n| (n as f64 / mean - 1.0).abs() < 0.025)
        );
    }

    #[test]
    fn seeds_give_sequences_of_their_own() {
        let first = |seed| SearchRandom::new(seed).bits();
        let mut all: Vec<u64> = (0..1000).map(first).collect();
        all.sort_unstable();
        all.dedup();
        assert_eq!(all.len(), 1000);
    }
}
