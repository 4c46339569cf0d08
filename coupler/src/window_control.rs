//! How long the next window is where the case gives bounds in place of a length (docs/theory.md, TSM-13).
//!
//! The length follows the errors and velocities of the windows before and nothing else: no output, probe, checkpoint or interrupt.

use crate::checkpoint::{StateFile, StateFileError};
use crate::time::Ticks;

/// A window grows and shrinks by these factors at most.
const GROWTH: f64 = 2.0;
const SHRINKAGE: f64 = 0.2;
/// Share of what a bound allows at which the next window is aimed.
const AIM: f64 = 0.9;
/// Exponents of the controller of proportional and integral part, over the power of the error.
const INTEGRAL: f64 = 0.7;
const PROPORTIONAL: f64 = 0.4;

/// Bounds of windows, motion time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WindowBounds {
    /// The shortest window, with which the run begins.
    pub min: Ticks,
    /// The longest.
    pub max: Ticks,
    /// Largest Courant number of the gas.
    pub courant: Option<f64>,
    /// Largest estimated error of a window's step.
    pub error: Option<f64>,
}

/// What a window says of the length of the next.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WindowOutcome {
    /// Its length, motion time.
    pub span: Ticks,
    /// Its estimated error; `None` where there is none yet.
    pub error: Option<f64>,
    /// The power of the span with which that falls.
    pub power: f64,
    /// Courant number over motion time, in 1/s, at its end.
    pub courant_rate: f64,
}

/// The controller with its memory.
#[derive(Clone, Debug, PartialEq)]
pub struct WindowControl {
    bounds: WindowBounds,
    /// Windows are whole numbers of this, in s; `None`: of any length.
    step: Option<f64>,
    size: Ticks,
    /// The error of the window before.
    error_before: Option<f64>,
}

impl WindowControl {
    /// Begins with the shortest window.
    pub fn new(bounds: WindowBounds, step: Option<f64>) -> Self {
        let mut control = Self {
            bounds,
            step,
            size: bounds.min,
            error_before: None,
        };
        control.restart();
        control
    }

    /// The next window's length, motion time.
    pub fn size(&self) -> Ticks {
        self.size
    }

    /// After a jump: the shortest window again.
    pub fn restart(&mut self) {
        self.size = self.within(0.0);
        self.error_before = None;
    }

    /// Why a window is too long, in words, where it is and could be shorter.
    pub fn refuses(&self, window: &WindowOutcome) -> Option<String> {
        if window.span <= self.within(0.0) {
            return None;
        }
        let courant = window.courant_rate * window.span.seconds();
        match (self.bounds.error, window.error, self.bounds.courant) {
            (Some(bound), Some(error), _) if error > bound => {
                Some(format!("its error is {error:.2e}, above {bound}"))
            }
            (_, _, Some(bound)) if courant > bound => {
                Some(format!("its Courant number is {courant:.3}, above {bound}"))
            }
            _ => None,
        }
    }

    /// Shortens the next window after one that was refused.
    pub fn shrink(&mut self, window: &WindowOutcome) {
        let span = window.span.seconds();
        let mut next = AIM * span;
        if let (Some(bound), Some(error)) = (self.bounds.error, window.error) {
            next = next.min(AIM * span * (bound / error).powf(1.0 / window.power));
        }
        next = next.max(SHRINKAGE * span).min(self.by_courant(window));
        self.error_before = None;
        self.size = self.within(next);
    }

    /// Chooses the length after a window that was committed.
    pub fn advance(&mut self, window: &WindowOutcome) {
        let span = window.span.seconds();
        let factor = match (self.bounds.error, window.error) {
            (None, _) => GROWTH,
            // Without an estimate there is nothing to grow by.
            (Some(_), None) => 1.0,
            (Some(bound), Some(error)) => self.factor(bound, error, window.power),
        };
        self.error_before = window.error;
        let mut next = span * factor;
        // A window that a schedule or the end cut short says nothing against the length before.
        if factor >= 1.0 {
            next = next.max(self.size.seconds());
        }
        self.size = self.within(next.min(self.by_courant(window)));
    }

    /// Factor by which the error lets the window grow.
    fn factor(&self, bound: f64, error: f64, power: f64) -> f64 {
        if error <= 0.0 {
            return GROWTH;
        }
        let aim = bound * AIM.powf(power);
        let factor = match self.error_before.filter(|before| *before > 0.0) {
            None => (aim / error).powf(1.0 / power),
            Some(before) => {
                (aim / error).powf(INTEGRAL / power) * (before / aim).powf(PROPORTIONAL / power)
            }
        };
        factor.clamp(SHRINKAGE, GROWTH)
    }

    fn by_courant(&self, window: &WindowOutcome) -> f64 {
        match self.bounds.courant {
            Some(bound) if window.courant_rate > 0.0 => AIM * bound / window.courant_rate,
            _ => f64::INFINITY,
        }
    }

