//! What the declarations of the sections begin with.

pub(super) use calcine_coupler::physics::dimension::Dimension as D;
pub(super) use calcine_coupler::physics::law::Bound::{
    Any, AtLeast, Between, NotNegative, Positive, UpTo, Within,
};

pub(super) use super::key::KeyPresence::{Default, OneOf, Required, With, Without};
pub(super) use super::key::KeyValue::{
    Band, ByName, Choice, Choices, Curve, Dated, Either, Grading, Law, LawName, Measured, Named,
    Number, Numbers, Path, Schedule, Shares, Spans, Table, Tables, Text, Texts, Truth, Vector,
    Vectors, Whole, Wholes,
};
pub(super) use super::key::{Key, MOST, key, words};
pub(super) use crate::case::plant::words::*;
pub(super) use crate::case::words::*;
