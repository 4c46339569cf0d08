//! Keys of cases of kind `flowsheet`.

mod output;
mod solids;
mod units;

use self::output::{CONTINUATION, OUTPUT, QUANTITIES, STEADY, TUNING};
use self::units::UNITS;
use super::prelude::*;

/// The keys of the file of a plant.
#[rustfmt::skip]
pub(super) const FLOWSHEET: &[Key] = &[
    key("format", Whole(0, MOST), Required, "Version of the format; 1 is the only one.", "1"),
    key("kind", Choice(|| vec!["flowsheet"]), Required, "What the file describes: a plant of units and streams.", "\"flowsheet\""),
    key("title", Text, Required, "Title for people.", "\"Granulation with a recycle\""),
    key("time", Table(TIME), Required, "How long the plant is followed.", "[time]"),
    key("method", Table(METHOD), Without("see its keys"), "How the plant is followed.", "[method]"),
    key("sizes", Table(SIZES), Required, "Size classes of all solids: exactly one of `uniform`, `geometric` and `edges`.", "[sizes]"),
    key("compounds", Named(COMPOUNDS), Required, "Compounds by name.", "[compounds.urea]"),
    key("attributes", Tables(ATTRIBUTES), Without("none"), "Further dimensions of the distributions: classes that particles belong to beside their size, such as colour or moisture, which stay with them through every unit.", "[[attributes]]"),
    key("units", Tables(UNITS), Required, "Units, each of one kind. What stands first is computed first within a recycle.", "[[units]]"),
    key("streams", Tables(STREAMS), Required, "Streams between units. Every port needs one.", "[[streams]]"),
    key("output", Table(OUTPUT), Required, "What is written.", "[output]"),
    key("quantities", Tables(QUANTITIES), Without("none"), "Quantities of interest.", "[[quantities]]"),
    key("steady", Table(STEADY), Without("none is looked for"), "The steady state next to the end of the run, and whether the plant returns to it.", "[steady]"),
    key("continuation", Table(CONTINUATION), Without("none"), "Steady states over the values of a key, and the values at which the plant gains or loses its stability.", "[continuation]"),
    key("tuning", Table(TUNING), Without("none"), "Keys of the plant that `calcine tune` fits to measurements.", "[tuning]"),
];

#[rustfmt::skip]
const TIME: &[Key] = &[
    key("end", Number(D::TIME, Positive), Required, "End of the run; all times of the case are times of the plant.", "\"1 h\""),
    key("checkpoint", Table(CHECKPOINT), Without("only on interrupt"), "When a checkpoint is written.", "{ wall = \"10 min\" }"),
];

#[rustfmt::skip]
const CHECKPOINT: &[Key] = &[
    key("every", Number(D::TIME, Positive), Without("never"), "A checkpoint with the first row of the series after each so much time.", "\"10 min\""),
    key("wall", Number(D::TIME, Positive), Without("never"), "A checkpoint with the first row of the series after each so much wall time.", "\"15 min\""),
];

#[rustfmt::skip]
const METHOD: &[Key] = &[
    key("recycles", Choice(words::<RecycleMethod>), Default("monolithic"), "How recycles are closed: at every evaluation, or by waveform relaxation, window by window.", "\"monolithic\""),
    key("integrator", Choice(words::<PlantIntegrator>), Default("explicit"), "How the unknowns of the units are followed: explicit of fifth order (Dormand and Prince), stabilised of second order for exchange that is fast (Runge–Kutta–Chebyshev), or stiff (Kennedy and Carpenter's ESDIRK4).", "\"explicit\""),
    key("tolerance", Number(D::NONE, Within(0.0, 1.0)), Default("1e-6"), "Error of a step that is allowed, relative to the size of the unknowns.", "1e-6"),
    key("tears", Texts(0), Without("by the order of the units"), "Streams at which recycles are torn: as many as open them all.", "[\"milled\"]"),
    key("waveform", Table(WAVEFORM), Without("see its keys"), "Windows of waveform relaxation; with `recycles = \"waveform\"`.", "{ longest = \"100 s\" }"),
];

