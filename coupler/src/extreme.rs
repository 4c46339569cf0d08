//! Extremes that do not lose NaN, as `f64::max` and `f64::min` do.

/// The larger of two numbers; NaN where one of them is.
pub fn larger(one: f64, other: f64) -> f64 {
    if one.is_nan() || one > other {
        one
    } else {
        other
    }
}

/// The smaller of two numbers; NaN where one of them is.
pub fn smaller(one: f64, other: f64) -> f64 {
    -larger(-one, -other)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nan_is_seen_on_either_side_and_numbers_are_ordered() {
        for (one, other) in [(f64::NAN, 1.0), (1.0, f64::NAN), (f64::NAN, f64::NAN)] {
            assert!(larger(one, other).is_nan() && smaller(one, other).is_nan());
        }
        for (one, other) in [(1.0, 2.0), (2.0, 1.0)] {
            assert_eq!((larger(one, other), smaller(one, other)), (2.0, 1.0));
        }
    }
}
