//! Keys of `laws`.

use super::prelude::*;
use crate::laws;

#[rustfmt::skip]
const DRAG: &[Key] = &[
    key("model", Choice(words::<MomentumModel>), Default("a"), "How gas and particles share the pressure gradient: `a`, each by its share of the volume; `b`, the gas takes all, and a particle is as much lighter as the gas it displaces. The same for a bed at rest or in steady flow.", "\"b\""),
];

#[rustfmt::skip]
const HEAT_TRANSFER: &[Key] = &[
    key("film", Choice(words::<FilmTemperature>), Without("that of `mass_transfer`, so that heat and gas pass one film; `gas` where nothing reacts"), "Temperature at which the properties of the gas are taken: that of the gas, as the sources of most laws have it; `two-thirds`, T_p + (T_gas - T_p)/3, or `mean`, of particle and gas at the start of a window.", "\"two-thirds\""),
];

#[rustfmt::skip]
const SPECIES_DIFFUSIVITY: &[Key] = &[
    key("value", Number(D::DIFFUSIVITY, Positive), Required, "Its value.", "\"7.8e-5 m^2/s\""),
    key("at", Number(D::TEMPERATURE, Positive), Required, "The temperature of the value.", "\"300 K\""),
    key("pressure", Number(D::PRESSURE, Positive), Default("1 atm"), "The pressure of the value.", "\"1 bar\""),
    key("exponent", Number(D::NONE, Between(0.0, 4.0)), Default("1.75"), "Exponent of the temperature, 0 to 4: kinetic theory has 1.5 to 2.", "1.5"),
];

#[rustfmt::skip]
const FILM_DIFFUSIVITY: &[Key] = &[
    key("value", Number(D::DIFFUSIVITY, Positive), Without("by Fuller, Schettler and Giddings"), "The value of all species that are not in `species`.", "\"2.1e-5 m^2/s\""),
    key("at", Number(D::TEMPERATURE, Positive), Without("required with `value`"), "The temperature of the value.", "\"300 K\""),
    key("pressure", Number(D::PRESSURE, Positive), Default("1 atm"), "The pressure of the value.", "\"1 bar\""),
    key("exponent", Number(D::NONE, Between(0.0, 4.0)), Default("1.75"), "Exponent of the temperature, 0 to 4: kinetic theory has 1.5 to 2.", "1.5"),
    key("species", Named(SPECIES_DIFFUSIVITY), Without("none has a value of its own"), "Values of single species of the gas.", "{ H2 = { value = \"7.8e-5 m^2/s\", at = \"300 K\" } }"),
];

#[rustfmt::skip]
const MASS_TRANSFER: &[Key] = &[
    key("film", Choice(words::<FilmTemperature>), Default("two-thirds"), "Temperature of the film, at which its concentrations and the coefficient of mass transfer are taken: T_p + (T_gas - T_p)/3; `mean`, of particle and gas; or `gas`. Its composition is that of the gas.", "\"mean\""),
    key("stefan_flow", Choice(words::<StefanFlow>), Default("mass"), "What the net flow through the film does to the transfer of each gas and of heat: by flows of mass with the density of the film, Spalding's ln(1 + B); by flows of moles; or nothing.", "\"molar\""),
    key("diffusivity", Either(&Choice(words::<FilmDiffusivityName>), &Table(FILM_DIFFUSIVITY)), Default("fuller"), "Diffusivities D of the gases in the film: mixture-averaged, with those of pairs by Fuller, Schettler and Giddings; `schmidt`, viscosity over density over `gas.schmidt` of all gases, as in the gas itself; or stated, value (T/at)^exponent (pressure/p).", "\"schmidt\""),
];

#[rustfmt::skip]
const CONDUCTION: &[Key] = &[
    key("area", Choice(words::<AreaName>), Default("overlap"), "By which overlap contacts conduct: the computed one; that of the real materials (`real_young`) under the computed elastic force; or that under `load`.", "\"force\""),
    key("load", Number(D::FORCE, Positive), Without("required with `load`"), "Force on every contact, where area is `load`.", "\"50 mN\""),
    key("within", Number(D::LENGTH, Positive), Without("required with `load`"), "Widest gap that counts as a contact, where area is `load`.", "\"20 um\""),
    key("gap", Law(laws::gap, &[]), Without("none"), "Conduction through the gas between surfaces that are near.", "{ law = \"cheng\" }"),
];

#[rustfmt::skip]
const RADIATION: &[Key] = &[
    key("surroundings", Either(&Schedule(D::TEMPERATURE, Positive), &Choice(words::<Closed>)), Without("required with a law"), "Temperature of what rays reach that meet no wall; `closed`: nothing leaves.", "\"300 K\""),
    key("inside", Choice(words::<InsideName>), Default("isothermal"), "Spheres of one temperature, or less radiation through the bed where they conduct so badly that their warm side cannot pass on what it receives; the materials then need a conductivity.", "\"singh-kaviany\""),
    key("rays", Whole(16, 1_000_000), Default("1024"), "Rays a particle; of `view-factors`.", "1024"),
    key("range", Number(D::NONE, AtLeast(1.0)), Default("3"), "Distance of centres in largest diameters up to which particles see each other, 1 or more.", "3"),
    key("refresh", Number(D::TIME, Positive), Without("with every window"), "Views of moving particles hold for so much process time.", "\"10 s\""),
];

#[rustfmt::skip]
pub(super) const LAWS: &[Key] = &[
    key("drag", Law(laws::drag, DRAG), Required, "Drag on a particle.", "{ law = \"ergun-wen-yu\" }"),
    key("heat_transfer", Law(laws::heat_transfer, HEAT_TRANSFER), Required, "Heat transfer between gas and particle.", "{ law = \"gunn\" }"),
    key("mass_transfer", Law(laws::heat_transfer, MASS_TRANSFER), Without("none"), "Mass transfer between gas and particles that react, by a law of heat transfer with the Schmidt number in place of the Prandtl number; required, and not `none`, where reactions exchange gas.", "{ law = \"gunn\" }"),
    key("conduction", Law(laws::conduction, CONDUCTION), Required, "Heat conduction between particles and to walls of a temperature.", "{ law = \"none\" }"),
    key("radiation", Law(laws::radiation, RADIATION), Required, "Radiation between particles, to walls and surroundings; the gas is transparent.", "{ law = \"none\" }"),
];
