//! Mechanisms: gas reactions over the species of a mixture.

use std::sync::Arc;

use calcine_numerics::Number;

use super::error::KineticsError;
use super::falloff::RateConstant;
use super::mechanism_reaction::MechanismReaction;
use super::statement::ReactionStatement;
use crate::gas::GAS_CONSTANT;
use crate::reaction::equilibrium::STANDARD_PRESSURE;
use crate::thermo::Mixture;
use crate::thermo::mixture::MOST_SPECIES;

/// Concentration in mol/m³ below which a power of an order below one goes on as a straight line, a mole
/// fraction of about 1e-7 in a flame: see [`power`].
pub const FLOOR: f64 = 1e-6;

/// A gas at which rates are asked.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MixtureState<'a> {
    /// Pressure in Pa.
    pub pressure: f64,
    /// Temperature in K.
    pub temperature: f64,
    /// Mass fractions in the order of the mixture; negative ones count as zero.
    pub fractions: &'a [f64],
}

/// Gas reactions over the species of a mixture, in the mixture's order.
///
/// The rate of progress of a reaction in mol/m³/s is
///
/// q = [M] (k Π c_i^a_i − k/K Π c_i^(a_i + ν_i)),
///
/// with the concentrations c in mol/m³, the orders a (the numbers of the left side unless stated), ν the right side's numbers
/// less the left's, and the equilibrium constant K = exp(−ΔG°/(R T)) (p°/(R T))^Σν of the species' own Gibbs energies; the second
/// term only where the reaction goes both ways, [M] only with a third body. At equilibrium both terms are equal for
/// any orders. A species is made at w_i = M_i Σ ν_i q in kg/m³/s.
///
/// Orders below one: see [`power`].
#[derive(Clone, Debug)]
pub struct Mechanism {
    // Shared, so that a thread's own costs nothing.
    mixture: Arc<Mixture>,
    steps: Arc<[MechanismReaction]>,
    /// Species whose Gibbs energy is needed.
    gibbs: Arc<[usize]>,
}

impl Mechanism {
    /// A mechanism of these reactions over the species of a mixture.
    pub fn new(mixture: &Mixture, statements: &[ReactionStatement]) -> Result<Self, KineticsError> {
        let steps = statements
            .iter()
            .map(|one| MechanismReaction::new(mixture, one))
            .collect::<Result<Vec<_>, _>>()?;
        let both_ways = || steps.iter().filter(|one| one.back.is_some());
        let gibbs = (0..mixture.species().len())
            .filter(|k| both_ways().any(|one| one.net.iter().any(|(i, _)| i == k)))
            .collect();
        Ok(Self {
            mixture: Arc::new(mixture.clone()),
            steps: steps.into(),
            gibbs,
        })
    }

    /// How many species the mixture has.
    pub fn species(&self) -> usize {
        self.mixture.species().len()
    }

    /// The mixture.
    pub fn mixture(&self) -> &Mixture {
        &self.mixture
    }

    /// Its reactions.
    pub fn steps(&self) -> &[MechanismReaction] {
        &self.steps
    }

    /// How fast each species is made, in kg/m³/s.
    pub fn rates(&self, state: MixtureState<'_>, out: &mut [f64]) {
        let mut concentrations = [0.0; MOST_SPECIES];
        self.concentrations(&state, &mut concentrations);
        self.mass_rates(state.temperature, &concentrations, out);
    }

    /// Rates of progress forth and back of every reaction in mol/m³/s, in the order of the steps.
    pub fn progress(&self, state: MixtureState<'_>) -> Vec<(f64, f64)> {
        let mut concentrations = [0.0; MOST_SPECIES];
        self.concentrations(&state, &mut concentrations);
        let mut all = Vec::with_capacity(self.steps.len());
        self.each(state.temperature, &concentrations, |_, forth, back| {
            all.push((forth, back));
        });
        all
    }

    /// Concentrations in mol/m³; their sum is p/(R T).
    fn concentrations(&self, state: &MixtureState<'_>, out: &mut [f64; MOST_SPECIES]) {
        let mut sum = 0.0;
        let species = self.mixture.species().iter().zip(state.fractions);
        for (c, (one, y)) in out.iter_mut().zip(species) {
            *c = y.max(0.0) / one.molar_mass();
            sum += *c;
        }
        let factor = state.pressure / (GAS_CONSTANT * state.temperature * sum);
        out.iter_mut().for_each(|c| *c *= factor);
    }

    /// Chemical time in s as OpenFOAM's PaSR defines it: t_c = n Σ_i c_i/Σ_r (Σ_j ν_j,r) q_r with the number n of
    /// reactions, the concentrations, the numbers ν of the right sides and the rates of progress forth q. Infinite where
    /// nothing reacts.
    pub fn chemical_time(&self, state: MixtureState<'_>) -> f64 {
        let mut concentrations = [0.0; MOST_SPECIES];
        self.concentrations(&state, &mut concentrations);
        let mut made = 0.0;
        self.each(state.temperature, &concentrations, |one, forth, _| {
            made += one.right.iter().map(|(_, n)| n).sum::<f64>() * forth;
        });
        if made <= 0.0 {
            return f64::INFINITY;
        }
        let total: f64 = concentrations.iter().sum();
        self.steps.len() as f64 * total / made
    }

