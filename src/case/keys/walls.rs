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
pub(super) const ROTATING: &[Key] = &[
    key("point", Vector(D::LENGTH), Required, "A point of the axis.", "\"0 0 0 mm\""),
    key("angular_velocity", Vector(D::ANGULAR_VELOCITY), Required, "Angular velocity along the axis.", "\"0 0 3 rad/s\""),
];

#[rustfmt::skip]
const MOVED: &[Key] = &[
    key("direction", Vector(D::NONE), Required, "Direction in which it is moved; of any length.", "\"1 0 0\""),
    key("distance", Schedule(D::LENGTH, Any), Required, "Distance from where it starts over process time: linear between entries, constant outside them, 0 at the start of the run.", "[[\"5 s\", \"0 mm\"], [\"6 s\", \"40 mm\"]]"),
];

#[rustfmt::skip]
const OSCILLATING: &[Key] = &[
    key("amplitude", Vector(D::LENGTH), Required, "Largest displacement A; the wall is displaced by A sin(2 π t/T).", "\"0 0 2 mm\""),
    key("period", Number(D::TIME, Positive), Required, "Period T in process time.", "\"50 ms\""),
];

#[rustfmt::skip]
const SERVO: &[Key] = &[
    key("direction", Vector(D::NONE), Required, "Direction in which it presses, against the particles; of any length. It moves along this line, to either side.", "\"0 0 -1\""),
    key("force", Number(D::FORCE, Positive), OneOf, "Force with which it presses, its weight included. One of `force`, `pressure`.", "\"10 N\""),
    key("pressure", Number(D::PRESSURE, Positive), OneOf, "Pressure with which it presses, over `area`. One of `force`, `pressure`.", "\"5 kPa\""),
    key("area", Number(D::AREA, Positive), Without("required with `pressure`"), "Area over which `pressure` presses.", "\"20 cm^2\""),
    key("mass", Number(D::MASS, Positive), Required, "Mass m of the wall: its speed v follows m dv/dt = F - c v less the force of the particles.", "\"0.2 kg\""),
    key("damping", Number(D::MASS_FLOW, NotNegative), Default("0 N s/m"), "Damping c of its motion: a wall that touches nothing approaches the speed F/c.", "\"50 N s/m\""),
];

#[rustfmt::skip]
pub(super) const WALLS: &[Key] = &[
    key("name", Text, Required, "Name.", "\"container\""),
    key("material", Text, Required, "Its material.", "\"steel\""),
    key("plane", Table(PLANE), OneOf, "An endless plane. One of `patches`, `plane`, `cylinder`, `cone`, `stl`.", "{ point = \"0 0 0 m\", normal = \"0 0 1\" }"),
    key("cylinder", Table(CYLINDER), OneOf, "The inner side of an endless cylinder. One of `patches`, `plane`, `cylinder`, `cone`, `stl`.", "{ point = \"0 0 0 m\", axis = \"0 0 1\", radius = \"25 mm\" }"),
    key("cone", Table(CONE), OneOf, "The inner side of the frustum of a cone. One of `patches`, `plane`, `cylinder`, `cone`, `stl`.", "{ from = \"0 0 0 mm\", to = \"0 0 40 mm\", from_radius = \"5 mm\", to_radius = \"25 mm\" }"),
    key("stl", Path, OneOf, "Triangles of an STL file, ASCII or binary; both their sides are wall. One of `patches`, `plane`, `cylinder`, `cone`, `stl`.", "\"wall.stl\""),
    key("patches", Texts(0), OneOf, "The sides of the generated mesh that carry these patches, the round side of a cylinder being the circle of its diameter; of a `polymesh`, and of bodies cut out of a generated mesh, the faces of these patches, as triangles. One of `patches`, `plane`, `cylinder`, `cone`, `stl`.", "[\"side\", \"bottom\"]"),
    key("scale", Number(D::NONE, Positive), Default("1"), "Length in m of a unit of the STL file.", "1e-3"),
    key("velocity", Vector(D::VELOCITY), Without("at rest"), "Velocity of the wall. One of `velocity`, `rotating`, `moved`, `oscillating`, `servo`.", "\"0 0 0.1 m/s\""),
    key("rotating", Table(ROTATING), Without("at rest"), "The wall turns about an axis. One of `velocity`, `rotating`, `moved`, `oscillating`, `servo`.", "{ point = \"0 0 0 m\", angular_velocity = \"0 0 3 rad/s\" }"),
    key("moved", Table(MOVED), Without("at rest"), "The wall is moved along a line by a schedule, as gates and dampers are; not in LIGGGHTS, nor with `motion.held`. One of `velocity`, `rotating`, `moved`, `oscillating`, `servo`.", "{ direction = \"1 0 0\", distance = [[\"5 s\", \"0 mm\"], [\"6 s\", \"40 mm\"]] }"),
    key("oscillating", Table(OSCILLATING), Without("at rest"), "The wall oscillates, as vibrated floors do; not in LIGGGHTS, nor with `motion.held`. One of `velocity`, `rotating`, `moved`, `oscillating`, `servo`.", "{ amplitude = \"0 0 2 mm\", period = \"50 ms\" }"),
    key("servo", Table(SERVO), Without("at rest"), "The wall is moved along a line to hold a force or a pressure, as plates that load a bed are; not in LIGGGHTS. One of `velocity`, `rotating`, `moved`, `oscillating`, `servo`.", "{ direction = \"0 0 -1\", force = \"10 N\", mass = \"0.2 kg\" }"),
    key("temperature", Schedule(D::TEMPERATURE, Positive), Without("adiabatic"), "Temperature of the wall, for conduction and radiation between it and particles. A wall without it conducts nothing and reflects radiation as a mirror.", "\"400 K\""),
    key("body", Text, Without("none"), "One of `bodies` that the wall belongs to, whose temperature it has in place of `temperature`, and which gives the heat.", "\"crucible\""),
];
