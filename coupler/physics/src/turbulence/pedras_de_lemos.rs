//! Pedras and de Lemos 2001.

use super::bed_eddies::{BedEddies, EddySource};
use crate::dimension::Dimension;
use crate::law::{Bound, LawEntry, LawParameter};
use crate::local::LocalGas;
use crate::pressure_drop::ERGUN_VISCOUS;

/// Eddies that the flow through the pores makes in proportion to those that are there:
///
/// Dk/Dt = … + b k,   Dε/Dt = … + C₂ b ε,   b = c_k U/√K,
///
/// with the superficial speed U = φ u and the permeability K. In a uniform bed ε/k tends to b; how much k there is, is
/// decided by what flows in, k_end = k_in (b k_in/ε_in)^(1/(C₂ − 1)).
///
/// Conversion: K of spheres by Ergun's viscous term, φ³ d²/(150 (1 − φ)²); the paper has φ³ D²/(144 (1 − φ)²) for its rods.
///
/// Validity: c_k = 0.28 was found by computing two-dimensional flow of high Reynolds numbers across
/// periodic arrays of circular rods; for packed spheres it is an extrapolation.
///
/// Source: Pedras and de Lemos, Int. J. Heat Mass Transfer 44 (2001) 1081, doi 10.1016/S0017-9310(00)00202-7.
#[derive(Clone, Copy, Debug)]
pub struct PedrasDeLemos {
    /// c_k.
    pub production: f64,
}

/// Its entry in a case file.
pub(super) static LAW: LawEntry<dyn BedEddies> = LawEntry {
    name: "pedras-de-lemos",
    summary: "k and its dissipation grow in proportion to themselves, until the time of the eddies is that of the pores.",
    source: "Pedras and de Lemos, Int. J. Heat Mass Transfer 44 (2001) 1081, doi 10.1016/S0017-9310(00)00202-7",
    parameters: &[LawParameter {
        name: "production",
        dimension: Dimension::NONE,
        bound: Bound::Positive,
        default: Some(0.28),
        needed_with: None,
        meaning: "Constant c_k of the production of k, c_k k U/√K with the superficial speed and Ergun's permeability.",
        example: "0.28",
    }],
    tables: &[],
    make: |values| {
        Box::new(PedrasDeLemos {
            production: values[0],
        })
    },
};

impl BedEddies for PedrasDeLemos {
    fn name(&self) -> &'static str {
        LAW.name
    }

    fn source(&self, gas: &LocalGas, diameter: f64) -> EddySource {
        let phi = gas.void_fraction.value();
        // φ u/√K with √K = φ^(3/2) d/(√150 (1 − φ)).
        let rate = gas.slip * (1.0 - phi) * (ERGUN_VISCOUS / phi).sqrt() / diameter;
        EddySource {
            growth: self.production * rate,
            ..EddySource::default()
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numbers::VoidFraction;

    fn growth(void_fraction: f64, slip: f64) -> f64 {
        let gas = LocalGas {
            void_fraction: VoidFraction::new(void_fraction).unwrap(),
            slip,
            ..LocalGas::of_numbers(void_fraction, 100.0, 0.7)
        };
        let law = (LAW.make)(&vec![0.28].into());
        let found = law.source(&gas, 0.018);
        assert_eq!((found.energy, found.dissipation), (0.0, 0.0));
        found.growth
    }

    #[test]
    fn agrees_with_an_independent_evaluation_at_a_void_fraction_of_0_4() {
        // In Python: U = 1 m/s, d = 18 mm, K = 0.4³ d²/(150 · 0.6²) = 3.84e-7 m², 0.28/√K.
        let found = growth(0.4, 2.5);
        assert!(
            (found / 451.848_057_057_531_95 - 1.0).abs() < 1e-12,
            "{found}"
        );
    }

    #[test]
    fn still_gas_and_free_gas_make_no_eddies() {
        assert_eq!(growth(0.4, 0.0), 0.0);
        assert_eq!(growth(1.0, 3.0), 0.0);
    }
}