    /// How fast each species is made in kg/m³/s, from concentrations in mol/m³; the result is Σ_r (Σ_j ν_j,r) q_r of
    /// [`Mechanism::chemical_time`] in mol/m³/s.
    pub(super) fn mass_rates<N: Number>(
        &self,
        temperature: N,
        concentrations: &[N; MOST_SPECIES],
        out: &mut [N],
    ) -> N {
        out.fill(N::constant(0.0));
        let mut gained = N::constant(0.0);
        self.each(temperature, concentrations, |one, forth, back| {
            gained = gained + forth.times(one.right.iter().map(|(_, n)| n).sum());
            let progress = forth - back;
            for &(k, n) in &one.net {
                out[k] = out[k] + progress.times(n);
            }
        });
        for (w, one) in out.iter_mut().zip(self.mixture.species()) {
            *w = w.times(one.molar_mass());
        }
        gained
    }

    /// Visits every reaction with its rates of progress forth and back.
    #[inline]
    fn each<N: Number>(
        &self,
        temperature: N,
        concentrations: &[N; MOST_SPECIES],
        mut visit: impl FnMut(&MechanismReaction, N, N),
    ) {
        let t = temperature.value();
        // G°/(R T) of the species, whose slope is −H/(R T²).
        let mut gibbs = [(0.0, 0.0); MOST_SPECIES];
        for &k in self.gibbs.iter() {
            let law = self.mixture.species()[k].polynomial();
            let thermal = GAS_CONSTANT * t;
            gibbs[k] = (
                law.gibbs_energy(t) / thermal,
                -law.enthalpy(t) / (thermal * t),
            );
        }
        let standard = (STANDARD_PRESSURE / (GAS_CONSTANT * t)).ln();
        for one in self.steps.iter() {
            let bodies = match &one.collider {
                None => N::constant(1.0),
                Some(efficiencies) => efficiencies
                    .iter()
                    .zip(concentrations)
                    .fold(N::constant(0.0), |sum, (e, c)| sum + c.times(*e)),
            };
            let mut constant = one.rate.at(temperature, bodies);
            if one.collider.is_some() && matches!(one.rate, RateConstant::Arrhenius(_)) {
                constant = constant * bodies;
            }
            let forth = constant * product(&one.orders, concentrations);
            let back = match &one.back {
                // Nothing runs back of what does not run forth; 1/K may overflow there.
                Some(orders) if constant.value() != 0.0 => {
                    let (value, slope) = one.net.iter().fold((0.0, 0.0), |sum, &(k, n)| {
                        (sum.0 + n * gibbs[k].0, sum.1 + n * gibbs[k].1)
                    });
                    // 1/K = exp(ΔG°/(R T) − Σν ln(p°/(R T)))
                    let inverse = temperature
                        .through(value - one.growth * standard, slope + one.growth / t)
                        .exp();
                    constant * inverse * product(orders, concentrations)
                }
                _ => N::constant(0.0),
            };
            visit(one, forth, back);
        }
    }
}

#[inline]
fn product<N: Number>(orders: &[(usize, f64)], concentrations: &[N; MOST_SPECIES]) -> N {
    orders.iter().fold(N::constant(1.0), |sum, &(k, n)| {
        sum * power(concentrations[k], n)
    })
}

/// c^n of a concentration in mol/m³, made regular where a reactant ends: below [`FLOOR`] (f),
///
/// - orders between 0 and 1 go on as the straight line c f^(n−1), whose slope is finite at zero;
/// - negative orders stay at f^n.
///
/// Both meet c^n at f, and their ratio in a reaction that goes both ways stays that of its equilibrium. Orders of 1 and
/// above need no floor: below zero, where the iterates of an integration may be, they are odd or zero.
#[inline]
fn power<N: Number>(c: N, n: f64) -> N {
    let x = c.value();
    if n == 1.0 {
        c
    } else if n == 0.0 {
        N::constant(1.0)
    } else if n == 2.0 {
        c.through(x * x.abs(), 2.0 * x.abs())
    } else if n > 1.0 {
        if x <= 0.0 {
            return N::constant(0.0);
        }
        let slope = x.powf(n - 1.0);
        c.through(x * slope, n * slope)
    } else if x >= FLOOR {
        let value = x.powf(n);
        c.through(value, n * value / x)
    } else if n > 0.0 {
        c.times(FLOOR.powf(n - 1.0))
    } else {
        N::constant(FLOOR.powf(n))
    }
}

#[cfg(test)]
mod tests;
