//! The gas about which particles are linearised, from attempt to attempt of a window.

use calcine_numerics::Anderson;

use crate::extreme::larger;
use crate::part::GasFields;
use crate::smoother::Operator;

/// Change of temperature in K that weighs as much as one of a mass fraction from none to one.
const KELVIN: f64 = 1000.0;

/// The gas about which particles are linearised: that of the last attempt, accelerated by the history of the window.
#[derive(Default)]
pub(super) struct GasIterate {
    temperature: Vec<f64>,
    composition: Vec<f64>,
    pressure: Vec<f64>,
    /// Logarithm of the mean pressure in Pa, which follows what reacts where gas cannot leave.
    level: f64,
    /// Temperature in K that each particle sees.
    pub sampled_temperature: Vec<f64>,
    acceleration: Anderson,
    /// The gas of an earlier attempt, scaled.
    kept: Vec<f64>,
    /// Iterate and what came of it as one list, scaled.
    before: Vec<f64>,
    made: Vec<f64>,
}

impl GasIterate {
    /// Begins the attempts of a window.
    pub fn begin(&mut self, operator: &Operator, gas: &GasFields<'_>) {
        self.start(gas);
        self.sample(operator);
    }

    fn start(&mut self, gas: &GasFields<'_>) {
        self.acceleration.clear();
        self.temperature.clear();
        self.temperature.extend_from_slice(gas.temperature);
        self.composition.clear();
        self.composition.extend_from_slice(gas.composition);
        self.pressure.clear();
        self.pressure.extend_from_slice(gas.pressure);
        self.level = level(gas.pressure);
    }

    /// Takes up what the gas made of the lines about the iterate. The result is how far the next one is from that gas:
    /// the largest of the logarithm of their pressures, and the root mean squares of the differences of temperatures
    /// (over [`KELVIN`]) and of mass fractions.
    pub fn advance(&mut self, operator: &Operator, gas: &GasFields<'_>) -> f64 {
        let extrapolated = self.step(gas);
        self.sample(operator);
        extrapolated
    }

    fn step(&mut self, gas: &GasFields<'_>) -> f64 {
        let cells = gas.temperature.len();
        // The one level weighs as much as a field.
        let weight = (cells.max(1) as f64).sqrt();
        let made = level(gas.pressure);
        scaled(
            &self.temperature,
            &self.composition,
            self.level,
            &mut self.before,
        );
        scaled(gas.temperature, gas.composition, made, &mut self.made);
        self.acceleration.accelerate(&self.before, &mut self.made);
        self.level = self.made.pop().map_or(made, |sum| sum / weight);
        self.pressure.clear();
        let shift = (self.level - made).exp();
        self.pressure
            .extend(gas.pressure.iter().map(|pascal| pascal * shift));
        let species = gas.composition.len() / cells.max(1);
        self.temperature.clear();
        self.temperature.extend_from_slice(gas.temperature);
        self.composition.clear();
        self.composition.extend_from_slice(gas.composition);
        let (temperature, composition) = self.made.split_at(cells);
        let (mut warmer, mut other) = (0.0, 0.0);
        for (cell, t) in temperature.iter().enumerate() {
            let own = cell * species..(cell + 1) * species;
            // Where it is extrapolated beyond what a gas can be, the gas of the attempt stays. Each by itself: a trace that the gas
            // solver leaves below zero holds nothing else back.
            if *t > 0.0 {
                warmer += (t - self.temperature[cell] / KELVIN).powi(2);
                self.temperature[cell] = t * KELVIN;
            }
            let fractions = &composition[own.clone()];
            let share = within(&self.composition[own.clone()], fractions);
            if share == 0.0 {
                continue;
            }
            for (gas, one) in self.composition[own].iter_mut().zip(fractions) {
                let next = if share < 1.0 {
                    *gas + share * (one - *gas)
                } else {
                    *one
                };
                other += (next - *gas).powi(2);
                *gas = next;
            }
        }
        let mean = |sum: f64| sum.sqrt() / weight;
        let apart = larger((self.level - made).abs(), mean(warmer));
        larger(apart, mean(other))
    }

    /// Keeps the gas of an attempt.
    pub fn keep(&mut self, gas: &GasFields<'_>) {
        let own = level(gas.pressure);
        scaled(gas.temperature, gas.composition, own, &mut self.kept);
    }

