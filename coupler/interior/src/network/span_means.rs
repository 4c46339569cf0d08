//! Mean temperatures over a span, of particles that say what they come to at its end (docs/theory.md, THP-4).
//!
//! A particle that comes to T′ from T₀ is at T₀ + w (T′ − T₀) in the mean. With the rate x of its approach over the span, the exact
//! solution of one that stores C beside what stays as it is,
//!
//! w = 1/(1 − e⁻ˣ) − 1/x,   x = Σ G/C,
//!
//! which is ½ where it hardly moves and 1 where it comes to rest within the span. What swings against a neighbour does so at twice the
//! rate, which is counted: then no two particles cross. (1 − w) x ≤ 1 for any x, so that T′ lies between all that there is at any span.

use calcine_physics::film::bernoulli;

use crate::model::SurfaceLine;

/// How mean temperatures of particles follow from those at the end of a span.
#[derive(Debug, Default)]
pub(super) struct SpanMeans {
    /// Temperatures at the end in K.
    pub end: Vec<f64>,
    /// w.
    pub share: Vec<f64>,
    /// Conductance in W/K of each node to particles, and to what has a given temperature.
    sums: Vec<[f64; 2]>,
}

impl SpanMeans {
    /// Begins with temperatures at the start of the span in K.
    pub fn begin(&mut self, start: &[f64]) {
        self.end.clear();
        self.end.extend_from_slice(start);
        self.share.clear();
        self.share.resize(start.len(), 1.0);
    }

    /// Finds the shares, with bonds between nodes and links to reservoirs in W/K; radiosities, if any, are `shift` nodes beyond the
    /// surfaces.
    pub fn weigh(
        &mut self,
        lines: &[SurfaceLine],
        bonds: &[([usize; 2], f64)],
        links: &[([usize; 2], f64)],
        shift: usize,
    ) {
        let count = lines.len();
        self.sums.clear();
        self.sums.resize(count + shift, [0.0; 2]);
        // A surface and its own radiosity are one particle.
        let own = |[i, j]: [usize; 2]| shift > 0 && j == i + shift;
        let stays = |node: usize| {
            let line = lines.get(node);
            line.is_some_and(|line| line.conductance.is_infinite())
        };
        for &([i, j], g) in bonds.iter().filter(|(nodes, _)| !own(*nodes)) {
            self.sums[i][usize::from(stays(j))] += g;
            self.sums[j][usize::from(stays(i))] += g;
        }
        for &([node, _], g) in links {
            self.sums[node][1] += g;
        }
        let twice = |[pairs, others]: [f64; 2]| 2.0 * pairs + others;
        for row in 0..count {
            self.share[row] = twice(self.sums[row]);
        }
        for &([i, j], g) in bonds.iter().filter(|(nodes, _)| own(*nodes)) {
            let [pairs, others] = self.sums[j];
            let all = g + pairs + others;
            if all > 0.0 {
                self.share[i] += g / all * twice(self.sums[j]);
            }
        }
        for (share, line) in self.share.iter_mut().zip(lines) {
            let all = *share + line.conductance - line.stored;
            *share = match line.stored > 0.0 {
                true => mean_share(all / line.stored),
                false => 1.0,
            };
        }
    }

    /// Lines over mean temperatures, of particles that had these temperatures in K at the start.
    pub fn lines(&self, of: &[SurfaceLine], start: &[f64]) -> impl Iterator<Item = SurfaceLine> {
        let all = of.iter().zip(&self.share).zip(start);
        all.map(|((line, &share), from)| match share {
            1.0 => *line,
            _ => SurfaceLine {
                conductance: line.conductance / share,
                temperature: from + share * (line.temperature - from),
                stored: 0.0,
            },
        })
    }

    /// Takes mean temperatures in K of the particles, the first of all nodes.
    pub fn advance(&mut self, start: &[f64], mean: &[f64]) {
        let all = self.end.iter_mut().zip(mean).zip(start).zip(&self.share);
        for (((end, mean), from), share) in all {
            *end = match *share {
                1.0 => *mean,
                share => from + (mean - from) / share,
            };
        }
    }
}

/// w of a rate times the span.
fn mean_share(x: f64) -> f64 {
    // 1/(1 − e⁻ˣ) − 1/x = 1 − (1 − B(x))/x with B(x) = x/(eˣ − 1); of small x its series.
    if x > LARGE {
        1.0 - 1.0 / x
    } else if x < SMALL {
        0.5 + x / 12.0 * (1.0 - x * x / 60.0)
    } else {
        1.0 - (1.0 - bernoulli(x)) / x
    }
}

/// x below which the series holds to round-off.
const SMALL: f64 = 1e-2;
/// x above which nothing is left of e⁻ˣ.
const LARGE: f64 = 700.0;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_mean_is_half_way_of_a_slow_approach_and_its_end_of_a_fast_one() {
        assert_eq!(mean_share(0.0), 0.5);
        assert_eq!(mean_share(f64::INFINITY), 1.0);
        // 1/(1 − e⁻²) − 1/2.
        assert!((mean_share(2.0) - 0.656_517_642_749_665_6).abs() < 1e-15);
        let [below, above] = [1.0 - 1e-12, 1.0 + 1e-12].map(|by| mean_share(by * SMALL));
        assert!((above - below).abs() < 1e-13, "{below} {above}");
        for x in [1e-3, 0.1, 1.0, 3.0, 10.0, 1e3, 1e8] {
            assert!((1.0 - mean_share(x)) * x <= 1.0 + 1e-12 * x, "{x}");
        }
    }
}
