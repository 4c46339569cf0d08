//! What an outer loop does where, at the pace of momentum and continuity, it would not reach its tolerance within its iterations. An outer iteration
//! takes twice as many pressure corrections as the case asks for, and again. Where the residual grows, or the most of them do not suffice, its
//! iterations are accelerated ([`super::acceleration`]), which ends growth; and where it grows with acceleration and the most corrections, half as many
//! are the most from then on: on stretched tetrahedra long sequences diverge. On oblique lines, where friction is more than a cell's inertia and drag,
//! iterations begin with twice the case's corrections: two then multiply in each what the velocities of neighbours differ by, so much that no pace can be
//! judged.

use std::collections::VecDeque;

use calcine_coupler::setup::GasControls;

/// Outer iterations over which a pace is judged: the first after a change still has what was there before.
const PLAIN: usize = 3;
/// The same of accelerated iterations, whose residual does not fall in each.
const ACCELERATED: usize = 6;
/// An iteration that multiplies the residual by more than this is judged alone.
const RUNAWAY: f64 = 2.0;
/// By so much the share of what iterations change becomes smaller where the residual grew, and where it ends.
const DAMPED: f64 = 0.5;
const LEAST: f64 = 0.25;

/// Friction of a cell on oblique lines over its inertia and drag above which iterations begin with longer sequences: from there on two corrections take
/// more time than four in ducts with friction at walls, and from 17 on may diverge from rest (docs/verification.md).
const STIFF: f64 = 1.0;

/// What changes after an outer iteration.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PaceChange {
    /// Nothing.
    GoOn,
    /// Iterations are accelerated from the next one on.
    Accelerate,
    /// The number of pressure corrections.
    Corrections,
}

/// The number of corrections, and the pace at which they take the residual down.
#[derive(Clone, Debug)]
pub struct Pace {
    /// Pressure corrections of an outer iteration.
    pub corrections: u32,
    /// True where iterations are accelerated.
    pub accelerated: bool,
    /// Share of what an accelerated iteration changes that is taken.
    pub share: f64,
    fewest: u32,
    most: u32,
    /// The last residuals at this pace, oldest first.
    residuals: VecDeque<f64>,
}

impl Pace {
    /// The case's number of corrections, at the residual before the first outer iteration, and twice as many where the largest
    /// [`friction`](super::friction::largest_share) of a cell over its inertia and drag is above [`STIFF`].
    pub fn new(controls: &GasControls, residual: f64, friction: f64) -> Self {
        let corrections = controls.pressure_corrections.max(1);
        let most = controls.most_pressure_corrections.max(corrections);
        Self {
            corrections: match friction > STIFF {
                true => (2 * corrections).min(most),
                false => corrections,
            },
            accelerated: false,
            share: 1.0,
            fewest: corrections,
            most,
            residuals: VecDeque::from([residual]),
        }
    }

    /// Takes the case's number again, at a residual, where iterations failed: accelerated where those were not, with less of what changes where they were.
    pub fn go_back(&mut self, residual: f64) {
        self.corrections = self.fewest;
        self.most = self.fewest;
        let share = if self.accelerated { LEAST } else { DAMPED };
        self.accelerate(share, residual);
    }

