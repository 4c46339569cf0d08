//! The gas at the surface of a particle whose reactions share it (docs/theory.md, RXN-3).

mod newton;

use calcine_numerics::{DenseMatrix, Number};

/// A part of the rate of a reaction, coefficient · Π c^n over gases at the surface.
#[derive(Clone, Copy, Debug)]
struct RateTerm<N> {
    /// Place of the reaction.
    reaction: usize,
    /// One forwards, minus one backwards; the coefficient in mol/s at 1 mol/m³ is not negative.
    sign: f64,
    coefficient: N,
    /// Its powers among all: where they begin and end.
    powers: (usize, usize),
}

/// A gas of which the film brings S − D c in mol/s.
#[derive(Clone, Copy, Debug)]
struct SurfaceGas<N> {
    conductance: N,
    supply: N,
}

/// Concentrations at the surface of a particle with which film and reactions are in balance,
///
/// D_i c_i + Σ_t |ν_ti| T_t (of what uses i) = S_i + Σ_t ν_ti T_t (of what makes i),   T_t = k_t Π c_i^n_ti,
///
/// and the rates there. All terms are positive, so that the logarithm of the ratio of both sides is nearly linear in
/// those of the concentrations, whatever the orders (of posynomials: Boyd et al. 2007, doi 10.1007/s11081-007-9001-7): Newton's method in
/// these finds them from far. Near the solution it goes on with concentrations and net rates together as unknowns, whose linear equations
/// lose no digits where forth and back of a reaction are far faster than the film, or where the film gives all it can.
///
/// A rate of order zero goes on as long as its gas is there: its factor is one down to a concentration that is round-off in the gas
/// beyond the film, and goes to zero with it.
#[derive(Clone, Debug)]
pub(super) struct SurfaceBalance<N> {
    gases: Vec<SurfaceGas<N>>,
    terms: Vec<RateTerm<N>>,
    /// Gas and order; of order zero as long as the gas is there.
    powers: Vec<(usize, f64)>,
    /// By which factor each reaction goes backwards.
    returning: Vec<N>,
    /// Gases that were taken to be above a concentration in mol/m³, or not.
    watched: Vec<(usize, f64, bool)>,
    /// Concentration of each gas in mol/m³ where it is there.
    x: Vec<f64>,
    /// Concentration in mol/m³ below which rates of order zero end.
    threshold: f64,
    state: SurfaceState,
    matrix: DenseMatrix,
    slopes: Vec<f64>,
    entries: Vec<f64>,
    right: Vec<f64>,
    solution: Vec<N>,
}

/// What follows from x.
#[derive(Clone, Debug, Default)]
struct SurfaceState {
    concentration: Vec<f64>,
    /// True of gases of which there is some, and of those that are found absent.
    there: Vec<bool>,
    absent: Vec<bool>,
    /// Values of terms in mol/s.
    terms: Vec<f64>,
    /// What is used and brought of each gas in mol/s.
    used: Vec<f64>,
    brought: Vec<f64>,
}

impl<N> Default for SurfaceBalance<N> {
    fn default() -> Self {
        Self {
            gases: Vec::new(),
            terms: Vec::new(),
            powers: Vec::new(),
            returning: Vec::new(),
            watched: Vec::new(),
            x: Vec::new(),
            threshold: 0.0,
            state: SurfaceState::default(),
            matrix: DenseMatrix::default(),
            slopes: Vec::new(),
            entries: Vec::new(),
            right: Vec::new(),
            solution: Vec::new(),
        }
    }
}

impl<N: Number> SurfaceBalance<N> {
    /// Forgets what was found before: results depend on nothing but the particle.
    pub fn begin(&mut self) {
        self.x.clear();
    }

    /// Begins with what another balance of the same gases found.
    pub fn begin_with<M>(&mut self, other: &SurfaceBalance<M>) {
        self.x.clone_from(&other.x);
        let found = &other.state.concentration;
        self.state.concentration.clone_from(found);
    }

    /// Empties the equations, of so many reactions.
    pub fn clear(&mut self, reactions: usize) {
        self.gases.clear();
        self.terms.clear();
        self.powers.clear();
        self.watched.clear();
        self.returning.clear();
        self.returning.resize(reactions, N::constant(1.0));
    }

    /// The next gas, of which the film brings supply − conductance · c in mol/s.
    pub fn gas(&mut self, conductance: N, supply: N) {
        self.gases.push(SurfaceGas {
            conductance,
            supply,
        });
    }

    /// A term of a reaction, by its coefficient in mol/s at 1 mol/m³, of either sign.
    pub fn term(
        &mut self,
        reaction: usize,
        coefficient: N,
        powers: impl IntoIterator<Item = (usize, f64)>,
    ) {
        let begin = self.powers.len();
        self.powers.extend(powers);
        let backwards = coefficient.value() < 0.0;
        self.terms.push(RateTerm {
            reaction,
            sign: if backwards { -1.0 } else { 1.0 },
            coefficient: if backwards { -coefficient } else { coefficient },
            powers: (begin, self.powers.len()),
        });
    }

    /// By which factor a reaction goes where it goes backwards.
    pub fn returns(&mut self, reaction: usize, factor: N) {
        self.returning[reaction] = factor;
    }

    /// Concentration at the surface in mol/m³ that was found last, if any was.
    pub fn found(&self, gas: usize) -> Option<f64> {
        let known = self.x.get(gas).is_some();
        known.then(|| self.state.concentration[gas])
    }

