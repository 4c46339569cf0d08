//! The error that a window's step in time makes, from the committed gas of successive windows (docs/theory.md, TSM-12).
//!
//! The estimate needs nothing of a solver, so that it is the same for every gas.

use calcine_physics::Vec3;

use crate::checkpoint::{StateFile, StateFileError};
use crate::part::GasFields;

/// Error of a step of implicit Euler: 1/(1 − z) − e^z = z²/2 + …
const EULER: f64 = 0.5;
/// Error of a step of the two-stage scheme, γ = 1 − 1/√2: R(z) − e^z = (3γ² − 2γ³ − 1/6) z³ + … = 0.04044 z³.
const TWO_STAGES: f64 = 0.040_440_114_519_880_91;

/// The estimated error of one window's step: root mean squares over the gas.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct StepError {
    /// Of the velocity, as a share of the largest root mean square of it so far.
    pub velocity: f64,
    /// Of the temperature, as a share of the temperature.
    pub temperature: f64,
    /// Of the mass fraction of which it is largest.
    pub composition: f64,
}

impl StepError {
    /// The largest of the three.
    pub fn largest(&self) -> f64 {
        self.velocity.max(self.temperature).max(self.composition)
    }
}

/// Spans in s of a window: on the motion clock, over which velocities change, and that over which the gas stores.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct StepSpans {
    /// Of velocities.
    pub motion: f64,
    /// Of temperature and composition.
    pub storage: f64,
}

/// The order in time of a window's step.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum StepOrder {
    /// Implicit Euler, and whatever a window holds constant.
    First,
    /// Two stages.
    Second,
}

impl StepOrder {
    /// The power of the span with which the error of a step falls.
    pub fn power(self) -> f64 {
        match self {
            Self::First => 2.0,
            Self::Second => 3.0,
        }
    }
}

/// Mean rates of change over a window.
#[derive(Clone, Debug, Default, PartialEq)]
struct Rates {
    spans: StepSpans,
    values: Vec<f64>,
}

/// What successive windows have left: the gas at the last commit, and its rates in the windows before.
#[derive(Clone, Debug, Default)]
pub struct StepHistory {
    /// Velocities, temperatures, mass fractions at the last commit.
    last: Vec<f64>,
    /// Rates of the last two windows at most, the latest first.
    rates: Vec<Rates>,
    /// The largest root mean square of the velocity in m/s so far.
    speed: f64,
    /// True from a start or a jump to the end of the window after it, whose rates hold the jump.
    jumped: bool,
}

impl StepHistory {
    /// The gas from which the first window steps.
    pub fn begin(fields: &GasFields<'_>) -> Self {
        let mut history = Self {
            jumped: true,
            ..Self::default()
        };
        gather(fields, &mut history.last);
        history
    }

    /// What jumps at the start of the next window is no error of a step: the rates of that window and of those before are left out.
    pub fn jump(&mut self) {
        self.rates.clear();
        self.jumped = true;
    }

    /// The error of a step to these fields, with gas of these volumes in m³ in the cells; `None` where too few windows have passed
    /// since the start or the last jump, of second order one more.
    pub fn estimate(
        &self,
        fields: &GasFields<'_>,
        volume: &[f64],
        spans: StepSpans,
        order: StepOrder,
    ) -> Option<StepError> {
        let before = self.rates.first().filter(|_| !self.jumped)?;
        let older = self.rates.get(1);
        if order == StepOrder::Second && older.is_none() {
            return None;
        }
        let mut now = Vec::new();
        gather(fields, &mut now);
        if now.len() != self.last.len() {
            return None;
        }
        let cells = volume.len();
        let velocities = 3 * cells;
        let error = |place: usize| {
            let span = |of: StepSpans| match place < velocities {
                true => of.motion,
                false => of.storage,
            };
            let (h, h1) = (span(spans), span(before.spans));
            let rate = (now[place] - self.last[place]) / h;
            let change = rate - before.values[place];
            let Some(older) = older.filter(|_| order == StepOrder::Second) else {
                // The rate over a step of implicit Euler is that at its end, whatever the lengths of both.
                return EULER * h * change;
            };
            // Divided differences of Newton.
            let h2 = span(older.spans);
            let earlier = (before.values[place] - older.values[place]) / (h1 + h2);
            let third = (change / (h + h1) - earlier) / (h + h1 + h2);
            TWO_STAGES * h * h * h * 6.0 * third
        };
        let whole: f64 = volume.iter().sum();
        let mean = |of: &dyn Fn(usize) -> f64| {
            let sum: f64 = volume.iter().enumerate().map(|(c, v)| v * of(c)).sum();
            (sum / whole).sqrt()
        };
        let speed = self.speed.max(root_mean_square(fields.velocity, volume));
        let velocity = mean(&|cell| (0..3).map(|i| error(3 * cell + i).powi(2)).sum());
        let species = fields.composition.len() / cells.max(1);
        let first = velocities + cells;
        let fractions =
            (0..species).map(|k| mean(&|cell| error(first + cell * species + k).powi(2)));
        Some(StepError {
            velocity: if velocity > 0.0 {
                velocity / speed
            } else {
                0.0
            },
            temperature: mean(&|cell| {
                (error(velocities + cell) / fields.temperature[cell]).powi(2)
            }),
            composition: fractions.fold(0.0, f64::max),
        })
    }