    /// Takes up the residual after an outer iteration.
    pub fn judge(&mut self, controls: &GasControls, outer: u32, residual: f64) -> PaceChange {
        let last = self.residuals.back().copied().unwrap_or(residual);
        self.residuals.push_back(residual);
        // A residual that is NaN grew.
        let fell = residual < last;
        if self.accelerated && !fell {
            self.share = (DAMPED * self.share).max(LEAST);
        }
        let runs_away = residual.is_nan() || residual > RUNAWAY * last;
        if runs_away && !self.accelerated && outer > 1 {
            return self.accelerate(DAMPED, residual);
        }
        let judged = if self.accelerated { ACCELERATED } else { PLAIN };
        if self.residuals.len() <= judged {
            return PaceChange::GoOn;
        }
        let before = self.residuals.pop_front().unwrap_or(residual);
        let left = f64::from(controls.outer_iterations.saturating_sub(outer));
        let pace = (residual / before).powf(1.0 / judged as f64);
        let suffices =
            |iterations: f64| residual * pace.powf(iterations) <= controls.outer_tolerance;
        if suffices(left) {
            return PaceChange::GoOn;
        }
        let grew = residual.is_nan() || residual >= before;
        let last = self.corrections;
        if !self.accelerated && (grew || last == self.most) {
            return self.accelerate(if grew { DAMPED } else { 1.0 }, residual);
        }
        if last < self.most {
            self.corrections = (2 * last).min(self.most);
        } else if grew && self.most > self.fewest {
            self.most = (last / 2).max(self.fewest);
            self.corrections = self.most;
        } else {
            return PaceChange::GoOn;
        }
        self.residuals = VecDeque::from([residual]);
        PaceChange::Corrections
    }

    fn accelerate(&mut self, share: f64, residual: f64) -> PaceChange {
        self.accelerated = true;
        self.share = share;
        self.residuals = VecDeque::from([residual]);
        PaceChange::Accelerate
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn controls() -> GasControls {
        GasControls {
            outer_iterations: 20,
            convection: Default::default(),
            pressure_corrections: 2,
            time_scheme: Default::default(),
            most_pressure_corrections: 7,
            outer_tolerance: 1e-8,
            linear_tolerance: Some(1e-13),
        }
    }

    /// The pace after outer iterations that multiply the residual by a factor each.
    fn after(factor: f64, iterations: u32) -> Pace {
        let mut pace = Pace::new(&controls(), 1.0, 0.0);
        for outer in 1..=iterations {
            pace.judge(&controls(), outer, factor.powi(outer as i32));
        }
        pace
    }

    #[test]
    fn iterations_stay_as_they_are_where_the_pace_suffices() {
        // 20 iterations of 0.39 make 7e-9, and of 0.41 2e-8.
        let pace = after(0.39, 19);
        assert_eq!((pace.corrections, pace.accelerated), (2, false));
        assert_eq!([2, 3].map(|done| after(0.41, done).corrections), [2, 4]);
    }

    #[test]
    fn iterations_begin_with_longer_sequences_where_friction_rules() {
        let begun = [0.995, 1.005].map(|friction| Pace::new(&controls(), 1.0, friction));
        assert_eq!(begun.map(|pace| pace.corrections), [2, 4]);
        let mut alone = controls();
        alone.most_pressure_corrections = 2;
        assert_eq!(Pace::new(&alone, 1.0, 1.005).corrections, 2);
    }

    #[test]
    fn corrections_double_up_to_the_most_and_then_iterations_are_accelerated() {
        let paces = [2, 3, 6, 9, 20].map(|done| after(0.5, done));
        assert_eq!(
            paces.each_ref().map(|pace| pace.corrections),
            [2, 4, 7, 7, 7]
        );
        assert_eq!(
            paces.map(|pace| pace.accelerated),
            [false, false, false, true, true]
        );
    }

    #[test]
    fn iterations_are_accelerated_where_the_residual_grows() {
        let pace = after(1.5, 3);
        assert_eq!(
            (pace.corrections, pace.accelerated, pace.share),
            (2, true, 0.5)
        );
        assert_eq!(after(1.5, 4).share, 0.25);
    }

    #[test]
    fn corrections_halve_where_the_residual_grows_with_the_most() {
        let mut pace = Pace::new(&controls(), 1.0, 0.0);
        let mut changes = Vec::new();
        for outer in 1..60 {
            let last = pace.corrections;
            pace.judge(&controls(), outer, f64::from(outer) + 1.0);
            if pace.corrections != last {
                changes.push((outer, pace.corrections));
            }
        }
        assert_eq!(changes, [(9, 4), (15, 7), (21, 3), (27, 2)]);
        pace.go_back(1.0);
        assert_eq!((pace.corrections, pace.share), (2, 0.25));
    }
}
