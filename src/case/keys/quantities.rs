//! Keys of `quantities`.

use super::prelude::*;
use super::zone::ZONE;

#[rustfmt::skip]
const MEASURE_SURFACE_ANGLE: &[Key] = &[
    key("point", Vector(D::LENGTH), Required, "A point of the axis.", "\"0 0 0 mm\""),
    key("axis", Vector(D::NONE), Required, "Direction of the axis; angles count as rotations about it do.", "\"0 1 0\""),
];

#[rustfmt::skip]
const MEASURE: &[Key] = &[
    key("difference", Choice(words::<DifferenceField>), OneOf, "Area mean on the first of `patches` minus that on the second.", "\"pressure\""),
    key("patches", Texts(2), Without("none"), "The two patches; required with `difference`.", "[\"bottom\", \"top\"]"),
    key("gas", Choice(words::<GasField>), OneOf, "A statistic of the gas: over all cells (the mean over the volume of gas), over `patch` or over `probe`.", "\"temperature\""),
    key("patch", Text, Without("all cells"), "The patch; with `gas`, whose mean is over its area, and required with `flow` and `force`.", "\"top\""),
    key("probe", Text, Without("everywhere"), "The probe, with `gas` or `particles`.", "\"axis\""),
    key("of", Text, Without("none"), "The species of the gas, or the solid of particles that react, of which a `mass_fraction`, a `conversion` or the `flow` of a species is; required with these.", "\"CO2\""),
    key("particles", Choice(words::<ParticleField>), OneOf, "A statistic over all particles, over those of `population`, `material` and `zone`, or over those at `probe`. Speeds and the kinetic energy (of flight and spin) are of process time, `height` is z, `count` is 1 for each, `conversion` the share of a solid that has reacted of what the particle came with, by which its mean and deviation are weighted; `mean_temperature`, `centre_temperature` and `shell_count` are of particles with shells, of thin ones their temperature and 1.", "\"temperature\""),
    key("population", Text, Without("all"), "The population, with `particles` and `discharge`.", "\"beads\""),
    key("material", Text, Without("all"), "The material, with `particles`.", "\"glass\""),
    key("zone", Table(ZONE), Without("everywhere"), "Where the centres lie of the particles that count, with `particles`.", "{ box = { from = \"0 0 0 mm\", to = \"10 10 50 mm\" } }"),
    key("statistic", Choice(words::<Statistic>), Without("with `probe` the mean, of `count` the sum"), "The statistic; required with `gas` and `particles`. `sum` is for `count`, `mass` and `kinetic_energy`; particles count by their weights, gas by its volume or area. `mass-flow-mean`, of `temperature` or `mass_fraction` with `patch`, is weighted by the mass flow through it (mixing-cup mean), the temperature by enthalpy.", "\"mean\""),
    key("particle", Choice(words::<ParticleField>), OneOf, "The value of one particle.", "\"temperature\""),
    key("number", Whole(1, MOST), Without("none"), "Which particle, counted from 1; required with `particle`.", "10"),
    key("wall_heat", Text, OneOf, "Heat in W from a wall of a temperature, or from `surroundings`, into the particles.", "\"hot\""),
    key("flow", Choice(words::<Passing>), OneOf, "What flows through `patch` into the gas, a mean over the last window: `heat` in W (conduction, and sensible enthalpy from 298.15 K on that flows with the gas), `mass` in kg/s, or one of the `species`, `of`, in kg/s.", "\"heat\""),
    key("force", Choice(words::<ForcePart>), OneOf, "Force in N of the gas on the wall `patch`, along a direction: that of the `pressure` above `gas.pressure`, `viscous` (a mean over the last window), or the `total`.", "\"viscous\""),
    key("along", Vector(D::NONE), Without("none"), "Direction; required with `force`.", "\"0 0 1\""),
    key("discharge", Choice(words::<Discharged>), OneOf, "Particles that left through outlets: `mass_flow` in kg/s, `mass` in kg, `count`, or the `residence_time` in s since feeds brought them, a mean over their mass, and its standard deviation `residence_deviation`. With `population` of what is tagged by it.", "\"mass_flow\""),
    key("outlet", Text, Without("all"), "The outlet, with `discharge`.", "\"exit\""),
    key("over", Number(D::TIME, Positive), Without("since the start"), "Process time up to now that counts, with `discharge`; of the window in which it begins, the part after that.", "\"10 s\""),
    key("body", Text, OneOf, "Temperature of one of `bodies`.", "\"crucible\""),
    key("surface_angle", Table(MEASURE_SURFACE_ANGLE), OneOf, "Slope of the bed in a drum, in rad: the angle by which the centre of mass of all particles has turned about an axis from straight below it; a flat surface stands across the line between them.", "{ point = \"0 0 0 mm\", axis = \"0 1 0\" }"),
];

#[rustfmt::skip]
const EXPECT: &[Key] = &[
    key("at", Number(D::TIME, Any), Without("the end"), "Process time at which it holds.", "\"10 min\""),
    key("value", Measured, Required, "The value.", "\"180 Pa\""),
    key("within", Band, Required, "How far off it may be.", "\"5 %\""),
];

#[rustfmt::skip]
pub(super) const QUANTITIES: &[Key] = &[
    key("name", Text, Required, "Name; no two alike.", "\"pressure_drop\""),
    key("measure", Table(MEASURE), Required, "Exactly one of `difference`, `gas`, `particles`, `particle`, `wall_heat`, `flow`, `force`, `discharge`, `body` and `surface_angle`.", "{ particles = \"temperature\", statistic = \"mean\" }"),
    key("agree", Band, Without("not compared"), "Largest difference between pairings: a share of the value at each time, or, for what runs to zero, in the unit of the quantity.", "\"1 %\""),
    key("agree_from", Number(D::TIME, Any), Without("the start"), "Process time from which `agree` holds: before it the quantity may depend on how single particles collide.", "\"0.3 s\""),
    key("agree_over", Number(D::TIME, Positive), Without("values as they are"), "Process time over which recorded values are averaged before pairings are compared; for what fluctuates. With `agree`.", "\"1 s\""),
    key("expect", Table(EXPECT), Without("none"), "Expected value.", "{ at = \"10 min\", value = \"180 Pa\", within = \"5 %\" }"),
];
