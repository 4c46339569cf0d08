//! How close the equations of an attempt are solved: as far as the outer loop can make use of it.
//!
//! The outer loop ends at a residual; a linear solve that goes much further improves nothing but its own equation with coefficients
//! that are not better known. So no solve goes closer than a share of the outer tolerance (the forcing terms of an inexact Newton
//! iteration, Eisenstat and Walker 1996, doi 10.1137/0917003), unless the case states its linear tolerance. What a cell stores
//! is what its fluxes brought, whatever the solves leave (species, enthalpy: their remainders; mass: continuity itself), so that the
//! ledger does not depend on it.

use calcine_coupler::setup::GasControls;

/// Linear solves go no closer than this share of the outer tolerance.
const SHARE: f64 = 0.1;

/// Largest mismatch of a cell's mass with the equation of state, in units of the outer tolerance, with which a window counts as
/// converged. The residual of continuity is a mean over all cells and relative to what flows; over a long window that is many times
/// what a cell holds.
const VOLUME: f64 = 1000.0;

/// What momentum may move the velocity of any one cell by, relative to the fastest gas, in units of the outer tolerance: its residual is a mean over cells,
/// which hardly sees few small ones.
pub const WORST: f64 = 1000.0;

/// When the solve of a scalar ends: where its residual is below either.
#[derive(Clone, Copy, Debug)]
pub struct ScalarTolerance {
    /// As a share of what moves: through the boundary, from the particles, into storage.
    pub absolute: f64,
    /// As a share of the initial residual.
    pub relative: f64,
}

/// Whether the equations of scalars are those of the fields at hand.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Assembled {
    /// Since the fields were looked at last.
    Yes,
    /// They have to be assembled.
    No,
}

/// Continuity at hand.
#[derive(Clone, Copy, Debug, Default)]
pub struct ContinuityResidual {
    /// Σ over cells of its mismatch, and what openings miss, as a share of `terms`.
    pub share: f64,
    /// What cells hold over the storage span, and what flows through them, in kg/s; in short windows what moves pressures as the flow
    /// does, if that is less ([`super::pressure`]).
    pub terms: f64,
    /// Mean Courant number on the process clock, AF Co: how often the gas of a cell is renewed in a window.
    pub renewals: f64,
}

/// What the linear solves of an outer iteration end at.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LinearTolerances {
    /// Σ|mismatch of continuity| in kg/s: a share of what cells hold (in short windows of less), not of what flows through them, which over a long window
    /// is 1 + AF Co times that.
    pub continuity: f64,
    /// Relative to what moves of a scalar. What is left in one cell, flows carry through as many as the window is Courant numbers
    /// long: 1/(1 + AF Co).
    pub scalars: f64,
    /// Below this share of its terms no equation is solved.
    pub terms: f64,
}

impl LinearTolerances {
    /// For the continuity at hand; those of the case, where it says so.
    pub fn new(controls: &GasControls, continuity: &ContinuityResidual) -> Self {
        if let Some(given) = controls.linear_tolerance {
            return Self {
                continuity: 0.0,
                scalars: given,
                terms: given,
            };
        }
        let share = SHARE * controls.outer_tolerance / (1.0 + continuity.renewals);
        Self {
            continuity: share * continuity.terms,
            scalars: share.max(GasControls::CLOSE),
            terms: GasControls::CLOSE,
        }
    }
}

/// Largest mismatch of a cell's mass with the equation of state of a converged window.
pub fn volume_bound(controls: &GasControls) -> f64 {
    VOLUME * controls.outer_tolerance
}

#[cfg(test)]
mod tests {
    use super::*;

    fn controls(outer_tolerance: f64, linear_tolerance: Option<f64>) -> GasControls {
        GasControls {
            outer_iterations: 20,
            convection: Default::default(),
            pressure_corrections: 2,
            time_scheme: Default::default(),
            most_pressure_corrections: 16,
            outer_tolerance,
            linear_tolerance,
        }
    }

    #[test]
    fn linear_solves_follow_the_outer_tolerance_and_the_renewals_of_the_gas() {
        let continuity = ContinuityResidual {
            share: 1.0,
            terms: 3.0,
            renewals: 9.0,
        };
        let found = LinearTolerances::new(&controls(1e-5, None), &continuity);
        let near = |found: f64, wanted: f64| (found / wanted - 1.0).abs() < 1e-12;
        assert!(near(found.continuity, 3e-7));
        assert!(near(found.scalars, 1e-7));
    }

    #[test]
    fn a_linear_tolerance_of_the_case_is_kept() {
        let found = LinearTolerances::new(&controls(1e-5, Some(1e-8)), &Default::default());
        assert_eq!(
            [found.continuity, found.scalars, found.terms],
            [0.0, 1e-8, 1e-8]
        );
    }
}
