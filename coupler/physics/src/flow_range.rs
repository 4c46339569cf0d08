//! The flow that a correlation was published for.

use crate::local::LocalGas;

/// Which slip the Reynolds number of a correlation is made with.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ReynoldsBasis {
    /// The superficial slip ε |u − v|.
    Superficial,
    /// The interstitial slip |u − v|.
    Interstitial,
}

/// Range of void fraction and Reynolds number, on the diameter, that the source of a correlation states. A law is
/// evaluated beyond it as it stands; a run counts and reports where it is (docs/reference/results.md).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FlowRange {
    /// Lowest and highest void fraction.
    pub void_fraction: (f64, f64),
    /// Lowest and highest Reynolds number.
    pub reynolds: (f64, f64),
    /// What the Reynolds number is made with.
    pub basis: ReynoldsBasis,
}

impl FlowRange {
    /// The range of a law whose source states none.
    pub const UNSTATED: Self = Self {
        void_fraction: (0.0, 1.0),
        reynolds: (0.0, f64::INFINITY),
        basis: ReynoldsBasis::Superficial,
    };

    /// The range of a law of a force in a flow: without slip there is none, whatever the law.
    #[must_use]
    pub fn of_force(mut self, gas: &LocalGas) -> Self {
        if gas.slip == 0.0 {
            self.reynolds.0 = 0.0;
        }
        self
    }

    /// The Reynolds number that the range is of, at a sphere of a diameter in m.
    pub fn reynolds_of(&self, gas: &LocalGas, diameter: f64) -> f64 {
        match self.basis {
            ReynoldsBasis::Superficial => gas.superficial_reynolds(diameter),
            ReynoldsBasis::Interstitial => gas.interstitial_reynolds(diameter),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::drag::DRAG_LAWS;
    use crate::heat_transfer::HEAT_TRANSFER_LAWS;

    #[test]
    fn ranges_are_of_positive_width_and_hold_void_fractions_of_beds() {
        let drag = DRAG_LAWS.iter().map(|law| law.by_default().range());
        let heat = HEAT_TRANSFER_LAWS
            .iter()
            .map(|law| law.by_default().range());
        for range in drag.chain(heat) {
            let (low, high) = range.void_fraction;
            assert!(0.0 <= low && low < high && high <= 1.0, "{range:?}");
            assert!(0.0 <= range.reynolds.0 && range.reynolds.0 < range.reynolds.1);
        }
    }

    #[test]
    fn a_reynolds_number_is_made_with_the_slip_that_its_range_names() {
        let gas = LocalGas::of_numbers(0.5, 8.0, 0.7);
        let of = |basis| {
            FlowRange {
                basis,
                ..FlowRange::UNSTATED
            }
            .reynolds_of(&gas, 1.0)
        };
        assert_eq!(of(ReynoldsBasis::Interstitial), 8.0);
        assert_eq!(of(ReynoldsBasis::Superficial), 4.0);
    }
}