    /// What was told holds for a gas as far above or below a concentration as `taken`, both in mol/m³.
    pub fn watch(&mut self, gas: usize, concentration: f64, taken: f64) {
        self.watched
            .push((gas, concentration, taken > concentration));
    }

    /// True where the solution lies on the other side of what was watched.
    pub fn has_turned(&self) -> bool {
        let mut watched = self.watched.iter();
        watched.any(|&(gas, concentration, above)| {
            (self.state.concentration[gas] > concentration) != above
        })
    }

    /// Net rates in mol/s of all reactions, by the moles of the gases that each makes (+) or uses (−); not a number where no
    /// state of the surface balances what they make.
    pub fn solve(&mut self, moles: &[Vec<(usize, f64)>], out: impl FnMut(usize, N)) {
        // From the solution before, and else anew, at last with half steps, which end the cycles of whole ones.
        let mut found = false;
        let known = self.gases.iter().all(|gas| gas.supply.value().is_finite());
        for step in [1.0, 1.0, 0.5].into_iter().filter(|_| known) {
            self.start(moles);
            found = self.find(moles, step);
            if found {
                break;
            }
            self.x.clear();
        }
        self.follow(found, out);
    }

    /// Everything that follows from x; the sum of the logarithms by which gases are out of balance.
    fn evaluate(&mut self, moles: &[Vec<(usize, f64)>]) -> f64 {
        let state = &mut self.state;
        state.concentration.clone_from(&self.x);
        state.absent.clear();
        state.absent.resize(self.gases.len(), false);
        // What neither the film nor a reaction of what is there brings is not there; what reactions would bring and then hold
        // back is not either.
        for _ in 0..=self.gases.len() {
            self.find_there(moles);
            self.balance(moles);
            let state = &mut self.state;
            let mut all = true;
            for (k, there) in state.there.iter().enumerate() {
                if *there && state.brought[k] <= 0.0 {
                    state.absent[k] = true;
                    all = false;
                }
            }
            if all {
                break;
            }
        }
        let state = &self.state;
        let ratios = state.used.iter().zip(&state.brought).zip(&state.there);
        ratios
            .filter(|(_, there)| **there)
            .map(|((used, brought), _)| (used / brought).ln().abs())
            .sum()
    }

    /// Which gases are there, and the values of terms.
    fn find_there(&mut self, moles: &[Vec<(usize, f64)>]) {
        let state = &mut self.state;
        state.there.clear();
        let in_gas = self.gases.iter().map(|gas| gas.supply.value() > 0.0);
        state.there.extend(in_gas);
        loop {
            self.state.terms.clear();
            for place in 0..self.terms.len() {
                let value = self.value(place);
                self.state.terms.push(value);
            }
            self.hold_back();
            let (state, mut more) = (&mut self.state, false);
            for (term, value) in self.terms.iter().zip(&state.terms) {
                if *value > 0.0 {
                    for &(gas, n) in &moles[term.reaction] {
                        if n * term.sign > 0.0 && !state.there[gas] && !state.absent[gas] {
                            state.there[gas] = true;
                            more = true;
                        }
                    }
                }
            }
            if !more {
                break;
            }
        }
    }

    /// A term in mol/s, before it is held back.
    fn value(&self, place: usize) -> f64 {
        let term = &self.terms[place];
        let powers = &self.powers[term.powers.0..term.powers.1];
        let each = powers.iter().map(|&(gas, order)| self.factor(gas, order));
        each.fold(term.coefficient.value(), |product, one| product * one)
    }

    /// What a gas of an order does to a term.
    fn factor(&self, gas: usize, order: f64) -> f64 {
        let c = self.state.concentration[gas];
        match order {
            _ if !self.state.there[gas] => 0.0,
            0.0 => (c / self.threshold).min(1.0),
            1.0 => c,
            _ => c.powf(order),
        }
    }

    /// What is used and brought of each gas.
    fn balance(&mut self, moles: &[Vec<(usize, f64)>]) {
        let state = &mut self.state;
        state.used.clear();
        state.brought.clear();
        for (k, gas) in self.gases.iter().enumerate() {
            if !state.there[k] {
                state.concentration[k] = 0.0;
            }
            let passed = gas.conductance.value() * state.concentration[k];
            state.used.push(passed);
            state.brought.push(gas.supply.value());
        }
        for (term, value) in self.terms.iter().zip(&state.terms) {
            for &(gas, n) in &moles[term.reaction] {
                let made = n * term.sign * value;
                if made > 0.0 {
                    state.brought[gas] += made;
                } else {
                    state.used[gas] -= made;
                }
            }
        }
    }

    /// Reactions that go backwards do so by their own factors.
    fn hold_back(&mut self) {
        for (reaction, factor) in self.returning.iter().enumerate() {
            let factor = factor.value();
            if factor < 1.0 && self.goes_back(reaction) {
                for (term, value) in self.terms.iter().zip(&mut self.state.terms) {
                    if term.reaction == reaction {
                        *value *= factor;
                    }
                }
            }
        }
    }

    fn goes_back(&self, reaction: usize) -> bool {
        let terms = self.terms.iter().zip(&self.state.terms);
        let own = terms.filter(|(term, _)| term.reaction == reaction);
        own.map(|(term, value)| term.sign * value).sum::<f64>() < 0.0
    }
}
