//! Distributions over size classes.

use std::fmt::Display;

use crate::{PlantError, SizeGrid};

/// Share of a distribution that may lie beyond either end of its grid.
pub const OUTSIDE: f64 = 1e-6;

/// Standard deviations beyond which [`OUTSIDE`] of a normal distribution lies on one side.
const TAIL: f64 = 4.753_424_308_823;

/// Shares of mass in each class of a normal distribution of diameters, by density at the middle of the classes and then
/// normalised, as Dyssol evaluates it (second order in the width of classes). `place` is what an error names.
pub fn normal_shares(
    grid: &SizeGrid,
    mean: f64,
    deviation: f64,
    place: impl Display,
) -> Result<Vec<f64>, PlantError> {
    for (quantity, value) in [("mean diameter", mean), ("standard deviation", deviation)] {
        if !(value.is_finite() && value > 0.0) {
            return Err(PlantError::Value {
                place: place.to_string(),
                quantity,
                value,
                allowed: "it is above 0 m",
            });
        }
    }
    let below_zero = normal_below(0.0, mean, deviation);
    if below_zero > OUTSIDE {
        return Err(PlantError::BelowZero {
            place: place.to_string(),
            mean,
            deviation,
            share: below_zero,
            most: rounded(mean / TAIL, deviation, f64::floor),
        });
    }
    let (from, to) = grid.range();
    // Of the mirrored distribution, so that a small share above is not lost in 1 − x.
    let (below, above) = (
        normal_below(from, mean, deviation),
        normal_below(-to, -mean, deviation),
    );
    if below > OUTSIDE || above > OUTSIDE {
        let reach = TAIL * deviation;
        return Err(PlantError::OutsideGrid {
            place: place.to_string(),
            share: below + above,
            from,
            to,
            low: rounded((mean - reach).max(0.0), deviation, f64::floor).min(from),
            high: rounded(mean + reach, deviation, f64::ceil).max(to),
        });
    }
    Ok(normal_row(grid, mean, deviation))
}

/// A length to two digits more than those of another, for people to read.
fn rounded(length: f64, of: f64, way: impl Fn(f64) -> f64) -> f64 {
    let scale = 10f64.powi(1 - of.log10().floor() as i32);
    way(length * scale) / scale
}

/// [`normal_shares`] of numbers that were looked at before. A distribution narrower than the classes falls into one.
pub(crate) fn normal_row(grid: &SizeGrid, mean: f64, deviation: f64) -> Vec<f64> {
    let nearest = |d: &f64| ((d - mean) / deviation).powi(2);
    let least = grid
        .diameters()
        .iter()
        .map(nearest)
        .fold(f64::INFINITY, f64::min);
    let density = |(class, d): (usize, &f64)| {
        // Relative to the largest, so that the narrowest distribution does not vanish.
        grid.width(class) * (-0.5 * (nearest(d) - least)).exp()
    };
    let mut row: Vec<f64> = grid.diameters().iter().enumerate().map(density).collect();
    let sum: f64 = row.iter().sum();
    row.iter_mut().for_each(|share| *share /= sum);
    row
}

/// Share of a normal distribution below x.
pub fn normal_below(x: f64, mean: f64, deviation: f64) -> f64 {
    let z = (x - mean) / (deviation * std::f64::consts::SQRT_2);
    let tail = 0.5 * complementary_error(z.abs());
    if z < 0.0 { tail } else { 1.0 - tail }
}

/// erfc(z) of z ≥ 0, by the power series of erf below 2.5 and the continued fraction above (Abramowitz and Stegun,
/// Handbook of Mathematical Functions, 1964, 7.1.6 and 7.1.14).
fn complementary_error(z: f64) -> f64 {
    let gauss = (-z * z).exp() / std::f64::consts::PI.sqrt();
    if z < 2.5 {
        let (mut term, mut sum, mut k) = (2.0 * z, 2.0 * z, 0.0);
        while term > 1e-17 * sum {
            k += 1.0;
            term *= 2.0 * z * z / (2.0 * k + 1.0);
            sum += term;
        }
        return 1.0 - gauss * sum;
    }
    let fraction = (1..=120)
        .rev()
        .fold(z, |below, k| z + 0.5 * f64::from(k) / below);
    gauss / fraction
}

/// Mass-weighted mean diameter in m of masses by class; none where there is no mass.
pub fn mean_diameter(grid: &SizeGrid, masses: &[f64]) -> Option<f64> {
    let sum: f64 = masses.iter().sum();
    let first: f64 = masses
        .iter()
        .zip(grid.diameters())
        .map(|(m, d)| m * d)
        .sum();
    (sum > 0.0).then(|| first / sum)
}

