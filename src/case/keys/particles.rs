//! Keys of `particles`, `feeds` and `outlets`.

use super::prelude::*;
use super::zone::{BOX, CYLINDER, ZONE};

#[rustfmt::skip]
const DIAMETER_NORMAL: &[Key] = &[
    key("mean", Number(D::LENGTH, AtLeast(1e-9)), Required, "Mean before it is cut off; between `min` and `max`.", "\"4 mm\""),
    key("deviation", Number(D::LENGTH, Positive), Required, "Standard deviation before it is cut off.", "\"0.4 mm\""),
    key("min", Number(D::LENGTH, AtLeast(1e-9)), Required, "Smallest diameter.", "\"3 mm\""),
    key("max", Number(D::LENGTH, AtLeast(1e-9)), Required, "Largest diameter.", "\"5 mm\""),
];

#[rustfmt::skip]
const DIAMETER_LOG_NORMAL: &[Key] = &[
    key("median", Number(D::LENGTH, AtLeast(1e-9)), Required, "Median before it is cut off; between `min` and `max`.", "\"4 mm\""),
    key("deviation", Number(D::NONE, Positive), Required, "Geometric standard deviation, above 1.", "1.3"),
    key("min", Number(D::LENGTH, AtLeast(1e-9)), Required, "Smallest diameter.", "\"2 mm\""),
    key("max", Number(D::LENGTH, AtLeast(1e-9)), Required, "Largest diameter.", "\"8 mm\""),
];

#[rustfmt::skip]
const DIAMETER_UNIFORM: &[Key] = &[
    key("min", Number(D::LENGTH, AtLeast(1e-9)), Required, "Smallest diameter.", "\"3 mm\""),
    key("max", Number(D::LENGTH, AtLeast(1e-9)), Required, "Largest diameter.", "\"5 mm\""),
];

#[rustfmt::skip]
const DIAMETER: &[Key] = &[
    key("normal", Table(DIAMETER_NORMAL), OneOf, "A normal distribution, cut off.", "{ mean = \"4 mm\", deviation = \"0.4 mm\", min = \"3 mm\", max = \"5 mm\" }"),
    key("log_normal", Table(DIAMETER_LOG_NORMAL), OneOf, "A log-normal distribution, cut off.", "{ median = \"4 mm\", deviation = 1.3, min = \"2 mm\", max = \"8 mm\" }"),
    key("uniform", Table(DIAMETER_UNIFORM), OneOf, "All diameters of a range alike.", "{ min = \"3 mm\", max = \"5 mm\" }"),
    key("table", Shares, OneOf, "Diameters, each with its share; shares are scaled to sum to 1.", "[[\"4 mm\", 0.3], [\"6 mm\", 0.7]]"),
    key("share", Choice(words::<Share>), Required, "What the distribution is of.", "\"number\""),
    key("seed", Whole(0, MOST), Required, "Equal seeds draw equal diameters.", "1"),
];

#[rustfmt::skip]
const PLACE_GRID: &[Key] = &[
    key("first", Vector(D::LENGTH), Required, "Centre of the first particle.", "\"5 5 5 mm\""),
    key("spacing", Vector(D::LENGTH), Required, "Distances of centres along x, y, z; at least the diameter.", "\"10 10 10 mm\""),
    key("counts", Wholes(3), Required, "Particles along x, y, z; 1e9 in all at most.", "[1, 1, 10]"),
];

#[rustfmt::skip]
const PLACE_REGION: &[Key] = &[
    key("from", Number(D::LENGTH, Any), Without("needed for a layer of a generated mesh, with `to`"), "Lowest z.", "\"60 mm\""),
    key("to", Number(D::LENGTH, Any), Without("needed for a layer of a generated mesh, with `from`"), "Highest z.", "\"90 mm\""),
    key("box", Table(BOX), Without("either this, `cylinder`, or `from` and `to`"), "A box along the axes.", "{ from = \"0 0 0 mm\", to = \"10 10 50 mm\" }"),
    key("cylinder", Table(CYLINDER), Without("either this, `box`, or `from` and `to`"), "An upright cylinder.", "{ from = \"0 0 0 mm\", to = \"0 0 50 mm\", radius = \"8 mm\" }"),
];

