//! Keys of cases of the kind "tuning".

use super::prelude::*;

#[rustfmt::skip]
const MODEL: &[Key] = &[
    key("type", Choice(words::<TunedModel>), Required, "What is tuned: `lumped` is a sample in a crucible with two temperatures, `kinetic` is a sample that has the temperature of the target.", "\"lumped\""),
    key("contact_transfer", Number(D::HEAT_TRANSFER, Positive), Default("100 W/m^2/K"), "Heat transfer coefficient h2 between crucible and sample (lumped).", "\"100 W/m^2/K\""),
    key("gas_transfer", Number(D::HEAT_TRANSFER, NotNegative), Default("20 W/m^2/K"), "Heat transfer coefficient h1 between gas and crucible (lumped).", "\"20 W/m^2/K\""),
    key("emissivity", Number(D::NONE, Between(0.0, 1.0)), Default("0.15"), "Emissivity of the crucible (lumped).", "0.15"),
    key("crucible_mass", Number(D::MASS, Positive), Default("200 mg"), "Mass of the crucible (lumped).", "\"200 mg\""),
    key("crucible_heat_capacity", Number(D::HEAT_CAPACITY, Positive), Default("140 J/kg/K"), "Specific heat capacity of the crucible (lumped).", "\"140 J/kg/K\""),
    key("outer_area", Number(AREA, Positive), Default("84.8 mm^2"), "Outer area of the crucible, side and bottom (lumped).", "\"84.8 mm^2\""),
    key("contact_area", Number(AREA, Positive), Default("28.27 mm^2"), "Area between crucible and sample (lumped).", "\"28.27 mm^2\""),
    key("sample_heat_capacity", Number(D::HEAT_CAPACITY, Positive), Default("1000 J/kg/K"), "Specific heat capacity of the fresh sample (lumped).", "\"1000 J/kg/K\""),
    key("product_heat_capacity", Number(D::HEAT_CAPACITY, Positive), Default("900 J/kg/K"), "Specific heat capacity of the solid product (lumped, where one of the two keys below needs it).", "\"900 J/kg/K\""),
    key("released_heat_capacity", Number(D::HEAT_CAPACITY, Positive), Default("1150 J/kg/K"), "Specific heat capacity of the gas that is released (lumped, with `reaction_heat = \"kirchhoff\"`).", "\"1150 J/kg/K\""),
    key("heat_capacity", Choice(words::<SampleCapacity>), Default("constant"), "Heat capacity of the sample: that of the fresh one, or of its composition (lumped).", "\"composition\""),
    key("reaction_heat", Choice(words::<ReactionHeat>), Default("constant"), "Reaction enthalpy: that at 298.15 K, or at the temperature of the sample by Kirchhoff's law (lumped).", "\"kirchhoff\""),
];

#[rustfmt::skip]
const TUNED_REACTIONS: &[Key] = &[
    key("name", Text, Without("needed where there are several"), "Name; parameters of one of several reactions are `NAME.activation_energy`.", "\"calcite\""),
    key("laws", Texts(0), Without("first order, F1"), "Kinetic laws that are compared, of one reaction several: F1, Fn, R2, R3, A2, A3, An, Pn, RPM, D1, D2, D3, D4, or `all`.", "[\"F1\", \"R2\", \"R3\"]"),
    key("pre_exponential", Number(D::ANGULAR_VELOCITY, Positive), Default("1e10 1/s"), "Pre-exponential factor A, where it is not tuned.", "\"1.235e15 1/s\""),
    key("activation_energy", Number(D::MOLAR_ENERGY, NotNegative), Default("200 kJ/mol"), "Activation energy E, where it is not tuned.", "\"325.1 kJ/mol\""),
    key("reactant", Number(D::NONE, UpTo(0.0, 1.0)), Default("1"), "Share of the sample's mass at the start that is its reactant.", "0.95"),
    key("mass_loss", Number(D::NONE, UpTo(0.0, 1.0)), Without("of one reaction that of the targets"), "Share of the reactant's mass that goes into the gas.", "0.4397"),
    key("reaction_enthalpy", Number(D::ENERGY_OF_MASS, Any), Default("0 J/kg"), "Heat that the reaction takes up at 298.15 K, of each kg of reactant.", "\"1.781 MJ/kg\""),
    key("order", Number(D::NONE, Between(0.0, 5.0)), Default("1.5"), "Order of the law Fn, where it is not tuned.", "1.5"),
    key("exponent", Number(D::NONE, Between(0.5, 6.0)), Default("1.5"), "Exponent of the laws An and Pn, where it is not tuned.", "2"),
    key("structure", Number(D::NONE, Between(0.0, 1000.0)), Default("3"), "Structural parameter of the law RPM, where it is not tuned.", "3"),
];

