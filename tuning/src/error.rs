//! What is wrong with a tuning, or stops it.

use thiserror::Error;

/// What is wrong with a tuning, or stops it. Each says the fact, the number and the remedy.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum TuningError {
    /// Points that are no temperature programme.
    #[error(
        "temperature programme: {0}; give two points or more with rising times and temperatures above 0 K"
    )]
    Programme(String),
    /// A model whose run does not come to its end.
    #[error("the model could not be run: {0}")]
    Model(String),
    /// Bounds of a parameter that are none.
    #[error("parameter \"{name}\": bounds from {low} to {high}; {remedy}")]
    Bounds {
        /// Name of the parameter.
        name: String,
        /// Lower bound in SI.
        low: f64,
        /// Upper bound in SI.
        high: f64,
        /// What they have to be.
        remedy: &'static str,
    },
    /// A parameter that the model does not have.
    #[error("the model has no number \"{name}\"; its numbers are {known}")]
    UnknownParameter {
        /// Name that was asked for.
        name: String,
        /// Names that there are.
        known: String,
    },
    /// Curves from which a method of kinetic analysis gets nothing.
    #[error("{method}: {cause}")]
    Analysis {
        /// The method.
        method: &'static str,
        /// What is missing, and what to do.
        cause: String,
    },
    /// Fewer values than parameters.
    #[error(
        "{values} values cannot determine {parameters} parameters; add targets, or fix parameters"
    )]
    TooFewValues {
        /// Values compared.
        values: usize,
        /// Free parameters.
        parameters: usize,
    },
    /// No set of parameters with which the model could be run.
    #[error("none of {tried} sets of parameters could be evaluated; the last one said: {cause}")]
    NoneEvaluated {
        /// How many were tried.
        tried: usize,
        /// What the last one said.
        cause: String,
    },
    /// A best fit that explains nothing of the curves.
    #[error(
        "the best fit of {laws} is no better than a sample that does not react: {left:.0} % of its sum of squares is left. Widen the \
         bounds of pre_exponential and activation_energy, so that the reaction falls into the temperatures of the curves, raise \
         `method.samples`, or fit the mass first: compare = [\"mass\"]"
    )]
    NothingReacts {
        /// The laws that were fitted.
        laws: String,
        /// Share of the sum of squares that is left, in %.
        left: f64,
    },
    /// Interrupted from outside.
    #[error("the tuning was interrupted")]
    Interrupted,
}
