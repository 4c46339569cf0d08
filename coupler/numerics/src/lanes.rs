//! Numbers side by side, one of each system that is solved at the same time.
//!
//! Everything acts lane by lane: the bits of a lane depend neither on its neighbours nor on the instructions of the
//! processor, as nothing is fused or reordered. In a function that is compiled for wide registers, such as what
//! [`vectorised`] calls, a compiler puts the lanes there.

use std::ops::{Add, AddAssign, Div, Index, IndexMut, Mul, Neg, Sub, SubAssign};

/// N numbers.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(align(64))]
pub struct Lanes<const N: usize>(pub [f64; N]);

impl<const N: usize> Default for Lanes<N> {
    #[inline(always)]
    fn default() -> Self {
        Self::all(0.0)
    }
}

impl<const N: usize> Lanes<N> {
    /// The same in all.
    #[inline(always)]
    pub const fn all(value: f64) -> Self {
        Self([value; N])
    }

    /// A function of each.
    #[inline(always)]
    #[must_use]
    pub fn map(self, of: impl Fn(f64) -> f64) -> Self {
        let mut out = self;
        for own in &mut out.0 {
            *own = of(*own);
        }
        out
    }

    /// Square roots.
    #[inline(always)]
    #[must_use]
    pub fn sqrt(self) -> Self {
        self.map(f64::sqrt)
    }

    /// Absolute values.
    #[inline(always)]
    #[must_use]
    pub fn abs(self) -> Self {
        self.map(f64::abs)
    }

    /// Ones over them.
    #[inline(always)]
    #[must_use]
    pub fn inverse(self) -> Self {
        self.map(|x| 1.0 / x)
    }

    /// Where it is below another `yes`, elsewhere `no`.
    #[inline(always)]
    #[must_use]
    pub fn if_below(self, other: Self, yes: Self, no: Self) -> Self {
        let mut out = no;
        for k in 0..N {
            out.0[k] = if self.0[k] < other.0[k] {
                yes.0[k]
            } else {
                no.0[k]
            };
        }
        out
    }

    /// Where it is positive `yes`, elsewhere `no`.
    #[inline(always)]
    #[must_use]
    pub fn if_positive(self, yes: Self, no: Self) -> Self {
        Self::all(0.0).if_below(self, yes, no)
    }

    /// The larger ones; its own where either is NaN.
    #[inline(always)]
    #[must_use]
    pub fn max(self, other: Self) -> Self {
        self.if_below(other, other, self)
    }

    /// The smaller ones.
    #[inline(always)]
    #[must_use]
    pub fn min(self, other: Self) -> Self {
        other.if_below(self, other, self)
    }

    /// Numbers no less than zero.
    #[inline(always)]
    #[must_use]
    pub fn positive(self) -> Self {
        self.max(Self::all(0.0))
    }

    /// True where a condition holds of one at least.
    #[inline(always)]
    pub fn any(self, holds: impl Fn(f64) -> bool) -> bool {
        let mut found = false;
        for own in self.0 {
            found |= holds(own);
        }
        found
    }

    /// e to their powers, within 2 units in the last place from −708 to 709; at the ends of that beyond it.
    ///
    /// x = n ln 2 + r with |r| ≤ ln 2/2: the series of eʳ to r¹³, times 2ⁿ (Cody and Waite, Software Manual for the Elementary
    /// Functions (1980), chapter 6).
    #[inline(always)]
    #[must_use]
    pub fn exp(self) -> Self {
        // 2^52 + 2^51: what is added to it is rounded to a whole number, which its last bits hold.
        const ROUND: f64 = 6_755_399_441_055_744.0;
        const HIGH: f64 = 6.931_471_803_691_238e-1;
        const LOW: f64 = 1.908_214_929_270_587_7e-10;
        let mut out = self;
        for own in &mut out.0 {
            let x = if *own < -708.0 { -708.0 } else { *own };
            let x = if x > 709.0 { 709.0 } else { x };
            let shifted = x * std::f64::consts::LOG2_E + ROUND;
            let n = shifted - ROUND;
            let r = (x - n * HIGH) - n * LOW;
            let mut sum = SERIES[0];
            for coefficient in &SERIES[1..] {
                sum = sum * r + coefficient;
            }
            let exponent = shifted.to_bits().wrapping_add(1023) << 52;
            *own = sum * f64::from_bits(exponent);
        }
        out
    }
}

