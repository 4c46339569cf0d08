//! Which law of conversion a reaction follows.

use calcine_numerics::Lanes;

use super::contracting_area::ContractingArea;
use super::contracting_volume::ContractingVolume;
use super::conversion_law::{ConversionLaw, TRACE};
use super::first_order::FirstOrder;
use super::nucleation::Nucleation;
use super::random_pore::RandomPore;

/// Which law of conversion a reaction follows.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Conversion {
    /// f = w.
    FirstOrder(FirstOrder),
    /// f = 2 w^1/2.
    ContractingArea(ContractingArea),
    /// f = 3 w^2/3.
    ContractingVolume(ContractingVolume),
    /// f = m w (a − ln w)^(1 − 1/m).
    Nucleation(Nucleation),
    /// f = w (1 − ψ ln w)^1/2.
    RandomPore(RandomPore),
}

impl Conversion {
    /// f and its derivative at any share w; a line through zero below [`TRACE`].
    pub fn of(&self, left: f64) -> [f64; 2] {
        let at = left.max(TRACE);
        let [value, slope] = match self {
            Self::FirstOrder(law) => law.of(at),
            Self::ContractingArea(law) => law.of(at),
            Self::ContractingVolume(law) => law.of(at),
            Self::Nucleation(law) => law.of(at),
            Self::RandomPore(law) => law.of(at),
        };
        if left >= TRACE {
            [value, slope]
        } else {
            let steep = value / TRACE;
            [steep * left, steep]
        }
    }

    /// The same at shares side by side.
    #[inline(always)]
    pub fn lanes<const N: usize>(&self, left: Lanes<N>) -> [Lanes<N>; 2] {
        if let Self::FirstOrder(_) = self {
            // Its line through zero is the law itself.
            return [left, Lanes::all(1.0)];
        }
        let mut all = [Lanes::default(); 2];
        for lane in 0..N {
            [all[0][lane], all[1][lane]] = self.of(left[lane]);
        }
        all
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const ALL: [Conversion; 5] = [
        Conversion::FirstOrder(FirstOrder),
        Conversion::ContractingArea(ContractingArea),
        Conversion::ContractingVolume(ContractingVolume),
        Conversion::Nucleation(Nucleation {
            exponent: 2.0,
            nuclei: 1e-3,
        }),
        Conversion::RandomPore(RandomPore { structure: 4.6 }),
    ];

    #[test]
    fn slopes_are_difference_quotients() {
        for law in ALL {
            for w in [1.0, 0.7, 0.2, 1e-3, 1e-6] {
                let h = 1e-7 * w;
                let quotient = (law.of(w + h)[0] - law.of(w - h)[0]) / (2.0 * h);
                let slope = law.of(w)[1];
                assert!(
                    (slope - quotient).abs() < 1e-5 * slope.abs().max(1.0),
                    "{law:?} {w}: {slope} {quotient}"
                );
            }
        }
    }

    #[test]
    fn shares_side_by_side_have_the_bits_of_each_by_itself() {
        let left = [1.0, 0.3, TRACE, 0.3 * TRACE, 0.0, -1e-9, 0.9, 1e-300];
        for law in ALL {
            let [value, slope] = law.lanes(Lanes(left));
            for lane in 0..left.len() {
                assert_eq!([value[lane], slope[lane]], law.of(left[lane]), "{law:?}");
            }
        }
    }

    #[test]
    fn every_law_ends_along_a_line_through_zero() {
        for law in ALL {
            let [value, slope] = law.of(0.0);
            assert_eq!(value, 0.0);
            assert!(slope > 0.0, "{law:?}");
            let [above, _] = law.of(TRACE);
            let [below, _] = law.of(TRACE * (1.0 - 1e-12));
            assert!((above / below - 1.0).abs() < 1e-11, "{law:?}");
        }
    }
}
