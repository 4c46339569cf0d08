//! The law of a smooth wall.

/// Between the wall and the first cell, at the distance y from it, the speed along the wall follows
///
/// u⁺ = y⁺ below y⁺ = 11.53,   u⁺ = ln(E y⁺)/κ above,   u⁺ = u/u*,  y⁺ = u* y/ν,
///
/// with the friction velocity of eddies in equilibrium, u* = C_μ^¼ √k (k of the first cell). Range: smooth walls,
/// 30 < y⁺ < 300 for the logarithm, no separation. Launder and Spalding 1974, doi
/// 10.1016/0045-7825(74)90029-2; the values of κ and E, of the many in use, are those of OpenFOAM's wall functions.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LogLaw {
    /// Von Kármán's constant κ.
    pub karman: f64,
    /// Roughness parameter E.
    pub roughness: f64,
}

impl LogLaw {
    /// κ = 0.41, E = 9.8.
    pub const SMOOTH: Self = Self {
        karman: 0.41,
        roughness: 9.8,
    };

    /// y⁺ at which both laws meet, by iteration of y⁺ = ln(E y⁺)/κ.
    pub fn laminar_limit(&self) -> f64 {
        // The slope 1/(κ y⁺) = 0.2 contracts the error a hundred million times in twelve steps.
        (0..12).fold(11.0, |y: f64, _| (self.roughness * y).ln() / self.karman)
    }

    /// Eddy viscosity over the gas' own between the wall and the first cell, at y⁺ of its centre, such that the
    /// plain difference of velocities gives the law's stress; `limit` is [`Self::laminar_limit`].
    #[inline]
    pub fn eddy_ratio(&self, y_plus: f64, limit: f64) -> f64 {
        // Below the limit exactly zero.
        if y_plus > 0.0 {
            y_plus / self.speed(y_plus, limit) - 1.0
        } else {
            0.0
        }
    }

    /// u⁺ at y⁺; `limit` is [`Self::laminar_limit`].
    #[inline]
    pub fn speed(&self, y_plus: f64, limit: f64) -> f64 {
        if y_plus > limit {
            (self.roughness * y_plus).ln() / self.karman
        } else {
            y_plus
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_laws_meet_at_11_53() {
        // Root of y = ln(9.8 y)/0.41 by bisection: 11.5301073.
        let law = LogLaw::SMOOTH;
        assert!((law.laminar_limit() - 11.530_107).abs() < 1e-5);
    }

    #[test]
    fn agrees_with_an_independent_evaluation_at_y_plus_of_100() {
        // ln(980)/0.41 = 16.798909, and y+/u+ - 1.
        let law = LogLaw::SMOOTH;
        assert!((law.speed(100.0, law.laminar_limit()) - 16.798_909).abs() < 1e-5);
        let ratio = law.eddy_ratio(100.0, law.laminar_limit());
        assert!((ratio - (100.0 / 16.798_909 - 1.0)).abs() < 1e-5);
    }

    #[test]
    fn below_the_limit_the_gas_is_laminar_and_above_the_ratio_rises_from_zero() {
        let law = LogLaw::SMOOTH;
        let limit = law.laminar_limit();
        assert_eq!(law.eddy_ratio(11.0, limit), 0.0);
        assert!(law.eddy_ratio(limit + 1e-3, limit) < 1e-4);
        assert_eq!(law.speed(5.0, limit), 5.0);
    }
}
