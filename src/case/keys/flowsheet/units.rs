//! Keys of `units`.

use super::solids::{CONTENT, DISTRIBUTION, INLET, STORED};
use crate::case::keys::prelude::*;
use crate::laws;

const NO_KEYS: &[Key] = &[];

#[rustfmt::skip]
pub(super) const UNITS: &[Key] = &[
    key("name", Text, Required, "Name, without a point; no two alike.", "\"mill\""),
    key("inlet", Table(INLET), OneOf, "Where material enters the plant. Port out: `out`.", "{ liquids = { urea = \"50 g/s\" }, temperature = \"300 K\" }"),
    key("outlet", Table(NO_KEYS), OneOf, "Where material leaves the plant. Port in: `in`.", "{}"),
    key("mixer", Table(MIXER), OneOf, "Brings streams together. Ports in: `in1`, `in2`, …; out: `out`.", "{ inlets = 2 }"),
    key("splitter", Table(SPLITTER), OneOf, "Divides a stream into streams of its composition. Port in: `in`; out: `out1`, `out2`, ….", "{ shares = [0.9, 0.1] }"),
    key("screen", Law(laws::screen, &[]), OneOf, "Divides solids by size; liquids go with the solids, vapours with the fines. Port in: `in`; out: `coarse`, `fine`.", "{ law = \"plitt\", cut = \"2 mm\", sharpness = 4 }"),
    key("mill", Law(laws::mill, &[]), OneOf, "Mills solids. Port in: `in`; out: `out`.", "{ law = \"constant\", mean = \"1 mm\", deviation = \"0.1 mm\" }"),
    key("granulator", Table(GRANULATOR), OneOf, "A well-mixed granulator with a population balance. Ports in: `feed`, `spray`, `gas`; out: `product`, `exhaust`.", "[units.granulator]"),
    key("dryer", Table(DRYER), OneOf, "Dries solids with gas. Ports in: `in`, `gas`; out: `out`, `exhaust`.", "{ moisture = 0.01 }"),
    key("cyclone", Table(CYCLONE), OneOf, "A gas cyclone by Muschelknautz' model. Port in: `in`; out: `solids`, `gas`.", "[units.cyclone]"),
    key("bunker", Table(BUNKER), OneOf, "A well-mixed store. Port in: `in`; out: `out`.", "{ content = { temperature = \"300 K\" } }"),
    key("bed", Table(BED), OneOf, "A bed that is computed particle by particle as a case of its own, and exchanges with the plant at intervals. It opens a recycle. Port in: `feed`; out: `product`.", "[units.bed]"),
    key("controller", Table(CONTROLLER), OneOf, "A controller in proportion and integral (PI) with bounds, whose output inlets, splitters and bunkers that name it take. Its integral does not wind up at a bound. No ports.", "[units.controller]"),
    key("delay", Table(DELAY), OneOf, "A conveyor or pipe: what enters leaves after a time, in well-mixed stages. It opens a recycle. Port in: `in`; out: `out`.", "{ time = \"30 s\", stages = 20 }"),
];

#[rustfmt::skip]
const MIXER: &[Key] = &[
    key("inlets", Whole(1, 1000), Default("2"), "How many streams enter.", "2"),
];

#[rustfmt::skip]
const SPLITTER: &[Key] = &[
    key("shares", Numbers(0), Required, "Share of each outlet; they sum to 1.", "[0.9, 0.1]"),
    key("controller", Text, Without("none"), "Controller whose output is the share of `out1`; the others divide the rest as their shares are.", "\"purge\""),
];

#[rustfmt::skip]
const CONTROLLER: &[Key] = &[
    key("stream", Text, OneOf, "The stream that is measured. Either this or `unit`.", "\"product\""),
    key("unit", Text, OneOf, "The unit whose content is measured. Either this or `stream`.", "\"bunker\""),
    key("field", Choice(words::<PlantField>), Required, "What is measured. Of a unit flows are masses.", "\"mass_flow\""),
    key("of", Text, Without("required with `compound`"), "Compound of the field `compound`.", "\"water\""),
    key("set_point", Measured, Required, "What the measurement is to be.", "\"20 kg\""),
    key("gain", Number(D::NONE, Any), Required, "Change of the output for a change of the measurement by one SI unit; negative where more output lowers the measurement.", "0.02"),
    key("time", Number(D::TIME, Positive), Without("in proportion alone"), "Time of the integral.", "\"5 min\""),
    key("filter", Number(D::TIME, Positive), Required, "Time by which the measurement is filtered; the filter begins at the set point.", "\"10 s\""),
    key("start", Number(D::NONE, Any), Required, "Output at the start, between `low` and `high`.", "1"),
    key("low", Number(D::NONE, Any), Required, "Lower bound of the output.", "0"),
    key("high", Number(D::NONE, Any), Required, "Upper bound of the output.", "2"),
];

#[rustfmt::skip]
const DRYER: &[Key] = &[
    key("moisture", Number(D::NONE, NotNegative), Required, "Volatile liquid left in kg per kg of solids.", "0.01"),
];

