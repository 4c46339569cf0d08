//! Numbers with or without a derivative.

use std::ops::{Add, Div, Mul, Neg, Sub};

/// What rates are computed in: `f64`, or [`Dual`] where their derivative in a direction is wanted too. One
/// text of the laws then gives both.
pub trait Number:
    Copy
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
{
    /// A constant.
    fn constant(value: f64) -> Self;
    /// Its value.
    fn value(self) -> f64;
    /// f of it, from f's value and slope there.
    #[must_use]
    fn through(self, value: f64, slope: f64) -> Self;

    /// e to its power.
    #[must_use]
    fn exp(self) -> Self {
        let e = self.value().exp();
        self.through(e, e)
    }

    /// Its natural logarithm.
    #[must_use]
    fn ln(self) -> Self {
        self.through(self.value().ln(), 1.0 / self.value())
    }

    /// Its product with a constant.
    #[must_use]
    fn times(self, factor: f64) -> Self {
        self.through(factor * self.value(), factor)
    }
}

impl Number for f64 {
    #[inline]
    fn constant(value: f64) -> Self {
        value
    }
    #[inline]
    fn value(self) -> f64 {
        self
    }
    #[inline]
    fn through(self, value: f64, _slope: f64) -> Self {
        value
    }
}

/// A value with its derivative in one direction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Dual {
    /// The value.
    pub value: f64,
    /// Its derivative.
    pub slope: f64,
}

impl Number for Dual {
    #[inline]
    fn constant(value: f64) -> Self {
        Self { value, slope: 0.0 }
    }
    #[inline]
    fn value(self) -> f64 {
        self.value
    }
    #[inline]
    fn through(self, value: f64, slope: f64) -> Self {
        Self {
            value,
            slope: slope * self.slope,
        }
    }
}

impl Add for Dual {
    type Output = Self;
    #[inline]
    fn add(self, other: Self) -> Self {
        Self {
            value: self.value + other.value,
            slope: self.slope + other.slope,
        }
    }
}

impl Sub for Dual {
    type Output = Self;
    #[inline]
    fn sub(self, other: Self) -> Self {
        self + -other
    }
}

impl Mul for Dual {
    type Output = Self;
    #[inline]
    fn mul(self, other: Self) -> Self {
        Self {
            value: self.value * other.value,
            slope: self.slope * other.value + self.value * other.slope,
        }
    }
}

impl Div for Dual {
    type Output = Self;
    #[inline]
    fn div(self, other: Self) -> Self {
        let value = self.value / other.value;
        Self {
            value,
            slope: (self.slope - value * other.slope) / other.value,
        }
    }
}

impl Neg for Dual {
    type Output = Self;
    #[inline]
    fn neg(self) -> Self {
        Self {
            value: -self.value,
            slope: -self.slope,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn any<N: Number>(x: N) -> N {
        let y = x * x - N::constant(3.0) / x;
        (y + x.ln()).times(0.5) * (-x).exp()
    }

    #[test]
    fn a_dual_carries_the_value_and_the_difference_quotient() {
        for x in [0.3, 1.0, 2.7] {
            let dual = any(Dual {
                value: x,
                slope: 2.0,
            });
            assert_eq!(dual.value, any(x));
            let h = 1e-6;
            let quotient = (any(x + h) - any(x - h)) / (2.0 * h);
            // Round-off of the quotient: 1e-16/1e-6.
            assert!(
                (dual.slope - 2.0 * quotient).abs() < 1e-8 * quotient.abs(),
                "{x}"
            );
        }
    }
}
