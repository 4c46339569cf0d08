//! The net flow through the film of a particle, which its reactions make and which acts on them (docs/theory.md, RXN-3).

use calcine_numerics::{Dual, Number};
use calcine_physics::film::{FilmCoefficient, StefanFlow, bernoulli};
use calcine_physics::gas::GAS_CONSTANT;
use calcine_physics::sphere;

use super::chemistry::SolidChemistry;
use super::passage::{FilmFlow, ParticleSurroundings};
use super::rates::{RateState, constants_of};
use super::surface::SurfaceBalance;

/// Most rounds by which the flow is found, and the change in a round, of the velocity over the largest coefficient of a
/// film and of the lightening, below which that change, taken to first order, ends it: Newton's method squares errors.
const ROUNDS: usize = 60;
const CLOSE: f64 = 1e-6;
/// Most halvings of a step in a row.
const MOST_HALVED: usize = 8;
/// Most doublings of a velocity by which one is found that carries away what reactions make, and halvings of what is left to its root.
const MOST_DOUBLED: usize = 60;
const BISECTIONS: usize = 12;
/// Largest velocity towards the particle over the smallest coefficient of a film: no more passes, however fast a solid takes up
/// a gas that is pure, in whose film nothing resists.
const MOST_INFLOW: f64 = 200.0;

/// Rates with the net flow through the film that they themselves make.
#[derive(Clone, Debug, Default)]
pub(super) struct FilmBalance {
    amounts: Vec<Dual<2>>,
    fractions: Vec<Dual<2>>,
    /// Rates of all reactions in mol/s at the point, with their slopes there.
    rates: Vec<Dual<2>>,
    /// Constants of the reactions at the particle's temperature.
    known: Vec<[f64; 2]>,
    /// Coefficients of the film at its temperature.
    film: Vec<FilmCoefficient>,
    /// The gas at the surface.
    surface: SurfaceBalance<Dual<2>>,
    /// Velocity in m/s and lightening about which rates are known.
    point: [f64; 2],
    /// Slopes of the residuals there, inverted.
    inverse: [[f64; 2]; 2],
}

impl FilmBalance {
    /// Forgets what was found before: results depend on nothing but the particle.
    pub fn begin(&mut self) {
        self.point = [0.0, 1.0];
        self.surface.begin();
    }

    /// The gas at the surface with it.
    pub fn surface(&self) -> &SurfaceBalance<Dual<2>> {
        &self.surface
    }

    /// The flow about which rates are known.
    pub fn point<N: Number>(&self) -> FilmFlow<N> {
        flow(self.point.map(N::constant))
    }

    /// Finds the flow that the reactions make by Newton's method, and the rates in mol/s with it.
    pub fn solve(
        &mut self,
        chemistry: &SolidChemistry,
        around: &ParticleSurroundings<'_>,
        state: &RateState<'_, f64>,
        out: &mut [f64],
    ) {
        let duals = |values: &[f64], duals: &mut Vec<Dual<2>>| {
            duals.clear();
            duals.extend(values.iter().map(|value| Dual::constant(*value)));
        };
        duals(state.amounts, &mut self.amounts);
        duals(state.fractions, &mut self.fractions);
        let none = Dual::constant(0.0);
        self.rates.resize(chemistry.reactions.len(), none);
        // The temperature stays as it is on the way.
        let known = chemistry.reactions.iter();
        self.known.clear();
        self.known
            .extend(known.map(|one| constants_of(one, state.temperature)));
        let at = around.film_temperature(state.temperature);
        let mut film = std::mem::take(&mut self.film);
        film.clear();
        let each = around.film.iter().map(|one| one.of(at));
        film.extend(each.map(FilmCoefficient::constant));
        let around = &ParticleSurroundings {
            film: &film,
            ..*around
        };
        self.solve_at(chemistry, around, state, out);
        self.film = film;
    }

    fn solve_at(
        &mut self,
        chemistry: &SolidChemistry,
        around: &ParticleSurroundings<'_>,
        state: &RateState<'_, f64>,
        out: &mut [f64],
    ) {
        let bounds = coefficients(around, state);
        let point = self.point;
        let mut residual = self.find(chemistry, around, state, (point, bounds));
        // Newton's method that is lost begins once more where what reactions make is carried away.
        if residual.is_none()
            && let Some(blown) = self.bracket(chemistry, around, state, bounds.1)
        {
            residual = self.find(chemistry, around, state, (blown, bounds));
        }
        let Some(residual) = residual else {
            self.begin();
            out.fill(f64::NAN);
            return;
        };
        for (out, rate) in out.iter_mut().zip(&self.rates) {
            *out = rate.value;
        }
        self.follow(residual.map(|one| one.value), out);
    }