    /// How far a gas is from the one that was kept: the root of the sum over temperature (over [`KELVIN`]), mass fractions
    /// and logarithm of the mean pressure of their mean square differences.
    pub fn moved(&mut self, gas: &GasFields<'_>) -> f64 {
        let own = level(gas.pressure);
        scaled(gas.temperature, gas.composition, own, &mut self.made);
        let pairs = self.made.iter().zip(&self.kept);
        let sum: f64 = pairs.map(|(now, before)| (now - before).powi(2)).sum();
        (sum / gas.temperature.len().max(1) as f64).sqrt()
    }

    fn sample(&mut self, operator: &Operator) {
        self.sampled_temperature.resize(operator.particles(), 0.0);
        operator.sample(&self.temperature, &mut self.sampled_temperature);
    }

    /// The fields of the gas with pressure, temperature and composition of the iterate.
    pub fn fields<'a>(&'a self, gas: GasFields<'a>) -> GasFields<'a> {
        GasFields {
            pressure: &self.pressure,
            temperature: &self.temperature,
            composition: &self.composition,
            ..gas
        }
    }
}

/// The share of the way from mass fractions to others up to which none leaves what is from none to one.
fn within(from: &[f64], to: &[f64]) -> f64 {
    let mut share: f64 = 1.0;
    for (from, to) in from.iter().zip(to) {
        if !(0.0..=1.0).contains(to) {
            let end = if *to > 1.0 { 1.0 } else { 0.0 };
            let own = (end - from) / (to - from);
            share = if own > 0.0 { share.min(own) } else { 0.0 };
        }
    }
    share
}

/// A gas as one list: temperatures in K over [`KELVIN`], mass fractions, and the logarithm of its mean pressure, which weighs
/// as much as a field.
fn scaled(temperature: &[f64], composition: &[f64], level: f64, out: &mut Vec<f64>) {
    out.clear();
    out.extend(temperature.iter().map(|kelvin| kelvin / KELVIN));
    out.extend_from_slice(composition);
    out.push((temperature.len().max(1) as f64).sqrt() * level);
}

/// Logarithm of the mean pressure in Pa.
fn level(pressure: &[f64]) -> f64 {
    let sum: f64 = pressure.iter().sum();
    (sum / pressure.len().max(1) as f64)
        .max(f64::MIN_POSITIVE)
        .ln()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A cell of two gases at a temperature in K.
    fn gas<'a>(temperature: &'a [f64], composition: &'a [f64]) -> GasFields<'a> {
        GasFields {
            temperature,
            pressure: &[1e5],
            density: &[1.0],
            composition,
            velocity: &[],
            pressure_gradient: &[],
            turbulence: Default::default(),
        }
    }

    /// Attempts until a temperature that the gas makes of that of the iterate by this slope is within 1e-6 K of the fixed point,
    /// while the gas solver leaves a trace about none.
    fn attempts(slope: f64, traces: [f64; 2]) -> usize {
        let mut iterate = GasIterate::default();
        iterate.start(&gas(&[1000.0], &[traces[0], 1.0 - traces[0]]));
        for attempt in 1..200 {
            let kelvin = 1100.0 + slope * (iterate.temperature[0] - 1100.0);
            let trace = traces[attempt % 2];
            iterate.step(&gas(&[kelvin], &[trace, 1.0 - trace]));
            if (iterate.temperature[0] - 1100.0).abs() < 1e-6 {
                return attempt;
            }
        }
        200
    }

    #[test]
    fn a_trace_that_the_gas_leaves_below_none_does_not_hold_back_the_temperature() {
        for slope in [0.98, -0.9, -1.05] {
            for traces in [[0.0, 0.0], [-1e-12, 1e-13], [-1e-12, -2e-12], [1e-12, 0.0]] {
                let taken = attempts(slope, traces);
                assert!(taken <= 5, "{slope} {traces:?}: {taken}");
            }
        }
    }

    #[test]
    fn fractions_go_as_far_as_none_is_below_none_or_above_one() {
        let inside = [0.2, 0.8];
        assert_eq!(within(&inside, &[0.4, 0.6]), 1.0);
        assert!((within(&inside, &[-0.2, 1.2]) - 0.5).abs() < 1e-15);
        assert_eq!(within(&[-1e-12, 1.0 + 1e-12], &[-2e-12, 1.0 + 2e-12]), 0.0);
        // From below none to far below it, and to what is no number.
        assert_eq!(within(&[0.0, 1.0], &[-0.1, 1.1]), 0.0);
        assert_eq!(within(&inside, &[f64::NAN, f64::NAN]), 0.0);
    }
}
