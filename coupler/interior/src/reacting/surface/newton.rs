//! How the gas at the surface of a particle is found.

use calcine_numerics::{LinearAlgebra, Number};

use super::{RateTerm, SurfaceBalance, SurfaceGas};

/// Rounds at most by which the state of a surface is found.
const ROUNDS: usize = 100;
/// Largest relative change of any concentration that ends them: Newton's method squares errors, and the rates are those of
/// one step more.
const CLOSE: f64 = 1e-7;
/// Changes up to which concentrations follow a linear step, and changes of logarithms in one step at most.
const LINEAR: f64 = 0.25;
const LONGEST: f64 = 40.0;
const LONGEST_LINEAR: f64 = 1.5;
/// Logarithms of ratios in all above which linear steps are given up again.
const FAR: f64 = 4.0;
/// Square of slopes of logarithms below which they count as none.
const DAMPING: f64 = 1e-4;

impl<N: Number> SurfaceBalance<N> {
    /// Concentrations to begin with: those of the solution before, or of the gas beyond the film, or those below which rates of
    /// order zero end where these want more than the film brings.
    pub(super) fn start(&mut self, moles: &[Vec<(usize, f64)>]) {
        let in_gas = |gas: &SurfaceGas<N>| gas.supply.value() / gas.conductance.value();
        let sum: f64 = self.gases.iter().map(in_gas).sum();
        let all = if sum > 0.0 { sum } else { 1.0 };
        self.threshold = f64::EPSILON * all;
        if self.x.len() == self.gases.len() && self.x.iter().all(|x| *x > 0.0 && x.is_finite()) {
            return;
        }
        self.x.clear();
        for (k, gas) in self.gases.iter().enumerate() {
            let bulk = in_gas(gas);
            let zeroth = self.terms.iter().filter(|term| {
                let powers = &self.powers[term.powers.0..term.powers.1];
                powers.contains(&(k, 0.0))
            });
            let wanted: f64 = zeroth
                .flat_map(|term| {
                    let own = moles[term.reaction].iter().filter(|one| one.0 == k);
                    own.map(|one| -one.1 * term.coefficient.value())
                })
                .sum();
            self.x.push(if wanted > gas.supply.value() && bulk > 0.0 {
                self.threshold * gas.supply.value() / wanted
            } else if bulk > 0.0 {
                bulk
            } else {
                all
            });
        }
    }

    /// Newton's method with so much of steps of logarithms; true where it ended at a solution.
    pub(super) fn find(&mut self, moles: &[Vec<(usize, f64)>], step: f64) -> bool {
        let mut off = self.evaluate(moles);
        let mut far = LINEAR;
        for _ in 0..ROUNDS {
            if !off.is_finite() {
                return false;
            }
            if off > far && self.logarithmic_change(moles) > LINEAR {
                for (x, change) in self.x.iter_mut().zip(&self.right) {
                    *x *= (step * change).exp();
                }
            } else {
                // Along an equilibrium both sides come nearer towards endless concentrations too: linear steps stay.
                far = FAR;
                let change = self.linear_change(moles);
                if change <= CLOSE {
                    return true;
                }
                // Far along an equilibrium logarithms go with the linear step, which keeps to it.
                let share = (LONGEST_LINEAR / change).min(1.0);
                let steps = self.x.iter_mut().zip(&self.right).zip(&self.state.there);
                for ((x, step), _) in steps.filter(|(_, there)| **there) {
                    *x *= if change <= LINEAR {
                        1.0 + step
                    } else {
                        (share * step).exp()
                    };
                }
            }
            off = self.evaluate(moles);
        }
        false
    }

    /// How the logarithm of a term changes with that of the concentration of a gas of an order in it.
    fn steepness(&self, gas: usize, order: f64) -> f64 {
        if order == 0.0 {
            f64::from(u8::from(self.x[gas] < self.threshold))
        } else {
            order
        }
    }

    /// Changes of logarithms, in `right`, by which those of the ratios of both sides vanish to first order, as far as the changes are
    /// not far more than the ratios (Marquardt 1963, doi 10.1137/0111030): along an equilibrium ratios say nothing. The largest of them.
    fn logarithmic_change(&mut self, moles: &[Vec<(usize, f64)>]) -> f64 {
        let n = self.gases.len();
        let state = &self.state;
        self.slopes.clear();
        self.slopes.resize(n * n, 0.0);
        for k in (0..n).filter(|k| state.there[*k]) {
            let passed = self.gases[k].conductance.value() * self.x[k];
            self.slopes[k * n + k] = passed / state.used[k];
        }
        for (term, value) in self.terms.iter().zip(&state.terms) {
            for &(gas, moles) in &moles[term.reaction] {
                let made = moles * term.sign * value;
                if made == 0.0 || !state.there[gas] {
                    continue;
                }
                let share = if made > 0.0 {
                    made / state.brought[gas]
                } else {
                    made / state.used[gas]
                };
                for &(other, order) in &self.powers[term.powers.0..term.powers.1] {
                    self.slopes[gas * n + other] -= share * self.steepness(other, order);
                }
            }
        }
        self.entries.clear();
        self.entries.resize(n * n, 0.0);
        self.right.clear();
        self.right.resize(n, 0.0);
        for row in (0..n).filter(|k| state.there[*k]) {
            let slopes = &self.slopes[row * n..(row + 1) * n];
            let ratio = (state.used[row] / state.brought[row]).ln();
            for (k, slope) in slopes.iter().enumerate() {
                self.right[k] += slope * ratio;
                for (l, other) in slopes.iter().enumerate() {
                    self.entries[k * n + l] += slope * other;
                }
            }
        }
        self.matrix.resize(n);
        if !self.matrix.factorise(-DAMPING, &self.entries) {
            return 0.0;
        }
        self.matrix.solve(&mut self.right);
        let largest = self.right.iter().fold(0.0, |a: f64, b| a.max(b.abs()));
        if largest > LONGEST {
            self.right.iter_mut().for_each(|x| *x *= LONGEST / largest);
        }
        largest
    }