#[rustfmt::skip]
const TUNED: &[Key] = &[
    key("low", Measured, Required, "Lower bound, in the unit of the parameter.", "\"50 W/m^2/K\""),
    key("high", Measured, Required, "Upper bound.", "\"150 W/m^2/K\""),
    key("scale", Choice(words::<ParameterScale>), Without("logarithmic for `pre_exponential`, linear for others"), "How the search goes from bound to bound.", "\"logarithmic\""),
];

#[rustfmt::skip]
const TARGET_COLUMNS: &[Key] = &[
    key("time", Text, Without("recognised"), "Heading of the column of times, or its number.", "\"Time\""),
    key("temperature", Text, Without("recognised"), "Heading of the column of temperatures.", "\"Sample temperature\""),
    key("mass", Text, Without("recognised"), "Heading of the column of masses.", "\"Weight\""),
    key("loss_rate", Text, Without("recognised"), "Heading of the column of rates of loss.", "\"DTG\""),
    key("run", Text, Without("recognised"), "Heading of the column that tells several runs of a file apart.", "\"run\""),
];

#[rustfmt::skip]
const TARGET_UNITS: &[Key] = &[
    key("time", Text, Without("that of the heading"), "Unit of the times: s, min, h.", "\"min\""),
    key("temperature", Text, Without("that of the heading"), "Unit of the temperatures: degC, K.", "\"degC\""),
    key("mass", Text, Without("that of the heading"), "Unit of the masses: %, mg, g, or 1 for a share.", "\"%\""),
    key("loss_rate", Text, Without("that of the heading"), "Unit of the rates: %/min, mg/min, 1/s.", "\"%/min\""),
];

#[rustfmt::skip]
const TARGETS: &[Key] = &[
    key("file", Path, Required, "File of a curve: text with columns, of any instrument.", "\"tg-15.csv\""),
    key("name", Text, Without("the heating rate, or the file's name"), "Name in results.", "\"15 K/min\""),
    key("columns", Table(TARGET_COLUMNS), Without("all recognised"), "Which columns are meant.", "{ mass = \"Weight\" }"),
    key("units", Table(TARGET_UNITS), Without("those of the headings"), "Units of the columns.", "{ mass = \"%\" }"),
    key("delimiter", Choice(words::<DelimiterName>), Without("recognised"), "What stands between columns.", "\"semicolon\""),
    key("decimal", Choice(words::<DecimalName>), Without("recognised"), "The decimal sign.", "\"comma\""),
    key("compare", Choices(&["temperature", "mass", "loss_rate"]), Without("the mass, or the rate of loss where there is none"), "Which columns the model is compared with; the temperature of a lumped model is that of the sample.", "[\"temperature\", \"mass\"]"),
    key("sample_mass", Number(D::MASS, Positive), Without("the mean of the first masses of the file, before it falls"), "Mass of the sample at the start, which masses in mg are relative to. Where it is not stated, the scale of the curve is fitted.", "\"5 mg\""),
    key("sample_share", Number(D::NONE, Between(0.2, 1.5)), Without("the mean of the first values of the file, before it falls"), "Value at the start, which masses in % are relative to: 100 % where the instrument took it from the mass at the start. Where it is not stated, the scale of the curve is fitted.", "\"100 %\""),
    key("heating_rate", Number(D::HEATING_RATE, Positive), Without("the temperatures of the file"), "Constant heating rate of the furnace.", "\"15 K/min\""),
    key("start_temperature", Number(D::TEMPERATURE, Positive), Default("293.15 K"), "Temperature at the first time, with `heating_rate`.", "\"20 degC\""),
    key("fit", Truth, Default("true"), "Whether the parameters are fitted to it. With `false` it is kept back: the tuned model is compared with it afterwards.", "false"),
    key("conversion", Numbers(2), Without("all of the curve"), "Range of the conversion that counts.", "[0.001, 0.999]"),
    key("largest_rise", Number(D::NONE, Between(0.0, 10.0)), Default("5 %"), "Largest rise of the mass that is let pass, as a share of its whole fall.", "\"5 %\""),
];