    /// The nearest length that the bounds allow.
    fn within(&self, seconds: f64) -> Ticks {
        let [min, max] = [self.bounds.min, self.bounds.max];
        let mut seconds = seconds.clamp(min.seconds(), max.seconds());
        if let Some(step) = self.step {
            // Of round-off in the number of steps as little as a tick is.
            const WHOLE: f64 = 1e-6;
            let whole = (seconds / step + WHOLE).floor();
            let least = (min.seconds() / step - WHOLE).ceil().max(1.0);
            seconds = step * whole.max(least);
            let size = Ticks::from_seconds(seconds);
            return size.unwrap_or(min);
        }
        let size = Ticks::from_seconds(seconds);
        size.map_or(min, |size| size.clamp(min, max))
    }

    /// What a checkpoint holds.
    pub fn record(&self, state: &mut StateFile) {
        state.set_u64s("window_size", &[self.size.count().cast_unsigned()]);
        let error: Vec<f64> = self.error_before.into_iter().collect();
        state.set_f64s("window_error", &error);
    }

    /// Takes it up.
    pub fn restore(&mut self, state: &StateFile) -> Result<(), StateFileError> {
        if let [size] = *state.u64s("window_size")? {
            self.size = Ticks::new(size.cast_signed());
        }
        self.error_before = state.f64s("window_error")?.first().copied();
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ticks(seconds: f64) -> Ticks {
        Ticks::from_seconds(seconds).unwrap()
    }

    fn control(courant: Option<f64>, error: Option<f64>) -> WindowControl {
        WindowControl::new(
            WindowBounds {
                min: ticks(1e-5),
                max: ticks(1e-2),
                courant,
                error,
            },
            None,
        )
    }

    fn outcome(control: &WindowControl, error: Option<f64>, courant_rate: f64) -> WindowOutcome {
        WindowOutcome {
            span: control.size(),
            error,
            power: 2.0,
            courant_rate,
        }
    }

    #[test]
    fn errors_of_a_constant_curvature_settle_near_the_bound() {
        let mut control = control(None, Some(1e-3));
        let mut spans = Vec::new();
        for _ in 0..60 {
            let span = control.size().seconds();
            let window = outcome(&control, Some(200.0 * span * span), 0.0);
            assert_eq!(control.refuses(&window), None);
            control.advance(&window);
            spans.push(span);
        }
        // 0.9 of the span that the bound allows.
        let error = 200.0 * spans[59].powi(2);
        assert!((error / 1e-3 - 0.81).abs() < 1e-3, "{error}");
        for pair in spans.windows(2) {
            assert!(pair[1] <= 2.0 * pair[0] * (1.0 + 1e-9));
        }
    }

    #[test]
    fn the_courant_number_is_kept_below_its_bound_and_the_length_within_its_own() {
        let mut control = control(Some(2.0), None);
        for rate in [0.0, 0.0, 0.0, 1e3, 1e9, 1e3] {
            let window = outcome(&control, None, rate);
            control.advance(&window);
            let size = control.size().seconds();
            assert!((1e-5..=1e-2).contains(&size));
            assert!(rate == 1e9 || size * rate <= 2.0, "{size} at {rate}");
        }
        for _ in 0..20 {
            let window = outcome(&control, None, 1.0);
            control.advance(&window);
        }
        assert_eq!(control.size(), ticks(1e-2));
    }

    #[test]
    fn a_window_above_a_bound_is_refused_unless_it_is_the_shortest() {
        let mut control = control(Some(1.0), Some(1e-3));
        assert_eq!(control.refuses(&outcome(&control, Some(1.0), 0.0)), None);
        control.size = ticks(4e-3);
        let long = outcome(&control, Some(4e-3), 0.0);
        assert!(control.refuses(&long).unwrap().contains("error"));
        control.shrink(&long);
        // 0.9 · 4 ms · √(1/4)
        assert_eq!(control.size(), ticks(1.8e-3));
        let fast = outcome(&control, Some(1e-4), 1e3);
        assert!(control.refuses(&fast).unwrap().contains("Courant"));
        control.shrink(&fast);
        assert_eq!(control.size(), ticks(0.9e-3));
    }

    #[test]
    fn windows_are_whole_numbers_of_the_particles_step() {
        let mut control = control(Some(1.0), None);
        control.step = Some(3e-6);
        control.restart();
        assert_eq!(control.size(), ticks(1.2e-5));
        control.advance(&outcome(&control, None, 0.0));
        assert_eq!(control.size(), ticks(2.4e-5));
        control.advance(&outcome(&control, None, 0.9 / 2e-5));
        assert_eq!(control.size(), ticks(1.8e-5));
    }

    #[test]
    fn a_window_cut_short_by_a_schedule_leaves_the_length_as_it_was() {
        let mut control = control(None, Some(1e-3));
        control.size = ticks(4e-3);
        let short = WindowOutcome {
            span: ticks(1e-4),
            ..outcome(&control, Some(1e-7), 0.0)
        };
        control.advance(&short);
        assert_eq!(control.size(), ticks(4e-3));
        control.restart();
        assert_eq!(control.size(), ticks(1e-5));
    }
}
