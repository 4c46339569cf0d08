//! Zehner, Bauer and Schlünder.

use super::{BedConductivity, PackedBed};
use crate::radiation::STEFAN_BOLTZMANN;

/// A unit cell of two half bodies whose heat flows in parallel lines.
///
/// k/k_g = (1 − √(1−ε)) (1 + ε k_r) + √(1−ε) (φ k_p + (1 − φ) k_c), k_p = k_s/k_g,
/// k_r = 4 σ/(2/e − 1) T³ d/k_g, B = 1.25 ((1−ε)/ε)^(10/9), N = 1 + (k_r − B)/k_p,
/// k_c = 2/N {B (k_p + k_r − 1)/(N² k_p) ln((k_p + k_r)/B) + (B + 1)/(2B) (k_r − B) − (B − 1)/N}
///
/// with the share φ of the surface that touches (0 for points, 0.0077 for ceramics, 0.0013 for steel,
/// 0.0253 for copper). The gas' free path is left out.
///
/// Validity: 0.2 < ε < 0.6, up to 1500 K; about 30 %.
///
/// Source: Zehner and Schlünder, Chem.-Ing.-Tech. 42 (1970) 933, doi 10.1002/cite.330421408; Bauer and
/// Schlünder, Int. Chem. Eng. 18 (1978) 189; VDI Heat Atlas, section D6.3.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ZehnerBauerSchluender {
    /// φ, the share of the surface that touches.
    pub flattening: f64,
}

impl BedConductivity for ZehnerBauerSchluender {
    fn conductivity(&self, bed: &PackedBed) -> f64 {
        let (eps, gas) = (bed.void_fraction, bed.gas_conductivity);
        let kp = bed.solid_conductivity / gas;
        let film = 4.0 * STEFAN_BOLTZMANN / (2.0 / bed.emissivity - 1.0);
        let kr = film * bed.temperature.powi(3) * bed.diameter / gas;
        let b = 1.25 * ((1.0 - eps) / eps).powf(10.0 / 9.0);
        let n = 1.0 + (kr - b) / kp;
        let log = ((kp + kr) / b).ln();
        let core = 2.0 / n
            * (b * (kp + kr - 1.0) / (n * n * kp) * log + (b + 1.0) / (2.0 * b) * (kr - b)
                - (b - 1.0) / n);
        let root = (1.0 - eps).sqrt();
        let phi = self.flattening;
        gas * ((1.0 - root) * (1.0 + eps * kr) + root * (phi * kp + (1.0 - phi) * core))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const BED: PackedBed = PackedBed {
        void_fraction: 0.4,
        diameter: 4e-3,
        solid_conductivity: 1.1,
        gas_conductivity: 0.026,
        emissivity: 0.9,
        temperature: 300.0,
    };

    #[test]
    fn solid_gas_and_radiation_alike_make_a_body_of_that_conductivity() {
        // k_p → 1 without radiation: the bed conducts as the gas does (the limit of N → 1 − B).
        let bed = PackedBed {
            solid_conductivity: 0.026,
            temperature: 1e-3,
            ..BED
        };
        let law = ZehnerBauerSchluender::default();
        assert!((law.conductivity(&bed) / 0.026 - 1.0).abs() < 1e-9);
    }

    #[test]
    fn agrees_with_an_independent_evaluation() {
        // Evaluated apart, term by term, in another language.
        for (temperature, flattening, expected) in REFERENCE {
            let law = ZehnerBauerSchluender { flattening };
            let made = law.conductivity(&PackedBed { temperature, ..BED });
            assert!(
                (made / expected - 1.0).abs() < 1e-9,
                "{temperature}: {made}"
            );
        }
    }

    const REFERENCE: [(f64, f64, f64); 3] = [
        (300.0, 0.0, 0.193_869_669_723_052_78),
        (300.0, 0.0077, 0.198_996_746_940_988_62),
        (1500.0, 0.0, 1.148_804_361_112_410_4),
    ];
}
