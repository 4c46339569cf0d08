//! Rates of reactions in a shell, with their derivatives (docs/theory.md, XDP-9).

use calcine_numerics::Dual;
use calcine_physics::gas::GAS_CONSTANT;
use calcine_physics::pores::dusty_gas::MOST_GASES;
use calcine_physics::reaction::arrhenius::in_series;
use calcine_physics::reaction::equilibrium::STANDARD_PRESSURE;
use calcine_physics::reaction::{Arrhenius, Conversion, Equilibrium, PowerLaw, conversion};

use super::physics::RadialPhysics;
use super::side_by_side::{LANES, Wide};
use crate::reacting::{Rate, Reaction};

/// Share of the solids of a shell below which what a rate of an order below one uses counts as a trace, and what goes backwards
/// needs as much of its products: x (2 − x) of the rate, x in traces, as [`crate::reacting::rates::TRACE`].
pub(super) const TRACE: f64 = 1e-4;

/// Partial pressure in Pa of a gas below which a reaction that uses it and does not follow it ends: x (2 − x) of the rate, x in these.
const TRACE_PRESSURE: f64 = 1e-3;

/// The shells of a place in all lanes, as rates see them.
#[derive(Clone, Copy, Debug)]
pub(super) struct ShellState<'a> {
    /// Temperature in K.
    pub temperature: Wide,
    /// Partial pressures in Pa.
    pub pressures: &'a [Wide],
    /// Amounts of solids in mol, and those of a particle in which nothing has reacted.
    pub amounts: &'a [Wide],
    pub first: &'a [Wide],
    /// Volume in m³.
    pub volume: Wide,
}

/// A rate in mol/s and its derivatives.
#[derive(Clone, Debug, Default)]
pub(super) struct ShellRate {
    pub value: Wide,
    /// By temperature, partial pressures and amounts of solids.
    pub by_temperature: Wide,
    pub by_pressure: Vec<Wide>,
    pub by_amount: Vec<Wide>,
    /// Those by amounts where it goes backwards.
    by_amount_back: Vec<Wide>,
}

impl ShellRate {
    pub fn new(solids: usize, gases: usize) -> Self {
        Self {
            by_pressure: vec![Wide::default(); gases],
            by_amount: vec![Wide::default(); solids],
            by_amount_back: vec![Wide::default(); solids],
            ..Self::default()
        }
    }
}

/// A product of powers of concentrations with its derivatives.
struct GasPowers {
    value: Wide,
    by_temperature: Wide,
    by_pressure: [Wide; MOST_GASES],
}

/// c^n and its slope; nothing reacts of what is not there.
#[inline(always)]
fn power(c: Wide, order: f64) -> [Wide; 2] {
    if order == 1.0 {
        return [c, Wide::all(1.0)];
    }
    if order == 0.0 {
        return [Wide::all(1.0), Wide::default()];
    }
    let value = c.map(|c| if c == 0.0 { 0.0 } else { c.powf(order) });
    let slope = value * order / c;
    [value, c.if_positive(slope, Wide::default())]
}

impl GasPowers {
    /// Π c_g^n_g of c = p/(R T), each gas once.
    #[inline(always)]
    fn of(orders: &[(usize, f64)], state: &ShellState<'_>) -> Self {
        let over = state.temperature.inverse();
        let molar = over * (1.0 / GAS_CONSTANT);
        let mut made = Self {
            value: Wide::all(1.0),
            by_temperature: Wide::default(),
            by_pressure: [Wide::default(); MOST_GASES],
        };
        for (k, &(g, order)) in orders.iter().enumerate() {
            let [own, slope] = power(state.pressures[g].positive() * molar, order);
            made.value = made.value * own;
            let mut rest = slope * molar;
            for (other, &(g, order)) in orders.iter().enumerate() {
                if other != k {
                    rest = rest * power(state.pressures[g].positive() * molar, order)[0];
                }
            }
            made.by_pressure[g] += rest;
        }
        for &(g, _) in orders {
            made.by_temperature -= made.by_pressure[g] * state.pressures[g].positive() * over;
        }
        made
    }
}

/// k of one constant, or of two in series, with its slope.
#[inline(always)]
fn constant(first: &Arrhenius, second: Option<&Arrhenius>, temperature: Wide) -> [Wide; 2] {
    if second.is_none() {
        return first.lanes(temperature);
    }
    let mut all = [Wide::default(); 2];
    for lane in 0..LANES {
        let own = in_series(first, second, Dual::<1>::along(temperature[lane], 0));
        (all[0][lane], all[1][lane]) = (own.value, own.slope[0]);
    }
    all
}

