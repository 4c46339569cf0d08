//! What breaks, and into what.

use calcine_physics::dimension::Dimension;
use calcine_physics::law::{Bound, LawEntry, LawParameter};

/// Breakage of particles of volume v in m³.
pub trait BreakageLaw: Send + Sync {
    /// Rate S at which a particle of volume v breaks, in 1/s.
    fn rate(&self, v: f64) -> f64;

    /// Number of fragments of a particle of volume v that are smaller than u ≤ v, and their volume in m³. Of all fragments
    /// the volume is v.
    fn below(&self, u: f64, v: f64) -> [f64; 2];

    /// Which of its numbers it cannot have, with the value and what it may be.
    fn refused(&self) -> Option<(&'static str, f64, &'static str)> {
        None
    }
}

/// Random binary breakage at a rate in proportion to volume.
///
/// S = S₀ v,   β(u, v) = 2/v
///
/// Source: Ziff and McGrady, J. Phys. A 18 (1985) 3027, doi 10.1088/0305-4470/18/15/026.
#[derive(Clone, Copy, Debug)]
pub struct RandomBinary {
    /// S₀ in 1/(s m³).
    pub rate: f64,
}

impl BreakageLaw for RandomBinary {
    fn rate(&self, v: f64) -> f64 {
        self.rate * v
    }

    fn below(&self, u: f64, v: f64) -> [f64; 2] {
        [2.0 * u / v, u * u / v]
    }
}

/// Its entry in a case file.
pub(super) static RANDOM_BINARY: LawEntry<dyn BreakageLaw> = LawEntry {
    name: "random-binary",
    summary: "Two fragments of any size, at a rate in proportion to volume.",
    source: "Ziff and McGrady, J. Phys. A 18 (1985) 3027, doi 10.1088/0305-4470/18/15/026",
    parameters: &[LawParameter {
        name: "rate",
        dimension: Dimension([-3, 0, -1, 0, 0]),
        bound: Bound::NotNegative,
        default: None,
        needed_with: None,
        meaning: "Rate of breakage per volume of the particle.",
        example: "\"1e6 1/s/m^3\"",
    }],
    tables: &[],
    make: |values| Box::new(RandomBinary { rate: values[0] }),
};
