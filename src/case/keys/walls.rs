//! Keys of `walls`.

use super::prelude::*;

#[rustfmt::skip]
const PLANE: &[Key] = &[
    key("point", Vector(D::LENGTH), Required, "A point of it.", "\"0 0 0 mm\""),
    key("normal", Vector(D::NONE), Required, "Direction into the side where particles are; of any length.", "\"0 0 1\""),
];

#[rustfmt::skip]
const CYLINDER: &[Key] = &[
    key("point", Vector(D::LENGTH), Required, "A point of its axis.", "\"0 0 0 mm\""),
    key("axis", Vector(D::NONE), Required, "Direction of its axis; of any length.", "\"0 0 1\""),
    key("radius", Number(D::LENGTH, Positive), Required, "Radius.", "\"25 mm\""),
];

#[rustfmt::skip]
const CONE: &[Key] = &[
    key("from", Vector(D::LENGTH), Required, "Centre of one end.", "\"0 0 0 mm\""),
    key("to", Vector(D::LENGTH), Required, "Centre of the other end.", "\"0 0 40 mm\""),
    key("from_radius", Number(D::LENGTH, NotNegative), Required, "Radius at `from`.", "\"5 mm\""),
    key("to_radius", Number(D::LENGTH, NotNegative), Required, "Radius at `to`.", "\"25 mm\""),
];

#[rustfmt::skip]
const ROTATING: &[Key] = &[
    key("point", Vector(D::LENGTH), Required, "A point of the axis.", "\"0 0 0 mm\""),
    key("angular_velocity", Vector(D::ANGULAR_VELOCITY), Required, "Angular velocity along the axis.", "\"0 0 3 rad/s\""),
];

#[rustfmt::skip]
pub(super) const WALLS: &[Key] = &[
    key("name", Text, Required, "Name.", "\"container\""),
    key("material", Text, Required, "Its material.", "\"steel\""),
    key("plane", Table(PLANE), OneOf, "An endless plane. One of `patches`, `plane`, `cylinder`, `cone`, `stl`.", "{ point = \"0 0 0 m\", normal = \"0 0 1\" }"),
    key("cylinder", Table(CYLINDER), OneOf, "The inner side of an endless cylinder. One of `patches`, `plane`, `cylinder`, `cone`, `stl`.", "{ point = \"0 0 0 m\", axis = \"0 0 1\", radius = \"25 mm\" }"),
    key("cone", Table(CONE), OneOf, "The inner side of the frustum of a cone. One of `patches`, `plane`, `cylinder`, `cone`, `stl`.", "{ from = \"0 0 0 mm\", to = \"0 0 40 mm\", from_radius = \"5 mm\", to_radius = \"25 mm\" }"),
    key("stl", Path, OneOf, "Triangles of an STL file, ASCII or binary; both their sides are wall. One of `patches`, `plane`, `cylinder`, `cone`, `stl`.", "\"wall.stl\""),
    key("patches", Texts(0), OneOf, "The sides of the generated mesh that carry these patches, the round side of a cylinder being the circle of its diameter; of a `polymesh` the faces of these patches, as triangles. One of `patches`, `plane`, `cylinder`, `cone`, `stl`.", "[\"side\", \"bottom\"]"),
    key("scale", Number(D::NONE, Positive), Default("1"), "Length in m of a unit of the STL file.", "1e-3"),
    key("velocity", Vector(D::VELOCITY), Without("at rest"), "Velocity of the wall. Not with `rotating`.", "\"0 0 0.1 m/s\""),
    key("rotating", Table(ROTATING), Without("at rest"), "The wall turns about an axis. Not with `velocity`.", "{ point = \"0 0 0 m\", angular_velocity = \"0 0 3 rad/s\" }"),
    key("temperature", Schedule(D::TEMPERATURE, Positive), Without("adiabatic"), "Temperature of the wall, for conduction and radiation between it and particles. A wall without it conducts nothing and reflects radiation as a mirror.", "\"400 K\""),
];
