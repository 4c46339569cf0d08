//! Heat capacity of solids.

use calcine_numerics::Lanes;

use crate::gas::REFERENCE_TEMPERATURE;
use crate::points::linear;

/// Specific heat capacity of a solid, linear in temperature between given points and constant outside
/// them; its integral, the enthalpy, and the inverse of that are exact.
#[derive(Clone, Debug, PartialEq)]
pub struct HeatCapacity {
    /// Temperatures in K, increasing, and c_p in J/kg/K there.
    points: Vec<(f64, f64)>,
    /// Slopes beyond the points in J/kg/K², zero at the last.
    slopes: Vec<f64>,
    /// Enthalpy at the points in J/kg, zero at the first.
    enthalpy: Vec<f64>,
    /// Entropy at the points in J/kg/K, zero at the first.
    entropy: Vec<f64>,
}

impl HeatCapacity {
    /// The same at all temperatures, in J/kg/K.
    pub fn constant(value: f64) -> Self {
        Self::table(vec![(REFERENCE_TEMPERATURE, value)])
    }

    /// Points of temperature in K, increasing, and c_p in J/kg/K, positive; at least one.
    pub fn table(points: Vec<(f64, f64)>) -> Self {
        debug_assert!(!points.is_empty());
        let (mut enthalpy, mut entropy) = (vec![0.0], vec![0.0]);
        for pair in points.windows(2) {
            let area = 0.5 * (pair[0].1 + pair[1].1) * (pair[1].0 - pair[0].0);
            enthalpy.push(enthalpy[enthalpy.len() - 1] + area);
            entropy.push(entropy[entropy.len() - 1] + heat_over_temperature(pair[0], pair[1]));
        }
        let slope = |pair: &[(f64, f64)]| (pair[1].1 - pair[0].1) / (pair[1].0 - pair[0].0);
        let mut slopes: Vec<f64> = points.windows(2).map(slope).collect();
        slopes.push(0.0);
        Self {
            points,
            slopes,
            enthalpy,
            entropy,
        }
    }

    /// True where it is the same at all temperatures.
    pub fn is_constant(&self) -> bool {
        self.points.len() == 1
    }

    /// Lowest and highest temperature in K for which it is given; a constant is taken to hold at all.
    pub fn range(&self) -> (f64, f64) {
        match (self.points.first(), self.points.last()) {
            (Some(first), Some(last)) if !self.is_constant() => (first.0, last.0),
            _ => (0.0, f64::INFINITY),
        }
    }

    /// c_p in J/kg/K at a temperature in K.
    pub fn at(&self, temperature: f64) -> f64 {
        linear(&self.points, temperature)
    }

    /// dc_p/dT in J/kg/K² at a temperature in K.
    pub fn slope(&self, temperature: f64) -> f64 {
        let next = self
            .points
            .partition_point(|&(from, _)| from <= temperature);
        match (next.checked_sub(1), self.points.get(next)) {
            (Some(place), Some(after)) => {
                let from = self.points[place];
                (after.1 - from.1) / (after.0 - from.0)
            }
            _ => 0.0,
        }
    }

    /// Enthalpy in J/kg, counted from the first point.
    pub fn enthalpy(&self, temperature: f64) -> f64 {
        let next = self
            .points
            .partition_point(|&(from, _)| from <= temperature);
        let place = next.saturating_sub(1);
        let (from, capacity) = self.points[place];
        let mean = 0.5 * (capacity + self.at(temperature));
        self.enthalpy[place] + mean * (temperature - from)
    }

    /// c_p in J/kg/K and enthalpy in J/kg, counted from the first point, at temperatures in K side by side.
    #[inline(always)]
    pub fn lanes<const N: usize>(&self, temperature: Lanes<N>) -> [Lanes<N>; 2] {
        let of = |place: usize| {
            let (from, capacity) = self.points[place];
            [from, capacity, self.slopes[place], self.enthalpy[place]].map(Lanes::all)
        };
        let next = self.points.partition_point(|one| one.0 <= temperature[0]);
        let place = next.saturating_sub(1);
        let to = self.points.get(next).map_or(f64::INFINITY, |one| one.0);
        let between = self.points[place].0..to;
        let [mut from, mut base, mut slope, mut enthalpy] = of(place);
        if temperature.any(|t| !between.contains(&t)) {
            // Not all are between the same two points. Below the first one nothing rises.
            [from, base, ..] = of(0);
            (slope, enthalpy) = (Lanes::default(), Lanes::default());
            for (k, point) in self.points.iter().enumerate() {
                // Where all are below, they are below the points that follow.
                if k > 0 && !temperature.any(|t| t >= point.0) {
                    break;
                }
                let [at, own, rise, held] = of(k);
                from = temperature.if_below(at, from, at);
                base = temperature.if_below(at, base, own);
                slope = temperature.if_below(at, slope, rise);
                enthalpy = temperature.if_below(at, enthalpy, held);
            }
        }
        let beyond = temperature - from;
        let capacity = base + slope * beyond;
        [capacity, enthalpy + (base + capacity) * beyond * 0.5]
    }

    /// Entropy in J/kg/K, counted from the first point.
    pub fn entropy(&self, temperature: f64) -> f64 {
        let next = self
            .points
            .partition_point(|&(from, _)| from <= temperature);
        let place = next.saturating_sub(1);
        let to = (temperature, self.at(temperature));
        self.entropy[place] + heat_over_temperature(self.points[place], to)
    }

