//! What can be wrong with a gas.

use thiserror::Error;

/// An error of the gas properties.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum ThermoError {
    /// No built-in species has this name.
    #[error("the species {name} is not built in; there are {known}")]
    UnknownSpecies {
        /// The name.
        name: String,
        /// The names there are.
        known: String,
    },
    /// A mixture of nothing or of too many species.
    #[error("a mixture of {count} species; it needs 1 to {most}")]
    Count {
        /// How many there are.
        count: usize,
        /// How many there may be.
        most: usize,
    },
    /// A species that is named twice.
    #[error("the species {name} stands twice")]
    RepeatedSpecies {
        /// Its name.
        name: String,
    },
    /// A property of a species that must be positive is not.
    #[error("{quantity} of the species {species} is {value}, but must be positive and finite")]
    NotPositive {
        /// The species.
        species: String,
        /// Which property, with its unit.
        quantity: &'static str,
        /// Its value.
        value: f64,
    },
    /// Temperatures of a polynomial that do not follow each other.
    #[error(
        "a polynomial from {lowest} K to {common} K and on to {highest} K: \
         the temperatures must be positive and rise"
    )]
    Range {
        /// Lowest temperature in K.
        lowest: f64,
        /// Temperature in K at which the two ranges meet.
        common: f64,
        /// Highest temperature in K.
        highest: f64,
    },
    /// Species whose polynomials have no temperature in common.
    #[error(
        "the species' polynomials have no temperature in common: \
         one starts at {lowest} K, another ends at {highest} K"
    )]
    NoCommonRange {
        /// Highest of the lowest temperatures in K.
        lowest: f64,
        /// Lowest of the highest temperatures in K.
        highest: f64,
    },
    /// An enthalpy that no temperature in the range has.
    #[error(
        "no temperature from {lowest} K to {highest} K has the enthalpy {enthalpy} {unit}; \
         there it lies between {least} {unit} and {most} {unit}"
    )]
    EnthalpyOutOfRange {
        /// The enthalpy.
        enthalpy: f64,
        /// Unit of the enthalpies.
        unit: &'static str,
        /// Lowest temperature in K.
        lowest: f64,
        /// Highest temperature in K.
        highest: f64,
        /// Enthalpy at the lowest temperature.
        least: f64,
        /// Enthalpy at the highest temperature.
        most: f64,
    },
}
