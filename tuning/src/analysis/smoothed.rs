use crate::least_squares::cholesky_solve;
use crate::target::TargetCurve;

/// Share of the time between conversions of 5 and 95 % over which points are smoothed, half to each side.
const WINDOW: f64 = 0.15;
/// Temperatures that leave a line by more than this share of their rise have no constant heating rate.
const LINE: f64 = 0.1;
/// Points within the window at least.
const LEAST_POINTS: usize = 9;

/// A run as conversion and its rate, smoothed by local parabolas: the noise of a measured curve would drown its derivative.
///
/// Source: Savitzky and Golay, Anal. Chem. 36 (1964) 1627, doi 10.1021/ac60214a047, here with weights (1 − u²) of distance
/// and any spacing of points.
#[derive(Clone, Debug, PartialEq)]
pub struct SmoothedRun {
    /// Name of the curve.
    pub name: String,
    /// Heating rate in K/s, where it is constant while the sample reacts.
    pub heating_rate: Option<f64>,
    /// Temperatures in K.
    pub temperature: Vec<f64>,
    /// Conversions.
    pub conversion: Vec<f64>,
    /// dα/dt in 1/s.
    pub rate: Vec<f64>,
}

impl SmoothedRun {
    /// Of a curve with a mass that falls, and the loss at a conversion of one, which all curves of an analysis share: equal
    /// conversions of them are equal states, whether a curve runs to completion or not. `None` where it has too few points, or
    /// does not reach a conversion of 5 %.
    pub fn of(target: &TargetCurve, loss: f64) -> Option<Self> {
        let raw = target.conversion(loss)?;
        let times = &target.run.times;
        let first = |limit: f64| raw.iter().position(|&x| x >= limit);
        let (from, to) = (first(0.05)?, first(0.95).unwrap_or(raw.len() - 1));
        let half = 0.5 * WINDOW * (times[to] - times[from]);
        let (mut conversion, mut rate) = (Vec::new(), Vec::new());
        let mut start = 0;
        for &time in times {
            while times[start] < time - half {
                start += 1;
            }
            let end = times.partition_point(|&one| one <= time + half);
            let (start, end) = widened(start, end, times.len());
            let reach = (time - times[start]).max(times[end - 1] - time).max(half);
            let points = times[start..end].iter().zip(&raw[start..end]);
            let points = points.map(|(t, y)| ((t - time) / (1.001 * reach), *y));
            let [value, slope] = parabola(points)?;
            conversion.push(value);
            rate.push(slope / (1.001 * reach));
        }
        let temperature = match target.of(crate::target::ComparedQuantity::Temperature) {
            Some(measured) => measured.to_vec(),
            None => times
                .iter()
                .map(|&t| target.run.programme.at(t).0)
                .collect(),
        };
        Some(Self {
            name: target.name.clone(),
            heating_rate: constant_slope(&times[from..=to], &temperature[from..=to]),
            temperature,
            conversion,
            rate,
        })
    }

    /// Temperature and rate at a conversion, where the curve passes it first.
    pub fn at_conversion(&self, conversion: f64) -> Option<(f64, f64)> {
        let next = self.conversion.iter().position(|&x| x >= conversion)?;
        let before = next.checked_sub(1)?;
        let (a, b) = (self.conversion[before], self.conversion[next]);
        let share = (conversion - a) / (b - a);
        let between = |list: &[f64]| list[before] + share * (list[next] - list[before]);
        Some((between(&self.temperature), between(&self.rate)))
    }

    /// Temperature at the largest rate, by a parabola through all points above nine tenths of it.
    pub fn peak_temperature(&self) -> Option<f64> {
        let top = self.rate.iter().enumerate();
        let top = top.max_by(|a, b| a.1.total_cmp(b.1))?.0;
        let high = |k: usize| self.rate[k] > 0.9 * self.rate[top];
        let from = (0..top)
            .rev()
            .take_while(|&k| high(k))
            .last()
            .unwrap_or(top);
        let to = (top..self.rate.len()).take_while(|&k| high(k)).last()?;
        let reach = (self.temperature[to] - self.temperature[from]).abs();
        if to < from + 3 || reach == 0.0 {
            return Some(self.temperature[top]);
        }
        let centre = self.temperature[top];
        let points = (from..=to).map(|k| ((self.temperature[k] - centre) / reach, self.rate[k]));
        let [_, slope, bend] = plain_parabola(points)?;
        // The vertex, where the parabola opens downwards and within its points.
        let vertex = -0.5 * slope / bend;
        let sound = bend < 0.0 && vertex.abs() <= 1.0;
        Some(if sound {
            centre + reach * vertex
        } else {
            centre
        })
    }
}

/// Slope of y over x, where y rises along a line.
fn constant_slope(x: &[f64], y: &[f64]) -> Option<f64> {
    let points: Vec<(f64, f64)> = x.iter().copied().zip(y.iter().copied()).collect();
    let line = super::FittedLine::through(&points)?;
    let rise = line.slope * (x[x.len() - 1] - x[0]);
    let off = points
        .iter()
        .map(|(x, y)| (y - line.intercept - line.slope * x).abs());
    (off.fold(0.0, f64::max) < LINE * rise).then_some(line.slope)
}

fn widened(mut start: usize, mut end: usize, count: usize) -> (usize, usize) {
    while end - start < LEAST_POINTS.min(count) {
        start = start.saturating_sub(1);
        end = (end + 1).min(count);
    }
    (start, end)
}

/// Value and slope at u = 0 of a parabola through points within −1 to 1, with weights 1 − u².
fn parabola(points: impl Iterator<Item = (f64, f64)>) -> Option<[f64; 2]> {
    let [value, slope, _] = weighted(points, |u| 1.0 - u * u)?;
    Some([value, slope])
}

fn plain_parabola(points: impl Iterator<Item = (f64, f64)>) -> Option<[f64; 3]> {
    weighted(points, |_| 1.0)
}

/// Coefficients of 1, u, u² by weighted least squares.
fn weighted(
    points: impl Iterator<Item = (f64, f64)>,
    weight: impl Fn(f64) -> f64,
) -> Option<[f64; 3]> {
    let (mut matrix, mut right) = ([0.0; 9], [0.0; 3]);
    for (u, y) in points {
        let w = weight(u);
        let powers = [1.0, u, u * u];
        for row in 0..3 {
            right[row] += w * powers[row] * y;
            for column in 0..3 {
                matrix[3 * row + column] += w * powers[row] * powers[column];
            }
        }
    }
    let solution = cholesky_solve(&mut matrix, &right)?;
    Some([solution[0], solution[1], solution[2]])
}
