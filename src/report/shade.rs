//! What colours the pictures of bed and gas: one quantity and one range for all of them.

use super::colour::Range;
use crate::results::read::{Array, Arrays};

/// What colours particles.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Shade {
    /// Their temperature, with that of the gas.
    Temperature,
    /// Their speed, where all have one temperature and the snapshots hold velocities.
    Speed,
}

impl Shade {
    /// That of snapshots: the temperature, unless it is the same everywhere.
    pub fn of<'a>(all: impl Iterator<Item = (&'a Arrays, &'a Arrays)>) -> Self {
        let mut speeds = false;
        let mut values = Vec::new();
        for (gas, particles) in all {
            speeds |= particles.contains_key("velocity");
            for arrays in [gas, particles] {
                let range = Range::of(temperature(arrays).iter().copied());
                values.extend(range.into_iter().flat_map(|range| [range.low, range.high]));
            }
        }
        // Half a thousandth of a kelvin is what the gas solver's tolerance leaves.
        match Range::of(values.into_iter()) {
            Some(range) if range.high - range.low >= 5e-4 => Self::Temperature,
            _ if speeds => Self::Speed,
            _ => Self::Temperature,
        }
    }

    /// Values of particles.
    pub fn particles(self, arrays: &Arrays) -> Vec<f64> {
        match self {
            Self::Temperature => temperature(arrays).to_vec(),
            Self::Speed => arrays.get("velocity").map_or(Vec::new(), |velocity| {
                let vectors = velocity.values.chunks_exact(3);
                vectors
                    .map(|v| v.iter().map(|x| x * x).sum::<f64>().sqrt())
                    .collect()
            }),
        }
    }

    /// Values of gas cells; none where they are not shown.
    pub fn gas(self, arrays: &Arrays) -> &[f64] {
        match self {
            Self::Temperature => temperature(arrays),
            Self::Speed => &[],
        }
    }

    /// Name of the column of particles.
    pub fn column(self) -> &'static str {
        match self {
            Self::Temperature => "temperature",
            Self::Speed => "speed",
        }
    }

    /// Label of the colour bar.
    pub fn label(self) -> &'static str {
        match self {
            Self::Temperature => "T in K",
            Self::Speed => "v in m/s",
        }
    }
}

fn temperature(arrays: &Arrays) -> &[f64] {
    match arrays.get("temperature") {
        Some(Array {
            components: 1,
            values,
        }) => values,
        _ => &[],
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn arrays(entries: &[(&str, usize, &[f64])]) -> Arrays {
        let entry = |&(name, components, values): &(&str, usize, &[f64])| {
            let values = values.to_vec();
            (name.to_owned(), Array { components, values })
        };
        entries.iter().map(entry).collect()
    }

    #[test]
    fn particles_of_one_temperature_are_coloured_by_their_speed() {
        let cold = arrays(&[("temperature", 1, &[300.0, 300.0])]);
        let bed = arrays(&[
            ("temperature", 1, &[300.0, 300.0]),
            ("velocity", 3, &[0.0, 3.0, 4.0, 0.0, 0.0, 1.0]),
        ]);
        let shade = Shade::of([(&cold, &bed)].into_iter());
        assert_eq!(shade, Shade::Speed);
        assert_eq!(shade.particles(&bed), [5.0, 1.0]);
        let bare = arrays(&[("velocity", 3, &[1.0, 0.0, 0.0])]);
        assert_eq!(Shade::of([(&bare, &bare)].into_iter()), Shade::Speed);
        assert!(shade.gas(&cold).is_empty());
        let warm = arrays(&[("temperature", 1, &[300.0, 301.0])]);
        assert_eq!(Shade::of([(&warm, &bed)].into_iter()), Shade::Temperature);
        // Without velocities there is nothing else to show.
        assert_eq!(Shade::of([(&cold, &cold)].into_iter()), Shade::Temperature);
    }
}
