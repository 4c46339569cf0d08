//! Steady states over a key.

use super::steady::SteadyState;
use super::topology::Plant;
use crate::PlantError;

/// The steady state of one value of a key, and its dominant mode.
#[derive(Clone, Debug)]
pub struct ContinuationPoint {
    /// Value of the key.
    pub value: f64,
    /// Steady state.
    pub steady: SteadyState,
    /// Growth rate of the dominant mode in 1/s.
    pub growth_rate: f64,
    /// Period of the dominant mode in s; infinite where it does not oscillate.
    pub period: f64,
}

/// Plants that differ by one key, whose steady states are followed (docs/theory.md, FLS-5).
pub struct Continuation<F> {
    make: F,
    /// Time at which schedules are looked at, in s.
    time: f64,
}

impl<F: Fn(f64) -> Result<Plant, PlantError>> Continuation<F> {
    /// Plants of a key, with schedules as they are at a time in s.
    pub fn new(make: F, time: f64) -> Self {
        Self { make, time }
    }

    /// The steady state of a value, from a guess.
    pub fn point(&self, value: f64, guess: &[f64]) -> Result<ContinuationPoint, PlantError> {
        let plant = (self.make)(value)?;
        let steady = plant.steady(guess, self.time)?;
        let stability = plant.stability(&steady, self.time)?;
        Ok(ContinuationPoint {
            value,
            growth_rate: stability.growth_rate().unwrap_or(f64::NEG_INFINITY),
            period: stability.period().unwrap_or(f64::INFINITY),
            steady,
        })
    }

    /// Steady states of values that follow one another, each from the one before, the first from the plant's start.
    pub fn follow(&self, values: &[f64]) -> Result<Vec<ContinuationPoint>, PlantError> {
        let mut points: Vec<ContinuationPoint> = Vec::new();
        for value in values {
            let guess = match points.last() {
                Some(point) => point.steady.unknowns.clone(),
                None => (self.make)(*value)?.start(),
            };
            points.push(self.point(*value, &guess)?);
        }
        Ok(points)
    }

    /// Values of the key at which points that follow one another gain or lose stability, to a relative `width` (regula falsi with
    /// Illinois' halving).
    ///
    /// Source: Dowell and Jarratt, BIT 11 (1971) 168, doi 10.1007/BF01934364.
    pub fn limits(
        &self,
        points: &[ContinuationPoint],
        width: f64,
    ) -> Result<Vec<ContinuationPoint>, PlantError> {
        let crosses = |pair: &&[ContinuationPoint]| {
            (pair[0].growth_rate < 0.0) != (pair[1].growth_rate < 0.0)
        };
        let pairs = points.windows(2).filter(crosses);
        pairs
            .map(|pair| self.limit(&pair[0], &pair[1], width))
            .collect()
    }

    fn limit(
        &self,
        from: &ContinuationPoint,
        to: &ContinuationPoint,
        width: f64,
    ) -> Result<ContinuationPoint, PlantError> {
        let (mut low, mut high) = (from.clone(), to.clone());
        let mut rates = [low.growth_rate, high.growth_rate];
        let mut side = 0;
        // As many as bisection needs for the width of a double.
        for _ in 0..60 {
            let share = rates[0] / (rates[0] - rates[1]);
            let value = low.value + share * (high.value - low.value);
            let found = self.point(value, &low.steady.unknowns)?;
            let done = (high.value - low.value).abs().min(
                (found.value - low.value)
                    .abs()
                    .min((high.value - found.value).abs()),
            ) <= width * found.value.abs();
            if done || found.growth_rate == 0.0 {
                return Ok(found);
            }
            let rate = found.growth_rate;
            if (rate < 0.0) == (low.growth_rate < 0.0) {
                (low, rates[0]) = (found, rate);
                rates[1] *= if side == -1 { 0.5 } else { 1.0 };
                side = -1;
            } else {
                (high, rates[1]) = (found, rate);
                rates[0] *= if side == 1 { 0.5 } else { 1.0 };
                side = 1;
            }
        }
        Ok(low)
    }
}
