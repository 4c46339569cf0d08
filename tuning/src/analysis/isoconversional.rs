use calcine_physics::gas::GAS_CONSTANT;

use super::{FittedLine, SmoothedRun};
use crate::TuningError;

/// Slope of ln p(u) over u in Doyle's approximation, log p = −2.315 − 0.4567 u.
const DOYLE: f64 = 0.4567 * std::f64::consts::LN_10;

/// The energy at one conversion.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ConversionEnergy {
    /// Conversion.
    pub conversion: f64,
    /// Energy in J/mol.
    pub energy: f64,
    /// Its standard error in J/mol.
    pub error: f64,
}

/// Conversions at which energies are taken.
fn conversions() -> impl Iterator<Item = f64> {
    (2..=18).map(|k| 0.05 * f64::from(k))
}

fn energies(
    runs: &[SmoothedRun],
    method: &'static str,
    needs: &str,
    factor: f64,
    ordinate: impl Fn(&SmoothedRun, f64, f64) -> f64,
) -> Result<Vec<ConversionEnergy>, TuningError> {
    let mut found = Vec::new();
    for conversion in conversions() {
        let points = runs.iter().filter_map(|run| {
            let (temperature, rate) = run.at_conversion(conversion)?;
            let y = ordinate(run, temperature, rate);
            y.is_finite().then_some((1.0 / temperature, y))
        });
        let points: Vec<(f64, f64)> = points.collect();
        if points.len() == runs.len()
            && let Some(line) = FittedLine::through(&points)
        {
            found.push(ConversionEnergy {
                conversion,
                energy: -line.slope * GAS_CONSTANT / factor,
                error: line.slope_error * GAS_CONSTANT / factor,
            });
        }
    }
    if runs.len() < 2 || found.is_empty() {
        let cause = format!("needs two runs or more with {needs}, which reach equal conversions");
        return Err(TuningError::Analysis { method, cause });
    }
    Ok(found)
}

/// Friedman's method: ln(dα/dt) over 1/T at a conversion has the slope −E/R, whatever the law and the programme.
///
/// Source: Friedman, J. Polym. Sci. C 6 (1964) 183, doi 10.1002/polc.5070060121.
pub fn friedman(runs: &[SmoothedRun]) -> Result<Vec<ConversionEnergy>, TuningError> {
    let needs = "different heating rates or temperatures";
    energies(runs, "Friedman's method", needs, 1.0, |_, _, rate| {
        rate.ln()
    })
}

/// The method of Ozawa, Flynn and Wall: ln β over 1/T at a conversion has the slope −1.0516 E/R for constant heating rates
/// β, by Doyle's approximation, which is good to 3 % for E/(R T) from 20 to 60.
///
/// Sources: Ozawa, Bull. Chem. Soc. Jpn. 38 (1965) 1881, doi 10.1246/bcsj.38.1881; Flynn and Wall, J. Polym. Sci. B 4 (1966)
/// 323, doi 10.1002/pol.1966.110040504.
pub fn ozawa_flynn_wall(runs: &[SmoothedRun]) -> Result<Vec<ConversionEnergy>, TuningError> {
    energies(
        runs,
        "the method of Ozawa, Flynn and Wall",
        "different constant heating rates",
        DOYLE,
        |run, _, _| run.heating_rate.map_or(f64::NAN, f64::ln),
    )
}
