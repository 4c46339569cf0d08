//! Numbers with or without derivatives.

use std::ops::{Add, Div, Mul, Neg, Sub};

/// What rates are computed in: `f64`, or [`Dual`] where their derivatives are wanted too. One text of the laws
/// then gives both.
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
    #[inline]
    #[must_use]
    fn exp(self) -> Self {
        let e = self.value().exp();
        self.through(e, e)
    }

    /// Its natural logarithm.
    #[inline]
    #[must_use]
    fn ln(self) -> Self {
        self.through(self.value().ln(), 1.0 / self.value())
    }

    /// Its product with a constant.
    #[inline]
    #[must_use]
    fn times(self, factor: f64) -> Self {
        self.through(factor * self.value(), factor)
    }

    /// One over it.
    #[inline]
    #[must_use]
    fn inverse(self) -> Self {
        let inverse = 1.0 / self.value();
        self.through(inverse, -inverse * inverse)
    }

    /// Its cube root; at zero, where the slope is infinite, a constant.
    #[inline]
    #[must_use]
    fn cbrt(self) -> Self {
        let (x, root) = (self.value(), self.value().cbrt());
        let slope = if x == 0.0 { 0.0 } else { root / (3.0 * x) };
        self.through(root, slope)
    }

    /// The number itself where it is not negative, zero elsewhere; at zero it has the slope from above.
    #[inline]
    #[must_use]
    fn positive(self) -> Self {
        if self.value() >= 0.0 {
            self
        } else {
            Self::constant(0.0)
        }
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

/// A value with its derivatives in N directions (forward mode of automatic differentiation).
///
/// Source: Griewank and Walther, Evaluating Derivatives, 2nd ed. (2008), chapter 3,
/// doi 10.1137/1.9780898717761.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Dual<const N: usize> {
    /// The value.
    pub value: f64,
    /// Its derivatives.
    pub slope: [f64; N],
}

impl<const N: usize> Dual<N> {
    /// A number that is one of the directions itself.
    #[inline]
    #[must_use]
    pub fn along(value: f64, direction: usize) -> Self {
        let mut slope = [0.0; N];
        slope[direction] = 1.0;
        Self { value, slope }
    }

    #[inline]
    fn combine(value: f64, (a, x): (f64, [f64; N]), (b, y): (f64, [f64; N])) -> Self {
        let mut slope = [0.0; N];
        for k in 0..N {
            slope[k] = a * x[k] + b * y[k];
        }
        Self { value, slope }
    }
}

impl<const N: usize> Number for Dual<N> {
    #[inline]
    fn constant(value: f64) -> Self {
        Self {
            value,
            slope: [0.0; N],
        }
    }
    #[inline]
    fn value(self) -> f64 {
        self.value
    }
    #[inline]
    fn through(self, value: f64, slope: f64) -> Self {
        let mut own = self.slope;
        for one in &mut own {
            *one *= slope;
        }
        Self { value, slope: own }
    }
}

impl<const N: usize> Add for Dual<N> {
    type Output = Self;
    #[inline]
    fn add(self, other: Self) -> Self {
        let mut slope = self.slope;
        for (own, other) in slope.iter_mut().zip(other.slope) {
            *own += other;
        }
        Self {
            value: self.value + other.value,
            slope,
        }
    }
}

impl<const N: usize> Sub for Dual<N> {
    type Output = Self;
    #[inline]
    fn sub(self, other: Self) -> Self {
        let mut slope = self.slope;
        for (own, other) in slope.iter_mut().zip(other.slope) {
            *own -= other;
        }
        Self {
            value: self.value - other.value,
            slope,
        }
    }
}

impl<const N: usize> Mul for Dual<N> {
    type Output = Self;
    #[inline]
    fn mul(self, other: Self) -> Self {
        let value = self.value * other.value;
        Self::combine(value, (other.value, self.slope), (self.value, other.slope))
    }
}

impl<const N: usize> Div for Dual<N> {
    type Output = Self;
    #[inline]
    fn div(self, other: Self) -> Self {
        let inverse = 1.0 / other.value;
        let value = self.value / other.value;
        Self::combine(
            value,
            (inverse, self.slope),
            (-value * inverse, other.slope),
        )
    }
}

impl<const N: usize> Neg for Dual<N> {
    type Output = Self;
    #[inline]
    fn neg(self) -> Self {
        self.through(-self.value, -1.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn any<N: Number>(x: N, y: N) -> N {
        let z = x * x - N::constant(3.0) / x;
        (z + x.ln()).times(0.5) * (-x).exp() + (x * y).cbrt() - y.inverse()
    }

    #[test]
    fn a_dual_carries_the_value_and_the_difference_quotients() {
        for x in [0.3, 1.0, 2.7] {
            let y = 0.7 * x;
            let dual = any(Dual::<2>::along(x, 0), Dual::along(y, 1));
            assert_eq!(dual.value, any(x, y));
            let h = 1e-6;
            let quotients = [
                (any(x + h, y) - any(x - h, y)) / (2.0 * h),
                (any(x, y + h) - any(x, y - h)) / (2.0 * h),
            ];
            for (slope, quotient) in dual.slope.iter().zip(quotients) {
                // Round-off of the quotient: 1e-16/1e-6.
                assert!(
                    (slope - quotient).abs() < 1e-8 * (1.0 + quotient.abs()),
                    "{x}"
                );
            }
        }
    }

    #[test]
    fn at_zero_a_cube_root_is_a_constant_and_a_negative_number_has_no_positive_part() {
        assert_eq!(Dual::<1>::along(0.0, 0).cbrt(), Dual::constant(0.0));
        assert_eq!(Dual::<1>::along(-2.0, 0).positive(), Dual::constant(0.0));
        assert_eq!(Dual::<1>::along(2.0, 0).positive(), Dual::along(2.0, 0));
    }
}
