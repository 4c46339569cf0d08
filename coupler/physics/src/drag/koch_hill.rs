//! Koch and Hill 2001, after Hill, Koch and Ladd 2001.

use std::f64::consts::PI;

use super::model::Drag;
use crate::flow_range::{FlowRange, ReynoldsBasis};
use crate::law::LawEntry;
use crate::local::LocalGas;

/// Drag in random arrays of spheres from lattice-Boltzmann simulations.
///
/// With φ = 1 − ε and Re = ρ U a/μ on the **radius** a = d/2 and the superficial U = ε |u − v|:
///
/// F = F₀(φ) + F₃(φ) Re
///
/// F₀ = (1 + 3 √(φ/2) + (135/64) φ ln φ + 17.14 φ)/(1 + 0.681 φ − 8.48 φ² + 8.16 φ³), φ < 0.4,
/// F₀ = 10 φ/(1 − φ)³ above;  F₃ = 0.0673 + 0.212 φ + 0.0232/(1 − φ)⁵
///
/// Conversion: F is the full force over 6π μ a U. (In a packed bed F₀ = 10φ/ε³ makes n F·6πμaU =
/// 180 φ² μ U/(ε³ d²), Carman's whole pressure gradient.) So K_A |u − v| = ε · 6π μ a U F, that is
/// K_A = 3π μ d ε² F; the two-fluid β = 18 μ ε² φ F/d² is n K_A, form A. On the diameter's
/// Reynolds number the inertial term is ½ F₃ Re.
///
/// The codes disagree, in four ways.
/// - 17.14 (MFiX) or 16.14 (CFDEMcoupling, Lethe, and works after Link et al. 2005). 17.14 − 0.681
///   = 16.46 is the coefficient 16.456 of φ in Kim and Russel's expansion for dilute fixed beds,
///   whose first terms 3/√2 and 135/64 are the ones above: 17.14 is what the form is made for.
///   16.14 joins the dense branch better (1 % instead of 4 %). The two differ by 4.4 % at φ = 0.2,
///   and not at all from φ = 0.4 on.
/// - CFDEMcoupling writes `135/64` in integers: 2 instead of 2.109.
/// - MFiX has Benyahia et al.'s extension: F₀ + F₁ Re² in slow, F₂ + F₃ Re in fast flow, other F₃
///   below φ = 0.0953, and the branches at φ = 0.4 blended.
/// - Lethe has taken ε Re and Re, superficial and interstitial, for the Reynolds number.
///
/// Validity: φ 0 to 0.64, Re up to about 100; below Re ≈ 5 the inertial part grows as Re², which
/// the linear term overstates. F₀ steps down by 3.8 % at φ = 0.4.
///
/// Sources: Koch and Hill, Annu. Rev. Fluid Mech. 33 (2001) 619, doi 10.1146/annurev.fluid.33.1.619;
/// Hill, Koch and Ladd, J. Fluid Mech. 448 (2001) 213 and 243, doi 10.1017/S0022112001005948 and
/// 10.1017/S0022112001005936; Benyahia, Syamlal and O'Brien, Powder Technol. 162 (2006) 166,
/// doi 10.1016/j.powtec.2005.12.014.
#[derive(Clone, Copy, Debug)]
pub struct KochHill;

/// Solid fraction from which F₀ is Carman's.
const DENSE: f64 = 0.4;

/// Its entry in a case file.
pub(super) static LAW: LawEntry<dyn Drag> = LawEntry {
    name: "koch-hill",
    summary: "Random arrays of spheres by lattice-Boltzmann simulations.",
    source: "Koch and Hill, Annu. Rev. Fluid Mech. 33 (2001) 619, doi 10.1146/annurev.fluid.33.1.619",
    parameters: &[],
    tables: &[],
    make: |_| Box::new(KochHill),
};

