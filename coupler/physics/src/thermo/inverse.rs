//! Temperature from an enthalpy.

use super::ThermoError;

/// Most steps that are taken; the bracket halves at least in every second of them.
const MOST_STEPS: usize = 200;
/// Relative step at which Newton's method has converged: the next would be its square.
const CONVERGED: f64 = 1e-9;

/// Temperature in K within `bounds` at which `enthalpy_and_capacity` (of T) gives the enthalpy,
/// in `unit`, by Newton's method from `guess`, bisecting where it would leave the bracket.
///
/// c_p > 0, so that h rises and has one root at most. The bounds are evaluated only if a step wants to
/// pass them.
pub fn temperature(
    enthalpy: f64,
    unit: &'static str,
    bounds: (f64, f64),
    guess: f64,
    enthalpy_and_capacity: impl Fn(f64) -> (f64, f64),
) -> Result<f64, ThermoError> {
    let (mut low, mut high) = bounds;
    let refuse = || ThermoError::EnthalpyOutOfRange {
        enthalpy,
        unit,
        lowest: bounds.0,
        highest: bounds.1,
        least: enthalpy_and_capacity(bounds.0).0,
        most: enthalpy_and_capacity(bounds.1).0,
    };
    if !enthalpy.is_finite() {
        return Err(refuse());
    }
    let inside = guess >= low && guess <= high;
    let mut t = if inside { guess } else { 0.5 * (low + high) };
    for _ in 0..MOST_STEPS {
        let (h, c_p) = enthalpy_and_capacity(t);
        if h > enthalpy {
            high = t;
        } else {
            low = t;
        }
        let next = t - (h - enthalpy) / c_p;
        let too_low = next < bounds.0 && enthalpy_and_capacity(bounds.0).0 > enthalpy;
        let too_high = next > bounds.1 && enthalpy_and_capacity(bounds.1).0 < enthalpy;
        if too_low || too_high {
            return Err(refuse());
        }
        if next >= low && next <= high && (next - t).abs() <= CONVERGED * t {
            return Ok(next);
        }
        if high - low <= f64::EPSILON * high {
            // A step of the fit, some 1e-8 of h, lies between the two.
            return Ok(low);
        }
        t = if next > low && next < high {
            next
        } else {
            0.5 * (low + high)
        };
    }
    Err(refuse())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// h = T + T²/1000.
    fn parabola(t: f64) -> (f64, f64) {
        (t + t * t / 1000.0, 1.0 + t / 500.0)
    }

    fn solve(enthalpy: f64, guess: f64) -> Result<f64, ThermoError> {
        temperature(enthalpy, "J/kg", (200.0, 3000.0), guess, parabola)
    }

    #[test]
    fn any_guess_leads_to_the_temperature() {
        for guess in [200.0, 300.0, 3000.0, -5.0, 1e9, f64::NAN] {
            for t in [200.0, 200.1, 999.0, 2999.9, 3000.0] {
                let found = solve(parabola(t).0, guess).unwrap();
                assert!((found / t - 1.0).abs() < 1e-14, "{t} from {guess}: {found}");
            }
        }
    }

    #[test]
    fn enthalpies_out_of_range_are_refused_with_the_range() {
        for enthalpy in [
            parabola(199.9).0,
            parabola(3000.1).0,
            f64::NAN,
            f64::INFINITY,
        ] {
            let error = solve(enthalpy, 300.0).unwrap_err().to_string();
            assert!(error.contains("from 200 K to 3000 K"), "{error}");
            assert!(error.contains("between 240 J/kg and 12000 J/kg"), "{error}");
        }
    }

    #[test]
    fn an_enthalpy_in_the_gap_of_a_step_has_the_temperature_of_the_step() {
        let stepped = |t: f64| {
            if t <= 1000.0 {
                (t, 1.0)
            } else {
                (t + 1e-3, 1.0)
            }
        };
        for guess in [300.0, 1000.0, 2500.0] {
            let t = temperature(1000.0005, "J/kg", (200.0, 3000.0), guess, stepped).unwrap();
            assert!((t - 1000.0).abs() < 1e-9, "{guess}: {t}");
        }
    }
}
