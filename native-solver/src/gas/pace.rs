//! How many pressure corrections an outer iteration takes: the case's, and twice as many, and again, where at the pace of
//! momentum and continuity the outer loop would not reach its tolerance within its iterations. Where the residual grows with the most, half as many
//! are the most from then on: on stretched tetrahedra long sequences diverge.

use std::collections::VecDeque;

use calcine_coupler::setup::GasControls;

/// Outer iterations over which a pace is judged: the first after a change still has what was there before.
const JUDGED: usize = 3;

/// The number of corrections, and the pace at which they take the residual down.
#[derive(Clone, Debug)]
pub struct Pace {
    /// Pressure corrections of an outer iteration.
    pub corrections: u32,
    fewest: u32,
    most: u32,
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
            most: controls.most_pressure_corrections.max(corrections),
            residuals: VecDeque::from([residual]),
        }
    }

    /// Takes the case's number again, at a residual.
    pub fn go_back(&mut self, residual: f64) {
        self.corrections = self.fewest;
        self.most = self.fewest;
        self.residuals = VecDeque::from([residual]);
    }

    /// Takes up the residual after an outer iteration; true where the number changes.
    pub fn judge(&mut self, controls: &GasControls, outer: u32, residual: f64) -> bool {
        self.residuals.push_back(residual);
        if self.residuals.len() <= JUDGED || self.most == self.fewest {
            return false;
        }
        let before = self.residuals.pop_front().unwrap_or(residual);
        let last = self.corrections;
        if last == self.most {
            // A residual that is NaN grew.
            let fell = residual < before;
            if !fell {
                self.most = (last / 2).max(self.fewest);
                self.corrections = self.most;
            }
        } else {
            let left = controls.outer_iterations.saturating_sub(outer);
            let pace = (residual / before).powf(1.0 / JUDGED as f64);
            let expected = residual * pace.powf(f64::from(left));
            if expected > controls.outer_tolerance {
                self.corrections = (2 * last).min(self.most);
            }
        }
        let changed = self.corrections != last;
        if changed {
            self.residuals = VecDeque::from([residual]);
        }
        changed
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
    fn corrections_halve_where_the_residual_grows_with_the_most() {
        let mut pace = Pace::new(&controls(), 1.0);
        let residuals = [0.9, 0.8, 0.7, 0.8, 0.9, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0];
        let corrections: Vec<_> = (1..)
            .zip(residuals)
            .filter(|&(outer, residual)| pace.judge(&controls(), outer, residual))
            .map(|(outer, _)| outer)
            .collect();
        // To 4, to 7, to 3, to 2.
        assert_eq!(corrections, [3, 6, 9, 12]);
        assert_eq!(pace.corrections, 2);
        let later = (13..19).map(|outer| pace.judge(&controls(), outer, 7.0));
        assert!(!later.collect::<Vec<_>>().contains(&true));
    }

    #[test]
    fn corrections_double_up_to_the_most_where_it_does_not() {
        assert_eq!([2, 3, 6, 9].map(|done| after(0.5, done)), [2, 4, 7, 7]);
        assert_eq!(after(1.5, 6), 7);
    }
}
