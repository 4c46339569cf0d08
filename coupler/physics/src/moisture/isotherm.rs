//! Water activity of wood by Hailwood and Horrobin's sorption isotherm.

use calcine_numerics::{Dual, Number};

/// Moisture of wood in equilibrium with air of a relative humidity H, 0 ≤ H ≤ 1, at a temperature in K:
///
/// M = (18/W) [k/(1 − k) + (K₁k + 2K₁K₂k²)/(1 + K₁k + K₁K₂k²)],   k = K H,
///
/// with t in °C, W = 349 + 1.29 t + 0.0135 t², K = 0.805 + 0.000736 t − 0.00000273 t²,
/// K₁ = 6.27 − 0.00938 t − 0.000303 t², K₂ = 1.91 + 0.0407 t − 0.000293 t².
///
/// Validity: −1 to 132 °C, 5 to 95 % relative humidity; near 1 it runs to fibre saturation, some 0.29 at 21 °C.
///
/// Source: Glass and Zelinka, Wood Handbook, ch. 4, USDA FPL-GTR-190 (2010), eq. 4-5; Hailwood and Horrobin, Trans.
/// Faraday Soc. 42B (1946) 84, doi 10.1039/TF946420B084.
pub fn equilibrium_moisture(humidity: f64, temperature: f64) -> f64 {
    let set = Constants::at(temperature);
    set.moisture(humidity)
}

/// Vapour pressure over wood of a moisture at a temperature in K, over that of free water: the humidity with which it is in
/// equilibrium, 1 from fibre saturation on.
pub fn water_activity(moisture: f64, temperature: f64) -> f64 {
    let set = Constants::at(temperature);
    if moisture >= set.moisture(1.0) {
        return 1.0;
    }
    let set = Constants::at(Dual::<1>::constant(temperature));
    if moisture <= 0.0 {
        return 0.0;
    }
    // M rises with H: Newton's method, within the interval that still holds the root.
    let (mut low, mut high, mut humidity) = (0.0, 1.0, 0.5);
    for _ in 0..100 {
        let found = set.moisture(Dual::<1>::along(humidity, 0));
        let off = found.value - moisture;
        // Beyond the round-off of M steps only wander.
        if off.abs() <= 4.0 * f64::EPSILON * moisture {
            return humidity;
        }
        if off > 0.0 {
            high = humidity;
        } else {
            low = humidity;
        }
        let step = humidity - off / found.slope[0];
        let next = if step > low && step < high {
            step
        } else {
            0.5 * (low + high)
        };
        if (next - humidity).abs() <= 4.0 * f64::EPSILON * humidity {
            return next;
        }
        humidity = next;
    }
    humidity
}

/// Temperature in K above which the isotherm stays as it is there: its constant K₁ comes to zero at 129 °C.
const HIGHEST: f64 = 398.15;

/// [`water_activity`] with derivatives. Above 125 °C the isotherm is that of 125 °C; of a moisture below zero it goes on with the
/// slope at zero.
pub fn activity<N: Number>(moisture: N, temperature: N) -> N {
    let (m, hot) = (moisture.value(), temperature.value() >= HIGHEST);
    let kelvin = temperature.value().min(HIGHEST);
    let value = water_activity(m, kelvin);
    if value >= 1.0 {
        return N::constant(1.0);
    }
    // M(a, T) stays: da = (dM − M_T dT)/M_a.
    let found = Constants::at(Dual::<2>::along(kelvin, 1)).moisture(Dual::along(value, 0));
    let [by_activity, by_temperature] = found.slope;
    let one_over = 1.0 / by_activity;
    let by_temperature = if hot { 0.0 } else { by_temperature };
    let start = if m < 0.0 { m * one_over } else { value };
    N::constant(start)
        + (moisture - N::constant(m)).times(one_over)
        + (temperature - N::constant(temperature.value())).times(-by_temperature * one_over)
}

/// The four constants at a temperature.
struct Constants<N> {
    w: N,
    k: N,
    k1: N,
    k2: N,
}

impl<N: Number> Constants<N> {
    fn at(temperature: N) -> Self {
        let t = temperature - N::constant(273.15);
        let line = |a: f64, b: f64, c: f64| N::constant(a) + t * (N::constant(b) + t.times(c));
        Self {
            w: line(349.0, 1.29, 0.0135),
            k: line(0.805, 0.000_736, -0.000_002_73),
            k1: line(6.27, -0.009_38, -0.000_303),
            k2: line(1.91, 0.0407, -0.000_293),
        }
    }

    fn moisture(&self, humidity: N) -> N {
        let one = N::constant(1.0);
        let k = self.k * humidity;
        let (first, second) = (self.k1 * k, self.k1 * self.k2 * k * k);
        let bound = k / (one - k) + (first + second.times(2.0)) / (one + first + second);
        bound.times(18.0) / self.w
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn agrees_with_an_independent_evaluation() {
        // In Python, by the printed constants.
        for (celsius, humidity, expected) in [
            (21.1, 0.5, 0.092_425_823_217_065_47),
            (21.1, 0.9, 0.204_795_037_261_148_6),
            (60.0, 0.5, 0.076_635_011_593_460_88),
            (100.0, 0.5, 0.053_581_938_180_321_524),
        ] {
            let found = equilibrium_moisture(humidity, celsius + 273.15);
            assert!((found / expected - 1.0).abs() < 1e-12, "{celsius}: {found}");
        }
    }

    #[test]
    fn agrees_with_the_handbook_s_table() {
        // Wood Handbook, table 4-2, in %: 21.1 °C 50 % 9.2, 90 % 20.5; 37.8 °C 65 % 11.2; −1.1 °C 50 % 9.5.
        for (celsius, humidity, table) in [
            (21.1, 0.5, 9.2),
            (21.1, 0.9, 20.5),
            (37.8, 0.65, 11.2),
            (-1.1, 0.5, 9.5),
        ] {
            let found = 100.0 * equilibrium_moisture(humidity, celsius + 273.15);
            assert!(
                (found - table).abs() < 0.051,
                "{celsius} {humidity}: {found}"
            );
        }
    }

    #[test]
    fn the_activity_is_the_inverse() {
        for celsius in [0.0, 21.1, 60.0, 110.0] {
            let kelvin = celsius + 273.15;
            let inverts = |humidity: f64| {
                let back = water_activity(equilibrium_moisture(humidity, kelvin), kelvin);
                assert!(
                    (back / humidity - 1.0).abs() < 1e-12,
                    "{celsius} {humidity}: {back}"
                );
            };
            [1e-6, 0.05, 0.95, 0.999].into_iter().for_each(inverts);
            // Wherever the root lies among floating-point numbers.
            for k in 0..1000 {
                inverts(0.5 + 1e-4 * f64::from(k));
            }
        }
    }

    #[test]
    fn free_water_has_its_full_vapour_pressure_and_dry_wood_none() {
        assert_eq!(water_activity(0.5, 300.0), 1.0);
        assert_eq!(water_activity(0.0, 300.0), 0.0);
    }
}
