//! Rates of reactions in a shell, with their derivatives (docs/theory.md, XDP-9).

use calcine_numerics::{Dual, Number};
use calcine_physics::gas::GAS_CONSTANT;
use calcine_physics::reaction::equilibrium::STANDARD_PRESSURE;
use calcine_physics::reaction::{Conversion, PowerLaw, conversion};

use super::physics::{MOST_SOLIDS, RadialPhysics};
use crate::reacting::{Rate, Reaction};

/// Share of the solids of a shell below which what a rate of an order below one uses counts as a trace, and what goes backwards
/// needs as much of its products: x (2 − x) of the rate, x in traces, as [`crate::reacting::rates::TRACE`].
pub(super) const TRACE: f64 = 1e-4;

/// A shell, as rates see it.
#[derive(Clone, Copy, Debug)]
pub(super) struct ShellState<'a> {
    /// Temperature in K.
    pub temperature: f64,
    /// Partial pressures in Pa.
    pub pressures: &'a [f64],
    /// Amounts of solids in mol, and those of a particle in which nothing has reacted.
    pub amounts: &'a [f64],
    pub first: &'a [f64],
    /// Volume in m³.
    pub volume: f64,
}

/// A rate in mol/s and its derivatives.
#[derive(Clone, Debug, Default)]
pub(super) struct ShellRate {
    pub value: f64,
    /// By temperature, partial pressures and amounts of solids.
    pub by_temperature: f64,
    pub by_pressure: Vec<f64>,
    pub by_amount: Vec<f64>,
}

/// A product of powers of concentrations with its derivatives.
struct GasPowers {
    value: f64,
    by_temperature: f64,
    by_pressure: [f64; calcine_physics::pores::dusty_gas::MOST_GASES],
}

impl GasPowers {
    /// Π c_g^n_g of c = p/(R T); nothing reacts of what is not there.
    fn of(orders: impl Iterator<Item = (usize, f64)> + Clone, state: &ShellState<'_>) -> Self {
        let molar = 1.0 / (GAS_CONSTANT * state.temperature);
        let mut made = Self {
            value: 1.0,
            by_temperature: 0.0,
            by_pressure: [0.0; calcine_physics::pores::dusty_gas::MOST_GASES],
        };
        let power = |g: usize, order: f64| {
            let c = state.pressures[g].max(0.0) * molar;
            if order == 0.0 {
                [1.0, 0.0]
            } else if order == 1.0 {
                [c, 1.0]
            } else if c == 0.0 {
                [0.0, 0.0]
            } else {
                let value = c.powf(order);
                [value, order * value / c]
            }
        };
        for (k, (g, order)) in orders.clone().enumerate() {
            made.value *= power(g, order)[0];
            let others = orders.clone().enumerate().filter(|(other, _)| *other != k);
            let rest: f64 = others.map(|(_, (g, order))| power(g, order)[0]).product();
            made.by_pressure[g] += rest * power(g, order)[1] * molar;
        }
        for (g, order) in orders {
            if order != 0.0 {
                made.by_temperature -=
                    made.by_pressure[g] * state.pressures[g].max(0.0) / state.temperature;
            }
        }
        made
    }
}

