//! Reactions of the gas with itself, as the solvers take them.

use calcine_physics::kinetics::{Mechanism, Tolerances};

/// What the gas does by itself.
#[derive(Clone, Debug, Default)]
pub enum GasChemistry {
    /// Nothing.
    #[default]
    None,
    /// It reacts.
    Reacting(Box<ReactingGas>),
}

/// A gas that reacts.
#[derive(Clone, Debug)]
pub struct ReactingGas {
    /// Its reactions, over the species of the setup's mixture.
    pub mechanism: Mechanism,
    /// How closely they are integrated.
    pub tolerances: Tolerances,
    /// How what is mixed within a cell bears on them.
    pub combustion: Combustion,
}

/// How what is mixed within a cell bears on its reactions.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Combustion {
    /// A cell is mixed: laminar rates.
    #[default]
    Laminar,
    /// The partially stirred reactor of docs/theory.md, COR-16: only what eddies mix reacts.
    Pasr {
        /// C_mix.
        mixing_constant: f64,
    },
}

impl GasChemistry {
    /// The gas that reacts, where it does.
    pub fn reacting(&self) -> Option<&ReactingGas> {
        match self {
            Self::None => None,
            Self::Reacting(gas) => Some(gas),
        }
    }
}
