//! Quantities with units: "2 mm", "25 cm^3/min", "300 K", "10 10 120 mm".

pub use calcine_coupler::physics::dimension::Dimension;
use calcine_coupler::physics::figures::{Brief, rounded};

/// A unit: value in SI = factor · value (+ offset for degrees Celsius alone).
#[derive(Clone, Copy, Debug, PartialEq)]
struct Unit {
    factor: f64,
    offset: f64,
    dimension: Dimension,
}

/// Base and derived units as users write them.
const UNITS: &[(&str, f64, [i8; 5])] = &[
    ("m", 1.0, [1, 0, 0, 0, 0]),
    ("cm", 1e-2, [1, 0, 0, 0, 0]),
    ("mm", 1e-3, [1, 0, 0, 0, 0]),
    ("um", 1e-6, [1, 0, 0, 0, 0]),
    ("nm", 1e-9, [1, 0, 0, 0, 0]),
    ("µm", 1e-6, [1, 0, 0, 0, 0]),
    ("km", 1e3, [1, 0, 0, 0, 0]),
    ("kg", 1.0, [0, 1, 0, 0, 0]),
    ("g", 1e-3, [0, 1, 0, 0, 0]),
    ("mg", 1e-6, [0, 1, 0, 0, 0]),
    ("t", 1e3, [0, 1, 0, 0, 0]),
    ("s", 1.0, [0, 0, 1, 0, 0]),
    ("ms", 1e-3, [0, 0, 1, 0, 0]),
    ("us", 1e-6, [0, 0, 1, 0, 0]),
    ("uPa", 1e-6, [-1, 1, -2, 0, 0]),
    ("µs", 1e-6, [0, 0, 1, 0, 0]),
    ("min", 60.0, [0, 0, 1, 0, 0]),
    ("h", 3600.0, [0, 0, 1, 0, 0]),
    ("d", 86400.0, [0, 0, 1, 0, 0]),
    ("K", 1.0, [0, 0, 0, 1, 0]),
    ("mol", 1.0, [0, 0, 0, 0, 1]),
    ("kmol", 1e3, [0, 0, 0, 0, 1]),
    ("l", 1e-3, [3, 0, 0, 0, 0]),
    ("N", 1.0, [1, 1, -2, 0, 0]),
    ("mN", 1e-3, [1, 1, -2, 0, 0]),
    ("kN", 1e3, [1, 1, -2, 0, 0]),
    ("Pa", 1.0, [-1, 1, -2, 0, 0]),
    ("hPa", 1e2, [-1, 1, -2, 0, 0]),
    ("kPa", 1e3, [-1, 1, -2, 0, 0]),
    ("MPa", 1e6, [-1, 1, -2, 0, 0]),
    ("GPa", 1e9, [-1, 1, -2, 0, 0]),
    ("bar", 1e5, [-1, 1, -2, 0, 0]),
    ("mbar", 1e2, [-1, 1, -2, 0, 0]),
    // Standard atmosphere, exact (CGPM 1954).
    ("atm", 101_325.0, [-1, 1, -2, 0, 0]),
    // 1 lbf/in², exact.
    ("psi", 6_894.757_293_168, [-1, 1, -2, 0, 0]),
    // Thermochemical calories, those of mechanisms.
    ("cal", 4.184, [2, 1, -2, 0, 0]),
    ("kcal", 4184.0, [2, 1, -2, 0, 0]),
    ("mJ", 1e-3, [2, 1, -2, 0, 0]),
    ("J", 1.0, [2, 1, -2, 0, 0]),
    ("kJ", 1e3, [2, 1, -2, 0, 0]),
    ("MJ", 1e6, [2, 1, -2, 0, 0]),
    ("Wh", 3600.0, [2, 1, -2, 0, 0]),
    ("kWh", 3.6e6, [2, 1, -2, 0, 0]),
    ("W", 1.0, [2, 1, -3, 0, 0]),
    ("mW", 1e-3, [2, 1, -3, 0, 0]),
    ("kW", 1e3, [2, 1, -3, 0, 0]),
    ("MW", 1e6, [2, 1, -3, 0, 0]),
    ("rad", 1.0, [0, 0, 0, 0, 0]),
    ("deg", std::f64::consts::PI / 180.0, [0, 0, 0, 0, 0]),
    ("rpm", std::f64::consts::PI / 30.0, [0, 0, -1, 0, 0]),
    ("%", 1e-2, [0, 0, 0, 0, 0]),
];

