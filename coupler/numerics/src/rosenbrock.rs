//! Stiff systems of ordinary differential equations.

mod outcome;
mod tableau;

pub use outcome::{
    IntegrationAccuracy, IntegrationStalled, IntegrationStatistics, MOST_STEPS, StallCause,
};
pub use tableau::RosenbrockTableau;

use crate::linear::LinearAlgebra;

/// Safety factor of a new step, and its bounds relative to the step before.
const SAFETY: f64 = 0.9;
const SHRINK: f64 = 0.1;
const GROW: f64 = 6.0;
/// How much a first step, which is a guess, may shrink at once.
const FIRST_SHRINK: f64 = 1e-3;
/// Error, as a share of the tolerance, with which a step of the quick method over a whole span is taken.
const QUICK: f64 = 0.1;

/// An autonomous stiff system: unknowns y with y' = f(y; p), and integrals z' = g(y; p) that no rate depends on (they
/// cost no linear algebra). The parameters p are those by which the tangent is taken.
pub trait StiffSystem {
    /// Number of unknowns.
    fn unknowns(&self) -> usize;

    /// Number of integrals.
    fn integrals(&self) -> usize {
        0
    }

    /// Number of parameters of the tangent.
    fn parameters(&self) -> usize {
        0
    }

    /// True where the direct effect of the parameters on the integrals is wanted ([`Rosenbrock::direct`]).
    fn direct(&self) -> bool {
        false
    }

    /// True where the tangent is wanted ([`Rosenbrock::tangent`]); it is zero elsewhere.
    fn follows_tangent(&self) -> bool {
        true
    }

    /// f, then g, at the unknowns y.
    fn rates(&mut self, y: &[f64], out: &mut [f64]);

    /// f, then g, and their derivatives at the unknowns y. SystemDerivatives come filled with zeros.
    fn differentiate(&mut self, y: &[f64], out: &mut [f64], derivatives: &mut SystemDerivatives);

    /// Share of a step that stays within what the unknowns can be, with a tolerance of the system's own; a step of
    /// less than one is repeated with that share of its length. Amounts that would become negative are the use of it.
    fn admissible(&self, _from: &[f64], _to: &[f64]) -> f64 {
        1.0
    }

    /// Longest first step in s, from the unknowns y with their rates: where these bend so soon that a step beyond it would
    /// see neither the bend nor its own error.
    fn first_step(&self, _y: &[f64], _rates: &[f64]) -> f64 {
        f64::INFINITY
    }

    /// Puts right what an accepted step left outside by less than the tolerance of [`StiffSystem::admissible`], in a way
    /// that conserves what it has to: unknowns, integrals, and their derivatives by each parameter likewise (unknowns,
    /// then integrals, in slices of that length).
    fn correct(&mut self, _y: &mut [f64], _integrals: &mut [f64], _tangent: &mut [f64]) {}
}

/// SystemDerivatives of a system's rates.
#[derive(Clone, Debug, Default)]
pub struct SystemDerivatives {
    /// ∂f/∂y in the order of the linear algebra; row by row for [`crate::DenseMatrix`].
    pub jacobian: Vec<f64>,
    /// ∂g/∂y, row by row.
    pub integrals: Vec<f64>,
    /// ∂f/∂p, then ∂g/∂p, parameter by parameter.
    pub parameters: Vec<f64>,
}

/// A Rosenbrock method with an embedded error estimate and control of its step, for systems of one linear algebra.
///
/// With h the step, J = ∂f/∂y at its start and γ, a, c, m, e of the [`RosenbrockTableau`], the stages u_i solve
///
/// (1/(γ h) I − J) u_i = f(y + Σ_j a_ij u_j) + Σ_j c_ij u_j/h,   y ← y + Σ_i m_i u_i,   error = Σ_i e_i u_i,
///
/// with one factorisation a step and no iteration. Linear invariants of f are kept to round-off.
///
/// *Tangent.* s = ∂y/∂p follows s' = J s + ∂f/∂p by the same stages and factors, with J and ∂f/∂p of the start of
/// each step: exact for systems that are linear within a step, else to first order in the step. It keeps the
/// linear invariants too: what is used up to its end by then has no slope.
///
/// *Positivity* is not a property of the method. A step that ends outside of what the system allows by more than a
/// tolerance is repeated with a smaller one ([`StiffSystem::admissible`]); what is left within the tolerance the system
/// corrects in a way that conserves what it has to ([`StiffSystem::correct`]). Nothing is clipped.
///
/// *Steps.* The first is the whole span, or what the system says ([`StiffSystem::first_step`]); then Gustafsson's predictive control.
/// Where the first step is the whole span, a method of fewer stages may try it before ([`Rosenbrock::quickly`]).
///
/// Sources: Hairer and Wanner, Solving Ordinary Differential Equations II, 2nd ed. (1996), sections IV.7 and IV.8,
/// doi 10.1007/978-3-642-05221-7; Gustafsson, ACM Trans. Math. Softw. 20 (1994) 496, doi 10.1145/198429.198437.
#[derive(Clone, Debug)]
pub struct Rosenbrock<L> {
    tableau: &'static RosenbrockTableau,
    /// The method that tries a whole span in one step before.
    quick: Option<&'static RosenbrockTableau>,
    algebra: L,
    derivatives: SystemDerivatives,
    width: usize,
    unknowns: usize,
    /// Rates at the start of a step, and at a stage.
    start: Vec<f64>,
    rates: Vec<f64>,
    /// Stages of the step, one after the other, and of the tangent.
    stages: Vec<f64>,
    tangent_stages: Vec<f64>,
    /// Unknowns of a stage.
    place: Vec<f64>,
    next: Vec<f64>,
    integrals: Vec<f64>,
    /// ∂y/∂p and ∂z/∂p, parameter by parameter.
    tangent: Vec<f64>,
    /// ∫ ∂g/∂p dτ, parameter by parameter.
    direct: Vec<f64>,
    /// Length of the first accepted step of the last integration in s.
    first_step: f64,
}

