//! Syamlal and O'Brien 1988.

use std::f64::consts::PI;

use super::model::Drag;
use crate::dimension::Dimension;
use crate::flow_range::{FlowRange, ReynoldsBasis};
use crate::law::{Bound, LawEntry, LawParameter};
use crate::local::LocalGas;

/// Void fraction at which B changes.
const DILUTE: f64 = 0.85;

/// Drag by the velocities at which suspensions settle.
///
/// With Re = ρ |u − v| d/μ (interstitial, diameter) and v_r, the velocity at which a suspension settles over that of a lone sphere:
///
/// β = 3 ε (1 − ε) ρ |u − v|/(4 v_r² d) · (0.63 + 4.8 √(v_r/Re))²,
/// v_r = ½ (A − 0.06 Re + √((0.06 Re)² + 0.12 Re (2B − A) + A²)),
/// A = ε^4.14, B = c ε^1.28 for ε ≤ 0.85, ε^d above.
///
/// v_r is Garside's and Al-Dibouni's, C_d Dalla Valle's of a lone sphere at Re/v_r. Conversion: MFiX' model A has this β beside −ε∇p, so
/// K_A = β V_p/(1 − ε) = π/8 μ d ε (0.63 √Re + 4.8 √v_r)²/v_r², which is finite at rest.
///
/// c = 0.8 and d = 2.65 by default. They are adjusted to a measured minimum fluidisation (MFiX' `drag_c1`, `drag_d1`); B has no jump
/// where c 0.85^1.28 = 0.85^d.
///
/// Validity: settling and fluidised suspensions. In packed beds it is low: at ε = 0.45 and Re of a few it has 0.6 times the drag by Ergun.
/// A lone sphere in creeping flow has 0.96 of Stokes' drag, by Dalla Valle.
///
/// Point, by β as printed: air of ρ = 1.2 kg/m³ and μ = 1.82e-5 Pa s, ε = 0.6, |u − v| = 0.5 m/s, d = 2 mm has Re = 65.934,
/// v_r = 0.389551, β = 355.102 kg/m³/s and K_A = 355.102 π d³/6/0.4 = 3.71862e-6 kg/s.
///
/// Sources: Syamlal and O'Brien, Int. J. Multiphase Flow 14 (1988) 473, doi 10.1016/0301-9322(88)90023-7; Syamlal, Rogers and O'Brien, MFIX
/// documentation: theory guide, DOE/METC-94/1004 (1993); v_r: Garside and Al-Dibouni, Ind. Eng. Chem. Process Des. Dev. 16 (1977) 206,
/// doi 10.1021/i260062a008.
#[derive(Clone, Copy, Debug)]
pub struct SyamlalOBrien {
    /// c, of dense suspensions.
    pub dense_factor: f64,
    /// d, of dilute ones.
    pub dilute_exponent: f64,
}

/// Its entry in a case file.
pub(super) static LAW: LawEntry<dyn Drag> = LawEntry {
    name: "syamlal-obrien",
    summary: "Settling and fluidised suspensions, by the velocities at which they settle; low in packed beds.",
    source: "Syamlal and O'Brien, Int. J. Multiphase Flow 14 (1988) 473, doi 10.1016/0301-9322(88)90023-7",
    parameters: &[
        LawParameter {
            name: "dense_factor",
            dimension: Dimension::NONE,
            bound: Bound::Positive,
            default: Some(0.8),
            needed_with: None,
            meaning: "Factor c of B = c eps^1.28 up to a void fraction of 0.85; adjusted to a measured minimum fluidisation.",
            example: "0.8",
        },
        LawParameter {
            name: "dilute_exponent",
            dimension: Dimension::NONE,
            bound: Bound::Positive,
            default: Some(2.65),
            needed_with: None,
            meaning: "Exponent d of B = eps^d above it; B has no jump where c 0.85^1.28 = 0.85^d.",
            example: "2.65",
        },
    ],
    tables: &[],
    make: |values| {
        Box::new(SyamlalOBrien {
            dense_factor: values[0],
            dilute_exponent: values[1],
        })
    },
};

impl SyamlalOBrien {
    /// Velocity at which a suspension settles over that of a lone sphere.
    fn settling_ratio(&self, eps: f64, re: f64) -> f64 {
        let a = eps.powf(4.14);
        let b = match eps <= DILUTE {
            true => self.dense_factor * eps.powf(1.28),
            false => eps.powf(self.dilute_exponent),
        };
        // (v − A)/(B − v) = 0.06 Re/v
        let slowed = a - 0.06 * re;
        0.5 * (slowed + (slowed * slowed + 0.24 * re * b).sqrt())
    }
}

impl Drag for SyamlalOBrien {
    fn name(&self) -> &'static str {
        LAW.name
    }

    fn coefficient(&self, gas: &LocalGas, d: f64) -> f64 {
        let eps = gas.void_fraction.value();
        let re = gas.interstitial_reynolds(d);
        let ratio = self.settling_ratio(eps, re);
        let root = 0.63 * re.sqrt() + 4.8 * ratio.sqrt();
        PI / 8.0 * gas.viscosity * d * eps * (root / ratio).powi(2)
    }

    fn range(&self) -> FlowRange {
        FlowRange {
            void_fraction: (0.4, 1.0),
            reynolds: (0.0, 1e4),
            basis: ReynoldsBasis::Interstitial,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const LAW_OF_MFIX: SyamlalOBrien = SyamlalOBrien {
        dense_factor: 0.8,
        dilute_exponent: 2.65,
    };

    #[test]
    fn agrees_with_an_independent_evaluation() {
        // In Python, β V_p/(1 − ε) with v_r by bisection of its implicit form.
        for (eps, u, d, expected) in [
            (0.45, 0.1, 1e-3, 1.1173047564381619e-06),
            (0.6, 0.5, 2e-3, 3.71862303017714e-06),
            (0.85, 0.5, 1e-3, 8.717836698322143e-07),
            (0.95, 2.0, 1e-3, 1.2383213201989036e-06),
            (0.9999, 0.3, 2e-4, 5.239254824217239e-08),
        ] {
            let k = LAW_OF_MFIX.coefficient(&LocalGas::air(eps, u), d);
            assert!((k / expected - 1.0).abs() < 1e-12, "{eps}: {k:e}");
        }
        let adjusted = SyamlalOBrien {
            dense_factor: 0.3,
            dilute_exponent: 8.0,
        };
        for (eps, expected) in [(0.6, 1.7581638079590968e-05), (0.9, 4.372555464154033e-06)] {
            let k = adjusted.coefficient(&LocalGas::air(eps, 0.5), 2e-3);
            assert!((k / expected - 1.0).abs() < 1e-12, "{eps}: {k:e}");
        }
    }

    #[test]
    fn a_suspension_settles_so_much_slower_than_a_lone_sphere_as_garside_and_al_dibouni_found() {
        // K u = ε times the weight less buoyancy, which a lone sphere of the same law has at u/v_r.
        for (eps, u) in [(0.5, 0.02), (0.7, 0.1), (0.9, 0.5)] {
            let d = 5e-4;
            let suspended = LAW_OF_MFIX.coefficient(&LocalGas::air(eps, u), d) * u / eps;
            let re = LocalGas::air(eps, u).interstitial_reynolds(d);
            let ratio = LAW_OF_MFIX.settling_ratio(eps, re);
            let alone = LAW_OF_MFIX.coefficient(&LocalGas::air(1.0, u / ratio), d) * u / ratio;
            assert!((suspended / alone - 1.0).abs() < 1e-12, "{eps}");
        }
    }
}