    /// Newton's method from a velocity and a lightening on, with the smallest and largest coefficient of a film; the residuals where it
    /// ends.
    fn find(
        &mut self,
        chemistry: &SolidChemistry,
        around: &ParticleSurroundings<'_>,
        state: &RateState<'_, f64>,
        (mut next, (least, most)): ([f64; 2], (f64, f64)),
    ) -> Option<[Dual<2>; 2]> {
        let (mut before, mut last, mut halved) = (f64::INFINITY, None, 0);
        for left in (0..ROUNDS).rev() {
            let found = self.look(chemistry, around, state, next);
            let off = found[0].value.abs() / most + found[1].value.abs() / next[1];
            // A step too far is halved, as is one to where no state of the surface balances what reactions make.
            let too_far = off > before && off > CLOSE || !off.is_finite() && before.is_finite();
            if too_far && left > 0 && halved < MOST_HALVED {
                next = [0, 1].map(|k| 0.5 * (next[k] + self.point[k]));
                halved += 1;
                continue;
            }
            // Residuals that grow on the way to their root have no step downhill.
            if too_far {
                return None;
            }
            halved = 0;
            // What makes more gas the more there is has no end but with a flow that carries it away.
            if !off.is_finite() && left > 0 && next[0].is_finite() {
                next = [2.0 * next[0].min(-0.5 * most), 1.0];
                continue;
            }
            (self.point, before) = (next, off);
            self.invert(&found);
            let [faster, lighter] = self.change(found.map(|one| one.value));
            let far = faster.abs() / (most + next[0].abs()) + lighter.abs() / next[1];
            if far < CLOSE {
                return Some(found);
            }
            if !far.is_finite() {
                return None;
            }
            next = [
                (next[0] + faster).min(MOST_INFLOW * least),
                (next[1] + lighter).clamp(0.2 * next[1], 5.0 * next[1]),
            ];
            last = Some(found);
        }
        last.filter(|_| before < CLOSE.sqrt())
    }

    /// A velocity and a lightening near those at which a flow away from the particle carries off what reactions make, by bisection: the
    /// residual of the flow is below zero where it is faster than what is made. On its way it may grow, as where the pressure of a
    /// solid's decomposition is above that of the gas: the faster the flow, the less the film resists, up to what the interface makes.
    fn bracket(
        &mut self,
        chemistry: &SolidChemistry,
        around: &ParticleSurroundings<'_>,
        state: &RateState<'_, f64>,
        fastest: f64,
    ) -> Option<[f64; 2]> {
        let mut slow = [0.0, 1.0];
        let mut fast = [-fastest, 1.0];
        let mut rounds = 0..MOST_DOUBLED;
        loop {
            let too_slow = self.lighten(chemistry, around, state, &mut fast);
            if !too_slow {
                break;
            }
            rounds.next()?;
            slow = fast;
            fast = [2.0 * fast[0], fast[1]];
        }
        for _ in 0..BISECTIONS {
            let mut middle = [0, 1].map(|k| 0.5 * (slow[k] + fast[k]));
            match self.lighten(chemistry, around, state, &mut middle) {
                true => slow = middle,
                false => fast = middle,
            }
        }
        Some(fast)
    }

    /// Finds the lightening that goes with a velocity; whether reactions make more than it carries away.
    fn lighten(
        &mut self,
        chemistry: &SolidChemistry,
        around: &ParticleSurroundings<'_>,
        state: &RateState<'_, f64>,
        flow: &mut [f64; 2],
    ) -> bool {
        let mut made = f64::INFINITY;
        for _ in 0..ROUNDS {
            let found = self.look(chemistry, around, state, *flow);
            if !(found[0].value.is_finite() && found[1].value.is_finite()) {
                return true;
            }
            made = found[0].value;
            // Newton's method for the lightening over what the gas at the surface says of it, which rates of all but zero lightening have too.
            let (there, slope) = (flow[1] - found[1].value, 1.0 - found[1].slope[1]);
            let step = -found[1].value * there / (there - flow[1] * slope).max(f64::MIN_POSITIVE);
            if !step.is_finite() || step.abs() < CLOSE * flow[1] {
                break;
            }
            flow[1] = (flow[1] + step).clamp(0.2 * flow[1], 5.0 * flow[1]);
        }
        made > 0.0
    }

