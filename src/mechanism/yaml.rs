//! YAML as a tree of texts with their lines: what a text means is for those who know the key. So `NO` is nitrogen monoxide.

use saphyr_parser::{Event, Parser};

use super::fault::{Fault, fault};
use crate::fortran;

/// Deepest nesting: mechanisms have four.
const DEEPEST: usize = 32;

/// A node.
#[derive(Clone, Debug)]
pub struct YamlNode {
    /// Its line, from one.
    pub line: usize,
    /// What it is.
    pub value: YamlValue,
}

/// What a node is.
#[derive(Clone, Debug)]
pub enum YamlValue {
    /// A text, a number, true or false.
    Text(String),
    /// A list.
    List(Vec<YamlNode>),
    /// Keys with their values, in the order of the file.
    Map(Vec<(String, YamlNode)>),
}

/// What is being read.
enum Open {
    List(Vec<YamlNode>),
    Map(Vec<(String, YamlNode)>, Option<String>),
}

/// Reads the first document of a text.
pub fn parse(text: &str) -> Result<YamlNode, Fault> {
    let mut open: Vec<(usize, Open)> = Vec::new();
    for event in Parser::new_from_str(text) {
        let (event, span) = event.map_err(|error| {
            let line = error.marker().line();
            (Some(line), format!("no YAML: {}", error.info()))
        })?;
        let line = span.start.line();
        if open.len() > DEEPEST {
            return fault(line, format!("is nested more than {DEEPEST} times"));
        }
        let done = match event {
            Event::Scalar(text, ..) => YamlNode {
                line,
                value: YamlValue::Text(text.into_owned()),
            },
            Event::SequenceStart(..) => {
                open.push((line, Open::List(Vec::new())));
                continue;
            }
            Event::MappingStart(..) => {
                open.push((line, Open::Map(Vec::new(), None)));
                continue;
            }
            Event::SequenceEnd | Event::MappingEnd => match open.pop() {
                Some((line, Open::List(list))) => YamlNode {
                    line,
                    value: YamlValue::List(list),
                },
                Some((line, Open::Map(map, _))) => YamlNode {
                    line,
                    value: YamlValue::Map(map),
                },
                None => continue,
            },
            Event::Alias(_) => return fault(line, "an alias (*) is not read: write the value out"),
            _ => continue,
        };
        match open.last_mut() {
            None => return Ok(done),
            Some((_, Open::List(list))) => list.push(done),
            Some((_, Open::Map(map, key))) => match key.take() {
                Some(name) => map.push((name, done)),
                None => match done.value {
                    YamlValue::Text(name) if map.iter().any(|(other, _)| *other == name) => {
                        return fault(line, format!("the key {name} stands twice"));
                    }
                    YamlValue::Text(name) => *key = Some(name),
                    _ => return fault(line, "a key that is no text"),
                },
            },
        }
    }
    Err((None, "has no content".into()))
}

impl YamlNode {
    /// Its keys.
    pub fn map(&self, what: &str) -> Result<&[(String, YamlNode)], Fault> {
        match &self.value {
            YamlValue::Map(map) => Ok(map),
            _ => fault(self.line, format!("{what} is no table of keys")),
        }
    }

    /// Its entries.
    pub fn list(&self, what: &str) -> Result<&[YamlNode], Fault> {
        match &self.value {
            YamlValue::List(list) => Ok(list),
            _ => fault(self.line, format!("{what} is no list")),
        }
    }

    /// Its text.
    pub fn text(&self, what: &str) -> Result<&str, Fault> {
        match &self.value {
            YamlValue::Text(text) => Ok(text),
            _ => fault(self.line, format!("{what} is no text")),
        }
    }

    /// Its number.
    pub fn number(&self, what: &str) -> Result<f64, Fault> {
        let text = self.text(what)?;
        match fortran::number(text.trim()) {
            Some(number) => Ok(number),
            None => fault(
                self.line,
                format!("{what} is \"{text}\", which is not a number"),
            ),
        }
    }

    /// True or false.
    pub fn truth(&self, what: &str) -> Result<bool, Fault> {
        match self.text(what)? {
            "true" | "True" | "yes" => Ok(true),
            "false" | "False" | "no" => Ok(false),
            other => fault(
                self.line,
                format!("{what} is \"{other}\", not true or false"),
            ),
        }
    }

    /// The value of a key.
    pub fn get(&self, key: &str) -> Option<&YamlNode> {
        match &self.value {
            YamlValue::Map(map) => map
                .iter()
                .find(|(name, _)| name == key)
                .map(|(_, node)| node),
            _ => None,
        }
    }

    /// The value of a key that must be there.
    pub fn required(&self, key: &str, what: &str) -> Result<&YamlNode, Fault> {
        match self.get(key) {
            Some(node) => Ok(node),
            None => fault(self.line, format!("{what} has no {key}")),
        }
    }

    /// Refuses keys other than these.
    pub fn only(&self, known: &[&str], what: &str) -> Result<(), Fault> {
        for (name, node) in self.map(what)? {
            if !known.contains(&name.as_str()) {
                return fault(node.line, format!("{name} of {what} is not read"));
            }
        }
        Ok(())
    }

    /// Names with numbers.
    pub fn numbers(&self, what: &str) -> Result<Vec<(String, f64)>, Fault> {
        let pairs = self.map(what)?.iter();
        pairs
            .map(|(name, node)| Ok((name.clone(), node.number(name)?)))
            .collect()
    }
}