/// Symbols of all units but degrees Celsius.
pub(super) fn symbols() -> impl Iterator<Item = &'static str> {
    UNITS.iter().map(|unit| unit.0)
}

/// What people write for units, and what is meant.
const MEANT: &[(&str, &str)] = &[
    ("C", "degC"),
    ("celsius", "degC"),
    ("kelvin", "K"),
    ("sec", "s"),
    ("second", "s"),
    ("minute", "min"),
    ("hr", "h"),
    ("hour", "h"),
    ("day", "d"),
    ("micron", "um"),
    ("meter", "m"),
    ("metre", "m"),
    ("gram", "g"),
    ("liter", "l"),
    ("litre", "l"),
    ("lpm", "l/min"),
    ("pascal", "Pa"),
    ("joule", "J"),
    ("watt", "W"),
    ("degree", "deg"),
];

/// The unit that was meant by one that is not known: another word for it, or another spelling.
pub(super) fn meant(unit: &str) -> Option<&'static str> {
    let singular = unit.strip_suffix('s').unwrap_or(unit);
    let same = |name: &str| {
        [unit, singular]
            .iter()
            .any(|one| one.eq_ignore_ascii_case(name))
    };
    let word = MEANT.iter().find(|(name, _)| same(name));
    let spelt = || symbols().find(|symbol| symbol.eq_ignore_ascii_case(unit));
    word.map(|(_, meant)| *meant).or_else(spelt)
}

/// Zero of the Celsius scale in K.
const CELSIUS: f64 = 273.15;

/// Why a text is not a quantity.
#[derive(Clone, Debug, PartialEq)]
pub enum UnitError {
    /// No number where one is needed.
    Number(String),
    /// A unit that is not known.
    Unknown(String),
}

/// A symbol and its power: `m^3`, `m3`, which no symbol ends like, and `m-3`.
fn raised(part: &str) -> Option<(&str, &str)> {
    if let Some(both) = part.split_once('^') {
        return Some(both);
    }
    let end = part.find(|c: char| c.is_ascii_digit() || c == '-')?;
    let (symbol, power) = part.split_at(end);
    let plain = power.strip_prefix('-').unwrap_or(power);
    let is_power = plain.len() == 1 && !symbol.is_empty();
    is_power.then_some((symbol, power))
}

fn unit(text: &str) -> Result<Unit, UnitError> {
    // The Greek letter is the sign for micro on many keyboards.
    let plain = text
        .replace('²', "^2")
        .replace('³', "^3")
        .replace('\u{3bc}', "µ");
    let text = plain.as_str();
    if text == "degC" || text == "°C" {
        return Ok(Unit {
            factor: 1.0,
            offset: CELSIUS,
            dimension: Dimension::TEMPERATURE,
        });
    }
    let (mut factor, mut exponents, mut sign) = (1.0, [0i8; 5], 1i8);
    let mut rest = text;
    loop {
        let end = rest.find(['/', '*', '·', ' ']).unwrap_or(rest.len());
        let (symbol, power) = match raised(&rest[..end]) {
            Some((symbol, power)) => {
                let power = power.parse::<i8>().ok().filter(|p| (-9..=9).contains(p));
                (
                    symbol,
                    power.ok_or_else(|| UnitError::Unknown(text.into()))?,
                )
            }
            None => (&rest[..end], 1),
        };
        if symbol != "1" {
            let known = UNITS.iter().find(|(name, ..)| *name == symbol);
            let &(_, scale, dimension) = known.ok_or_else(|| UnitError::Unknown(symbol.into()))?;
            factor *= f64::powi(scale, i32::from(sign * power));
            for (sum, exponent) in exponents.iter_mut().zip(dimension) {
                let change = (sign * power).checked_mul(exponent);
                let next = change.and_then(|change| sum.checked_add(change));
                *sum = next.ok_or_else(|| UnitError::Unknown(text.into()))?;
            }
        }
        let Some(separator) = rest[end..].chars().next() else {
            break;
        };
        sign = if separator == '/' { -1 } else { 1 };
        rest = &rest[end + separator.len_utf8()..];
    }
    Ok(Unit {
        factor,
        offset: 0.0,
        dimension: Dimension(exponents),
    })
}

