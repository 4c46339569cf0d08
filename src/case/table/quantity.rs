//! Quantities with units: single ones, vectors, schedules.

use calcine_coupler::physics::law::Bound;
use calcine_coupler::setup::Schedule;
use toml_edit::Value;

use super::{Key, KeyPresence, KeyValue, TableReader};
use crate::case::keys::parse_number;
use crate::case::units::{Dimension, UnitError, meant, quantities, shown};

/// Of a rate as of an angular velocity.
const PER_SECOND: Dimension = Dimension([0, 0, -1, 0, 0]);

/// True of a rate in 1/s, which has the dimension of an angular velocity.
fn is_rate(key: &str, dimension: Dimension) -> bool {
    dimension == PER_SECOND && key != "angular_velocity"
}

/// A dimension in words with its article.
fn words_of(key: &str, dimension: Dimension) -> String {
    match is_rate(key, dimension) {
        true => "a rate in 1/s".into(),
        false => dimension.words(),
    }
}

fn example_of(key: &str, dimension: Dimension) -> &'static str {
    match is_rate(key, dimension) {
        true => "1e-3 1/s",
        false => dimension.example(),
    }
}

fn unit_of(key: &str, dimension: Dimension) -> String {
    match is_rate(key, dimension) {
        true => "1/s".into(),
        false => dimension.unit(),
    }
}

/// Highest temperature in K that a case may state.
const HOTTEST: f64 = 1e5;

