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