/// Diameter in m below which a share of the mass lies, linear within classes; none where there is no mass.
pub fn quantile(grid: &SizeGrid, masses: &[f64], share: f64) -> Option<f64> {
    let sum: f64 = masses.iter().sum();
    if sum.is_nan() || sum <= 0.0 {
        return None;
    }
    let (wanted, mut below) = (share * sum, 0.0);
    for (class, mass) in masses.iter().enumerate() {
        if below + mass >= wanted && *mass > 0.0 {
            return Some(grid.edges()[class] + (wanted - below) / mass * grid.width(class));
        }
        below += mass;
    }
    Some(grid.range().1)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_normal_distribution_has_its_mean_and_its_quantiles() {
        let grid = SizeGrid::uniform(400, 0.0, 4e-3).unwrap();
        let row = normal_shares(&grid, 2e-3, 1e-4, "test").unwrap();
        assert!((mean_diameter(&grid, &row).unwrap() - 2e-3).abs() < 1e-15);
        // 1.281551565545 standard deviations below the mean.
        let expected = 2e-3 - 1.281_551_565_545e-4;
        let found = quantile(&grid, &row, 0.1).unwrap();
        assert!((found - expected).abs() < 5e-8, "{found} {expected}");
    }

    #[test]
    fn the_share_below_agrees_with_tabulated_values() {
        // Φ(1), Φ(−2), Φ(4), Φ(−6) to fifteen digits.
        let known = [
            (1.0, 0.841_344_746_068_543),
            (-2.0, 0.022_750_131_948_179_2),
            (4.0, 0.999_968_328_758_167),
            (-6.0, 9.865_876_450_376_95e-10),
        ];
        for (z, expected) in known {
            let found = normal_below(z, 0.0, 1.0);
            assert!(
                (found / expected - 1.0).abs() < 1e-13,
                "{z}: {found} {expected}"
            );
        }
    }

    #[test]
    fn a_distribution_beyond_its_grid_is_refused_with_what_is_outside() {
        let grid = SizeGrid::uniform(40, 0.0, 2e-3).unwrap();
        let told = normal_shares(&grid, 1.9e-3, 1e-4, "feed").unwrap_err();
        let PlantError::OutsideGrid { share, .. } = told else {
            panic!("{told}");
        };
        // One standard deviation: 15.87 %.
        assert!((share - 0.158_655_253_931).abs() < 1e-11, "{share}");
    }

    /// What an error tells to do is done, and does.
    #[test]
    fn what_is_told_of_a_distribution_beyond_its_grid_mends_it() {
        for (mean, deviation) in [
            (2e-3, 1.3e-4),
            (3.97e-3, 1e-6),
            (1.1e-3, 7.7e-5),
            (1e-3, 2.1e-4),
        ] {
            let grid = SizeGrid::uniform(40, 1.05e-3, 3.95e-3).unwrap();
            match normal_shares(&grid, mean, deviation, "feed") {
                Err(PlantError::OutsideGrid { low, high, .. }) => {
                    let wider = SizeGrid::uniform(40, low, high).unwrap();
                    assert!(
                        normal_shares(&wider, mean, deviation, "feed").is_ok(),
                        "{mean}"
                    );
                    // No more than what it takes.
                    assert!(low >= mean - 5.0 * deviation || low == 1.05e-3, "{low}");
                    assert!(high <= mean + 5.0 * deviation || high == 3.95e-3, "{high}");
                }
                other => assert!(other.is_ok() && mean == 2e-3, "{other:?}"),
            }
        }
    }

    /// No grid holds it, wherever it begins: the grid is not what is told to change.
    #[test]
    fn a_distribution_that_reaches_below_zero_is_told_so() {
        let grid = SizeGrid::uniform(40, 0.0, 4e-3).unwrap();
        let told = normal_shares(&grid, 1e-3, 4e-4, "feed").unwrap_err();
        let text = told.to_string();
        let PlantError::BelowZero { share, most, .. } = told else {
            panic!("{told}");
        };
        // Φ(−2.5) = 6.2097e-3.
        assert!((share - 6.209_665_325_776e-3).abs() < 1e-12, "{share}");
        assert!(normal_shares(&grid, 1e-3, most, "feed").is_ok());
        assert!(!text.contains("size classes begin"), "{text}");
    }

    #[test]
    fn a_distribution_narrower_than_a_class_is_one_class() {
        let grid = SizeGrid::uniform(4, 0.0, 4e-3).unwrap();
        let row = normal_shares(&grid, 1.4e-3, 1e-9, "test").unwrap();
        assert_eq!(row, [0.0, 1.0, 0.0, 0.0]);
    }
}
