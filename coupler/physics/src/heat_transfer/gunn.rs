//! Gunn 1978.

use super::model::HeatTransfer;
use crate::flow_range::{FlowRange, ReynoldsBasis};
use crate::law::LawEntry;
use crate::local::LocalGas;

/// Heat transfer in fixed and fluidised beds.
///
/// Nu = (7 − 10ε + 5ε²)(1 + 0.7 Re^0.2 Pr^⅓) + (1.33 − 2.4ε + 1.2ε²) Re^0.7 Pr^⅓
///
/// with Re on the superficial slip ε |u − v|. (MFiX uses the interstitial one, CFDEMcoupling the
/// exponent 0.33 in the place of ⅓.)
///
/// Validity: 0.35 < ε ≤ 1, Re ≤ 1e5.
///
/// Source: Gunn, Int. J. Heat Mass Transfer 21 (1978) 467, doi 10.1016/0017-9310(78)90080-7.
#[derive(Clone, Copy, Debug)]
pub struct Gunn;

/// Its entry in a case file.
pub(super) static LAW: LawEntry<dyn HeatTransfer> = LawEntry {
    name: "gunn",
    summary: "Fixed and fluidised beds, void fractions of 0.35 to 1.",
    source: "Gunn, Int. J. Heat Mass Transfer 21 (1978) 467, doi 10.1016/0017-9310(78)90080-7",
    parameters: &[],
    tables: &[],
    make: |_| Box::new(Gunn),
};

impl HeatTransfer for Gunn {
    fn name(&self) -> &'static str {
        LAW.name
    }

    fn nusselt(&self, gas: &LocalGas, d: f64) -> f64 {
        let eps = gas.void_fraction.value();
        let re = gas.superficial_reynolds(d);
        let pr_third = gas.prandtl().cbrt();
        (7.0 - 10.0 * eps + 5.0 * eps * eps) * (1.0 + 0.7 * re.powf(0.2) * pr_third)
            + (1.33 - 2.4 * eps + 1.2 * eps * eps) * re.powf(0.7) * pr_third
    }

    fn range(&self) -> FlowRange {
        FlowRange {
            void_fraction: (0.35, 1.0),
            reynolds: (0.0, 1e5),
            basis: ReynoldsBasis::Superficial,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numbers::VoidFraction;

    /// Gas with a superficial Reynolds number and Pr = 0.7 for a particle of 1 m.
    fn gas(eps: f64, re: f64) -> LocalGas {
        LocalGas {
            void_fraction: VoidFraction::new(eps).unwrap(),
            density: 1.0,
            viscosity: 1.0,
            conductivity: 1.0,
            heat_capacity: 0.7,
            slip: re / eps,
        }
    }

    #[test]
    fn agrees_with_the_independent_values_of_cor_3() {
        let oracle = [
            (0.4, 10.0, 10.044174),
            (0.4, 100.0, 22.267000),
            (0.4, 1000.0, 76.023223),
            (1.0, 100.0, 8.021848),
        ];
        for (eps, re, expected) in oracle {
            let nu = Gunn.nusselt(&gas(eps, re), 1.0);
            assert!((nu / expected - 1.0).abs() < 1e-6, "{eps} {re}: {nu}");
        }
    }

    #[test]
    fn a_lone_sphere_in_still_gas_has_a_nusselt_number_of_two() {
        assert!((Gunn.nusselt(&gas(1.0, 0.0), 1.0) - 2.0).abs() < 1e-15);
    }
}
