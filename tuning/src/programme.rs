//! The temperature that a furnace or a sample follows.

use std::cmp::Ordering;

use crate::TuningError;

/// Width in K of the panels over which rate constants are integrated: over one of them ln k bends so little that the rule of
/// four points is exact to 1e-9 of k for energies to 500 kJ/mol above 500 K.
const PANEL: f64 = 4.0;
/// Places and weights of the rule of Gauss and Legendre with four points over −1 to 1.
const GAUSS: [(f64, f64); 4] = [
    (-0.861_136_311_594_052_6, 0.347_854_845_137_453_85),
    (-0.339_981_043_584_856_3, 0.652_145_154_862_546_1),
    (0.339_981_043_584_856_3, 0.652_145_154_862_546_1),
    (0.861_136_311_594_052_6, 0.347_854_845_137_453_85),
];

/// Parts of its span by whose slopes a ramp is told from a hold.
const PARTS: usize = 20;
/// Place among the sorted slopes of the one that the others are measured by, above which outliers may lie.
const STEEP: usize = 17;

/// A temperature over time, linear between its points.
#[derive(Clone, Debug, PartialEq)]
pub struct TemperatureProgramme {
    times: Vec<f64>,
    temperatures: Vec<f64>,
}

impl TemperatureProgramme {
    /// Times in s, each later than the one before, with temperatures in K.
    pub fn new(times: Vec<f64>, temperatures: Vec<f64>) -> Result<Self, TuningError> {
        if times.len() != temperatures.len() || times.len() < 2 {
            return Err(TuningError::Programme(format!(
                "{} times and {} temperatures",
                times.len(),
                temperatures.len()
            )));
        }
        if let Some(place) = times
            .windows(2)
            .position(|pair| pair[1].partial_cmp(&pair[0]) != Some(Ordering::Greater))
        {
            return Err(TuningError::Programme(format!(
                "{} s does not come after {} s",
                times[place + 1],
                times[place]
            )));
        }
        let warm = |t: &f64| t.is_finite() && *t > 0.0;
        if let Some(cold) = temperatures.iter().find(|t| !warm(t)) {
            return Err(TuningError::Programme(format!("a temperature of {cold} K")));
        }
        Ok(Self {
            times,
            temperatures,
        })
    }

    /// A constant heating rate in K/s from a temperature in K at time zero, up to a time in s.
    pub fn heating(start: f64, rate: f64, end: f64) -> Result<Self, TuningError> {
        Self::new(vec![0.0, end], vec![start, start + rate * end])
    }

    /// Its points: times in s and temperatures in K.
    pub fn points(&self) -> (&[f64], &[f64]) {
        (&self.times, &self.temperatures)
    }

    /// Temperature in K and its slope in K/s at a time in s; before the first and after the last point the line goes on.
    pub fn at(&self, time: f64) -> (f64, f64) {
        let next = self.times.partition_point(|&one| one <= time);
        let next = next.clamp(1, self.times.len() - 1);
        let (from, to) = (next - 1, next);
        let slope =
            (self.temperatures[to] - self.temperatures[from]) / (self.times[to] - self.times[from]);
        (
            self.temperatures[from] + slope * (time - self.times[from]),
            slope,
        )
    }

    /// The mean heating rate in K/s over the span of its temperatures, by least squares.
    pub fn heating_rate(&self) -> f64 {
        slope(&self.times, &self.temperatures)
    }

