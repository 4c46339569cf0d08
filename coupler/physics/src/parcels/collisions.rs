//! Time scales on which collisions damp the velocities of parcels and make them isotropic.

use std::f64::consts::PI;

/// The solid about a parcel, by the averages of its cell.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LocalSolid {
    /// Solid fraction α.
    pub solid_fraction: f64,
    /// Standard deviation of the velocities √(u²) in m/s, all directions together.
    pub fluctuation: f64,
    /// Sauter mean radius r₃₂ in m, positive.
    pub sauter_radius: f64,
    /// Frequency f of collisions in 1/s.
    pub collision_frequency: f64,
}

/// Rates of relaxation by collisions (docs/theory.md, MPC-4), with g = α_cp/(α_cp − α):
///
/// - damping out of equilibrium 1/τ = (8√2/(3π)) ¼(1 − e²) f g;
/// - damping at equilibrium 1/τ = (16/√(3π)) ¼(1 − e²) α √(u²)/r₃₂ g;
/// - isotropy 1/τ = (8√2/(5π)) ¼(3 − e)(1 + e) f g.
///
/// Validity: α < α_cp; at and above close packing the rates are infinite.
///
/// Source: O'Rourke, Zhao and Snider, Chem. Eng. Sci. 64 (2009) 1784, doi 10.1016/j.ces.2008.12.014; O'Rourke and Snider, Chem.
/// Eng. Sci. 65 (2010) 6014, doi 10.1016/j.ces.2010.08.032; Chem. Eng. Sci. 80 (2012) 39, doi 10.1016/j.ces.2012.05.047.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CollisionTimes {
    /// Restitution e, 0 to 1.
    pub restitution: f64,
    /// Solid fraction α_cp of the closest packing.
    pub close_packing: f64,
}

impl CollisionTimes {
    /// Rate 1/τ in 1/s at which velocities relax to their mean, out of equilibrium.
    pub fn damping(&self, solid: &LocalSolid) -> f64 {
        8.0 * 2.0_f64.sqrt() / (3.0 * PI)
            * self.loss()
            * solid.collision_frequency
            * self.crowding(solid)
    }

    /// The same of velocities whose distribution is that of equilibrium.
    pub fn damping_at_equilibrium(&self, solid: &LocalSolid) -> f64 {
        16.0 / (3.0 * PI).sqrt() * self.loss() * solid.solid_fraction * solid.fluctuation
            / solid.sauter_radius
            * self.crowding(solid)
    }

    /// Rate 1/τ in 1/s at which velocities become isotropic.
    pub fn isotropy(&self, solid: &LocalSolid) -> f64 {
        let e = self.restitution;
        8.0 * 2.0_f64.sqrt() / (5.0 * PI)
            * 0.25
            * (3.0 - e)
            * (1.0 + e)
            * solid.collision_frequency
            * self.crowding(solid)
    }

    /// ¼ (1 − e²).
    fn loss(&self) -> f64 {
        0.25 * (1.0 - self.restitution * self.restitution)
    }

    fn crowding(&self, solid: &LocalSolid) -> f64 {
        let room = self.close_packing - solid.solid_fraction;
        if room > 0.0 {
            self.close_packing / room
        } else {
            f64::INFINITY
        }
    }
}

/// Share of its difference from the mean velocity that a parcel loses over a step x = Δt/τ: x/(x + 2) as in
/// Crank and Nicolson's method at half the rate (docs/theory.md, MPC-4).
pub fn damped_share(step_over_time: f64) -> f64 {
    if step_over_time.is_infinite() {
        return 1.0;
    }
    step_over_time / (step_over_time + 2.0)
}

/// Probability 1 − e^(−x) that a collision draws the velocity of a parcel anew over a step x = Δt/τ.
pub fn redrawn_share(step_over_time: f64) -> f64 {
    -(-step_over_time).exp_m1()
}

#[cfg(test)]
mod tests {
    use super::*;

    const TIMES: CollisionTimes = CollisionTimes {
        restitution: 0.9,
        close_packing: 0.65,
    };
    const SOLID: LocalSolid = LocalSolid {
        solid_fraction: 0.4,
        fluctuation: 0.2,
        sauter_radius: 1e-3,
        collision_frequency: 50.0,
    };

    #[test]
    fn rates_agree_with_an_independent_evaluation() {
        // In Python, by the formulas above.
        for (found, expected) in [
            (TIMES.damping(&SOLID), 7.412_604_336_360_172),
            (TIMES.damping_at_equilibrium(&SOLID), 51.492_190_054_409_05),
            (TIMES.isotropy(&SOLID), 93.398_814_638_138_19),
        ] {
            assert!((found / expected - 1.0).abs() < 1e-12, "{found}");
        }
    }

    #[test]
    fn elastic_collisions_damp_nothing_but_make_isotropic() {
        let elastic = CollisionTimes {
            restitution: 1.0,
            ..TIMES
        };
        assert_eq!(elastic.damping(&SOLID), 0.0);
        assert_eq!(elastic.damping_at_equilibrium(&SOLID), 0.0);
        assert!(elastic.isotropy(&SOLID) > 0.0);
    }

    #[test]
    fn at_close_packing_collisions_are_at_once() {
        let packed = LocalSolid {
            solid_fraction: 0.65,
            ..SOLID
        };
        assert_eq!(TIMES.isotropy(&packed), f64::INFINITY);
        assert_eq!(damped_share(TIMES.damping(&packed)), 1.0);
        assert_eq!(redrawn_share(TIMES.isotropy(&packed)), 1.0);
    }

    #[test]
    fn shares_of_short_steps_are_their_rates() {
        assert!((damped_share(1e-9) / 0.5e-9 - 1.0).abs() < 1e-8);
        assert!((redrawn_share(1e-9) / 1e-9 - 1.0).abs() < 1e-8);
    }
}
