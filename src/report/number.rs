//! Numbers as people read them.

/// A number with so many significant digits: plain between 1e-3 and 1e6, else with a power of ten.
pub(crate) fn figure(value: f64, digits: usize) -> String {
    if value == 0.0 {
        return "0".into();
    }
    if !value.is_finite() {
        return "–".into();
    }
    let scientific = format!("{value:.*e}", digits.saturating_sub(1));
    let (mantissa, exponent) = scientific.split_once('e').unwrap_or((&scientific, "0"));
    let exponent: i32 = exponent.parse().unwrap_or(0);
    if (-3..6).contains(&exponent) {
        let decimals = usize::try_from(digits as i32 - 1 - exponent).unwrap_or(0);
        return minus(trim(&format!("{value:.decimals$}")));
    }
    minus(&format!("{}·10{}", trim(mantissa), superscript(exponent)))
}

/// A value with its unit; pure numbers have none.
pub(crate) fn with_unit(value: f64, digits: usize, unit: &str) -> String {
    if unit == "1" || unit.is_empty() {
        figure(value, digits)
    } else {
        format!("{} {unit}", figure(value, digits))
    }
}

/// Label of an axis: a name and its unit, as people write them.
pub(crate) fn axis_label(name: &str, unit: &str) -> String {
    let name = name.replace('_', " ");
    match unit {
        "" | "1" => name,
        unit => {
            let unit = unit.replace("^2", "²").replace("^3", "³");
            format!("{name} in {unit}")
        }
    }
}

/// A time span in the unit that suits it.
pub(crate) fn span(seconds: f64) -> String {
    match seconds {
        0.0 => "0 s".into(),
        s if s < 1e-3 => format!("{} µs", figure(s * 1e6, 3)),
        s if s < 1.0 => format!("{} ms", figure(s * 1e3, 3)),
        s if s < 120.0 => format!("{} s", figure(s, 4)),
        s if s < 7200.0 => format!("{} min", figure(s / 60.0, 4)),
        s => format!("{} h", figure(s / 3600.0, 4)),
    }
}

fn trim(text: &str) -> &str {
    if text.contains('.') {
        text.trim_end_matches('0').trim_end_matches('.')
    } else {
        text
    }
}

fn minus(text: &str) -> String {
    match text.strip_prefix('-') {
        Some(rest) => format!("−{rest}"),
        None => text.into(),
    }
}

fn superscript(exponent: i32) -> String {
    let digits = ['⁰', '¹', '²', '³', '⁴', '⁵', '⁶', '⁷', '⁸', '⁹'];
    exponent
        .to_string()
        .chars()
        .map(|c| match c.to_digit(10) {
            Some(digit) => digits[digit as usize],
            None => '⁻',
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_keep_their_significant_digits_and_lose_idle_zeros() {
        assert_eq!(figure(101_325.0, 4), "101325");
        assert_eq!(figure(400.0, 4), "400");
        assert_eq!(figure(0.025, 3), "0.025");
        assert_eq!(figure(-56.6568, 4), "−56.66");
        assert_eq!(figure(2.2e-16, 2), "2.2·10⁻¹⁶");
        assert_eq!(figure(1e6, 3), "1·10⁶");
        assert_eq!(figure(f64::NAN, 3), "–");
        assert_eq!(span(300.0), "5 min");
        assert_eq!(span(0.01), "10 ms");
    }
}