    /// Heating rate in K/s of its ramp, holds left out: the median over the parts of its span that heat. `None` where it heats for less than
    /// half of the span.
    pub fn ramp_rate(&self) -> Option<f64> {
        let (start, end) = (self.times[0], self.times[self.times.len() - 1]);
        let place = |part: usize| start + (end - start) * part as f64 / PARTS as f64;
        let of_part = |part: usize| {
            let (from, to) = (place(part), place(part + 1));
            let within = |time: f64| self.times.partition_point(|&one| one < time);
            let points = within(from)..within(to);
            match points.len() {
                0..=2 => (self.at(to).0 - self.at(from).0) / (to - from),
                _ => slope(&self.times[points.clone()], &self.temperatures[points]),
            }
        };
        let mut slopes: Vec<f64> = (0..PARTS).map(of_part).collect();
        slopes.sort_by(f64::total_cmp);
        let least = 0.5 * slopes[STEEP];
        let heating = &slopes[slopes.partition_point(|&one| one <= least.max(0.0))..];
        (2 * heating.len() >= PARTS).then(|| heating[heating.len() / 2])
    }
}

/// Slope of values over times by least squares.
fn slope(times: &[f64], values: &[f64]) -> f64 {
    let mean = |list: &[f64]| list.iter().sum::<f64>() / list.len() as f64;
    let (time, value) = (mean(times), mean(values));
    let (mut above, mut below) = (0.0, 0.0);
    for (t, one) in times.iter().zip(values) {
        above += (t - time) * (one - value);
        below += (t - time) * (t - time);
    }
    above / below
}

/// Places at which rate constants are evaluated so that ∫ k dt is known at given times whatever the constants are.
#[derive(Clone, Debug, PartialEq)]
pub struct RateQuadrature {
    /// 1/T at each place in 1/K.
    inverse: Vec<f64>,
    /// Time that each place stands for, in s.
    weights: Vec<f64>,
    /// Of each output time, how many places come before it.
    ends: Vec<usize>,
}

impl RateQuadrature {
    /// For outputs at these times in s, in ascending order, from the first point of the programme on.
    pub fn new(programme: &TemperatureProgramme, times: &[f64]) -> Self {
        let (knots, _) = programme.points();
        let (mut inverse, mut weights, mut ends) = (Vec::new(), Vec::new(), Vec::new());
        let mut now = knots[0];
        let mut add = |from: f64, to: f64| {
            let (start, slope) = programme.at(0.5 * (from + to));
            let change = (slope * (to - from)).abs();
            let panels = (change / PANEL).ceil().max(1.0);
            let half = 0.5 * (to - from) / panels;
            for panel in 0..panels as usize {
                let middle = from + half * (2.0 * panel as f64 + 1.0);
                for (place, weight) in GAUSS {
                    let time = middle + half * place;
                    inverse.push(1.0 / (start + slope * (time - 0.5 * (from + to))));
                    weights.push(half * weight);
                }
            }
            inverse.len()
        };
        let mut count = 0;
        for &time in times {
            while now < time {
                let knot = knots.partition_point(|&one| one <= now);
                let to = knots.get(knot).map_or(time, |&knot| knot.min(time));
                count = add(now, to);
                now = to;
            }
            ends.push(count);
        }
        Self {
            inverse,
            weights,
            ends,
        }
    }

