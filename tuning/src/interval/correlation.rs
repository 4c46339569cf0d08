use crate::least_squares::{FittedPlaces, cholesky_solve};

/// Pairs that are correlated by more are named: one of them cannot be known without the other.
pub const CORRELATED: f64 = 0.95;

/// Two parameters and how strongly their errors go together.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ParameterPair {
    /// The first parameter.
    pub first: usize,
    /// The second parameter.
    pub second: usize,
    /// Correlation from −1 to 1.
    pub correlation: f64,
}

/// Correlations of the errors of all free parameters, from (JᵀJ)⁻¹ at the fit; `None` where some direction of the
/// parameters has no effect at all.
pub fn correlations(fitted: &FittedPlaces) -> Option<Vec<ParameterPair>> {
    let columns = &fitted.jacobian;
    let n = columns.len();
    let dot = |a: &[f64], b: &[f64]| -> f64 { a.iter().zip(b).map(|(a, b)| a * b).sum() };
    let scale: Vec<f64> = columns
        .iter()
        .map(|column| dot(column, column).sqrt())
        .collect();
    if scale.iter().any(|&one| one.is_nan() || one <= 0.0) {
        return None;
    }
    let mut inverse = Vec::with_capacity(n);
    for k in 0..n {
        let mut matrix: Vec<f64> = (0..n * n)
            .map(|place| {
                let (row, column) = (place / n, place % n);
                dot(&columns[row], &columns[column]) / (scale[row] * scale[column])
            })
            .collect();
        let mut unit = vec![0.0; n];
        unit[k] = 1.0;
        inverse.push(cholesky_solve(&mut matrix, &unit)?);
    }
    let mut pairs = Vec::new();
    for a in 0..n {
        for b in a + 1..n {
            pairs.push(ParameterPair {
                first: fitted.free[a],
                second: fitted.free[b],
                correlation: inverse[a][b] / (inverse[a][a] * inverse[b][b]).sqrt(),
            });
        }
    }
    Some(pairs)
}

/// The pairs of a fit that are correlated by more than [`CORRELATED`].
pub fn correlated(fitted: &FittedPlaces) -> Option<Vec<ParameterPair>> {
    let mut pairs = correlations(fitted)?;
    pairs.retain(|pair| pair.correlation.abs() > CORRELATED);
    Some(pairs)
}

/// Correlation of each difference with the next one of its curve: near zero for noise, near one where the model misses.
pub fn lag_one(list: &[f64]) -> f64 {
    let count = list.len() as f64;
    let mean = list.iter().sum::<f64>() / count;
    let spread: f64 = list.iter().map(|r| (r - mean) * (r - mean)).sum();
    let product: f64 = list
        .windows(2)
        .map(|pair| (pair[0] - mean) * (pair[1] - mean))
        .sum();
    if spread > 0.0 { product / spread } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn two_columns_at_sixty_degrees_are_correlated_by_minus_one_half() {
        let fitted = |second: Vec<f64>| FittedPlaces {
            places: vec![0.5; 2],
            sums: vec![1.0],
            counts: vec![2],
            jacobian: vec![vec![2.0, 0.0], second],
            free: vec![0, 1],
            evaluations: 0,
        };
        let pairs = correlations(&fitted(vec![0.5, 0.75f64.sqrt()])).unwrap();
        assert!((pairs[0].correlation + 0.5).abs() < 1e-14);
        assert!(correlations(&fitted(vec![0.0, 0.0])).is_none());
        let pairs = correlated(&fitted(vec![1.0, 0.2])).unwrap();
        assert_eq!((pairs[0].first, pairs[0].second), (0, 1));
    }

    #[test]
    fn noise_has_no_memory_and_a_wave_has() {
        let wave: Vec<f64> = (0..200).map(|k| (0.1 * f64::from(k)).sin()).collect();
        let mut random = crate::SearchRandom::new(4);
        let noise: Vec<f64> = (0..200).map(|_| random.normal()).collect();
        assert!(lag_one(&wave) > 0.95 && lag_one(&noise).abs() < 0.3);
    }
}
