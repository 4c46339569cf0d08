//! Beetstra, van der Hoef and Kuipers 2007.

use std::f64::consts::PI;

use super::model::Drag;
use crate::flow_range::{FlowRange, ReynoldsBasis};
use crate::law::LawEntry;
use crate::local::LocalGas;

/// Drag in random arrays of equal spheres from lattice-Boltzmann simulations.
///
/// With φ = 1 − ε and Re = ρ U d/μ, U = ε |u − v| (superficial, diameter):
///
/// F = F₀ + F₁, F₀ = 10 φ/(1 − φ)² + (1 − φ)² (1 + 1.5 √φ),
/// F₁ = 0.413 Re/(24 (1 − φ)²) · n/(1 + 10^(3φ) Re^−(1+4φ)/2),
/// n = (1 − φ)⁻¹ + 3 φ (1 − φ) + 8.4 Re^−0.343
///
/// Conversion: F is the drag alone over 3π μ d U: its packed limit 10 φ/ε² is ε times the
/// 10 φ/ε³ of Carman's whole pressure gradient. So K_A = 3π μ d ε F, and β = 18 μ ε φ F/d² = n K_A.
/// The numerator's Re · Re^−0.343 is written as Re^0.657, which is finite at rest.
///
/// MFiX (`BVK`), OpenFOAM (`Beetstra`, C_d Re = 24 ε F) and Lethe have the same constants; MFiX
/// applies a correction for mixed sizes, whose form A and B differ (the paper's erratum). This
/// law is for one size. For Re = 0 MFiX returns no drag at all, where the law has a limit.
///
/// Validity: φ 0.1 to 0.6, Re up to 1000.
///
/// Sources: Beetstra, van der Hoef and Kuipers, AIChE J. 53 (2007) 489, doi 10.1002/aic.11065,
/// erratum AIChE J. 53 (2007) 3020, doi 10.1002/aic.11330; F at rest: van der Hoef, Beetstra and
/// Kuipers, J. Fluid Mech. 528 (2005) 233, doi 10.1017/S0022112004003295.
#[derive(Clone, Copy, Debug)]
pub struct Beetstra;

/// Its entry in a case file.
pub(super) static LAW: LawEntry<dyn Drag> = LawEntry {
    name: "beetstra",
    summary: "Random arrays of equal spheres by lattice-Boltzmann simulations, to Reynolds numbers of 1000.",
    source: "Beetstra, van der Hoef and Kuipers, AIChE J. 53 (2007) 489, doi 10.1002/aic.11065",
    parameters: &[],
    tables: &[],
    make: |_| Box::new(Beetstra),
};

impl Drag for Beetstra {
    fn name(&self) -> &'static str {
        LAW.name
    }

    fn coefficient(&self, gas: &LocalGas, d: f64) -> f64 {
        let eps = gas.void_fraction.value();
        let phi = 1.0 - eps;
        let re = gas.superficial_reynolds(d);
        let f = creeping(eps, phi) + inertial(eps, phi, re);
        3.0 * PI * gas.viscosity * d * eps * f
    }

    fn range(&self) -> FlowRange {
        FlowRange {
            void_fraction: (0.4, 0.9),
            reynolds: (0.0, 1000.0),
            basis: ReynoldsBasis::Superficial,
        }
    }
}

/// F in creeping flow.
fn creeping(eps: f64, phi: f64) -> f64 {
    10.0 * phi / (eps * eps) + eps * eps * (1.0 + 1.5 * phi.sqrt())
}

/// What inertia adds to F.
fn inertial(eps: f64, phi: f64, re: f64) -> f64 {
    if re == 0.0 {
        return 0.0;
    }
    let growth = (1.0 / eps + 3.0 * phi * eps) * re + 8.4 * re.powf(0.657);
    let damping = 1.0 + 10f64.powf(3.0 * phi) * re.powf(-(1.0 + 4.0 * phi) / 2.0);
    0.413 / (24.0 * eps * eps) * growth / damping
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn reduces_to_stokes_drag_for_a_lone_particle_in_creeping_flow() {
        let k = Beetstra.coefficient(&LocalGas::air(1.0, 0.0), 1e-3);
        assert!((k / (3.0 * PI * 1.82e-5 * 1e-3) - 1.0).abs() < 1e-14, "{k}");
    }

    #[test]
    fn agrees_with_an_independent_evaluation() {
        // In Python, from 3π μ d U F/|u − v| with the formula as printed.
        for (eps, u, d, expected) in [
            (0.4, 0.5, 2e-3, 7.05925587929287e-06),
            (0.45, 0.1, 1e-3, 2.1487721424519434e-06),
            (0.7, 0.5, 1e-3, 1.2249328570092547e-06),
            (0.7, 1e-3, 1e-4, 8.423061469749943e-08),
            (0.95, 5.0, 1e-2, 0.00016897817273337737),
        ] {
            let k = Beetstra.coefficient(&LocalGas::air(eps, u), d);
            assert!((k / expected - 1.0).abs() < 1e-12, "{eps}: {k:e}");
        }
    }

    #[test]
    fn a_packed_bed_in_creeping_flow_has_carman_s_pressure_gradient_and_a_little_more() {
        // The second term of F at ε = 0.4: ε² (1 + 1.5 √0.6) over 10 φ/ε² = 0.92 %.
        let (eps, u, d) = (0.4, 1e-6, 1e-3);
        let n = (1.0 - eps) / (PI / 6.0 * f64::powi(d, 3));
        let gradient = n * Beetstra.coefficient(&LocalGas::air(eps, u), d) * u / eps;
        let carman = 180.0 * 0.36 * 1.82e-5 * (eps * u) / (f64::powi(eps, 3) * d * d);
        assert!(
            (gradient / carman - 1.00922).abs() < 1e-4,
            "{}",
            gradient / carman
        );
    }

    #[test]
    fn inertia_fades_continuously_at_rest_and_grows_with_the_flow() {
        assert!(inertial(0.5, 0.5, 1e-12) < 1e-12);
        let steps: Vec<f64> = (-6..4).map(|k| inertial(0.5, 0.5, 10f64.powi(k))).collect();
        assert!(steps.windows(2).all(|pair| pair[1] > pair[0]), "{steps:?}");
    }
}
