/// A straight line through points, by least squares.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FittedLine {
    /// Slope.
    pub slope: f64,
    /// Value at x = 0.
    pub intercept: f64,
    /// Standard error of the slope; zero where two points leave none.
    pub slope_error: f64,
}

impl FittedLine {
    /// Through two points or more whose x differ; `None` otherwise.
    pub fn through(points: &[(f64, f64)]) -> Option<Self> {
        let n = points.len() as f64;
        let x = points.iter().map(|p| p.0).sum::<f64>() / n;
        let y = points.iter().map(|p| p.1).sum::<f64>() / n;
        let xx: f64 = points.iter().map(|p| (p.0 - x).powi(2)).sum();
        let xy: f64 = points.iter().map(|p| (p.0 - x) * (p.1 - y)).sum();
        if points.len() < 2 || xx.is_nan() || xx <= 0.0 {
            return None;
        }
        let slope = xy / xx;
        let left: f64 = points
            .iter()
            .map(|p| (p.1 - y - slope * (p.0 - x)).powi(2))
            .sum();
        let slope_error = match points.len() {
            2 => 0.0,
            _ => (left / (n - 2.0) / xx).sqrt(),
        };
        Some(Self {
            slope,
            intercept: y - slope * x,
            slope_error,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_and_its_error_are_those_of_a_hand_calculation() {
        let line = FittedLine::through(&[(0.0, 1.0), (1.0, 2.0), (2.0, 5.0)]).unwrap();
        // Slope 4/2, differences 1/3, −2/3, 1/3: √(6/9/2).
        assert_eq!(line.slope, 2.0);
        assert!((line.intercept - 2.0 / 3.0).abs() < 1e-15);
        assert!((line.slope_error - (1.0f64 / 3.0).sqrt()).abs() < 1e-12);
        assert!(FittedLine::through(&[(1.0, 1.0), (1.0, 2.0)]).is_none());
    }
}
