//! Mass transfer between gas and particle, by the analogy with heat transfer.

use crate::heat_transfer::HeatTransfer;
use crate::local::LocalGas;

/// Sherwood number Sh = β d/D of a species of diffusivity D in m²/s: the Nusselt number of a heat
/// transfer law with the Schmidt number in the place of the Prandtl number, such that the flow of the
/// species into the particle is β π d² (c_gas − c_surface); diameter in m.
///
/// Validity: that of the law, for mass fluxes too small to move the boundary layer, and 0.6 < Sc < 3000.
///
/// Source: Chilton and Colburn, Ind. Eng. Chem. 26 (1934) 1183, doi 10.1021/ie50299a012.
pub fn sherwood(law: &dyn HeatTransfer, gas: &LocalGas, diffusivity: f64, diameter: f64) -> f64 {
    // A gas whose Prandtl number is the Schmidt number.
    let analogue = LocalGas {
        conductivity: gas.density * gas.heat_capacity * diffusivity,
        ..*gas
    };
    law.nusselt(&analogue, diameter)
}

/// Mass transfer coefficient β = Sh D/d in m/s.
pub fn coefficient(law: &dyn HeatTransfer, gas: &LocalGas, diffusivity: f64, diameter: f64) -> f64 {
    sherwood(law, gas, diffusivity, diameter) * diffusivity / diameter
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::heat_transfer::{Gunn, RanzMarshall, Wakao};

    #[test]
    fn sherwood_is_nusselt_at_the_schmidt_number() {
        let gas = LocalGas::air(0.4, 0.5);
        let diffusivity = 2.0e-5;
        let schmidt = gas.schmidt(diffusivity);
        let alike = LocalGas::of_numbers(0.4, gas.interstitial_reynolds(1e-3), schmidt);
        for law in [&Gunn as &dyn HeatTransfer, &RanzMarshall, &Wakao] {
            let sh = sherwood(law, &gas, diffusivity, 1e-3);
            assert!(
                (sh / law.nusselt(&alike, 1.0) - 1.0).abs() < 1e-12,
                "{}",
                law.name()
            );
        }
    }

    #[test]
    fn a_lone_sphere_in_still_gas_exchanges_by_diffusion_alone() {
        let beta = coefficient(&RanzMarshall, &LocalGas::air(1.0, 0.0), 2e-5, 1e-3);
        assert!((beta / (2.0 * 2e-5 / 1e-3) - 1.0).abs() < 1e-15);
    }

    #[test]
    fn agrees_with_an_independent_evaluation() {
        // Ranz and Marshall, Re = 32.967033, Sc = 0.7583333, 2 + 0.6 Re^0.5 Sc^(1/3) in Python.
        let sh = sherwood(&RanzMarshall, &LocalGas::air(0.4, 0.5), 2e-5, 1e-3);
        assert!((sh / 5.141_554_249_518 - 1.0).abs() < 1e-12, "{sh}");
    }
}
