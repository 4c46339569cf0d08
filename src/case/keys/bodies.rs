//! Keys of `bodies`.

use super::prelude::*;

#[rustfmt::skip]
const RADIATION: &[Key] = &[
    key("area", Number(D::AREA, Positive), Required, "Area that radiates.", "\"85 mm^2\""),
    key("emissivity", Number(D::NONE, UpTo(0.0, 1.0)), Required, "Emissivity of the exchange between the two.", "0.15"),
    key("surroundings", Schedule(D::TEMPERATURE, Positive), Required, "Temperature of the surroundings over process time.", "[[\"0 s\", \"300 K\"], [\"2 h\", \"1300 K\"]]"),
];

#[rustfmt::skip]
pub(super) const BODIES: &[Key] = &[
    key("material", Text, Required, "Its material, for its heat capacity.", "\"platinum\""),
    key("mass", Number(D::MASS, Positive), Required, "Its mass.", "\"200 mg\""),
    key("temperature", Number(D::TEMPERATURE, Positive), Required, "Its temperature at the start.", "\"293.15 K\""),
    key("radiation", Table(RADIATION), Without("none"), "Radiation to surroundings, beside that of its walls to particles.", "{ area = \"85 mm^2\", emissivity = 0.15, surroundings = \"1000 K\" }"),
];
