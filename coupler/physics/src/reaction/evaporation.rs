//! Liquid water that leaves a particle as vapour, and comes back.

use calcine_numerics::Number;

use crate::gas::GAS_CONSTANT;
use crate::moisture::antoine::vapour_pressure;
use crate::moisture::isotherm;

/// A particle whose surface is in equilibrium with its water (docs/theory.md, DRY-1): the vapour there has the concentration
///
/// c = a p_sat(T)/(R T),
///
/// with the activity a of the water, 1 where it is free.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Evaporation {
    /// Moisture below which water is bound, in kg a kg of dry solid, where its heat of sorption counts.
    pub fibre_saturation: Option<f64>,
    /// True where the vapour pressure over bound water follows [`isotherm`].
    pub isotherm: bool,
}

impl Evaporation {
    /// Concentration in mol/m³ of the vapour at the surface of a particle with these masses of water and of dry solid in kg, at
    /// a temperature in K.
    pub fn concentration<N: Number>(&self, [water, dry]: [N; 2], temperature: N) -> N {
        let free = vapour_pressure(temperature) / temperature.times(GAS_CONSTANT);
        // A drop without solid has free water.
        if !self.isotherm || dry.value() <= 0.0 {
            return free;
        }
        free * isotherm::activity(water / dry, temperature)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use calcine_numerics::Dual;

    #[test]
    fn free_water_has_the_vapour_of_the_steam_tables() {
        // IAPWS-IF97: saturated vapour of 60 °C 0.13043 kg/m³; of an ideal gas 0.12923, Antoine's pressure 0.3 % below.
        let law = Evaporation {
            fibre_saturation: None,
            isotherm: false,
        };
        let c = law.concentration([1.0, 1.0], 333.15) * 18.015e-3;
        assert!((c / 0.13043 - 1.0).abs() < 0.015, "{c}");
    }

    #[test]
    fn wood_in_equilibrium_with_humid_air_has_its_vapour() {
        let law = Evaporation {
            fibre_saturation: None,
            isotherm: true,
        };
        for (kelvin, humidity) in [(294.0, 0.5), (330.0, 0.2), (350.0, 0.9)] {
            let moisture = isotherm::equilibrium_moisture(humidity, kelvin);
            let found = law.concentration([moisture * 0.4, 0.4], kelvin);
            let free = law.concentration([1.0, 0.4], kelvin);
            assert!((found / free - humidity).abs() < 1e-10, "{kelvin}");
        }
        let drop = law.concentration([1e-6, 0.0], 300.0);
        assert_eq!(drop, law.concentration([1.0, 0.1], 300.0));
    }

    #[test]
    fn slopes_are_difference_quotients() {
        let law = Evaporation {
            fibre_saturation: None,
            isotherm: true,
        };
        for (water, dry, kelvin) in [
            (0.01, 0.2, 320.0),
            (0.03, 0.2, 370.0),
            (0.3, 0.2, 350.0),
            (0.0, 0.2, 340.0),
        ] {
            let dual = law.concentration(
                [Dual::<3>::along(water, 0), Dual::along(dry, 1)],
                Dual::along(kelvin, 2),
            );
            let at = |w: f64, d: f64, t: f64| law.concentration([w, d], t);
            let h = 1e-7;
            let quotients = [
                (at(water + h, dry, kelvin) - at(water - h, dry, kelvin)) / (2.0 * h),
                (at(water, dry + h, kelvin) - at(water, dry - h, kelvin)) / (2.0 * h),
                (at(water, dry, kelvin + 1e-3) - at(water, dry, kelvin - 1e-3)) / 2e-3,
            ];
            for (found, expected) in dual.slope.iter().zip(quotients) {
                let scale = expected.abs().max(1e-6 * dual.value);
                assert!(
                    (found - expected).abs() <= 2e-5 * scale,
                    "{water} {kelvin}: {found} {expected}"
                );
            }
        }
    }
}
