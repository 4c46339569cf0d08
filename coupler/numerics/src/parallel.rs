//! Loops and sums in fixed chunks: the same bits on any number of threads.

use rayon::prelude::*;

/// Elements per chunk. Fixed, so that sums do not depend on the number of threads.
pub const CHUNK: usize = 4096;
/// Up to so many elements the caller's thread does the work alone, chunk by chunk: waking another costs
/// some microseconds, and a chunk of most loops takes no longer. (On the heated bed with 4416 cells, two
/// threads took 1.5 times as long as one before.)
pub const ALONE: usize = 4 * CHUNK;

/// Sets every element to a function of its index.
#[inline]
pub fn fill<T: Send>(values: &mut [T], value: impl Fn(usize) -> T + Sync) {
    update(values, |index, slot| *slot = value(index));
}

/// Changes every element, given its index.
#[inline]
pub fn update<T: Send>(values: &mut [T], change: impl Fn(usize, &mut T) + Sync) {
    let chunk = |start: usize, values: &mut [T]| {
        for (i, slot) in values.iter_mut().enumerate() {
            change(start + i, slot);
        }
    };
    if values.len() <= ALONE {
        chunk(0, values);
    } else {
        values
            .par_chunks_mut(CHUNK)
            .enumerate()
            .for_each(|(k, values)| chunk(k * CHUNK, values));
    }
}

/// Changes every element of two slices of one length side by side, given the index.
#[inline]
pub fn update_both<A: Send, B: Send>(
    first: &mut [A],
    second: &mut [B],
    change: impl Fn(usize, &mut A, &mut B) + Sync,
) {
    let chunk = |start: usize, first: &mut [A], second: &mut [B]| {
        for (i, (first, second)) in first.iter_mut().zip(second).enumerate() {
            change(start + i, first, second);
        }
    };
    if first.len() <= ALONE {
        chunk(0, first, second);
    } else {
        first
            .par_chunks_mut(CHUNK)
            .zip(second.par_chunks_mut(CHUNK))
            .enumerate()
            .for_each(|(k, (first, second))| chunk(k * CHUNK, first, second));
    }
}

/// The sums of several functions over `0..count`: chunk by chunk, then pairwise over the chunks.
#[inline]
pub fn sums<const N: usize>(count: usize, terms: impl Fn(usize) -> [f64; N] + Sync) -> [f64; N] {
    let add = |mut sum: [f64; N], terms: [f64; N]| {
        for (sum, term) in sum.iter_mut().zip(terms) {
            *sum += term;
        }
        sum
    };
    let chunk = |from: usize| {
        let to = count.min(from + CHUNK);
        (from..to).fold([0.0; N], |sum, i| add(sum, terms(i)))
    };
    if count <= CHUNK {
        return chunk(0);
    }
    let chunks = 0..count.div_ceil(CHUNK);
    let mut partial: Vec<[f64; N]> = if count <= ALONE {
        chunks.map(|k| chunk(k * CHUNK)).collect()
    } else {
        let chunks = chunks.into_par_iter();
        chunks.map(|k| chunk(k * CHUNK)).collect()
    };
    while partial.len() > 1 {
        for i in 0..partial.len().div_ceil(2) {
            let right = partial.get(2 * i + 1).copied();
            partial[i] = add(partial[2 * i], right.unwrap_or([0.0; N]));
        }
        partial.truncate(partial.len().div_ceil(2));
    }
    partial[0]
}

/// The sum of a function over `0..count`, in the same order.
#[inline]
pub fn sum(count: usize, term: impl Fn(usize) -> f64 + Sync) -> f64 {
    sums(count, |i| [term(i)])[0]
}

/// The largest value of a function over `0..count`, with the first index that has it; a value
/// that is not a number counts as larger than any other.
pub fn largest(count: usize, value: impl Fn(usize) -> f64 + Sync) -> (usize, f64) {
    let better = |best: (usize, f64), next: (usize, f64)| {
        if best.1.is_nan() || (next.1 <= best.1 && !next.1.is_nan()) {
            best
        } else {
            next
        }
    };
    let chunk_to = |from: usize, to: usize| {
        (from..to)
            .map(|i| (i, value(i)))
            .fold((from, f64::NEG_INFINITY), better)
    };
    let chunk = |from: usize| chunk_to(from, count.min(from + CHUNK));
    if count <= ALONE {
        return chunk_to(0, count);
    }
    let partial: Vec<_> = (0..count.div_ceil(CHUNK))
        .into_par_iter()
        .map(|k| chunk(k * CHUNK))
        .collect();
    partial.into_iter().fold((0, f64::NEG_INFINITY), better)
}

/// The scalar product of two vectors of equal length.
#[inline]
pub fn dot(a: &[f64], b: &[f64]) -> f64 {
    sum(a.len(), |i| a[i] * b[i])
}

/// The sum of magnitudes.
#[inline]
pub fn magnitude(a: &[f64]) -> f64 {
    sum(a.len(), |i| a[i].abs())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_sum_has_the_same_bits_on_one_and_on_seven_threads() {
        let term = |i: usize| ((i * 7919) % 1013) as f64 / 1013.0 - 0.4 + 1e-9 * i as f64;
        let on = |threads| {
            rayon::ThreadPoolBuilder::new()
                .num_threads(threads)
                .build()
                .unwrap()
                .install(|| sum(1_000_003, term))
        };
        assert_eq!(on(1).to_bits(), on(7).to_bits());
        let plain: f64 = (0..1_000_003).map(term).sum();
        assert!((on(1) / plain - 1.0).abs() < 1e-12);
    }

    #[test]
    fn the_largest_is_found_with_its_first_index_and_nan_wins() {
        assert_eq!(largest(3, |i| [1.0, 5.0, 5.0][i]), (1, 5.0));
        let (index, value) = largest(20_000, |i| if i == 9_000 { f64::NAN } else { i as f64 });
        assert_eq!(index, 9_000);
        assert!(value.is_nan());
    }
}