#[rustfmt::skip]
const METHOD: &[Key] = &[
    key("algorithm", Choice(words::<TuningAlgorithm>), Default("least-squares"), "`least-squares` fits from many starts; `nsga2` searches for the front between several compared quantities.", "\"nsga2\""),
    key("population", Whole(4, 100_000), Default("30"), "Sets of parameters in a generation of `nsga2`.", "30"),
    key("generations", Whole(1, 1_000_000), Default("120"), "Generations of `nsga2`.", "120"),
    key("seed", Whole(0, MOST), Default("1"), "Seed of all that is drawn.", "1"),
    key("samples", Whole(0, 1_000_000), Default("60"), "Sets of parameters that `least-squares` tries first, beside its own guesses.", "60"),
    key("starts", Whole(1, 10_000), Default("6"), "How many of the best of them are followed.", "6"),
    key("differences", Choice(words::<DifferenceName>), Default("absolute"), "Differences as they are, or relative to the measured values.", "\"relative\""),
    key("choose", Text, Without("all of them, by their likelihood"), "Compared quantity by which the point of the front is chosen and polished.", "\"mass\""),
    key("polish", Truth, Default("true"), "Whether the chosen point of a front is fitted further.", "true"),
];

#[rustfmt::skip]
const INTERVALS: &[Key] = &[
    key("level", Number(D::NONE, Between(0.5, 0.999)), Default("0.95"), "Probability with which an interval holds the true value.", "0.95"),
    key("profile", Truth, Default("true"), "Whether intervals are found by profiles of the likelihood.", "true"),
    key("bootstrap", Whole(0, 100_000), Default("100"), "Sets of data that are drawn anew and fitted; 0 for none.", "200"),
];

/// m².
const AREA: D = D([2, 0, 0, 0, 0]);

/// The keys of the file of a tuning.
#[rustfmt::skip]
pub(super) const TUNING: &[Key] = &[
    key("kind", Choice(|| vec!["tuning"]), Required, "What the file describes.", "\"tuning\""),
    key("format", Whole(0, MOST), Required, "Version of the format; 1 is the only one.", "1"),
    key("title", Text, Required, "Title for people.", "\"Calcite, three heating rates\""),
    key("model", Table(MODEL), Required, "What is tuned.", "[model]"),
    key("reactions", Tables(TUNED_REACTIONS), Required, "Reactions of the sample, side by side.", "[[reactions]]"),
    key("parameters", Named(TUNED), Required, "Parameters that are tuned, by their names: numbers of the model and of its reactions.", "[parameters.activation_energy]"),
    key("targets", Tables(TARGETS), Required, "Curves that the model is to follow.", "[[targets]]"),
    key("method", Table(METHOD), Without("its defaults"), "How the parameters are searched for.", "[method]"),
    key("intervals", Table(INTERVALS), Without("its defaults"), "How well the parameters are known.", "[intervals]"),
];
