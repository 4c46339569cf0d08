//! Keys of `reactions`.

use super::prelude::*;
use crate::laws;

#[rustfmt::skip]
const RATE_IN_SERIES: &[Key] = &[
    key("factor", Number(D::NONE, Positive), Required, "As that of the first.", "0.2"),
    key("exponent", Number(D::NONE, Any), Default("0"), "Exponent of the temperature in K.", "0"),
    key("activation_energy", Number(D::MOLAR_ENERGY, Any), Default("0 J/mol"), "Activation energy.", "\"18 kJ/mol\""),
];

#[rustfmt::skip]
const RATE: &[Key] = &[
    key("factor", Either(&Number(D::VELOCITY, Positive), &Number(D::NONE, Positive)), Required, "Shrinking core: of the rate by area of the interface and concentration of the gas. Power law: a number in mol, m and s, of the rate in mol/m^3/s by concentrations in mol/m^3.", "3e4"),
    key("exponent", Number(D::NONE, Any), Default("0"), "Exponent of the temperature in K.", "0.5"),
    key("activation_energy", Number(D::MOLAR_ENERGY, Any), Default("0 J/mol"), "Activation energy.", "\"60 kJ/mol\""),
    key("orders", ByName(D::NONE), Without("none"), "Power law: order of each gas and solid; required there. A negative one only of a gas that is always there.", "{ Fe = 1, O2 = 1 }"),
    key("in_series", Table(RATE_IN_SERIES), Without("none"), "Power law: a second rate constant in series, 1/k = 1/k1 + 1/k2, such as that of diffusion in pores.", "{ factor = 0.2, activation_energy = \"18 kJ/mol\" }"),
];

#[rustfmt::skip]
const LAYER_DIFFUSIVITY: &[Key] = &[
    key("value", Number(D::DIFFUSIVITY, Positive), Required, "Its value.", "\"1e-5 m^2/s\""),
    key("at", Number(D::TEMPERATURE, Positive), Without("none"), "The temperature of the value; required with an exponent.", "\"1100 K\""),
    key("exponent", Number(D::NONE, Any), Default("0"), "Exponent of the temperature.", "1.75"),
];

#[rustfmt::skip]
const EQUILIBRIUM: &[Key] = &[
    key("constant", Number(D::NONE, Any), Required, "Its constant.", "-2.946"),
    key("over_temperature", Number(D::TEMPERATURE, Any), Required, "What stands over the temperature; may be negative.", "\"2744 K\""),
];

#[rustfmt::skip]
pub(super) const REACTIONS: &[Key] = &[
    key("name", Text, Required, "Its name.", "\"calcination\""),
    key("equation", Text, Required, "Moles of gases of `gas.species` and of solids, with => (one way) or <=> (both ways); balanced. The last species of the gas reacts in none.", "\"CaCO3 <=> CaO + CO2\""),
    key("law", LawName(laws::rate), Required, "At the surface of a core, with gas film, layers and kinetics in series; or in the whole particle, by powers of concentrations.", "\"shrinking-core\""),
    key("rate", Table(RATE), Required, "Rate constant k = factor T^exponent exp(-activation_energy/RT) of the forward reaction.", "{ factor = \"0.3 m/s\", activation_energy = \"70 kJ/mol\" }"),
    key("layer_diffusivity", Table(LAYER_DIFFUSIVITY), Without("none"), "Shrinking core: diffusivity of the gas in the pores of the layer that the reaction leaves, value (T/at)^exponent; required there.", "{ value = \"1e-5 m^2/s\", at = \"1100 K\", exponent = 1.75 }"),
    key("equilibrium", Table(EQUILIBRIUM), Without("from the Gibbs energies of gases and solids"), "Of a reaction with <=>: ln K = constant + over_temperature/T, with partial pressures over 1 bar.", "{ constant = -2.946, over_temperature = \"2744 K\" }"),
    key("heat", Number(D::MOLAR_ENERGY, Any), Without("not stated"), "Heat that the reaction takes up at 298.15 K, to be compared with that of the enthalpies of formation, which counts; more than 2 % off is an error.", "\"178 kJ/mol\""),
];
