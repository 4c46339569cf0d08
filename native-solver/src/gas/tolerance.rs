//! How close the scalars of an attempt are solved.

/// When the solve of a scalar ends: where its residual is below either.
#[derive(Clone, Copy, Debug)]
pub struct ScalarTolerance {
    /// As a share of what moves: through the boundary, from the particles, into storage.
    pub absolute: f64,
    /// As a share of the initial residual.
    pub relative: f64,
}
