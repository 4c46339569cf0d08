//! Gas reactions as they are stated, by names.

use super::falloff::RateConstant;
use crate::reaction::Equation;

/// A reaction as a mechanism file, a case file or a table states it.
#[derive(Clone, Debug, PartialEq)]
pub struct ReactionStatement {
    /// Its name, such as its equation.
    pub name: String,
    /// Its equation, without third bodies. Where it goes both ways, the rate back follows from the
    /// equilibrium of the species' own Gibbs energies.
    pub equation: Equation,
    /// Orders of the rate forth where they are not the numbers of the left side: these alone count then.
    /// Of concentrations in mol/m³.
    pub orders: Option<Vec<(String, f64)>>,
    /// Its rate constant in (mol/m³)^(1 − Σ orders)/s; with a third body and Arrhenius' law, which counts
    /// as one more order.
    pub rate: RateConstant,
    /// Its third body.
    pub collider: Option<Collider>,
}

/// What stabilises or breaks a molecule by hitting it: all species by their efficiencies.
#[derive(Clone, Debug, PartialEq)]
pub struct Collider {
    /// Efficiencies by name.
    pub efficiencies: Vec<(String, f64)>,
    /// That of all others.
    pub others: f64,
}
