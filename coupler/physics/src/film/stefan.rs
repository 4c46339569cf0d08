//! The net flow through a film.

use calcine_numerics::Number;

/// How the net flow of all gases through a film acts on the transfer of each (film theory): a gas of the coefficient β passes
/// a film of the concentration c at the rate
///
/// N = c A [β⁺ x_gas − β⁻ x_surface],   β⁻ = β φ/(e^φ − 1),   β⁺ = β⁻ e^φ,   φ = w/β,
///
/// towards the particle, w the velocity of the net flow towards it in m/s. Of one gas that passes a film in which no other
/// moves it is Spalding's β ln(1 + B).
///
/// Source: Bird, Stewart and Lightfoot, Transport Phenomena, 2nd ed. (2002), sections 19.4 and 22.8, ISBN 0-471-41077-2; Spalding,
/// Proc. 4th Symp. (Int.) Combustion (1953) 847, doi 10.1016/S0082-0784(53)80110-4.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum StefanFlow {
    /// x are mass fractions, and w the flow of mass over the density of the film, which is that of the gas beyond it at the
    /// temperature of the film.
    Mass,
    /// x are mole fractions, and w the flow of moles over the molar density of the film. Exact for films of one temperature
    /// and of gases of one diffusivity.
    Molar,
    /// None.
    None,
}

/// Below this argument the series is exact to round-off.
const SERIES: f64 = 1e-2;

/// x/(eˣ − 1), Bernoulli's function.
#[inline]
pub fn bernoulli<N: Number>(x: N) -> N {
    let v = x.value();
    if v.abs() < SERIES {
        let s = v * v;
        let value = 1.0 - 0.5 * v + s * (1.0 / 12.0 + s * (-1.0 / 720.0 + s / 30_240.0));
        let slope = -0.5 + v * (1.0 / 6.0 + s * (-1.0 / 180.0 + s / 5040.0));
        return x.through(value, slope);
    }
    // Of large arguments the powers of e themselves have no room.
    let value = if v > 0.0 {
        v * (-v).exp() / -(-v).exp_m1()
    } else {
        v / v.exp_m1()
    };
    // d/dx = B/x − B − B²/x
    x.through(value, value * ((1.0 - value) / v - 1.0))
}

#[cfg(test)]
mod tests {
    use super::*;
    use calcine_numerics::Dual;

    #[test]
    fn agrees_with_an_independent_evaluation() {
        // x/(exp(x) − 1) with 50 digits in Python.
        for (x, expected) in [
            (1.0, 0.581_976_706_869_326_4),
            (-1.0, 1.581_976_706_869_326_4),
            (0.009, 0.995_506_749_990_887_6),
            (20.0, 4.122_307_253_373_824e-8),
            (-50.0, 50.0),
            (0.0, 1.0),
        ] {
            let found = bernoulli(x);
            assert!((found / expected - 1.0).abs() < 1e-13, "{x}: {found:e}");
        }
        assert!(bernoulli(800.0) < 1e-300 && bernoulli(-800.0) == 800.0);
    }

    #[test]
    fn the_slope_is_the_difference_quotient_on_both_sides_of_the_series() {
        for x in [-30.0, -1.0, -0.011, -0.009, 0.0, 0.009, 0.011, 1.0, 30.0] {
            let dual = bernoulli(Dual::<1>::along(x, 0));
            let quotient = (bernoulli(x + 1e-5) - bernoulli(x - 1e-5)) / 2e-5;
            assert!(
                (dual.slope[0] - quotient).abs() < 1e-9,
                "{x}: {dual:?} {quotient}"
            );
        }
    }

    #[test]
    fn what_flows_through_a_film_on_which_nothing_else_moves_is_by_spalding_s_logarithm() {
        // w = β⁺ y_gas − β⁻ y_surface with φ = w/β is solved by φ = ln((1 − y_surface)/(1 − y_gas)).
        let (gas, surface): (f64, f64) = (0.1, 0.6);
        let phi = ((1.0 - surface) / (1.0 - gas)).ln();
        let back = bernoulli(phi);
        assert!((phi - (back * phi.exp() * gas - back * surface)).abs() < 1e-15);
    }
}
