//! Sums over long rows in lanes, so that they need not wait for one another; their order is fixed.

const LANES: usize = 8;

/// Σ v.
pub fn sum(values: &[f64]) -> f64 {
    lanes(values, |value| value)
}

/// Σ |v|.
pub fn sum_of_sizes(values: &[f64]) -> f64 {
    lanes(values, f64::abs)
}

fn lanes(values: &[f64], of: impl Fn(f64) -> f64) -> f64 {
    let mut sums = [0.0; LANES];
    let chunks = values.chunks_exact(LANES);
    let rest: f64 = chunks.remainder().iter().map(|value| of(*value)).sum();
    for chunk in chunks {
        for (sum, value) in sums.iter_mut().zip(chunk) {
            *sum += of(*value);
        }
    }
    rest + sums.iter().sum::<f64>()
}

/// Σ |a − b| of two rows of one length.
pub fn sum_of_differences(a: &[f64], b: &[f64]) -> f64 {
    of_pairs(a, b, |x, y| (x - y).abs())
}

/// Σ of the products of two rows of one length.
pub fn dot(a: &[f64], b: &[f64]) -> f64 {
    of_pairs(a, b, |x, y| x * y)
}

fn of_pairs(a: &[f64], b: &[f64], of: impl Fn(f64, f64) -> f64) -> f64 {
    let mut sums = [0.0; LANES];
    let (left, right) = (a.chunks_exact(LANES), b.chunks_exact(LANES));
    let ends = left.remainder().iter().zip(right.remainder());
    let rest: f64 = ends.map(|(x, y)| of(*x, *y)).sum();
    for (x, y) in left.zip(right) {
        for ((sum, x), y) in sums.iter_mut().zip(x).zip(y) {
            *sum += of(*x, *y);
        }
    }
    rest + sums.iter().sum::<f64>()
}

/// Adds to each of `to` its share of a row in which they take turns.
pub fn add_in_turns(values: &[f64], to: &mut [f64]) {
    let count = to.len();
    if count == 1 {
        to[0] += sum(values);
        return;
    }
    let wide = count * LANES.div_ceil(count);
    let mut sums = [0.0; 4 * LANES];
    if wide > sums.len() {
        for turn in values.chunks_exact(count) {
            to.iter_mut().zip(turn).for_each(|(t, value)| *t += value);
        }
        return;
    }
    let sums = &mut sums[..wide];
    let chunks = values.chunks_exact(wide);
    for (place, value) in chunks.remainder().iter().enumerate() {
        to[place % count] += value;
    }
    for chunk in chunks {
        sums.iter_mut()
            .zip(chunk)
            .for_each(|(s, value)| *s += value);
    }
    for turn in sums.chunks_exact(count) {
        to.iter_mut().zip(turn).for_each(|(t, s)| *t += s);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_value_is_counted_once_at_any_length() {
        for length in 0..40usize {
            let values: Vec<f64> = (0..length).map(|k| k as f64 - 7.0).collect();
            let plain: f64 = values.iter().sum();
            let sizes: f64 = values.iter().map(|v| v.abs()).sum();
            let squares: f64 = values.iter().map(|v| v * v).sum();
            let none = vec![0.0; length];
            assert_eq!(sum(&values), plain);
            assert_eq!(sum_of_sizes(&values), sizes);
            assert_eq!(sum_of_differences(&values, &none), sizes);
            assert_eq!(dot(&values, &values), squares);
        }
    }

    #[test]
    fn rows_that_take_turns_are_summed_apart() {
        for count in 1..40usize {
            let values: Vec<f64> = (0..count * 11).map(|k| k as f64).collect();
            let mut found = vec![1.0; count];
            add_in_turns(&values, &mut found);
            for (k, found) in found.iter().enumerate() {
                let plain: f64 = values.iter().skip(k).step_by(count).sum();
                assert_eq!(*found, plain + 1.0, "{count} {k}");
            }
        }
    }
}