/// 1/13!, 1/12! … 1.
const SERIES: [f64; 14] = [
    1.0 / 6_227_020_800.0,
    1.0 / 479_001_600.0,
    1.0 / 39_916_800.0,
    1.0 / 3_628_800.0,
    1.0 / 362_880.0,
    1.0 / 40_320.0,
    1.0 / 5_040.0,
    1.0 / 720.0,
    1.0 / 120.0,
    1.0 / 24.0,
    1.0 / 6.0,
    0.5,
    1.0,
    1.0,
];

macro_rules! operator {
    ($trait:ident, $method:ident, $sign:tt) => {
        impl<const N: usize> $trait for Lanes<N> {
            type Output = Self;
            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                let mut out = self;
                for k in 0..N {
                    out.0[k] = self.0[k] $sign other.0[k];
                }
                out
            }
        }
        impl<const N: usize> $trait<f64> for Lanes<N> {
            type Output = Self;
            #[inline(always)]
            fn $method(self, other: f64) -> Self {
                self.map(|own| own $sign other)
            }
        }
    };
}

operator!(Add, add, +);
operator!(Sub, sub, -);
operator!(Mul, mul, *);
operator!(Div, div, /);

impl<const N: usize> AddAssign for Lanes<N> {
    #[inline(always)]
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}

impl<const N: usize> SubAssign for Lanes<N> {
    #[inline(always)]
    fn sub_assign(&mut self, other: Self) {
        *self = *self - other;
    }
}

impl<const N: usize> Neg for Lanes<N> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        self.map(|own| -own)
    }
}

impl<const N: usize> Index<usize> for Lanes<N> {
    type Output = f64;
    #[inline(always)]
    fn index(&self, lane: usize) -> &f64 {
        &self.0[lane]
    }
}

impl<const N: usize> IndexMut<usize> for Lanes<N> {
    #[inline(always)]
    fn index_mut(&mut self, lane: usize) -> &mut f64 {
        &mut self.0[lane]
    }
}

/// Runs what is inlined into it with the widest registers of the processor.
#[inline]
pub fn vectorised(work: impl FnOnce()) {
    struct Work<F>(F);
    impl<F: FnOnce()> pulp::WithSimd for Work<F> {
        type Output = ();
        #[inline(always)]
        fn with_simd<S: pulp::Simd>(self, _: S) {
            (self.0)();
        }
    }
    pulp::Arch::new().dispatch(Work(work));
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn powers_of_e_are_those_of_the_library_whatever_the_registers() {
        for k in -7000..7000 {
            let x = 0.1 * f64::from(k) + 1e-3 * f64::from(k % 17);
            let mut wide = Lanes::<8>::all(x);
            let plain = wide.exp()[3];
            vectorised(
                #[inline(always)]
                || wide = wide.exp(),
            );
            assert_eq!(plain.to_bits(), wide[0].to_bits());
            assert!((plain / x.exp() - 1.0).abs() < 4.5e-16, "{x}");
        }
        assert!(Lanes::<1>::all(f64::NAN).exp()[0].is_nan());
        assert_eq!(Lanes::<1>::all(0.0).exp()[0], 1.0);
    }

    #[test]
    fn choices_are_made_lane_by_lane() {
        let (one, other) = (Lanes([1.0, 5.0]), Lanes([2.0, 4.0]));
        assert_eq!(one.max(other), Lanes([2.0, 5.0]));
        assert_eq!(one.min(other), Lanes([1.0, 4.0]));
        assert_eq!((one - other).if_positive(one, other), Lanes([2.0, 5.0]));
        assert_eq!((one - other).positive(), Lanes([0.0, 1.0]));
    }
}