impl RadialPhysics {
    /// The rates of a reaction in shells.
    #[inline(always)]
    pub fn rate(&self, index: usize, state: &ShellState<'_>, out: &mut ShellRate) {
        let reaction = &self.chemistry.reactions[index];
        let t = state.temperature;
        let ([k, k_slope], orders): ([Wide; 2], &[(usize, f64)]) = match &reaction.rate {
            Rate::Grains { rate_constant, .. } => {
                return self.grains(index, rate_constant.lanes(t), state, out);
            }
            Rate::Conversion {
                rate_constant,
                gases,
                ..
            } => (constant(rate_constant, None, t), gases),
            Rate::Power(law) => {
                let second = law.in_series.as_ref();
                (constant(&law.rate_constant, second, t), &law.gases)
            }
            Rate::Core { .. } | Rate::Evaporation(_) | Rate::Devolatilisation(_) => {
                (Default::default(), &[])
            }
        };
        let forth = GasPowers::of(orders, state);
        let mut drive = [forth.value, forth.by_temperature];
        let count = out.by_pressure.len();
        out.by_pressure.copy_from_slice(&forth.by_pressure[..count]);
        let reverse = reaction.equilibrium != Equilibrium::OneWay;
        if reverse {
            let [back, logarithmic] = reaction.equilibrium.inverse_lanes(t);
            let net = self.net_gas[index];
            let standard = (t * GAS_CONSTANT).inverse() * STANDARD_PRESSURE;
            let behind = GasPowers::of(&self.behind[index], state);
            let scale = match net {
                0.0 => back,
                1.0 => back / standard,
                -1.0 => back * standard,
                _ => back * standard.map(|c| c.powf(-net)),
            };
            let by_temperature = scale * (logarithmic + t.inverse() * net);
            drive[0] -= scale * behind.value;
            drive[1] -= by_temperature * behind.value + scale * behind.by_temperature;
            for (own, by) in out.by_pressure.iter_mut().zip(behind.by_pressure) {
                *own -= scale * by;
            }
        }
        for &g in &self.ends_with[index] {
            let one = Wide::all(1.0);
            let x = (state.pressures[g].positive() * (1.0 / TRACE_PRESSURE)).min(one);
            let rest = one - x;
            let there = x * (rest + 1.0);
            drive[1] = drive[1] * there;
            for by in &mut out.by_pressure {
                *by = *by * there;
            }
            out.by_pressure[g] += drive[0] * rest * (2.0 / TRACE_PRESSURE);
            drive[0] = drive[0] * there;
        }
        let backwards = reverse && drive[0].any(|drive| drive < 0.0);
        let solid = match &reaction.rate {
            Rate::Power(law) => self.power(reaction, law, state, (drive[0], backwards), out),
            Rate::Conversion { conversion, .. } => self.converted(
                (index, reaction),
                conversion,
                state,
                (drive[0], backwards),
                out,
            ),
            _ => Wide::default(),
        };
        out.value = k * solid * drive[0];
        out.by_temperature = solid * (k_slope * drive[0] + k * drive[1]);
        let (by_pressure, by_amount) = (k * solid, k * drive[0]);
        for by in &mut out.by_pressure {
            *by = *by * by_pressure;
        }
        for by in &mut out.by_amount {
            *by = *by * by_amount;
        }
    }

    /// k S (p_eq − p).
    #[inline(always)]
    fn grains(
        &self,
        index: usize,
        rate_constant: [Wide; 2],
        state: &ShellState<'_>,
        out: &mut ShellRate,
    ) {
        let reaction = &self.chemistry.reactions[index];
        out.by_pressure.fill(Wide::default());
        let (Rate::Grains { grains, .. }, [(gas, moles)]) = (&reaction.rate, &reaction.gases[..])
        else {
            return;
        };
        let solid = self.reactant[index];
        let [back, logarithmic] = reaction.equilibrium.inverse_lanes(state.temperature);
        let first = state.first[solid];
        let surface = (first * self.true_volume[solid]).map(|volume| grains.at_start(volume));
        // K = (p/p°)^ν.
        let at_rest = match *moles {
            1.0 => back.inverse(),
            moles => back.map(|back| back.powf(-1.0 / moles)),
        } * STANDARD_PRESSURE;
        let at_rest_slope = at_rest * logarithmic * (-1.0 / moles);
        let lacking = at_rest - state.pressures[*gas];
        let over = first.max(Wide::all(f64::MIN_POSITIVE)).inverse();
        let law = Conversion::ContractingVolume(conversion::ContractingVolume);
        let left = state.amounts[solid] * over;
        let mut share = Wide::default();
        out.by_amount.fill(Wide::default());
        for lane in 0..LANES {
            let [value, slope] = law.of(left[lane]);
            share[lane] = value / 3.0;
            out.by_amount[solid][lane] = slope / 3.0 * over[lane];
        }
        if lacking.any(|lacking| lacking < 0.0) {
            let there = self.products(reaction, state, &mut out.by_amount_back);
            let forth = Wide::default();
            share = lacking.if_below(forth, there, share);
            for (own, back) in out.by_amount.iter_mut().zip(&out.by_amount_back) {
                *own = lacking.if_below(forth, *back, *own);
            }
        }
        let [k, k_slope] = rate_constant.map(|own| own * surface);
        out.value = k * share * lacking;
        out.by_temperature = share * (k_slope * lacking + k * at_rest_slope);
        out.by_pressure[*gas] = -(k * share);
        for by in &mut out.by_amount {
            *by = *by * k * lacking;
        }
    }

