//! Some of many.

/// So many of a number of things, evenly spaced, the first and the last among them; the last alone where one is asked for.
pub(super) fn spread(all: usize, wanted: usize) -> Vec<usize> {
    let shown = wanted.min(all);
    match shown {
        0 => Vec::new(),
        1 => vec![all - 1],
        _ => (0..shown)
            .map(|place| place * (all - 1) / (shown - 1))
            .collect(),
    }
}