#[rustfmt::skip]
const WAVEFORM: &[Key] = &[
    key("first", Number(D::TIME, Positive), Default("1 s"), "First window.", "\"1 s\""),
    key("shortest", Number(D::TIME, Positive), Default("1e-9 s"), "Shortest window.", "\"1 ms\""),
    key("longest", Number(D::TIME, Positive), Default("1000 s"), "Longest window.", "\"100 s\""),
    key("change", Number(D::NONE, Within(1.0, 10.0)), Default("1.2"), "Factor by which windows grow and shrink.", "1.2"),
    key("few", Whole(1, 10_000), Default("12"), "A window of at most so many iterations is followed by a longer one.", "12"),
    key("many", Whole(1, 10_000), Default("40"), "A window of more iterations is followed by a shorter one.", "40"),
    key("most", Whole(1, 100_000), Default("500"), "Most iterations of a window.", "500"),
    key("acceleration", Choice(words::<TearMethod>), Default("anderson"), "How tear streams are iterated.", "\"wegstein\""),
    key("wegstein_limit", Number(D::NONE, Any), Default("-0.5"), "Lower limit of Wegstein's q; with `acceleration = \"wegstein\"`.", "-0.5"),
];

#[rustfmt::skip]
const SIZES: &[Key] = &[
    key("uniform", Table(CLASSES), OneOf, "Classes of one width. One of `uniform`, `geometric`, `edges`.", "{ classes = 200, from = \"0 mm\", to = \"4 mm\" }"),
    key("geometric", Table(CLASSES), OneOf, "Classes whose edges have one ratio. One of `uniform`, `geometric`, `edges`.", "{ classes = 60, from = \"0.1 mm\", to = \"4 mm\" }"),
    key("edges", Texts(0), OneOf, "The edges, rising. One of `uniform`, `geometric`, `edges`.", "[\"0 mm\", \"1 mm\", \"2 mm\"]"),
];

#[rustfmt::skip]
const CLASSES: &[Key] = &[
    key("classes", Whole(2, 100_000), Required, "Number of classes.", "200"),
    key("from", Number(D::LENGTH, NotNegative), Required, "Smallest diameter.", "\"0 mm\""),
    key("to", Number(D::LENGTH, Positive), Required, "Largest diameter.", "\"4 mm\""),
];

#[rustfmt::skip]
const COMPOUNDS: &[Key] = &[
    key("volatile", Truth, Default("false"), "Whether its liquid evaporates in granulators and dryers; what does not is deposited.", "true"),
    key("solid_heat_capacity", Number(D::HEAT_CAPACITY, NotNegative), Required, "Heat capacity of the solid.", "\"1500 J/kg/K\""),
    key("liquid_heat_capacity", Number(D::HEAT_CAPACITY, NotNegative), Required, "Heat capacity of the liquid.", "\"4200 J/kg/K\""),
    key("vapour_heat_capacity", Number(D::HEAT_CAPACITY, NotNegative), Required, "Heat capacity of the vapour.", "\"1900 J/kg/K\""),
    key("evaporation_heat", Number(D::ENERGY_OF_MASS, NotNegative), Default("0 J/kg"), "Heat of evaporation at 273.15 K.", "\"2.5 MJ/kg\""),
];

#[rustfmt::skip]
const ATTRIBUTES: &[Key] = &[
    key("name", Text, Required, "Name; no two alike.", "\"colour\""),
    key("classes", Whole(1, 10_000), Required, "Number of classes.", "2"),
];

#[rustfmt::skip]
const STREAMS: &[Key] = &[
    key("name", Text, Required, "Name; no two alike.", "\"product\""),
    key("from", Text, Required, "Unit that it leaves, with the port behind a point where the unit has several.", "\"coarse.fine\""),
    key("to", Text, Required, "Unit that it enters, with the port behind a point where the unit has several.", "\"granulator.feed\""),
];
