//! How the value of a key is described in words.

use calcine_coupler::physics::dimension::Dimension;

use super::key::{KeyValue, MOST};
use crate::case::units;
use crate::laws::LawCatalogue;

/// A number of a default or of a law's parameter with its SI unit.
pub(in crate::case) fn number_words(value: f64, dimension: Dimension) -> String {
    format!("{} {}", units::shown(value), dimension.unit())
        .trim_end()
        .to_owned()
}

/// The number of a default, in SI units.
pub(in crate::case) fn parse_number(text: &str) -> Option<f64> {
    let (numbers, _) = units::quantities(text).ok()?;
    numbers.first().copied()
}

impl KeyValue {
    /// What the value is, in words for the docs.
    pub(in crate::case) fn words(self, laws: &LawCatalogue) -> String {
        let count = |n: usize| match n {
            2 => "two",
            3 => "three",
            6 => "six",
            _ => "seven",
        };
        match self {
            KeyValue::Text => "text".into(),
            KeyValue::Path => "path".into(),
            KeyValue::Texts(0) => "list of texts".into(),
            KeyValue::Texts(n) => format!("{} texts", count(n)),
            KeyValue::Truth => "true or false".into(),
            KeyValue::Whole(_, MOST) => "whole number".into(),
            KeyValue::Whole(least, most) => format!("whole number, {least} to {most}"),
            KeyValue::Wholes(n) => format!("{} whole numbers", count(n)),
            KeyValue::Number(dimension, _) => quantity(dimension),
            KeyValue::Numbers(0) => "list of numbers".into(),
            KeyValue::Numbers(n) => format!("{} numbers", count(n)),
            KeyValue::Vector(dimension) => format!("three {}", plural(dimension)),
            KeyValue::Vectors(dimension) => format!("list of three {}", plural(dimension)),
            KeyValue::Schedule(Dimension::NONE, _) => "number or schedule".into(),
            KeyValue::Schedule(dimension, _) => format!("{}, or schedule", quantity(dimension)),
            KeyValue::Curve(dimension, _) => {
                format!("{}, or points over temperature", quantity(dimension))
            }
            KeyValue::Choice(_) | KeyValue::LawName(_) => {
                let choices = self.choices(laws);
                let quoted: Vec<String> = choices.iter().map(|word| format!("`{word}`")).collect();
                match &quoted[..] {
                    [first @ .., last] if !first.is_empty() => {
                        format!("{} or {last}", first.join(", "))
                    }
                    all => all.concat(),
                }
            }
            KeyValue::Choices(choices) => {
                let quoted: Vec<String> = choices.iter().map(|word| format!("`{word}`")).collect();
                format!("list of {}", quoted.join(", "))
            }
            KeyValue::Band => "band".into(),
            KeyValue::Measured => "as the field measured".into(),
            KeyValue::Spans => "list of [begin, end]".into(),
            KeyValue::Shares => "list of pairs".into(),
            KeyValue::Grading => "number, or list".into(),
            KeyValue::Table(_)
            | KeyValue::Named(_)
            | KeyValue::Law(..)
            | KeyValue::LawTable(..) => "table".into(),
            KeyValue::OfLaws(..) => {
                let mut words: Vec<String> = Vec::new();
                for value in self.alternatives(laws) {
                    let one = value.words(laws);
                    if !words.contains(&one) {
                        words.push(one);
                    }
                }
                words.join(", or ")
            }
            KeyValue::Tables(_) => "list of tables".into(),
            KeyValue::Dated(_) => "table, or schedule of tables".into(),
            KeyValue::ByName(Dimension::NONE) => "table of numbers".into(),
            KeyValue::ByName(dimension) => format!("table of {}", plural(dimension)),
            KeyValue::Either(one, other) => {
                let choices = one.choices(laws);
                let quoted: Vec<String> = choices.iter().map(|word| format!("`{word}`")).collect();
                let one = match quoted.is_empty() {
                    true => one.words(laws),
                    false => quoted.join(", "),
                };
                let comma = match one.contains(", ") && quoted.is_empty() {
                    true => ",",
                    false => "",
                };
                format!("{one}{comma} or {}", other.words(laws))
            }
        }
    }
}

/// `time, s`, or `number`.
fn quantity(dimension: Dimension) -> String {
    match dimension {
        Dimension::NONE => "number".into(),
        // No single number of a case turns: those that do are vectors.
        Dimension::ANGULAR_VELOCITY => "rate, 1/s".into(),
        _ if noun(dimension) == dimension.unit() => dimension.unit(),
        _ => format!("{}, {}", noun(dimension), dimension.unit()),
    }
}

/// `velocities, m/s`, or `numbers`.
fn plural(dimension: Dimension) -> String {
    if dimension == Dimension::NONE {
        return "numbers".into();
    }
    let noun = noun(dimension);
    let nouns = match noun.strip_suffix('y') {
        Some(stem) => format!("{stem}ies"),
        None => format!("{noun}s"),
    };
    format!("{nouns}, {}", dimension.unit())
}

fn noun(dimension: Dimension) -> String {
    let words = dimension.words();
    words
        .trim_start_matches("an ")
        .trim_start_matches("a ")
        .to_owned()
}
