//! What each particle sees adds up to its surface.

use calcine_interior::{ExchangeAreas, RowImbalance};

/// Relative error of a row at which the scaling ends.
const CLOSED: f64 = 1e-13;
/// Relative error above which a row counts as not balanced.
const TOLERATED: f64 = 1e-9;
/// Rounds of scaling at most.
const ROUNDS: usize = 200;

/// Scales exchange areas, S_ij' = d_i d_j S_ij and S_ik' = d_i S_ik for a reservoir k, until the row of each
/// particle sums to its surface: Sinkhorn's and Knopp's iteration in its symmetric form, d_i ← √(d_i A_i/
/// Σ_j …). Reciprocity is not touched. Where no such factors exist (a row of three spheres that see nothing
/// else), rows are cut down to their surface, and what they lack they see of themselves.
///
/// Source: Knight, Ruiz and Uçar, SIAM J. Matrix Anal. Appl. 35 (2014) 931, doi 10.1137/110825753.
pub fn balance(views: &mut ExchangeAreas) {
    let count = views.surface.len();
    let mut factor = vec![1.0; count];
    let mut row = vec![0.0; count];
    for _ in 0..ROUNDS {
        sums(views, &factor, &mut row);
        let mut worst = 0.0_f64;
        for p in 0..count {
            if row[p] > 0.0 {
                let ratio = views.surface[p] / row[p];
                worst = worst.max((ratio - 1.0).abs());
                factor[p] *= ratio.sqrt();
            }
        }
        if worst < CLOSED {
            break;
        }
    }
    views.imbalance = imbalance(&views.surface, &row);
    for ([a, b], area) in &mut views.pairs {
        *area *= factor[*a] * factor[*b];
    }
    for ([p, _], area) in &mut views.reservoirs {
        *area *= factor[*p];
    }
    for (area, factor) in views.own.iter_mut().zip(&factor) {
        *area *= factor * factor;
    }
    // What is left above a surface is cut, on both sides of a pair alike.
    sums(views, &vec![1.0; count], &mut row);
    let cut: Vec<f64> = row
        .iter()
        .zip(&views.surface)
        .map(
            |(sum, surface)| match *sum > surface * (1.0 + 10.0 * CLOSED) {
                true => surface / sum,
                false => 1.0,
            },
        )
        .collect();
    for ([a, b], area) in &mut views.pairs {
        *area *= cut[*a].min(cut[*b]);
    }
    for ([p, _], area) in &mut views.reservoirs {
        *area *= cut[*p];
    }
    for (area, cut) in views.own.iter_mut().zip(&cut) {
        *area *= cut;
    }
}

/// Rows that do not sum to their surface; one that sees nothing has nothing to scale.
fn imbalance(surface: &[f64], row: &[f64]) -> RowImbalance {
    let mut found = RowImbalance::default();
    for (p, (surface, sum)) in surface.iter().zip(row).enumerate() {
        let error = (surface / sum - 1.0).abs();
        if *sum > 0.0 && error > TOLERATED {
            found.rows += 1;
            if error > found.worst {
                (found.worst, found.row) = (error, p);
            }
        }
    }
    found
}

/// Row sums in m² with factors.
fn sums(views: &ExchangeAreas, factor: &[f64], row: &mut [f64]) {
    for ((sum, own), factor) in row.iter_mut().zip(&views.own).zip(factor) {
        *sum = factor * factor * own;
    }
    for &([a, b], area) in &views.pairs {
        let scaled = factor[a] * factor[b] * area;
        row[a] += scaled;
        row[b] += scaled;
    }
    for &([p, _], area) in &views.reservoirs {
        row[p] += factor[p] * area;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_of_a_full_matrix_close_and_stay_reciprocal() {
        let mut views = ExchangeAreas {
            pairs: vec![
                ([0, 1], 0.4),
                ([0, 2], 0.7),
                ([1, 2], 0.5),
                ([2, 3], 0.2),
                ([0, 3], 0.3),
            ],
            reservoirs: vec![([3, 0], 0.6), ([1, 0], 0.3)],
            radiosity: false,
            own: vec![0.1, 0.0, 0.0, 0.0],
            surface: vec![1.0, 1.5, 1.2, 1.0],
            imbalance: RowImbalance::default(),
        };
        balance(&mut views);
        let mut row = [0.0; 4];
        sums(&views, &[1.0; 4], &mut row);
        for (sum, surface) in row.iter().zip(&views.surface) {
            assert!((sum / surface - 1.0).abs() < 1e-12, "{row:?}");
        }
        assert!(views.pairs.iter().all(|pair| pair.1 > 0.0));
        assert_eq!(views.imbalance.rows, 0);
    }

    #[test]
    fn a_row_that_cannot_close_never_sees_more_than_all() {
        let mut views = ExchangeAreas {
            pairs: vec![([0, 1], 0.1), ([1, 2], 0.1)],
            reservoirs: Vec::new(),
            radiosity: false,
            own: vec![0.0; 3],
            surface: vec![1.0; 3],
            imbalance: RowImbalance::default(),
        };
        balance(&mut views);
        let mut row = [0.0; 3];
        sums(&views, &[1.0; 3], &mut row);
        assert!(row.iter().all(|sum| *sum <= 1.0 + 1e-12), "{row:?}");
        assert!(views.imbalance.rows > 0, "{:?}", views.imbalance);
        assert!((views.pairs[0].1 / views.pairs[1].1 - 1.0).abs() < 1e-9);
    }
}
