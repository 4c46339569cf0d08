//! The values along an axis that have a label.

use super::colour::Range;

/// A range with some air around it; a flat one gets a visible height.
pub(super) fn padded(range: Range) -> Range {
    let span = range.high - range.low;
    let size = range.high.abs().max(range.low.abs());
    let air = match size {
        0.0 => 1.0,
        _ if span > 1e-6 * size => 0.06 * span,
        _ => 0.01 * size,
    };
    Range {
        low: range.low - air,
        high: range.high + air,
    }
}

/// Round values inside a range, about so many.
pub(super) fn ticks(range: Range, about: usize) -> Vec<f64> {
    let span = range.high - range.low;
    if span <= 0.0 {
        return vec![range.low];
    }
    let raw = span / about as f64;
    let power = 10f64.powf(raw.log10().floor());
    let step = [1.0, 2.0, 2.5, 5.0, 10.0]
        .into_iter()
        .map(|factor| factor * power)
        .find(|&step| step >= raw)
        .unwrap_or(10.0 * power);
    let first = (range.low / step - 1e-9).ceil() as i64;
    let last = (range.high / step + 1e-9).floor() as i64;
    (first..=last).map(|n| n as f64 * step).collect()
}

/// Significant digits that tell neighbouring ticks apart.
pub(super) fn digits(range: Range, step: f64) -> usize {
    let largest = range.low.abs().max(range.high.abs());
    let places = (largest / step).log10().floor();
    if places.is_finite() {
        // A step of 2.5 has a digit more than one of 1, 2 or 5.
        let mantissa = step / 10f64.powf(step.log10().floor());
        let more = usize::from((mantissa - 2.5).abs() < 1e-6);
        (places as usize + 2 + more).clamp(2, 12)
    } else {
        5
    }
}

/// Powers of ten, as logarithms, in a range of logarithms: about five.
pub(super) fn decades(range: Range) -> Vec<f64> {
    let count = (range.high - range.low).round() as usize;
    let step = count.div_ceil(5).max(1);
    (0..=count)
        .step_by(step)
        .map(|n| range.low + n as f64)
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ticks_are_round_and_inside_the_range() {
        let range = Range {
            low: 0.0,
            high: 300.0,
        };
        assert_eq!(
            ticks(range, 6),
            [0.0, 50.0, 100.0, 150.0, 200.0, 250.0, 300.0]
        );
        let narrow = Range {
            low: 17.93,
            high: 18.07,
        };
        for tick in ticks(narrow, 5) {
            assert!((17.93..=18.07).contains(&tick), "{tick}");
        }
    }

    #[test]
    fn ticks_of_a_quarter_are_told_apart() {
        let range = Range {
            low: 1.4,
            high: 2.3,
        };
        assert_eq!(digits(range, 0.25), 3);
        assert_eq!(digits(range, 0.5), 2);
    }
}
