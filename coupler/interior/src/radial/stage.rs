//! Rounds of Newton's method on the equations of the stages at which particles side by side are.

use calcine_numerics::lanes::vectorised;
use calcine_physics::gas::GAS_CONSTANT;

use super::physics::RadialPhysics;
use super::side_by_side::Wide;
use super::transport::{ANY, OutsideLanes};
use super::workspace::RadialWorkspace;

/// Share of an amount or a pressure that a round leaves at least, and share of a temperature by which it moves at most.
const LEFT_AMOUNT: f64 = 1e-2;
const LEFT_PRESSURE: f64 = 0.1;
const MOST_WARMED: f64 = 0.25;

impl RadialPhysics {
    /// One round of Newton's method in each lane, at its own stage: from the iterate `now` and the base to the next iterate. What it
    /// asked for is left in `ws.right` and `ws.moved`.
    pub fn round(&self, outside: &OutsideLanes<'_>, ws: &mut RadialWorkspace) {
        vectorised(
            #[inline(always)]
            || match self.gases() {
                0 => self.round_of::<0, 1>(outside, ws),
                1 => self.round_of::<1, 2>(outside, ws),
                2 => self.round_of::<2, 3>(outside, ws),
                3 => self.round_of::<3, 4>(outside, ws),
                _ => self.round_of::<ANY, 0>(outside, ws),
            },
        );
    }

    /// The same, compiled for a number of gases and the order of the blocks that follows.
    #[inline(always)]
    fn round_of<const G: usize, const B: usize>(
        &self,
        outside: &OutsideLanes<'_>,
        ws: &mut RadialWorkspace,
    ) {
        self.measure(ws);
        if ws.updating.any(|updating| updating > 0.0) {
            self.coefficients::<G>(outside, ws);
        }
        self.properties::<G>(ws);
        self.assemble::<G>(outside, ws);
        ws.algebra.solve::<B>(&ws.entries, &mut ws.right);
        self.update::<G>(outside, ws);
    }

    /// Takes the step of a round; the largest relative change that it asked for.
    #[inline(always)]
    fn update<const G: usize>(&self, outside: &OutsideLanes<'_>, ws: &mut RadialWorkspace) {
        let (n, s, r) = (ws.shells, ws.solids, ws.reactions);
        let g = if G == ANY { ws.gases } else { G };
        let block = 1 + g;
        let mut most = Wide::default();
        // Zero but where a change is not finite.
        let mut wrong = Wide::default();
        let mut over_pressure = Wide::default();
        for (lane, outside) in outside.iter().enumerate() {
            over_pressure[lane] = outside.as_ref().map_or(1.0, |one| 1.0 / one.pressure);
        }
        for shell in 0..n {
            let mut all = Wide::default();
            for first in &ws.unreacted[shell * s..(shell + 1) * s] {
                all += *first;
            }
            let over = all.inverse();
            for j in 0..r {
                let place = shell * r + j;
                let mut extent = ws.extent_rest[place]
                    + ws.extent_by_temperature[place] * ws.right[shell * block];
                for h in 0..g {
                    extent +=
                        ws.extent_by_pressure[place * g + h] * ws.right[shell * block + 1 + h];
                }
                most = most.max(extent.abs() * over);
                wrong += extent * 0.0;
                ws.extent_rest[place] = extent;
            }
            // No amount is left less than a share of what it is.
            let mut share = Wide::all(1.0);
            for k in 0..s {
                let mut change = Wide::default();
                for j in 0..r {
                    change += ws.extent_rest[shell * r + j] * self.solid_moles[j * s + k];
                }
                let least = ws.now.amount[shell * s + k].positive() * (1.0 - LEFT_AMOUNT);
                let wanted = -change;
                let limited = least.if_below(wanted, least / wanted, share);
                share = share.min(limited);
            }
            for j in 0..r {
                let place = shell * r + j;
                let step = share * ws.extent_rest[place];
                ws.now.extent[place] += step;
            }
            for k in 0..s {
                let mut amount = ws.base.amount[shell * s + k];
                for j in 0..r {
                    amount += ws.now.extent[shell * r + j] * self.solid_moles[j * s + k];
                }
                ws.now.amount[shell * s + k] = amount;
            }
        }
        for node in 0..=n {
            let step = ws.right[node * block];
            let kelvin = ws.now.temperature[node];
            most = most.max(step.abs() / kelvin);
            wrong += step * 0.0;
            let limit = kelvin * MOST_WARMED;
            ws.now.temperature[node] = kelvin + step.max(-limit).min(limit);
            for k in 0..g {
                let step = ws.right[node * block + 1 + k];
                most = most.max(step.abs() * over_pressure);
                wrong += step * 0.0;
                let own = ws.now.pressure[node * g + k];
                let next = own + step;
                let least = next.max(own * LEFT_PRESSURE);
                ws.now.pressure[node * g + k] = own.if_positive(least, next);
            }
        }
        ws.moved = most + wrong;
    }

    /// Books what a solved stage of a lane comes to: amounts of gases by their pressures (`now_gas`), enthalpies of shells, and what
    /// came of gases (`came`) and of enthalpy in J (`warmed`) into each shell. What leaves the particle is what is missing in all: so
    /// amounts close, and no difference of flows far above what pores hold has to be exact.
    pub fn book(&self, lane: usize, ws: &mut RadialWorkspace) {
        let (n, s, g, r) = (ws.shells, ws.solids, ws.gases, ws.reactions);
        let block = 1 + g;
        for shell in 0..n {
            [ws.held.volume[shell][lane], ws.held.pores[shell][lane]] =
                self.volumes(shell, lane, ws);
            // Enthalpies are those before the last round, which moved temperatures by no more than its bound: to round-off they
            // follow along their slope.
            let warmer = ws.right[shell * block][lane];
            let mut enthalpy = 0.0;
            for k in shell * s..(shell + 1) * s {
                let own = ws.solid_enthalpy[k][lane] + ws.solid_capacity[k][lane] * warmer;
                enthalpy += ws.now.amount[k][lane] * own;
            }
            let kelvin = ws.now.temperature[shell][lane];
            let per_pascal = ws.held.pores[shell][lane] / (GAS_CONSTANT * kelvin);
            for k in 0..g {
                let place = shell * g + k;
                let now = ws.now.pressure[place][lane] * per_pascal;
                let mut made = 0.0;
                for j in 0..r {
                    made += self.gas_moles[j * g + k] * ws.now.extent[shell * r + j][lane];
                }
                ws.now_gas[place][lane] = now;
                ws.came[place][lane] = now - ws.base.gas[place][lane] - made;
                let own = ws.gas_enthalpy[place][lane] + ws.gas_capacity[place][lane] * warmer;
                enthalpy += now * own;
            }
            ws.now_enthalpy[shell][lane] = enthalpy;
            ws.warmed[shell][lane] = enthalpy - ws.base.enthalpy[shell][lane];
        }
    }

    /// Takes the amounts of gases at the start of a lane as the partial pressures of its iterate.
    pub fn pressurise(&self, lane: usize, ws: &mut RadialWorkspace) {
        let g = ws.gases;
        for shell in 0..ws.shells {
            let kelvin = ws.now.temperature[shell][lane];
            let scale = GAS_CONSTANT * kelvin / ws.held.pores[shell][lane];
            for k in 0..g {
                ws.now.pressure[shell * g + k][lane] = ws.start_gas[shell * g + k][lane] * scale;
            }
        }
    }
}