/// Numbers followed by one unit, in SI; the unit may be missing only for plain numbers.
pub fn quantities(text: &str) -> Result<(Vec<f64>, Dimension), UnitError> {
    let mut numbers = Vec::new();
    // The minus sign of typeset texts.
    let text = text.replace('\u{2212}', "-");
    let mut rest = text.trim();
    while !rest.is_empty() {
        let end = rest.find(char::is_whitespace).unwrap_or(rest.len());
        let word = &rest[..end];
        if let Ok(number) = word.parse::<f64>() {
            if !number.is_finite() {
                return Err(UnitError::Number(word.into()));
            }
            numbers.push(number);
            rest = rest[end..].trim_start();
            continue;
        }
        // "1/s" behind a number is its unit.
        if !numbers.is_empty() && word.starts_with("1/") {
            break;
        }
        // "2mm": a number with its unit attached
        let split = word.find(|c: char| !(c.is_ascii_digit() || ".+-".contains(c)));
        if let Some(split) = split
            && let Ok(number) = word[..split].parse::<f64>()
        {
            numbers.push(number);
            rest = &rest[split..];
        }
        break;
    }
    if numbers.is_empty() {
        return Err(UnitError::Number(text));
    }
    if rest.is_empty() {
        return Ok((numbers, Dimension::NONE));
    }
    let Unit {
        factor,
        offset,
        dimension,
    } = unit(rest)?;
    let converted: Vec<f64> = numbers
        .iter()
        .map(|number| number * factor + offset)
        .collect();
    if converted.iter().any(|number| !number.is_finite()) {
        return Err(UnitError::Number(text));
    }
    Ok((converted, dimension))
}

/// A number as messages show it: without the last digits' round-off.
pub fn shown(number: f64) -> String {
    rounded(number, 9)
}

/// A computed number as messages show it, to six digits.
pub fn short(number: f64) -> String {
    Brief(number).to_string()
}

/// Most names in one warning.
const MOST_NAMES: usize = 3;

/// The first of some names, and how many follow.
pub(in crate::case) fn listed(names: &[&str]) -> Option<String> {
    let shown: Vec<String> = names
        .iter()
        .take(MOST_NAMES)
        .map(|name| format!("`{name}`"))
        .collect();
    let more = names.len().saturating_sub(MOST_NAMES);
    match more {
        0 => (!shown.is_empty()).then(|| shown.join(", ")),
        _ => Some(format!("{} and {more} more", shown.join(", "))),
    }
}

/// A computed number as warnings show it, to three digits.
pub fn short3(number: f64) -> String {
    rounded(number, 2)
}