#[rustfmt::skip]
const GRANULATOR: &[Key] = &[
    key("density", Number(D::DENSITY, Positive), Required, "Density of granules.", "\"1320 kg/m^3\""),
    CONTENT,
    key("temperature", Number(D::TEMPERATURE, Positive), Required, "Temperature of the bed; with `heat = \"balanced\"` at the start.", "\"300 K\""),
    key("heat", Choice(words::<HeatOfBed>), Default("held"), "Whether the temperature is held, at the cost of heat that is a term of the ledger, or follows from what enters and evaporates.", "\"balanced\""),
    key("moisture", Number(D::NONE, NotNegative), Default("0"), "Volatile liquid that bed and product keep, in kg per kg of solids.", "0.01"),
    key("level", Table(LEVEL), Without("the mass stays: what enters pushes out as much"), "How much the bed holds: one of `residence` and `controlled`.", "{ residence = \"10 min\" }"),
    key("growth", Table(GROWTH), Without("all sizes grow alike"), "Growth of a diameter relative to others; the spray's mass sets its scale. One of `linear` and `table`.", "{ linear = \"1 mm\" }"),
    key("scheme", Choice(words::<SchemeOfGrowth>), Default("van-leer"), "Discretisation of growth.", "\"van-leer\""),
    key("overspray", Table(OVERSPRAY), Without("none"), "Spray that dries before it hits a particle.", "{ share = 0.05 }"),
    key("wear", Number(D::VELOCITY, NotNegative), Default("0 m/s"), "Rate at which every diameter shrinks by attrition; what is worn off is dust.", "\"1e-9 m/s\""),
    key("aggregation", Law(laws::aggregation, &[]), Without("none"), "Aggregation of pairs of particles.", "{ law = \"constant\", rate = \"1e-9 1/s\" }"),
    key("kernel", Table(KERNEL), Without("none"), "Aggregation by a table of rates, measured or computed at another scale.", "{ diameters = [\"1 mm\", \"2 mm\"], rates = [\"1e-9 1/s\", \"2e-9 1/s\", \"2e-9 1/s\", \"4e-9 1/s\"] }"),
    key("collisions", Table(COLLISIONS), Without("none"), "Aggregation by the collisions that a bed of this plant counts.", "{ bed = \"bed\", efficiency = 1e-3 }"),
    key("breakage", Law(laws::breakage, &[]), Without("none"), "Breakage of particles.", "{ law = \"random-binary\", rate = \"1e6 1/s/m^3\" }"),
];

#[rustfmt::skip]
const LEVEL: &[Key] = &[
    key("residence", Number(D::TIME, Positive), OneOf, "The product is the mass divided by this time. Either this or `controlled`.", "\"10 min\""),
    key("controlled", Table(CONTROLLED), OneOf, "A controller in proportion: the product is what enters, and the mass above the set point divided by the controller's time. Either this or `residence`.", "{ mass = \"20 kg\", time = \"60 s\" }"),
];

#[rustfmt::skip]
const CONTROLLED: &[Key] = &[
    key("mass", Number(D::MASS, Positive), Required, "Set point.", "\"20 kg\""),
    key("time", Number(D::TIME, Positive), Required, "Time of the controller.", "\"60 s\""),
];

#[rustfmt::skip]
const GROWTH: &[Key] = &[
    key("linear", Number(D::LENGTH, Positive), OneOf, "g = 1 + d over this length. Either this or `table`.", "\"1 mm\""),
    key("table", Shares, OneOf, "Diameters, each with its g: linear between the points, constant beyond. Either this or `linear`.", "[[\"1 mm\", 1], [\"2 mm\", 1.3]]"),
];

#[rustfmt::skip]
const KERNEL: &[Key] = &[
    key("diameters", Texts(0), Required, "Diameters, rising.", "[\"1 mm\", \"2 mm\"]"),
    key("rates", Texts(0), Required, "Rate at which a pair of particles of the bed aggregates, for each diameter each, row by row; bilinear between, constant beyond.", "[\"1e-9 1/s\", \"2e-9 1/s\", \"2e-9 1/s\", \"4e-9 1/s\"]"),
];

#[rustfmt::skip]
const COLLISIONS: &[Key] = &[
    key("bed", Text, Required, "Unit of kind `bed` that has a `kernel`.", "\"bed\""),
    key("efficiency", Number(D::NONE, Between(0.0, 1.0)), Required, "Share of the collisions after which two particles stay together.", "1e-3"),
];

#[rustfmt::skip]
const BED: &[Key] = &[
    key("case", Path, Required, "Case file of the bed. It has feeds and outlets; its materials are compounds of the plant by their names; what each feed brings, and how warm, comes from the plant.", "\"plant-bed-shaft.toml\""),
    key("interval", Number(D::TIME, Positive), Required, "Time between two exchanges: what flowed in over one is fed, and what left the bed in it flows out over the next.", "\"1 s\""),
    key("kernel", Table(BED_KERNEL), Without("none"), "The kernel of collisions that the bed returns, for `granulator.collisions`.", "{ diameters = [\"4 mm\", \"6 mm\"] }"),
];

