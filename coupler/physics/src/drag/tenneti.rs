//! Tenneti, Garg and Subramaniam 2011.

use std::f64::consts::PI;

use super::model::Drag;
use crate::flow_range::{FlowRange, ReynoldsBasis};
use crate::law::LawEntry;
use crate::local::LocalGas;

/// Drag in random arrays of equal spheres from particle-resolved simulations.
///
/// With φ = 1 − ε and Re = ρ U d/μ, U = ε |u − v| (superficial, diameter):
///
/// F = (1 + 0.15 Re^0.687)/(1 − φ)³ + 5.81 φ/(1 − φ)³ + 0.48 φ^⅓/(1 − φ)⁴
///     + φ³ Re (0.95 + 0.61 φ³/(1 − φ)²)
///
/// Conversion: F is the full force, the mean pressure gradient included, over 3π μ d U: in a packed bed of
/// φ = 0.6 it is 0.92 of the 10 φ/(1 − φ)³ of Carman's whole pressure gradient. The drag alone is ε times it, so
/// K_A = 3π μ d ε² F, and the two-fluid β = 18 μ ε² φ F/d² = n K_A, form A.
///
/// OpenFOAM's `Tenneti` also takes the pressure gradient out, but adds the isolated sphere's term as it is where
/// it is divided by ε here; of that term NGA2 leaves the 1 undivided in some versions.
///
/// Validity: φ 0.1 to 0.5, Re 0.01 to 300. For φ → 0 it tends to Schiller and Naumann's isolated sphere.
///
/// Point, by F as printed: air of ρ = 1.2 kg/m³ and μ = 1.82e-5 Pa s, ε = 0.7, |u − v| = 0.5 m/s, d = 1 mm has Re = 23.0769,
/// F = 13.7266 and K_A = 3π μ d 0.7² · 13.7266 = 1.15372e-6 kg/s.
///
/// Source: Tenneti, Garg and Subramaniam, Int. J. Multiphase Flow 37 (2011) 1072,
/// doi 10.1016/j.ijmultiphaseflow.2011.05.010.
#[derive(Clone, Copy, Debug)]
pub struct Tenneti;

/// Its entry in a case file.
pub(super) static LAW: LawEntry<dyn Drag> = LawEntry {
    name: "tenneti",
    summary: "Random arrays of equal spheres by particle-resolved simulations, solid fractions of 0.1 to 0.5.",
    source: "Tenneti, Garg and Subramaniam, Int. J. Multiphase Flow 37 (2011) 1072, \
             doi 10.1016/j.ijmultiphaseflow.2011.05.010",
    parameters: &[],
    tables: &[],
    make: |_| Box::new(Tenneti),
};

impl Drag for Tenneti {
    fn name(&self) -> &'static str {
        LAW.name
    }

    fn coefficient(&self, gas: &LocalGas, d: f64) -> f64 {
        let eps = gas.void_fraction.value();
        let phi = 1.0 - eps;
        let re = gas.superficial_reynolds(d);
        let isolated = (1.0 + 0.15 * re.powf(0.687)) / eps.powi(3);
        let array = 5.81 * phi / eps.powi(3) + 0.48 * phi.cbrt() / eps.powi(4);
        let inertial = phi.powi(3) * re * (0.95 + 0.61 * phi.powi(3) / (eps * eps));
        let f = isolated + array + inertial;
        3.0 * PI * gas.viscosity * d * eps * eps * f
    }

    fn range(&self) -> FlowRange {
        FlowRange {
            void_fraction: (0.5, 0.9),
            reynolds: (0.01, 300.0),
            basis: ReynoldsBasis::Superficial,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn reduces_to_stokes_drag_for_a_lone_particle_in_creeping_flow() {
        let k = Tenneti.coefficient(&LocalGas::air(1.0, 0.0), 1e-3);
        assert!((k / (3.0 * PI * 1.82e-5 * 1e-3) - 1.0).abs() < 1e-14, "{k}");
    }

    #[test]
    fn agrees_with_an_independent_evaluation() {
        // In Python, ε times the full force 3π μ d U F over |u − v|, with F as printed.
        for (eps, u, d, expected) in [
            (0.5, 0.5, 2e-3, 4.781755920656261e-06),
            (0.5, 0.02, 1e-3, 1.644143016842227e-06),
            (0.7, 0.5, 1e-3, 1.153722474159004e-06),
            (0.9, 1.0, 1e-3, 8.289320909999289e-07),
            (0.9, 0.01, 2e-4, 7.102611671360234e-08),
        ] {
            let k = Tenneti.coefficient(&LocalGas::air(eps, u), d);
            assert!((k / expected - 1.0).abs() < 1e-12, "{eps}: {k:e}");
        }
    }

    #[test]
    fn a_packed_bed_in_creeping_flow_has_nearly_carman_s_pressure_gradient() {
        // At φ = 0.6 the terms of F are 15.625, 54.469 and 15.815 against 10 φ/ε³ = 93.75: 0.9164.
        let (eps, u, d) = (0.4, 1e-6, 1e-3);
        let n = (1.0 - eps) / (PI / 6.0 * f64::powi(d, 3));
        let gradient = n * Tenneti.coefficient(&LocalGas::air(eps, u), d) * u / eps;
        let carman = 180.0 * 0.36 * 1.82e-5 * (eps * u) / (f64::powi(eps, 3) * d * d);
        assert!(
            (gradient / carman - 0.9164).abs() < 1e-3,
            "{}",
            gradient / carman
        );
    }
}