    /// Takes the committed gas.
    pub fn commit(&mut self, fields: &GasFields<'_>, volume: &[f64], spans: StepSpans) {
        self.speed = self.speed.max(root_mean_square(fields.velocity, volume));
        let mut now = Vec::new();
        gather(fields, &mut now);
        if now.len() != self.last.len() {
            self.jump();
        }
        if self.jumped {
            self.jumped = false;
            self.last = now;
            self.rates.clear();
            // The window after a jump holds it: rates count from the next window on.
            return;
        }
        let velocities = 3 * volume.len();
        let mut rates = match self.rates.len() {
            2 => self.rates.pop().unwrap_or_default(),
            _ => Rates::default(),
        };
        rates.spans = spans;
        rates.values.clear();
        let pairs = now.iter().zip(&self.last).enumerate();
        rates.values.extend(pairs.map(|(place, (new, old))| {
            (new - old)
                / match place < velocities {
                    true => spans.motion,
                    false => spans.storage,
                }
        }));
        self.rates.insert(0, rates);
        self.last = now;
    }

    /// What a checkpoint holds of it. A solver that reads its own checkpoint may differ in round-off from what it last told: the gas of the
    /// last commit is kept as the estimates know it.
    pub fn record(&self, state: &mut StateFile) {
        let mut numbers = vec![self.speed, f64::from(u8::from(self.jumped))];
        for one in &self.rates {
            numbers.extend([one.spans.motion, one.spans.storage]);
        }
        state.set_f64s("step_error", &numbers);
        state.set_f64s("step_gas", &self.last);
        for (name, place) in [("step_rates", 0), ("step_rates_before", 1)] {
            let values = self.rates.get(place).map_or(&[][..], |one| &one.values);
            state.set_f64s(name, values);
        }
    }

    /// Takes up what a checkpoint holds, for a gas with these fields.
    pub fn restore(fields: &GasFields<'_>, state: &StateFile) -> Result<Self, StateFileError> {
        let mut history = Self::begin(fields);
        if let [speed, jumped, spans @ ..] = state.f64s("step_error")? {
            history.last = state.f64s_of("step_gas", history.last.len())?.to_vec();
            history.speed = *speed;
            history.jumped = *jumped != 0.0;
            let names = ["step_rates", "step_rates_before"];
            for (spans, name) in spans.as_chunks::<2>().0.iter().zip(names) {
                history.rates.push(Rates {
                    spans: StepSpans {
                        motion: spans[0],
                        storage: spans[1],
                    },
                    values: state.f64s_of(name, history.last.len())?.to_vec(),
                });
            }
        }
        Ok(history)
    }
}

fn gather(fields: &GasFields<'_>, values: &mut Vec<f64>) {
    values.clear();
    values.extend(fields.velocity.iter().flat_map(|u| [u.x, u.y, u.z]));
    values.extend_from_slice(fields.temperature);
    values.extend_from_slice(fields.composition);
}

