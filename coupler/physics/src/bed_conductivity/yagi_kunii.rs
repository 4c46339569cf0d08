//! Yagi and Kunii 1957.

use super::{BedConductivity, PackedBed};
use crate::radiation::STEFAN_BOLTZMANN;

/// Solids in series with the stagnant gas and the radiation about the contacts, in parallel to the radiation
/// from void to void.
///
/// k/k_g = ε (1 + β d h_rv/k_g) + β (1 − ε)/(1/(1/φ + d h_rs/k_g) + γ k_g/k_s),
/// h_rs = 4 σ T³ e/(2 − e), h_rv = 4 σ T³/(1 + ε (1 − e)/(2 (1 − ε) e)),
/// φ = φ₂ + (φ₁ − φ₂) (ε − 0.26)/0.216 between ε = 0.26 and 0.476, and with n = 1.5 (loose, index 1) and
/// 4√3 (dense, index 2) contacts per half sphere, κ = k_s/k_g, sin² θ = 1/n,
/// φ_i = ½ ((κ − 1)/κ)² sin² θ/(ln(κ − (κ − 1) cos θ) − (κ − 1)/κ (1 − cos θ)) − 2/(3 κ)
///
/// with β = 0.9, γ = 2/3. The conduction through contact areas is left out, as they do for beds at
/// atmospheric pressure.
///
/// Validity: still gas; 0.26 ≤ ε ≤ 0.476 (φ₁, φ₂ are kept beyond).
///
/// Source: Yagi and Kunii, AIChE J. 3 (1957) 373, doi 10.1002/aic.690030317; φ by Kunii and Smith, AIChE J. 6
/// (1960) 71, doi 10.1002/aic.690060115.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct YagiKunii;

const BETA: f64 = 0.9;
const GAMMA: f64 = 2.0 / 3.0;

fn film(ratio: f64, contacts: f64) -> f64 {
    let cosine = (1.0 - 1.0 / contacts).sqrt();
    let share = (ratio - 1.0) / ratio;
    let log = (ratio - (ratio - 1.0) * cosine).ln();
    0.5 * share * share / contacts / (log - share * (1.0 - cosine)) - 2.0 / (3.0 * ratio)
}

impl BedConductivity for YagiKunii {
    fn conductivity(&self, bed: &PackedBed) -> f64 {
        let (eps, gas, e) = (bed.void_fraction, bed.gas_conductivity, bed.emissivity);
        let ratio = bed.solid_conductivity / gas;
        let (loose, dense) = (film(ratio, 1.5), film(ratio, 4.0 * 3.0_f64.sqrt()));
        let place = ((eps - 0.26) / 0.216).clamp(0.0, 1.0);
        let film = dense + (loose - dense) * place;
        let black = 4.0 * STEFAN_BOLTZMANN * bed.temperature.powi(3);
        let surfaces = black * e / (2.0 - e);
        let voids = black / (1.0 + eps * (1.0 - e) / (2.0 * (1.0 - eps) * e));
        let parallel = eps * (1.0 + BETA * bed.diameter * voids / gas);
        let about = 1.0 / film + bed.diameter * surfaces / gas;
        gas * (parallel + BETA * (1.0 - eps) / (1.0 / about + GAMMA / ratio))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const BED: PackedBed = PackedBed {
        void_fraction: 0.4,
        diameter: 11e-3,
        solid_conductivity: 40.0,
        gas_conductivity: 0.05,
        emissivity: 0.8,
        temperature: 800.0,
    };

    #[test]
    fn agrees_with_an_independent_evaluation() {
        let made = YagiKunii.conductivity(&BED);
        assert!(
            (made / 1.466_675_994_650_021_4 - 1.0).abs() < 1e-9,
            "{made}"
        );
        let cold = PackedBed {
            temperature: 1.0,
            ..BED
        };
        let made = YagiKunii.conductivity(&cold);
        assert!(
            (made / 0.604_854_616_625_289_5 - 1.0).abs() < 1e-9,
            "{made}"
        );
    }

    #[test]
    fn radiation_grows_with_the_third_power_of_temperature_where_it_rules_the_voids() {
        let at = |temperature: f64| {
            let bed = PackedBed {
                temperature,
                solid_conductivity: 1e9,
                ..BED
            };
            YagiKunii.conductivity(&bed)
        };
        let slope = (at(40_000.0) / at(20_000.0)).log2();
        assert!((slope - 3.0).abs() < 1e-3, "{slope}");
    }
}