    /// ∫ exp(−θ/T) dt in s up to each output time, θ = E/R in K.
    pub fn integrate(&self, theta: f64, out: &mut Vec<f64>) {
        out.clear();
        let (mut sum, mut from) = (0.0, 0);
        for &end in &self.ends {
            let places = self.inverse[from..end].iter().zip(&self.weights[from..end]);
            sum += places
                .map(|(inverse, weight)| weight * (-theta * inverse).exp())
                .sum::<f64>();
            from = end;
            out.push(sum);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_programme_is_linear_between_its_points_and_goes_on_beyond_them() {
        let programme =
            TemperatureProgramme::new(vec![0.0, 10.0, 20.0], vec![300.0, 320.0, 320.0]).unwrap();
        assert_eq!(programme.at(5.0), (310.0, 2.0));
        assert_eq!(programme.at(10.0), (320.0, 0.0));
        assert_eq!(programme.at(30.0), (320.0, 0.0));
        assert_eq!(programme.at(-1.0), (298.0, 2.0));
    }

    /// Temperatures each 5 s with noise of 0.05 K, a hold of a tenth of the span before and after the ramp of 10 K/min.
    #[test]
    fn the_rate_of_a_ramp_leaves_holds_out_and_a_hold_has_none() {
        let mut random = crate::SearchRandom::new(1);
        let mut of = |hold: f64| {
            let times: Vec<f64> = (0..720).map(|k| 5.0 * f64::from(k)).collect();
            let temperature = |t: &f64| 300.0 + (t - hold).clamp(0.0, 3600.0 - 2.0 * hold) / 6.0;
            let values = times.iter().map(temperature);
            let values = values.map(|value| value + 0.05 * random.normal()).collect();
            TemperatureProgramme::new(times, values).unwrap()
        };
        let held = of(360.0);
        let rate = 60.0 * held.ramp_rate().unwrap();
        assert!((rate - 10.0).abs() < 0.02, "{rate}");
        assert!(
            60.0 * held.heating_rate() < 9.7,
            "a mean has the holds in it"
        );
        assert_eq!(of(1500.0).ramp_rate(), None);
        let line = TemperatureProgramme::heating(300.0, 0.25, 100.0).unwrap();
        assert!((line.ramp_rate().unwrap() / 0.25 - 1.0).abs() < 1e-12);
    }

    #[test]
    fn a_clock_that_stands_still_and_a_temperature_below_zero_are_refused() {
        let of = |times: &[f64], temperatures: &[f64]| {
            TemperatureProgramme::new(times.to_vec(), temperatures.to_vec())
        };
        assert!(of(&[0.0, 0.0], &[300.0, 310.0]).is_err());
        assert!(of(&[0.0, f64::NAN], &[300.0, 310.0]).is_err());
        assert!(of(&[0.0, 1.0], &[300.0, -1.0]).is_err());
        assert!(of(&[0.0], &[300.0]).is_err());
    }

    /// ∫ exp(−θ/T) dT up to T is T E₂(θ/T), E₂ by its continued fraction (Abramowitz and Stegun 5.1.22).
    fn exact(theta: f64, t: f64) -> f64 {
        let u = theta / t;
        let mut tail = 0.0;
        for k in (1..200).rev() {
            let k = f64::from(k);
            tail = k * (k + 1.0) / (u + 2.0 + 2.0 * k - tail);
        }
        t * (-u).exp() / (u + 2.0 - tail)
    }

    #[test]
    fn the_integral_of_the_rate_constant_is_that_of_the_exponential_integral() {
        let rate = 0.25;
        let programme = TemperatureProgramme::heating(293.15, rate, 4000.0).unwrap();
        let times: Vec<f64> = (0..40).map(|k| 100.0 * f64::from(k)).collect();
        let quadrature = RateQuadrature::new(&programme, &times);
        let mut out = Vec::new();
        for energy in [40e3, 120e3, 325.1e3, 500e3] {
            let theta = energy / calcine_physics::gas::GAS_CONSTANT;
            quadrature.integrate(theta, &mut out);
            for (&time, found) in times.iter().zip(&out).skip(20) {
                let t = 293.15 + rate * time;
                let expected = (exact(theta, t) - exact(theta, 293.15)) / rate;
                assert!(
                    (found / expected - 1.0).abs() < 1e-9,
                    "{energy} {t}: {found} {expected}"
                );
            }
        }
    }

    #[test]
    fn a_held_temperature_counts_with_its_time() {
        let programme = TemperatureProgramme::new(vec![0.0, 100.0], vec![700.0, 700.0]).unwrap();
        let quadrature = RateQuadrature::new(&programme, &[0.0, 50.0, 150.0]);
        let mut out = Vec::new();
        quadrature.integrate(7000.0, &mut out);
        let k = (-10.0f64).exp();
        for (found, time) in out.iter().zip([0.0, 50.0, 150.0]) {
            assert!((found - time * k).abs() < 1e-12);
        }
    }
}
