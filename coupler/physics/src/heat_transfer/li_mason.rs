//! Li and Mason 2000.

use super::model::HeatTransfer;
use crate::dimension::Dimension;
use crate::flow_range::{FlowRange, ReynoldsBasis};
use crate::law::{Bound, LawEntry, LawParameter};
use crate::local::LocalGas;

/// Reynolds numbers at which its branches change.
const BRANCHES: [f64; 2] = [200.0, 1500.0];

/// Heat transfer of particles in pneumatic transport.
///
/// Nu = 2 + 0.6 ε^n Re^½ Pr^⅓ for Re < 200,
/// Nu = 2 + ε^n (0.5 Re^½ + 0.02 Re^0.8) Pr^⅓ up to 1500,
/// Nu = 2 + 4.5e-5 ε^n Re^1.8 above, with Re on the slip |u − v| and the diameter.
///
/// n = 3.5 for fine particles in dilute flow by default, 4.75 is used for dense ones. The branches do not meet: for Pr = 0.7
/// Nu falls by 0.3 % of its second term at 200.
///
/// CFDEMcoupling's `LaEuScalarTemp` is the same but for Pr^0.33.
///
/// Point: ε = 0.6, Re = 800, Pr = 0.7, n = 3.5 has 0.5 √800 = 14.1421, 0.02 · 800^0.8 = 4.2025 and Nu = 2 + 0.6^3.5 · 18.3446 · 0.7^⅓ =
/// 4.72523.
///
/// Source: Li and Mason, Powder Technol. 112 (2000) 273, doi 10.1016/S0032-5910(00)00302-8.
#[derive(Clone, Copy, Debug)]
pub struct LiMason {
    /// Exponent n of the void fraction.
    pub exponent: f64,
}

/// Its entry in a case file.
pub(super) static LAW: LawEntry<dyn HeatTransfer> = LawEntry {
    name: "li-mason",
    summary: "Particles in pneumatic transport.",
    source: "Li and Mason, Powder Technol. 112 (2000) 273, doi 10.1016/S0032-5910(00)00302-8",
    parameters: &[LawParameter {
        name: "exponent",
        dimension: Dimension::NONE,
        bound: Bound::NotNegative,
        default: Some(3.5),
        needed_with: None,
        meaning: "Exponent of the void fraction; 4.75 is used for dense flows.",
        example: "3.5",
    }],
    tables: &[],
    make: |values| {
        Box::new(LiMason {
            exponent: values[0],
        })
    },
};

impl HeatTransfer for LiMason {
    fn name(&self) -> &'static str {
        LAW.name
    }

    fn nusselt(&self, gas: &LocalGas, d: f64) -> f64 {
        let re = gas.interstitial_reynolds(d);
        let prandtl = gas.prandtl().cbrt();
        let flow = match BRANCHES {
            [first, _] if re < first => 0.6 * re.sqrt() * prandtl,
            [_, second] if re < second => (0.5 * re.sqrt() + 0.02 * re.powf(0.8)) * prandtl,
            _ => 4.5e-5 * re.powf(1.8),
        };
        2.0 + gas.void_fraction.value().powf(self.exponent) * flow
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

    #[test]
    fn agrees_with_an_independent_evaluation_in_each_branch() {
        // In Python.
        for (eps, re, exponent, expected) in [
            (1.0, 100.0, 3.5, 7.327424010455604),
            (0.9, 200.0, 3.5, 7.193372635631524),
            (0.6, 800.0, 3.5, 4.7252300263760905),
            (0.6, 800.0, 4.75, 3.439104159005219),
            (0.95, 2000.0, 3.5, 34.8926697378263),
        ] {
            let gas = LocalGas::of_numbers(eps, re, 0.7);
            let nusselt = LiMason { exponent }.nusselt(&gas, 1.0);
            assert!((nusselt / expected - 1.0).abs() < 1e-12, "{re}: {nusselt}");
        }
    }
}
