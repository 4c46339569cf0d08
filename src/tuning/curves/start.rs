//! The mass at the start of a curve.

/// Slopes of the first rows beyond so many of their standard errors are a fall, not noise.
const SLOPE: f64 = 3.0;
/// Rows in which a slope is sought first.
const FIRST: usize = 4;
/// Changes below this share of the mass are round-off.
const ROUND_OFF: f64 = 1e-9;

/// What the masses of a curve are relative to.
#[derive(Clone, Debug, PartialEq)]
pub struct MassAtStart {
    /// Mass in kg, or share, at the start.
    pub value: f64,
    /// The same in the unit of the file.
    pub written: f64,
    /// That unit.
    pub unit: String,
    /// First rows that it is the mean of; `None` where it is stated.
    pub rows: Option<usize>,
}

/// Number of first rows before the mass changes: half of the first rows whose slope is more than noise. Where a reaction
/// begins within them, it takes less in the first half than the noise of their mean.
pub(super) fn plateau(mass: &[f64]) -> usize {
    let noise = noise(mass);
    let mut count = FIRST.min(mass.len());
    while count < mass.len() {
        let rows = &mass[..count];
        let middle = 0.5 * (count as f64 - 1.0);
        let offset = |k: usize| k as f64 - middle;
        let spread: f64 = (0..count).map(|k| offset(k).powi(2)).sum();
        let slope = rows.iter().enumerate().map(|(k, m)| offset(k) * m);
        let slope = slope.sum::<f64>() / spread;
        let change = slope.abs() * count as f64;
        if change > ROUND_OFF * mass[0].abs() && slope.abs() > SLOPE * noise / spread.sqrt() {
            break;
        }
        count += (count / 8).max(1);
    }
    (count.min(mass.len()) / 2).max(1)
}

/// Standard deviation of the noise of a curve: of its second differences, by their median, which a curve that bends in a few
/// rows alone does not move.
pub(super) fn noise(mass: &[f64]) -> f64 {
    let bends = mass.windows(3).map(|m| (m[0] - 2.0 * m[1] + m[2]).abs());
    let mut bends: Vec<f64> = bends.collect();
    bends.sort_by(f64::total_cmp);
    // A normal distribution has half of its values within 0.6745 of its deviation; second differences have √6 of it.
    let median = bends.get(bends.len() / 2).copied().unwrap_or(0.0);
    median / (0.6745 * 6f64.sqrt())
}

#[cfg(test)]
mod tests {
    use calcine_tuning::SearchRandom;

    use super::*;

    /// A fall as 10^(k/40 − 6), which is 1e-4 after 80 rows and 1e-3 after 120, without and with noise.
    #[test]
    fn the_mean_of_the_plateau_is_the_mass_at_the_start_within_its_noise() {
        let fall = |k: i32| 10f64.powf(f64::from(k) / 40.0 - 6.0).min(0.4);
        let exact: Vec<f64> = (0..300).map(|k| 1.0 - fall(k)).collect();
        assert!(
            (exact[..plateau(&exact)].iter().sum::<f64>() / plateau(&exact) as f64 - 1.0).abs()
                < 2e-6
        );
        let mut off = 0.0;
        for seed in 0..50 {
            let mut random = SearchRandom::new(seed);
            let noisy: Vec<f64> = exact.iter().map(|m| m + 1e-3 * random.normal()).collect();
            let count = plateau(&noisy);
            let mean = noisy[..count].iter().sum::<f64>() / count as f64;
            off += (mean - 1.0f64).powi(2) * count as f64 / 1e-6 / 50.0;
            assert!(count < 120, "{count}");
        }
        // The mean square of errors over that of the noise of the mean.
        assert!(off < 2.0, "{off}");
        assert_eq!(plateau(&[5.0; 40]), 20);
    }
}
