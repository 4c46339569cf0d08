//! Wen and Yu 1966.

use super::model::Drag;
use crate::flow_range::{FlowRange, ReynoldsBasis};
use crate::law::LawEntry;
use crate::local::LocalGas;
use crate::sphere;

/// Drag in suspensions after Wen and Yu.
///
/// K_A = V_p μ/d² · ¾ C_d Re(ε Re) ε^−2.65, Re = ρ |u − v| d/μ (interstitial), V_p = π d³/6,
/// C_d Re(x) = 24 (1 + 0.15 x^0.687) for x ≤ 1000, 0.44 x above (Schiller and Naumann).
///
/// Conversion: the paper weighs fluidised particles, so it states the full force: that of a lone
/// sphere in the same superficial flow U = ε u times ε^−4.7 (4.65 in the form below). The drag is
/// ε times it: K_A u = (π/8) C_d ρ d² U² ε^−3.65, which is the form above. Gidaspow's
/// β = ¾ C_d ε (1 − ε) ρ |u − v| ε^−2.65/d is n K_A. Codes agree on it (MFiX, CFDEMcoupling,
/// Lethe), MFiX with −4.65 + 2 written as −2.65.
///
/// Validity: ε above 0.8, Re up to 2e5. C_d steps up by 0.4 % at ε Re = 1000.
///
/// Sources: Wen and Yu, Chem. Eng. Prog. Symp. Ser. 62 (1966) 100 (no DOI); the exponent in
/// form A: Gidaspow, Multiphase Flow and Fluidization (1994), doi 10.1016/C2009-0-21244-X.
#[derive(Clone, Copy, Debug)]
pub struct WenYu;

/// Its entry in a case file.
pub(super) static LAW: LawEntry<dyn Drag> = LawEntry {
    name: "wen-yu",
    summary: "Suspensions, void fractions above 0.8.",
    source: "Wen and Yu, Chem. Eng. Prog. Symp. Ser. 62 (1966) 100",
    parameters: &[],
    tables: &[],
    make: |_| Box::new(WenYu),
};

impl Drag for WenYu {
    fn name(&self) -> &'static str {
        LAW.name
    }

    fn coefficient(&self, gas: &LocalGas, d: f64) -> f64 {
        let eps = gas.void_fraction.value();
        let re = gas.interstitial_reynolds(d);
        let v_p = sphere::volume_of_diameter(d);
        let scale = v_p * gas.viscosity / (d * d);
        scale * 0.75 * drag_times_reynolds(eps * re) * eps.powf(-2.65)
    }

    fn range(&self) -> FlowRange {
        FlowRange {
            void_fraction: (0.8, 1.0),
            reynolds: (0.0, 2e5),
            basis: ReynoldsBasis::Superficial,
        }
    }
}

/// C_d Re of a sphere as a function of Re.
fn drag_times_reynolds(re: f64) -> f64 {
    if re <= 1000.0 {
        24.0 * (1.0 + 0.15 * re.powf(0.687))
    } else {
        0.44 * re
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::PI;

    #[test]
    fn reduces_to_stokes_drag_for_a_lone_particle_in_creeping_flow() {
        let d = 1e-4;
        let k = WenYu.coefficient(&LocalGas::air(1.0, 0.0), d);
        assert!((k / (3.0 * PI * 1.82e-5 * d) - 1.0).abs() < 1e-14, "{k}");
    }

    #[test]
    fn agrees_with_an_independent_evaluation_of_both_branches() {
        // In Python, from Gidaspow's β V_p/(1 − ε): 1 mm at 0.5 m/s (ε Re = 29.7), ε = 0.9;
        // 0.7; 1 cm at 5 m/s (ε Re = 3132), ε = 0.95.
        for (eps, u, d, expected) in [
            (0.9, 0.5, 1e-3, 5.760597615061594e-07),
            (0.7, 0.5, 1e-3, 1.013441426536769e-06),
            (0.95, 5.0, 1e-2, 0.00011282877263121512),
        ] {
            let k = WenYu.coefficient(&LocalGas::air(eps, u), d);
            assert!((k / expected - 1.0).abs() < 1e-12, "{eps}: {k:e}");
        }
    }

    #[test]
    fn steps_by_less_than_half_a_percent_where_the_drag_coefficient_becomes_constant() {
        let (below, above) = (
            drag_times_reynolds(1000.0),
            drag_times_reynolds(1000.0 + 1e-9),
        );
        assert!((above / below - 1.0).abs() < 5e-3, "{below} {above}");
        assert!(drag_times_reynolds(999.0) < below && drag_times_reynolds(1001.0) > above);
    }

    #[test]
    fn the_drag_of_fast_flow_starts_above_a_reynolds_number_of_1000() {
        // 24 (1 + 0.15·1000^0.687) = 438.288140 against 440; 0.5 % to either side still 1.
        let jump = drag_times_reynolds(1000.0 * (1.0 + 1e-12)) / drag_times_reynolds(1000.0);
        assert!((jump / (440.0 / 438.288_140) - 1.0).abs() < 1e-6, "{jump}");
        for re in [995.0, 1005.0] {
            let ratio = drag_times_reynolds(re * (1.0 + 1e-12)) / drag_times_reynolds(re);
            assert!((ratio - 1.0).abs() < 1e-9, "{re}");
        }
        assert_eq!(drag_times_reynolds(1005.0), 0.44 * 1005.0);
    }
}