impl<L: LinearAlgebra> Rosenbrock<L> {
    /// A method with its linear algebra.
    pub fn new(tableau: &'static RosenbrockTableau, algebra: L) -> Self {
        Self {
            tableau,
            quick: None,
            algebra,
            derivatives: SystemDerivatives::default(),
            width: 0,
            unknowns: 0,
            start: Vec::new(),
            rates: Vec::new(),
            stages: Vec::new(),
            tangent_stages: Vec::new(),
            place: Vec::new(),
            next: Vec::new(),
            integrals: Vec::new(),
            tangent: Vec::new(),
            direct: Vec::new(),
            first_step: 0.0,
        }
    }

    /// The same, with another method of no more stages that tries to take each span in one step, and does where its error is far
    /// below what is tolerated.
    pub fn quickly(mut self, quick: &'static RosenbrockTableau) -> Self {
        debug_assert!(quick.stages <= self.tableau.stages);
        self.quick = Some(quick);
        self
    }

    /// The linear algebra, to change its order between integrations.
    pub fn algebra(&mut self) -> &mut L {
        &mut self.algebra
    }

    /// Values of the integrals at the end of the last integration.
    pub fn integrals(&self) -> &[f64] {
        &self.integrals
    }

    /// Length of the first accepted step of the last integration in s: where a like one may begin
    /// ([`StiffSystem::first_step`]).
    pub fn first_step(&self) -> f64 {
        self.first_step
    }

    /// SystemDerivatives by a parameter of the unknowns, then the integrals, at the end of the last integration.
    pub fn tangent(&self, parameter: usize) -> &[f64] {
        &self.tangent[parameter * self.width..(parameter + 1) * self.width]
    }

    /// What a parameter does to the integrals with the unknowns as they went, ∫ ∂g/∂p dτ over the last integration by
    /// the trapezoidal rule: the tangent without the response of the unknowns. For systems that ask for it
    /// ([`StiffSystem::direct`]).
    pub fn direct(&self, parameter: usize) -> &[f64] {
        let integrals = self.width - self.unknowns;
        &self.direct[parameter * integrals..(parameter + 1) * integrals]
    }