impl RadialPhysics {
    /// The rate of a reaction in a shell.
    pub fn rate(&self, index: usize, state: &ShellState<'_>, out: &mut ShellRate) {
        let reaction = &self.chemistry.reactions[index];
        out.by_pressure.clear();
        out.by_pressure.resize(self.gases(), 0.0);
        out.by_amount.clear();
        out.by_amount.resize(self.solids(), 0.0);
        let t = state.temperature;
        let back = reaction.equilibrium.inverse(Dual::<1>::along(t, 0));
        let (rate_constant, orders): (Dual<1>, &[(usize, f64)]) = match &reaction.rate {
            Rate::Grains { rate_constant, .. } => {
                return self.grains(
                    index,
                    (rate_constant.of(Dual::along(t, 0)), back),
                    state,
                    out,
                );
            }
            Rate::Conversion {
                rate_constant,
                gases,
                ..
            } => (rate_constant.of(Dual::along(t, 0)), gases),
            Rate::Power(law) => (
                law.without(
                    None,
                    Dual::along(t, 0),
                    |_| Dual::constant(1.0),
                    |_| Dual::constant(1.0),
                )
                .0,
                &law.gases,
            ),
            Rate::Core { .. } | Rate::Evaporation(_) | Rate::Devolatilisation(_) => {
                (Dual::constant(0.0), &[])
            }
        };
        let forth = GasPowers::of(orders.iter().copied(), state);
        let mut drive = [forth.value, forth.by_temperature];
        out.by_pressure[..].copy_from_slice(&forth.by_pressure[..self.gases()]);
        if back.value > 0.0 {
            let net = self.net_gas[index];
            let standard = STANDARD_PRESSURE / (GAS_CONSTANT * t);
            let both = orders.iter().copied().chain(reaction.gases.iter().copied());
            let gases = 0..self.gases();
            let sums = gases.filter_map(|g| {
                let order: f64 = both.clone().filter(|one| one.0 == g).map(|one| one.1).sum();
                (order != 0.0).then_some((g, order))
            });
            let behind = GasPowers::of(sums, state);
            let scale = back.value * standard.powf(-net);
            let by_temperature = scale * (back.slope[0] / back.value + net / t);
            drive[0] -= scale * behind.value;
            drive[1] -= by_temperature * behind.value + scale * behind.by_temperature;
            for (own, by) in out.by_pressure.iter_mut().zip(behind.by_pressure) {
                *own -= scale * by;
            }
        }
        let solid = match &reaction.rate {
            Rate::Power(law) => {
                self.power(reaction, law, state, drive[0] < 0.0, &mut out.by_amount)
            }
            Rate::Conversion { conversion, .. } => self.converted(
                (index, reaction),
                conversion,
                state,
                drive[0] < 0.0,
                &mut out.by_amount,
            ),
            _ => 0.0,
        };
        let [k, k_slope] = [rate_constant.value, rate_constant.slope[0]];
        out.value = k * solid * drive[0];
        out.by_temperature = solid * (k_slope * drive[0] + k * drive[1]);
        out.by_pressure.iter_mut().for_each(|by| *by *= k * solid);
        out.by_amount.iter_mut().for_each(|by| *by *= k * drive[0]);
    }

    /// k S (p_eq − p).
    fn grains(
        &self,
        index: usize,
        (rate_constant, back): (Dual<1>, Dual<1>),
        state: &ShellState<'_>,
        out: &mut ShellRate,
    ) {
        let reaction = &self.chemistry.reactions[index];
        let (Rate::Grains { grains, .. }, [(gas, moles)]) = (&reaction.rate, &reaction.gases[..])
        else {
            return;
        };
        let solid = self.reactant[index];
        let surface = grains.at_start(state.first[solid] * self.true_volume[solid]);
        // K = (p/p°)^ν.
        let at_rest = STANDARD_PRESSURE * back.value.powf(-1.0 / moles);
        let at_rest_slope = -at_rest / moles * back.slope[0] / back.value;
        let lacking = at_rest - state.pressures[*gas];
        let left = state.amounts[solid] / state.first[solid].max(f64::MIN_POSITIVE);
        let [share, by_left] = if lacking < 0.0 {
            [self.products(reaction, state, &mut out.by_amount), 0.0]
        } else {
            let [value, slope] =
                Conversion::ContractingVolume(conversion::ContractingVolume).of(left);
            [value / 3.0, slope / 3.0]
        };
        if lacking >= 0.0 {
            out.by_amount[solid] = by_left / state.first[solid].max(f64::MIN_POSITIVE);
        }
        let [k, k_slope] = [
            rate_constant.value * surface,
            rate_constant.slope[0] * surface,
        ];
        out.value = k * share * lacking;
        out.by_temperature = share * (k_slope * lacking + k * at_rest_slope);
        out.by_pressure[*gas] = -k * share;
        out.by_amount.iter_mut().for_each(|by| *by *= k * lacking);
    }

