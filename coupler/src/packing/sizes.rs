//! Distributions of diameters.

use super::error::{PackingError, positive};
use super::random::SplitMix64;

/// Diameters of the spheres.
#[derive(Clone, Debug, PartialEq)]
pub enum Sizes {
    /// One diameter in m.
    Equal(f64),
    /// Diameters in m, each with its share.
    Mixture {
        /// Diameter in m and share; shares are scaled to sum to 1.
        parts: Vec<(f64, f64)>,
        /// What the shares are of.
        share: Share,
    },
    /// A distribution, cut off at both ends.
    Range {
        /// Density of the distribution.
        shape: Shape,
        /// Smallest diameter in m.
        min: f64,
        /// Largest diameter in m.
        max: f64,
        /// What the distribution is of.
        share: Share,
    },
}

/// Densities over the diameter d, up to a factor.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Shape {
    /// The same everywhere.
    Uniform,
    /// exp(−(d − mean)²/(2 deviation²)).
    Normal {
        /// Mean in m, before it is cut off.
        mean: f64,
        /// Standard deviation in m, before it is cut off.
        deviation: f64,
    },
    /// exp(−(ln(d/median)/ln deviation)²/2)/d.
    LogNormal {
        /// Median in m, before it is cut off.
        median: f64,
        /// Geometric standard deviation, above 1.
        deviation: f64,
    },
}

/// What a distribution of sizes is of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Share {
    /// Of the number of spheres.
    Number,
    /// Of their mass, all of one density.
    Mass,
}

/// Intervals by which a density is tabulated.
const INTERVALS: usize = 2048;

impl Sizes {
    /// So many diameters in m. Equal seeds give equal lists; a longer list begins with a shorter one.
    pub fn sample(&self, count: usize, seed: u64) -> Result<Vec<f64>, PackingError> {
        let mut sampler = self.sampler(seed)?;
        Ok((0..count).map(|_| sampler.draw()).collect())
    }

    /// Largest diameter in m.
    pub fn largest(&self) -> f64 {
        match self {
            Self::Equal(diameter) => *diameter,
            Self::Mixture { parts, .. } => parts.iter().map(|part| part.0).fold(0.0, f64::max),
            Self::Range { max, .. } => *max,
        }
    }

    /// Smallest diameter in m.
    pub fn smallest(&self) -> f64 {
        match self {
            Self::Equal(diameter) => *diameter,
            Self::Mixture { parts, .. } => {
                let diameters = parts.iter().map(|part| part.0);
                diameters.fold(f64::INFINITY, f64::min)
            }
            Self::Range { min, .. } => *min,
        }
    }

    /// Mean diameter in m, by number.
    pub fn mean(&self) -> Result<f64, PackingError> {
        let sampler = self.sampler(0)?;
        let mut below = 0.0;
        let mut sum = 0.0;
        for (node, &upper) in sampler.nodes.iter().zip(&sampler.cumulative) {
            sum += (upper - below) * 0.5 * (node.0 + node.1);
            below = upper;
        }
        Ok(sum / below)
    }

    pub(super) fn sampler(&self, seed: u64) -> Result<Sampler, PackingError> {
        let by_number = |diameter: f64, share: Share| match share {
            Share::Number => 1.0,
            Share::Mass => diameter.powi(-3),
        };
        let mut sampler = Sampler {
            nodes: Vec::new(),
            cumulative: Vec::new(),
            random: SplitMix64(seed),
        };
        match self {
            Self::Equal(diameter) => {
                positive("diameter", *diameter)?;
                sampler.add(*diameter, *diameter, 1.0);
            }
            Self::Mixture { parts, share } => {
                positive("number of diameters", parts.len() as f64)?;
                // Relative to the largest, so that no power of a small length underflows.
                let largest = self.largest();
                for &(diameter, part) in parts {
                    positive("diameter", diameter)?;
                    positive("share of a diameter", part)?;
                    let weight = part * by_number(diameter / largest, *share);
                    sampler.add(diameter, diameter, weight);
                }
            }
            Self::Range {
                shape,
                min,
                max,
                share,
            } => {
                positive("smallest diameter", *min)?;
                positive("range of diameters", max - min)?;
                shape.check(*min, *max)?;
                let at = |i: f64| min + (max - min) * i / INTERVALS as f64;
                let density = |i: f64| shape.density(at(i)) * by_number(at(i) / max, *share);
                for i in (0..INTERVALS).map(|i| i as f64) {
                    // Simpson's rule.
                    let weight = density(i) + 4.0 * density(i + 0.5) + density(i + 1.0);
                    sampler.add(at(i), at(i + 1.0), weight);
                }
            }
        }
        let total = sampler.cumulative.last().copied().unwrap_or(0.0);
        positive("sum of the shares of all diameters", total)?;
        Ok(sampler)
    }
}

impl Shape {
    fn check(&self, min: f64, max: f64) -> Result<(), PackingError> {
        let (what, middle) = match *self {
            Self::Uniform => return Ok(()),
            Self::Normal { mean, deviation } => {
                positive("standard deviation of the diameters", deviation)?;
                ("mean diameter", mean)
            }
            Self::LogNormal { median, deviation } => {
                positive("geometric standard deviation, less 1", deviation - 1.0)?;
                ("median diameter", median)
            }
        };
        if (min..=max).contains(&middle) {
            return Ok(());
        }
        Err(PackingError::Value {
            what,
            value: middle,
            need: "a value between the smallest and the largest",
        })
    }

    fn density(&self, diameter: f64) -> f64 {
        match *self {
            Self::Uniform => 1.0,
            Self::Normal { mean, deviation } => {
                (-0.5 * ((diameter - mean) / deviation).powi(2)).exp()
            }
            Self::LogNormal { median, deviation } => {
                let off = (diameter / median).ln() / deviation.ln();
                // Relative to the median, so that it is a plain number.
                (-0.5 * off * off).exp() * median / diameter
            }
        }
    }
}

/// Draws diameters by the inverse of their cumulative distribution.
pub(super) struct Sampler {
    /// Ends of each interval in m; equal for a single diameter.
    nodes: Vec<(f64, f64)>,
    /// Weight up to and with each interval.
    cumulative: Vec<f64>,
    random: SplitMix64,
}

impl Sampler {
    fn add(&mut self, low: f64, high: f64, weight: f64) {
        let before = self.cumulative.last().copied().unwrap_or(0.0);
        self.nodes.push((low, high));
        self.cumulative.push(before + weight);
    }

    /// A diameter in m.
    pub fn draw(&mut self) -> f64 {
        let (Some(total), Some(last)) = (self.cumulative.last(), self.nodes.last()) else {
            return 0.0;
        };
        if self.nodes.len() == 1 {
            return last.0;
        }
        let wanted = total * self.random.unit();
        let place = self.cumulative.partition_point(|&upper| upper <= wanted);
        let Some(&(low, high)) = self.nodes.get(place) else {
            return last.1;
        };
        if low == high {
            return low;
        }
        let before = if place == 0 {
            0.0
        } else {
            self.cumulative[place - 1]
        };
        let within = (wanted - before) / (self.cumulative[place] - before);
        low + (high - low) * within
    }
}
