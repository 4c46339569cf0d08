//! Reactions that are far faster than all else: at their equilibrium, or at the end of what they use (docs/theory.md, XDP-9).
//!
//! The extent of a reaction is eliminated from the equations of its shell at given temperature and pressures. Where it follows these
//! [`INSTANT`] times as strongly as the shell stores them, it is where it would be if it were faster still, to that share; beyond, what
//! the shell stores would be lost to round-off. Its rate counts up to there.

use calcine_physics::pores::dusty_gas::MOST_GASES;

use super::physics::RadialPhysics;
use super::rates::{ShellRate, ShellState};
use super::side_by_side::{LANES, Wide};

/// How many times as strongly as a shell stores what drives it a reaction follows that at most.
const INSTANT: f64 = 1e12;
/// Least share of one that the rate itself leaves of the slope of its equation; a rate that grows as its solid goes is followed along
/// the line to the end of that.
const LEAST_SLOPE: f64 = 0.5;

/// What a shell stores in a stage, with what passes its faces: of each gas in mol/Pa, of heat in J/K.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct ShellStores {
    pub gas: [Wide; MOST_GASES],
    pub heat: Wide,
}

/// Molar enthalpies in J/mol of solids and gases of a shell.
#[derive(Clone, Copy, Debug)]
pub(super) struct ReactingEnthalpies<'a> {
    pub solids: &'a [Wide],
    pub gases: &'a [Wide],
}

impl RadialPhysics {
    /// Slows a rate that is too fast to tell from an instant one over a weight in s, and takes slopes by which its end is found.
    #[inline(always)]
    pub fn tame(
        &self,
        index: usize,
        state: &ShellState<'_>,
        weight: Wide,
        (stores, enthalpies): (&ShellStores, &ReactingEnthalpies<'_>),
        rate: &mut ShellRate,
    ) {
        let reaction = &self.chemistry.reactions[index];
        let mut fast = Wide::default();
        let mut heat = Wide::default();
        let mut turned: f64 = 0.0;
        for &(k, moles) in &reaction.gases {
            heat += enthalpies.gases[k] * moles;
            turned += moles.abs();
        }
        for (by, stored) in rate.by_pressure.iter().zip(&stores.gas) {
            fast = fast.max(by.abs() * turned / *stored);
        }
        // How the equation of the extent follows the solids, one at first.
        let mut by_solids = Wide::default();
        for &(k, moles) in &reaction.solids {
            heat += enthalpies.solids[k] * moles;
            by_solids -= rate.by_amount[k] * moles;
        }
        fast = fast.max((rate.by_temperature * heat / stores.heat).abs());
        let ends = self.reactant[index];
        let chord = rate.value / state.amounts[ends];
        let slope = weight * by_solids;
        let fast = weight * fast;
        let quick = (weight * chord).max(slope);
        let slow = !(fast.max(quick).any(|fast| fast > INSTANT)
            || slope.any(|slope| slope < LEAST_SLOPE - 1.0));
        if slow {
            return;
        }
        let mut share = Wide::all(1.0);
        for lane in 0..LANES {
            let forth = rate.value[lane] > 0.0 && state.amounts[ends][lane] > 0.0;
            let quick = if forth { quick[lane] } else { 0.0 };
            let most = fast[lane].max(quick);
            if most > INSTANT {
                share[lane] = INSTANT / most;
            }
            // Beside the reactant nothing moves a rate that is found by its line.
            let grows = slope[lane] < LEAST_SLOPE - 1.0;
            if forth && (grows || quick > INSTANT) {
                for by in &mut rate.by_amount {
                    by[lane] = 0.0;
                }
                rate.by_amount[ends][lane] = chord[lane];
            }
        }
        rate.value = rate.value * share;
        rate.by_temperature = rate.by_temperature * share;
        for by in rate.by_pressure.iter_mut().chain(&mut rate.by_amount) {
            *by = *by * share;
        }
    }
}
