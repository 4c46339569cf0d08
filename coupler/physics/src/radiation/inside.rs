//! What a sphere's own conductivity leaves of the radiation through a bed.

use std::f64::consts::FRAC_PI_2;

/// Share of the radiative conductivity of a bed of spheres of one temperature each that is left where spheres
/// conduct so badly that their warm side cannot pass on what it receives.
///
/// F = a₁ e atan(a₂ K^a₃/e) + a₄ is a bed's radiative conductivity over 4 σ T³ d, with the emissivity e and
/// K = k_s/(4 d σ T³); the share is F(K)/F(∞). a₁ = 0.5756, a₂ = 1.5353, a₃ = 0.8011, a₄ = 0.1843.
///
/// Validity: random beds, void fractions about 0.4; 0.2 ≤ e ≤ 1, 0.01 ≤ K ≤ 10. A correction of the bed's
/// conductivity, not of a single sphere's exchange.
///
/// Source: Singh and Kaviany, Int. J. Heat Mass Transf. 37 (1994) 2579, doi 10.1016/0017-9310(94)90031-0.
pub fn conducted_share(emissivity: f64, conductivity: f64, diameter: f64, temperature: f64) -> f64 {
    const A: [f64; 4] = [0.5756, 1.5353, 0.8011, 0.1843];
    let film = 4.0 * super::STEFAN_BOLTZMANN * temperature.powi(3);
    let number = conductivity / (film * diameter);
    let turn = (A[1] * number.powf(A[2]) / emissivity).atan();
    (A[0] * emissivity * turn + A[3]) / (A[0] * emissivity * FRAC_PI_2 + A[3])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn good_conductors_keep_all_and_bad_ones_a_part() {
        assert!((conducted_share(0.9, 1e9, 6e-3, 1000.0) - 1.0).abs() < 1e-6);
        // e = 0.9, k = 2, d = 6 mm, 1500 K: K = 0.435445, evaluated apart.
        let made = conducted_share(0.9, 2.0, 6e-3, 1500.0);
        assert!(
            (made / 0.558_188_522_793_891_6 - 1.0).abs() < 1e-9,
            "{made}"
        );
    }
}
