//! Keys of parts of space, wherever a case states one.

use super::prelude::*;

/// A box or a cylinder.
pub(super) const ZONE: &[Key] = &[ZONE_BOX, ZONE_CYLINDER];

#[rustfmt::skip]
pub(super) const ZONE_BOX: Key =
    key("box", Table(BOX), OneOf, "A box along the axes. Either this or `cylinder`.", "{ from = \"0 0 0 mm\", to = \"10 10 50 mm\" }");

#[rustfmt::skip]
pub(super) const ZONE_CYLINDER: Key =
    key("cylinder", Table(CYLINDER), OneOf, "A cylinder of any direction. Either this or `box`.", "{ from = \"0 0 0 mm\", to = \"0 0 50 mm\", radius = \"8 mm\" }");

#[rustfmt::skip]
pub(super) const BOX: &[Key] = &[
    key("from", Vector(D::LENGTH), Required, "Corner with the smallest coordinates.", "\"0 0 0 mm\""),
    key("to", Vector(D::LENGTH), Required, "Corner with the largest coordinates.", "\"10 10 50 mm\""),
];

#[rustfmt::skip]
pub(super) const CYLINDER: &[Key] = &[
    key("from", Vector(D::LENGTH), Required, "Centre of one end.", "\"0 0 0 mm\""),
    key("to", Vector(D::LENGTH), Required, "Centre of the other end.", "\"0 0 50 mm\""),
    key("radius", Number(D::LENGTH, Positive), Required, "Radius.", "\"8 mm\""),
];