#[rustfmt::skip]
const BED_KERNEL: &[Key] = &[
    key("diameters", Texts(0), Required, "Diameters, rising, to which particles are counted by their ratio.", "[\"4 mm\", \"6 mm\"]"),
    key("gap", Number(D::NONE, Within(0.0, 1.0)), Default("0.05"), "Pairs count that are nearer than this share of their mean diameter, and approach: small against the distance between particles, large enough that pairs are found.", "0.05"),
];

#[rustfmt::skip]
const OVERSPRAY: &[Key] = &[
    key("share", Number(D::NONE, Between(0.0, 1.0)), Required, "Share of the sprayed solids that becomes dust.", "0.05"),
    key("returned", Number(D::NONE, Between(0.0, 1.0)), Default("0"), "Share of all dust that stays in the bed as nuclei; the rest leaves with the exhaust.", "0.5"),
    key("sizes", Table(DISTRIBUTION), Without("the first class"), "Distribution of the dust.", "{ normal = { mean = \"0.1 mm\", deviation = \"10 um\" } }"),
];

#[rustfmt::skip]
const CYCLONE: &[Key] = &[
    key("diameter", Number(D::LENGTH, Positive), Required, "Diameter.", "\"0.5 m\""),
    key("height", Number(D::LENGTH, Positive), Required, "Height.", "\"1.5 m\""),
    key("cylinder_height", Number(D::LENGTH, Positive), Required, "Height of the cylindrical part.", "\"0.6 m\""),
    key("finder_diameter", Number(D::LENGTH, Positive), Required, "Diameter of the vortex finder.", "\"0.2 m\""),
    key("finder_depth", Number(D::LENGTH, Positive), Required, "Depth of the vortex finder.", "\"0.3 m\""),
    key("exit_diameter", Number(D::LENGTH, Positive), Required, "Diameter of the exit of particles.", "\"0.15 m\""),
    key("slot_width", Number(D::LENGTH, Positive), Required, "Width of the slot.", "\"0.1 m\""),
    key("slot_height", Number(D::LENGTH, Positive), Required, "Height of the slot.", "\"0.25 m\""),
    key("wall_friction", Number(D::NONE, Positive), Default("0.005"), "Wall friction coefficient of pure gas.", "0.005"),
    key("curve_width", Number(D::NONE, AtLeast(1.0)), Default("3"), "Width of the separation curve: 2 for long thin cyclones to 4 for wide squat ones.", "3"),
    key("load_constant", Number(D::NONE, Positive), Default("0.025"), "Constant of the load limit: 0.02 for fine particles to 0.03 for coarse ones.", "0.025"),
    key("gas_density", Number(D::DENSITY, Positive), Required, "Density of the gas.", "\"1.2 kg/m^3\""),
    key("viscosity", Number(D::VISCOSITY, Positive), Required, "Viscosity of the gas.", "\"18.5e-6 Pa s\""),
    key("solid_density", Number(D::DENSITY, Positive), Required, "Density of particles.", "\"1320 kg/m^3\""),
];

#[rustfmt::skip]
const DELAY: &[Key] = &[
    key("time", Number(D::TIME, Positive), Required, "Mean time on the way.", "\"30 s\""),
    key("stages", Whole(1, 10_000), Required, "Stages: one is a stirred tank, many a plug; the variance of the time is its square over their number.", "20"),
];

#[rustfmt::skip]
const BUNKER: &[Key] = &[
    key("content", Table(STORED), Required, "What it holds at the start.", "{ temperature = \"300 K\" }"),
    key("discharge", Table(DISCHARGE), Without("what enters pushes out as much"), "How it empties: one of `residence`, `adaptive`, `rate` and `controller`.", "{ residence = \"10 min\" }"),
];

#[rustfmt::skip]
const DISCHARGE: &[Key] = &[
    key("residence", Number(D::TIME, Positive), OneOf, "The outflow is the mass divided by this time. One of `residence`, `adaptive`, `rate`, `controller`.", "\"10 min\""),
    key("adaptive", Number(D::MASS, Positive), OneOf, "Target: the outflow is the inflow times (2 m/(m + target))². One of `residence`, `adaptive`, `rate`, `controller`.", "\"20 kg\""),
    key("rate", Schedule(D::MASS_FLOW, NotNegative), OneOf, "Mass flow over time. One of `residence`, `adaptive`, `rate`, `controller`.", "\"0.1 kg/s\""),
    key("controller", Text, OneOf, "Controller whose output is the mass flow in kg/s. One of `residence`, `adaptive`, `rate`, `controller`.", "\"level\""),
    key("between", Choice(words::<InBetween>), Default("line"), "How the rate runs between its points: in straight lines, or in steps that hold to the next.", "\"step\""),
];