    /// n₀ f(w) in mol; backwards n₀ as far as the products are there.
    fn converted(
        &self,
        (index, reaction): (usize, &Reaction),
        conversion: &Conversion,
        state: &ShellState<'_>,
        backwards: bool,
        slopes: &mut [f64],
    ) -> f64 {
        let solid = self.reactant[index];
        let first = state.first[solid];
        if backwards {
            let there = self.products(reaction, state, slopes);
            slopes.iter_mut().for_each(|slope| *slope *= first);
            return first * there;
        }
        if first <= 0.0 {
            // A solid that others make goes by what there is of it.
            slopes[solid] = 1.0;
            return state.amounts[solid];
        }
        let [value, slope] = conversion.of(state.amounts[solid] / first);
        slopes[solid] = slope;
        first * value
    }

    /// V Π c_s^m in mol, times what of the solids that are used is there.
    fn power(
        &self,
        reaction: &Reaction,
        law: &PowerLaw,
        state: &ShellState<'_>,
        backwards: bool,
        slopes: &mut [f64],
    ) -> f64 {
        let trace = TRACE * state.first.iter().sum::<f64>();
        let order_in = |s: usize| {
            let found = law.solids.iter().find(|one| one.0 == s);
            found.map_or(0.0, |one| one.1)
        };
        let mut value = state.volume;
        let mut logarithms = [0.0; MOST_SOLIDS];
        let used = reaction
            .solids
            .iter()
            .filter(|one| one.1 < 0.0)
            .map(|one| one.0);
        let others = law.solids.iter().map(|one| one.0);
        let others =
            others.filter(|s| !reaction.solids.iter().any(|one| one.0 == *s && one.1 < 0.0));
        for s in used.chain(others) {
            let (n, order) = (state.amounts[s], order_in(s));
            let [factor, slope] = ends(n, order, trace, state.volume);
            value *= factor;
            if let Some(own) = logarithms.get_mut(s) {
                *own = if factor == 0.0 { 0.0 } else { slope / factor };
            }
        }
        for (slope, own) in slopes.iter_mut().zip(logarithms) {
            *slope = value * own;
        }
        if backwards {
            let mut by = [0.0; MOST_SOLIDS];
            let by = &mut by[..slopes.len()];
            let there = self.products(reaction, state, by);
            for (slope, by) in slopes.iter_mut().zip(&*by) {
                *slope = *slope * there + value * by;
            }
            value *= there;
        }
        value
    }

    /// How far the solids that a reaction makes are there, and its derivatives.
    fn products(&self, reaction: &Reaction, state: &ShellState<'_>, slopes: &mut [f64]) -> f64 {
        let trace = TRACE * state.first.iter().sum::<f64>();
        let mut all = 1.0;
        slopes.fill(0.0);
        for &(s, _) in reaction.solids.iter().filter(|one| one.1 > 0.0) {
            let x = (state.amounts[s] / trace).clamp(0.0, 1.0);
            let [value, slope] = [x * (2.0 - x), 2.0 * (1.0 - x) / trace];
            slopes.iter_mut().for_each(|by| *by *= value);
            slopes[s] += all * slope;
            all *= value;
        }
        all
    }
}

/// The factor of a solid in a power law of an order, (n/V)^m, and its slope; below a trace it ends where nothing is left.
fn ends(amount: f64, order: f64, trace: f64, volume: f64) -> [f64; 2] {
    if order == 1.0 {
        return [amount.max(0.0) / volume, 1.0 / volume];
    }
    if order > 1.0 && amount <= 0.0 {
        return [0.0, 0.0];
    }
    let at = if order > 1.0 {
        amount
    } else {
        amount.max(trace)
    };
    let power = (at / volume).powf(order);
    if at == amount {
        return [power, order * power / at];
    }
    let x = amount.max(0.0) / trace;
    let (steep, bend) = (2.0 - order, order - 1.0);
    [
        power * x * (steep + bend * x),
        power * (steep + 2.0 * bend * x) / trace,
    ]
}
