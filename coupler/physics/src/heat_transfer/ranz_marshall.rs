//! Ranz and Marshall 1952.

use super::model::HeatTransfer;
use crate::flow_range::{FlowRange, ReynoldsBasis};
use crate::law::LawEntry;
use crate::local::LocalGas;

/// Heat transfer of a single sphere.
///
/// Nu = 2 + 0.6 Re^½ Pr^⅓, with Re on the slip |u − v| and the diameter.
///
/// Validity: single spheres, Re up to about 2e5.
///
/// Source: Ranz and Marshall, Chem. Eng. Prog. 48 (1952) 141 and 173.
#[derive(Clone, Copy, Debug)]
pub struct RanzMarshall;

/// Its entry in a case file.
pub(super) static LAW: LawEntry<dyn HeatTransfer> = LawEntry {
    name: "ranz-marshall",
    summary: "A single sphere.",
    source: "Ranz and Marshall, Chem. Eng. Prog. 48 (1952) 141",
    parameters: &[],
    tables: &[],
    make: |_| Box::new(RanzMarshall),
};

impl HeatTransfer for RanzMarshall {
    fn name(&self) -> &'static str {
        LAW.name
    }

    fn nusselt(&self, gas: &LocalGas, d: f64) -> f64 {
        2.0 + 0.6 * gas.interstitial_reynolds(d).sqrt() * gas.prandtl().cbrt()
    }

    fn range(&self) -> FlowRange {
        FlowRange {
            void_fraction: (0.0, 1.0),
            reynolds: (0.0, 2e5),
            basis: ReynoldsBasis::Interstitial,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numbers::VoidFraction;

    #[test]
    fn agrees_with_the_independent_value_of_cor_1() {
        let mut gas = LocalGas {
            void_fraction: VoidFraction::new(1.0).unwrap(),
            density: 1.0,
            viscosity: 1.0,
            conductivity: 1.0,
            heat_capacity: 0.7,
            slip: 100.0,
        };
        assert!((RanzMarshall.nusselt(&gas, 1.0) - 7.327424).abs() < 1e-6);
        gas.slip = 0.0;
        assert_eq!(RanzMarshall.nusselt(&gas, 1.0), 2.0);
    }
}
