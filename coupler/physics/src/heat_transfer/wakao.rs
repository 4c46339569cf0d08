//! Wakao and Kaguei 1982.

use super::model::HeatTransfer;
use crate::flow_range::{FlowRange, ReynoldsBasis};
use crate::law::LawEntry;
use crate::local::LocalGas;

/// Heat transfer in packed beds.
///
/// Nu = 2 + 1.1 Re^0.6 Pr^⅓, with Re on the superficial slip ε |u − v| and the diameter.
///
/// Validity: packed beds, 3 < Re < 3000; it was fitted with axial dispersion taken apart.
///
/// Source: Wakao, Kaguei and Funazkri, Chem. Eng. Sci. 34 (1979) 325,
/// doi 10.1016/0009-2509(79)85064-2; Wakao and Kaguei, Heat and Mass Transfer in Packed Beds (1982).
#[derive(Clone, Copy, Debug)]
pub struct Wakao;

/// Its entry in a case file.
pub(super) static LAW: LawEntry<dyn HeatTransfer> = LawEntry {
    name: "wakao",
    summary: "Packed beds, Reynolds numbers of 3 to 3000.",
    source: "Wakao, Kaguei and Funazkri, Chem. Eng. Sci. 34 (1979) 325, doi 10.1016/0009-2509(79)85064-2",
    parameters: &[],
    tables: &[],
    make: |_| Box::new(Wakao),
};

impl HeatTransfer for Wakao {
    fn name(&self) -> &'static str {
        LAW.name
    }

    fn nusselt(&self, gas: &LocalGas, d: f64) -> f64 {
        2.0 + 1.1 * gas.superficial_reynolds(d).powf(0.6) * gas.prandtl().cbrt()
    }

    fn range(&self) -> FlowRange {
        FlowRange {
            void_fraction: (0.0, 1.0),
            reynolds: (3.0, 3000.0),
            basis: ReynoldsBasis::Superficial,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn agrees_with_the_independent_values_of_cor_2() {
        // (2000, 0.7) as in the doctest of CalebBell/ht, (100, 0.7) in Python.
        for (re, expected) in [(2000.0, 95.40641328041248), (100.0, 17.479_563)] {
            let nu = Wakao.nusselt(&LocalGas::of_numbers(0.4, re / 0.4, 0.7), 1.0);
            assert!((nu / expected - 1.0).abs() < 1e-7, "{re}: {nu}");
        }
    }

    #[test]
    fn still_gas_conducts_with_a_nusselt_number_of_two() {
        assert_eq!(
            Wakao.nusselt(&LocalGas::of_numbers(0.4, 0.0, 0.7), 1.0),
            2.0
        );
    }
}
