//! Tear streams as functions of time.

use calcine_numerics::Anderson;

/// Nodes of a window.
pub const NODES: usize = 6;

/// How an iteration of tear streams is accelerated.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum TearAcceleration {
    /// Anderson's method over all tear streams and nodes together.
    Anderson,
    /// Wegstein's secant of every number for itself, with q not below a limit (Dyssol's is −0.5).
    ///
    /// Source: Wegstein, Commun. ACM 1 (1958) 9, doi 10.1145/368861.368871.
    Wegstein(f64),
}

/// Windows of waveform relaxation. The numbers are Dyssol's.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WaveformSettings {
    /// First, shortest and longest window in s.
    pub first: f64,
    /// Shortest window in s.
    pub shortest: f64,
    /// Longest window in s.
    pub longest: f64,
    /// Factor by which windows grow and shrink.
    pub change: f64,
    /// Windows of at most so many iterations are followed by a longer one.
    pub few: usize,
    /// Windows of more iterations are followed by a shorter one, which is not shorter than the first for that.
    pub many: usize,
    /// Most iterations of a window.
    pub most: usize,
    /// TearAcceleration.
    pub acceleration: TearAcceleration,
}

impl Default for WaveformSettings {
    fn default() -> Self {
        Self {
            first: 1.0,
            shortest: 1e-9,
            longest: 1000.0,
            change: 1.2,
            few: 12,
            many: 40,
            most: 500,
            acceleration: TearAcceleration::Anderson,
        }
    }
}

/// Tear streams over a window: polynomials through Chebyshev's nodes.
#[derive(Clone, Debug)]
pub struct Waveform {
    from: f64,
    span: f64,
    /// All tear streams at each node.
    pub values: Vec<Vec<f64>>,
}

impl Waveform {
    /// The same values at all nodes.
    pub fn constant(from: f64, span: f64, values: &[f64]) -> Self {
        Self {
            from,
            span,
            values: vec![values.to_vec(); NODES],
        }
    }

    /// Place of a node in the window, 0 to 1: the first and the last are its ends.
    pub fn node(k: usize) -> f64 {
        let angle = std::f64::consts::PI * k as f64 / (NODES - 1) as f64;
        0.5 * (1.0 - angle.cos())
    }

    /// All tear streams at a time in s, by the barycentric formula.
    ///
    /// Source: Berrut and Trefethen, SIAM Rev. 46 (2004) 501, doi 10.1137/S0036144502417715.
    pub fn at(&self, time: f64, out: &mut Vec<f64>) {
        out.clear();
        let x = (time - self.from) / self.span;
        if let Some(k) = (0..NODES).find(|k| Self::node(*k) == x) {
            out.extend_from_slice(&self.values[k]);
            return;
        }
        out.resize(self.values[0].len(), 0.0);
        let mut sum = 0.0;
        for (k, values) in self.values.iter().enumerate() {
            let sign = if k % 2 == 0 { 1.0 } else { -1.0 };
            let half = if k == 0 || k == NODES - 1 { 0.5 } else { 1.0 };
            let weight = sign * half / (x - Self::node(k));
            sum += weight;
            out.iter_mut()
                .zip(values)
                .for_each(|(o, v)| *o += weight * v);
        }
        out.iter_mut().for_each(|o| *o /= sum);
    }
}

/// What makes the next iterate of all nodes.
#[derive(Clone, Debug)]
pub struct NodeIteration {
    anderson: Anderson,
    /// Iterate and what it became, the time before.
    last: Option<[Vec<f64>; 2]>,
}

impl NodeIteration {
    /// A new iteration.
    pub fn new() -> Self {
        Self {
            anderson: Anderson::default(),
            last: None,
        }
    }

    /// The next iterate in place of what the iteration made of `x`.
    pub fn accelerate(&mut self, by: TearAcceleration, x: &[f64], made: &mut [f64]) {
        let TearAcceleration::Wegstein(limit) = by else {
            self.anderson.accelerate(x, made);
            return;
        };
        let now = [x.to_vec(), made.to_vec()];
        if let Some([before, became]) = self.last.replace(now) {
            for (k, value) in made.iter_mut().enumerate() {
                let moved = x[k] - before[k];
                let slope = (*value - became[k]) / moved;
                if moved != 0.0 && slope != 1.0 && slope.is_finite() {
                    let q = (slope / (slope - 1.0)).clamp(limit, 0.0);
                    *value = q * x[k] + (1.0 - q) * *value;
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_polynomial_of_the_nodes_degree_is_kept() {
        let f = |t: f64| 1.0 + t - 0.3 * t.powi(3) + 0.01 * t.powi(5);
        let mut wave = Waveform::constant(2.0, 3.0, &[0.0]);
        for k in 0..NODES {
            wave.values[k][0] = f(2.0 + 3.0 * Waveform::node(k));
        }
        let mut out = Vec::new();
        for t in [2.0, 2.4, 3.7, 5.0] {
            wave.at(t, &mut out);
            assert!((out[0] - f(t)).abs() < 1e-13, "{t}: {} {}", out[0], f(t));
        }
    }

    #[test]
    fn wegstein_solves_a_line_in_two_steps() {
        let map = |x: f64| 3.0 - 0.4 * x;
        let mut iteration = NodeIteration::new();
        let mut x = [0.0];
        for _ in 0..2 {
            let mut made = [map(x[0])];
            iteration.accelerate(TearAcceleration::Wegstein(-5.0), &x, &mut made);
            x = made;
        }
        // The slope is −0.4, q = 0.4/1.4 above zero: not allowed, so that the iteration is the plain one.
        assert!((x[0] - map(map(0.0))).abs() < 1e-15);
        let map = |x: f64| 3.0 + 0.4 * x;
        let mut iteration = NodeIteration::new();
        let mut x = [0.0];
        for _ in 0..2 {
            let mut made = [map(x[0])];
            iteration.accelerate(TearAcceleration::Wegstein(-5.0), &x, &mut made);
            x = made;
        }
        assert!((x[0] - 5.0).abs() < 1e-14, "{}", x[0]);
    }
}
