//! A key of a case file, and what its value may be.

use calcine_coupler::physics::dimension::Dimension;
use calcine_coupler::physics::law::{Bound, LawParameter};

use super::law_path::{LawFamily, LawPath};
use crate::case::words::CaseWord;
use crate::laws::LawCatalogue;

/// The largest whole number of TOML.
pub const MOST: i64 = i64::MAX;

/// Whether a key must be there.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum KeyPresence {
    /// It must.
    Required,
    /// Of the keys of its table that are so, one at most may be there; the meaning names them.
    OneOf,
    /// It need not; this value, as a case writes it, holds without it.
    Default(&'static str),
    /// It need not; in words, what holds without it or when it is required.
    Without(&'static str),
    /// It is there where this other key of its table is, and only there.
    With(&'static str),
    /// A law's key: its value in SI units without it; `None` where the law needs it.
    OfLaw(Option<f64>),
}

/// One key.
#[derive(Clone, Copy, Debug)]
pub struct Key {
    /// Its name in its table.
    pub name: &'static str,
    /// What its value may be.
    pub value: KeyValue,
    /// Whether it must be there.
    pub presence: KeyPresence,
    /// What it means.
    pub meaning: &'static str,
    /// An example of the value, in TOML; the heading of a table that is long.
    pub example: &'static str,
}

/// A key, for the declarations.
pub(super) const fn key(
    name: &'static str,
    value: KeyValue,
    presence: KeyPresence,
    meaning: &'static str,
    example: &'static str,
) -> Key {
    Key {
        name,
        value,
        presence,
        meaning,
        example,
    }
}

impl Key {
    /// The key of a law's number.
    pub(in crate::case) fn of_parameter(parameter: &LawParameter) -> Self {
        Self {
            name: parameter.name,
            value: KeyValue::Number(parameter.dimension, parameter.bound),
            presence: match parameter.needed_with {
                Some(_) => KeyPresence::Without("none"),
                None => KeyPresence::OfLaw(parameter.default),
            },
            meaning: parameter.meaning,
            example: parameter.example,
        }
    }
}

/// What the value of a key may be.
#[derive(Clone, Copy, Debug)]
pub enum KeyValue {
    /// A text.
    Text,
    /// A path, relative to the case file.
    Path,
    /// A list of so many texts; 0: of any number.
    Texts(usize),
    /// `true` or `false`.
    Truth,
    /// A whole number between two.
    Whole(i64, i64),
    /// So many whole numbers of at least 1.
    Wholes(usize),
    /// A quantity with its unit, or a plain number.
    Number(Dimension, Bound),
    /// A list of so many plain numbers; 0: of any number.
    Numbers(usize),
    /// Three numbers and a unit in one text; without a dimension a direction.
    Vector(Dimension),
    /// A list of vectors.
    Vectors(Dimension),
    /// A value, or pairs of time and value.
    Schedule(Dimension, Bound),
    /// A value, or pairs of temperature and value.
    Curve(Dimension, Bound),
    /// One of several words.
    Choice(fn() -> Vec<&'static str>),
    /// A list of such words.
    Choices(&'static [&'static str]),
    /// A largest difference: a share, or a quantity in the unit of what is measured.
    Band,
    /// A quantity in the unit of what is measured.
    Measured,
    /// Pairs of begin and end.
    Spans,
    /// Pairs of a diameter and its share.
    Shares,
    /// A ratio of cell sizes, or regions of three numbers each.
    Grading,
    /// A table.
    Table(&'static [Key]),
    /// A list of tables.
    Tables(&'static [Key]),
    /// A table, or pairs of time and table.
    Dated(&'static [Key]),
    /// Tables by names that the user chooses.
    Named(&'static [Key]),
    /// Numbers or quantities by names that the user chooses.
    ByName(Dimension),
    /// A table in which a law of a family is chosen, with keys of its own.
    Law(LawFamily, &'static [Key]),
    /// The name of a law of a family; the keys of its laws stand in the same table.
    LawName(LawFamily),
    /// A table of laws of a family.
    LawTable(LawFamily, LawPath),
    /// What one law or another of a family takes here.
    OfLaws(LawFamily, LawPath),
    /// One or the other.
    Either(&'static KeyValue, &'static KeyValue),
}

/// The words of a choice, for [`KeyValue::Choice`].
pub(super) fn words<T: CaseWord>() -> Vec<&'static str> {
    T::ALL.iter().map(|(word, _)| *word).collect()
}

impl KeyValue {
    /// True where the user chooses the names below.
    pub(super) fn is_named(self) -> bool {
        matches!(self, KeyValue::Named(_))
    }

    /// The words that it may be.
    pub(in crate::case) fn choices(self, laws: &LawCatalogue) -> Vec<&'static str> {
        match self {
            KeyValue::Choice(words) => words(),
            KeyValue::Choices(words) => words.to_vec(),
            KeyValue::LawName(family) => family(laws).iter().map(|law| law.name).collect(),
            _ => Vec::new(),
        }
    }
}
