//! How many pressure corrections an outer iteration takes: the case's, and twice as many, and again, where at the pace of
//! momentum and continuity the outer loop would not reach its tolerance within its iterations. Where the residual grows with two such longer
//! sequences, one after the other, the case's number is taken again, from what was there before them: on stretched tetrahedra they diverge.

use std::collections::VecDeque;

use calcine_coupler::setup::GasControls;

/// Outer iterations over which a pace is judged: the first after a change still has what was there before.
const JUDGED: usize = 3;

/// What comes of a judgement.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Judgement {
    /// The same number of corrections.
    Same,
    /// More than before.
    More,
    /// The case's again, for good.
    Back,
}

/// The number of corrections, and the pace at which they take the residual down.
#[derive(Clone, Debug)]
pub struct Pace {
    /// Pressure corrections of an outer iteration.
    pub corrections: u32,
    fewest: u32,
    most: u32,
    /// Longer sequences in a row with which the residual grew.
    grew: u32,
    /// The last residuals with this number of corrections, oldest first.
    residuals: VecDeque<f64>,
}

impl Pace {
    /// The case's number of corrections, at the residual before the first outer iteration.
    pub fn new(controls: &GasControls, residual: f64) -> Self {
        let corrections = controls.pressure_corrections.max(1);
        Self {
            corrections,
            fewest: corrections,
            grew: 0,
            most: controls.most_pressure_corrections.max(corrections),
            residuals: VecDeque::from([residual]),
        }
    }

    /// True where there are more corrections than the case's.
    pub fn is_longer(&self) -> bool {
        self.corrections > self.fewest
    }

    /// Takes the case's number again, at a residual.
    pub fn go_back(&mut self, residual: f64) {
        self.corrections = self.fewest;
        self.most = self.fewest;
        self.residuals = VecDeque::from([residual]);
    }

    /// Takes up the residual after an outer iteration.
    pub fn judge(&mut self, controls: &GasControls, outer: u32, residual: f64) -> Judgement {
        self.residuals.push_back(residual);
        if self.residuals.len() <= JUDGED || self.most == self.fewest {
            return Judgement::Same;
        }
        let before = self.residuals.pop_front().unwrap_or(residual);
        if self.is_longer() {
            // A residual that is NaN grew.
            let fell = residual < before;
            self.grew = if fell { 0 } else { self.grew + 1 };
            if self.grew > 1 || (self.grew > 0 && self.corrections == self.most) {
                return Judgement::Back;
            }
        }
        if self.corrections == self.most {
            return Judgement::Same;
        }
        let left = controls.outer_iterations.saturating_sub(outer);
        let pace = (residual / before).powf(1.0 / JUDGED as f64);
        let expected = residual * pace.powf(f64::from(left));
        if expected > controls.outer_tolerance {
            self.corrections = (2 * self.corrections).min(self.most);
            self.residuals = VecDeque::from([residual]);
            return Judgement::More;
        }
        Judgement::Same
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

    /// Corrections after outer iterations that multiply the residual by a factor each.
    fn after(factor: f64, iterations: u32) -> u32 {
        let mut pace = Pace::new(&controls(), 1.0);
        for outer in 1..=iterations {
            pace.judge(&controls(), outer, factor.powi(outer as i32));
        }
        pace.corrections
    }

    #[test]
    fn corrections_stay_where_the_pace_suffices() {
        // 20 iterations of 0.39 make 7e-9.
        assert_eq!(after(0.39, 19), 2);
    }

    #[test]
    fn the_case_s_number_counts_again_where_the_residual_grows_with_two_longer_sequences() {
        let mut pace = Pace::new(&controls(), 1.0);
        let residuals = [0.9, 0.8, 0.7, 0.8, 0.9, 1.0, 2.0, 3.0, 4.0];
        let found: Vec<_> = (1..)
            .zip(residuals)
            .map(|(outer, residual)| pace.judge(&controls(), outer, residual))
            .collect();
        assert_eq!(found[2], Judgement::More);
        assert_eq!(found[5], Judgement::More);
        assert_eq!(found[8], Judgement::Back);
        assert_eq!(pace.corrections, 7);
        pace.go_back(0.7);
        assert_eq!(pace.corrections, 2);
        let later: Vec<_> = (10..16)
            .map(|outer| pace.judge(&controls(), outer, 0.7))
            .collect();
        assert!(later.iter().all(|one| *one == Judgement::Same));
    }

    #[test]
    fn corrections_double_up_to_the_most_where_it_does_not() {
        assert_eq!([2, 3, 6, 9].map(|done| after(0.5, done)), [2, 4, 7, 7]);
        assert_eq!(after(1.5, 6), 7);
    }
}