    /// Adds to rates at the point, in mol/s, what the rest of the way to the flow with their residuals does to them.
    pub fn follow<N: Number>(&self, residual: [N; 2], rates: &mut [N]) {
        let change = self.change(residual);
        for (rate, known) in rates.iter_mut().zip(&self.rates) {
            *rate = *rate + change[0].times(known.slope[0]) + change[1].times(known.slope[1]);
        }
    }

    /// Rates and residuals at a velocity and a lightening.
    fn look(
        &mut self,
        chemistry: &SolidChemistry,
        around: &ParticleSurroundings<'_>,
        state: &RateState<'_, f64>,
        [velocity, lightening]: [f64; 2],
    ) -> [Dual<2>; 2] {
        let state = RateState {
            amounts: &self.amounts,
            fractions: &self.fractions,
            temperature: Dual::constant(state.temperature),
            film_flow: flow([Dual::along(velocity, 0), Dual::along(lightening, 1)]),
            first: state.first,
            trace: state.trace,
            fastest: state.fastest,
            known: Some(&self.known),
        };
        chemistry.rates(around, &state, &mut self.surface, &mut self.rates);
        residual(chemistry, around, &state, &self.rates)
    }

    /// Takes up the slopes of residuals.
    fn invert(&mut self, [first, second]: &[Dual<2>; 2]) {
        let ([a, b], [c, d]) = (first.slope, second.slope);
        let one_over = 1.0 / (a * d - b * c);
        self.inverse = [[d * one_over, -b * one_over], [-c * one_over, a * one_over]];
    }

    /// By how much residuals say that the point is off.
    fn change<N: Number>(&self, residual: [N; 2]) -> [N; 2] {
        self.inverse
            .map(|row| -(residual[0].times(row[0]) + residual[1].times(row[1])))
    }
}

fn flow<N: Number>([velocity, lightening]: [N; 2]) -> FilmFlow<N> {
    FilmFlow {
        velocity,
        lightening,
    }
}

/// Smallest and largest coefficient in m/s of the film of any gas.
fn coefficients(around: &ParticleSurroundings<'_>, state: &RateState<'_, f64>) -> (f64, f64) {
    let radius = around.size.radius_of(state.amounts, around.radius);
    let film = around.film_temperature(state.temperature);
    let each = (0..around.film.len()).map(|k| around.coefficient(k, radius, film));
    each.fold((f64::INFINITY, 0.0), |(least, most), one| {
        (one.min(least), one.max(most))
    })
}

/// What is left of w − Ṅ/(c A) (of moles or of mass), and of m − Σ m X_surface, m X_surface = X_gas e^φ − N/(c A β⁻).
pub(super) fn residual<N: Number>(
    chemistry: &SolidChemistry,
    around: &ParticleSurroundings<'_>,
    state: &RateState<'_, N>,
    rates: &[N],
) -> [N; 2] {
    let FilmFlow {
        velocity,
        lightening,
    } = state.film_flow;
    let (zero, one) = (N::constant(0.0), N::constant(1.0));
    let Some(gas) = &chemistry.gas else {
        return [velocity, lightening - one];
    };
    let radius = around.size.radius_of(state.amounts, around.radius);
    let film = around.film_temperature(state.temperature);
    let area = sphere::surface_of(radius);
    // A/(c A) in m/mol… of a flow of one mole per second the velocity in m/s.
    let of_a_mole = (film / area).times(GAS_CONSTANT / around.pressure);
    let by_mass = around.theory.stefan_flow == StefanFlow::Mass;
    let molar = |k: usize| gas.species()[k].molar_mass();
    let mut made = zero;
    for (rate, reaction) in rates.iter().zip(&chemistry.reactions) {
        let weighed = reaction
            .gases
            .iter()
            .map(|&(g, n)| if by_mass { n * molar(g) } else { n });
        made = made + rate.times(weighed.sum());
    }
    if !by_mass {
        return [velocity + made * of_a_mole, lightening - one];
    }
    let mut mean = zero;
    let mut at_surface = zero;
    for (k, &fraction) in state.fractions.iter().enumerate() {
        mean = mean + fraction.times(molar(k));
        let coefficient = around.coefficient(k, radius, film);
        let number = velocity / coefficient;
        at_surface = at_surface + fraction * number.exp();
        let mut own = zero;
        for (rate, reaction) in rates.iter().zip(&chemistry.reactions) {
            let moles: f64 = reaction
                .gases
                .iter()
                .filter(|one| one.0 == k)
                .map(|one| one.1)
                .sum();
            if moles != 0.0 {
                own = own + rate.times(moles);
            }
        }
        at_surface = at_surface + own * of_a_mole / (coefficient * bernoulli(number));
    }
    [velocity + made * of_a_mole / mean, lightening - at_surface]
}
