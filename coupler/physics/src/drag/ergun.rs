//! Ergun 1952.

use super::model::Drag;
use crate::flow_range::{FlowRange, ReynoldsBasis};
use crate::law::LawEntry;
use crate::local::LocalGas;
use crate::pressure_drop::{ERGUN_INERTIAL, ERGUN_VISCOUS};
use crate::sphere;

/// Drag in packed beds after Ergun.
///
/// K_A = V_p μ/d² · (150 (1 − ε)/ε + 1.75 Re), Re = ρ |u − v| d/μ (interstitial), V_p = π d³/6.
///
/// Conversion: the paper gives the pressure gradient of the bed with the superficial velocity
/// U = ε u ([`crate::pressure_drop::ergun`]). It is n F, the full force; so
/// K_A u = ε F = ε (−dp/dx) V_p/(1 − ε), and U = ε u cancels ε³ to the form above.
///
/// Validity: packed beds, ε 0.35 to 0.55. It vanishes with the slip's square for ε → 1, and says
/// nothing of lone particles.
///
/// Source: Ergun, Chem. Eng. Prog. 48 (1952) 89 (no DOI).
#[derive(Clone, Copy, Debug)]
pub struct Ergun;

/// Its entry in a case file.
pub(super) static LAW: LawEntry<dyn Drag> = LawEntry {
    name: "ergun",
    summary: "Packed beds.",
    source: "Ergun, Chem. Eng. Prog. 48 (1952) 89",
    parameters: &[],
    tables: &[],
    make: |_| Box::new(Ergun),
};

impl Drag for Ergun {
    fn name(&self) -> &'static str {
        LAW.name
    }

    fn coefficient(&self, gas: &LocalGas, d: f64) -> f64 {
        let eps = gas.void_fraction.value();
        let re = gas.interstitial_reynolds(d);
        let v_p = sphere::volume_of_diameter(d);
        let scale = v_p * gas.viscosity / (d * d);
        scale * (ERGUN_VISCOUS * (1.0 - eps) / eps + ERGUN_INERTIAL * re)
    }

    fn range(&self) -> FlowRange {
        FlowRange {
            void_fraction: (0.35, 0.55),
            reynolds: (0.0, f64::INFINITY),
            basis: ReynoldsBasis::Interstitial,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::pressure_drop;
    use std::f64::consts::PI;

    #[test]
    fn a_bed_of_such_particles_has_the_pressure_drop_of_the_paper() {
        for (eps, u, d) in [(0.4, 0.5, 2e-3), (0.45, 3.0, 1e-2), (0.55, 1e-4, 1e-4)] {
            let gas = LocalGas::air(eps, u);
            let n = (1.0 - eps) / (PI / 6.0 * f64::powi(d, 3));
            // Form A: ε(−dp/dx) = n K_A u.
            let drop = n * Ergun.coefficient(&gas, d) * u / eps;
            let bed = pressure_drop::ergun(gas.void_fraction, eps * u, 1.2, 1.82e-5, d);
            assert!((drop / bed - 1.0).abs() < 1e-14, "{eps} {u} {d}");
        }
    }

    #[test]
    fn agrees_with_an_independent_evaluation() {
        // In Python, from the pressure gradient: ε = 0.4, 0.5 m/s, 2 mm; ε = 0.45, 0.1 m/s, 1 mm.
        let k = Ergun.coefficient(&LocalGas::air(0.4, 0.5), 2e-3);
        assert!((k / 6.48738882966292e-06 - 1.0).abs() < 1e-12, "{k:e}");
        let k = Ergun.coefficient(&LocalGas::air(0.45, 0.1), 1e-3);
        assert!((k / 1.8570303241219669e-06 - 1.0).abs() < 1e-12, "{k:e}");
    }

    #[test]
    fn grows_with_the_slip_by_its_inertial_term_alone() {
        let at = |u| Ergun.coefficient(&LocalGas::air(0.4, u), 2e-3);
        // dK/du = 1.75 V_p ρ/d = 1.75 (π/6) ρ d².
        let slope = 1.75 * PI / 6.0 * 1.2 * 4e-6;
        assert!(((at(1.5) - at(0.5)) / slope - 1.0).abs() < 1e-12);
    }
}
