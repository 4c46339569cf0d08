//! Loops and sums in fixed blocks: the same bits on any number of threads.

use rayon::prelude::*;

/// Elements of a block. Fixed, so that sums do not depend on the number of threads.
pub const BLOCK: usize = 2048;
/// Up to so many elements the caller's thread does the work alone, block by block: waking another costs
/// more than it takes over.
pub const ALONE: usize = 8 * BLOCK;

/// Changes every element, given its index.
#[inline]
pub fn update<T: Send>(values: &mut [T], change: impl Fn(usize, &mut T) + Sync) {
    let block = |start: usize, values: &mut [T]| {
        for (offset, value) in values.iter_mut().enumerate() {
            change(start + offset, value);
        }
    };
    if values.len() <= ALONE {
        return block(0, values);
    }
    let blocks = values.par_chunks_mut(BLOCK).enumerate();
    blocks.for_each(|(index, values)| block(index * BLOCK, values));
}

/// Changes every element of two slices of one length side by side, given the index.
#[inline]
pub fn update_both<A: Send, B: Send>(
    first: &mut [A],
    second: &mut [B],
    change: impl Fn(usize, &mut A, &mut B) + Sync,
) {
    let block = |start: usize, first: &mut [A], second: &mut [B]| {
        for (offset, (first, second)) in first.iter_mut().zip(second).enumerate() {
            change(start + offset, first, second);
        }
    };
    if first.len() <= ALONE {
        return block(0, first, second);
    }
    let blocks = first
        .par_chunks_mut(BLOCK)
        .zip(second.par_chunks_mut(BLOCK));
    blocks
        .enumerate()
        .for_each(|(index, (first, second))| block(index * BLOCK, first, second));
}

/// Sets every element to a function of its index.
#[inline]
pub fn fill<T: Send>(values: &mut [T], value: impl Fn(usize) -> T + Sync) {
    update(values, |index, slot| *slot = value(index));
}

/// Sum of a function over `0..count`: block by block, then over the blocks.
#[inline]
pub fn sum(count: usize, term: impl Fn(usize) -> f64 + Sync) -> f64 {
    blocks(count, |range| range.map(&term).sum())
        .into_iter()
        .sum()
}

/// Largest value of a function over `0..count`, and 0 at least.
#[inline]
pub fn largest(count: usize, term: impl Fn(usize) -> f64 + Sync) -> f64 {
    let of = |range: std::ops::Range<usize>| range.map(&term).fold(0.0, f64::max);
    blocks(count, of).into_iter().fold(0.0, f64::max)
}

fn blocks(count: usize, of: impl Fn(std::ops::Range<usize>) -> f64 + Sync) -> Vec<f64> {
    let range = |block: usize| block * BLOCK..count.min((block + 1) * BLOCK);
    let blocks = 0..count.div_ceil(BLOCK);
    if count <= ALONE {
        return blocks.map(|block| of(range(block))).collect();
    }
    let blocks = blocks.into_par_iter();
    blocks.map(|block| of(range(block))).collect()
}
