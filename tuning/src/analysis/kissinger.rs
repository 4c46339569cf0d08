use calcine_physics::gas::GAS_CONSTANT;

use super::{FittedLine, SmoothedRun};
use crate::TuningError;

/// What Kissinger's method gives.
#[derive(Clone, Debug, PartialEq)]
pub struct KissingerResult {
    /// Energy in J/mol.
    pub energy: f64,
    /// Its standard error in J/mol.
    pub energy_error: f64,
    /// Pre-exponential factor of first order in 1/s.
    pub pre_exponential: f64,
    /// Heating rates in K/s with the temperatures of the largest rate in K.
    pub peaks: Vec<(f64, f64)>,
}

/// Kissinger's method: ln(β/T_p²) over 1/T_p has the slope −E/R and, for first order, the intercept ln(A R/E).
///
/// Source: Kissinger, Anal. Chem. 29 (1957) 1702, doi 10.1021/ac60131a045.
pub fn kissinger(runs: &[SmoothedRun]) -> Result<KissingerResult, TuningError> {
    let peaks: Vec<(f64, f64)> = runs
        .iter()
        .filter_map(|run| Some((run.heating_rate?, run.peak_temperature()?)))
        .filter(|(rate, _)| *rate > 0.0)
        .collect();
    let points: Vec<(f64, f64)> = peaks
        .iter()
        .map(|(rate, peak)| (1.0 / peak, (rate / (peak * peak)).ln()))
        .collect();
    let line = FittedLine::through(&points).filter(|line| line.slope < 0.0);
    let line = line.ok_or_else(|| TuningError::Analysis {
        method: "Kissinger's method",
        cause: "needs two constant heating rates or more, at which the peak moves up with the rate"
            .into(),
    })?;
    let energy = -line.slope * GAS_CONSTANT;
    Ok(KissingerResult {
        energy,
        energy_error: line.slope_error * GAS_CONSTANT,
        pre_exponential: line.intercept.exp() * energy / GAS_CONSTANT,
        peaks,
    })
}

/// Temperature in K of the largest rate of a reaction of first order, without any lag of the sample: where
/// E β/(R T²) = A exp(−E/(R T)), β the heating rate in K/s, A in 1/s, E in J/mol.
pub fn kissinger_temperature(factor: f64, energy: f64, rate: f64) -> f64 {
    let theta = energy / GAS_CONSTANT;
    // u − ln(u²) with u = θ/T: u = ln(A θ/β) − 2 ln u, a contraction for u > 2; Newton's iteration.
    let constant = (factor * theta / rate).ln();
    let mut u = constant.max(3.0);
    for _ in 0..50 {
        let next = u - (u + 2.0 * u.ln() - constant) / (1.0 + 2.0 / u);
        if (next - u).abs() <= 1e-14 * u {
            return theta / next;
        }
        u = next;
    }
    theta / u
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn peak_temperatures_of_calcination_are_those_of_the_requirements() {
        // Requirements LMP: no lag, first order, A 1.235e15 1/s, E 325.1 kJ/mol.
        for (rate, expected) in [
            (3.0, 682.92),
            (6.0, 698.61),
            (9.0, 708.03),
            (12.0, 714.82),
            (15.0, 720.15),
        ] {
            let found = kissinger_temperature(1.235e15, 325.1e3, rate / 60.0) - 273.15;
            assert!((found - expected).abs() < 0.006, "{rate}: {found}");
        }
    }
}
