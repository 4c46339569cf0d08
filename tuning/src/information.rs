//! Comparison of models that were fitted to the same data.

/// Akaike's criterion with the correction for few data, of a fit with a deviance D = Σ n ln(S/n) over n values, k parameters
/// and one more for the size of the errors of each objective: D + 2 k + 2 k (k + 1)/(n − k − 1). The smaller, the better.
///
/// Sources: Akaike, IEEE Trans. Autom. Control 19 (1974) 716, doi 10.1109/TAC.1974.1100705; Hurvich and Tsai, Biometrika 76
/// (1989) 297, doi 10.1093/biomet/76.2.297.
pub fn akaike(deviance: f64, values: usize, parameters: usize) -> f64 {
    let (n, k) = (values as f64, parameters as f64);
    deviance + 2.0 * k + 2.0 * k * (k + 1.0) / (n - k - 1.0)
}

/// Weights exp(−Δ/2) of criteria, relative to their sum.
pub fn akaike_weights(criteria: &[f64]) -> Vec<f64> {
    let least = criteria.iter().copied().fold(f64::INFINITY, f64::min);
    let weights: Vec<f64> = criteria
        .iter()
        .map(|one| (-0.5 * (one - least)).exp())
        .collect();
    let sum: f64 = weights.iter().sum();
    weights.iter().map(|one| one / sum).collect()
}

/// By how much a criterion has to be lower for a law with more numbers of its own to be taken in place of a simpler one. A
/// law that contains another is always lower in deviance; by 8 (6 and the 2 of its number) it is by chance alone in 0.5 % of
/// sets.
pub const PARSIMONY: f64 = 6.0;

/// Which of several fits is chosen: the one with the least criterion, unless one with fewer parameters comes within
/// [`PARSIMONY`] of it; of such the one with the fewest, then the least criterion. `None` of none.
pub fn choose(fits: &[(f64, usize)]) -> Option<usize> {
    let least = fits.iter().map(|fit| fit.0).fold(f64::INFINITY, f64::min);
    let near = (0..fits.len()).filter(|&k| fits[k].0 <= least + PARSIMONY);
    near.min_by(|&a, &b| {
        let ((first, few), (second, many)) = (fits[a], fits[b]);
        few.cmp(&many).then(first.total_cmp(&second))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_parameter_costs_two_and_more_with_few_data() {
        assert!((akaike(10.0, 1_000_000, 4) - akaike(10.0, 1_000_000, 3) - 2.0).abs() < 1e-4);
        // 2·3 + 2·3·4/(10 − 3 − 1).
        assert_eq!(akaike(10.0, 10, 3), 20.0);
    }

    #[test]
    fn weights_add_up_and_fall_by_e_for_each_two() {
        let weights = akaike_weights(&[100.0, 102.0, 104.0]);
        assert!((weights.iter().sum::<f64>() - 1.0).abs() < 1e-15);
        assert!((weights[0] / weights[1] - 1f64.exp()).abs() < 1e-12);
    }

    #[test]
    fn a_simpler_fit_is_chosen_where_it_is_as_good_and_the_better_one_elsewhere() {
        assert_eq!(choose(&[(-100.0, 3), (-96.0, 2), (-90.0, 2)]), Some(1));
        assert_eq!(choose(&[(-100.0, 3), (-93.0, 2)]), Some(0));
        assert_eq!(choose(&[(-100.0, 2), (-99.0, 2)]), Some(0));
        assert_eq!(choose(&[]), None);
    }
}