    /// n₀ f(w) in mol; backwards n₀ as far as the products are there.
    #[inline(always)]
    fn converted(
        &self,
        (index, reaction): (usize, &Reaction),
        conversion: &Conversion,
        state: &ShellState<'_>,
        (drive, backwards): (Wide, bool),
        out: &mut ShellRate,
    ) -> Wide {
        let solid = self.reactant[index];
        let first = state.first[solid];
        out.by_amount.fill(Wide::default());
        let amount = state.amounts[solid];
        let [value, slope] = conversion.lanes(amount / first);
        // A solid that others make goes by what there is of it.
        let mut all = first.if_positive(first * value, amount);
        out.by_amount[solid] = first.if_positive(slope, Wide::all(1.0));
        if backwards {
            let there = self.products(reaction, state, &mut out.by_amount_back);
            let forth = Wide::default();
            all = drive.if_below(forth, first * there, all);
            for (own, back) in out.by_amount.iter_mut().zip(&out.by_amount_back) {
                *own = drive.if_below(forth, *back * first, *own);
            }
        }
        all
    }

    /// V Π c_s^m in mol, times what of the solids that are used is there.
    #[inline(always)]
    fn power(
        &self,
        reaction: &Reaction,
        law: &PowerLaw,
        state: &ShellState<'_>,
        (drive, backwards): (Wide, bool),
        out: &mut ShellRate,
    ) -> Wide {
        let order_in = |s: usize| {
            let found = law.solids.iter().find(|one| one.0 == s);
            found.map_or(0.0, |one| one.1)
        };
        let mut value = state.volume;
        let slopes = &mut out.by_amount;
        slopes.fill(Wide::default());
        // Of all factors so far times the next one; a factor that is zero keeps its slope.
        let mut take = |value: &mut Wide, s: usize, [factor, slope]: [Wide; 2]| {
            for other in slopes.iter_mut() {
                *other = *other * factor;
            }
            slopes[s] += *value * slope;
            *value = *value * factor;
        };
        let trace = trace(state);
        let is_used = |s: usize| reaction.solids.iter().any(|one| one.0 == s && one.1 < 0.0);
        let used = reaction.solids.iter().filter(|one| one.1 < 0.0);
        let others = law.solids.iter().filter(|one| !is_used(one.0));
        for &(s, _) in used.chain(others) {
            let (n, order) = (state.amounts[s], order_in(s));
            if order == 1.0 {
                let over = state.volume.inverse();
                take(&mut value, s, [n.positive() * over, over]);
                continue;
            }
            let mut factor = [Wide::default(); 2];
            for lane in 0..LANES {
                [factor[0][lane], factor[1][lane]] =
                    ends(n[lane], order, trace[lane], state.volume[lane]);
            }
            take(&mut value, s, factor);
        }
        if backwards {
            let by = &mut out.by_amount_back;
            let there = self.products(reaction, state, by);
            let forth = Wide::default();
            for (slope, by) in slopes.iter_mut().zip(by) {
                *slope = drive.if_below(forth, *slope * there + value * *by, *slope);
            }
            value = drive.if_below(forth, value * there, value);
        }
        value
    }

    /// How far the solids that a reaction makes are there, and its derivatives.
    #[inline(always)]
    fn products(&self, reaction: &Reaction, state: &ShellState<'_>, slopes: &mut [Wide]) -> Wide {
        let trace = trace(state);
        let mut all = Wide::all(1.0);
        slopes.fill(Wide::default());
        for &(s, _) in reaction.solids.iter().filter(|one| one.1 > 0.0) {
            let x = (state.amounts[s] / trace).positive().min(Wide::all(1.0));
            let rest = -x + 1.0;
            let [value, slope] = [x * (rest + 1.0), rest / trace * 2.0];
            for by in slopes.iter_mut() {
                *by = *by * value;
            }
            slopes[s] += all * slope;
            all = all * value;
        }
        all
    }
}

/// Amount in mol below which a solid counts as a trace.
#[inline(always)]
fn trace(state: &ShellState<'_>) -> Wide {
    let mut sum = Wide::default();
    for first in state.first {
        sum += *first;
    }
    sum * TRACE
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
