//! Keys of `reactions`.

use super::prelude::*;
use crate::laws;

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
    key("equilibrium", Table(EQUILIBRIUM), Without("from the Gibbs energies of gases and solids"), "Of a reaction with <=>: ln K = constant + over_temperature/T, with partial pressures over 1 bar.", "{ constant = -2.946, over_temperature = \"2744 K\" }"),
    key("heat", Number(D::MOLAR_ENERGY, Any), Without("not stated"), "Heat that the reaction takes up at 298.15 K, to be compared with that of the enthalpies of formation, which counts; more than 2 % off is an error.", "\"178 kJ/mol\""),
];
