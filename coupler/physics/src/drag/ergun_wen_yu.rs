//! Ergun below, Wen and Yu above a void fraction of 0.8.

use super::model::Drag;
use super::{Ergun, WenYu};
use crate::law::LawEntry;
use crate::local::LocalGas;

/// Drag in dense beds after Ergun and in dilute ones after Wen and Yu (Gidaspow's switch).
///
/// With Re = ρ |u − v| d/μ (interstitial) and V_p = π d³/6, the full form, drag and pressure force
/// in one, is F = (K_A/ε)(u − v) with
///
/// K_A/ε = V_p μ/(ε d²) · (150 (1 − ε)/ε + 1.75 Re)                       for ε < 0.8,
/// K_A/ε = V_p μ/(ε d²) · ¾ C_d Re(ε Re) ε^−2.65                           else,
/// C_d Re(x) = 24 (1 + 0.15 x^0.687) for x ≤ 1000, 0.44 x above.
///
/// Conversion: the papers' coefficient balances −∇p on the gas; it is K_A/ε (docs/theory.md, DRG-1),
/// so this law returns ε times it, for use with −ε∇p.
///
/// Validity: packed and fluidised beds of spheres. The two branches do not meet at ε = 0.8;
/// [`super::Gidaspow`] blends them.
///
/// Sources: Ergun, Chem. Eng. Prog. 48 (1952) 89; Wen and Yu, Chem. Eng. Prog. Symp. Ser. 62
/// (1966) 100; the switch: Gidaspow, Multiphase Flow and Fluidization (1994),
/// doi 10.1016/C2009-0-21244-X.
#[derive(Clone, Copy, Debug)]
pub struct ErgunWenYu;

/// Void fraction at which Wen and Yu take over from Ergun.
const SWITCH: f64 = 0.8;

/// Its entry in a case file.
pub(super) static LAW: LawEntry<dyn Drag> = LawEntry {
    name: "ergun-wen-yu",
    summary: "Ergun below a void fraction of 0.8, Wen and Yu above.",
    source: "Gidaspow, Multiphase Flow and Fluidization (1994), doi 10.1016/C2009-0-21244-X",
    parameters: &[],
    tables: &[],
    make: |_| Box::new(ErgunWenYu),
};

impl Drag for ErgunWenYu {
    fn name(&self) -> &'static str {
        LAW.name
    }

    fn coefficient(&self, gas: &LocalGas, d: f64) -> f64 {
        if gas.void_fraction.value() < SWITCH {
            Ergun.coefficient(gas, d)
        } else {
            WenYu.coefficient(gas, d)
        }
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::PI;

    use super::*;
    use crate::numbers::VoidFraction;

    fn gas(eps: f64, slip: f64) -> LocalGas {
        LocalGas {
            void_fraction: VoidFraction::new(eps).unwrap(),
            density: 1.2,
            viscosity: 1.82e-5,
            conductivity: 0.026,
            heat_capacity: 1006.0,
            slip,
        }
    }

    #[test]
    fn reduces_to_stokes_drag_for_a_lone_particle_in_creeping_flow() {
        let d = 1e-4;
        let stokes = 3.0 * PI * 1.82e-5 * d;
        let k = ErgunWenYu.coefficient(&gas(1.0, 1e-9), d);
        assert!((k / stokes - 1.0).abs() < 1e-3, "{k} {stokes}");
    }

    #[test]
    fn a_uniform_bed_has_the_pressure_drop_of_ergun() {
        // Requirements COR-5: 14 mm spheres, ε = 0.4, 145 mm, μ = 1.82e-5 Pa s, ρ = 1.2 kg/m³.
        for (superficial, expected) in [(0.5, 56.6568), (1.0, 215.2667), (2.0, 838.3460)] {
            let (eps, d) = (0.4, 0.014);
            let u = superficial / eps;
            let number_density = (1.0 - eps) / (PI / 6.0 * f64::powi(d, 3));
            // Model A: ε dp/dx = −n K_A u
            let k = ErgunWenYu.coefficient(&gas(eps, u), d);
            let drop = number_density * k * u / eps * 0.145;
            assert!((drop / expected - 1.0).abs() < 2e-6, "{drop} {expected}");
        }
    }

    #[test]
    fn agrees_with_an_independent_evaluation_of_both_wen_yu_branches() {
        // Evaluated apart from this code, in Python: ε = 0.9, ρ = 1.2, μ = 1.82e-5, d = 1 mm, slip 0.5 m/s:
        // ε Re = 29.67032967, C_d Re = 60.964767, K_A = π/6·1e-3·1.82e-5·¾·C_d Re·0.9^−2.65.
        let k = ErgunWenYu.coefficient(&gas(0.9, 0.5), 1e-3);
        let re: f64 = 0.9 * 1.2 * 0.5 * 1e-3 / 1.82e-5;
        assert!((re - 29.670_329_67).abs() < 1e-8);
        assert!((k / 5.760_597_615e-7 - 1.0).abs() < 1e-9, "{k:e}");
        // Re > 1000: ε Re = 0.9·1.2·5·0.01/1.82e-5 = 2967.03, C_d Re = 1305.4945.
        let k = ErgunWenYu.coefficient(&gas(0.9, 5.0), 1e-2);
        assert!((k / 1.233_569_639e-4 - 1.0).abs() < 1e-9, "{k:e}");
    }

    /// K_A at a void fraction over K_A just below it.
    fn ratio_across(eps: f64, slip: f64) -> f64 {
        let below = ErgunWenYu.coefficient(&gas(eps * (1.0 - 1e-12), slip), 1e-3);
        ErgunWenYu.coefficient(&gas(eps, slip), 1e-3) / below
    }

    #[test]
    fn wen_and_yu_take_over_at_a_void_fraction_of_0_8_with_a_jump() {
        // In creeping flow Ergun gives 150·0.2/0.8 = 37.5, Wen and Yu 18·0.8^−2.65 = 32.515021.
        assert!((ratio_across(0.8, 0.0) / (32.515_021 / 37.5) - 1.0).abs() < 1e-6);
        for eps in [0.793, 0.807] {
            assert!((ratio_across(eps, 0.0) - 1.0).abs() < 1e-9, "{eps}");
        }
    }
}