impl Drag for KochHill {
    fn name(&self) -> &'static str {
        LAW.name
    }

    fn coefficient(&self, gas: &LocalGas, d: f64) -> f64 {
        let eps = gas.void_fraction.value();
        let phi = 1.0 - eps;
        let re = gas.superficial_reynolds(d / 2.0);
        let f = creeping(phi) + inertial(phi) * re;
        3.0 * PI * gas.viscosity * d * eps * eps * f
    }

    fn range(&self) -> FlowRange {
        // The source counts on the radius.
        FlowRange {
            void_fraction: (0.36, 1.0),
            reynolds: (0.0, 200.0),
            basis: ReynoldsBasis::Superficial,
        }
    }
}

/// F₀, the force in creeping flow.
fn creeping(phi: f64) -> f64 {
    if phi == 0.0 {
        // The limit: φ ln φ → 0.
        return 1.0;
    }
    if phi >= DENSE {
        return 10.0 * phi / (1.0 - phi).powi(3);
    }
    (1.0 + 3.0 * (phi / 2.0).sqrt() + 135.0 / 64.0 * phi * phi.ln() + 17.14 * phi)
        / (1.0 + 0.681 * phi - 8.48 * phi * phi + 8.16 * phi.powi(3))
}

/// F₃, the growth of the force with the Reynolds number.
fn inertial(phi: f64) -> f64 {
    0.0673 + 0.212 * phi + 0.0232 / (1.0 - phi).powi(5)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn reduces_to_stokes_drag_for_a_lone_particle_in_creeping_flow() {
        let k = KochHill.coefficient(&LocalGas::air(1.0, 0.0), 1e-3);
        assert!((k / (3.0 * PI * 1.82e-5 * 1e-3) - 1.0).abs() < 1e-14, "{k}");
        // and continuously so: F₀ − 1 goes with √φ.
        assert!((creeping(1e-12) - 1.0 - 3.0 * f64::sqrt(0.5e-12)).abs() < 1e-9);
    }

    #[test]
    fn agrees_with_an_independent_evaluation_of_both_branches() {
        // In Python, from ε 6π μ a U F/|u − v|.
        for (eps, u, d, expected) in [
            (0.4, 0.5, 2e-3, 6.92662369502074e-06),
            (0.45, 0.1, 1e-3, 2.170752481456361e-06),
            (0.7, 0.5, 1e-3, 1.0921460159824621e-06),
            (0.7, 1e-3, 1e-4, 8.313797806697041e-08),
            (0.9, 0.5, 1e-3, 6.696727534659135e-07),
            (0.95, 5.0, 1e-2, 0.0002646032196970281),
        ] {
            let k = KochHill.coefficient(&LocalGas::air(eps, u), d);
            assert!((k / expected - 1.0).abs() < 1e-12, "{eps}: {k:e}");
        }
    }

    #[test]
    fn a_packed_bed_in_creeping_flow_has_carman_s_pressure_gradient() {
        let (eps, u, d) = (0.4, 1e-6, 1e-3);
        let n = (1.0 - eps) / (PI / 6.0 * f64::powi(d, 3));
        let gradient = n * KochHill.coefficient(&LocalGas::air(eps, u), d) * u / eps;
        let carman = 180.0 * 0.36 * 1.82e-5 * (eps * u) / (f64::powi(eps, 3) * d * d);
        assert!(
            (gradient / carman - 1.0).abs() < 1e-4,
            "{gradient} {carman}"
        );
    }

    #[test]
    fn begins_as_the_expansion_for_dilute_fixed_beds() {
        // Kim and Russel (1985): 1 + (3/√2) φ^½ + (135/64) φ ln φ + 16.456 φ + …; the form's own
        // next term, −0.681 (3/√2) φ^1.5, is taken off.
        let phi = 1e-6_f64;
        let known = 1.0 + 3.0 * (phi / 2.0).sqrt() + 135.0 / 64.0 * phi * phi.ln();
        let linear = (creeping(phi) - known) / phi + 0.681 * 3.0 * (phi / 2.0).sqrt();
        assert!((linear - 16.456).abs() < 0.01, "{linear}");
    }

    #[test]
    fn steps_by_less_than_4_percent_between_its_branches() {
        let step = creeping(0.4 - 1e-12) / creeping(0.4) - 1.0;
        assert!((step - 0.039).abs() < 1e-3, "{step}");
    }
}
