//! Keys of what streams and units are made of.

use crate::case::keys::prelude::*;

#[rustfmt::skip]
const NORMAL: &[Key] = &[
    key("mean", Number(D::LENGTH, Positive), Required, "Mean diameter by mass.", "\"2 mm\""),
    key("deviation", Number(D::LENGTH, Positive), Required, "Standard deviation.", "\"0.1 mm\""),
];

/// A distribution over sizes.
#[rustfmt::skip]
pub(super) const DISTRIBUTION: &[Key] = &[
    key("normal", Table(NORMAL), OneOf, "A normal distribution. One of `normal`, `classes`, `passing`.", "{ mean = \"2 mm\", deviation = \"0.1 mm\" }"),
    key("classes", Shares, OneOf, "Diameters, each with the share of the mass in the class that it falls into; shares are scaled to sum to 1. One of `normal`, `classes`, `passing`.", "[[\"1 mm\", 0.4], [\"2 mm\", 0.6]]"),
    key("passing", Shares, OneOf, "Diameters, each with the share of the mass that is smaller, as sieves measure it: from 0 to 1, linear between the points. One of `normal`, `classes`, `passing`.", "[[\"1 mm\", 0], [\"2 mm\", 0.7], [\"3 mm\", 1]]"),
];

/// The size classes of solids, their compounds and attributes.
macro_rules! solids {
    ($name:literal, $dimension:expr, $meaning:literal, $example:literal) => {
        &[
            key(
                $name,
                Number($dimension, NotNegative),
                Required,
                $meaning,
                $example,
            ),
            key(
                "sizes",
                Table(DISTRIBUTION),
                Required,
                "Distribution over sizes, by mass.",
                "{ normal = { mean = \"2 mm\", deviation = \"0.1 mm\" } }",
            ),
            key(
                "composition",
                ByName(D::NONE),
                Without("required with several compounds"),
                "Mass fraction of each compound; they sum to 1.",
                "{ urea = 1 }",
            ),
            key(
                "attributes",
                ByName(D::NONE),
                Without("the first class of each"),
                "Class of each attribute, counted from 1.",
                "{ colour = 2 }",
            ),
        ]
    };
}

#[rustfmt::skip]
const FED: &[Key] = solids!("flow", D::MASS_FLOW, "Mass flow.", "\"0.1 kg/s\"");

#[rustfmt::skip]
const HELD: &[Key] = solids!("mass", D::MASS, "Mass.", "\"20 kg\"");

/// What flows in.
#[rustfmt::skip]
pub(super) const INLET: &[Key] = &[
    key("solids", Tables(FED), Without("none"), "Solids; several tables are several kinds of particles.", "[{ flow = \"0.1 kg/s\", sizes = { normal = { mean = \"1.5 mm\", deviation = \"0.1 mm\" } } }]"),
    key("liquids", ByName(D::MASS_FLOW), Without("none"), "Mass flow of each liquid.", "{ urea = \"50 g/s\", water = \"50 g/s\" }"),
    key("vapours", ByName(D::MASS_FLOW), Without("none"), "Mass flow of each gas and vapour.", "{ air = \"0.5 kg/s\" }"),
    key("temperature", Number(D::TEMPERATURE, Positive), Required, "Temperature.", "\"300 K\""),
    key("factor", Schedule(D::NONE, NotNegative), Default("1"), "Factor of all flows, over time.", "[[\"0 s\", 1], [\"1 h\", 1.1]]"),
    key("controller", Text, Without("none"), "Controller whose output multiplies the flows, beside the factor.", "\"level\""),
    key("between", Choice(words::<InBetween>), Default("line"), "How the factor runs between its points: in straight lines, or in steps that hold to the next.", "\"step\""),
];

/// The bed of a granulator at the start.
#[rustfmt::skip]
pub(super) const CONTENT: Key =
    key("content", Tables(HELD), Required, "Solids at the start; several tables are several kinds of particles.", "[{ mass = \"20 kg\", sizes = { normal = { mean = \"2 mm\", deviation = \"0.1 mm\" } } }]");

/// The content of a bunker at the start.
#[rustfmt::skip]
pub(super) const STORED: &[Key] = &[
    key("solids", Tables(HELD), Without("none"), "Solids; several tables are several kinds of particles.", "[{ mass = \"20 kg\", sizes = { normal = { mean = \"2 mm\", deviation = \"0.1 mm\" } } }]"),
    key("liquids", ByName(D::MASS), Without("none"), "Mass of each liquid.", "{ water = \"1 kg\" }"),
    key("vapours", ByName(D::MASS), Without("none"), "Mass of each gas and vapour.", "{ air = \"10 g\" }"),
    key("temperature", Number(D::TEMPERATURE, Positive), Required, "Temperature.", "\"300 K\""),
];
