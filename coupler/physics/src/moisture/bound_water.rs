//! Heat that binds water in wood below fibre saturation.

use calcine_numerics::Number;

/// Moisture up to which a material binds water in its cell walls, in kg of water a kg of dry solid.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum FibreSaturation {
    /// The same at all temperatures.
    Constant(f64),
    /// 0.598 − 0.001 T/K, as drying models of wood take it.
    ///
    /// Validity: 273 to 500 K. Source: Stanish, Schajer, Kayihan, AIChE J. 32 (1986) 1301, doi 10.1002/aic.690320808; the
    /// figures are not checked against the paper.
    Linear,
}

impl FibreSaturation {
    /// Fibre saturation at a temperature in K.
    #[inline]
    pub fn at<N: Number>(self, temperature: N) -> N {
        match self {
            Self::Constant(value) => N::constant(value),
            Self::Linear => temperature.through(0.598 - 0.001 * temperature.value(), -0.001),
        }
    }
}

/// Heat of sorption over the heat of evaporation (docs/theory.md, DRY-2):
///
/// Δh/h_fg = 0.4 (1 − M/M_fsp)² below fibre saturation M_fsp, else 0.
///
/// Validity: wood, 0 ≤ M. Source: Stanish, Schajer, Kayihan, AIChE J. 32 (1986) 1301, doi 10.1002/aic.690320808.
#[inline]
pub fn sorption_heat_ratio<N: Number>(moisture: N, fibre_saturation: N) -> N {
    if moisture.value() >= fibre_saturation.value() {
        return N::constant(0.0);
    }
    let left = N::constant(1.0) - moisture * fibre_saturation.inverse();
    left * left * N::constant(0.4)
}

/// Energy that is lacking of a material with bound water against its dry solid and free water, over the heat of evaporation, by
/// its masses of water and of dry solid in kg (docs/theory.md, DRY-2), in kg:
///
/// S = −m_dry ∫₀^M 0.4 (1 − M'/M_fsp)² dM'.
pub fn binding(water: f64, dry: f64, fibre_saturation: f64) -> f64 {
    if water <= 0.0 || dry <= 0.0 {
        return 0.0;
    }
    let moisture = (water / dry).min(fibre_saturation);
    // Σ without a difference of nearly equal numbers: 1 − (1 − x)³ = x (3 − 3 x + x²)
    let x = moisture / fibre_saturation;
    -dry * 0.4 * fibre_saturation / 3.0 * x * (3.0 - 3.0 * x + x * x)
}

/// Derivatives of [`binding`] with the masses of water and of dry solid.
pub fn binding_slopes<N: Number>(water: N, dry: N, fibre_saturation: f64) -> [N; 2] {
    if dry.value() <= 0.0 {
        return [N::constant(0.0); 2];
    }
    let moisture = (water / dry).positive();
    let ratio = sorption_heat_ratio(moisture, N::constant(fibre_saturation));
    let x = if moisture.value() < fibre_saturation {
        moisture.times(1.0 / fibre_saturation)
    } else {
        N::constant(1.0)
    };
    let sum = N::constant(3.0) - x.times(3.0) + x * x;
    // S = −m_dry g(M): −g + M g'
    let g = (x * sum).times(0.4 * fibre_saturation / 3.0);
    [-ratio, moisture * ratio - g]
}

/// Mean of [`sorption_heat_ratio`] over the water that leaves between two moistures, from the higher to the lower one, both
/// of one fibre saturation; the ratio itself where they are equal.
pub fn mean_sorption_heat_ratio(from: f64, to: f64, fibre_saturation: f64) -> f64 {
    if from == to {
        return sorption_heat_ratio(from, fibre_saturation);
    }
    // ∫ 0.4 (1 − M/F)² dM = −(0.4 F/3) (1 − M/F)³
    let cube = |moisture: f64| (1.0 - moisture / fibre_saturation).max(0.0).powi(3);
    0.4 * fibre_saturation / 3.0 * (cube(to) - cube(from)) / (from - to)
}

#[cfg(test)]
mod tests {
    use super::*;
    use calcine_numerics::Dual;

