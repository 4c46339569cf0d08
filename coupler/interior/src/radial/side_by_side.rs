//! How many particles with shells are computed side by side, one a lane of vector registers.

use calcine_numerics::Lanes;

/// Particles that are computed side by side.
pub(super) const LANES: usize = 8;
/// A value of each.
pub(super) type Wide = Lanes<LANES>;