    /// Advances the unknowns over a span in s. In error they are where the integration came to.
    pub fn integrate<S: StiffSystem>(
        &mut self,
        system: &mut S,
        y: &mut [f64],
        span: f64,
        accuracy: IntegrationAccuracy<'_>,
    ) -> Result<IntegrationStatistics, IntegrationStalled> {
        self.resize(system);
        let mut done = IntegrationStatistics::default();
        let (mut time, mut step) = (0.0, span);
        let mut worst = 0;
        // Length and error of the last accepted step.
        let mut before: Option<(f64, f64)> = None;
        let order = f64::from(self.tableau.error_order);
        let fail = |reached, cause, worst| IntegrationStalled {
            reached,
            span,
            cause,
            worst,
        };
        self.differentiate(system, y)
            .map_err(|worst| fail(time, StallCause::NotFinite, worst))?;
        step = step.min(system.first_step(y, &self.start));
        let mut quick = self.quick.filter(|_| step >= span);
        let mut last_rejected = false;
        while done.steps + done.rejected < accuracy.steps {
            let left = span - time;
            let ends = step >= 0.999 * left;
            step = if ends { left } else { step };
            let tableau = quick.unwrap_or(self.tableau);
            let evaluations = &mut done.evaluations;
            let (error, place) = self.attempt(system, y, (step, tableau), accuracy, evaluations);
            let inside = if error <= 1.0 {
                system.admissible(y, &self.next[..self.unknowns])
            } else {
                1.0
            };
            if quick.take().is_some() && !(error <= QUICK && inside >= 1.0) {
                continue;
            }
            worst = place;
            let mut factor = SAFETY * error.max(1e-10).powf(-1.0 / order);
            if error <= 1.0 && inside >= 1.0 {
                if system.follows_tangent() {
                    self.follow_tangent(system.parameters(), (step, tableau));
                }
                if done.steps == 0 {
                    self.first_step = step;
                }
                y.copy_from_slice(&self.next[..self.unknowns]);
                let gains = self.next[self.unknowns..].iter();
                for (z, gain) in self.integrals.iter_mut().zip(gains) {
                    *z += gain;
                }
                system.correct(y, &mut self.integrals, &mut self.tangent);
                let direct = system.direct();
                if direct {
                    self.add_direct(step);
                }
                time += step;
                done.steps += 1;
                if ends && !direct {
                    return Ok(done);
                }
                self.differentiate(system, y)
                    .map_err(|worst| fail(time, StallCause::NotFinite, worst))?;
                if direct {
                    self.add_direct(step);
                }
                if ends {
                    return Ok(done);
                }
                if let Some((length, old)) = before {
                    let now: f64 = error.max(1e-10);
                    let predicted = (old / (now * now)).powf(1.0 / order) * step / length;
                    factor = factor.min(SAFETY * predicted);
                }
                before = Some((step, error.max(1e-2)));
                let most = if last_rejected { 1.0 } else { GROW };
                step *= factor.clamp(SHRINK, most);
                last_rejected = false;
            } else {
                done.rejected += 1;
                last_rejected = true;
                let least = if before.is_none() {
                    FIRST_SHRINK
                } else {
                    SHRINK
                };
                step *= if error <= 1.0 {
                    inside.max(SHRINK)
                } else if error.is_finite() {
                    factor.clamp(least, 0.9)
                } else {
                    SHRINK
                };
                if time + step <= time {
                    return Err(fail(time, StallCause::Step, worst));
                }
            }
        }
        Err(fail(time, StallCause::Steps(accuracy.steps), worst))
    }

    fn resize(&mut self, system: &impl StiffSystem) {
        let (n, m, p) = (system.unknowns(), system.integrals(), system.parameters());
        (self.unknowns, self.width) = (n, n + m);
        let stages = self.tableau.stages;
        let d = &mut self.derivatives;
        d.jacobian.resize(self.algebra.entries(), 0.0);
        d.integrals.resize(m * n, 0.0);
        d.parameters.resize(p * self.width, 0.0);
        for list in [&mut self.start, &mut self.rates, &mut self.next] {
            list.resize(self.width, 0.0);
        }
        self.place.resize(n, 0.0);
        self.stages.resize(stages * self.width, 0.0);
        self.tangent_stages.resize(stages * self.width, 0.0);
        self.integrals.clear();
        self.integrals.resize(m, 0.0);
        self.tangent.clear();
        self.tangent.resize(p * self.width, 0.0);
        self.direct.clear();
        self.direct.resize(p * m, 0.0);
    }

    /// Rates and derivatives at y; the index of a value that is not finite as an error.
    fn differentiate<S: StiffSystem>(&mut self, system: &mut S, y: &[f64]) -> Result<(), usize> {
        let d = &mut self.derivatives;
        for list in [&mut d.jacobian, &mut d.integrals, &mut d.parameters] {
            list.fill(0.0);
        }
        system.differentiate(y, &mut self.start, d);
        match self.start.iter().position(|rate| !rate.is_finite()) {
            Some(place) => Err(place),
            None => Ok(()),
        }
    }

