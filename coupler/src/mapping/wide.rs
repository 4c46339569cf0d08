//! Numbers in the lanes of a vector register, with the operators of numbers, and their arctangent. The same bits for
//! every set of vector instructions: nothing is fused or reordered.

use std::f64::consts::{FRAC_PI_2, FRAC_PI_4, PI};
use std::ops::{Add, Div, Mul, Sub};

use pulp::Simd;

/// Numbers side by side.
#[derive(Clone, Copy)]
pub(super) struct Wide<S: Simd> {
    simd: S,
    lanes: S::f64s,
}

macro_rules! operator {
    ($trait:ident, $method:ident, $simd:ident) => {
        impl<S: Simd> $trait for Wide<S> {
            type Output = Self;

            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                Self::new(self.simd, self.simd.$simd(self.lanes, other.lanes))
            }
        }
    };
}

operator!(Add, add, add_f64s);
operator!(Sub, sub, sub_f64s);
operator!(Mul, mul, mul_f64s);
operator!(Div, div, div_f64s);

impl<S: Simd> Wide<S> {
    #[inline(always)]
    pub fn new(simd: S, lanes: S::f64s) -> Self {
        Self { simd, lanes }
    }

    #[inline(always)]
    pub fn lanes(self) -> S::f64s {
        self.lanes
    }

    /// A number in all lanes.
    #[inline(always)]
    pub fn all(self, value: f64) -> Self {
        Self::new(self.simd, self.simd.splat_f64s(value))
    }

    #[inline(always)]
    pub fn sqrt(self) -> Self {
        Self::new(self.simd, self.simd.sqrt_f64s(self.lanes))
    }

    #[inline(always)]
    pub fn abs(self) -> Self {
        Self::new(self.simd, self.simd.abs_f64s(self.lanes))
    }

    #[inline(always)]
    pub fn negated(self) -> Self {
        Self::new(self.simd, self.simd.neg_f64s(self.lanes))
    }

    /// Lane by lane `yes` where this is less than another, else `no`.
    #[inline(always)]
    pub fn if_below(self, other: Self, yes: Self, no: Self) -> Self {
        let mask = self.simd.less_than_f64s(self.lanes, other.lanes);
        Self::new(self.simd, self.simd.select_f64s(mask, yes.lanes, no.lanes))
    }

    /// Lane by lane `yes` where this is positive, else `no`.
    #[inline(always)]
    pub fn if_positive(self, yes: Self, no: Self) -> Self {
        self.all(0.0).if_below(self, yes, no)
    }
}

/// Numerator of the arctangent's rational function, highest power first (S. Moshier, Cephes Mathematical Library, atan.c).
const P: [f64; 5] = [
    -8.750_608_600_031_904e-1,
    -1.615_753_718_733_365_2e1,
    -7.500_855_792_314_705e1,
    -1.228_866_684_490_136_1e2,
    -6.485_021_904_942_025e1,
];
/// Its denominator below x⁵, highest power first.
const Q: [f64; 5] = [
    2.485_846_490_142_306_4e1,
    1.650_270_098_316_988_6e2,
    4.328_810_604_912_902_7e2,
    4.853_903_996_359_137e2,
    1.945_506_571_482_614e2,
];
/// Up to this ratio the rational function is used as it is; beyond, for the angle less π/4.
const DIRECT: f64 = 0.66;

/// The angle of (x, y) from the first axis in (−π, π], to two units in the last place; 0 for (0, 0).
#[inline(always)]
pub(super) fn angle<S: Simd>(y: Wide<S>, x: Wide<S>) -> Wide<S> {
    let all = |value| x.all(value);
    let (along, across) = (x.abs(), y.abs());
    let large = along.if_below(across, across, along);
    let small = along.if_below(across, along, across);
    let limit = all(DIRECT) * large;
    let numerator = limit.if_below(small, small - large, small);
    let denominator = limit.if_below(small, small + large, large);
    let ratio = numerator / denominator.if_positive(denominator, all(1.0));
    let square = ratio * ratio;
    let mut top = all(P[0]);
    for coefficient in &P[1..] {
        top = top * square + all(*coefficient);
    }
    let mut below = square + all(Q[0]);
    for coefficient in &Q[1..] {
        below = below * square + all(*coefficient);
    }
    let own = ratio + ratio * square * (top / below);
    let octant = limit.if_below(small, all(FRAC_PI_4) + own, own);
    let quadrant = along.if_below(across, all(FRAC_PI_2) - octant, octant);
    let half = x.if_below(all(0.0), all(PI) - quadrant, quadrant);
    y.if_below(all(0.0), half.negated(), half)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The angle by the widest registers of this machine and by single numbers.
    fn both(y: f64, x: f64) -> [f64; 2] {
        struct One(f64, f64);
        impl pulp::WithSimd for One {
            type Output = f64;

            #[inline(always)]
            fn with_simd<S: Simd>(self, simd: S) -> f64 {
                let wide = |value| Wide::new(simd, simd.splat_f64s(value));
                let found = angle(wide(self.0), wide(self.1));
                let mut out = [0.0; 8];
                let (heads, _) = S::as_mut_simd_f64s(&mut out);
                heads[0] = found.lanes();
                out[0]
            }
        }
        let plain = pulp::WithSimd::with_simd(One(y, x), pulp::Scalar);
        [pulp::Arch::new().dispatch(One(y, x)), plain]
    }

    #[test]
    fn the_angle_is_that_of_the_system_s_library_all_around_and_at_all_lengths() {
        for i in 0..100_000 {
            let share = f64::from(i) * 0.618_033_988_749_895 % 1.0;
            let turn = PI * (2.0 * share - 1.0);
            let length = 10f64.powi(i % 200 - 100);
            let (x, y) = (length * turn.cos(), length * turn.sin());
            let ([found, plain], wanted) = (both(y, x), y.atan2(x));
            assert_eq!(found.to_bits(), plain.to_bits());
            // Two units in the last place of what is added up: quarters of π.
            let tolerance = 2.0 * f64::EPSILON * wanted.abs();
            assert!(
                (found - wanted).abs() <= tolerance,
                "{x} {y}: {found} {wanted}"
            );
        }
    }

    #[test]
    fn small_angles_keep_their_digits_and_the_axes_are_exact() {
        let found = |y, x| both(y, x)[0];
        assert_eq!(found(1e-200, 1.0), 1e-200);
        assert_eq!(found(-3e-9, 1.0), (-3e-9f64).atan2(1.0));
        assert_eq!(found(0.0, 2.0), 0.0);
        assert_eq!(found(2.0, 0.0), FRAC_PI_2);
        assert_eq!(found(-2.0, 0.0), -FRAC_PI_2);
        assert_eq!(found(0.0, -2.0), PI);
        assert_eq!(found(0.0, 0.0), 0.0);
    }
}