fn root_mean_square(velocity: &[Vec3], volume: &[f64]) -> f64 {
    let pairs = velocity.iter().zip(volume);
    let sum: f64 = pairs.map(|(u, v)| v * u.norm_squared()).sum();
    (sum / volume.iter().sum::<f64>()).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gas_columns::GasColumns;

    /// One cell whose fields follow a function of time.
    fn gas(value: f64) -> GasColumns {
        GasColumns {
            temperature: vec![value],
            velocity: vec![Vec3::new(value, 0.0, 0.0)],
            composition: vec![value, 1.0 - value],
            ..GasColumns::default()
        }
    }

    /// Estimates and errors of single steps of y' = −y with spans that grow by a tenth; `step`: what a scheme makes of z = −h.
    fn steps(order: StepOrder, span: f64, step: impl Fn(f64) -> f64) -> Vec<[f64; 2]> {
        let (mut value, mut h) = (1.0, span);
        let mut history = StepHistory::begin(&gas(value).fields());
        let mut found = Vec::new();
        for _ in 0..5 {
            let next = value * step(-h);
            let spans = StepSpans {
                motion: h,
                storage: h,
            };
            let new = gas(next);
            if let Some(error) = history.estimate(&new.fields(), &[2.0], spans, order) {
                // A share of the temperature at the step's end.
                let exact = value * ((-h).exp() - step(-h)).abs();
                found.push([error.temperature * next, exact]);
                assert_eq!(error.composition, error.temperature * next);
            }
            history.commit(&new.fields(), &[2.0], spans);
            value = next;
            h *= 1.1;
        }
        found
    }

    const GAMMA: f64 = 1.0 - std::f64::consts::FRAC_1_SQRT_2;

    fn two_stages(z: f64) -> f64 {
        (1.0 + (1.0 - 2.0 * GAMMA) * z) / (1.0 - GAMMA * z).powi(2)
    }

    #[test]
    fn the_constant_of_two_stages_is_that_of_their_stability_function() {
        let constant = 3.0 * GAMMA.powi(2) - 2.0 * GAMMA.powi(3) - 1.0 / 6.0;
        assert!((TWO_STAGES - constant).abs() < 1e-15, "{constant:?}");
    }

    #[test]
    fn the_estimate_meets_the_error_of_a_step_as_spans_shrink() {
        for order in [StepOrder::First, StepOrder::Second] {
            let off = [1e-2, 1e-3].map(|span| {
                let found = match order {
                    StepOrder::First => steps(order, span, |z| 1.0 / (1.0 - z)),
                    StepOrder::Second => steps(order, span, two_stages),
                };
                let last = found[found.len() - 1];
                (last[0] / last[1] - 1.0).abs()
            });
            // Of first order in the span, but for what the error of second order itself, 0.24 of its third difference, adds
            // where spans change.
            assert!(off[0] < 0.05, "{order:?}: {off:?}");
            let rest = match order {
                StepOrder::First => 0.0,
                StepOrder::Second => 0.01,
            };
            assert!(off[1] < 0.15 * off[0] + rest, "{order:?}: {off:?}");
        }
    }

    #[test]
    fn nothing_is_said_before_two_windows_have_passed_since_a_start_or_a_jump() {
        assert_eq!(steps(StepOrder::First, 0.1, |z| 1.0 / (1.0 - z)).len(), 3);
        let spans = StepSpans {
            motion: 0.1,
            storage: 0.1,
        };
        let mut history = StepHistory::begin(&gas(1.0).fields());
        for value in [2.0, 2.1, 2.2] {
            history.commit(&gas(value).fields(), &[1.0], spans);
        }
        let at = |history: &StepHistory, value: f64| {
            history.estimate(&gas(value).fields(), &[1.0], spans, StepOrder::First)
        };
        assert!(at(&history, 2.3).unwrap().largest() < 1e-12);
        history.jump();
        assert_eq!(at(&history, 9.0), None);
        history.commit(&gas(9.0).fields(), &[1.0], spans);
        assert_eq!(at(&history, 9.1), None);
        history.commit(&gas(9.1).fields(), &[1.0], spans);
        assert!(at(&history, 9.2).unwrap().largest() < 1e-12);
    }

    #[test]
    fn a_history_goes_on_from_its_checkpoint_with_the_same_bits() {
        let spans = |span| StepSpans {
            motion: span,
            storage: 3.0 * span,
        };
        let mut history = StepHistory::begin(&gas(1.0).fields());
        for (place, value) in [0.7, 0.5, 0.4, 0.35].into_iter().enumerate() {
            let mut state = StateFile::new();
            history.record(&mut state);
            let value_before = [1.0, 0.7, 0.5, 0.4][place];
            let restored = StepHistory::restore(&gas(value_before).fields(), &state).unwrap();
            let of = |one: &StepHistory| {
                one.estimate(&gas(value).fields(), &[1.0], spans(0.1), StepOrder::Second)
            };
            assert_eq!(of(&restored), of(&history), "window {place}");
            history.commit(
                &gas(value).fields(),
                &[1.0],
                spans(0.1 + 0.01 * place as f64),
            );
        }
    }
}
