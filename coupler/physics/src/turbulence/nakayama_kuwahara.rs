//! Nakayama and Kuwahara 1999.

use super::bed_eddies::{BedEddies, EddySource};
use super::k_epsilon::KEpsilon;
use crate::law::LawEntry;
use crate::local::LocalGas;

/// Constant of ε∞.
const DISSIPATION: f64 = 39.0;
/// Constant of k∞.
const ENERGY: f64 = 3.7;

/// Eddies of a developed flow through an array of obstacles, to which k and ε relax:
///
/// k∞ = 3.7 φ^(3/2) (1 − φ) u²,   ε∞ = 39 φ² (1 − φ)^(5/2) u³/D,
/// Dk/Dt = … + ε∞,   Dε/Dt = … + C₂ ε∞²/k∞,
///
/// with the void fraction φ, the size D of the obstacles and the interstitial (intrinsic mean) speed u. With the
/// superficial one, U = φ u, they are k∞ = 3.7 (1 − φ)/√φ U² and ε∞ = 39 (1 − φ)^(5/2)/φ U³/D.
///
/// Conversion: D is the side of square rods; here it is the diameter of the spheres. u is the slip.
///
/// Validity: found by computing two-dimensional flow of high Reynolds numbers across periodic arrays of square rods;
/// for packed spheres it is an extrapolation. Its ε∞ is 0.50 to 0.98 of the work of Ergun's inertial pressure drop,
/// 1.75 (1 − φ)/φ⁴ U³/D, at φ of 0.35 to 0.5, and more than that work above.
///
/// Source: Nakayama and Kuwahara, J. Fluids Eng. 121 (1999) 427, doi 10.1115/1.2822227.
#[derive(Clone, Copy, Debug)]
pub struct NakayamaKuwahara;

/// Its entry in a case file.
pub(super) static LAW: LawEntry<dyn BedEddies> = LawEntry {
    name: "nakayama-kuwahara",
    summary: "k and its dissipation relax to those of a developed flow across square rods of the particles' size.",
    source: "Nakayama and Kuwahara, J. Fluids Eng. 121 (1999) 427, doi 10.1115/1.2822227",
    parameters: &[],
    tables: &[],
    make: |_| Box::new(NakayamaKuwahara),
};

impl NakayamaKuwahara {
    /// k∞ in m²/s² and ε∞ in m²/s³.
    pub fn developed(gas: &LocalGas, diameter: f64) -> [f64; 2] {
        let (phi, u) = (gas.void_fraction.value(), gas.slip);
        let solid = 1.0 - phi;
        let energy = ENERGY * phi.powf(1.5) * solid * u * u;
        let dissipation = DISSIPATION * phi * phi * solid.powf(2.5) * u.powi(3) / diameter;
        [energy, dissipation]
    }
}

impl BedEddies for NakayamaKuwahara {
    fn name(&self) -> &'static str {
        LAW.name
    }

    fn source(&self, gas: &LocalGas, diameter: f64) -> EddySource {
        let [energy, dissipation] = Self::developed(gas, diameter);
        // ε∞²/k∞ ~ u⁴ ends with the flow.
        let destroyed = if energy > 0.0 {
            dissipation * dissipation / energy
        } else {
            0.0
        };
        EddySource {
            energy: dissipation,
            dissipation: KEpsilon::STANDARD.destruction * destroyed,
            growth: 0.0,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numbers::VoidFraction;

    fn at(void_fraction: f64, slip: f64) -> LocalGas {
        LocalGas {
            void_fraction: VoidFraction::new(void_fraction).unwrap(),
            slip,
            ..LocalGas::of_numbers(void_fraction, 100.0, 0.7)
        }
    }

    #[test]
    fn agrees_with_an_independent_evaluation_at_a_void_fraction_of_0_4() {
        // In Python with the superficial forms: U = 1 m/s, d = 18 mm.
        let [k, eps] = NakayamaKuwahara::developed(&at(0.4, 2.5), 0.018);
        assert!((k / 3.510_128_202_786_901_4 - 1.0).abs() < 1e-13, "{k}");
        assert!((eps / 1_510.463_505_020_892_4 - 1.0).abs() < 1e-13, "{eps}");
        let source = NakayamaKuwahara.source(&at(0.4, 2.5), 0.018);
        assert_eq!(source.energy, eps);
        assert!((source.dissipation / 1_247_954.418_451_745_8 - 1.0).abs() < 1e-12);
        assert_eq!(source.growth, 0.0);
    }

    #[test]
    fn dissipates_no_more_than_ergun_s_pressure_drop_does_in_a_packed_bed() {
        // Work per mass of gas of the inertial pressure drop: 1.75 (1 − φ)/φ⁴ U³/d.
        let share = |phi: f64| {
            let [_, eps] = NakayamaKuwahara::developed(&at(phi, 1.0 / phi), 0.01);
            eps / (1.75 * (1.0 - phi) / phi.powi(4) / 0.01)
        };
        assert!((share(0.35) - 0.500_727).abs() < 1e-5, "{}", share(0.35));
        assert!((share(0.5) - 0.984_899).abs() < 1e-5, "{}", share(0.5));
    }

    #[test]
    fn still_gas_and_free_gas_make_no_eddies() {
        let none = EddySource::default();
        assert_eq!(NakayamaKuwahara.source(&at(0.4, 0.0), 0.01), none);
        assert_eq!(NakayamaKuwahara.source(&at(1.0, 3.0), 0.01), none);
    }
}
