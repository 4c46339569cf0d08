//! Vapour pressure of water by Antoine's equation.

use calcine_numerics::Number;

/// 0 °C in K.
const ICE_POINT: f64 = 273.15;
/// One millimetre of mercury in Pa.
const MILLIMETRE: f64 = 101_325.0 / 760.0;

/// Constants A, B, C of log₁₀(p/mmHg) = A − B/(C + t/°C).
#[derive(Clone, Copy, Debug, PartialEq)]
struct Constants {
    a: f64,
    b: f64,
    c: f64,
}

/// From 1 °C up to [`CROSSING`].
const LOW: Constants = Constants {
    a: 8.071_31,
    b: 1730.63,
    c: 233.426,
};

/// From [`CROSSING`] to 374 °C.
const HIGH: Constants = Constants {
    a: 8.140_19,
    b: 1810.94,
    c: 244.485,
};

/// Temperature in °C at which both sets of constants give the same pressure. At 100 °C, where tables end the first set, the
/// second is 0.55 % higher; changed here, the law is continuous and has one inverse.
const CROSSING: f64 = 108.266_314_698_567_3;
/// The pressure there in mmHg over its logarithm: log₁₀(p/mmHg).
const CROSSING_LOGARITHM: f64 = LOW.a - LOW.b / (LOW.c + CROSSING);

/// Vapour pressure of water in Pa at a temperature in K (docs/theory.md, COR-9):
///
/// log₁₀(p/mmHg) = A − B/(C + t), t in °C; A, B, C = 8.07131, 1730.63, 233.426 below 108.27 °C and 8.14019, 1810.94, 244.485
/// above.
///
/// Validity: 1 to 374 °C; 0.1 % from 1 to 100 °C.
///
/// Source: Antoine, C. R. Acad. Sci. 107 (1888) 681; constants of the Dortmund Data Bank.
#[inline]
pub fn vapour_pressure<N: Number>(temperature: N) -> N {
    let t = temperature.value() - ICE_POINT;
    let set = if t < CROSSING { LOW } else { HIGH };
    // The equation has a pole at 39.7 K, above which the pressure is none.
    if set.c + t <= 0.0 {
        return N::constant(0.0);
    }
    let value = 10.0_f64.powf(set.a - set.b / (set.c + t)) * MILLIMETRE;
    let slope = value * std::f64::consts::LN_10 * set.b / ((set.c + t) * (set.c + t));
    temperature.through(value, slope)
}

/// Temperature in K at which the vapour pressure of water is a pressure in Pa, above zero: the boiling point at that pressure,
/// and the dew point of vapour of that partial pressure.
#[inline]
pub fn boiling_temperature<N: Number>(pressure: N) -> N {
    let logarithm = (pressure.value() / MILLIMETRE).log10();
    let set = if logarithm < CROSSING_LOGARITHM {
        LOW
    } else {
        HIGH
    };
    let gap = set.a - logarithm;
    let value = set.b / gap - set.c + ICE_POINT;
    let slope = set.b / (gap * gap * pressure.value() * std::f64::consts::LN_10);
    pressure.through(value, slope)
}

#[cfg(test)]
mod tests {
    use super::*;
    use calcine_numerics::Dual;

    #[test]
    fn agrees_with_an_independent_evaluation() {
        // In Python, by the printed constants.
        for (celsius, expected) in [
            (60.0, 19_870.155_035_141),
            (100.0, 101_336.514_941_627),
            (150.0, 472_551.910_045_366),
            (200.0, 1_551_850.193_926_28),
        ] {
            let found = vapour_pressure(celsius + ICE_POINT);
            assert!((found / expected - 1.0).abs() < 1e-12, "{celsius}: {found}");
        }
    }

    #[test]
    fn water_boils_at_100_degrees_at_an_atmosphere() {
        let celsius = boiling_temperature(101_325.0) - ICE_POINT;
        assert!((celsius - 99.996_829_736_7).abs() < 1e-9, "{celsius}");
    }

    #[test]
    fn agrees_with_steam_tables() {
        // IAPWS-IF97: 20 °C 2339.3 Pa, 80 °C 47 415 Pa, 120 °C 198 670 Pa, 200 °C 1.554 93 MPa.
        for (celsius, table) in [
            (20.0, 2339.3),
            (80.0, 47_415.0),
            (120.0, 198_670.0),
            (200.0, 1_554_930.0),
        ] {
            let found = vapour_pressure(celsius + ICE_POINT);
            assert!((found / table - 1.0).abs() < 5e-3, "{celsius}: {found}");
        }
    }

    #[test]
    fn both_sets_of_constants_meet_where_one_takes_over() {
        let (below, above) = (CROSSING - 1e-9, CROSSING + 1e-9);
        let ratio = vapour_pressure(below + ICE_POINT) / vapour_pressure(above + ICE_POINT);
        assert!((ratio - 1.0).abs() < 1e-9, "{ratio}");
    }

    #[test]
    fn the_boiling_temperature_is_the_inverse() {
        for kelvin in [275.0, 320.0, 372.0, 381.3, 381.5, 450.0, 640.0] {
            let back = boiling_temperature(vapour_pressure(kelvin));
            assert!((back - kelvin).abs() < 1e-9, "{kelvin}: {back}");
        }
    }

    #[test]
    fn the_slopes_are_the_difference_quotients() {
        for kelvin in [300.0, 372.0, 400.0] {
            let dual = vapour_pressure(Dual::<1>::along(kelvin, 0));
            let quotient = (vapour_pressure(kelvin + 1e-3) - vapour_pressure(kelvin - 1e-3)) / 2e-3;
            assert!((dual.slope[0] / quotient - 1.0).abs() < 1e-7, "{kelvin}");
            let pressure = dual.value;
            let back = boiling_temperature(Dual::<1>::along(pressure, 0));
            assert!(
                (back.slope[0] * dual.slope[0] - 1.0).abs() < 1e-10,
                "{kelvin}"
            );
        }
    }
}
