//! Di Felice 1994.

use std::f64::consts::PI;

use super::model::Drag;
use crate::flow_range::{FlowRange, ReynoldsBasis};
use crate::law::LawEntry;
use crate::local::LocalGas;

/// Drag of a lone sphere in the same superficial flow times a power of the void fraction.
///
/// f = (π/8) C_d ρ d² U² ε^−χ, U = ε |u − v|, Re = ρ U d/μ (superficial),
/// C_d = (0.63 + 4.8/√Re)² (Dallavalle), χ = 3.7 − 0.65 exp(−(1.5 − log₁₀ Re)²/2);
///
/// K_A = f/|u − v| = (π/8) μ d (0.63 √Re + 4.8)² ε^(1−χ), which needs no division by Re.
///
/// Conversion: f is the drag alone. Its limits show it: χ = 3.7 in slow and in fast flow, where
/// the full force of suspended particles goes with ε^−4.7 (Wen and Yu); the drag is ε times that.
/// In a packed bed of ε = 0.4 it gives 0.91 of Ergun's drag in creeping flow; read as a full
/// force it would give 0.36.
///
/// CFDEMcoupling has this form (ε^(2−χ), superficial Re); Lethe changed by ε² between versions
/// (now ε^(2−χ) too).
///
/// Validity: the whole range of ε, Re 0.01 to 1e4. In creeping flow C_d Re is 23.04, not 24: a
/// lone particle has 0.96 of Stokes' drag.
///
/// Sources: Di Felice, Int. J. Multiphase Flow 20 (1994) 153, doi 10.1016/0301-9322(94)90011-6;
/// Dallavalle, Micromeritics (1948).
#[derive(Clone, Copy, Debug)]
pub struct DiFelice;

/// Its entry in a case file.
pub(super) static LAW: LawEntry<dyn Drag> = LawEntry {
    name: "di-felice",
    summary: "A lone sphere times a power of the void fraction, packed to dilute.",
    source: "Di Felice, Int. J. Multiphase Flow 20 (1994) 153, doi 10.1016/0301-9322(94)90011-6",
    parameters: &[],
    tables: &[],
    make: |_| Box::new(DiFelice),
};

impl Drag for DiFelice {
    fn name(&self) -> &'static str {
        LAW.name
    }

    fn coefficient(&self, gas: &LocalGas, d: f64) -> f64 {
        let eps = gas.void_fraction.value();
        let re = gas.superficial_reynolds(d);
        let cd_re = (0.63 * re.sqrt() + 4.8).powi(2);
        PI / 8.0 * gas.viscosity * d * cd_re * eps.powf(1.0 - exponent(re))
    }

    fn range(&self) -> FlowRange {
        FlowRange {
            void_fraction: (0.0, 1.0),
            reynolds: (0.01, 1e4),
            basis: ReynoldsBasis::Superficial,
        }
    }
}

/// Exponent χ of the voidage function.
fn exponent(re: f64) -> f64 {
    if re == 0.0 {
        // The limit: log₁₀ Re → −∞.
        return 3.7;
    }
    3.7 - 0.65 * (-(1.5 - re.log10()).powi(2) / 2.0).exp()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn agrees_with_an_independent_evaluation() {
        // In Python, from f/|u − v|: Re = 26.4 (the middle of χ's dip), 23.1, 2.97, 3132, 0.0046.
        for (eps, u, d, expected) in [
            (0.4, 0.5, 2e-3, 6.049976769347733e-06),
            (0.7, 0.5, 1e-3, 9.114752221683193e-07),
            (0.45, 0.1, 1e-3, 1.5741309812775976e-06),
            (0.95, 5.0, 1e-2, 0.00013111514650305725),
            (0.7, 1e-3, 1e-4, 4.390311898239758e-08),
        ] {
            let k = DiFelice.coefficient(&LocalGas::air(eps, u), d);
            assert!((k / expected - 1.0).abs() < 1e-12, "{eps}: {k:e}");
        }
    }

    #[test]
    fn a_lone_particle_at_rest_has_0_96_of_stokes_drag() {
        let k = DiFelice.coefficient(&LocalGas::air(1.0, 0.0), 1e-3);
        assert!(
            (k / (3.0 * PI * 1.82e-5 * 1e-3) - 0.96).abs() < 1e-14,
            "{k}"
        );
    }

    #[test]
    fn the_exponent_is_3_7_in_slow_and_fast_flow_and_3_05_between() {
        assert_eq!(exponent(0.0), 3.7);
        assert!((exponent(1e-6) - 3.7).abs() < 1e-9);
        assert!((exponent(1e9) - 3.7).abs() < 1e-9);
        assert!((exponent(10f64.powf(1.5)) - 3.05).abs() < 1e-14);
    }

    #[test]
    fn is_no_full_force_a_packed_bed_in_creeping_flow_has_0_91_of_ergun() {
        let gas = LocalGas::air(0.4, 0.0);
        let ratio = DiFelice.coefficient(&gas, 1e-3) / super::super::Ergun.coefficient(&gas, 1e-3);
        assert!((ratio - 0.912).abs() < 1e-3, "{ratio}");
    }
}
