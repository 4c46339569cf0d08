//! How children differ from their parents.

use crate::random::SearchRandom;

/// How children differ from their parents.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct VariationSettings {
    /// Probability that a pair is crossed.
    pub crossover: f64,
    /// Index η of the crossover: the larger, the nearer children are to their parents.
    pub crossover_index: f64,
    /// Probability that a gene mutates, times the number of genes.
    pub mutations: f64,
    /// Index η of the mutation.
    pub mutation_index: f64,
}

impl Default for VariationSettings {
    /// Those of Deb et al. 2002, section V: 0.9, 20, one gene a child, 20.
    fn default() -> Self {
        Self {
            crossover: 0.9,
            crossover_index: 20.0,
            mutations: 1.0,
            mutation_index: 20.0,
        }
    }
}

/// Genes nearer than this count as equal.
const SAME: f64 = 1e-14;

/// Simulated binary crossover within zero to one (Deb and Agrawal, Complex Systems 9 (1995) 115; bounds as in Deb's own
/// program, where children of a bounded gene follow the distribution cut off at the bounds).
pub(super) fn cross(
    parents: [&Vec<f64>; 2],
    settings: &VariationSettings,
    random: &mut SearchRandom,
) -> [Vec<f64>; 2] {
    let mut children = [parents[0].clone(), parents[1].clone()];
    if random.unit() >= settings.crossover {
        return children;
    }
    let [first, second] = &mut children;
    for (a, b) in first.iter_mut().zip(second) {
        if random.unit() >= 0.5 || (*a - *b).abs() < SAME {
            continue;
        }
        let (low, high) = (a.min(*b), a.max(*b));
        let chance = random.unit();
        let spread = |room: f64| {
            let power = settings.crossover_index + 1.0;
            let beta = 1.0 + 2.0 * room / (high - low);
            let alpha = 2.0 - beta.powf(-power);
            if chance <= 1.0 / alpha {
                (chance * alpha).powf(1.0 / power)
            } else {
                (1.0 / (2.0 - chance * alpha)).powf(1.0 / power)
            }
        };
        let near = 0.5 * (low + high - spread(low) * (high - low));
        let far = 0.5 * (low + high + spread(1.0 - high) * (high - low));
        // Round-off alone can leave the bounds.
        let (near, far) = (near.clamp(0.0, 1.0), far.clamp(0.0, 1.0));
        (*a, *b) = match random.unit() < 0.5 {
            true => (far, near),
            false => (near, far),
        };
    }
    children
}

/// Polynomial mutation within zero to one (Deb and Goyal, Comput. Sci. Inform. 26 (1996) 30).
pub(super) fn mutate(
    child: &mut [f64],
    settings: &VariationSettings,
    genes: usize,
    random: &mut SearchRandom,
) {
    let power = settings.mutation_index + 1.0;
    for gene in child {
        if random.unit() >= settings.mutations / genes as f64 {
            continue;
        }
        let chance = random.unit();
        let change = if chance < 0.5 {
            let rest = (1.0 - *gene).powf(power);
            (2.0 * chance + (1.0 - 2.0 * chance) * rest).powf(1.0 / power) - 1.0
        } else {
            let rest = gene.powf(power);
            1.0 - (2.0 * (1.0 - chance) + (2.0 * chance - 1.0) * rest).powf(1.0 / power)
        };
        *gene = (*gene + change).clamp(0.0, 1.0);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn children_stay_within_bounds_and_have_the_mean_of_their_parents() {
        let mut random = SearchRandom::new(1);
        let settings = VariationSettings {
            crossover: 1.0,
            ..VariationSettings::default()
        };
        let (a, b) = (vec![0.4; 4], vec![0.6; 4]);
        let (mut mean, count) = (0.0, 20_000);
        for _ in 0..count {
            let [first, second] = cross([&a, &b], &settings, &mut random);
            for (x, y) in first.iter().zip(&second) {
                assert!((0.0..=1.0).contains(x) && (0.0..=1.0).contains(y));
                // Far from the bounds both sides have one spread.
                mean += (x + y) / (8.0 * f64::from(count));
            }
        }
        assert!((mean - 0.5).abs() < 1e-3, "{mean}");
    }

    #[test]
    fn mutations_are_small_by_their_index_and_stay_within_bounds() {
        let mut random = SearchRandom::new(2);
        let settings = VariationSettings {
            mutations: 1.0,
            ..VariationSettings::default()
        };
        let (mut moved, count) = (0.0, 50_000);
        for _ in 0..count {
            let mut child = [0.5];
            mutate(&mut child, &settings, 1, &mut random);
            assert!((0.0..=1.0).contains(&child[0]));
            moved += (child[0] - 0.5).abs() / f64::from(count);
        }
        // The mean of 1 − (2 c)^(1/(η + 1)) over c from 0 to ½ is 1/(η + 2); the bounds are too far to matter.
        assert!((moved * 22.0 - 1.0).abs() < 0.02, "{moved}");
    }
}