    /// Takes up the linear equations of concentrations and net rates at x: of a gas that is there by its relative change, of one that is
    /// not by its concentration; the largest relative change that they say.
    fn linear_change(&mut self, moles: &[Vec<(usize, f64)>]) -> f64 {
        let (gases, reactions) = (self.gases.len(), moles.len());
        let n = gases + reactions;
        self.entries.clear();
        self.entries.resize(n * n, 0.0);
        self.right.clear();
        self.right.resize(n, 0.0);
        for (k, gas) in self.gases.iter().enumerate() {
            let conductance = gas.conductance.value();
            self.entries[k * n + k] = match self.state.there[k] {
                true => conductance * self.x[k],
                false => conductance,
            };
            self.right[k] = conductance * self.state.concentration[k] - gas.supply.value();
        }
        for (reaction, moles) in moles.iter().enumerate() {
            let row = gases + reaction;
            self.entries[row * n + row] = 1.0;
            for &(gas, moles) in moles {
                self.entries[gas * n + row] -= moles;
            }
        }
        for (place, term) in self.terms.iter().enumerate() {
            let row = gases + term.reaction;
            let value = term.sign * self.state.terms[place];
            self.right[row] -= value;
            let powers = &self.powers[term.powers.0..term.powers.1];
            for &(gas, order) in powers {
                let slope = if self.state.there[gas] {
                    if value == 0.0 {
                        continue;
                    }
                    value * self.steepness(gas, order)
                } else if order == 1.0 {
                    term.sign * self.without(term, gas)
                } else {
                    continue;
                };
                self.entries[row * n + gas] -= slope;
            }
        }
        self.matrix.resize(n);
        if !self.matrix.factorise(0.0, &self.entries) {
            return f64::INFINITY;
        }
        self.matrix.solve(&mut self.right);
        let each = self.right.iter().zip(&self.state.there);
        let there = each.filter(|(_, there)| **there);
        there.fold(0.0, |most: f64, (change, _)| {
            if change.is_finite() {
                most.max(change.abs())
            } else {
                f64::INFINITY
            }
        })
    }

    /// A term but for the factor of a gas, in mol/s at 1 mol/m³.
    fn without(&self, term: &RateTerm<N>, gas: usize) -> f64 {
        let powers = &self.powers[term.powers.0..term.powers.1];
        let others = powers.iter().filter(|one| one.0 != gas);
        let each = others.map(|&(other, order)| self.factor(other, order));
        each.fold(term.coefficient.value(), |product, one| product * one)
    }

    /// Net rates by one step more, with their derivatives.
    pub(super) fn follow(&mut self, found: bool, mut out: impl FnMut(usize, N)) {
        let gases = self.gases.len();
        if !found {
            self.x.clear();
            for reaction in 0..self.returning.len() {
                out(reaction, N::constant(f64::NAN));
            }
            return;
        }
        let mut solution = std::mem::take(&mut self.solution);
        solution.clear();
        let each = self.gases.iter().zip(&self.state.concentration);
        solution.extend(each.map(|(gas, c)| gas.conductance.times(*c) - gas.supply));
        solution.resize(gases + self.returning.len(), N::constant(0.0));
        for term in &self.terms {
            let powers = &self.powers[term.powers.0..term.powers.1];
            let factors = powers.iter().map(|&(gas, order)| self.factor(gas, order));
            let value = term.coefficient.times(term.sign * factors.product::<f64>());
            let row = gases + term.reaction;
            solution[row] = solution[row] - value;
        }
        for (reaction, factor) in self.returning.iter().enumerate() {
            let rate = solution[gases + reaction];
            if factor.value() < 1.0 && rate.value() > 0.0 {
                solution[gases + reaction] = rate * *factor;
            }
        }
        self.matrix.solve_numbers(&mut solution);
        for (reaction, rate) in solution[gases..].iter().enumerate() {
            out(reaction, *rate);
        }
        self.solution = solution;
    }
}
