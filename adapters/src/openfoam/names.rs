//! Names of the solvers.

/// Name in messages.
pub(super) const NAME: &str = "OpenFOAM (gas)";

/// Name of the solver's program.
pub const SOLVER: &str = "calcineGasFoam";

/// Name of the parcels in messages.
pub(super) const PARCELS: &str = "OpenFOAM (parcels)";

/// Name of the program that moves parcels.
pub const PARCEL_PROGRAM: &str = "calcineParcelFoam";
