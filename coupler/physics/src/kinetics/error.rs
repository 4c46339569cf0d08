//! What can be wrong with gas reactions.

use thiserror::Error;

/// An error of gas reactions.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum KineticsError {
    /// A mechanism names a species that the gas does not have.
    #[error("{reaction} names {species}, which the gas does not have; it has {known}")]
    UnknownSpecies {
        /// The reaction, by its equation, or the mechanism's name.
        reaction: String,
        /// The species.
        species: String,
        /// The species of the gas.
        known: String,
    },
    /// An equation that cannot be read.
    #[error("{reaction} cannot be read: {why}")]
    Equation {
        /// The text.
        reaction: String,
        /// What is wrong with it.
        why: String,
    },
    /// An equation that loses or makes atoms.
    #[error("{reaction} is not balanced: {off}")]
    Unbalanced {
        /// The reaction.
        reaction: String,
        /// What is too much on which side.
        off: String,
    },
    /// A number that is none.
    #[error("{reaction}: {quantity} is {value}, which is no number of its kind")]
    Value {
        /// The reaction.
        reaction: String,
        /// What it is.
        quantity: &'static str,
        /// Its value.
        value: f64,
    },
    /// A third body without efficiency.
    #[error("{reaction} needs a third body, but the gas has none for it")]
    NoCollider {
        /// The reaction.
        reaction: String,
    },
    /// A state in which rates have no meaning.
    #[error("gas cannot react at {state}")]
    State {
        /// The state in words.
        state: String,
    },
    /// An integration that did not come through.
    #[error(
        "the reactions could be integrated over {reached:.3e} s of {time:.3e} s only, \
         starting from {state}: {why}"
    )]
    Integration {
        /// The state at the start in words.
        state: String,
        /// How far it came in s.
        reached: f64,
        /// How far it should have come in s.
        time: f64,
        /// What stopped it.
        why: String,
    },
}