    /// Temperature in K of an enthalpy in J/kg.
    pub fn temperature(&self, enthalpy: f64) -> f64 {
        let next = self.enthalpy.partition_point(|&from| from <= enthalpy);
        let place = next.saturating_sub(1);
        let (from, capacity) = self.points[place];
        let rest = enthalpy - self.enthalpy[place];
        let slope = match self.points.get(next) {
            Some(after) if next > 0 => (after.1 - capacity) / (after.0 - from),
            _ => 0.0,
        };
        // rest = c x + s x²/2; this root has no cancellation and holds for s = 0.
        let root = (capacity * capacity + 2.0 * slope * rest).max(0.0).sqrt();
        from + 2.0 * rest / (capacity + root)
    }
}

/// ∫ c_p/T dT between two points of temperature in K and c_p, linear in between.
fn heat_over_temperature(from: (f64, f64), to: (f64, f64)) -> f64 {
    let span = to.0 - from.0;
    if span == 0.0 {
        return 0.0;
    }
    let slope = (to.1 - from.1) / span;
    (from.1 - slope * from.0) * (to.0 / from.0).ln() + slope * span
}

#[cfg(test)]
mod tests {
    use super::*;

    fn alumina() -> HeatCapacity {
        HeatCapacity::table(vec![(300.0, 780.0), (600.0, 1080.0), (1200.0, 1260.0)])
    }

    #[test]
    fn is_linear_between_points_and_constant_outside() {
        let law = alumina();
        for (t, expected) in [
            (100.0, 780.0),
            (300.0, 780.0),
            (450.0, 930.0),
            (900.0, 1170.0),
            (2000.0, 1260.0),
        ] {
            assert!((law.at(t) - expected).abs() < 1e-12, "{t}");
        }
        for (t, expected) in [(100.0, 0.0), (450.0, 1.0), (900.0, 0.3), (2000.0, 0.0)] {
            assert!((law.slope(t) - expected).abs() < 1e-14, "{t}");
        }
        assert_eq!(HeatCapacity::constant(840.0).at(77.0), 840.0);
        assert_eq!(HeatCapacity::constant(840.0).slope(77.0), 0.0);
    }

    #[test]
    fn side_by_side_it_is_what_it_is_alone() {
        for law in [alumina(), HeatCapacity::constant(840.0)] {
            // Apart, between two points, beyond the last one and before the first one.
            for all in [
                [100.0, 300.0, 450.0, 600.0, 700.0, 1200.0, 1500.0, 299.0],
                [600.0, 601.0, 700.0, 1199.0, 800.0, 900.0, 600.0, 1000.0],
                [1200.0, 1500.0, 1201.0, 3000.0, 1e4, 1300.0, 1200.0, 1400.0],
                [1.0, 299.0, 100.0, 298.0, 150.0, 200.0, 250.0, 77.0],
            ] {
                let [capacity, enthalpy] = law.lanes(Lanes(all));
                for (k, t) in all.into_iter().enumerate() {
                    assert!((capacity[k] / law.at(t) - 1.0).abs() < 1e-14, "{t}");
                    assert!((enthalpy[k] - law.enthalpy(t)).abs() < 1e-9, "{t}");
                }
            }
        }
    }

    #[test]
    fn enthalpy_is_the_integral_by_hand_and_temperature_its_inverse() {
        let law = alumina();
        // 300 (780 + 1080)/2 = 279 000; 600 (1080 + 1260)/2 = 702 000
        assert_eq!(law.enthalpy(600.0), 279_000.0);
        assert_eq!(law.enthalpy(1200.0), 981_000.0);
        assert_eq!(law.enthalpy(1300.0), 981_000.0 + 126_000.0);
        assert_eq!(law.enthalpy(200.0), -78_000.0);
        for t in [100.0, 300.0, 300.001, 450.0, 600.0, 777.7, 1200.0, 2500.0] {
            assert!(
                (law.temperature(law.enthalpy(t)) / t - 1.0).abs() < 1e-14,
                "{t}"
            );
        }
    }

    #[test]
    fn entropy_is_the_integral_of_heat_over_temperature() {
        let law = alumina();
        // Midpoint sums of 20 000 parts in Python.
        for (t, expected) in [
            (600.0, 632.710_647),
            (1200.0, 1_436.543_109),
            (200.0, -316.262_784),
        ] {
            assert!(
                (law.entropy(t) / expected - 1.0).abs() < 1e-7,
                "{t}: {}",
                law.entropy(t)
            );
        }
        assert!(
            (HeatCapacity::constant(840.0).entropy(2.0 * REFERENCE_TEMPERATURE)
                - 840.0 * std::f64::consts::LN_2)
                .abs()
                < 1e-10
        );
    }

    #[test]
    fn the_derivative_of_enthalpy_is_the_heat_capacity() {
        let law = alumina();
        for t in [150.0, 400.0, 599.0, 601.0, 1100.0, 1500.0] {
            let slope = (law.enthalpy(t + 1e-3) - law.enthalpy(t - 1e-3)) / 2e-3;
            assert!((slope / law.at(t) - 1.0).abs() < 1e-8, "{t}");
        }
    }
}
