//! Keys of what is written and looked for.

use crate::case::keys::prelude::*;

#[rustfmt::skip]
pub(super) const OUTPUT: &[Key] = &[
    key("every", Number(D::TIME, Positive), Required, "Time between rows of the series.", "\"10 s\""),
    key("distributions", Number(D::TIME, Positive), Without("at the start and the end alone"), "Time between distributions of all streams and units that hold solids; with the first row after it.", "\"5 min\""),
];

#[rustfmt::skip]
const MEASURE: &[Key] = &[
    key("stream", Text, OneOf, "A stream, of which `field` is measured. One of `stream`, `unit`, `steady`, `limit`.", "\"product\""),
    key("unit", Text, OneOf, "What a unit holds, of which `field` is measured. One of `stream`, `unit`, `steady`, `limit`.", "\"granulator\""),
    key("field", Choice(words::<PlantField>), Without("none"), "What is measured; required with `stream` and `unit`. Of a unit flows are masses.", "\"mass_flow\""),
    key("of", Text, Without("none"), "The compound of a `compound` field; required with it.", "\"water\""),
    key("over", Choice(words::<OverTime>), Default("last"), "The last value, or of the values from `from` on the mean, the smallest, the largest, the difference of these, or the period of what oscillates.", "\"span\""),
    key("from", Number(D::TIME, NotNegative), Default("0 s"), "Time from which values count, with `over`.", "\"30000 s\""),
    key("steady", Choice(words::<SteadyField>), OneOf, "Of the steady state: the growth rate or the period of the mode that decays last, or how far the end of the run is from it, the largest difference of a unit's mass in a class relative to what the unit holds. One of `stream`, `unit`, `steady`, `limit`.", "\"growth_rate\""),
    key("limit", Choice(words::<LimitField>), OneOf, "Of the first limit of stability that the continuation finds: the value of the key, or the period there. One of `stream`, `unit`, `steady`, `limit`.", "\"value\""),
];

#[rustfmt::skip]
const EXPECT: &[Key] = &[
    key("value", Measured, Required, "The value.", "\"0.18 kg/s\""),
    key("within", Band, Required, "How far off it may be.", "\"0.2 %\""),
];

#[rustfmt::skip]
pub(super) const QUANTITIES: &[Key] = &[
    key("name", Text, Required, "Name; no two alike.", "\"product\""),
    key("measure", Table(MEASURE), Required, "Exactly one of `stream`, `unit`, `steady` and `limit`.", "{ stream = \"product\", field = \"mass_flow\" }"),
    key("expect", Table(EXPECT), Without("none"), "Expected value at the end of the run.", "{ value = \"0.18 kg/s\", within = \"0.2 %\" }"),
    key("agree", Band, Without("not compared"), "Largest difference between two runs that are compared.", "\"1e-6\""),
];

#[rustfmt::skip]
pub(super) const STEADY: &[Key] = &[
    key("from", Choice(words::<SteadyFrom>), Default("end"), "What the iteration begins with: the end of the run, or its start.", "\"start\""),
    key("modes", Whole(1, 1000), Default("6"), "How many modes are written.", "6"),
];

#[rustfmt::skip]
pub(super) const CONTINUATION: &[Key] = &[
    key("keys", Texts(0), Required, "Keys that all get the value, as `--set` names them.", "[\"units.coarse.screen.sharpness\"]"),
    key("values", Texts(0), Required, "Values that follow one another, each with its unit; each steady state begins from the one before, the first from the plant's start.", "[\"4\", \"6\", \"8\"]"),
    key("width", Number(D::NONE, Within(0.0, 1.0)), Default("1e-4"), "How closely a limit of stability is found, relative to the value.", "1e-4"),
];

#[rustfmt::skip]
pub(super) const TUNING: &[Key] = &[
    key("state", Choice(words::<PlantTunedState>), Default("run"), "What is measured: the run at the times of the measurements, or the steady state.", "\"run\""),
    key("parameters", Tables(TUNED), Required, "The keys that are tuned.", "[[tuning.parameters]]"),
    key("distributions", Tables(SIEVED), Without("none"), "Measured distributions.", "[[tuning.distributions]]"),
    key("values", Tables(MEASURED_VALUES), Without("none"), "Other measured quantities.", "[[tuning.values]]"),
    key("samples", Whole(1, 100_000), Default("12"), "Sets of parameters that are tried first, spread over the bounds.", "12"),
    key("starts", Whole(1, 1000), Default("2"), "How many of the best are followed.", "2"),
    key("seed", Whole(0, MOST), Default("1"), "Seed of the sets.", "1"),
    key("level", Number(D::NONE, Within(0.0, 1.0)), Default("0.95"), "Probability with which an interval holds the true value.", "0.95"),
];

#[rustfmt::skip]
const TUNED: &[Key] = &[
    key("key", Text, Required, "Key of this plant, as `--set` names it.", "\"units.granulator.growth.linear\""),
    key("low", Text, Required, "Lower bound, in the unit of the key.", "\"0.5 mm\""),
    key("high", Text, Required, "Upper bound, in the same unit.", "\"4 mm\""),
    key("logarithmic", Truth, Default("false"), "Whether it is searched by its logarithm: bounds of several powers of ten.", "true"),
];

#[rustfmt::skip]
const SIEVED: &[Key] = &[
    key("stream", Text, OneOf, "The stream that was sieved. Either this or `unit`.", "\"product\""),
    key("unit", Text, OneOf, "The unit whose content was sieved. Either this or `stream`.", "\"granulator\""),
    key("file", Path, Required, "CSV file: a head of `time_s` and the apertures, as `time_s, 1 mm, 1.4 mm`; in each row a time in s and the share of the mass that passes each aperture, rising.", "\"sieves.csv\""),
    key("deviation", Number(D::NONE, Positive), Required, "Standard deviation of a share between two apertures.", "0.005"),
];

#[rustfmt::skip]
const MEASURED_VALUES: &[Key] = &[
    key("stream", Text, OneOf, "The stream. Either this or `unit`.", "\"product\""),
    key("unit", Text, OneOf, "The unit. Either this or `stream`.", "\"granulator\""),
    key("field", Choice(words::<PlantField>), Required, "What was measured.", "\"mean_diameter\""),
    key("of", Text, Without("required with `compound` and `class`"), "Compound of the field `compound`, or attribute class of `class` and `class_mean_diameter`, such as `colour 1`.", "\"water\""),
    key("file", Path, Required, "CSV file: a head of `time_s` and another word; in each row a time in s and the value in SI units.", "\"means.csv\""),
    key("deviation", Measured, Required, "Standard deviation of a value, in the unit of the field.", "\"5 um\""),
];
