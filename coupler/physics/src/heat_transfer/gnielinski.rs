//! Gnielinski 1980.

use super::model::HeatTransfer;
use crate::flow_range::{FlowRange, ReynoldsBasis};
use crate::law::LawEntry;
use crate::local::LocalGas;

/// Heat transfer in packed beds from that of a single sphere in the gaps' flow.
///
/// Nu = f_a Nu_s, f_a = 1 + 1.5 (1 − ε), Nu_s = 2 + √(Nu_l² + Nu_t²), Nu_l = 0.664 Re^½ Pr^⅓,
/// Nu_t = 0.037 Re^0.8 Pr/(1 + 2.443 Re^−0.1 (Pr^⅔ − 1)), with Re = ρ U d/(μ ε), that is on the
/// interstitial slip.
///
/// For Re → 0 the denominator of Nu_t goes through zero where Pr < 1 (at Re = 3 for Pr = 0.4, at 0.001
/// for Pr = 0.7). It is kept at a quarter at least: Nu_t then fades with Re^0.8, and at Pr = 0.7 nothing
/// changes above Re = 0.03, where Nu_t is a hundredth of Nu_l.
///
/// Validity: spheres, 0.1 < Re < 1000 (VDI: up to 2e4), 0.4 < Pr < 1000.
///
/// Source: Gnielinski, vt Verfahrenstechnik 16 (1982) 36; VDI Heat Atlas, chapter G9, "Fluid-particle
/// heat transfer in flow through packed beds of solids", doi 10.1007/978-3-540-77877-6_42.
#[derive(Clone, Copy, Debug)]
pub struct Gnielinski;

/// Lowest denominator of Nu_t.
const LOWEST: f64 = 0.25;

/// Its entry in a case file.
pub(super) static LAW: LawEntry<dyn HeatTransfer> = LawEntry {
    name: "gnielinski",
    summary: "Packed beds, from a single sphere in the flow of the gaps.",
    source: "VDI Heat Atlas, chapter G9, doi 10.1007/978-3-540-77877-6_42",
    parameters: &[],
    tables: &[],
    make: |_| Box::new(Gnielinski),
};

impl HeatTransfer for Gnielinski {
    fn name(&self) -> &'static str {
        LAW.name
    }

    fn nusselt(&self, gas: &LocalGas, d: f64) -> f64 {
        let (re, pr) = (gas.interstitial_reynolds(d), gas.prandtl());
        let laminar = 0.664 * re.sqrt() * pr.cbrt();
        let turbulent = if re > 0.0 {
            let layer = 1.0 + 2.443 * re.powf(-0.1) * (pr.cbrt().powi(2) - 1.0);
            0.037 * re.powf(0.8) * pr / layer.max(LOWEST)
        } else {
            0.0
        };
        let packing = 1.0 + 1.5 * (1.0 - gas.void_fraction.value());
        packing * (2.0 + laminar.hypot(turbulent))
    }

    fn range(&self) -> FlowRange {
        FlowRange {
            void_fraction: (0.0, 1.0),
            reynolds: (0.1, 2e4),
            basis: ReynoldsBasis::Interstitial,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn agrees_with_the_independent_value_of_cor_4() {
        // d = 8e-4, ε = 0.4, U = 1, ρ = 1e3, μ = 1e-3: Re = 2000; doctest of CalebBell/ht.
        let nu = Gnielinski.nusselt(&LocalGas::of_numbers(0.4, 2000.0, 0.7), 1.0);
        assert!((nu / 61.37823202546954 - 1.0).abs() < 1e-12, "{nu}");
    }

    #[test]
    fn agrees_with_an_independent_evaluation_with_and_without_the_lowest_denominator() {
        // In Python: (ε, Re, Pr). The denominator is 0.67, 2.30, 1, 0.113 and −0.299: the last two are
        // kept at a quarter.
        for (eps, re, pr, expected) in [
            (0.45, 100.0, 0.7, 14.766161211282046),
            (0.45, 100.0, 2.5, 20.354670339666676),
            (0.6, 1000.0, 1.0, 39.93991827394158),
            (0.4, 10.0, 0.4, 6.823970408770541),
            (0.4, 1e-4, 0.7, 3.8112024853728785),
        ] {
            let nu = Gnielinski.nusselt(&LocalGas::of_numbers(eps, re, pr), 1.0);
            assert!((nu / expected - 1.0).abs() < 1e-12, "{re} {pr}: {nu}");
        }
    }

    #[test]
    fn still_gas_around_a_lone_sphere_has_a_nusselt_number_of_two() {
        assert_eq!(
            Gnielinski.nusselt(&LocalGas::of_numbers(1.0, 0.0, 0.7), 1.0),
            2.0
        );
    }

    #[test]
    fn it_grows_steadily_from_rest_on() {
        for prandtl in [0.4, 0.7, 7.0] {
            let at = |k: i32| {
                let re = 10f64.powf(f64::from(k) / 10.0);
                Gnielinski.nusselt(&LocalGas::of_numbers(0.4, re, prandtl), 1.0)
            };
            for k in -60..60 {
                assert!(
                    at(k + 1) > at(k),
                    "Pr {prandtl}, Re 10^{}",
                    f64::from(k) / 10.0
                );
            }
        }
    }
}
