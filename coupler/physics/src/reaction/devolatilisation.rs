//! Devolatilisation of biomass by one rate of the volatiles left.

use calcine_numerics::Number;

use super::arrhenius::Arrhenius;

/// Volatiles of a particle that leave by a rate of order n (docs/theory.md, DEV-2):
///
/// dm_v/dt = −k(T) m_v^n m_v0^(1−n),
///
/// which is dy/dt = −k yⁿ of the share y = m_v/m_v0 that is left.
///
/// Validity: wood and its like, dry, 550 to 700 K. Source: Tavakkol et al. (docs/theory.md, DEV-2): k₀ = 2.58e11 1/s,
/// E = 159.2 kJ/mol, n = 1.22.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Devolatilisation {
    /// k in 1/s over temperature.
    pub rate: Arrhenius,
    /// Order n, at least 1: below it the last volatiles leave in finite time.
    pub order: f64,
}

impl Devolatilisation {
    /// Share y of the volatiles that is left after a time in s at a temperature in K, of a share left before; exact for a
    /// constant temperature:
    ///
    /// y = [y₀^(1−n) + (n − 1) k t]^(−1/(n−1)),   n = 1: y₀ e^(−kt).
    pub fn left<N: Number>(&self, before: f64, temperature: N, time: f64) -> N {
        if before == 0.0 {
            return N::constant(0.0);
        }
        let rate = self.rate.of(temperature);
        let advance = rate.value() * time;
        let n = self.order - 1.0;
        // y₀ (1 + (n − 1) y₀^(n−1) k t)^(−1/(n−1)), by its logarithm: regular at n = 1.
        let scaled = before.powf(n) * advance;
        let value = if n == 0.0 {
            before * (-advance).exp()
        } else {
            before * (-(n * scaled).ln_1p() / n).exp()
        };
        // dy/d(kt) = −yⁿ
        rate.through(value, -time * value.powf(self.order))
    }

    /// Rate in mol/s at a temperature in K of an amount in mol that is left of another one at the start.
    pub fn turnover<N: Number>(&self, amount: N, start: f64, temperature: N) -> N {
        if start <= 0.0 || amount.value() <= 0.0 {
            return N::constant(0.0);
        }
        let left = amount.value() / start;
        let value = start * left.powf(self.order);
        amount.through(value, self.order * left.powf(self.order - 1.0)) * self.rate.of(temperature)
    }

    /// Rate −dy/dt in 1/s of a share left at a temperature in K.
    pub fn rate(&self, left: f64, temperature: f64) -> f64 {
        self.rate.at(temperature) * left.powf(self.order)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use calcine_numerics::Dual;

    const BIOMASS: Devolatilisation = Devolatilisation {
        rate: Arrhenius {
            factor: 2.58e11,
            exponent: 0.0,
            activation_energy: 159_200.0,
        },
        order: 1.22,
    };

    #[test]
    fn rate_constants_agree_with_independent_values() {
        // In Python: 2.58e11 exp(−159.2e6/8314.462618/T).
        for (temperature, expected) in [
            (573.0, 7.929_433_811_186_586e-4),
            (598.0, 3.205_877_507_135_472e-3),
            (623.0, 1.158_669_235_389_905e-2),
            (673.0, 0.113_661_473_515_601_6),
        ] {
            let found = BIOMASS.rate(1.0, temperature);
            assert!(
                (found / expected - 1.0).abs() < 1e-12,
                "{temperature}: {found:e}"
            );
        }
    }

    #[test]
    fn conversion_after_half_an_hour_at_573_k_is_that_of_the_closed_form() {
        // docs/theory.md, DEV-5.
        let left = BIOMASS.left(1.0, 573.0, 1800.0);
        assert!((1.0 - left - 0.710_984_072_794_5).abs() < 1e-11, "{left}");
    }

    #[test]
    fn two_parts_of_a_time_are_the_whole() {
        let half = BIOMASS.left(1.0, 600.0, 100.0);
        let whole: f64 = BIOMASS.left(1.0, 600.0, 200.0);
        assert!((BIOMASS.left(half, 600.0, 100.0) / whole - 1.0).abs() < 1e-14);
    }

    #[test]
    fn of_first_order_it_is_an_exponential_and_the_limit_of_higher_orders() {
        let of = |order: f64| Devolatilisation { order, ..BIOMASS }.left(0.7, 600.0, 300.0);
        let exact: f64 = 0.7 * (-300.0 * BIOMASS.rate.at(600.0)).exp();
        assert_eq!(of(1.0), exact);
        assert!((of(1.0 + 1e-9) / exact - 1.0).abs() < 1e-8);
    }

    #[test]
    fn the_slope_is_the_difference_quotient() {
        let dual = BIOMASS.left(0.8, Dual::<1>::along(610.0, 0), 60.0);
        let quotient =
            (BIOMASS.left(0.8, 610.001, 60.0) - BIOMASS.left(0.8, 609.999, 60.0)) / 0.002;
        assert!((dual.slope[0] / quotient - 1.0).abs() < 1e-7);
    }

    #[test]
    fn heated_at_a_constant_rate_it_is_half_converted_and_fastest_where_an_integration_apart_has_it()
     {
        // docs/theory.md, DEV-5: 5, 10, 20 K/min; half converted, fastest, in K.
        for (heating, half, fastest) in [
            (5.0, 599.77, 603.6),
            (10.0, 612.29, 616.3),
            (20.0, 625.34, 629.5),
        ] {
            let step = 0.05;
            let time = step / (heating / 60.0);
            let (mut left, mut temperature) = (1.0, 450.0);
            let (mut found_half, mut peak) = (0.0, (0.0, 0.0));
            while temperature < 750.0 {
                let middle: f64 = temperature + 0.5 * step;
                let next = BIOMASS.left(left, middle, time);
                if left >= 0.5 && next < 0.5 {
                    found_half = temperature + step * (left - 0.5) / (left - next);
                }
                if left - next > peak.0 {
                    peak = (left - next, middle);
                }
                left = next;
                temperature += step;
            }
            assert!((found_half - half).abs() < 0.01, "{heating}: {found_half}");
            assert!((peak.1 - fastest).abs() < 0.1, "{heating}: {}", peak.1);
        }
    }
}