    /// One step from y to `next`; its error relative to what is tolerated, and where that is.
    fn attempt<S: StiffSystem>(
        &mut self,
        system: &mut S,
        y: &[f64],
        (step, tableau): (f64, &RosenbrockTableau),
        accuracy: IntegrationAccuracy<'_>,
        evaluations: &mut usize,
    ) -> (f64, usize) {
        let (n, width) = (self.unknowns, self.width);
        let (scaled, inverse) = (tableau.gamma * step, 1.0 / step);
        if !self
            .algebra
            .factorise(1.0 / scaled, &self.derivatives.jacobian)
        {
            return (f64::INFINITY, 0);
        }
        self.rates.copy_from_slice(&self.start);
        for i in 0..tableau.stages {
            let (known, own) = self.stages.split_at_mut(i * width);
            let own = &mut own[..width];
            if i > 0 && tableau.fresh[i] {
                self.place.copy_from_slice(y);
                for (stage, a) in known.chunks_exact(width).zip(&tableau.a[i]) {
                    add(&mut self.place, *a, stage);
                }
                system.rates(&self.place, &mut self.rates);
                *evaluations += 1;
            }
            own.copy_from_slice(&self.rates);
            for (stage, c) in known.chunks_exact(width).zip(&tableau.c[i]) {
                add(own, c * inverse, stage);
            }
            let (unknown, integral) = own.split_at_mut(n);
            self.algebra.solve(unknown);
            for (value, line) in integral
                .iter_mut()
                .zip(self.derivatives.integrals.chunks_exact(n))
            {
                *value = scaled * (*value + dot(line, unknown));
            }
        }
        self.next[..n].copy_from_slice(y);
        self.next[n..].fill(0.0);
        for (stage, m) in self.stages.chunks_exact(width).zip(&tableau.m) {
            add(&mut self.next, *m, stage);
        }
        self.error(y, &tableau.e, accuracy)
    }

    fn error(
        &mut self,
        y: &[f64],
        weights: &[f64],
        accuracy: IntegrationAccuracy<'_>,
    ) -> (f64, usize) {
        let (n, width) = (self.unknowns, self.width);
        let errors = &mut self.rates;
        errors.fill(0.0);
        for (stage, e) in self.stages.chunks_exact(width).zip(weights) {
            add(errors, *e, stage);
        }
        let (mut most, mut place) = (0.0, 0);
        for (k, error) in errors.iter().enumerate() {
            let before = if k < n { y[k] } else { self.integrals[k - n] };
            let size = if k < n {
                before.abs().max(self.next[k].abs())
            } else {
                before.abs().max((before + self.next[k]).abs())
            };
            let share = error.abs() / (accuracy.absolute[k] + accuracy.relative * size);
            if !share.is_finite() || !self.next[k].is_finite() {
                return (f64::INFINITY, k);
            }
            if share > most {
                (most, place) = (share, k);
            }
        }
        (most, place)
    }

    /// Adds one end of a step to the direct effects of the parameters.
    fn add_direct(&mut self, step: f64) {
        let integrals = self.width - self.unknowns;
        if integrals == 0 {
            return;
        }
        let columns = self.derivatives.parameters.chunks_exact(self.width);
        for (sums, column) in self.direct.chunks_exact_mut(integrals).zip(columns) {
            add(sums, 0.5 * step, &column[self.unknowns..]);
        }
    }

    /// Moves the tangents over the step that was just accepted.
    fn follow_tangent(&mut self, parameters: usize, (step, tableau): (f64, &RosenbrockTableau)) {
        let (n, width) = (self.unknowns, self.width);
        let (scaled, inverse) = (tableau.gamma * step, 1.0 / step);
        for p in 0..parameters {
            let slope = &mut self.tangent[p * width..(p + 1) * width];
            let source = &self.derivatives.parameters[p * width..(p + 1) * width];
            for i in 0..tableau.stages {
                let (known, own) = self.tangent_stages.split_at_mut(i * width);
                let own = &mut own[..width];
                if i == 0 || tableau.fresh[i] {
                    self.place.copy_from_slice(&slope[..n]);
                    for (stage, a) in known.chunks_exact(width).zip(&tableau.a[i]) {
                        add(&mut self.place, *a, stage);
                    }
                }
                // (1/(γh) I − J) v = J w + b is (1/(γh) I − J)(v + w) = w/(γh) + b.
                own.copy_from_slice(source);
                for (stage, c) in known.chunks_exact(width).zip(&tableau.c[i]) {
                    add(own, c * inverse, stage);
                }
                let (unknown, integral) = own.split_at_mut(n);
                add(unknown, 1.0 / scaled, &self.place);
                self.algebra.solve(unknown);
                for (value, line) in integral
                    .iter_mut()
                    .zip(self.derivatives.integrals.chunks_exact(n))
                {
                    *value = scaled * (*value + dot(line, unknown));
                }
                add(unknown, -1.0, &self.place);
            }
            for (stage, m) in self.tangent_stages.chunks_exact(width).zip(&tableau.m) {
                add(slope, *m, stage);
            }
        }
    }
}

/// out + a x, over the shorter of the two.
#[inline]
fn add(out: &mut [f64], a: f64, x: &[f64]) {
    if a != 0.0 {
        for (value, x) in out.iter_mut().zip(x) {
            *value += a * x;
        }
    }
}

#[inline]
fn dot(a: &[f64], x: &[f64]) -> f64 {
    a.iter().zip(x).map(|(a, x)| a * x).sum()
}

#[cfg(test)]
pub(crate) mod tests;
