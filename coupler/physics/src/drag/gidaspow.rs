//! Gidaspow's Ergun and Wen-Yu, blended.

use std::f64::consts::PI;

use super::model::Drag;
use super::{Ergun, WenYu};
use crate::law::LawEntry;
use crate::local::LocalGas;

/// Ergun in dense, Wen and Yu in dilute beds, with a smooth passage at ε = 0.8.
///
/// K_A = (1 − w) K_Ergun + w K_WenYu,  w = ½ + arctan(150 · 1.75 (ε − 0.8))/π
///
/// Conversion: both parts are K_A already ([`Ergun`], [`WenYu`]); β in the sources is n K_A, form A.
///
/// The definitions differ. Gidaspow's book and Ding and Gidaspow (1990) switch at ε = 0.8: that
/// law is [`super::ErgunWenYu`], and MFiX' `GIDASPOW`, CFDEMcoupling and Lethe have it (CFDEM and
/// Lethe without the constant drag coefficient above Re = 1000, Lethe's switch at ε > 0.8). The
/// arctangent is Huilin and Gidaspow's, made so that β has no step; MFiX' `GIDASPOW_BLEND` has the
/// same formula (and names its original source unknown). Its tails are long: at ε = 0.4 Wen and
/// Yu still weigh 0.30 %, so a packed bed has not quite Ergun's pressure drop.
///
/// Validity: packed and fluidised beds of spheres.
///
/// Sources: Huilin and Gidaspow, Chem. Eng. Sci. 58 (2003) 3777, doi 10.1016/S0009-2509(03)00238-0;
/// Ding and Gidaspow, AIChE J. 36 (1990) 523, doi 10.1002/aic.690360404.
#[derive(Clone, Copy, Debug)]
pub struct Gidaspow;

/// Void fraction in the middle of the passage.
const PASSAGE: f64 = 0.8;
/// Steepness of the passage, 150 · 1.75.
const STEEPNESS: f64 = 262.5;

/// Its entry in a case file.
pub(super) static LAW: LawEntry<dyn Drag> = LawEntry {
    name: "gidaspow",
    summary: "Ergun and Wen and Yu with a smooth passage at a void fraction of 0.8.",
    source: "Huilin and Gidaspow, Chem. Eng. Sci. 58 (2003) 3777, doi 10.1016/S0009-2509(03)00238-0",
    parameters: &[],
    tables: &[],
    make: |_| Box::new(Gidaspow),
};

impl Drag for Gidaspow {
    fn name(&self) -> &'static str {
        LAW.name
    }

    fn coefficient(&self, gas: &LocalGas, d: f64) -> f64 {
        let w = dilute_weight(gas.void_fraction.value());
        (1.0 - w) * Ergun.coefficient(gas, d) + w * WenYu.coefficient(gas, d)
    }
}

/// Weight of the dilute law.
fn dilute_weight(eps: f64) -> f64 {
    0.5 + (STEEPNESS * (eps - PASSAGE)).atan() / PI
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn agrees_with_an_independent_evaluation_on_both_sides_of_the_passage() {
        // In Python; w = 0.11575 at ε = 0.79, 0.79293 at 0.805.
        for (eps, u, d, expected) in [
            (0.4, 0.5, 2e-3, 6.4962633265183385e-06),
            (0.79, 0.3, 1e-3, 7.015141146584159e-07),
            (0.805, 0.3, 1e-3, 6.244022184432803e-07),
        ] {
            let k = Gidaspow.coefficient(&LocalGas::air(eps, u), d);
            assert!((k / expected - 1.0).abs() < 1e-12, "{eps}: {k:e}");
        }
    }

    #[test]
    fn is_half_of_each_law_at_a_void_fraction_of_0_8() {
        let gas = LocalGas::air(0.8, 0.3);
        let half = 0.5 * (Ergun.coefficient(&gas, 1e-3) + WenYu.coefficient(&gas, 1e-3));
        assert!((Gidaspow.coefficient(&gas, 1e-3) / half - 1.0).abs() < 1e-13);
    }

    #[test]
    fn has_no_step_where_the_switched_law_has_one() {
        let step = |law: &dyn Drag| {
            let [below, above] =
                [0.8 - 1e-9, 0.8 + 1e-9].map(|eps| law.coefficient(&LocalGas::air(eps, 0.3), 1e-3));
            (above / below - 1.0).abs()
        };
        assert!(step(&Gidaspow) < 1e-6);
        assert!(step(&super::super::ErgunWenYu) > 0.05);
    }

    #[test]
    fn is_ergun_within_a_third_of_a_percent_of_the_difference_in_a_packed_bed() {
        assert!((dilute_weight(0.4) - 0.00303).abs() < 1e-5);
        assert!((dilute_weight(1.0) - 0.99394).abs() < 1e-5);
    }
}
