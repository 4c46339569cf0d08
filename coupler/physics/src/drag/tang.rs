//! Tang, Peters, Kuipers, Kriebitzsch and van der Hoef 2015.

use std::f64::consts::PI;

use super::model::Drag;
use crate::flow_range::{FlowRange, ReynoldsBasis};
use crate::law::LawEntry;
use crate::local::LocalGas;

/// Drag in random arrays of equal spheres from simulations with immersed boundaries.
///
/// With φ = 1 − ε and Re = ρ U d/μ, U = ε |u − v| (superficial, diameter):
///
/// F = 10 φ/(1 − φ)² + (1 − φ)² (1 + 1.5 √φ)
///     + [0.11 φ (1 + φ) − 0.00456/(1 − φ)⁴ + (0.169 (1 − φ) + 0.0644/(1 − φ)⁴) Re^−0.343] Re
///
/// Conversion: F is the drag alone over 3π μ d U, as Beetstra's, whose limit at rest it shares. So K_A = 3π μ d ε F. The term
/// Re · Re^−0.343 is written as Re^0.657, which is finite at rest. OpenFOAM's `Tang` is the same (C_d Re = 24 ε F).
///
/// The spheres of the arrays are held: spheres that move feel more drag where they fluctuate (Tang, Peters and Kuipers, AIChE J. 62
/// (2016) 1958).
///
/// Validity: φ 0 to 0.6, Re up to 1000. Of a lone sphere it has 1.07 times Schiller and Naumann's drag at Re = 1, 1.18 times at
/// 100 and the same at 1000. Far beyond, from Re of about 1e5 in dilute flow, it falls below zero, which ends a run with an error.
///
/// In dense arrays it is far below Ergun's law where inertia counts: at φ = 0.55 it has 0.34 of Ergun's drag at Re = 929 (Beetstra's 0.69,
/// Tenneti's 0.45).
///
/// Point, by F as printed: air of ρ = 1.2 kg/m³ and μ = 1.82e-5 Pa s, ε = 0.7, |u − v| = 0.5 m/s, d = 1 mm has Re = 23.0769,
/// F = 10.6061 and K_A = 3π μ d 0.7 · 10.6061 = 1.27349e-6 kg/s.
///
/// Source: Tang, Peters, Kuipers, Kriebitzsch and van der Hoef, AIChE J. 61 (2015) 688, doi 10.1002/aic.14645.
#[derive(Clone, Copy, Debug)]
pub struct Tang;

/// Its entry in a case file.
pub(super) static LAW: LawEntry<dyn Drag> = LawEntry {
    name: "tang",
    summary: "Random arrays of equal spheres by simulations with immersed boundaries, to Reynolds numbers of 1000.",
    source: "Tang, Peters, Kuipers, Kriebitzsch and van der Hoef, AIChE J. 61 (2015) 688, doi 10.1002/aic.14645",
    parameters: &[],
    tables: &[],
    make: |_| Box::new(Tang),
};

impl Drag for Tang {
    fn name(&self) -> &'static str {
        LAW.name
    }

    fn coefficient(&self, gas: &LocalGas, d: f64) -> f64 {
        let eps = gas.void_fraction.value();
        let phi = 1.0 - eps;
        let re = gas.superficial_reynolds(d);
        let fourth = eps.powi(4);
        let creeping = 10.0 * phi / (eps * eps) + eps * eps * (1.0 + 1.5 * phi.sqrt());
        let linear = 0.11 * phi * (1.0 + phi) - 0.00456 / fourth;
        let slower = 0.169 * eps + 0.0644 / fourth;
        let f = creeping + linear * re + slower * re.powf(0.657);
        3.0 * PI * gas.viscosity * d * eps * f
    }

    fn range(&self) -> FlowRange {
        FlowRange {
            void_fraction: (0.4, 1.0),
            reynolds: (0.0, 1000.0),
            basis: ReynoldsBasis::Superficial,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::Beetstra;
    use super::*;

    #[test]
    fn agrees_with_an_independent_evaluation() {
        // In Python, from 3π μ d U F/|u − v| with the formula as printed.
        for (eps, u, d, expected) in [
            (0.4, 0.5, 2e-3, 7.97392859872182e-06),
            (0.45, 0.1, 1e-3, 2.385200200893085e-06),
            (0.7, 0.5, 1e-3, 1.2734924504812863e-06),
            (0.9, 1e-3, 1e-4, 3.762859428689826e-08),
            (0.9, 5.0, 2e-3, 6.823138856743216e-06),
        ] {
            let k = Tang.coefficient(&LocalGas::air(eps, u), d);
            assert!((k / expected - 1.0).abs() < 1e-12, "{eps}: {k:e}");
        }
    }

    #[test]
    fn in_creeping_flow_it_is_beetstra_s_law() {
        for eps in [0.4, 0.6, 0.9, 1.0] {
            let gas = LocalGas::air(eps, 0.0);
            let ratio = Tang.coefficient(&gas, 1e-3) / Beetstra.coefficient(&gas, 1e-3);
            assert!((ratio - 1.0).abs() < 1e-14, "{eps}: {ratio}");
        }
    }
}
