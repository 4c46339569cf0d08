//! Parameters that are tuned, within their bounds.

use calcine_physics::dimension::Dimension;

use crate::TuningError;

/// A number that is tuned, with its bounds.
#[derive(Clone, Debug, PartialEq)]
pub struct TunedParameter {
    /// Its name.
    pub name: String,
    /// Its dimension.
    pub dimension: Dimension,
    /// Lower bound in SI.
    pub low: f64,
    /// Upper bound in SI.
    pub high: f64,
    /// True: searched by its logarithm.
    pub logarithmic: bool,
}

/// All numbers that are tuned: values in SI on one side, places from zero to one between the bounds on the other.
#[derive(Clone, Debug, PartialEq)]
pub struct ParameterSpace {
    parameters: Vec<TunedParameter>,
}

impl ParameterSpace {
    /// Refuses bounds that are crossed, not finite, or not positive where a logarithm is taken.
    pub fn new(parameters: Vec<TunedParameter>) -> Result<Self, TuningError> {
        for one in &parameters {
            let wrong = |remedy| {
                Err(TuningError::Bounds {
                    name: one.name.clone(),
                    low: one.low,
                    high: one.high,
                    remedy,
                })
            };
            if !(one.low.is_finite() && one.high.is_finite()) {
                return wrong("give finite bounds");
            }
            if one.low >= one.high {
                return wrong("the lower one must be below the upper one");
            }
            if one.logarithmic && one.low <= 0.0 {
                return wrong("a logarithm needs bounds above zero");
            }
        }
        Ok(Self { parameters })
    }

    /// The parameters.
    pub fn parameters(&self) -> &[TunedParameter] {
        &self.parameters
    }

    /// How many they are.
    pub fn len(&self) -> usize {
        self.parameters.len()
    }

    /// True where nothing is tuned.
    pub fn is_empty(&self) -> bool {
        self.parameters.is_empty()
    }

    /// Value in SI of a parameter at a place.
    pub fn value(&self, parameter: usize, place: f64) -> f64 {
        let one = &self.parameters[parameter];
        match place {
            // Bounds come back as they are.
            0.0 => one.low,
            1.0 => one.high,
            _ if one.logarithmic => one.low * (one.high / one.low).powf(place),
            _ => one.low + place * (one.high - one.low),
        }
    }

    /// Values in SI at places.
    pub fn values(&self, places: &[f64]) -> Vec<f64> {
        let places = places.iter().enumerate();
        places.map(|(k, &place)| self.value(k, place)).collect()
    }

    /// Place of a value in SI, cut off at the bounds.
    pub fn place(&self, parameter: usize, value: f64) -> f64 {
        let one = &self.parameters[parameter];
        let place = match one.logarithmic {
            true => (value / one.low).ln() / (one.high / one.low).ln(),
            false => (value - one.low) / (one.high - one.low),
        };
        place.clamp(0.0, 1.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parameter(low: f64, high: f64, logarithmic: bool) -> TunedParameter {
        TunedParameter {
            name: "k".into(),
            dimension: Dimension::NONE,
            low,
            high,
            logarithmic,
        }
    }

    #[test]
    fn places_and_values_are_inverse_and_ends_are_exact() {
        let space = ParameterSpace::new(vec![
            parameter(50.0, 150.0, false),
            parameter(1e3, 1e17, true),
        ]);
        let space = space.unwrap();
        assert_eq!(space.values(&[0.0, 1.0]), [50.0, 1e17]);
        assert_eq!(space.value(0, 0.25), 75.0);
        assert!((space.value(1, 0.5) / 1e10 - 1.0).abs() < 1e-12);
        for place in [0.1, 0.7] {
            for k in [0, 1] {
                assert!((space.place(k, space.value(k, place)) - place).abs() < 1e-14);
            }
        }
    }

    #[test]
    fn bounds_that_are_none_are_refused() {
        for (low, high, logarithmic) in [
            (2.0, 1.0, false),
            (1.0, 1.0, false),
            (0.0, 1.0, true),
            (0.0, f64::INFINITY, false),
        ] {
            assert!(ParameterSpace::new(vec![parameter(low, high, logarithmic)]).is_err());
        }
    }
}
