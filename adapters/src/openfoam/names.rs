//! Names of the gas solver.

/// Name in messages.
pub(super) const NAME: &str = "OpenFOAM (gas)";

/// Name of the solver's program.
pub const SOLVER: &str = "calcineGasFoam";
