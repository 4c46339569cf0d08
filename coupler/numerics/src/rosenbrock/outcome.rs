//! How exactly systems are integrated, and what comes of it.

use thiserror::Error;

/// Steps of one integration at most, unless asked otherwise.
pub const MOST_STEPS: usize = 20_000;

/// How exactly a system is integrated.
#[derive(Clone, Copy, Debug)]
pub struct IntegrationAccuracy<'a> {
    /// Error of a step relative to each value.
    pub relative: f64,
    /// Error of a step that counts as none, of each unknown and then each integral, in its own unit.
    pub absolute: &'a [f64],
    /// Most steps.
    pub steps: usize,
}

impl<'a> IntegrationAccuracy<'a> {
    /// Absolute errors alone.
    pub fn absolute(absolute: &'a [f64]) -> Self {
        Self {
            relative: 0.0,
            absolute,
            steps: MOST_STEPS,
        }
    }
}

/// What an integration took.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct IntegrationStatistics {
    /// Accepted steps.
    pub steps: usize,
    /// Steps that were repeated with a smaller one.
    pub rejected: usize,
    /// Evaluations of the rates alone; those with derivatives are as many as accepted steps,
    /// one more where direct effects are wanted.
    pub evaluations: usize,
}

/// Why an integration does not come to its end.
#[derive(Clone, Copy, Debug, Error, PartialEq, Eq)]
pub enum StallCause {
    /// So many steps did not suffice.
    #[error("it took more than {0} steps")]
    Steps(usize),
    /// Steps became too small for the clock to move.
    #[error("the steps became too small to add up")]
    Step,
    /// A rate is not finite.
    #[error("a rate is not finite")]
    NotFinite,
}

/// An integration that does not come to its end.
#[derive(Clone, Copy, Debug, Error, PartialEq)]
#[error("the rates could not be followed beyond {reached:.6e} s of {span:.6e} s: {cause}")]
pub struct IntegrationStalled {
    /// How far it came in s.
    pub reached: f64,
    /// How far it was to go in s.
    pub span: f64,
    /// Why.
    pub cause: StallCause,
    /// Index of the unknown, or beyond them of the integral, whose error was the largest.
    pub worst: usize,
}