    #[test]
    fn agrees_with_independent_values() {
        // docs/theory.md, DRY-2, with M_fsp = 0.3.
        for (moisture, expected) in [
            (0.0, 0.4),
            (0.1, 0.4 * 4.0 / 9.0),
            (0.2, 0.4 / 9.0),
            (0.3, 0.0),
            (0.9, 0.0),
        ] {
            let found = sorption_heat_ratio(moisture, 0.3);
            assert!((found - expected).abs() < 1e-15, "{moisture}: {found}");
        }
    }

    #[test]
    fn the_slope_is_the_difference_quotient_and_vanishes_at_saturation() {
        for moisture in [0.01, 0.15, 0.29] {
            let dual = sorption_heat_ratio(Dual::<1>::along(moisture, 0), Dual::constant(0.3));
            let quotient = (sorption_heat_ratio(moisture + 1e-6, 0.3)
                - sorption_heat_ratio(moisture - 1e-6, 0.3))
                / 2e-6;
            assert!((dual.slope[0] - quotient).abs() < 1e-8, "{moisture}");
        }
        let there = sorption_heat_ratio(Dual::<1>::along(0.3, 0), Dual::constant(0.3));
        assert_eq!(there.slope[0], 0.0);
    }

    #[test]
    fn the_mean_is_that_of_many_small_parts() {
        for (from, to) in [(1.0, 0.0), (0.3, 0.0), (0.25, 0.1), (0.5, 0.4)] {
            let parts = 20_000;
            let width = (from - to) / f64::from(parts);
            let sum: f64 = (0..parts)
                .map(|k| sorption_heat_ratio(to + (f64::from(k) + 0.5) * width, 0.3))
                .sum();
            let mean = mean_sorption_heat_ratio(from, to, 0.3);
            assert!((mean - sum / f64::from(parts)).abs() < 1e-8, "{from} {to}");
        }
        assert_eq!(
            mean_sorption_heat_ratio(0.1, 0.1, 0.3),
            sorption_heat_ratio(0.1, 0.3)
        );
    }

    #[test]
    fn drying_of_a_kiln_s_charge_takes_sorption_beside_evaporation() {
        // docs/theory.md, DRY-7: 350 kg/h, half of it water, h_fg 2257 kJ/kg: 109.7 kW without, 114.1 kW with sorption.
        let water = 350.0 / 3600.0 / 2.0;
        let without = water * 2257.0;
        let with = without * (1.0 + mean_sorption_heat_ratio(1.0, 0.0, 0.3));
        assert!((without - 109.715).abs() < 1e-3, "{without}");
        assert!((with - 114.1).abs() < 0.05, "{with}");
    }

    #[test]
    fn what_binds_water_is_the_sum_of_its_heats_of_sorption() {
        let (dry, saturation) = (0.7, 0.3);
        for moisture in [0.02, 0.15, 0.3, 0.9] {
            let mean = mean_sorption_heat_ratio(moisture, 0.0, saturation);
            let found = binding(moisture * dry, dry, saturation);
            assert!(
                (found + mean * moisture * dry).abs() < 1e-15,
                "{moisture}: {found}"
            );
            let h = 1e-6;
            let [by_water, by_dry] = binding_slopes(moisture * dry, dry, saturation);
            let at = |w: f64, d: f64| binding(w, d, saturation);
            let quotient = (at(moisture * dry + h, dry) - at(moisture * dry - h, dry)) / (2.0 * h);
            assert!((by_water - quotient).abs() < 1e-6, "{moisture}: {by_water}");
            let quotient = (at(moisture * dry, dry + h) - at(moisture * dry, dry - h)) / (2.0 * h);
            assert!((by_dry - quotient).abs() < 1e-6, "{moisture}: {by_dry}");
        }
        assert_eq!(binding(0.0, 0.7, 0.3), 0.0);
        assert_eq!(binding_slopes(1e-6, 0.0, 0.3), [0.0, 0.0]);
    }

    #[test]
    fn fibre_saturation_falls_with_temperature() {
        assert_eq!(FibreSaturation::Constant(0.3).at(350.0), 0.3);
        assert!((FibreSaturation::Linear.at(298.0) - 0.3_f64).abs() < 1e-15);
        assert_eq!(
            FibreSaturation::Linear.at(Dual::<1>::along(300.0, 0)).slope[0],
            -0.001
        );
    }
}
