//! Radiation by distance.

/// Share left.
pub fn visibility(_s: f64) -> f64 {
    1.0
}

/// Share left of a wall.
pub fn wall_visibility(_h: f64) -> f64 {
    1.0
}
