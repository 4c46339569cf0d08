//! Quantities with units: single ones, vectors, schedules.

use calcine_coupler::setup::Schedule;
use toml_edit::Value;

use super::TableReader;
use crate::case::units::{Dimension, UnitError, quantities};

impl TableReader<'_> {
    /// A quantity with its unit, in SI.
    pub fn quantity(&self, key: &str, dimension: Dimension) -> Option<f64> {
        let item = self.item(key)?;
        match item.as_value() {
            Some(value) => self.value(key, value, dimension),
            None => {
                self.wrong_type(
                    key,
                    &format!("{} such as \"{}\"", dimension.words(), dimension.example()),
                    item,
                );
                None
            }
        }
    }

    /// A quantity that must be there.
    pub fn required_quantity(&self, key: &str, dimension: Dimension) -> Option<f64> {
        if !self.has(key) {
            self.missing(key, &format!("\"{}\"", dimension.example()));
        }
        self.quantity(key, dimension)
    }

    /// A quantity above zero.
    pub fn positive(&self, key: &str, dimension: Dimension) -> Option<f64> {
        self.quantity(key, dimension)
            .and_then(|value| self.above_zero(key, value))
    }

    /// A quantity above zero that must be there.
    pub fn required_positive(&self, key: &str, dimension: Dimension) -> Option<f64> {
        self.required_quantity(key, dimension)
            .and_then(|value| self.above_zero(key, value))
    }

    fn above_zero(&self, key: &str, value: f64) -> Option<f64> {
        if value > 0.0 {
            return Some(value);
        }
        self.fail(
            key,
            format!("is {value} (in SI units)"),
            "it must be above zero",
        );
        None
    }

    /// A wall time above zero.
    pub fn wall_time(&self, key: &str) -> Option<std::time::Duration> {
        let seconds = self.positive(key, Dimension::TIME)?;
        let time = std::time::Duration::try_from_secs_f64(seconds).ok();
        if time.is_none() {
            self.fail(
                key,
                format!("is {seconds:e} s, beyond any clock"),
                "write a shorter time",
            );
        }
        time
    }

    /// Three components with one unit: "x y z unit".
    pub fn vector(&self, key: &str, dimension: Dimension) -> Option<[f64; 3]> {
        let item = self.item(key)?;
        let example = dimension
            .example()
            .split_once(' ')
            .map_or("", |(_, unit)| unit);
        let needs = format!("three numbers and a unit such as \"0 0 1 {example}\"");
        let Some(text) = item.as_str() else {
            self.wrong_type(key, &needs, item);
            return None;
        };
        let numbers = self.parsed(key, text, dimension)?;
        let vector = <[f64; 3]>::try_from(numbers.as_slice()).ok();
        if vector.is_none() {
            self.fail(
                key,
                format!("has {} numbers in \"{text}\"", numbers.len()),
                format!("write {needs}"),
            );
        }
        vector
    }

    /// A vector that must be there.
    pub fn required_vector(&self, key: &str, dimension: Dimension) -> Option<[f64; 3]> {
        if !self.has(key) {
            let unit = dimension
                .example()
                .split_once(' ')
                .map_or("", |(_, unit)| unit);
            self.missing(key, &format!("\"0 0 1 {unit}\""));
        }
        self.vector(key, dimension)
    }

    /// A value, or a list of [time, value] with increasing times.
    pub fn schedule(&self, key: &str, dimension: Dimension) -> Option<Schedule> {
        self.points(key, (Dimension::TIME, "time"), dimension)
            .map(Schedule)
    }

    /// A value, or a list of [argument, value] with increasing arguments, such as temperatures in K; the
    /// argument of a single value is 0.
    pub fn curve(
        &self,
        key: &str,
        over: Dimension,
        dimension: Dimension,
    ) -> Option<Vec<(f64, f64)>> {
        self.points(key, (over, "temperature"), dimension)
    }

    fn points(
        &self,
        key: &str,
        (over, word): (Dimension, &str),
        dimension: Dimension,
    ) -> Option<Vec<(f64, f64)>> {
        let Some(item) = self.item(key) else {
            self.missing(key, &format!("\"{}\"", dimension.example()));
            return None;
        };
        let Some(array) = item.as_array() else {
            return self
                .quantity(key, dimension)
                .map(|value| vec![(0.0, value)]);
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
                self.fail(
                    key,
                    format!("needs pairs of {word} and value"),
                    format!("for example {example}"),
                );
                return None;
            };
            let time = self.value(key, time, over)?;
            let value = self.value(key, value, dimension)?;
            if entries.last().is_some_and(|last| last.0 >= time) {
                self.fail(
                    key,
                    format!("has the {word} {time} {unit} after a later or equal one"),
                    format!("the {word}s must increase"),
                );
                return None;
            }
            entries.push((time, value));
        }
        if entries.is_empty() {
            self.fail(
                key,
                "is an empty schedule",
                format!("write at least one pair of {word} and value"),
            );
            return None;
        }
        Some(entries)
    }

    /// A schedule of absolute temperatures.
    pub fn temperatures(&self, key: &str) -> Option<Schedule> {
        self.all_above_zero(
            key,
            Dimension::TEMPERATURE,
            "temperatures are absolute: above 0 K",
        )
    }

    /// A schedule of absolute pressures.
    pub fn pressures(&self, key: &str) -> Option<Schedule> {
        self.all_above_zero(
            key,
            Dimension::PRESSURE,
            "pressures are absolute: above 0 Pa",
        )
    }

    fn all_above_zero(&self, key: &str, dimension: Dimension, help: &str) -> Option<Schedule> {
        let schedule = self.schedule(key, dimension)?;
        if let Some((_, value)) = schedule.0.iter().find(|entry| entry.1 <= 0.0) {
            let example = dimension.example();
            let unit = example.split_once(' ').map_or("", |(_, unit)| unit);
            let unit = if dimension == Dimension::PRESSURE {
                "Pa"
            } else {
                unit
            };
            self.fail(key, format!("is {value} {unit}"), help);
            return None;
        }
        Some(schedule)
    }

    /// One value of a key (or of an entry of its list) as a quantity.
    pub fn value(&self, key: &str, value: &Value, dimension: Dimension) -> Option<f64> {
        let example = dimension.example();
        let plain = value
            .as_float()
            .or_else(|| value.as_integer().map(|number| number as f64));
        if let Some(number) = plain {
            if dimension == Dimension::NONE && number.is_finite() {
                return Some(number);
            }
            self.fail(
                key,
                format!("needs a unit, for example \"{example}\""),
                format!("{number} has none: write it in quotes with a unit"),
            );
            return None;
        }
        let Some(text) = value.as_str() else {
            let rule = format!(
                "needs {} such as \"{example}\", but is {}",
                dimension.words(),
                value.type_name()
            );
            self.fail(key, rule, format!("write \"{example}\""));
            return None;
        };
        let numbers = self.parsed(key, text, dimension)?;
        if let [number] = numbers[..] {
            return Some(number);
        }
        self.fail(
            key,
            format!("has {} numbers in \"{text}\"", numbers.len()),
            format!("write one, for example \"{example}\""),
        );
        None
    }

    fn parsed(&self, key: &str, text: &str, dimension: Dimension) -> Option<Vec<f64>> {
        let (words, example) = (dimension.words(), dimension.example());
        match quantities(text) {
            Ok((numbers, found)) if found == dimension => return Some(numbers),
            Ok((_, Dimension::NONE)) => self.fail(
                key,
                format!("needs a unit, for example \"{example}\""),
                format!("\"{text}\" has none"),
            ),
            Ok((_, found)) => self.fail(
                key,
                format!(
                    "needs {words} such as \"{example}\", but \"{text}\" is {}",
                    found.words()
                ),
                format!("write {words}"),
            ),
            Err(UnitError::Unknown(unit)) => self.fail(
                key,
                format!("has the unit \"{unit}\", which is not known"),
                format!("it needs {words} such as \"{example}\""),
            ),
            Err(UnitError::Number(text)) => self.fail(
                key,
                format!("needs {words} such as \"{example}\", but \"{text}\" has no finite number"),
                "write a number and a unit",
            ),
        }
        None
    }
}