impl TableReader<'_> {
    /// A quantity with its unit, in SI, or a plain number, as it is declared; without it its default.
    pub fn number(&self, key: &str) -> Option<f64> {
        let (declared, (dimension, bound)) = self.declared_as(key, |value| match value {
            KeyValue::Number(dimension, bound) => Some((dimension, bound)),
            _ => None,
        })?;
        self.number_of(&declared, dimension, bound)
    }

    /// A quantity of the dimension that goes with another choice of the table, of those that are declared.
    pub fn number_as(&self, key: &str, dimension: Dimension) -> Option<f64> {
        let (declared, bound) = self.declared_as(key, |value| match value {
            KeyValue::Number(own, bound) => (own == dimension).then_some(bound),
            KeyValue::Measured => Some(Bound::Any),
            _ => None,
        })?;
        self.number_of(&declared, dimension, bound)
    }

    pub(super) fn number_of(&self, key: &Key, dimension: Dimension, bound: Bound) -> Option<f64> {
        let Some(item) = self.item_of(key) else {
            return match key.presence {
                KeyPresence::Default(text) => parse_number(text),
                KeyPresence::OfLaw(value) => value,
                _ => None,
            };
        };
        let Some(value) = item.as_value() else {
            let needs = format!("{} such as {}", words_of(key.name, dimension), key.example);
            self.wrong_type(key.name, &needs, item);
            return None;
        };
        let value = self.value(key.name, value, dimension)?;
        self.within(key.name, value, dimension, bound)
            .then_some(value)
    }

    /// True where a value is within the bound of its key; an error else.
    fn within(&self, key: &str, value: f64, dimension: Dimension, bound: Bound) -> bool {
        if dimension == Dimension::TEMPERATURE && value > HOTTEST {
            let rule = format!("is {} K", shown(value));
            self.refuse(key, &rule, format!("it is at most {HOTTEST} K"));
            return false;
        }
        let holds = bound.holds(value);
        if !holds {
            let rule = format!("is {} {}", shown(value), unit_of(key, dimension));
            let absolute = match key == "pressure" && dimension == Dimension::PRESSURE {
                true => ": pressures are absolute, 1 atm at the ground",
                false => "",
            };
            self.refuse(
                key,
                rule.trim_end(),
                format!("it {}{absolute}", bound.words()),
            );
        }
        holds
    }

    /// A wall time above zero.
    pub fn wall_time(&self, key: &str) -> Option<std::time::Duration> {
        let seconds = self.number(key)?;
        let time = std::time::Duration::try_from_secs_f64(seconds).ok();
        if time.is_none() {
            self.refuse(
                key,
                format!("is {seconds:e} s, beyond any clock"),
                "write a shorter time",
            );
        }
        time
    }

    /// Three components with one unit: "x y z unit".
    pub fn vector(&self, key: &str) -> Option<[f64; 3]> {
        let (declared, dimension) = self.declared_as(key, |value| match value {
            KeyValue::Vector(dimension) => Some(dimension),
            _ => None,
        })?;
        let needs = format!(
            "three numbers{} such as {}",
            match dimension {
                Dimension::NONE => "",
                _ => " and a unit",
            },
            declared.example
        );
        let Some(item) = self.item_of(&declared) else {
            let KeyPresence::Default(text) = declared.presence else {
                return None;
            };
            let (numbers, _) = quantities(text).ok()?;
            return <[f64; 3]>::try_from(numbers).ok();
        };
        let Some(text) = item.as_str() else {
            self.wrong_type(key, &needs, item);
            return None;
        };
        let numbers = self.parsed(key, text, dimension)?;
        let vector = <[f64; 3]>::try_from(numbers.as_slice()).ok();
        if vector.is_none() {
            self.unread(
                key,
                format!("has {} numbers in \"{text}\"", numbers.len()),
                format!("write {needs}"),
            );
        }
        vector
    }

    /// A value, or a list of [time, value] with increasing times.
    pub fn schedule(&self, key: &str) -> Option<Schedule> {
        let (declared, (dimension, bound)) = self.declared_as(key, |value| match value {
            KeyValue::Schedule(dimension, bound) => Some((dimension, bound)),
            _ => None,
        })?;
        let points = self.points(&declared, (Dimension::TIME, "time"), dimension)?;
        self.all_within(key, &points, dimension, bound)
            .then_some(Schedule(points))
    }

    /// A value, or a list of [temperature, value] with increasing temperatures in K; the temperature of a single
    /// value is 0.
    pub fn curve(&self, key: &str) -> Option<Vec<(f64, f64)>> {
        let (declared, (dimension, bound)) = self.declared_as(key, |value| match value {
            KeyValue::Curve(dimension, bound) => Some((dimension, bound)),
            _ => None,
        })?;
        let over = (Dimension::TEMPERATURE, "temperature");
        let points = self.points(&declared, over, dimension)?;
        self.all_within(key, &points, dimension, bound)
            .then_some(points)
    }

    fn all_within(
        &self,
        key: &str,
        points: &[(f64, f64)],
        dimension: Dimension,
        bound: Bound,
    ) -> bool {
        points
            .iter()
            .all(|point| self.within(key, point.1, dimension, bound))
    }

    fn points(
        &self,
        declared: &Key,
        (over, word): (Dimension, &str),
        dimension: Dimension,
    ) -> Option<Vec<(f64, f64)>> {
        let key = declared.name;
        let Some(item) = self.item_of(declared) else {
            return match declared.presence {
                KeyPresence::Default(text) => Some(vec![(0.0, parse_number(text)?)]),
                _ => None,
            };
        };
        let Some(array) = item.as_array() else {
            let Some(value) = item.as_value() else {
                let needs = format!("{} such as {}", dimension.words(), declared.example);
                self.wrong_type(key, &needs, item);
                return None;
            };
            return Some(vec![(0.0, self.value(key, value, dimension)?)]);
        };
        let unit = if word == "time" { "s" } else { "K" };
        let mut entries: Vec<(f64, f64)> = Vec::new();
        for entry in array {
            let pair = entry.as_array().filter(|pair| pair.len() == 2);
            let Some((time, value)) = pair.and_then(|pair| Some((pair.get(0)?, pair.get(1)?)))
            else {
                let (low, high) = if word == "time" {
                    ("0 s", "10 s")
                } else {
                    ("300 K", "600 K")
                };
                let value = dimension.example();
                let example = format!("[[\"{low}\", \"{value}\"], [\"{high}\", \"{value}\"]]");
                self.unread(
                    key,
                    format!("needs pairs of {word} and value"),
                    format!("for example {example}"),
                );
                return None;
            };
            let time = self.value(key, time, over)?;
            let value = self.value(key, value, dimension)?;
            if entries.last().is_some_and(|last| last.0 >= time) {
                self.refuse(
                    key,
                    format!("has the {word} {time} {unit} after a later or equal one"),
                    format!("the {word}s must increase"),
                );
                return None;
            }
            entries.push((time, value));
        }
        if entries.is_empty() {
            self.refuse(
                key,
                "is an empty schedule",
                format!("write at least one pair of {word} and value"),
            );
            return None;
        }
        Some(entries)
    }

    /// One value of a key (or of an entry of its list) as a quantity.
    pub fn value(&self, key: &str, value: &Value, dimension: Dimension) -> Option<f64> {
        let example = example_of(key, dimension);
        let plain = value
            .as_float()
            .or_else(|| value.as_integer().map(|number| number as f64));
        if let Some(number) = plain {
            if dimension == Dimension::NONE && number.is_finite() {
                return Some(number);
            }
            self.unread(
                key,
                format!("needs a unit, for example \"{example}\""),
                format!("{number} has none: write it in quotes with a unit"),
            );
            return None;
        }
        let Some(text) = value.as_str() else {
            let rule = format!(
                "needs {} such as \"{example}\", but is {}",
                words_of(key, dimension),
                value.type_name()
            );
            self.unread(key, rule, format!("write \"{example}\""));
            return None;
        };
        let numbers = self.parsed(key, text, dimension)?;
        if let [number] = numbers[..] {
            return Some(number);
        }
        self.unread(
            key,
            format!("has {} numbers in \"{text}\"", numbers.len()),
            format!("write one, for example \"{example}\""),
        );
        None
    }

    fn parsed(&self, key: &str, text: &str, dimension: Dimension) -> Option<Vec<f64>> {
        let (words, example) = (words_of(key, dimension), example_of(key, dimension));
        if let Some(point) = with_a_comma(text) {
            self.unread(
                key,
                format!("has a comma in \"{text}\""),
                format!("write the decimal point as a point, \"{point}\"; numbers of a vector stand apart by spaces"),
            );
            return None;
        }
        match quantities(text) {
            Ok((numbers, found)) if found == dimension => return Some(numbers),
            Ok((_, Dimension::NONE)) => self.unread(
                key,
                format!("needs a unit, for example \"{example}\""),
                format!("\"{text}\" has none"),
            ),
            Ok((_, found)) => self.unread(
                key,
                format!(
                    "needs {words} such as \"{example}\", but \"{text}\" is {}",
                    match found {
                        PER_SECOND => "a rate in 1/s".into(),
                        _ => found.words(),
                    }
                ),
                match dimension {
                    Dimension::NONE => "write the number alone; what has a unit by its orders is in mol, m and s".into(),
                    _ => format!("write {words}"),
                },
            ),
            Err(UnitError::Unknown(unit)) => self.unread(
                key,
                format!("has the unit \"{unit}\", which is not known"),
                match meant(&unit) {
                    Some(known) => format!("did you mean \"{known}\"?"),
                    None if unit.contains(|c: char| c.is_ascii_digit()) => format!(
                        "write powers with ^ and each division with /, as in \"W/m^2/K\"; it needs {words} such as \"{example}\""
                    ),
                    None => format!("it needs {words} such as \"{example}\""),
                },
            ),
            Err(UnitError::Number(text)) => self.unread(
                key,
                format!("needs {words} such as \"{example}\", but \"{text}\" has no finite number"),
                "write a number and a unit",
            ),
        }
        None
    }
}

/// The text with points in place of commas that stand between digits.
fn with_a_comma(text: &str) -> Option<String> {
    let letters: Vec<char> = text.chars().collect();
    let is_digit = |place: Option<usize>| {
        let letter = place.and_then(|place| letters.get(place));
        letter.is_some_and(char::is_ascii_digit)
    };
    let decimal = |place: usize| {
        letters[place] == ',' && is_digit(place.checked_sub(1)) && is_digit(Some(place + 1))
    };
    let point = |place: usize| match decimal(place) {
        true => '.',
        false => letters[place],
    };
    let places = 0..letters.len();
    let any = places.clone().any(decimal);
    any.then(|| places.map(point).collect())
}