/// A difference, for bands: "0.5 K", "5 %"; degrees Celsius count as kelvins.
pub fn difference(text: &str) -> Result<(f64, Dimension), UnitError> {
    let text = text.replace("degC", "K").replace("°C", "K");
    match quantities(&text)? {
        (numbers, dimension) if numbers.len() == 1 => Ok((numbers[0], dimension)),
        _ => Err(UnitError::Number(text)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_shown_without_hundreds_of_zeros() {
        assert_eq!(
            (shown(1e300), short(1e-300)),
            ("1e300".into(), "1e-300".into())
        );
        assert_eq!(
            (shown(0.0), short3(-2.5e-3)),
            ("0".into(), "-0.0025".into())
        );
        assert_eq!(shown(9.2e6), "9200000");
    }

    fn one(text: &str) -> (f64, Dimension) {
        let (numbers, dimension) = quantities(text).unwrap();
        assert_eq!(numbers.len(), 1);
        (numbers[0], dimension)
    }

    #[test]
    fn quantities_are_converted_to_si() {
        assert_eq!(one("2 mm"), (0.002, Dimension::LENGTH));
        assert_eq!(one("2mm"), (0.002, Dimension::LENGTH));
        assert_eq!(one("10 min"), (600.0, Dimension::TIME));
        assert_eq!(one("20 degC"), (293.15, Dimension::TEMPERATURE));
        assert_eq!(one("840 J/kg/K"), (840.0, Dimension::HEAT_CAPACITY));
        assert_eq!(one("0.9 kJ/kg/K"), (900.0, Dimension::HEAT_CAPACITY));
        assert_eq!(one("1 atm"), (101_325.0, Dimension::PRESSURE));
        let (mass, dimension) = one("28.96 g/mol");
        assert!((mass - 0.02896).abs() < 1e-16);
        assert_eq!(dimension, Dimension::MOLAR_MASS);
        assert_eq!(one("180 deg"), (std::f64::consts::PI, Dimension::NONE));
        assert_eq!(one("9.81 m/s^2").1, Dimension::ACCELERATION);
        assert_eq!(one("2700 kg/m3").0, 2700.0);
        assert_eq!(one("2700 kg/m³"), one("2700 kg/m^3"));
        assert_eq!(one("2700 kg m-3"), one("2700 kg/m^3"));
        assert_eq!(one("5 W/m2/K"), one("5 W/m^2/K"));
        assert_eq!(one("25 cm3/min"), one("25 cm^3/min"));
        assert_eq!(one("30 kcal/mol"), one("125.52 kJ/mol"));
        assert!((one("14.7 psi").0 / 101_353.0 - 1.0).abs() < 1e-5);
        assert_eq!(one("1e5 1/s").0, 1e5);
        assert!(matches!(quantities("5 W/m2K"), Err(UnitError::Unknown(unit)) if unit == "m2K"));
        assert_eq!(one("1e-3 m"), (1e-3, Dimension::LENGTH));
        assert_eq!(one("0.6"), (0.6, Dimension::NONE));
        let (flow, dimension) = one("25 cm^3/min");
        assert!((flow - 25e-6 / 60.0).abs() < 1e-20);
        assert_eq!(dimension.to_string(), "m^3 s^-1");
        assert_eq!(quantities("10 10 120 mm").unwrap().0, [0.01, 0.01, 0.12]);
    }

    #[test]
    fn what_is_no_quantity_says_why() {
        assert_eq!(
            quantities("two mm"),
            Err(UnitError::Number("two mm".into()))
        );
        assert_eq!(
            quantities("2 furlong"),
            Err(UnitError::Unknown("furlong".into()))
        );
        assert!(matches!(quantities("inf m"), Err(UnitError::Number(_))));
        assert!(quantities("").is_err());
        assert!(quantities("1 m^99").is_err());
        assert!(quantities(&format!("1 {}", ["m^9"; 20].join("*"))).is_err());
        assert!(quantities("1e308 t/l").is_err());
    }

    #[test]
    fn other_words_and_spellings_of_a_unit_say_what_is_meant() {
        for (written, known) in [
            ("C", "degC"),
            ("Celsius", "degC"),
            ("Hours", "h"),
            ("MM", "mm"),
            ("k", "K"),
            ("Lpm", "l/min"),
        ] {
            assert_eq!(meant(written), Some(known), "{written}");
            assert!(quantities(&format!("1 {known}")).is_ok());
        }
        assert_eq!(meant("furlong"), None);
    }

    #[test]
    fn a_difference_in_degrees_celsius_is_one_in_kelvins() {
        assert_eq!(difference("0.5 degC"), Ok((0.5, Dimension::TEMPERATURE)));
        assert_eq!(difference("5 %"), Ok((0.05, Dimension::NONE)));
        assert!(difference("1 2 K").is_err());
    }
}