#[rustfmt::skip]
const PLACE: &[Key] = &[
    key("grid", Table(PLACE_GRID), OneOf, "A regular stacking. Either this or `file`.", "{ first = \"5 5 5 mm\", spacing = \"10 10 10 mm\", counts = [1, 1, 10] }"),
    key("file", Path, OneOf, "Particles of a file: `.csv`, a LIGGGHTS text dump, `.dat` of MFiX, `.vtk` (ASCII), `.vtp` or `.vtu` (ASCII or raw). Lengths in m; diameter or radius, temperature, velocity and weight where it has them.", "\"bed.csv\""),
    key("height", Number(D::LENGTH, Positive), Without("with `packing`, either this or `region`"), "Height of the packing above the bottom of the mesh.", "\"145 mm\""),
    key("region", Table(PLACE_REGION), Without("with `packing`, either this or `height`"), "What the packing fills: a layer of a generated mesh (`from`, `to`), so that populations lie one above the other, or a box or an upright cylinder within any mesh.", "{ from = \"60 mm\", to = \"90 mm\" }"),
    key("solid_fraction", Number(D::NONE, Within(0.0, 0.74)), Without("with `random`, either this or `number`"), "Volume of spheres over the filled space, layers at the walls included; up to about 0.59 with equal spheres.", "0.58"),
    key("number", Whole(1, 10_000_000), Without("with `random`, either this or `solid_fraction`"), "Number of spheres between the ends of the packing.", "2000"),
    key("seed", Whole(0, MOST), Without("required with `random`"), "Equal seeds give equal packings, bit for bit.", "1"),
    key("packing", Choice(words::<PackingName>), OneOf, "A packing from wall to wall of a generated mesh, or of a region's: random by geometry alone, without gravity, or a regular stacking of whole spheres from the bottom on.", "\"random\""),
    key("timestep", Whole(0, MOST), Without("the last one"), "The snapshot of a dump.", "20000"),
    key("type", Whole(0, MOST), Without("all"), "Only particles whose column `type` says so; of results of Calcine, whose `population` does (from 0).", "1"),
];

#[rustfmt::skip]
pub(super) const PARTICLES: &[Key] = &[
    key("name", Text, Required, "Name; no two alike.", "\"beads\""),
    key("material", Text, Required, "One of `materials`.", "\"glass\""),
    key("diameter", Either(&Number(D::LENGTH, AtLeast(1e-9)), &Table(DIAMETER)), Required, "Diameter, 1 nm at least, or a distribution: exactly one of `normal`, `log_normal`, `uniform` and `table`. Where a file of particles states diameters, those count.", "\"10 mm\""),
    key("motion", Choice(words::<MotionSpec>), Required, "How the particles move: not at all; by gravity, contacts and the force of the gas; or as parcels that stand for many, by gravity, the stress of the solid and the force of the gas. What moves needs a section `[motion]`.", "\"frozen\""),
    key("velocity", Vector(D::VELOCITY), Without("at rest"), "Velocity at the start; of free particles.", "\"0 0 -0.1 m/s\""),
    key("temperature", Number(D::TEMPERATURE, Positive), OneOf, "Temperature at the start. Either this or `prescribed_temperature`.", "\"300 K\""),
    key("prescribed_temperature", Schedule(D::TEMPERATURE, Positive), OneOf, "Temperature over process time, whatever heat the particles take or give: a boundary condition. What that takes from outside is `prescribed_heat` in the ledger. Not of a material that reacts. Either this or `temperature`.", "[[\"0 s\", \"300 K\"], [\"10 min\", \"600 K\"]]"),
    key("weight", Number(D::NONE, Positive), Default("1"), "Statistical weight: how many real particles of this diameter each particle stands for, in all that it exchanges with the gas. Other than 1 for motion = \"frozen\" and \"parcels\" only, and without heat between particles. Where a file of particles has a column `weight`, that counts.", "2.5"),
    key("place", Table(PLACE), Required, "Where the particles are: exactly one of `grid`, `file` and `packing`. Spheres of two populations may overlap by 5 % of the sum of their radii, of one population by 20 %.", "{ file = \"bed.csv\" }"),
];

#[rustfmt::skip]
pub(super) const FEEDS: &[Key] = &[
    key("name", Text, Required, "Name.", "\"charge\""),
    key("population", Text, Required, "Of which population they are: it gives material and diameters.", "\"beads\""),
    key("region", Table(ZONE), Required, "Where: a box or a cylinder.", "{ box = { from = \"0 0 80 mm\", to = \"50 50 100 mm\" } }"),
    key("mass_rate", Number(D::MASS_FLOW, Positive), Without("none"), "Mass flow; particles wait where there is no room. This or `batch`, or both.", "\"1 kg/h\""),
    key("begin", Number(D::TIME, NotNegative), Without("the start"), "Process time at which the mass flow begins.", "\"10 min\""),
    key("end", Number(D::TIME, Positive), Without("never"), "Process time at which the mass flow ends: with `begin` a pulse of tracer, with a population of its own as its tag.", "\"11 min\""),
    key("batch", Number(D::MASS, Positive), Without("none"), "Mass that comes before the first window; what finds no room follows. This or `mass_rate`, or both.", "\"20 g\""),
    key("velocity", Vector(D::VELOCITY), Without("at rest"), "Velocity at which they come.", "\"0 0 -0.01 m/s\""),
    key("temperature", Number(D::TEMPERATURE, Positive), Without("that of the population"), "Their temperature.", "\"300 K\""),
    key("seed", Whole(0, MOST), Required, "Equal seeds give equal particles at equal places.", "1"),
];

#[rustfmt::skip]
pub(super) const OUTLETS: &[Key] = &[
    key("name", Text, Required, "Name.", "\"discharge\""),
    key("region", Table(ZONE), Required, "Where: a box or a cylinder.", "{ box = { from = \"0 0 80 mm\", to = \"50 50 100 mm\" } }"),
    key("mass_rate", Number(D::MASS_FLOW, Positive), Without("all that come there"), "Mass flow at most, the lowest along gravity first.", "\"1 kg/h\""),
];
