//! One implicit stage: Newton's method on the equations of a particle.

use calcine_numerics::LinearAlgebra;
use calcine_physics::gas::GAS_CONSTANT;

use super::physics::RadialPhysics;
use super::transport::Outside;
use super::workspace::RadialWorkspace;

/// Rounds of Newton's method at most, and of those the ones that take coefficients anew: then they are held, so that the
/// last rounds square what is left.
const ROUNDS: usize = 40;
const UPDATES: usize = 4;
/// Changes that end them, relative to temperature, pressure and the amount of solids.
const CLOSE: f64 = 1e-8;
/// Share of an amount or a pressure that a round leaves at least, and share of a temperature by which it moves at most.
const LEFT_AMOUNT: f64 = 1e-2;
const LEFT_PRESSURE: f64 = 0.1;
const MOST_WARMED: f64 = 0.25;

impl RadialPhysics {
    /// Solves a stage from its base and an iterate, whose flows count over `length` in s; false where no solution was found.
    pub fn solve(&self, outside: &Outside<'_>, length: f64, ws: &mut RadialWorkspace) -> bool {
        ws.now.extent.fill(0.0);
        ws.now.amount.copy_from_slice(&ws.base.amount);
        for round in 0..ROUNDS {
            if round < UPDATES && !self.coefficients(outside, ws) {
                return false;
            }
            if !self.measure(ws) {
                return false;
            }
            self.assemble(outside, length, ws);
            ws.entries.iter_mut().for_each(|value| *value = -*value);
            if !ws.algebra.factorise(0.0, &ws.entries) {
                return false;
            }
            ws.algebra.solve(&mut ws.right);
            let moved = self.update(outside.around.pressure, ws);
            if !moved.is_finite() {
                return false;
            }
            if moved <= CLOSE {
                self.measure(ws);
                self.properties(ws);
                self.flows(outside, ws);
                return true;
            }
        }
        false
    }

    /// Takes the step of a round; the largest relative change that it asked for.
    fn update(&self, pressure: f64, ws: &mut RadialWorkspace) -> f64 {
        let (n, s, g, r) = (ws.shells, ws.solids, ws.gases, ws.reactions);
        let block = 1 + g;
        let mut most: f64 = 0.0;
        let mut note = |change: f64| {
            most = if change.is_finite() {
                most.max(change)
            } else {
                f64::INFINITY
            };
        };
        for shell in 0..n {
            let step = &ws.right[shell * block..(shell + 1) * block];
            let first = &ws.unreacted[shell * s..(shell + 1) * s];
            let all: f64 = first.iter().sum();
            let mut change = [0.0; super::physics::MOST_SOLIDS];
            for (j, reaction) in self.chemistry.reactions.iter().enumerate() {
                let place = shell * r + j;
                let mut extent = ws.extent_rest[place] + ws.extent_by_temperature[place] * step[0];
                let by = &ws.extent_by_pressure[place * g..(place + 1) * g];
                extent += by
                    .iter()
                    .zip(&step[1..])
                    .map(|(by, step)| by * step)
                    .sum::<f64>();
                note(extent.abs() / all);
                ws.extent_rest[place] = extent;
                for &(k, moles) in &reaction.solids {
                    change[k] += moles * extent;
                }
            }
            let amounts = &ws.now.amount[shell * s..(shell + 1) * s];
            let mut share: f64 = 1.0;
            for (amount, change) in amounts.iter().zip(change) {
                let most = (1.0 - LEFT_AMOUNT) * amount.max(0.0);
                if -change > most {
                    share = share.min(most / -change);
                }
            }
            for j in 0..r {
                ws.now.extent[shell * r + j] += share * ws.extent_rest[shell * r + j];
            }
            self.amounts(shell, ws);
        }
        for node in 0..=n {
            let step = &ws.right[node * block..(node + 1) * block];
            let kelvin = &mut ws.now.temperature[node];
            note(step[0].abs() / *kelvin);
            *kelvin += step[0].clamp(-MOST_WARMED * *kelvin, MOST_WARMED * *kelvin);
            for (own, change) in ws.now.pressure[node * g..(node + 1) * g]
                .iter_mut()
                .zip(&step[1..])
            {
                note(change.abs() / pressure);
                let next = *own + change;
                *own = if *own > 0.0 {
                    next.max(LEFT_PRESSURE * *own)
                } else {
                    next
                };
            }
        }
        most
    }

    /// Amounts of a shell by the extents of the stage.
    fn amounts(&self, shell: usize, ws: &mut RadialWorkspace) {
        let (s, r) = (ws.solids, ws.reactions);
        let own = shell * s..(shell + 1) * s;
        let amounts = &mut ws.now.amount[own.clone()];
        amounts.copy_from_slice(&ws.base.amount[own]);
        for (j, reaction) in self.chemistry.reactions.iter().enumerate() {
            for &(k, moles) in &reaction.solids {
                amounts[k] += moles * ws.now.extent[shell * r + j];
            }
        }
    }

    /// Books what a solved stage comes to: amounts of gases by their pressures (`now_gas`), and what came of them (`came`) and of
    /// enthalpy in J (`warmed`) into each shell. What leaves the particle is what is missing in all: so amounts close, and no
    /// difference of flows far above what pores hold has to be exact.
    pub fn book(&self, ws: &mut RadialWorkspace) {
        let (n, s, g, r) = (ws.shells, ws.solids, ws.gases, ws.reactions);
        for shell in 0..n {
            let solids = shell * s..(shell + 1) * s;
            let pairs = ws.now.amount[solids.clone()]
                .iter()
                .zip(&ws.solid_enthalpy[solids]);
            let mut enthalpy: f64 = pairs.map(|(n, h)| n * h).sum();
            let per_pascal = ws.held.pores[shell] / (GAS_CONSTANT * ws.now.temperature[shell]);
            for k in 0..g {
                let place = shell * g + k;
                let now = ws.now.pressure[place] * per_pascal;
                let mut made = 0.0;
                for (j, reaction) in self.chemistry.reactions.iter().enumerate() {
                    for &(_, moles) in reaction.gases.iter().filter(|one| one.0 == k) {
                        made += moles * ws.now.extent[shell * r + j];
                    }
                }
                ws.now_gas[place] = now;
                ws.came[place] = now - ws.base.gas[place] - made;
                enthalpy += now * ws.gas_enthalpy[place];
            }
            ws.warmed[shell] = enthalpy - ws.base.enthalpy[shell];
        }
    }

    /// Takes amounts of gases in mol as the partial pressures of the iterate.
    pub fn pressurise(&self, gas: &[f64], ws: &mut RadialWorkspace) {
        let g = ws.gases;
        for shell in 0..ws.shells {
            let scale = GAS_CONSTANT * ws.now.temperature[shell] / ws.held.pores[shell];
            for k in 0..g {
                ws.now.pressure[shell * g + k] = gas[shell * g + k] * scale;
            }
        }
    }
}
